//! Moves a cage and asks the surface again: topology is looked at once, new positions cost little.
//!
//! ```sh
//! cargo run --release --example new_pose [CAGE]
//! ```

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use evenlight::surface::Layout;
use evenlight::tessellate::{TriangleMesh, tessellate_into};
use evenlight::{Surface, SurfaceOptions, io};

/// A cube, if no cage is named.
const CUBE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/cube.obj");

/// The pictures of the animation.
const FRAMES: usize = 8;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or(CUBE.to_owned());
    let (cage, _) = io::read_cage(path)?;
    // Pieces, extraordinary points and their rules: of all poses.
    let layout = Arc::new(Layout::new(&cage, SurfaceOptions::default())?);
    let mut surface = Surface::of_cage(&layout, &cage)?;
    let mut mesh = TriangleMesh::default();
    for frame in 0..FRAMES {
        let clock = Instant::now();
        surface.set_positions(twisted(&cage, 0.1 * frame as f64))?;
        // The mesh's memory is used again.
        tessellate_into(&surface, 8, &mut mesh)?;
        let largest = mesh.mean.iter().map(|h| h.abs()).fold(0.0, f64::max);
        let time = 1e3 * clock.elapsed().as_secs_f64();
        println!(
            "frame {frame}: {} triangles, |H| up to {largest:.4}, {time:.2} ms",
            mesh.triangles.len()
        );
    }
    Ok(())
}

/// The positions, turned about the z-axis by `angle` per unit of height.
fn twisted(cage: &evenlight::Cage, angle: f64) -> Vec<evenlight::Point> {
    let turn = |&[x, y, z]: &evenlight::Point| {
        let (s, c) = (angle * z).sin_cos();
        [c * x - s * y, s * x + c * y, z]
    };
    cage.positions().iter().map(turn).collect()
}
