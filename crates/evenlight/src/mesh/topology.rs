//! Connectivity as half-edges, without positions.
//!
//! A half-edge is one side of an edge; it belongs to the face on its left and is named by the
//! corner at which it starts, so half-edges are numbered like the corners of all faces:
//!
//! ```text
//!        d <------- c            h = a -> b            origin(h) = a, target(h) = b
//!        |     f    ^            next(h) = b -> c      previous(h) = d -> a
//!        v    h     |            twin(h) = b -> a, in the face below (None at a boundary)
//!        a -------> b
//! ```
//!
//! Around a vertex `v` the outgoing half-edges follow counter-clockwise by
//! `h -> twin(previous(h))`. The face of an outgoing half-edge is the *sector* between it and
//! the next one.

use super::{FaceId, Faces, MeshError, VertexId};

/// The number of a half-edge: the position of its first corner in [`Faces::all_corners`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct HalfEdgeId(pub u32);

impl HalfEdgeId {
    /// The number as an index into an array.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A half-edge of a [`Topology`]; its methods lead to its neighbours. Made by [`Topology::get`]
/// and [`Topology::half_edge_at`].
///
/// ```
/// use evenlight::{Cage, FaceId, Mesh, VertexId};
///
/// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
/// let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]]))?;
/// let h = cage.topology().half_edge_at(FaceId(0), 1).expect("the face has a corner 1");
/// assert_eq!([h.origin(), h.target(), h.next().target()], [1, 2, 3].map(VertexId));
/// assert!(h.twin().is_none(), "there is no other face");
/// assert!(cage.topology().half_edge_at(FaceId(0), 4).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct HalfEdge<'a> {
    topology: &'a Topology,
    id: HalfEdgeId,
}

impl HalfEdge<'_> {
    /// Its number.
    pub fn id(self) -> HalfEdgeId {
        self.id
    }

    /// The face on its left.
    pub fn face(self) -> FaceId {
        self.topology.face(self.id)
    }

    /// The corner of its face at which it starts.
    pub fn corner(self) -> usize {
        self.topology.corner(self.id)
    }

    /// The vertex at which it starts.
    pub fn origin(self) -> VertexId {
        self.topology.origin(self.id)
    }

    /// The vertex at which it ends.
    pub fn target(self) -> VertexId {
        self.topology.target(self.id)
    }

    /// The next half-edge around its face.
    #[must_use]
    pub fn next(self) -> Self {
        Self { id: self.topology.next(self.id), ..self }
    }

    /// The half-edge before it around its face.
    #[must_use]
    pub fn previous(self) -> Self {
        Self { id: self.topology.previous(self.id), ..self }
    }

    /// The other side of its edge; `None` at a boundary.
    #[must_use]
    pub fn twin(self) -> Option<Self> {
        self.topology.twin(self.id).map(|id| Self { id, ..self })
    }
}

const NONE: u32 = u32::MAX;

/// The highest number of vertices, faces and corners; one more would be mistaken for `NONE`.
pub(super) const MAX_COUNT: usize = u32::MAX as usize;

/// The connectivity of an orientable surface mesh, possibly with boundary.
///
/// By construction every edge has one or two faces, neighbouring faces have the same
/// orientation, and the faces of every vertex form one fan.
#[derive(Clone, Debug)]
pub struct Topology {
    faces: Faces,
    /// The face of each half-edge.
    face: Vec<FaceId>,
    /// The other side of each half-edge, or `NONE`.
    twin: Vec<u32>,
    /// One outgoing half-edge of each vertex, the clockwise-most at a boundary; `NONE` if
    /// the vertex is in no face.
    outgoing: Vec<u32>,
    /// The number of faces around each vertex.
    num_sectors: Vec<u32>,
}

impl Topology {
    /// Connects `faces` over `num_vertices` vertices.
    ///
    /// Takes time and memory linear in the number of corners.
    ///
    /// # Errors
    ///
    /// All faces that have fewer than three corners, a repeated corner or one out of range. If
    /// there are none, all places where the faces are not an orientable surface: an edge with
    /// three faces or more, two neighbours of opposite orientation, a vertex whose faces form more
    /// than one fan.
    pub fn build(faces: Faces, num_vertices: usize) -> Result<Self, Vec<MeshError>> {
        let counts = [("vertices", num_vertices), ("corners", faces.all_corners().len())];
        let too_many = counts.into_iter().find(|&(_, count)| count > MAX_COUNT);
        let errors = match too_many {
            Some((what, count)) => vec![MeshError::TooLarge { what, count, limit: MAX_COUNT }],
            None => face_faults(&faces, num_vertices),
        };
        if errors.is_empty() { Self::of_checked(faces, num_vertices) } else { Err(errors) }
    }

