//! What the surface says at the vertices: grids of whole quads at once.

use super::VertexOrigin;
use crate::patch::{Answer, Jet, Parts, Shape};
use crate::point::{Point, Vector};
use crate::surface::{QuadId, Surface};
use crate::task::map_indexed;

/// What a mesh keeps of the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) position: Point,
    pub(super) normal: Vector,
    pub(super) gauss: f64,
    pub(super) mean: f64,
}

impl Answer for Sample {
    const NAN: Self =
        Self { position: Point::NAN, normal: Point::NAN, gauss: f64::NAN, mean: f64::NAN };
}

impl Parts for Sample {
    const ORDER: usize = 2;

    #[inline(always)]
    fn from_parts(jet: Jet, shape: impl FnOnce(&Jet) -> Shape) -> Self {
        let Shape { normal, gauss, mean } = shape(&jet);
        Self { position: jet.p, normal, gauss, mean }
    }

    #[inline(always)]
    fn in_parameters(self, _: impl FnOnce(&Jet) -> Jet) -> Self {
        self
    }
}

/// A node of the grid of a quad.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodePlace {
    pub(super) quad: QuadId,
    /// The segments along each side of the quad.
    pub(super) segments: u32,
    /// The number of the node along u and along v.
    pub(super) node: [u32; 2],
}

impl NodePlace {
    pub(super) fn origin(self) -> VertexOrigin {
        VertexOrigin { quad: self.quad, uv: self.node.map(|node| self.parameter(node)) }
    }

    fn parameter(self, node: u32) -> f64 {
        f64::from(node) / f64::from(self.segments)
    }
}

/// The samples at nodes, in their order but in several pieces.
pub(super) fn samples(surface: &Surface, places: &[NodePlace]) -> Vec<Vec<Sample>> {
    /// So many nodes for a thread at a time: a few dozen quads.
    const PIECE: usize = 4096;
    let pieces: Vec<&[NodePlace]> = places.chunks(PIECE).collect();
    map_indexed(pieces.len(), |k| {
        let mut samples = Vec::with_capacity(pieces[k].len());
        for run in pieces[k].chunk_by(|a, b| a.quad == b.quad) {
            add_samples_of_quad(surface, run, &mut samples);
        }
        samples
    })
}

/// The samples at nodes of one quad, by way of the rectangle of nodes around them if they fill it.
fn add_samples_of_quad(surface: &Surface, run: &[NodePlace], samples: &mut Vec<Sample>) {
    let quad = run[0].quad;
    let (mut first, mut last) = ([u32::MAX; 2], [0; 2]);
    for place in run {
        for k in 0..2 {
            first[k] = first[k].min(place.node[k]);
            last[k] = last[k].max(place.node[k]);
        }
    }
    let [columns, rows] = [0, 1].map(|k| (last[k] - first[k]) as usize + 1);
    if columns * rows > 2 * run.len() {
        let alone = |place: &NodePlace| {
            let [u, v] = place.origin().uv;
            surface.eval_as(quad, u, v).unwrap_or(Sample::NAN)
        };
        samples.extend(run.iter().map(alone));
        return;
    }
    let lines = |k: usize| -> Vec<f64> {
        (first[k]..=last[k]).map(|node| run[0].parameter(node)).collect()
    };
    let mut grid = vec![Sample::NAN; columns * rows];
    let all = surface.eval_grid(quad, &lines(0), &lines(1), &mut grid);
    debug_assert_eq!(all, Ok(()), "there is an answer for every pair");
    let at = |[i, j]: [u32; 2]| (i - first[0]) as usize * rows + (j - first[1]) as usize;
    samples.extend(run.iter().map(|place| grid[at(place.node)]));
}
