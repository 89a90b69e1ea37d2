//! Fans: the faces around a vertex between two sharp edges.
//!
//! An infinitely sharp edge, like the boundary, separates the surfaces on its two sides: the
//! refinement of each side depends on its own faces and the crease alone. So the faces around a
//! vertex form *fans*:
//!
//! ```text
//!    \ 2 | 1 /            2 | 1               2 | 1               \ 3 | 2 /
//!     \  |  /               |                   |                  \  |  /
//!   ===== v =====         3 v ======          3 v 0              4  >v<  1     (===, X: sharp)
//!     /  |  \               |                   |                  /  |  \
//!    / 3 | 4 \            0 | ...             two fans of         / 5 | 6 \
//!   crease: two fans     dart: one closed    a corner, ...       smooth: one closed fan
//! ```
//!
//! An open fan of two faces at a crease, or of one face at a corner, is *regular*: its faces are
//! bi-3 patches up to the sharp edge. A smooth vertex of four faces is regular, too. All other fans
//! are extraordinary.

use super::sharpness::{Sharpness, is_semi_sharp};
use super::{HalfEdgeId, Topology, VertexId};
use crate::net::{Fan, VertexRule};

/// A fan of a mesh; `first` leaves the vertex clockwise-most, along the sharp edge if there is one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedFan {
    pub(crate) shape: Fan,
    pub(crate) first: HalfEdgeId,
}

/// The sectors of a fan, as the half-edges that leave the vertex.
pub(crate) fn sectors(t: &Topology, fan: PlacedFan) -> impl Iterator<Item = HalfEdgeId> {
    let mut at = Some(fan.first);
    (0..fan.shape.faces).map_while(move |_| {
        let h = at?;
        at = t.twin(t.previous(h));
        Some(h)
    })
}

/// Which vertices of one level are special.
pub(crate) struct Features<'a> {
    pub(crate) topology: &'a Topology,
    pub(crate) sharpness: &'a Sharpness,
    /// Whether a vertex is an inner vertex of a regular, smooth grid of quads.
    is_regular: Vec<bool>,
    /// Whether an n-gon has the vertex as a corner; empty if there are only quads.
    has_ngon: Vec<bool>,
}

impl<'a> Features<'a> {
    pub(crate) fn new(topology: &'a Topology, sharpness: &'a Sharpness) -> Self {
        let vertices = (0..topology.num_vertices() as u32).map(VertexId);
        let is_regular =
            vertices.map(|v| topology.num_sectors(v) == 4 && !topology.is_boundary(v)).collect();
        let mut features = Self { topology, sharpness, is_regular, has_ngon: Vec::new() };
        for corners in topology.faces().iter().filter(|corners| corners.len() != 4) {
            features.has_ngon.resize(topology.num_vertices(), false);
            for v in corners {
                features.has_ngon[v.index()] = true;
                features.is_regular[v.index()] = false;
            }
        }
        let is_regular = &mut features.is_regular;
        sharpness.for_each_touched(topology, |v| is_regular[v.index()] = false);
        features
    }

    /// Whether `v` is an inner vertex of a regular, smooth grid of quads.
    pub(crate) fn is_regular(&self, v: VertexId) -> bool {
        self.is_regular[v.index()]
    }

    /// Whether all faces at `v` are quads.
    pub(crate) fn has_quads(&self, v: VertexId) -> bool {
        !self.has_ngon.get(v.index()).copied().unwrap_or(false)
    }

    /// The fan of the face of `h` around the vertex that `h` leaves; `None` if its rule is still
    /// to change.
    pub(crate) fn fan(&self, h: HalfEdgeId) -> Option<PlacedFan> {
        let t = self.topology;
        let v = t.origin(h);
        let spokes = self.sharpness.spokes(t, v);
        let vertex = self.sharpness.vertex(v);
        if is_semi_sharp(vertex) || spokes.iter().any(|spoke| is_semi_sharp(spoke.sharpness)) {
            return None;
        }
        let sharp = spokes.iter().filter(|spoke| self.is_sharp(spoke.sharpness)).count();
        let rule = VertexRule::of(vertex, sharp);
        let shape = Fan { faces: t.num_sectors(v), is_closed: true, has_dart: sharp == 1, rule };
        let first = t.ring(v).next().unwrap_or(h);
        match sharp {
            0 => Some(PlacedFan { shape, first }),
            1 => Some(PlacedFan { shape, first: self.clockwise_most(h) }),
            _ => {
                let first = self.clockwise_most(h);
                let shape = Fan { faces: self.faces_from(first), is_closed: false, ..shape };
                Some(PlacedFan { shape, first })
            }
        }
    }

