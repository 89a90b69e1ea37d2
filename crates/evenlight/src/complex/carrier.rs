//! Carriers: the lines on which the sides of patches lie, and the places where they meet.
//!
//! ```text
//!    +-----------+        an edge of the cage, from the origin of its lower half-edge;
//!    |     :     |        a line of an n-gon, from the middle of edge k to the centre;
//!    |.....:.....|        a line u = const or v = const inside a parametric quad
//!    |     :     |
//!    +-----------+
//! ```
//!
//! Two patches are neighbours if and only if their sides have a carrier and an interval of it in
//! common. Carriers are known by the connectivity of the cage, whatever the positions.

use super::exact::{Exact, ONE, Rectangle};
use crate::mesh::{FaceId, HalfEdgeId, Topology, VertexId};

/// A line with a coordinate along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Carrier {
    /// An edge of the cage, 2 [`ONE`] long, by its lower half-edge.
    CageEdge(HalfEdgeId),
    /// The line between quads `k` and `k + 1` of an n-gon, [`ONE`] long.
    FaceLine(FaceId, u32),
    /// The line inside a quad on which parameter 0 (u) or 1 (v) has a value; the other runs along
    /// it.
    Inside(u32, u8, Exact),
}

/// A place at which sides meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Meeting {
    Vertex(VertexId),
    FaceCentre(FaceId),
    OnEdge(HalfEdgeId, Exact),
    OnFaceLine(FaceId, u32, Exact),
    Inside(u32, [Exact; 2]),
}

/// A side of a patch on its carrier.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub(super) carrier: Carrier,
    /// From the lower to the higher coordinate.
    pub(super) interval: [Exact; 2],
    /// Whether the side, counter-clockwise around the patch, runs to higher coordinates.
    pub(super) is_forward: bool,
    pub(super) patch: u32,
    pub(super) side: u8,
}

/// A parametric quad in its face.
#[derive(Clone, Copy, Debug)]
pub(super) struct QuadOfFace<'a> {
    pub(super) topology: &'a Topology,
    pub(super) quad: u32,
    pub(super) face: FaceId,
    pub(super) corner: usize,
}

impl QuadOfFace<'_> {
    /// The four sides of a patch that covers `rectangle`: v = v0, u = u1, v = v1, u = u0.
    pub(super) fn sides(self, patch: u32, rectangle: Rectangle) -> [Side; 4] {
        let [[u0, u1], [v0, v1]] = rectangle;
        [(0, [u0, u1], v0), (1, [v0, v1], u1), (2, [u0, u1], v1), (3, [v0, v1], u0)].map(
            |(side, interval, at)| {
                let is_forward = side < 2;
                let (carrier, interval, is_forward) = match at {
                    0 | ONE => self.on_border(side, interval),
                    _ => (self.inside(side, at), interval, is_forward),
                };
                Side { carrier, interval, is_forward, patch, side }
            },
        )
    }

    /// The line of side `side` of a patch, on which the parameter across has the value `at`.
    fn inside(self, side: u8, at: Exact) -> Carrier {
        Carrier::Inside(self.quad, if side.is_multiple_of(2) { 1 } else { 0 }, at)
    }

    /// The carrier of side `side` of the quad, an interval of u or v as one of the carrier, and
    /// whether the side, counter-clockwise, runs along the carrier.
    fn on_border(self, side: u8, interval: [Exact; 2]) -> (Carrier, [Exact; 2], bool) {
        let (n, k) = (self.topology.faces().corners(self.face).len(), self.corner);
        let before = (k + n - 1) % n;
        // Along the side counter-clockwise.
        let [from, to] = interval;
        let along = if side < 2 { [from, to] } else { [ONE - to, ONE - from] };
        match (n == 4, side) {
            (true, _) => self.on_edge(usize::from(side), along.map(|t| 2 * t)),
            (false, 0) => self.on_edge(k, along),
            (false, 3) => self.on_edge(before, along.map(|t| ONE + t)),
            (false, 1) => (Carrier::FaceLine(self.face, k as u32), interval, true),
            (false, _) => (Carrier::FaceLine(self.face, before as u32), interval, false),
        }
    }

    /// The carrier of edge `k` of the face, along which `interval` runs from corner `k`.
    fn on_edge(self, k: usize, [from, to]: [Exact; 2]) -> (Carrier, [Exact; 2], bool) {
        let h = self.topology.half_edge(self.face, k);
        match self.topology.twin(h) {
            Some(twin) if twin < h => {
                (Carrier::CageEdge(twin), [2 * ONE - to, 2 * ONE - from], false)
            }
            _ => (Carrier::CageEdge(h), [from, to], true),
        }
    }
}

impl Carrier {
    /// The place at a coordinate; the quad is the one of a line inside a quad.
    pub(super) fn meeting<'a>(
        self,
        topology: &Topology,
        at: Exact,
        quad_of_face: impl Fn(u32) -> QuadOfFace<'a>,
    ) -> Meeting {
        match self {
            Self::CageEdge(h) if at == 0 => Meeting::Vertex(topology.origin(h)),
            Self::CageEdge(h) if at == 2 * ONE => Meeting::Vertex(topology.target(h)),
            Self::CageEdge(h) => Meeting::OnEdge(h, at),
            Self::FaceLine(face, _) if at == ONE => Meeting::FaceCentre(face),
            Self::FaceLine(face, k) if at == 0 => {
                let h = topology.half_edge(face, k as usize);
                let lower = topology.twin(h).map_or(h, |twin| twin.min(h));
                Meeting::OnEdge(lower, ONE)
            }
            Self::FaceLine(face, k) => Meeting::OnFaceLine(face, k, at),
            Self::Inside(quad, parameter, across) => {
                // The line ends at the border of the quad, at the latest.
                let side = match (parameter, at) {
                    (0, 0) => 0,
                    (0, ONE) => 2,
                    (_, 0) => 3,
                    (_, ONE) => 1,
                    (0, _) => return Meeting::Inside(quad, [across, at]),
                    (_, _) => return Meeting::Inside(quad, [at, across]),
                };
                let quad = quad_of_face(quad);
                let (carrier, [at, _], _) = quad.on_border(side, [across; 2]);
                carrier.meeting(topology, at, quad_of_face)
            }
        }
    }
}