    /// [`Topology::build`] for faces that have no fault by themselves.
    pub(super) fn of_checked(faces: Faces, num_vertices: usize) -> Result<Self, Vec<MeshError>> {
        let face = faces.ids().flat_map(|f| vec![f; faces.corner_range(f).len()]).collect();
        let twin = vec![NONE; faces.all_corners().len()];
        let (outgoing, num_sectors) = (vec![NONE; num_vertices], vec![0; num_vertices]);
        let mut topology = Self { faces, face, twin, outgoing, num_sectors };
        let mut errors = topology.pair_half_edges(num_vertices);
        if errors.is_empty() {
            errors = topology.form_fans();
        }
        if errors.is_empty() { Ok(topology) } else { Err(errors) }
    }

    /// The same faces over other vertices. Edges are cut where the two faces have different
    /// vertices at an end. The result is the same as from [`Topology::build`], without sorting.
    ///
    /// # Errors
    ///
    /// If the faces of a vertex do not form one fan.
    pub(crate) fn with_vertices(
        &self,
        faces: Faces,
        num_vertices: usize,
    ) -> Result<Self, Vec<MeshError>> {
        let mut twin = vec![NONE; self.twin.len()];
        let at = faces.all_corners();
        for h in self.half_edges() {
            let Some(other) = self.twin(h) else { continue };
            let ends = [h, other, self.next(h), self.next(other)].map(|h| at[h.index()]);
            if ends[0] == ends[3] && ends[1] == ends[2] {
                twin[h.index()] = other.0;
            }
        }
        let (outgoing, num_sectors) = (vec![NONE; num_vertices], vec![0; num_vertices]);
        let mut topology = Self { faces, face: self.face.clone(), twin, outgoing, num_sectors };
        let errors = topology.form_fans();
        if errors.is_empty() { Ok(topology) } else { Err(errors) }
    }

    /// Finds the twin of every half-edge, by sorting the half-edges under their lower vertex.
    fn pair_half_edges(&mut self, num_vertices: usize) -> Vec<MeshError> {
        let mut errors = Vec::new();
        let (starts, sorted) = self.half_edges_by_lower_vertex(num_vertices);
        for v in 0..num_vertices {
            // Few half-edges, but a pole may have thousands: sorted, so that none is quadratic.
            let mut bucket: Vec<(VertexId, HalfEdgeId)> = sorted
                [starts[v] as usize..starts[v + 1] as usize]
                .iter()
                .map(|&h| (self.origin(h).max(self.target(h)), h))
                .collect();
            bucket.sort_unstable();
            for edge in bucket.chunk_by(|a, b| a.0 == b.0) {
                match *edge {
                    [_] => {}
                    [(_, a), (_, b)] if self.origin(a) != self.origin(b) => {
                        self.twin[a.index()] = b.0;
                        self.twin[b.index()] = a.0;
                    }
                    [(_, a), (_, b)] => errors.push(self.inconsistent_orientation(a, b)),
                    _ => errors.push(self.edge_with_many_faces(edge)),
                }
            }
        }
        errors
    }

    fn half_edges_by_lower_vertex(&self, num_vertices: usize) -> (Vec<u32>, Vec<HalfEdgeId>) {
        let lower = |h: HalfEdgeId| self.origin(h).min(self.target(h)).index();
        let mut starts = vec![0u32; num_vertices + 1];
        for h in self.half_edges() {
            starts[lower(h) + 1] += 1;
        }
        for v in 0..num_vertices {
            starts[v + 1] += starts[v];
        }
        let mut sorted = vec![HalfEdgeId(0); self.face.len()];
        let mut free = starts.clone();
        for h in self.half_edges() {
            let slot = &mut free[lower(h)];
            sorted[*slot as usize] = h;
            *slot += 1;
        }
        (starts, sorted)
    }

    fn inconsistent_orientation(&self, a: HalfEdgeId, b: HalfEdgeId) -> MeshError {
        MeshError::InconsistentOrientation {
            edge: [self.origin(a), self.target(a)],
            faces: [self.face(a), self.face(b)],
        }
    }

    fn edge_with_many_faces(&self, edge: &[(VertexId, HalfEdgeId)]) -> MeshError {
        let h = edge[0].1;
        MeshError::EdgeWithManyFaces {
            edge: [self.origin(h), self.target(h)],
            faces: edge.iter().map(|&(_, h)| self.face(h)).collect(),
        }
    }

