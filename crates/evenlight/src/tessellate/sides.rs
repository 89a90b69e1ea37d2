//! The sides of vertices: along folds the surface has several normals at one point.
//!
//! An infinitely sharp edge with a surface on both sides is a *fold*. It cuts the faces around a
//! vertex into fans, and each fan is a *side* of the vertex, with the normal and the curvature that
//! the surface has there from its own quads:
//!
//! ```text
//!      |     |     |            s: sides; a vertex without folds has one, a node inside a
//!  ----o-----o-----o----        fold two, a vertex at which k folds end k, but one where a
//!      |   s | s   |            fold ends in a smooth face (a dart)
//!      |     #     |
//!  ----o   s # s   o----        #: a fold
//!      |     #     |
//!      |   s | s   |            Of the vertex at the top all four faces are one side: there the
//!  ----o--s--o--s--o----        fold ends.
//! ```
//!
//! A vertex' first side, which has its number, is that with its lowest quad. The other sides are
//! numbered behind all vertices.

use super::TessellateError;
use super::nodes::Nodes;
use crate::mesh::{FaceId, HalfEdgeId, Topology, VertexId};
use crate::surface::Surface;

/// The sides of all nodes that are not their first.
#[derive(Debug, Default)]
pub(super) struct Sides {
    /// In the order of faces, then of nodes.
    entries: Vec<Entry>,
    /// The node of every further side.
    nodes: Vec<u32>,
    /// The number of the first further side.
    first: u32,
}

/// In `face`, node `node` has side `side`, which is not its first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    face: FaceId,
    node: u32,
    side: u32,
}

/// The further sides of the nodes of one face.
#[derive(Clone, Copy, Debug)]
pub(super) struct SidesOfFace<'a>(&'a [Entry]);

impl SidesOfFace<'_> {
    /// The side of `node` in this face.
    pub fn side(self, node: u32) -> u32 {
        let found = self.0.binary_search_by_key(&node, |entry| entry.node);
        found.map_or(node, |k| self.0[k].side)
    }
}

impl Sides {
    /// Numbers the sides of the nodes of `surface`.
    pub fn number(surface: &Surface, nodes: &Nodes) -> Result<Self, TessellateError> {
        let folds = folds(surface);
        let mut sides = Self { first: nodes.len() as u32, ..Self::default() };
        // An upper bound: folds end in two vertices, and add no more than a side to each.
        let most = (nodes.rate() as u64 + 1).saturating_mul(folds.len() as u64);
        if most.saturating_add(nodes.len() as u64) >= u64::from(u32::MAX) {
            return Err(TessellateError::TooManyVertices { rate: nodes.rate() });
        }
        let topology = surface.topology();
        for v in ends(topology, &folds) {
            sides.split_vertex(surface, nodes, v);
        }
        for h in folds.into_iter().filter(|&h| has_two_sides(surface, h)) {
            let face = topology.twin(h).map(|twin| topology.face(twin));
            for (face, node) in face.into_iter().flat_map(|f| nodes.inside(h).map(move |n| (f, n)))
            {
                sides.add(node, [face]);
            }
        }
        sides.entries.sort_unstable();
        Ok(sides)
    }

    /// Adds a side of `node`, in `faces`.
    fn add(&mut self, node: u32, faces: impl IntoIterator<Item = FaceId>) {
        let side = self.first + self.nodes.len() as u32;
        self.nodes.push(node);
        self.entries.extend(faces.into_iter().map(|face| Entry { face, node, side }));
    }

    /// Gives `v` a side for every fan of faces but the one with the lowest.
    fn split_vertex(&mut self, surface: &Surface, nodes: &Nodes, v: VertexId) {
        let fans = fans(surface, v);
        let Some(own) = fans.iter().filter_map(|fan| fan.iter().min()).min() else { return };
        for fan in fans.iter().filter(|fan| !fan.contains(own)) {
            self.add(nodes.at_vertex(v), fan.iter().copied());
        }
    }

    /// The node of every further side.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// The further sides in `face`.
    pub fn of_face(&self, face: FaceId) -> SidesOfFace<'_> {
        let start = self.entries.partition_point(|entry| entry.face < face);
        let len = self.entries[start..].partition_point(|entry| entry.face == face);
        SidesOfFace(&self.entries[start..start + len])
    }
}

/// The infinitely sharp edges inside the cage, as the lower of their half-edges, in order.
fn folds(surface: &Surface) -> Vec<HalfEdgeId> {
    let topology = surface.topology();
    let is_first = |h: &HalfEdgeId| topology.twin(*h).is_some_and(|twin| *h < twin);
    topology.half_edges().filter(|h| is_first(h) && surface.is_infinitely_sharp(*h)).collect()
}

/// Whether there is a surface on both sides of the edge of `h`.
fn has_two_sides(surface: &Surface, h: HalfEdgeId) -> bool {
    let topology = surface.topology();
    let mut sides = [Some(h), topology.twin(h)].into_iter();
    sides.all(|h| h.is_some_and(|h| !surface.is_omitted(topology.face(h))))
}

/// The vertices at the ends of edges, in order.
fn ends(topology: &Topology, edges: &[HalfEdgeId]) -> Vec<VertexId> {
    let ends = edges.iter().flat_map(|&h| [topology.origin(h), topology.target(h)]);
    let mut ends: Vec<VertexId> = ends.collect();
    ends.sort_unstable();
    ends.dedup();
    ends
}

/// The faces with a surface around `v`, between one infinitely sharp edge and the next.
/// Omitted faces separate nothing: the surface goes on under them.
fn fans(surface: &Surface, v: VertexId) -> Vec<Vec<FaceId>> {
    let topology = surface.topology();
    let mut ring: Vec<HalfEdgeId> = topology.ring(v).collect();
    let first = ring.iter().position(|&h| surface.is_infinitely_sharp(h));
    ring.rotate_left(first.unwrap_or(0));
    let fans = ring.chunk_by(|_, &h| !surface.is_infinitely_sharp(h));
    let faces = |fan: &[HalfEdgeId]| -> Vec<FaceId> {
        fan.iter().map(|&h| topology.face(h)).filter(|&f| !surface.is_omitted(f)).collect()
    };
    fans.map(faces).filter(|fan| !fan.is_empty()).collect()
}
