//! Boundaries, creases, corners: the surface is the limit of refinement by the published rules.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its cage fails")]

mod common;

use std::sync::Arc;

use common::Random;
use common::refine::refine;
use evenlight::mesh::{BoundaryRule, Corner, Crease, CreaseMethod, Tags};
use evenlight::point::{norm, sub};
use evenlight::{Cage, FaceId, Mesh, SchemeKind, Surface, VertexId};

/// A rough sheet of m x n quads, counter-clockwise seen from above.
fn sheet(m: u32, n: u32, random: &mut Random) -> Mesh {
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let positions = (0..=m).flat_map(|i| (0..=n).map(move |j| (i, j)));
    let positions: Vec<_> = positions
        .map(|(i, j)| [f64::from(i), f64::from(j), 0.0].map(|x| x + 0.6 * (random.unit() - 0.5)))
        .collect();
    let cells = (0..m).flat_map(|i| (0..n).map(move |j| (i, j)));
    Mesh::new(
        positions,
        cells.map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]),
    )
}

fn surface(mesh: &Mesh, scheme: SchemeKind) -> Surface {
    Surface::build(Cage::new(mesh.clone()).unwrap(), common::options(scheme)).unwrap()
}

/// The child of a quad in which (u,v) lies, and where in it.
fn child(u: f64, v: f64) -> (u32, f64, f64) {
    let (x, y) = (2.0 * u, 2.0 * v);
    match (x > 1.0, y > 1.0) {
        (false, false) => (0, x, y),
        (true, false) => (1, x - 1.0, y),
        (true, true) => (2, x - 1.0, y - 1.0),
        (false, true) => (3, x, y - 1.0),
    }
}

/// The surface of a mesh of quads is that of the mesh refined, at random points and corners.
fn is_surface_of_refined(mesh: &Mesh, levels: usize, random: &mut Random, name: &str) {
    let coarse = surface(mesh, SchemeKind::CatmullClark);
    let mut fine_mesh = mesh.clone();
    for _ in 0..levels {
        fine_mesh = refine(&fine_mesh);
    }
    let fine = surface(&fine_mesh, SchemeKind::CatmullClark);
    for face in mesh.faces.ids() {
        for _ in 0..8 {
            // Half of the points near a corner or a border.
            let near = |x: f64| if x < 0.5 { 0.06 * x } else { x };
            let [mut u, mut v] = [random.unit(), random.unit()].map(near);
            let (quad, at) = (coarse.quad(face, 0).unwrap(), [u, v]);
            let mut f = face.0;
            for _ in 0..levels {
                let (k, x, y) = child(u, v);
                (f, u, v) = (4 * f + k, x, y);
            }
            let a = coarse.eval(quad, at[0], at[1]);
            let b = fine.eval(fine.quad(FaceId(f), 0).unwrap(), u, v);
            let (Some(a), Some(b)) = (a, b) else {
                assert!(a.is_none() && b.is_none(), "{name}");
                continue;
            };
            let gap = norm(sub(a.jet.p, b.jet.p));
            assert!(gap < 1e-12, "{name}: face {} at {at:?}: {gap:e}", face.0);
            let scale = f64::from(1 << levels);
            let first = norm(sub(a.jet.du, b.jet.du.map(|x| x * scale)));
            let size = 1.0 + norm(a.jet.du);
            assert!(a.jet.du[0].is_nan() || first < 1e-10 * size, "{name}: du {first:e}");
        }
    }
}

#[test]
fn boundaries_of_a_sheet_by_every_rule() {
    let mut random = Random::new(1);
    for boundary in [BoundaryRule::None, BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner] {
        for (m, n) in [(1, 1), (1, 3), (2, 2), (3, 4)] {
            let mut mesh = sheet(m, n, &mut random);
            mesh.tags.boundary = boundary;
            if boundary == BoundaryRule::None {
                continue;
            }
            is_surface_of_refined(&mesh, 3, &mut random, &format!("{boundary:?} {m} x {n}"));
        }
    }
}

fn random_tags(mesh: &Mesh, random: &mut Random) -> Tags {
    let values = [0.25, 0.5, 1.0, 1.75, 2.5, 3.0, 10.0, 10.0, f64::INFINITY];
    let mut tags = Tags::default();
    if random.below(2) == 0 {
        tags.crease_method = CreaseMethod::Chaikin;
    }
    if random.below(3) == 0 {
        tags.boundary = BoundaryRule::EdgeOnly;
    }
    let only_hard = random.below(3) == 0;
    let mut value = || if only_hard { 10.0 } else { values[random.below(values.len())] };
    let mut random2 = Random::new((value() * 64.0) as u64 + mesh.positions.len() as u64);
    for face in mesh.faces.iter() {
        for k in 0..face.len() {
            if random2.below(5) == 0 {
                let edge = [face[k], face[(k + 1) % face.len()]];
                tags.creases.push(Crease { edge, sharpness: value() });
            }
            if random2.below(16) == 0 {
                tags.corners.push(Corner { vertex: face[k], sharpness: value() });
            }
        }
    }
    tags
}

/// Quads around a vertex of valence n, closed, with one more ring.
fn fan_sheet(n: u32, random: &mut Random) -> Mesh {
    let mut positions = vec![[0.0, 0.0, 0.5]];
    for r in 1..=3 {
        for k in 0..2 * n * r {
            let t = std::f64::consts::TAU * f64::from(k) / f64::from(2 * n * r);
            let r = f64::from(r);
            positions.push([r * t.cos(), r * t.sin(), 0.4 * random.unit()]);
        }
    }
    // Ring r has 2 n r vertices, the corners of the sectors at multiples of 2 r; grid of a sector.
    let at = |s: u32, a: u32, b: u32| -> u32 {
        let r = a.max(b);
        if r == 0 {
            return 0;
        }
        let first = 1 + n * r * (r - 1);
        let along = if a == r { b } else { 2 * r - a };
        first + (2 * r * s + along) % (2 * n * r)
    };
    let mut faces = Vec::new();
    for s in 0..n {
        for a in 0..3 {
            for b in 0..3 {
                faces.push([at(s, a, b), at(s, a + 1, b), at(s, a + 1, b + 1), at(s, a, b + 1)]);
            }
        }
    }
    Mesh::new(positions, faces)
}

#[test]
fn the_rings_of_a_fan_sheet_are_numbered_as_meant() {
    for n in 3..7 {
        let mesh = fan_sheet(n, &mut Random::new(3));
        let cage = Cage::new(mesh).unwrap();
        assert_eq!(cage.num_components(), 1);
        assert_eq!(cage.num_boundary_edges(), 6 * n as usize);
    }
}

#[test]
fn every_rule_at_random() {
    for seed in 0..60 {
        let mut random = Random::new(100 + seed);
        let mut mesh = match seed % 3 {
            0 => sheet(3, 3, &mut random),
            1 => fan_sheet(3 + (seed as u32 / 3) % 5, &mut random),
            _ => common::torus(4, 4),
        };
        mesh.tags = random_tags(&mesh, &mut random);
        is_surface_of_refined(&mesh, 3, &mut random, &format!("seed {seed}: {:?}", mesh.tags));
    }
}

#[test]
fn shared_use() {
    let _ = Arc::new(0);
    let _ = VertexId(0);
}
