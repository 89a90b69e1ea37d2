//! How well caps join: the jumps of position, tangent plane and curvature across all their borders,
//! and whether their curvature stays within what the rings in front have.
//!
//! ```text
//!   +-------+-------+
//!   |       |       |     lines    between sectors, and all that meet at the centre
//!   |       | ring K|     inside   between the patches of one sector
//!   +---+---+       |     ring     to the last ring, or to the surface around if there is none
//!   |   |   |       |
//!   +---+---+       |     Tangent planes agree exactly across all of them but for bi-3 caps, whose
//!   |   |   |       |     lines they cross with a small angle; curvature jumps a little across
//!   +---+---+-------+     lines and to the ring.
//! ```
//!
//! Around fans between sharp edges the lines that count are those inside; across the line of a dart
//! only the position does. Where the point has no tangent plane they meet in an angle.

use super::curvature::{Range, RingCurvature, curvature_over};
use super::defect::Defect;
use crate::cap::{Cap, FanLines};
use crate::patch::SurfacePoint;
use crate::point::{norm, sub};
use crate::rings::Rings;
use crate::surface::{PatchPlace, Role, Surface};
use crate::task::map_indexed;

/// Samples along the side of a patch.
const SAMPLES: usize = 16;

/// A cap counts as flat if its curvature times its extent is below this (see
/// [`shape`](super::shape)): its curvature is noise then.
const FLAT: f64 = 1e-7;

/// What is measured of the cap of one extraordinary point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CapReport {
    /// The index into [`Surface::extraordinary_points`].
    pub point: usize,
    /// The rings in front of the cap.
    pub rings: usize,
    /// The degree of its patches in both parameters.
    pub degree: usize,
    /// So many patches stand along each side of a sector.
    pub split: usize,
    /// Across the lines between sectors. Of these three, jumps of curvature are a part of the
    /// [`scale`](Self::scale); 0 for flat caps.
    pub lines: Defect,
    /// Across the borders between the patches of a sector.
    pub inside: Defect,
    /// Across the border to the last ring, or to the surface around.
    pub ring: Defect,
    /// The ranges of K and H over the cap.
    pub curvature: RingCurvature,
    /// Those over the last two rings in front of it (the only one, if there is one).
    pub before: Option<RingCurvature>,
    /// The largest absolute principal curvature of the cap, in 1/unit; 0 for flat caps.
    pub scale: f64,
}

impl CapReport {
    /// How far H of the cap leaves the range that it has over the last two rings, as a part of the
    /// curvature [`scale`](Self::scale); 0 if it stays within, `None` without rings.
    pub fn excess(&self) -> Option<f64> {
        let (own, before) = (self.curvature.mean, self.before?.mean);
        let outside = (own.max - before.max).max(before.min - own.min).max(0.0);
        Some(if self.scale == 0.0 { 0.0 } else { outside / self.scale })
    }
}

/// Measures the caps of a closed surface, one report for each point with a cap; none if the surface
/// is not closed.
pub fn cap_report(surface: &Surface) -> Vec<CapReport> {
    let Some(options) = surface.cap_options() else { return Vec::new() };
    let mut places: Vec<Vec<PatchPlace>> = vec![Vec::new(); surface.extraordinary_points().len()];
    for place in surface.patch_places(options.rings) {
        if let Some(point) = place.point {
            places[point].push(place);
        }
    }
    let report =
        |point: usize| surface.cap(point).map(|cap| report_of(surface, point, cap, &places[point]));
    map_indexed(places.len(), report).into_iter().flatten().collect()
}

