//! What topology apart from values saves: new positions on one layout, and primvars.
//!
//! Minima of interleaved runs, of which each does the whole work anew. Rings are made when they are
//! asked for, so every row asks for all of them: it evaluates the middle of every quad and every
//! extraordinary point.

use std::error::Error;
use std::sync::Arc;
use std::time::{Duration, Instant};

use evenlight::mesh::{Interpolation, Primvar};
use evenlight::task::Task;
use evenlight::{Cage, Mesh, QuadId, SchemeKind, Surface, SurfaceOptions};

/// Runs of every row.
const RUNS: usize = 15;

/// Measures poses and primvars of a mesh.
pub fn run(name: &str, mesh: &Mesh) -> Result<(), Box<dyn Error>> {
    Task::new().threads(1).run(|| measure(name, mesh))
}

fn measure(name: &str, mesh: &Mesh) -> Result<(), Box<dyn Error>> {
    let options = SurfaceOptions { scheme: SchemeKind::Qas4, ..SurfaceOptions::default() };
    let mut mesh = mesh.clone();
    mesh.primvars =
        [Interpolation::Vertex, Interpolation::FaceVarying].map(|i| four(&mesh, i)).into();
    let cage = Arc::new(Cage::new(mesh.clone())?);
    let surface = Surface::build(cage.clone(), options)?;
    let points = surface.extraordinary_points().len();
    println!("{name}: {} faces, {points} extraordinary points, one thread", cage.num_faces());
    let positions = cage.positions().to_vec();
    let mut best = [Duration::MAX; 6];
    for _ in 0..RUNS {
        let mut turn = |row: usize, work: &mut dyn FnMut()| {
            let clock = Instant::now();
            work();
            best[row] = best[row].min(clock.elapsed());
        };
        turn(0, &mut || drop(std::hint::black_box(Cage::new(mesh.clone()))));
        turn(1, &mut || make_rings(&Surface::build(cage.clone(), options).expect("it was built")));
        turn(2, &mut || make_rings(&surface.with_positions(positions.clone()).expect("they fit")));
        let fresh = Surface::build(cage.clone(), options)?;
        turn(3, &mut || evaluate(&fresh));
        turn(4, &mut || evaluate_primvar(&fresh, 0));
        turn(5, &mut || evaluate_primvar(&fresh, 1));
    }
    let [check, build, pose, first, vertex, corner] = best.map(|d| d.as_secs_f64() * 1e3);
    println!("  check the cage                               {check:9.2} ms");
    println!("  build from the cage, with all first rings    {build:9.2} ms");
    println!(
        "  new positions, same layout, with all rings   {pose:9.2} ms  ({:.1} times less)",
        build / pose
    );
    println!("  first evaluation of positions                {first:9.2} ms");
    println!(
        "  first evaluation of 4 numbers per vertex     {vertex:9.2} ms  ({:.2} times)",
        vertex / first
    );
    println!(
        "  first evaluation of 4 numbers per corner     {corner:9.2} ms  ({:.2} times; {:.2} with the layout that positions have)",
        corner / first,
        corner / (first + build)
    );
    Ok(())
}

/// Four numbers for every vertex, joined at all corners.
fn four(mesh: &Mesh, interpolation: Interpolation) -> Primvar {
    let values = mesh.positions.iter().flat_map(|&[x, y, z]| [x, y, z, x + y]).collect();
    let corners = mesh.faces.all_corners().iter().map(|v| v.0);
    let is_face_varying = interpolation == Interpolation::FaceVarying;
    let indices = if is_face_varying { corners.collect() } else { Vec::new() };
    Primvar { name: format!("{interpolation:?}"), interpolation, width: 4, values, indices }
}

/// Asks for the rings of all points, which makes their first nets.
fn make_rings(surface: &Surface) {
    for point in 0..surface.extraordinary_points().len() {
        std::hint::black_box(surface.rings(point));
    }
}

/// Evaluates the middle of every quad with second derivatives.
fn evaluate(surface: &Surface) {
    for quad in (0..surface.num_quads() as u32).map(QuadId) {
        std::hint::black_box(surface.eval_second(quad, 0.5, 0.5));
    }
}

fn evaluate_primvar(surface: &Surface, primvar: usize) {
    for quad in (0..surface.num_quads() as u32).map(QuadId) {
        std::hint::black_box(surface.eval_primvar::<4>(primvar, quad, 0.5, 0.5));
    }
}