    /// Whether the sharpness is infinite, where nothing is semi-sharp. An edge at the end of a
    /// refined part has unknown sharpness and counts as sharp.
    fn is_sharp(&self, sharpness: f64) -> bool {
        sharpness != 0.0
    }

    /// The sector that is reached from `h` by turning clockwise up to a sharp edge.
    fn clockwise_most(&self, h: HalfEdgeId) -> HalfEdgeId {
        let t = self.topology;
        let mut at = h;
        while !self.is_sharp(self.sharpness.edge(t, at)) {
            let Some(twin) = t.twin(at) else { break };
            at = t.next(twin);
        }
        at
    }

    /// The number of faces from `first` counter-clockwise up to a sharp edge.
    fn faces_from(&self, first: HalfEdgeId) -> usize {
        let t = self.topology;
        let (mut at, mut faces) = (first, 1);
        while !self.is_sharp(self.sharpness.edge(t, t.previous(at))) {
            let Some(twin) = t.twin(t.previous(at)) else { break };
            at = twin;
            faces += 1;
        }
        faces
    }

    /// Whether two rings of faces around the vertex of `fan` are regular except at the vertex: the
    /// direct and diagonal neighbours inside the fan are regular and smooth, those on its sharp
    /// edges lie on a regular crease.
    pub(crate) fn is_isolated(&self, fan: PlacedFan) -> bool {
        let t = self.topology;
        if !self.has_quads(t.origin(fan.first)) {
            return false;
        }
        let has_sharp_edge = !fan.shape.is_closed || fan.shape.has_dart;
        let last = fan.shape.faces - 1;
        sectors(t, fan).enumerate().all(|(s, h)| {
            let start = if has_sharp_edge && s == 0 {
                self.is_on_regular_crease(t.next(h))
            } else {
                self.is_regular(t.target(h))
            };
            let end = !has_sharp_edge || s < last || self.is_on_regular_crease(t.previous(h));
            start && end && self.is_regular(t.target(t.next(h)))
        })
    }

    /// Whether the face of `h` is one of two on its side of a crease through the vertex that `h`
    /// leaves.
    fn is_on_regular_crease(&self, h: HalfEdgeId) -> bool {
        self.has_quads(self.topology.origin(h))
            && self
                .fan(h)
                .is_some_and(|fan| fan.shape.is_regular() && fan.shape.rule == VertexRule::Crease)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{BoundaryRule, Crease, Mesh, Tags};

    /// A wheel of six quads around vertex 0, with sharp spokes to these of the vertices 1, 3 .. 11.
    fn fans(sharp: &[u32]) -> Vec<Fan> {
        let ring = |k: u32| 1 + k % 12;
        let faces = (0..6).map(|k| [0, ring(2 * k), ring(2 * k + 1), ring(2 * k + 2)]);
        let topology = Topology::build(Mesh::new(vec![], faces).faces, 13).unwrap();
        let crease = |&v: &u32| Crease { edge: [0, v].map(VertexId), sharpness: 10.0 };
        let tags = Tags { creases: sharp.iter().map(crease).collect(), ..Tags::default() };
        let sharpness = Sharpness::new(&topology, &tags, BoundaryRule::EdgeAndCorner);
        let features = Features::new(&topology, &sharpness);
        let ring = topology.ring(VertexId(0));
        let fans: Vec<PlacedFan> = ring.map(|h| features.fan(h).unwrap()).collect();
        for fan in &fans {
            assert_eq!(sectors(&topology, *fan).count(), fan.shape.faces);
        }
        fans.into_iter().map(|fan| fan.shape).collect()
    }

    #[test]
    fn sharp_edges_cut_a_vertex_into_fans() {
        let open = |faces, rule| Fan { faces, is_closed: false, has_dart: false, rule };
        assert!(fans(&[]).iter().all(|fan| fan.is_smooth() && fan.faces == 6));
        let dart = Fan { faces: 6, is_closed: true, has_dart: true, rule: VertexRule::Smooth };
        assert_eq!(fans(&[5]), [dart; 6]);
        let mut found = fans(&[1, 5]);
        found.sort();
        let (two, four) = (open(2, VertexRule::Crease), open(4, VertexRule::Crease));
        assert_eq!(found, [two, two, four, four, four, four]);
        let mut found = fans(&[1, 3, 7]);
        found.sort();
        let corner = |faces| open(faces, VertexRule::Corner);
        assert_eq!(found.iter().filter(|&&fan| fan == corner(1)).count(), 1);
        assert_eq!(found.iter().filter(|&&fan| fan == corner(2)).count(), 2);
        assert_eq!(found.iter().filter(|&&fan| fan == corner(3)).count(), 3);
    }
}
