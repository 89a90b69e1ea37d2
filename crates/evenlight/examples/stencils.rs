//! Writes limit points as weights of the cage's vertices, once, and applies them to pose after
//! pose.
//!
//! ```sh
//! cargo run --example stencils [CAGE]
//! ```

use std::error::Error;

use evenlight::stencil::StencilBuilder;
use evenlight::{QuadId, Surface, SurfaceOptions, io};

/// A cube, if no cage is named.
const CUBE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/cube.obj");

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or(CUBE.to_owned());
    let (cage, _) = io::read_cage(path)?;
    let surface = Surface::build(cage, SurfaceOptions::default())?;
    let has_surface = |quad: &QuadId| surface.eval_position(*quad, 0.5, 0.5).is_some();
    let quads = (0..surface.num_quads() as u32).map(QuadId).filter(has_surface);
    let places: Vec<_> = quads.map(|quad| (quad, 0.3, 0.6)).collect();

    // A row for each place: the weights of the vertices, which sum to 1.
    let stencils = StencilBuilder::of_surface(&surface)?.places(&places, 0)?;
    let (vertices, weights) = stencils.rows().next().ok_or("there is no face with a surface")?;
    println!("the first place is a mean of {} vertices:", vertices.len());
    for (vertex, weight) in vertices.iter().zip(weights).take(5) {
        println!("  vertex {vertex}: {weight:.6}");
    }

    // Any values of the vertices: here positions, at rest and lifted.
    let lifted: Vec<_> = surface.positions().iter().map(|&[x, y, z]| [x, y, z + 1.0]).collect();
    for positions in [surface.positions(), &lifted] {
        let points = stencils.apply(positions)?;
        let [x, y, z] = points[0];
        println!("it is at ({x:.6}, {y:.6}, {z:.6})");
    }
    Ok(())
}
