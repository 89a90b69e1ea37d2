//! What the surface says at the vertices: grids of whole quads at once.

use super::VertexOrigin;
use crate::parallel::map_indexed;
use crate::patch::{Answer, Jet, Parts, Shape};
use crate::point::{Point, Vector};
use crate::surface::Surface;

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

/// The samples at `origins`, in their order but in several pieces.
pub(super) fn samples(surface: &Surface, origins: &[VertexOrigin]) -> Vec<Vec<Sample>> {
    /// So many origins for a thread at a time: a few dozen quads.
    const PIECE: usize = 4096;
    let pieces: Vec<&[VertexOrigin]> = origins.chunks(PIECE).collect();
    map_indexed(pieces.len(), |k| {
        let runs = pieces[k].chunk_by(|a, b| a.quad == b.quad);
        runs.flat_map(|run| samples_of_quad(surface, run)).collect()
    })
}

/// The samples at places of one quad, by way of a grid if they fill one.
fn samples_of_quad(surface: &Surface, run: &[VertexOrigin]) -> Vec<Sample> {
    let [us, vs] = [0, 1].map(|k| {
        let mut all: Vec<f64> = run.iter().map(|origin| origin.uv[k]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    });
    let quad = run[0].quad;
    if us.len() * vs.len() > 2 * run.len() {
        let alone = |origin: &VertexOrigin| surface.eval_as(quad, origin.uv[0], origin.uv[1]);
        return run.iter().map(|origin| alone(origin).unwrap_or(Sample::NAN)).collect();
    }
    let mut grid = vec![Sample::NAN; us.len() * vs.len()];
    surface.eval_grid(quad, &us, &vs, &mut grid);
    let number = |all: &[f64], x: f64| all.partition_point(|&y| y < x);
    let node = |[u, v]: [f64; 2]| number(&us, u) + number(&vs, v) * us.len();
    run.iter().map(|origin| grid[node(origin.uv)]).collect()
}
