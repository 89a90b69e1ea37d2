//! The cage of a face-varying primvar: the faces of the positions' cage, with vertices of its own.
//!
//! Texture coordinates are themselves the control net of a Catmull-Clark surface. Corners at one
//! vertex of the cage are one vertex of that net if no seam lies between them. An edge is a *seam*
//! if its two faces have different values at one of its ends. Seams are boundaries of the net:
//!
//! ```text
//!   positions         values: a seam from the right that ends in d (a dart)
//!   +--+--+           +--+--+
//!   |  |  |           |  |  |
//!   +--d--+           +--d--+      the faces around d are one fan, whose two ends are the
//!   |  |  |           |  |\ '      two sides of the seam: d is a boundary vertex here
//!   +--+--+           |  | \+
//!                     +--+--+
//! ```
//!
//! What a boundary does is the primvar's [`FaceVaryingRule`]: its vertices lie on smooth curves, or
//! are sharp. Creases and sharp vertices of the cage hold for the primvar too.

use std::collections::{BTreeMap, BTreeSet};

use super::sharpness::{Beyond, half_edges_of, is_semi_sharp, single};
use super::{
    BoundaryRule, Corner, Crease, FaceVaryingRule, Faces, HalfEdgeId, INFINITELY_SHARP, Primvar,
    Tags, Topology, VertexId,
};

/// The faces of a primvar, and the value at each of its vertices.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PrimvarNet {
    /// The faces of the cage in their order, with the primvar's own vertices.
    pub(crate) faces: Faces,
    /// Creases, corners and holes of the primvar.
    pub(crate) tags: Tags,
    /// The number of the value at every vertex.
    pub(crate) values: Vec<u32>,
    /// The semi-sharp edges of the cage at vertices on seams that are not the primvar's there.
    pub(crate) beyond: BTreeMap<VertexId, Beyond>,
}

impl PrimvarNet {
    /// The net of a face-varying primvar of a cage whose positions have this boundary rule.
    pub(crate) fn new(
        topology: &Topology,
        tags: &Tags,
        primvar: &Primvar,
        boundary: BoundaryRule,
    ) -> Self {
        let values = &primvar.indices[..];
        let mut splitter = Splitter {
            tags,
            topology,
            values,
            boundary,
            rule: tags.face_varying,
            edge_sharpness: edge_sharpness(topology, tags),
            vertex_sharpness: vertex_sharpness(topology, tags),
            of_corner: vec![VertexId(0); values.len()],
            vertices: Vec::new(),
            corners: Vec::new(),
            beyond: BTreeMap::new(),
        };
        (0..topology.num_vertices() as u32).for_each(|v| splitter.split(VertexId(v)));
        let tags = splitter.own_tags();
        let Splitter { of_corner, vertices, beyond, .. } = splitter;
        let mut faces = Faces::default();
        for face in topology.faces().ids() {
            faces.push(topology.faces().corner_range(face).map(|corner| of_corner[corner]));
        }
        Self { faces, tags, values: vertices, beyond }
    }
}

/// The sharpness of every half-edge.
fn edge_sharpness(topology: &Topology, tags: &Tags) -> Vec<f64> {
    let mut sharpness = vec![0.0; topology.half_edges().len()];
    for crease in &tags.creases {
        for h in half_edges_of(topology, crease.edge) {
            sharpness[h.index()] = single(crease.sharpness);
        }
    }
    sharpness
}

/// The sharpness of every vertex.
fn vertex_sharpness(topology: &Topology, tags: &Tags) -> Vec<f64> {
    let mut sharpness = vec![0.0; topology.num_vertices()];
    for corner in &tags.corners {
        sharpness[corner.vertex.index()] = single(corner.sharpness);
    }
    sharpness
}

/// The faces at a vertex between two seams, or all of them.
struct Fan {
    value: u32,
    /// The half-edges that leave the vertex in front of each face.
    faces: Vec<HalfEdgeId>,
    /// The sharpness of the edges between the faces.
    inner: Vec<f64>,
}

impl Fan {
    fn has_infinite_edge(&self) -> bool {
        self.inner.iter().any(|&s| s >= INFINITELY_SHARP)
    }

