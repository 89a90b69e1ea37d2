//! Which point of the surface is seen at every sample of a tile.
//!
//! The triangles of the cells go through a depth buffer, which gives the nearest cell and
//! approximate (u,v) at every sample. Newton's method then moves (u,v) until the exact surface
//! point projects on the sample, so that what is shown there is the surface and not the
//! triangle.

use super::camera::Camera;
use super::dice::{Cell, GAP};
use crate::patch::SurfacePoint;
use crate::surface::{QuadId, Surface};

/// Points that project within this distance of the sample (in pixels) are exact enough.
const CLOSE: f64 = 0.01;

/// The most steps of Newton's method; it starts within a fraction of a pixel.
const STEPS: usize = 4;

/// A rectangle of pixels, each with `rate` x `rate` samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tile {
    /// The first column and row.
    pub origin: [usize; 2],
    /// The number of columns and rows.
    pub size: [usize; 2],
    /// Samples per pixel in either direction.
    pub rate: usize,
}

/// What the depth buffer knows at a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    quad: QuadId,
    uv: [f64; 2],
    depth: f64,
}

/// A visible point of the surface.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    /// The parametric quad.
    pub quad: QuadId,
    /// The parameters in it.
    pub uv: [f64; 2],
    /// What the surface answers there.
    pub point: SurfacePoint,
}

impl Tile {
    /// The number of samples in a row and in a column.
    fn samples(&self) -> [usize; 2] {
        self.size.map(|n| n * self.rate)
    }

    /// Column and row of sample number `index` of the tile.
    fn place(&self, index: usize) -> [usize; 2] {
        let columns = self.samples()[0];
        [index % columns, index / columns]
    }

    /// Where sample number `index` of the tile lies in the panel, in pixels.
    pub fn position(&self, index: usize) -> [f64; 2] {
        let place = self.place(index);
        std::array::from_fn(|k| self.origin[k] as f64 + (place[k] as f64 + 0.5) / self.rate as f64)
    }

    /// The pixel of sample number `index`, as column and row of the tile.
    pub fn pixel(&self, index: usize) -> [usize; 2] {
        self.place(index).map(|k| k / self.rate)
    }

    /// The samples between `low` and `high` (pixels) in direction `k`.
    fn range(&self, k: usize, low: f64, high: f64) -> std::ops::Range<usize> {
        let index = |x: f64| (x - self.origin[k] as f64) * self.rate as f64 - 0.5;
        let count = self.samples()[k] as f64;
        let (first, last) =
            (index(low).ceil().clamp(0.0, count), index(high).floor().clamp(-1.0, count - 1.0));
        first as usize..(last + 1.0) as usize
    }

    /// The nearest cell at every sample, row by row.
    pub fn nearest<'a>(&self, cells: impl Iterator<Item = &'a Cell>) -> Vec<Option<Candidate>> {
        let [columns, rows] = self.samples();
        let mut buffer = vec![None; columns * rows];
        for cell in cells {
            for triangle in triangles(cell) {
                self.cover(&mut buffer, cell.quad, &triangle);
            }
        }
        buffer
    }

    /// Enters a triangle into the depth buffer.
    fn cover(&self, buffer: &mut [Option<Candidate>], quad: QuadId, triangle: &Triangle) {
        let [low, high] = triangle.bounds();
        let columns = self.range(0, low[0], high[0]);
        for row in self.range(1, low[1], high[1]) {
            for index in columns.clone().map(|column| row * self.samples()[0] + column) {
                let Some(weights) = triangle.weights(self.position(index)) else { continue };
                let candidate = triangle.candidate(quad, weights);
                let entry = &mut buffer[index];
                if entry.is_none_or(|other| candidate.depth > other.depth) {
                    *entry = Some(candidate);
                }
            }
        }
    }
}

/// A corner of a triangle: projected position, and parameters in the quad.
type DicedCorner = ([f64; 3], [f64; 2]);

/// A triangle of a cell, prepared for questions about samples.
struct Triangle {
    corners: [DicedCorner; 3],
    /// 1 / twice the signed area in the picture.
    per_area: f64,
    /// By how much a weight may be negative and the sample still count as covered.
    slack: [f64; 3],
}

/// The eight triangles of a cell; those seen exactly edge-on are left out.
fn triangles(cell: &Cell) -> impl Iterator<Item = Triangle> + '_ {
    let corner = |i: usize, j: usize| -> DicedCorner {
        (cell.points[i][j], cell.parameters([i as f64, j as f64]))
    };
    let quarters = [(0, 0), (1, 0), (0, 1), (1, 1)];
    quarters.into_iter().flat_map(move |(i, j)| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [Triangle::new([a, b, c]), Triangle::new([a, c, d])].into_iter().flatten()
    })
}

impl Triangle {
    fn new(corners: [DicedCorner; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|(p, _)| [p[0], p[1]]);
        let per_area = 1.0 / turn(a, b, c);
        let length = |p: [f64; 2], q: [f64; 2]| length([q[0] - p[0], q[1] - p[1]]);
        // The weight of a corner is the distance from the opposite edge over the height.
        let slack =
            [length(b, c), length(c, a), length(a, b)].map(|edge| GAP * edge * per_area.abs());
        per_area.is_finite().then_some(Self { corners, per_area, slack })
    }

