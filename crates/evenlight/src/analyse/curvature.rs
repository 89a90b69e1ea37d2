//! The curvature report: how curvature behaves on the way to every extraordinary point.
//!
//! For each ring of patches around a point the ranges of Gauss curvature K and mean curvature H
//! are taken over a grid on every patch, its borders included. On a fair surface the ranges of
//! successive rings shrink or stay; pinched highlight lines show as ranges that grow from ring
//! to ring (Catmull-Clark's grow without bound).

use super::continuity::{Jumps, continuity};
use crate::complex::ComplexError;
use crate::patch::SurfacePoint;
use crate::surface::{PatchPlace, Role, Surface};

/// Grid points along each side of a patch, ends included.
const GRID: usize = 9;

/// Border points per side at which jumps are measured.
const BORDER_SAMPLES: usize = 5;

/// The least and the largest value of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The least value.
    pub min: f64,
    /// The largest value.
    pub max: f64,
}

impl Range {
    /// The range of no value.
    pub const EMPTY: Self = Self { min: f64::INFINITY, max: f64::NEG_INFINITY };

    /// The range with one more value; NaN (a degenerate patch corner) is passed over.
    pub fn with(self, value: f64) -> Self {
        Self { min: self.min.min(value), max: self.max.max(value) }
    }

    /// The smallest range that contains both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The length of the range.
    pub fn length(self) -> f64 {
        self.max - self.min
    }
}

/// The curvature ranges of one ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingCurvature {
    /// Gauss curvature K, in 1/unit^2.
    pub gauss: Range,
    /// Mean curvature H, in 1/unit.
    pub mean: Range,
}

/// What is reported for one extraordinary point.
#[derive(Clone, Debug, PartialEq)]
pub struct PointReport {
    /// The index into [`Surface::extraordinary_points`].
    pub point: usize,
    /// The rings from the outermost inwards.
    pub rings: Vec<RingCurvature>,
    /// The ranges over all these rings.
    pub total: RingCurvature,
    /// The largest jump of H across a border between two rings, in 1/unit. The schemes join
    /// their rings C2, so this is rounding.
    pub mean_jump_across_rings: f64,
    /// The largest jumps across the borders of all patches of the point.
    pub jumps: Jumps,
}

/// The curvature report of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvatureReport {
    /// One report per extraordinary point.
    pub points: Vec<PointReport>,
    /// The largest jumps across all patch borders of the surface.
    pub jumps: Jumps,
}

/// Measures curvature over rings 1 to `rings` of every extraordinary point, and the jumps across
/// all patch borders.
///
/// Sectors in omitted faces do not count. Takes 81 evaluations per patch.
///
/// # Errors
///
/// As of [`continuity`].
pub fn curvature_report(surface: &Surface, rings: usize) -> Result<CurvatureReport, ComplexError> {
    let continuity = continuity(surface, rings, BORDER_SAMPLES)?;
    let empty = RingCurvature { gauss: Range::EMPTY, mean: Range::EMPTY };
    let mut points: Vec<PointReport> = (0..surface.extraordinary_points().len())
        .map(|point| PointReport {
            point,
            rings: vec![empty; rings],
            total: empty,
            mean_jump_across_rings: continuity.mean_jumps_across_rings[point],
            jumps: continuity.points[point],
        })
        .collect();
    for place in surface.patch_places(rings) {
        if let (Some(point), Role::Ring(ring)) = (place.point, place.role) {
            let report = &mut points[point];
            let found = curvature_over(surface, &place);
            report.rings[ring] = union(report.rings[ring], found);
            report.total = union(report.total, found);
        }
    }
    Ok(CurvatureReport { points, jumps: continuity.all })
}

fn union(a: RingCurvature, b: RingCurvature) -> RingCurvature {
    RingCurvature { gauss: a.gauss.union(b.gauss), mean: a.mean.union(b.mean) }
}

/// The curvature ranges of one patch.
pub fn curvature_over(surface: &Surface, place: &PatchPlace) -> RingCurvature {
    let [[u0, u1], [v0, v1]] = place.domain;
    let at = |a: f64, b: f64, k: usize| a + (b - a) * k as f64 / (GRID - 1) as f64;
    let mut found = RingCurvature { gauss: Range::EMPTY, mean: Range::EMPTY };
    for i in 0..GRID {
        for j in 0..GRID {
            let p: SurfacePoint = surface.answer_on(place, [at(u0, u1, i), at(v0, v1, j)]);
            found.gauss = found.gauss.with(p.gauss);
            found.mean = found.mean.with(p.mean);
        }
    }
    found
}
