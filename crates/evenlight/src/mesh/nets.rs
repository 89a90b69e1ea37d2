//! The vertices of control nets: the walks over faces that gather them.

use super::fan::{PlacedFan, sectors};
use super::{HalfEdgeId, Topology, VertexId};
use crate::point::{add_scaled, scale};

/// The control net of a regular piece: the refinement level and the 4x4 vertices, the index along
/// v fastest. Beyond a sharp edge there are no vertices; the mirror image of the row behind the
/// edge stands for them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegularNet {
    pub(crate) level: u8,
    /// Bit k is set if edge k of the face (0 at v = 0, 1 at u = 1, 2 at v = 1, 3 at u = 0) is
    /// sharp.
    pub(crate) sharp_sides: u8,
    pub(crate) vertices: [VertexId; 16],
}

impl RegularNet {
    /// The net of the face of `h`, which leaves its corner 0.
    ///
    /// Four faces touch the face in a corner only; each of them gives four nodes:
    ///
    /// ```text
    ///  v ^  3--7-11-15
    ///    |  2--6-10-14      node (i,j) is number 4 i + j, i along u;
    ///    |  1--5--9-13      the face itself is 5 9 10 6
    ///    |  0--4--8-12 -> u
    /// ```
    pub(crate) fn smooth(t: &Topology, h: HalfEdgeId, level: usize) -> Self {
        let mut net = Self { level: level as u8, sharp_sides: 0, vertices: [t.origin(h); 16] };
        net.put(t, back_v(t, back_u(t, h)), 0, 0);
        net.put(t, back_v(t, forward_u(t, h)), 2, 0);
        net.put(t, forward_v(t, back_u(t, h)), 0, 2);
        net.put(t, forward_v(t, forward_u(t, h)), 2, 2);
        net
    }

    /// The net of the face of `h`, some of whose edges are sharp.
    pub(crate) fn with_sharp_sides(
        t: &Topology,
        h: HalfEdgeId,
        level: usize,
        sharp: [bool; 4],
    ) -> Self {
        let sharp_sides = (0..4).fold(0, |bits, k| bits | u8::from(sharp[k]) << k);
        let mut net = Self { level: level as u8, sharp_sides, vertices: [t.origin(h); 16] };
        let [below, right, above, left] = sharp.map(|sharp| !sharp);
        net.put(t, h, 1, 1);
        if below {
            net.put(t, back_v(t, h), 1, 0);
        }
        if right {
            net.put(t, forward_u(t, h), 2, 1);
        }
        if above {
            net.put(t, forward_v(t, h), 1, 2);
        }
        if left {
            net.put(t, back_u(t, h), 0, 1);
        }
        if below && left {
            net.put(t, back_v(t, back_u(t, h)), 0, 0);
        }
        if below && right {
            net.put(t, back_v(t, forward_u(t, h)), 2, 0);
        }
        if above && left {
            net.put(t, forward_v(t, back_u(t, h)), 0, 2);
        }
        if above && right {
            net.put(t, forward_v(t, forward_u(t, h)), 2, 2);
        }
        net
    }

    /// Enters the corners of the face of `h`, which leaves node (i,j).
    fn put(&mut self, t: &Topology, h: HalfEdgeId, i: usize, j: usize) {
        let mut h = h;
        for place in [4 * i + j, 4 * (i + 1) + j, 4 * (i + 1) + j + 1, 4 * i + j + 1] {
            self.vertices[place] = t.origin(h);
            h = t.next(h);
        }
    }

    /// The control points, from the positions of the net's level.
    #[inline]
    pub(crate) fn points<const N: usize>(&self, positions: &[[f64; N]]) -> [[f64; N]; 16] {
        let mut points = [[0.0; N]; 16];
        for (p, v) in points.iter_mut().zip(&self.vertices) {
            *p = positions[v.index()];
        }
        if self.sharp_sides != 0 {
            self.mirror(&mut points);
        }
        points
    }

