//! Jumps across patch borders: of position, tangent plane and curvature, and of the derivatives
//! up to order two in matched parameters.
//!
//! Every border of every patch is sampled and compared with what lies on the other side: another
//! patch of the same parametric quad, or the neighbouring quad. Quads are unfolded over
//! their common side, so that parameters go on in straight lines:
//!
//! ```text
//!          side 2                     T along the side, N into the quad, one frame on
//!        3 <------- 2                 each side of the border:
//!        |          ^
//! side 3 |   quad   | side 1              N ^            T' <--+
//!        v          |                       |                  |
//!        0 -------> 1                       +--> T          N' v
//!          side 0
//! ```
//!
//! A surface is C2 in these parameters across all borders except at extraordinary points and
//! infinitely sharp edges, where only positions agree; those are measured apart.

use super::defect::Defect;
use crate::complex::{ComplexError, EdgePlace, PatchComplex, PatchEdge, PatchId};
use crate::mesh::FaceId;
use crate::patch::{Jet, SurfacePoint};
use crate::point::{Vector, norm, scale, sub};
use crate::surface::{PatchPlace, QuadId, Role, Surface};

/// The largest jumps over a set of border points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jumps {
    /// Of position, tangent plane and curvature, that in 1/unit.
    pub defect: Defect,
    /// Of position and derivatives up to order two in matched parameters, as a part of the size
    /// of the patch (its largest derivative over its own parameters).
    pub parametric: f64,
}

impl Jumps {
    /// The larger of each.
    pub fn max(self, other: Self) -> Self {
        Self {
            defect: self.defect.max(other.defect),
            parametric: self.parametric.max(other.parametric),
        }
    }
}

/// The jumps of every extraordinary point (over the borders of its patches) and of the whole
/// surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Continuity {
    /// Per extraordinary point, in the order of [`Surface::extraordinary_points`].
    pub points: Vec<Jumps>,
    /// Per extraordinary point the largest jump of the mean curvature between two rings, in
    /// 1/unit.
    pub mean_jumps_across_rings: Vec<f64>,
    /// Over all borders of all patches but those on infinitely sharp edges.
    pub all: Jumps,
    /// Over the borders on infinitely sharp edges: all but the position may jump there.
    pub creases: Jumps,
}

/// Samples `samples` points inside every side of every patch of the surface with `rings` rings.
///
/// The inner border of the last ring is compared with the ring behind it. Caps, which join in other
/// parameters, are left out: [`cap_report`](super::caps::cap_report) measures them. Of more rings
/// than a [`PatchComplex`] can have, so many are measured.
///
/// # Errors
///
/// [`ComplexError::TooMany`].
pub fn continuity(
    surface: &Surface,
    rings: usize,
    samples: usize,
) -> Result<Continuity, ComplexError> {
    let complex = PatchComplex::of(surface, rings.min(PatchComplex::most_rings(surface.layout())))?;
    let around = Around { surface, complex: &complex };
    let num_points = surface.extraordinary_points().len();
    let mut result = Continuity {
        points: vec![Jumps::default(); num_points],
        mean_jumps_across_rings: vec![0.0; num_points],
        all: Jumps::default(),
        creases: Jumps::default(),
    };
    for (id, patch) in complex.patches().filter(|(_, patch)| patch.role != Role::Cap) {
        let mut found = Found::default();
        for side in 0..4 {
            (0..samples).for_each(|k| around.sample(&mut found, id, side, [k, samples]));
        }
        if let Some(point) = patch.point {
            result.points[point] = result.points[point].max(found.smooth);
            let largest = &mut result.mean_jumps_across_rings[point];
            *largest = largest.max(found.mean_across_rings);
        }
        result.all = result.all.max(found.smooth);
        result.creases = result.creases.max(found.crease);
    }
    Ok(result)
}

/// The largest jumps at some points, those over infinitely sharp edges apart.
#[derive(Clone, Copy, Default)]
struct Found {
    smooth: Jumps,
    crease: Jumps,
    /// Of the mean curvature, to another ring of the same quad.
    mean_across_rings: f64,
}

