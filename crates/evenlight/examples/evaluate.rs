//! Evaluates a surface on the way to an extraordinary vertex: position, derivatives, normal and
//! curvature, in two schemes.
//!
//! ```sh
//! cargo run --example evaluate [CAGE]
//! ```

use std::error::Error;
use std::sync::Arc;

use evenlight::surface::Sector;
use evenlight::{SchemeKind, Surface, SurfaceOptions, io};

/// A cube, if no cage is named.
const CUBE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/cube.obj");

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or(CUBE.to_owned());
    let (cage, _) = io::read_cage(path)?;
    let cage = Arc::new(cage);
    for scheme in [SchemeKind::CatmullClark, SchemeKind::Qas4] {
        let options = SurfaceOptions { scheme, ..SurfaceOptions::default() };
        show(&Surface::build(cage.clone(), options)?)?;
    }
    Ok(())
}

fn show(surface: &Surface) -> Result<(), Box<dyn Error>> {
    println!("scheme {}", surface.options().scheme.name());
    let point = surface.extraordinary_points().first().ok_or("there is no extraordinary point")?;
    let sector = point.sectors.first().ok_or("the point has no surface")?;
    // Halfway to the point, and again, and again: curvature stays bounded or does not.
    for step in [1.0, 0.5, 0.25, 1.0 / 16.0, 1e-6, 1e-12, 0.0] {
        let [u, v] = diagonal(sector, step);
        let at = surface.eval(sector.quad, u, v).ok_or("the quad is omitted")?;
        let [x, y, z] = at.jet.p;
        println!("  at {step:<8} ({x:.6}, {y:.6}, {z:.6})  K {:.6}  H {:.6}", at.gauss, at.mean);
    }
    let [x, y, z] = surface.rings(0).ok_or("the point has no rings")?.normal();
    println!("  the normal at the point is ({x:.6}, {y:.6}, {z:.6})");
    Ok(())
}

/// The place on the diagonal of a sector at `step` from its point.
fn diagonal(sector: &Sector, step: f64) -> [f64; 2] {
    let Sector { center, along: [a, b], .. } = sector;
    std::array::from_fn(|k| center[k] + step * (a[k] + b[k]))
}