    /// The box of the triangle in the picture, wider by [`GAP`].
    fn bounds(&self) -> [[f64; 2]; 2] {
        let along = |k: usize| self.corners.map(|(p, _)| p[k]);
        let low = |k: usize| along(k).into_iter().fold(f64::INFINITY, f64::min) - GAP;
        let high = |k: usize| along(k).into_iter().fold(f64::NEG_INFINITY, f64::max) + GAP;
        [[low(0), low(1)], [high(0), high(1)]]
    }

    /// The barycentric weights of the point of the triangle next to `at`, `None` if `at` is
    /// further than [`GAP`] from it.
    fn weights(&self, at: [f64; 2]) -> Option<[f64; 3]> {
        let [a, b, c] = self.corners.map(|(p, _)| [p[0], p[1]]);
        let w = [turn(b, c, at), turn(c, a, at), turn(a, b, at)].map(|area| area * self.per_area);
        if (0..3).any(|k| w[k] < -self.slack[k]) {
            return None;
        }
        let w = w.map(|w| w.max(0.0));
        let sum: f64 = w.iter().sum();
        Some(w.map(|w| w / sum))
    }

    fn candidate(&self, quad: QuadId, weights: [f64; 3]) -> Candidate {
        let mut sum = ([0.0; 2], 0.0);
        for (w, (p, uv)) in weights.iter().zip(self.corners) {
            sum.0 = [sum.0[0] + w * uv[0], sum.0[1] + w * uv[1]];
            sum.1 += w * p[2];
        }
        Candidate { quad, uv: sum.0, depth: sum.1 }
    }
}

/// Twice the signed area of the triangle a b c.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The length of a step in the picture. (`hypot`, which also takes care of overflow, is slower and
/// does not round alike everywhere.)
pub(super) fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// The point of the surface near `candidate` that projects on `at`, or the closest one found
/// in the quad; `None` if the surface answers nothing there.
pub(super) fn locate(
    surface: &Surface,
    camera: &Camera,
    candidate: &Candidate,
    at: [f64; 2],
) -> Option<Seen> {
    let Candidate { quad, mut uv, .. } = *candidate;
    let mut best: Option<(f64, Seen)> = None;
    for _ in 0..STEPS {
        let point = surface.eval(quad, uv[0], uv[1])?;
        let p = camera.project(point.jet.p);
        let missing = [at[0] - p[0], at[1] - p[1]];
        let distance = length(missing);
        if best.as_ref().is_some_and(|(least, _)| *least <= distance) {
            break;
        }
        best = Some((distance, Seen { quad, uv, point }));
        let Some(step) = (distance > CLOSE).then(|| newton_step(camera, &point, missing)).flatten()
        else {
            break;
        };
        uv = std::array::from_fn(|k| (uv[k] + step[k]).clamp(0.0, 1.0));
    }
    best.map(|(_, seen)| seen.with_finite_answers(surface))
}

/// The step in (u,v) that moves the projection by `missing` pixels to first order.
fn newton_step(camera: &Camera, point: &SurfacePoint, missing: [f64; 2]) -> Option<[f64; 2]> {
    let [gradient_u, gradient_v] = parameter_gradients(camera, point)?;
    let along = |g: [f64; 2]| g[0] * missing[0] + g[1] * missing[1];
    Some([along(gradient_u), along(gradient_v)])
}

/// How u and v change per pixel to the right and per pixel downwards; `None` where the surface
/// is seen edge-on or has no tangent plane.
pub(super) fn parameter_gradients(camera: &Camera, point: &SurfacePoint) -> Option<[[f64; 2]; 2]> {
    let [xu, yu, _] = camera.turned_to_pixels(point.jet.du);
    let [xv, yv, _] = camera.turned_to_pixels(point.jet.dv);
    let det = xu * yv - xv * yu;
    let gradients = [[yv / det, -xv / det], [-yu / det, xu / det]];
    gradients.as_flattened().iter().all(|x| x.is_finite()).then_some(gradients)
}

impl Seen {
    /// At an extraordinary point itself there are no derivatives: then the answers are those of
    /// a point close by, if there they are defined.
    fn with_finite_answers(self, surface: &Surface) -> Self {
        if has_curvature(&self.point) {
            return self;
        }
        let mut nearby = [1e-12, 1e-6].iter().filter_map(|&step| {
            let uv = self.uv.map(|t| t + step * (0.5 - t));
            Some((uv, surface.eval(self.quad, uv[0], uv[1])?))
        });
        match nearby.find(|(_, point)| has_curvature(point)) {
            Some((uv, point)) => Self { uv, point, ..self },
            None => self,
        }
    }
}

/// Whether derivatives and curvature at `point` are defined.
fn has_curvature(point: &SurfacePoint) -> bool {
    let derivatives = point.jet.du.iter().chain(&point.jet.dv);
    derivatives.chain([&point.gauss, &point.mean]).all(|x| x.is_finite())
}