/// A surface and its patches.
#[derive(Clone, Copy)]
struct Around<'a> {
    surface: &'a Surface,
    complex: &'a PatchComplex,
}

/// A point inside a side of a patch, in the parameters of its quad, what the patch says there, and
/// what it covers of u and v.
struct Here<'a> {
    patch: PatchId,
    place: &'a PatchPlace,
    side: u8,
    at: [f64; 2],
    found: SurfacePoint,
    size: [f64; 2],
}

impl<'a> Around<'a> {
    /// Compares point `k` of `samples` on a side of a patch with all that has it on the other side.
    fn sample(self, found: &mut Found, patch: PatchId, side: u8, [k, samples]: [usize; 2]) {
        let Some(place) = self.complex.place(patch) else { return };
        let part = (k as f64 + 0.5) / samples as f64;
        let at = point_of_side(place, side, [k, samples]);
        let size = place.domain.map(|[start, end]| end - start);
        let here = Here { patch, place, side, at, found: self.surface.answer_on(place, at), size };
        // Several edges, if one ends here.
        let own = if side < 2 { part } else { 1.0 - part };
        let edges = self.complex.edges_of_side(patch, side).iter();
        for edge in edges.filter_map(|&edge| self.complex.edge(edge)) {
            let mut uses = edge.uses().iter().filter(|of| (of.patch, of.side) == (patch, side));
            if uses.any(|of| of.interval[0] <= own && own <= of.interval[1]) {
                self.compare_across(found, &here, edge);
            }
        }
    }

    fn compare_across(self, found: &mut Found, here: &Here, edge: &PatchEdge) {
        let other = edge.across(here.patch).and_then(|other| self.complex.place(other));
        if matches!(edge.place, EdgePlace::AlongU { .. } | EdgePlace::AlongV { .. }) {
            return self.compare_inside(found, here, other);
        }
        let quad = here.place.quad;
        let side = usize::from(here.side);
        let Some((quad, other_side, t, speed)) = across(self.surface, quad, side, here.at) else {
            return;
        };
        let at = point_on_side(other_side, t);
        let there = match other {
            Some(place) => Some(self.surface.answer_on(place, at)),
            None => self.surface.eval(quad, at[0], at[1]),
        };
        let Some(there) = there else { return };
        // Both sides as seen from the border, in the parameters of this quad.
        let jet = border_jet(other_side, &there.jet).scaled_parameters(-speed);
        let here_jet = border_jet(side, &here.found.jet);
        let size = if side.is_multiple_of(2) { here.size } else { [here.size[1], here.size[0]] };
        let here = SurfacePoint { jet: here_jet, ..here.found };
        let jumps = compare(&here, &SurfacePoint { jet, ..there }, size);
        let is_crease =
            matches!(edge.place, EdgePlace::CageEdge(h) if self.surface.is_infinitely_sharp(h));
        let of_kind = if is_crease { &mut found.crease } else { &mut found.smooth };
        *of_kind = of_kind.max(jumps);
    }

    /// Compares with another patch of the same quad, or with the ring that would come next.
    fn compare_inside(self, found: &mut Found, here: &Here, other: Option<&PatchPlace>) {
        let (place, [u, v]) = (here.place, here.at);
        let there = match other.filter(|other| other.role != Role::Cap) {
            Some(other) => {
                let there: SurfacePoint = self.surface.answer_on(other, here.at);
                if other.point == place.point && other.role != place.role {
                    let jump = (there.mean - here.found.mean).abs();
                    found.mean_across_rings = found.mean_across_rings.max(jump);
                }
                Some(there)
            }
            None if place.point.is_some_and(|point| self.surface.cap(point).is_some()) => None,
            None => self.surface.eval(place.quad, u, v),
        };
        if let Some(there) = there {
            found.smooth = found.smooth.max(compare(&here.found, &there, here.size));
        }
    }
}

/// Point `k` of `samples` inside a side of a patch, in the parameters of its quad.
fn point_of_side(place: &PatchPlace, side: u8, [k, samples]: [usize; 2]) -> [f64; 2] {
    let [[u0, u1], [v0, v1]] = place.domain;
    let inside = |a: f64, b: f64| a + (b - a) * (k as f64 + 0.5) / samples as f64;
    match side {
        0 => [inside(u0, u1), v0],
        1 => [u1, inside(v0, v1)],
        2 => [inside(u0, u1), v1],
        _ => [u0, inside(v0, v1)],
    }
}