    /// Chooses the first half-edge of every vertex and checks that its fan has all sectors.
    fn form_fans(&mut self) -> Vec<MeshError> {
        for h in self.half_edges() {
            let v = self.origin(h).index();
            self.num_sectors[v] += 1;
            if self.outgoing[v] == NONE || self.twin(h).is_none() {
                self.outgoing[v] = h.0;
            }
        }
        let vertices = (0..self.num_sectors.len() as u32).map(VertexId);
        vertices
            .filter(|&v| self.ring(v).count() != self.num_sectors(v))
            .map(|vertex| MeshError::VertexNotAFan { vertex })
            .collect()
    }

    /// The faces.
    pub fn faces(&self) -> &Faces {
        &self.faces
    }

    /// The number of vertices, vertices in no face included.
    pub fn num_vertices(&self) -> usize {
        self.outgoing.len()
    }

    /// All half-edges.
    pub fn half_edges(&self) -> impl ExactSizeIterator<Item = HalfEdgeId> + use<> {
        (0..self.face.len() as u32).map(HalfEdgeId)
    }

    /// The half-edge of this number; `None` if there is none.
    pub fn get(&self, h: HalfEdgeId) -> Option<HalfEdge<'_>> {
        (h.index() < self.face.len()).then_some(HalfEdge { topology: self, id: h })
    }

    /// The half-edge that leaves corner `corner` of `face`; `None` if there is no such corner.
    pub fn half_edge_at(&self, face: FaceId, corner: usize) -> Option<HalfEdge<'_>> {
        let has_corner = corner < self.faces.corners(face).len();
        has_corner.then(|| HalfEdge { topology: self, id: self.half_edge(face, corner) })
    }

    /// The half-edge that leaves corner `corner` of `face`, of ids of this topology, like all
    /// methods of the crate that answer without an `Option`.
    pub(crate) fn half_edge(&self, face: FaceId, corner: usize) -> HalfEdgeId {
        HalfEdgeId((self.faces.corner_range(face).start + corner) as u32)
    }

    /// The face on the left of `h`.
    pub(crate) fn face(&self, h: HalfEdgeId) -> FaceId {
        self.face[h.index()]
    }

    /// The corner of its face at which `h` starts.
    pub(crate) fn corner(&self, h: HalfEdgeId) -> usize {
        h.index() - self.faces.corner_range(self.face(h)).start
    }

    /// The vertex at which `h` starts.
    pub(crate) fn origin(&self, h: HalfEdgeId) -> VertexId {
        self.faces.all_corners()[h.index()]
    }

    /// The vertex at which `h` ends.
    pub(crate) fn target(&self, h: HalfEdgeId) -> VertexId {
        self.origin(self.next(h))
    }

    /// The half-edge that follows `h` around its face.
    pub(crate) fn next(&self, h: HalfEdgeId) -> HalfEdgeId {
        let range = self.faces.corner_range(self.face(h));
        if h.index() + 1 == range.end {
            HalfEdgeId(range.start as u32)
        } else {
            HalfEdgeId(h.0 + 1)
        }
    }

    /// The half-edge that comes before `h` around its face.
    pub(crate) fn previous(&self, h: HalfEdgeId) -> HalfEdgeId {
        let range = self.faces.corner_range(self.face(h));
        if h.index() == range.start {
            HalfEdgeId(range.end as u32 - 1)
        } else {
            HalfEdgeId(h.0 - 1)
        }
    }

    /// The other side of the edge of `h`; `None` at a boundary, or if there is no such half-edge.
    pub fn twin(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.twin.get(h.index()).filter(|&&twin| twin != NONE).map(|&twin| HalfEdgeId(twin))
    }

    /// The outgoing half-edges of `v`, counter-clockwise; from the clockwise-most at a
    /// boundary. Empty if `v` is in no face, or there is no such vertex.
    pub fn ring(&self, v: VertexId) -> Ring<'_> {
        let start = self.outgoing(v);
        Ring { topology: self, start, next: start }
    }

    /// One outgoing half-edge of `v`, the clockwise-most at a boundary.
    fn outgoing(&self, v: VertexId) -> Option<HalfEdgeId> {
        self.outgoing.get(v.index()).filter(|&&h| h != NONE).map(|&h| HalfEdgeId(h))
    }

    /// Whether `v` is in a face.
    pub fn is_used(&self, v: VertexId) -> bool {
        self.outgoing(v).is_some()
    }

    /// Whether `v` is on the boundary. A vertex in no face is not.
    pub fn is_boundary(&self, v: VertexId) -> bool {
        self.outgoing(v).is_some_and(|h| self.twin(h).is_none())
    }

    /// The number of faces around `v`; 0 if there is no such vertex.
    pub fn num_sectors(&self, v: VertexId) -> usize {
        self.num_sectors.get(v.index()).map_or(0, |&n| n as usize)
    }

    /// The number of edges at `v`.
    pub fn valence(&self, v: VertexId) -> usize {
        self.num_sectors(v) + usize::from(self.is_boundary(v))
    }
}

