//! Rows of a primvar that is interpolated linearly: bilinear over every quad, and over the quads of
//! an n-gon by the middles of its edges and its centre.
//!
//! Refinement puts vertices in the middles of edges and the centres of faces, and moves none.

use std::sync::Arc;

use super::basis::{factors, product};
use super::columns::{Columns, Sums};
use crate::mesh::refine::{Level, Mask, Origin};
use crate::mesh::{FaceId, Topology, VertexId};
use crate::patch::basis::BasisJet;

/// The faces of a linear primvar, with vertices of its own.
#[derive(Debug)]
pub(super) struct LinearNet {
    pub(super) topology: Arc<Topology>,
    pub(super) columns: Columns,
}

/// 1 - t and t with their derivatives.
fn ends(t: f64) -> BasisJet<2> {
    [[1.0 - t, t], [-1.0, 1.0], [0.0, 0.0]]
}

impl LinearNet {
    /// Enters the R rows of a place of the quad at a corner of a face.
    pub(super) fn place<const R: usize>(
        &self,
        (face, corner): (FaceId, usize),
        [u, v]: [f64; 2],
        sums: &mut Sums<R>,
    ) {
        let corners = self.topology.faces().corners(face);
        let size = corners.len();
        let factors: [f64; R] = factors([1.0; 3], [1.0; 2]);
        let (bu, bv) = (ends(u), ends(v));
        // At the corners of the quad in the order of a face.
        let [here, next, opposite, before] =
            [[0, 0], [1, 0], [1, 1], [0, 1]].map(|at| product(&factors, [&bu, &bv], at));
        let mut enter = |k: usize, share: f64, w: [f64; R]| {
            self.columns.enter((0, corners[k % size]), w.map(|w| share * w), sums);
        };
        if size == 4 {
            [here, next, opposite, before]
                .into_iter()
                .enumerate()
                .for_each(|(k, w)| enter(k, 1.0, w));
            return;
        }
        enter(corner, 1.0, here);
        for (neighbour, w) in [(corner + 1, next), (corner + size - 1, before)] {
            enter(corner, 0.5, w);
            enter(neighbour, 0.5, w);
        }
        (0..size).for_each(|k| enter(k, 1.0 / size as f64, opposite));
    }
}

/// The weights of coarse vertices in a refined vertex of a linear primvar.
pub(super) fn mask(coarse: &Topology, level: &Level, v: VertexId) -> Mask {
    let mean = |of: &[VertexId]| of.iter().map(|&v| (v, 1.0 / of.len() as f64)).collect();
    let terms = match level.origin(v) {
        Origin::Vertex(v) => vec![(v, 1.0)],
        Origin::Edge(h) => mean(&[coarse.origin(h), coarse.target(h)]),
        Origin::Face(f) => mean(coarse.faces().corners(f)),
    };
    Mask { terms }
}