fn report_of(surface: &Surface, point: usize, cap: &Cap, places: &[PatchPlace]) -> CapReport {
    let around = Around { rings: surface.rings_at(point), cap };
    let over = |wanted: &dyn Fn(Role) -> bool| {
        let mut found = RingCurvature { gauss: Range::EMPTY, mean: Range::EMPTY };
        for place in places.iter().filter(|place| wanted(place.role)) {
            let own = curvature_over(surface, place);
            found.gauss = found.gauss.union(own.gauss);
            found.mean = found.mean.union(own.mean);
        }
        found
    };
    let last_two = |role: Role| matches!(role, Role::Ring(k) if k + 2 >= cap.rings());
    let scale = around.scale();
    let relative = |defect: Defect| Defect {
        curvature: if scale == 0.0 { 0.0 } else { defect.curvature / scale },
        ..defect
    };
    CapReport {
        point,
        rings: cap.rings(),
        degree: cap.degree(),
        split: cap.split(),
        lines: relative(around.lines()),
        inside: relative(around.inside()),
        ring: relative(around.ring()),
        curvature: over(&|role| role == Role::Cap),
        before: (cap.rings() > 0).then(|| over(&last_two)),
        scale,
    }
}

/// A cap and the rings around it.
#[derive(Clone, Copy)]
struct Around<'a> {
    rings: &'a Rings,
    cap: &'a Cap,
}

impl Around<'_> {
    fn sectors(self) -> impl Iterator<Item = usize> {
        0..self.rings.valence()
    }

    /// Points inside the sides of patches along a line.
    fn along(self) -> impl Iterator<Item = f64> + Clone {
        let count = self.cap.split() * SAMPLES;
        (0..count).map(move |k| (k as f64 + 0.5) / count as f64)
    }

    fn eval(self, s: usize, a: f64, b: f64) -> SurfacePoint {
        self.cap.eval_as(self.rings, s, [a, b])
    }

    /// The largest absolute principal curvature; 0 where it is noise.
    fn scale(self) -> f64 {
        let (mut largest, mut extent) = (0.0_f64, 0.0_f64);
        for s in self.sectors() {
            let coarse = || self.along().step_by(4);
            for (a, b) in coarse().flat_map(|a| coarse().map(move |b| (a, b))) {
                let p = self.eval(s, a, b);
                let [k1, k2] = p.principal_curvatures();
                largest = largest.max(k1.abs()).max(k2.abs());
                extent = extent.max(norm(sub(p.jet.p, self.rings.center())));
            }
        }
        if largest * extent >= FLAT { largest } else { 0.0 }
    }

    fn lines(self) -> Defect {
        let lines = FanLines::of(self.rings.rules());
        let at = |s: usize, u: f64| {
            Defect::between(&self.eval(s, u, 0.0), &self.eval(lines.behind(s), 0.0, u))
        };
        let smooth = lines.smooth().flat_map(|s| self.along().map(move |u| at(s, u)));
        let dart = lines.dart().into_iter().flat_map(|s| {
            self.along().map(move |u| Defect { position: at(s, u).position, ..Defect::default() })
        });
        largest(smooth.chain(dart))
    }

    fn inside(self) -> Defect {
        let m = self.cap.split();
        let joints = (1..m).flat_map(|joint| self.along().map(move |t| (joint, t)));
        let at = |s: usize, (joint, t): (usize, f64)| {
            let along = ((t * m as f64) as usize).min(m - 1);
            let x = joint as f64 / m as f64;
            let eval = |which, at| self.cap.eval_in_patch(self.rings, s, which, at);
            let across_a = [joint - 1, joint].map(|k| eval(k * m + along, [x, t]));
            let across_b = [joint - 1, joint].map(|k| eval(along * m + k, [t, x]));
            [across_a, across_b].map(|[p, q]| Defect::between(&p, &q))
        };
        largest(self.sectors().flat_map(|s| joints.clone().flat_map(move |joint| at(s, joint))))
    }

    /// Against the ring that would come next, which joins the last one with second derivatives.
    fn ring(self) -> Defect {
        let at = |s: usize, hole: [f64; 2]| {
            let [a, b] = self.rings.out_of_hole(self.cap.rings(), hole);
            Defect::between(&self.eval(s, hole[0], hole[1]), &self.rings.eval_as(s, a, b))
        };
        let edges = |t: f64| [[1.0, t], [t, 1.0]];
        let points = self.along().flat_map(edges).collect::<Vec<_>>();
        largest(self.sectors().flat_map(|s| points.iter().map(move |&hole| at(s, hole))))
    }
}

fn largest(defects: impl Iterator<Item = Defect>) -> Defect {
    defects.fold(Defect::default(), Defect::max)
}
