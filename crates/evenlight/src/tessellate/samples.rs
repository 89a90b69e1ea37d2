//! What the surface says at the vertices: grids of whole quads at once.

use super::VertexOrigin;
use crate::patch::{Answer, Jet, Parts, Shape};
use crate::point::{Point, Vector};
use crate::surface::Surface;
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

/// The samples at `origins`, which are nodes of grids with `rate` segments along every edge of the
/// cage, in their order but in several pieces.
pub(super) fn samples(
    surface: &Surface,
    rate: usize,
    origins: &[VertexOrigin],
) -> Vec<Vec<Sample>> {
    /// So many origins for a thread at a time: a few dozen quads.
    const PIECE: usize = 4096;
    let pieces: Vec<&[VertexOrigin]> = origins.chunks(PIECE).collect();
    map_indexed(pieces.len(), |k| {
        let mut samples = Vec::with_capacity(pieces[k].len());
        for run in pieces[k].chunk_by(|a, b| a.quad == b.quad) {
            add_samples_of_quad(surface, rate, run, &mut samples);
        }
        samples
    })
}

/// The samples at nodes of one quad, by way of the rectangle of nodes around them if they fill it.
fn add_samples_of_quad(
    surface: &Surface,
    rate: usize,
    run: &[VertexOrigin],
    samples: &mut Vec<Sample>,
) {
    let quad = run[0].quad;
    let corners = surface.topology().faces().corners(surface.layout().face_of_quad(quad).0);
    let segments = if corners.len() == 4 { rate } else { rate / 2 } as f64;
    // The parameters are whole numbers divided by that of the segments.
    let node = |origin: &VertexOrigin| origin.uv.map(|x| (segments * x + 0.5) as usize);
    let (mut first, mut last) = ([usize::MAX; 2], [0; 2]);
    for node in run.iter().map(node) {
        for k in 0..2 {
            first[k] = first[k].min(node[k]);
            last[k] = last[k].max(node[k]);
        }
    }
    let [columns, rows] = [0, 1].map(|k| last[k] - first[k] + 1);
    if columns * rows > 2 * run.len() {
        let alone = |origin: &VertexOrigin| surface.eval_as(quad, origin.uv[0], origin.uv[1]);
        samples.extend(run.iter().map(|origin| alone(origin).unwrap_or(Sample::NAN)));
        return;
    }
    let lines = |k: usize| -> Vec<f64> {
        (first[k]..=last[k]).map(|node| node as f64 / segments).collect()
    };
    let mut grid = vec![Sample::NAN; columns * rows];
    surface.eval_grid(quad, &lines(0), &lines(1), &mut grid);
    let place = |[i, j]: [usize; 2]| (i - first[0]) + (j - first[1]) * columns;
    samples.extend(run.iter().map(|origin| grid[place(node(origin))]));
}