/// What is wrong with each face by itself.
pub(super) fn face_faults(faces: &Faces, num_vertices: usize) -> Vec<MeshError> {
    // The last face seen at each vertex: finds repetitions in time linear in the corners.
    let mut last_face: Vec<Option<FaceId>> = vec![None; num_vertices];
    let mut errors = Vec::new();
    for (face, corners) in faces.ids().zip(faces.iter()) {
        if corners.len() < 3 {
            errors.push(MeshError::TooFewCorners { face, num_corners: corners.len() });
        }
        errors.extend(corner_fault(face, corners, &mut last_face));
    }
    errors
}

/// The first corner that is out of range or repeated.
fn corner_fault(
    face: FaceId,
    corners: &[VertexId],
    last_face: &mut [Option<FaceId>],
) -> Option<MeshError> {
    let num_vertices = last_face.len();
    for &vertex in corners {
        let Some(last) = last_face.get_mut(vertex.index()) else {
            return Some(MeshError::IndexOutOfRange { face, vertex, num_vertices });
        };
        if last.replace(face) == Some(face) {
            return Some(MeshError::RepeatedVertex { face, vertex });
        }
    }
    None
}

/// The outgoing half-edges around a vertex; made by [`Topology::ring`].
#[derive(Clone, Debug)]
pub struct Ring<'a> {
    topology: &'a Topology,
    start: Option<HalfEdgeId>,
    next: Option<HalfEdgeId>,
}

impl Iterator for Ring<'_> {
    type Item = HalfEdgeId;

    fn next(&mut self) -> Option<HalfEdgeId> {
        let h = self.next?;
        let following = self.topology.twin(self.topology.previous(h));
        self.next = if following == self.start { None } else { following };
        Some(h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;

    fn topology(num_vertices: usize, faces: &[&[u32]]) -> Result<Topology, Vec<MeshError>> {
        Topology::build(Mesh::new(vec![], faces).faces, num_vertices)
    }

    const CUBE: [&[u32]; 6] =
        [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

    #[test]
    fn half_edges_of_a_cube_obey_their_laws() {
        let t = topology(8, &CUBE).unwrap();
        for h in t.half_edges() {
            let twin = t.twin(h).unwrap();
            assert_eq!(t.twin(twin), Some(h));
            assert_eq!(t.origin(twin), t.target(h));
            assert_eq!(t.previous(t.next(h)), h);
            assert_eq!(t.half_edge(t.face(h), t.corner(h)), h);
        }
        for v in (0..8).map(VertexId) {
            assert_eq!(t.ring(v).count(), 3);
            assert!(t.ring(v).all(|h| t.origin(h) == v));
            assert!(!t.is_boundary(v) && t.valence(v) == 3);
        }
    }

    #[test]
    fn rings_turn_counter_clockwise() {
        // Four quads around vertex 4 of a 3 x 3 grid: 6 7 8 / 3 4 5 / 0 1 2.
        let t = topology(9, &[&[0, 1, 4, 3], &[1, 2, 5, 4], &[3, 4, 7, 6], &[4, 5, 8, 7]]).unwrap();
        let mut around: Vec<u32> = t.ring(VertexId(4)).map(|h| t.target(h).0).collect();
        let first = around.iter().position(|&v| v == 5).unwrap();
        around.rotate_left(first);
        assert_eq!(around, [5, 7, 3, 1]);
        // At the boundary the ring starts at the clockwise-most edge.
        let around: Vec<u32> = t.ring(VertexId(1)).map(|h| t.target(h).0).collect();
        assert_eq!(around, [2, 4]);
        assert_eq!(t.valence(VertexId(1)), 3);
    }

    #[test]
    fn faults_are_named() {
        let err = topology(5, &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]).unwrap_err();
        assert!(
            matches!(&err[..], [MeshError::EdgeWithManyFaces { faces, .. }] if faces.len() == 3)
        );
        let err = topology(4, &[&[0, 1, 2], &[0, 1, 3]]).unwrap_err();
        assert!(matches!(err[..], [MeshError::InconsistentOrientation { .. }]));
        let err = topology(5, &[&[0, 1, 2], &[0, 3, 4]]).unwrap_err();
        assert_eq!(err, [MeshError::VertexNotAFan { vertex: VertexId(0) }]);
    }
}
