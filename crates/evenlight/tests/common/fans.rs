//! Rough sheets around a vertex, with sharp edges.

use evenlight::mesh::Crease;
use evenlight::{Mesh, VertexId};

use super::Random;

/// A rough sheet of m x n quads, counter-clockwise seen from above.
pub fn sheet(m: u32, n: u32, random: &mut Random) -> Mesh {
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

/// Quads around a vertex of valence n, closed, with one more ring.
pub fn fan_sheet(n: u32, random: &mut Random) -> Mesh {
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

/// A fan sheet with infinitely sharp edges from the centre along these lines to the border.
pub fn starred(n: u32, lines: &[u32], seed: u64) -> Mesh {
    let mut mesh = fan_sheet(n, &mut Random::new(seed));
    for s in lines {
        // The vertices along a line.
        let along = [0, 1, 2, 3].map(|r| if r == 0 { 0 } else { 1 + n * r * (r - 1) + 2 * r * s });
        for edge in along.windows(2) {
            let edge = [edge[0], edge[1]].map(VertexId);
            mesh.tags.creases.push(Crease { edge, sharpness: 10.0 });
        }
    }
    mesh
}
