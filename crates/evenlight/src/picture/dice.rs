//! Cutting the parametric quads into cells that look flat.
//!
//! A cell is a square of a parametric quad with a 3 x 3 grid of exact surface points. It is cut
//! into four until its eight triangles are within a fraction of a pixel of the surface; cells
//! outside the picture are dropped on the way:
//!
//! ```text
//!  v ^  o---o---o         o points of a cell,
//!    |  | / | / |         . points added to cut it into four
//!    |  o---o---o
//!    |  | / | / |         o . o . o
//!    |  o---o---o         . . . . .
//!    +------------> u     o . o . o   ...
//! ```
//!
//! The cells shrink towards extraordinary points, where the derivatives in (u,v) are not
//! bounded, and at any zoom only what is seen is cut finely. Along the common line of
//! neighbours of different size, gaps remain that are narrower than [`GAP`]; the rasteriser
//! covers them.

use super::camera::Camera;
use crate::point::{Vector, norm, scale, sub};
use crate::surface::{QuadId, Surface};

/// Cells whose points deviate from straight lines by less than this (in pixels) are flat. Their
/// triangles, of half the cell's width, then deviate by a quarter of it where the surface is
/// smooth and by little more than half of it at extraordinary points of high valence.
const FLAT: f64 = 0.125;

/// The width in pixels of gaps between cells that are covered.
pub(super) const GAP: f64 = 0.0625;

/// How much an error of depth counts, compared to one across the picture.
const DEPTH_WEIGHT: f64 = 0.25;

/// Cells of less than this extent (in pixels) are small enough, however deep they are.
const SMALL: f64 = 0.5;

/// Cells are never smaller than 2^-40 of a quad: beyond, (u,v) have too few digits left.
const MAX_LEVEL: u32 = 40;

/// A flat part of the surface.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    /// The parametric quad.
    pub quad: QuadId,
    /// The parameters of the cell's lower left corner.
    pub corner: [f64; 2],
    /// The length of the cell in u and in v, a power of 1/2.
    pub side: f64,
    /// Projected surface points; `points[i][j]` is i half sides along u and j along v.
    pub points: [[Vector; 3]; 3],
}

/// The flat cells of `quad` that `camera` may see, in a fixed order.
pub(super) fn dice(surface: &Surface, camera: &Camera, quad: QuadId) -> Vec<Cell> {
    let Some(whole) = Cell::whole(surface, camera, quad) else { return Vec::new() };
    let mut flat = Vec::new();
    let mut open = vec![whole];
    while let Some(cell) = open.pop() {
        let cut =
            if cell.is_outside(camera) { Some(Vec::new()) } else { cell.cut(surface, camera) };
        match cut {
            Some(parts) => open.extend(parts),
            None => flat.push(cell),
        }
    }
    flat
}

impl Cell {
    /// The whole of `quad`; `None` if there is no surface.
    fn whole(surface: &Surface, camera: &Camera, quad: QuadId) -> Option<Self> {
        let mut points = [[[0.0; 3]; 3]; 3];
        for (i, row) in points.iter_mut().enumerate() {
            for (j, point) in row.iter_mut().enumerate() {
                let at = surface.eval(quad, 0.5 * i as f64, 0.5 * j as f64)?;
                *point = camera.project(at.jet.p);
            }
        }
        Some(Self { quad, corner: [0.0; 2], side: 1.0, points })
    }

    /// The smallest box in the picture that holds the points: low and high (x, y).
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let empty = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        self.points.as_flattened().iter().fold(empty, |[low, high], p| {
            [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
        })
    }

    /// Whether the cell, with a margin for the surface between its points, is outside the
    /// panel. Cells with points that are not finite count as outside.
    fn is_outside(&self, camera: &Camera) -> bool {
        let finite = self.points.iter().flatten().flatten().all(|x| x.is_finite());
        let [low, high] = self.bounds();
        let inside = |k: usize| {
            let margin = 1.0 + 0.5 * (high[k] - low[k]);
            low[k] - margin < camera.size[k] as f64 && high[k] + margin > 0.0
        };
        !(finite && inside(0) && inside(1))
    }

    /// The four quarters, or `None` if the cell is flat.
    fn cut(&self, surface: &Surface, camera: &Camera) -> Option<Vec<Self>> {
        if self.is_flat() || self.side <= 0.5_f64.powi(MAX_LEVEL as i32) {
            return None;
        }
        let grid = self.refined(surface, camera)?;
        let quarter = |i: usize, j: usize| Self {
            quad: self.quad,
            corner: [
                self.corner[0] + 0.25 * self.side * i as f64,
                self.corner[1] + 0.25 * self.side * j as f64,
            ],
            side: 0.5 * self.side,
            points: std::array::from_fn(|di| std::array::from_fn(|dj| grid[i + di][j + dj])),
        };
        Some(vec![quarter(0, 0), quarter(2, 0), quarter(0, 2), quarter(2, 2)])
    }

    /// The points at quarters of the side; the points of the cell are taken over.
    fn refined(&self, surface: &Surface, camera: &Camera) -> Option<[[Vector; 5]; 5]> {
        let mut grid = [[[0.0; 3]; 5]; 5];
        for (i, row) in grid.iter_mut().enumerate() {
            for (j, point) in row.iter_mut().enumerate() {
                *point = if i % 2 == 0 && j % 2 == 0 {
                    self.points[i / 2][j / 2]
                } else {
                    let [u, v] = self.parameters([0.5 * i as f64, 0.5 * j as f64]);
                    camera.project(surface.eval(self.quad, u, v)?.jet.p)
                };
            }
        }
        Some(grid)
    }

    /// The parameters in the quad at `steps` half sides from the corner.
    pub fn parameters(&self, steps: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|k| self.corner[k] + 0.5 * self.side * steps[k])
    }

    /// Whether rows, columns and diagonals are straight up to [`FLAT`] or all is [`SMALL`]. Whole
    /// quads are looked at twice if they are large enough to hide something between their
    /// points.
    fn is_flat(&self) -> bool {
        let [low, high] = self.bounds();
        let extent = (high[0] - low[0]).max(high[1] - low[1]);
        let p = &self.points;
        let lines = (0..3)
            .flat_map(|k| [[p[k][0], p[k][1], p[k][2]], [p[0][k], p[1][k], p[2][k]]])
            .chain([[p[0][0], p[1][1], p[2][2]], [p[0][2], p[1][1], p[2][0]]]);
        let is_straight = lines.map(bend).fold(0.0, f64::max) < FLAT;
        extent < SMALL || (is_straight && (self.side < 1.0 || extent < 4.0))
    }
}

/// How far the middle one of three points is from the middle of the others.
fn bend([a, b, c]: [Vector; 3]) -> f64 {
    let d = scale(0.5, sub(sub(b, a), sub(c, b)));
    norm([d[0], d[1], DEPTH_WEIGHT * d[2]])
}