    /// The sharpness of the semi-sharp edges between the faces.
    fn semi_sharp(&self) -> impl Iterator<Item = f64> + '_ {
        self.inner.iter().copied().filter(|&s| is_semi_sharp(s))
    }
}

struct Splitter<'a> {
    tags: &'a Tags,
    topology: &'a Topology,
    values: &'a [u32],
    boundary: BoundaryRule,
    rule: FaceVaryingRule,
    edge_sharpness: Vec<f64>,
    vertex_sharpness: Vec<f64>,
    of_corner: Vec<VertexId>,
    vertices: Vec<u32>,
    corners: Vec<Corner>,
    beyond: BTreeMap<VertexId, Beyond>,
}

impl Splitter<'_> {
    /// Makes the vertices of the primvar at `v`, and says how sharp they are.
    fn split(&mut self, v: VertexId) {
        if !self.topology.ring(v).any(|h| self.is_seam(h)) {
            return self.keep(v);
        }
        let fans = self.fans(v);
        let sharpness = self.fan_sharpness(v, &fans);
        for (k, (fan, sharpness)) in fans.iter().zip(sharpness).enumerate() {
            let vertex = VertexId(self.vertices.len() as u32);
            self.vertices.push(fan.value);
            fan.faces.iter().for_each(|h| self.of_corner[h.index()] = vertex);
            let beyond = self.beyond(v, &fans, k, sharpness);
            let sharpness = sharpness.max(beyond.vertex());
            if sharpness > 0.0 {
                self.corners.push(Corner { vertex, sharpness });
            }
            if beyond != Beyond::default() {
                self.beyond.insert(vertex, beyond);
            }
        }
    }

    /// Makes the one vertex of the primvar at `v`, where there is neither a seam nor a boundary.
    fn keep(&mut self, v: VertexId) {
        let Some(first) = self.topology.ring(v).next() else { return };
        let vertex = VertexId(self.vertices.len() as u32);
        self.vertices.push(self.value(first));
        for h in self.topology.ring(v) {
            self.of_corner[h.index()] = vertex;
        }
        let sharpness = self.vertex_sharpness[v.index()];
        if sharpness > 0.0 {
            self.corners.push(Corner { vertex, sharpness });
        }
    }

    fn value(&self, h: HalfEdgeId) -> u32 {
        self.values[h.index()]
    }

    /// Whether the two faces of the edge of `h` have different values at one of its ends, or there
    /// is one face only.
    fn is_seam(&self, h: HalfEdgeId) -> bool {
        let Some(twin) = self.topology.twin(h) else { return true };
        let next = |h| self.topology.next(h);
        self.value(h) != self.value(next(twin)) || self.value(next(h)) != self.value(twin)
    }

    /// Whether the edge of `h` is a seam between two faces.
    fn is_inner_seam(&self, h: HalfEdgeId) -> bool {
        self.topology.twin(h).is_some() && self.is_seam(h)
    }

    /// The fans at `v`, counter-clockwise.
    fn fans(&self, v: VertexId) -> Vec<Fan> {
        let mut ring: Vec<HalfEdgeId> = self.topology.ring(v).collect();
        let seam = ring.iter().position(|&h| self.is_seam(h));
        ring.rotate_left(seam.unwrap_or(0));
        let mut fans: Vec<Fan> = Vec::new();
        for (k, &h) in ring.iter().enumerate() {
            match fans.last_mut() {
                Some(fan) if !self.is_seam(h) => {
                    fan.faces.push(h);
                    fan.inner.push(self.edge_sharpness[h.index()]);
                }
                _ => {
                    // Faces around a vertex without a seam close at their first edge.
                    let inner = if k == 0 && seam.is_none() {
                        vec![self.edge_sharpness[h.index()]]
                    } else {
                        vec![]
                    };
                    fans.push(Fan { value: self.value(h), faces: vec![h], inner });
                }
            }
        }
        fans
    }

    /// The sharpness of the primvar's vertices at `v`.
    fn fan_sharpness(&self, v: VertexId, fans: &[Fan]) -> Vec<f64> {
        let own = self.vertex_sharpness[v.index()];
        let is_boundary = self.topology.is_boundary(v);
        if !fans.iter().any(|fan| self.is_inner_seam(fan.faces[0])) {
            let is_sharp = is_boundary && self.is_sharp_boundary(fans);
            return vec![if is_sharp { f64::INFINITY } else { own }; fans.len()];
        }
        if own >= INFINITELY_SHARP || self.are_all_sharp(fans, is_boundary) {
            return vec![f64::INFINITY; fans.len()];
        }
        let sharpness = fans.iter().map(|fan| {
            let alone = || fans.iter().filter(|other| other.value == fan.value).count() == 1;
            let is_tip = fan.faces.len() == 1 && self.rule != FaceVaryingRule::None;
            let is_sharp = is_tip || fan.has_infinite_edge() || !alone();
            if is_sharp { f64::INFINITY } else { own }
        });
        sharpness.collect()
    }

    /// Whether the boundary of the cage is sharp at a vertex without seams.
    fn is_sharp_boundary(&self, fans: &[Fan]) -> bool {
        let is_tip = fans.iter().all(|fan| fan.faces.len() == 1);
        let tips_are_sharp =
            self.rule != FaceVaryingRule::None || self.boundary == BoundaryRule::EdgeAndCorner;
        self.has_sharp_seams() || is_tip && tips_are_sharp
    }

    fn has_sharp_seams(&self) -> bool {
        matches!(self.rule, FaceVaryingRule::Boundaries | FaceVaryingRule::All)
    }

    /// Whether fans depend on each other.
    fn has_dependence(&self) -> bool {
        matches!(self.rule, FaceVaryingRule::CornersPlus1 | FaceVaryingRule::CornersPlus2)
    }

    /// Whether all vertices of the primvar are sharp at a vertex with a seam.
    fn are_all_sharp(&self, fans: &[Fan], is_boundary: bool) -> bool {
        let values: BTreeSet<u32> = fans.iter().map(|fan| fan.value).collect();
        let plus2 = self.rule == FaceVaryingRule::CornersPlus2;
        let is_broken = || fans.len() > values.len() || fans.iter().any(Fan::has_infinite_edge);
        let has_tip = || fans.iter().any(|fan| fan.faces.len() == 1);
        self.has_sharp_seams()
            || match values.len() {
                1 => plus2 && !is_boundary,
                2 => self.has_dependence() && is_broken() || plus2 && has_tip(),
                _ => self.has_dependence(),
            }
    }

    /// The semi-sharp edges at `v` that do not belong to fan `own`, whose own sharpness is given. A
    /// fan with semi-sharp edges is a corner for some refinements, and a fan without beside it is a
    /// corner for as long. But a fan that is sharp itself does not depend on others.
    fn beyond(&self, v: VertexId, fans: &[Fan], own: usize, sharpness: f64) -> Beyond {
        let depends = self.has_dependence()
            && fans.len() == 2
            && sharpness == 0.0
            && fans[own].semi_sharp().next().is_none();
        let others = fans.iter().enumerate().filter(|&(k, _)| k != own);
        let others = others.flat_map(|(_, fan)| fan.semi_sharp());
        let seams = self.topology.ring(v).filter(|&h| self.is_inner_seam(h));
        let seams = seams.map(|h| self.edge_sharpness[h.index()]).filter(|&s| is_semi_sharp(s));
        if depends {
            Beyond { holding: others.collect(), apart: seams.collect(), ..Beyond::default() }
        } else {
            Beyond { apart: others.chain(seams).collect(), ..Beyond::default() }
        }
    }

    /// The tags of the primvar.
    fn own_tags(&self) -> Tags {
        let creases = self.topology.half_edges().filter(|&h| {
            // Once per edge that is none of the primvar's boundaries.
            let is_first = self.topology.twin(h).is_some_and(|twin| h < twin);
            is_first && self.edge_sharpness[h.index()] > 0.0 && !self.is_seam(h)
        });
        let of = |h: HalfEdgeId| self.of_corner[h.index()];
        let crease = |h: HalfEdgeId| Crease {
            edge: [of(h), of(self.topology.next(h))],
            sharpness: self.edge_sharpness[h.index()],
        };
        Tags {
            boundary: BoundaryRule::EdgeOnly,
            crease_method: self.tags.crease_method,
            face_varying: self.rule,
            creases: creases.map(crease).collect(),
            corners: self.corners.clone(),
            holes: self.tags.holes.clone(),
        }
    }
}
