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

use std::collections::BTreeMap;

use crate::mesh::FaceId;
use crate::patch::{Jet, SurfacePoint};
use crate::point::{Vector, cross, dot, norm, scale, sub};
use crate::surface::{PatchPlace, QuadId, Role, Surface};

/// The largest jumps over a set of border points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jumps {
    /// Of position, in the units of the cage.
    pub position: f64,
    /// Of the tangent plane: the angle between the normals, in radians.
    pub tangent_plane: f64,
    /// Of curvature: the larger difference of the principal curvatures, in 1/unit.
    pub curvature: f64,
    /// Of position and derivatives up to order two in matched parameters, as a part of the size
    /// of the patch (its largest derivative over its own parameters).
    pub parametric: f64,
}

impl Jumps {
    /// The larger of each.
    pub fn max(self, other: Self) -> Self {
        Self {
            position: self.position.max(other.position),
            tangent_plane: self.tangent_plane.max(other.tangent_plane),
            curvature: self.curvature.max(other.curvature),
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

/// Samples `samples` points inside every patch border of the surface with `rings` rings.
///
/// The inner border of the last ring is compared with the ring behind it. Caps, which join in other
/// parameters, are left out: [`cap_report`](super::caps::cap_report) measures them.
pub fn continuity(surface: &Surface, rings: usize, samples: usize) -> Continuity {
    let num_points = surface.extraordinary_points().len();
    let mut result = Continuity {
        points: vec![Jumps::default(); num_points],
        mean_jumps_across_rings: vec![0.0; num_points],
        all: Jumps::default(),
        creases: Jumps::default(),
    };
    for (_, patches) in patches_by_quad(surface, rings) {
        for (k, patch) in patches.iter().enumerate() {
            let mut jumps = Jumps::default();
            for (u, v) in border_points(patch, samples) {
                let found = jumps_at(surface, &patches, k, [u, v]);
                jumps = jumps.max(found.smooth);
                result.creases = result.creases.max(found.crease);
                if let Some(point) = patch.point {
                    let largest = &mut result.mean_jumps_across_rings[point];
                    *largest = largest.max(mean_jump_across_rings(surface, &patches, k, [u, v]));
                }
            }
            if let Some(point) = patch.point {
                result.points[point] = result.points[point].max(jumps);
            }
            result.all = result.all.max(jumps);
        }
    }
    result
}

fn patches_by_quad(surface: &Surface, rings: usize) -> BTreeMap<QuadId, Vec<PatchPlace>> {
    let mut quads: BTreeMap<QuadId, Vec<PatchPlace>> = BTreeMap::new();
    for patch in surface.patch_places(rings).filter(|patch| patch.role != Role::Cap) {
        quads.entry(patch.quad).or_default().push(patch);
    }
    quads
}

/// Points inside the four borders of a patch, in the parameters of its quad.
fn border_points(patch: &PatchPlace, samples: usize) -> Vec<(f64, f64)> {
    let [[u0, u1], [v0, v1]] = patch.domain;
    let inside = |a: f64, b: f64, k: usize| a + (b - a) * (k as f64 + 0.5) / samples as f64;
    let along_u = (0..samples).flat_map(|k| [v0, v1].map(|v| (inside(u0, u1, k), v)));
    let along_v = (0..samples).flat_map(|k| [u0, u1].map(|u| (u, inside(v0, v1, k))));
    along_u.chain(along_v).collect()
}

/// The jumps at a point, those over an infinitely sharp edge apart.
#[derive(Clone, Copy, Default)]
struct Found {
    smooth: Jumps,
    crease: Jumps,
}

/// The jumps between patch `k` of a quad and everything else that has the point `at` of its
/// border.
fn jumps_at(surface: &Surface, patches: &[PatchPlace], k: usize, at: [f64; 2]) -> Found {
    let size = patches[k].domain.map(|[start, end]| end - start);
    let here = surface.answer_on::<SurfacePoint>(&patches[k], [at[0], at[1]]);
    let inside = patches.iter().enumerate().filter(|&(j, p)| j != k && contains(p, at));
    let mut jumps = Jumps::default();
    let mut alone = true;
    for (_, other) in inside {
        alone = false;
        jumps = jumps.max(compare(
            &here,
            &surface.answer_on::<SurfacePoint>(other, [at[0], at[1]]),
            size,
        ));
    }
    if let Some(side) = (0..4).find(|&side| is_on_side(side, at)) {
        let Some((quad, other_side, t, speed)) = across(surface, patches[k].quad, side, at) else {
            return Found { smooth: jumps, ..Found::default() };
        };
        let [u, v] = point_on_side(other_side, t);
        if let Some(there) = surface.eval(quad, u, v) {
            // Both sides as seen from the border, in the parameters of this quad.
            let jet = border_jet(other_side, &there.jet).scaled_parameters(-speed);
            let here = SurfacePoint { jet: border_jet(side, &here.jet), ..here };
            let size = if side.is_multiple_of(2) { size } else { [size[1], size[0]] };
            let beyond = compare(&here, &SurfacePoint { jet, ..there }, size);
            if is_crease(surface, patches[k].quad, side) {
                return Found { smooth: jumps, crease: beyond };
            }
            jumps = jumps.max(beyond);
        }
    } else if alone && patches[k].point.is_none_or(|point| surface.cap(point).is_none()) {
        // The inner border of the last ring: evaluation answers with the ring behind it.
        if let Some(there) = surface.eval(patches[k].quad, at[0], at[1]) {
            jumps = jumps.max(compare(&here, &there, size));
        }
    }
    Found { smooth: jumps, ..Found::default() }
}

/// Whether a side of a quad lies on an infinitely sharp edge.
fn is_crease(surface: &Surface, quad: QuadId, side: usize) -> bool {
    let topology = surface.topology();
    let (face, k) = surface.layout().face_of_quad(quad);
    let corners = topology.faces().corners(face).len();
    let edge = match (corners == 4, side) {
        (true, _) => side,
        (false, 0) => k,
        (false, 3) => (k + corners - 1) % corners,
        // Inside an n-gon.
        (false, _) => return false,
    };
    surface.is_infinitely_sharp(topology.half_edge(face, edge))
}

/// The jump of H between patch `k` of a quad and the patches of other rings at the point `at` of
/// its border.
fn mean_jump_across_rings(
    surface: &Surface,
    patches: &[PatchPlace],
    k: usize,
    [u, v]: [f64; 2],
) -> f64 {
    let here = surface.answer_on::<SurfacePoint>(&patches[k], [u, v]).mean;
    let of_another_ring = |p: &&PatchPlace| {
        p.point == patches[k].point && p.role != patches[k].role && contains(p, [u, v])
    };
    let others = patches.iter().filter(of_another_ring);
    others
        .map(|p| (surface.answer_on::<SurfacePoint>(p, [u, v]).mean - here).abs())
        .fold(0.0, f64::max)
}

/// Whether a point of a quad is in a patch, its border included.
fn contains(place: &PatchPlace, at: [f64; 2]) -> bool {
    (0..2).all(|d| place.domain[d][0] <= at[d] && at[d] <= place.domain[d][1])
}

/// The jumps between two answers for one point, in the same parameters; `size` is what a patch
/// covers of either.
fn compare(a: &SurfacePoint, b: &SurfacePoint, size: [f64; 2]) -> Jumps {
    let angle = norm(cross(a.normal, b.normal)).atan2(dot(a.normal, b.normal));
    let (ka, kb) = (a.principal_curvatures(), b.principal_curvatures());
    let own = over_patch(&a.jet, size);
    let extent = own.rows()[1..].iter().map(|&r| norm(r)).fold(0.0, f64::max);
    let other = over_patch(&b.jet, size);
    let apart = own.rows().into_iter().zip(other.rows()).map(|(x, y)| norm(sub(x, y)));
    Jumps {
        position: norm(sub(a.jet.p, b.jet.p)),
        tangent_plane: angle,
        curvature: (ka[0] - kb[0]).abs().max((ka[1] - kb[1]).abs()),
        parametric: apart.fold(0.0, f64::max) / extent,
    }
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

fn is_on_side(side: usize, [u, v]: [f64; 2]) -> bool {
    [v == 0.0, u == 1.0, v == 1.0, u == 0.0][side]
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