    /// Enters the nodes beyond sharp edges. With p(-1) = 2 p(0) - p(1) the second derivative
    /// across the edge is zero there, as it is after refinement with the crease rule.
    #[cold]
    fn mirror<const N: usize>(&self, p: &mut [[f64; N]; 16]) {
        let is_sharp = |k: usize| self.sharp_sides >> k & 1 == 1;
        let mut extend = |to: usize, from: usize, next: usize| {
            let mut q = scale(2.0, p[from]);
            add_scaled(&mut q, -1.0, p[next]);
            p[to] = q;
        };
        for j in 0..4 {
            if is_sharp(3) {
                extend(j, 4 + j, 8 + j);
            }
            if is_sharp(1) {
                extend(12 + j, 8 + j, 4 + j);
            }
        }
        for i in 0..4 {
            if is_sharp(0) {
                extend(4 * i, 4 * i + 1, 4 * i + 2);
            }
            if is_sharp(2) {
                extend(4 * i + 3, 4 * i + 2, 4 * i + 1);
            }
        }
    }
}

impl RegularNet {
    /// Moves the weights of nodes beyond sharp edges to the nodes whose mirror images they are.
    pub(crate) fn fold<const R: usize>(&self, w: &mut [[f64; R]; 16]) {
        let is_sharp = |k: usize| self.sharp_sides >> k & 1 == 1;
        let mut fold = |from: usize, to: usize, next: usize| {
            let moved = std::mem::replace(&mut w[from], [0.0; R]);
            for (r, x) in moved.into_iter().enumerate() {
                w[to][r] += 2.0 * x;
                w[next][r] -= x;
            }
        };
        // In the reverse order of `mirror`.
        for i in 0..4 {
            if is_sharp(0) {
                fold(4 * i, 4 * i + 1, 4 * i + 2);
            }
            if is_sharp(2) {
                fold(4 * i + 3, 4 * i + 2, 4 * i + 1);
            }
        }
        for j in 0..4 {
            if is_sharp(3) {
                fold(j, 4 + j, 8 + j);
            }
            if is_sharp(1) {
                fold(12 + j, 8 + j, 4 + j);
            }
        }
    }
}

fn across(t: &Topology, h: HalfEdgeId) -> HalfEdgeId {
    t.twin(h).expect("there is a face beyond an edge that is not sharp")
}

/// The half-edge one step along u, `h` being one along u at v = 0 of its face.
fn forward_u(t: &Topology, h: HalfEdgeId) -> HalfEdgeId {
    t.next(across(t, t.next(h)))
}

fn back_u(t: &Topology, h: HalfEdgeId) -> HalfEdgeId {
    t.previous(across(t, t.previous(h)))
}

fn forward_v(t: &Topology, h: HalfEdgeId) -> HalfEdgeId {
    across(t, t.next(t.next(h)))
}

fn back_v(t: &Topology, h: HalfEdgeId) -> HalfEdgeId {
    t.next(t.next(across(t, h)))
}

/// The vertices of a c-net, per sector in the order (0,1), (0,2), (1,1), (1,2), (2,1), (2,2),
/// around an isolated vertex; `first` leaves it in front of sector 0.
pub(crate) fn cnet_vertices(t: &Topology, first: HalfEdgeId) -> Vec<[VertexId; 6]> {
    t.ring(t.origin(first))
        .map(|h| {
            let [a, b] = line_end(t, h);
            let [c, d, e, f] = inner_nodes(t, h);
            [a, b, c, d, e, f]
        })
        .collect()
}

/// The vertices of the net of an isolated fan: two along every line, (1,1), (1,2), (2,1), (2,2) in
/// every sector, and the centre.
pub(crate) fn fan_vertices(t: &Topology, fan: PlacedFan) -> Vec<VertexId> {
    let all: Vec<HalfEdgeId> = sectors(t, fan).collect();
    let mut net: Vec<VertexId> =
        all.iter().flat_map(|&h| [t.target(h), t.target(forward_u(t, h))]).collect();
    if !fan.shape.is_closed {
        net.extend(all.last().into_iter().flat_map(|&h| line_end(t, h)));
    }
    net.extend(all.iter().flat_map(|&h| inner_nodes(t, h)));
    net.push(t.origin(fan.first));
    net
}

/// The nodes (0,1) and (0,2) of the sector of `h`.
fn line_end(t: &Topology, h: HalfEdgeId) -> [VertexId; 2] {
    [h, forward_v(t, h)].map(|h| t.origin(t.previous(h)))
}

/// The nodes (1,1), (1,2), (2,1), (2,2) of the sector of `h`.
fn inner_nodes(t: &Topology, h: HalfEdgeId) -> [VertexId; 4] {
    let (right, above) = (forward_u(t, h), forward_v(t, h));
    [h, above, right, forward_v(t, right)].map(|h| t.target(t.next(h)))
}