/// The jumps between two answers for one point, in the same parameters; `size` is what a patch
/// covers of either.
fn compare(a: &SurfacePoint, b: &SurfacePoint, size: [f64; 2]) -> Jumps {
    let own = over_patch(&a.jet, size);
    let extent = own.rows()[1..].iter().map(|&r| norm(r)).fold(0.0, f64::max);
    let other = over_patch(&b.jet, size);
    let apart = own.rows().into_iter().zip(other.rows()).map(|(x, y)| norm(sub(x, y)));
    Jumps { defect: Defect::between(a, b), parametric: apart.fold(0.0, f64::max) / extent }
}

/// A jet in parameters that run from 0 to 1 over a patch of this size.
fn over_patch(jet: &Jet, [u, v]: [f64; 2]) -> Jet {
    Jet {
        p: jet.p,
        du: scale(u, jet.du),
        dv: scale(v, jet.dv),
        duu: scale(u * u, jet.duu),
        duv: scale(u * v, jet.duv),
        dvv: scale(v * v, jet.dvv),
    }
}

/// The parameter along a side, from its first corner to the next.
fn along_side(side: usize, [u, v]: [f64; 2]) -> f64 {
    [u, v, 1.0 - u, 1.0 - v][side]
}

fn point_on_side(side: usize, t: f64) -> [f64; 2] {
    [[t, 0.0], [1.0, t], [1.0 - t, 1.0], [0.0, 1.0 - t]][side]
}

/// A jet in the frame (T, N) of a side.
fn border_jet(side: usize, jet: &Jet) -> Jet {
    let minus = |r: Vector| scale(-1.0, r);
    let Jet { p, du, dv, duu, duv, dvv } = *jet;
    match side {
        0 => *jet,
        1 => Jet { p, du: dv, dv: minus(du), duu: dvv, duv: minus(duv), dvv: duu },
        2 => Jet { p, du: minus(du), dv: minus(dv), duu, duv, dvv },
        _ => Jet { p, du: minus(dv), dv: du, duu: dvv, duv: minus(duv), dvv: duu },
    }
}

/// The quad across a side: its number, its side, the parameter there, and how long its unit of
/// parameter is in units of this quad's. `None` at a boundary.
fn across(
    surface: &Surface,
    quad: QuadId,
    side: usize,
    at: [f64; 2],
) -> Option<(QuadId, usize, f64, f64)> {
    let topology = surface.topology();
    let (face, k) = surface.layout().face_of_quad(quad);
    let corners = topology.faces().corners(face).len();
    let t = along_side(side, at);
    let quad_at = |face: FaceId, corner: usize| surface.quad(face, corner);
    // The edge of the cage and the parameter along it, in whole edges.
    let (h, t, speed) = match (corners == 4, side) {
        (true, _) => (topology.half_edge(face, side), t, 1.0),
        (false, 0) => (topology.half_edge(face, k), 0.5 * t, 2.0),
        (false, 3) => (topology.half_edge(face, (k + corners - 1) % corners), 0.5 + 0.5 * t, 2.0),
        // Inside an n-gon.
        (false, 1) => return Some((quad_at(face, (k + 1) % corners)?, 2, 1.0 - t, 1.0)),
        (false, _) => return Some((quad_at(face, (k + corners - 1) % corners)?, 1, 1.0 - t, 1.0)),
    };
    let twin = topology.twin(h)?;
    let (face, j, t) = (topology.face(twin), topology.corner(twin), 1.0 - t);
    let corners = topology.faces().corners(face).len();
    if corners == 4 {
        return Some((quad_at(face, 0)?, j, t, 1.0 / speed));
    }
    if t <= 0.5 {
        Some((quad_at(face, j)?, 0, 2.0 * t, 2.0 / speed))
    } else {
        Some((quad_at(face, (j + 1) % corners)?, 3, 2.0 * t - 1.0, 2.0 / speed))
    }
}
