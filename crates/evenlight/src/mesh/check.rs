//! What input is accepted: the step from [`Mesh`] to [`Cage`].
//!
//! A cage is an orientable surface, possibly with boundary and in several pieces:
//!
//! * there are faces, and each has three corners or more, all different vertices that exist;
//! * every coordinate is a finite number;
//! * every edge has one face, or two that run through it in opposite directions;
//! * the faces around every vertex form one fan;
//! * tags are on edges, vertices and faces that exist, and sharpness is 0 or more;
//! * every primvar has as many values as it needs, of one to four finite numbers each.
//!
//! ```text
//!   three faces on      opposite           two fans at v
//!      an edge         orientation           ("bow-tie")
//!
//!     +   +   +        +---<---+---<---+       +       +
//!      \  |  /         |       ^       |       | \   / |
//!       \ | /          v       ^       ^       |   v   |
//!         +            |       ^       |       | /   \ |
//!         +            +--->---+--->---+       +       +
//! ```
//!
//! A vertex in no face is no fault: it is reported and ignored. The shape may be anything: faces
//! may be degenerate, pass through each other or lie upon each other.

mod primvars;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::sharpness::half_edges_of;
use super::topology::{MAX_COUNT, face_faults};
use super::{
    CheckError, FaceId, Faces, Mesh, MeshError, Primvar, Tagged, Tags, Topology, VertexId, Warning,
};
use crate::point::Point;

/// A mesh that passed all checks, with its connectivity.
///
/// Cheap to clone: all parts are shared.
#[derive(Clone, Debug)]
pub struct Cage {
    positions: Arc<[Point]>,
    topology: Arc<Topology>,
    tags: Arc<Tags>,
    primvars: Arc<[Primvar]>,
    warnings: Arc<[Warning]>,
}

impl Cage {
    /// Checks `mesh`. Takes time linear in its size, apart from the sorting of each vertex's
    /// edges. Vertices and faces keep their numbers.
    ///
    /// # Errors
    ///
    /// All faults of one step; later steps assume that the earlier found none:
    /// 1. the numbers of vertices and faces (0 faces, 2^32 or more of either),
    /// 2. positions, each face and each primvar for itself,
    /// 3. edges,
    /// 4. the fans of vertices,
    /// 5. the tags.
    ///
    /// A crease between vertices that no edge joins is refused, though OpenSubdiv passes over it:
    /// whoever wrote the tags made a mistake, and would not get the surface that was meant.
    ///
    /// ```
    /// use evenlight::mesh::{Cage, Mesh};
    ///
    /// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    /// assert!(Cage::new(Mesh::new(square.clone(), [[0, 1, 2, 3]])).is_ok());
    /// let fault = Cage::new(Mesh::new(square, [[0, 1, 2], [0, 1, 3]])).unwrap_err();
    /// assert!(fault.to_string().starts_with("faces 0 and 1 both run from vertex 0 to vertex 1"));
    /// ```
    pub fn new(mesh: Mesh) -> Result<Self, CheckError> {
        let errors = own_faults(&mesh, MAX_COUNT);
        if !errors.is_empty() {
            return Err(CheckError { errors });
        }
        let topology = connect(&mesh.faces, mesh.positions.len())?;
        let errors = tag_faults(&topology, &mesh.tags);
        if !errors.is_empty() {
            return Err(CheckError { errors });
        }
        let warnings = warnings(&topology).into();
        let Mesh { positions, tags, primvars, .. } = mesh;
        let (topology, tags) = (Arc::new(topology), Arc::new(tags));
        Ok(Self {
            positions: positions.into(),
            topology,
            tags,
            primvars: primvars.into(),
            warnings,
        })
    }

    /// The same cage with other positions for all vertices.
    ///
    /// # Errors
    ///
    /// [`ValuesError`] if there is not one position for each vertex, or one is not finite.
    pub fn with_positions(&self, positions: Vec<Point>) -> Result<Self, ValuesError> {
        check_values(&positions, self.positions.len())?;
        Ok(Self { positions: positions.into(), ..self.clone() })
    }

    /// The position of every vertex, vertices in no face included.
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// The connectivity.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Boundary rule, creases, corners, holes.
    pub fn tags(&self) -> &Tags {
        &self.tags
    }

    /// Values beside the positions.
    pub fn primvars(&self) -> &[Primvar] {
        &self.primvars
    }

    /// What was accepted but should be known.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    pub(crate) fn shared_positions(&self) -> &Arc<[Point]> {
        &self.positions
    }

    pub(crate) fn shared_topology(&self) -> &Arc<Topology> {
        &self.topology
    }

    pub(crate) fn shared_tags(&self) -> &Arc<Tags> {
        &self.tags
    }

    pub(crate) fn shared_primvars(&self) -> &Arc<[Primvar]> {
        &self.primvars
    }

    /// The number of vertices that are in a face.
    pub fn num_used_vertices(&self) -> usize {
        self.used_vertices().count()
    }

    /// The number of faces.
    pub fn num_faces(&self) -> usize {
        self.topology.faces().len()
    }

    /// The number of edges, boundary edges included.
    pub fn num_edges(&self) -> usize {
        // An inner edge is two half-edges, a boundary edge one.
        (self.topology.half_edges().count() + self.num_boundary_edges()) / 2
    }

    /// The number of edges with one face; 0 if the surface is closed.
    pub fn num_boundary_edges(&self) -> usize {
        self.topology.half_edges().filter(|&h| self.topology.twin(h).is_none()).count()
    }

    /// The number of connected pieces.
    pub fn num_components(&self) -> usize {
        let mut sets = DisjointSets::new(self.positions.len());
        let joins: usize = self.topology.faces().iter().map(|face| sets.join_all(face)).sum();
        self.num_used_vertices() - joins
    }

    /// How many interior vertices there are of each valence; 4 is the regular one.
    pub fn interior_valences(&self) -> BTreeMap<usize, usize> {
        let interior = self.used_vertices().filter(|&v| !self.topology.is_boundary(v));
        histogram(interior.map(|v| self.topology.valence(v)))
    }

    /// How many faces there are of each number of corners.
    pub fn face_sizes(&self) -> BTreeMap<usize, usize> {
        histogram(self.topology.faces().iter().map(<[VertexId]>::len))
    }

    fn used_vertices(&self) -> impl Iterator<Item = VertexId> {
        vertices(&self.topology).filter(|&v| self.topology.is_used(v))
    }
}

/// Why values do not fit the vertices of a cage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ValuesError {
    /// There are not as many values as vertices.
    #[error("there are {found} values for {expected} vertices: give one for each")]
    Count {
        /// The number of vertices.
        expected: usize,
        /// The number of values.
        found: usize,
    },
    /// A number is NaN or infinite.
    #[error("the value of vertex {} is not finite: give it finite numbers", vertex.0)]
    NotFinite {
        /// The first such vertex.
        vertex: VertexId,
    },
}

/// Checks the values of this number of vertices.
pub(crate) fn check_values<const N: usize>(
    values: &[[f64; N]],
    num_vertices: usize,
) -> Result<(), ValuesError> {
    if values.len() != num_vertices {
        return Err(ValuesError::Count { expected: num_vertices, found: values.len() });
    }
    match values.iter().position(|value| value.iter().any(|x| !x.is_finite())) {
        Some(v) => Err(ValuesError::NotFinite { vertex: VertexId(v as u32) }),
        None => Ok(()),
    }
}

/// What is wrong before faces are compared with each other.
fn own_faults(mesh: &Mesh, max_count: usize) -> Vec<MeshError> {
    let mut errors = count_faults(mesh, max_count);
    if errors.is_empty() {
        errors.extend(position_faults(&mesh.positions));
        errors.extend(face_faults(&mesh.faces, mesh.positions.len()));
        errors.extend(primvars::faults(mesh));
    }
    errors
}

fn count_faults(mesh: &Mesh, limit: usize) -> Vec<MeshError> {
    let counts = [
        ("vertices", mesh.positions.len(), limit),
        ("faces", mesh.faces.len(), limit),
        ("corners", mesh.faces.all_corners().len(), MAX_COUNT),
    ];
    let too_many = counts.into_iter().filter(|&(_, count, limit)| count > limit);
    let mut errors: Vec<MeshError> =
        too_many.map(|(what, count, limit)| MeshError::TooLarge { what, count, limit }).collect();
    if mesh.faces.is_empty() {
        errors.push(MeshError::NoFaces { num_vertices: mesh.positions.len() });
    }
    errors
}

fn position_faults(positions: &[Point]) -> impl Iterator<Item = MeshError> {
    let faulty = positions.iter().zip(0..).filter(|(p, _)| p.iter().any(|x| !x.is_finite()));
    faulty.map(|(&position, v)| MeshError::NonFinitePosition { vertex: VertexId(v), position })
}

/// Tags on what does not exist, and sharpness that is negative or NaN.
fn tag_faults(topology: &Topology, tags: &Tags) -> Vec<MeshError> {
    let has_vertex = |v: VertexId| v.index() < topology.num_vertices();
    let has_edge = |edge: [VertexId; 2]| {
        edge.into_iter().all(has_vertex) && half_edges_of(topology, edge).next().is_some()
    };
    let creases =
        tags.creases.iter().map(|c| (Tagged::Edge(c.edge), has_edge(c.edge), c.sharpness));
    let corners = tags.corners.iter();
    let corners = corners.map(|c| (Tagged::Vertex(c.vertex), has_vertex(c.vertex), c.sharpness));
    let holes = tags.holes.iter();
    let holes = holes.map(|&f| (Tagged::Face(f), f.index() < topology.faces().len(), 0.0));
    let fault = |(what, exists, sharpness): (Tagged, bool, f64)| {
        if !exists {
            Some(MeshError::UnknownTag { what })
        } else if sharpness.is_nan() || sharpness < 0.0 {
            Some(MeshError::Sharpness { what, sharpness })
        } else {
            None
        }
    };
    creases.chain(corners).chain(holes).filter_map(fault).collect()
}

/// Connects the faces, after each was checked by itself.
fn connect(faces: &Faces, num_vertices: usize) -> Result<Topology, CheckError> {
    let topology = Topology::of_checked(faces.clone(), num_vertices);
    topology.map_err(|errors| CheckError { errors: name_duplicates(faces, errors) })
}

/// Reports faults that a repeated face causes as that repeated face.
fn name_duplicates(faces: &Faces, mut errors: Vec<MeshError>) -> Vec<MeshError> {
    let first = first_of_duplicates(faces, &errors);
    errors.retain(|error| {
        let mut seen = BTreeSet::new();
        edge_faces(error).iter().all(|f| seen.insert(*first.get(f).unwrap_or(f)))
    });
    let duplicates = first.iter().map(|(&second, &first)| [first, second]);
    duplicates.map(|faces| MeshError::DuplicateFace { faces }).chain(errors).collect()
}

/// For every face in `errors` that repeats an earlier face in `errors`: the first such face.
fn first_of_duplicates(faces: &Faces, errors: &[MeshError]) -> BTreeMap<FaceId, FaceId> {
    let suspects: BTreeSet<FaceId> = errors.iter().flat_map(edge_faces).copied().collect();
    let mut first_with = BTreeMap::new();
    let mut first_of = BTreeMap::new();
    for face in suspects {
        let first = *first_with.entry(canonical(faces.corners(face))).or_insert(face);
        if first != face {
            first_of.insert(face, first);
        }
    }
    first_of
}

/// The faces that meet at the edge of a fault; none if the fault is not one of an edge.
fn edge_faces(error: &MeshError) -> &[FaceId] {
    match error {
        MeshError::InconsistentOrientation { faces, .. } => faces,
        MeshError::EdgeWithManyFaces { faces, .. } => faces,
        _ => &[],
    }
}

/// The corners from the lowest one towards its lower neighbour: the same list, whatever the first
/// corner and the direction of the face are.
fn canonical(corners: &[VertexId]) -> Vec<VertexId> {
    let mut corners = corners.to_vec();
    let lowest = (0..corners.len()).min_by_key(|&i| corners[i]).unwrap_or(0);
    corners.rotate_left(lowest);
    if corners[1] > corners[corners.len() - 1] {
        corners[1..].reverse();
    }
    corners
}

fn warnings(topology: &Topology) -> Vec<Warning> {
    let unused: Vec<VertexId> = vertices(topology).filter(|&v| !topology.is_used(v)).collect();
    if unused.is_empty() { Vec::new() } else { vec![Warning::UnusedVertices(unused)] }
}

fn vertices(topology: &Topology) -> impl Iterator<Item = VertexId> + use<> {
    (0..topology.num_vertices() as u32).map(VertexId)
}

fn histogram(values: impl Iterator<Item = usize>) -> BTreeMap<usize, usize> {
    let mut counts = BTreeMap::new();
    for value in values {
        *counts.entry(value).or_insert(0) += 1;
    }
    counts
}

/// Sets of vertices that only grow together; each is a tree of links towards its root.
struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    fn new(num_vertices: usize) -> Self {
        Self { parent: (0..num_vertices as u32).collect() }
    }

    fn root(&mut self, v: VertexId) -> u32 {
        let mut v = v.0;
        while self.parent[v as usize] != v {
            let grandparent = self.parent[self.parent[v as usize] as usize];
            self.parent[v as usize] = grandparent;
            v = grandparent;
        }
        v
    }

    /// Joins the sets of all corners; gives the number of pairs of sets that became one.
    fn join_all(&mut self, corners: &[VertexId]) -> usize {
        corners.windows(2).filter(|edge| self.join(edge[0], edge[1])).count()
    }

    fn join(&mut self, v: VertexId, w: VertexId) -> bool {
        let (v, w) = (self.root(v), self.root(w));
        self.parent[v.max(w) as usize] = v.min(w);
        v != w
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Corner, Crease};

    /// The faults of a mesh with these faces, over points that do not matter.
    fn faults(num_vertices: usize, faces: &[&[u32]]) -> Vec<MeshError> {
        let mesh = Mesh::new(vec![[0.0; 3]; num_vertices], faces);
        Cage::new(mesh).map_or_else(|error| error.errors, |_| Vec::new())
    }

    fn cage(num_vertices: usize, faces: &[&[u32]]) -> Cage {
        Cage::new(Mesh::new(vec![[0.0; 3]; num_vertices], faces)).unwrap()
    }

    const CUBE: [&[u32]; 6] =
        [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

    #[test]
    fn a_mesh_without_faces_is_refused() {
        assert_eq!(faults(0, &[]), [MeshError::NoFaces { num_vertices: 0 }]);
        assert_eq!(faults(8, &[]), [MeshError::NoFaces { num_vertices: 8 }]);
    }

    #[test]
    fn every_faulty_face_is_named_with_its_first_fault_per_kind() {
        let found = faults(4, &[&[0, 1, 2], &[0, 1], &[], &[0, 4, 1], &[1, 2, 3, 2, 1]]);
        let [few, none, range, repeated] = &found[..] else { panic!("{found:?}") };
        assert_eq!(*few, MeshError::TooFewCorners { face: FaceId(1), num_corners: 2 });
        assert_eq!(*none, MeshError::TooFewCorners { face: FaceId(2), num_corners: 0 });
        let (face, vertex) = (FaceId(3), VertexId(4));
        assert_eq!(*range, MeshError::IndexOutOfRange { face, vertex, num_vertices: 4 });
        let (face, vertex) = (FaceId(4), VertexId(2));
        assert_eq!(*repeated, MeshError::RepeatedVertex { face, vertex });
    }

    #[test]
    fn nan_and_infinite_coordinates_are_refused_wherever_they_are() {
        for (axis, value) in [(0, f64::NAN), (1, f64::INFINITY), (2, f64::NEG_INFINITY)] {
            // Vertex 3 is in no face: its position would still be seen by whoever asks for all.
            for vertex in 0..4 {
                let mut positions = vec![[0.0; 3]; 4];
                positions[vertex][axis] = value;
                let error = Cage::new(Mesh::new(positions, [[0, 1, 2]])).unwrap_err();
                let named = VertexId(vertex as u32);
                assert!(matches!(error.errors[..],
                    [MeshError::NonFinitePosition { vertex, .. }] if vertex == named));
            }
        }
    }

    #[test]
    fn more_vertices_or_faces_than_can_be_numbered_are_refused() {
        let mesh = Mesh::new(vec![[0.0; 3]; 5], [[0, 1, 2], [1, 0, 3], [2, 1, 4], [0, 2, 3]]);
        assert_eq!(own_faults(&mesh, 5), []);
        let vertices = MeshError::TooLarge { what: "vertices", count: 5, limit: 4 };
        assert_eq!(own_faults(&mesh, 4), [vertices]);
        let found = own_faults(&mesh, 3);
        let faces = MeshError::TooLarge { what: "faces", count: 4, limit: 3 };
        assert!(found.len() == 2 && found[1] == faces);
    }

    #[test]
    fn a_bow_tie_is_named_at_its_vertex() {
        let found = faults(5, &[&[0, 1, 2], &[2, 3, 4]]);
        assert_eq!(found, [MeshError::VertexNotAFan { vertex: VertexId(2) }]);
    }

    #[test]
    fn two_cubes_that_share_a_vertex_are_refused_and_without_it_accepted() {
        let shifted = |share: bool| {
            CUBE.map(|f| f.iter().map(|&v| if share && v == 0 { 6 } else { v + 8 }).collect())
        };
        let two_cubes = |share| {
            let mut faces: Vec<Vec<u32>> = CUBE.iter().map(|f| f.to_vec()).collect();
            faces.extend(shifted(share));
            Cage::new(Mesh::new(vec![[0.0; 3]; 16], faces))
        };
        let error = two_cubes(true).unwrap_err();
        assert_eq!(error.errors, [MeshError::VertexNotAFan { vertex: VertexId(6) }]);
        assert_eq!(two_cubes(false).unwrap().num_components(), 2);
    }

    #[test]
    fn a_moebius_strip_cannot_be_oriented() {
        // Five quads between the vertices 0 2 4 6 8 above and 1 3 5 7 9 below; the last is
        // joined to the first with above and below exchanged.
        let strip: [&[u32]; 5] =
            [&[1, 3, 2, 0], &[3, 5, 4, 2], &[5, 7, 6, 4], &[7, 9, 8, 6], &[9, 0, 1, 8]];
        let found = faults(10, &strip);
        let (edge, faces) = ([VertexId(0), VertexId(1)], [FaceId(0), FaceId(4)]);
        assert_eq!(found, [MeshError::InconsistentOrientation { edge, faces }]);
        // Joined without the exchange it is a ring with two boundaries.
        let ring = cage(10, &[strip[0], strip[1], strip[2], strip[3], &[9, 1, 0, 8]]);
        assert_eq!((ring.num_components(), ring.num_boundary_edges()), (1, 10));
        // Whichever faces are flipped, one edge at least stays inconsistent.
        for flipped in 0..32 {
            let faces = (0..5).map(|k| {
                let mut face = strip[k].to_vec();
                if flipped >> k & 1 == 1 {
                    face.reverse();
                }
                face
            });
            let found = Cage::new(Mesh::new(vec![[0.0; 3]; 10], faces)).unwrap_err().errors;
            let inconsistent = |e| matches!(e, &MeshError::InconsistentOrientation { .. });
            assert!(found.len() % 2 == 1 && found.iter().all(inconsistent));
        }
    }

    #[test]
    fn a_flipped_face_is_in_all_faults_of_orientation() {
        for flipped in 0..6 {
            let mut cube = CUBE.map(<[u32]>::to_vec);
            cube[flipped].reverse();
            let errors = Cage::new(Mesh::new(vec![[0.0; 3]; 8], cube)).unwrap_err().errors;
            assert_eq!(errors.len(), 4);
            assert!(errors.iter().all(|e| edge_faces(e).contains(&FaceId(flipped as u32))));
        }
    }

    #[test]
    fn all_faces_of_a_crowded_edge_are_named() {
        let found = faults(5, &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]);
        let faces = vec![FaceId(0), FaceId(1), FaceId(2)];
        let edge = [VertexId(0), VertexId(1)];
        assert_eq!(found, [MeshError::EdgeWithManyFaces { edge, faces }]);
    }

    #[test]
    fn a_face_given_twice_is_named_as_that() {
        let faces = [FaceId(2), FaceId(6)];
        // As it is, turned, and flipped.
        for copy in [[0, 1, 5, 4], [5, 4, 0, 1], [1, 0, 4, 5]] {
            let mut cube = CUBE.to_vec();
            cube.push(&copy);
            assert_eq!(faults(8, &cube), [MeshError::DuplicateFace { faces }]);
        }
        // A third face through an edge of it is another fault.
        let found = faults(4, &[&[0, 1, 2], &[0, 1, 2], &[1, 0, 3]]);
        assert_eq!(found, [MeshError::DuplicateFace { faces: [FaceId(0), FaceId(1)] }]);
        // Four corners in another cyclic order are another face.
        let found = faults(4, &[&[0, 1, 2, 3], &[0, 1, 3, 2]]);
        assert!(found.iter().all(|e| matches!(e, MeshError::InconsistentOrientation { .. })));
    }

    #[test]
    fn tags_on_what_is_not_there_are_refused() {
        let mut mesh = Mesh::new(vec![[0.0; 3]; 8], CUBE);
        let crease = |a, b, sharpness| Crease { edge: [a, b].map(VertexId), sharpness };
        mesh.tags.creases = vec![crease(1, 0, 2.0), crease(0, 6, 1.0), crease(0, 8, 1.0)];
        mesh.tags.creases.push(crease(2, 3, -0.5));
        mesh.tags.corners = vec![Corner { vertex: VertexId(9), sharpness: f64::NAN }];
        mesh.tags.holes = vec![FaceId(5), FaceId(6)];
        let found = Cage::new(mesh).unwrap_err().errors;
        let edge = |a, b| Tagged::Edge([a, b].map(VertexId));
        let unknown = [edge(0, 6), edge(0, 8)].map(|what| MeshError::UnknownTag { what });
        assert_eq!(found[..2], unknown);
        assert_eq!(found[2], MeshError::Sharpness { what: edge(2, 3), sharpness: -0.5 });
        let [vertex, face] = [Tagged::Vertex(VertexId(9)), Tagged::Face(FaceId(6))];
        assert_eq!(found[3..], [vertex, face].map(|what| MeshError::UnknownTag { what }));
    }

    #[test]
    fn two_faces_back_to_back_are_a_closed_surface() {
        let cage = cage(3, &[&[0, 1, 2], &[2, 1, 0]]);
        assert_eq!(cage.num_boundary_edges(), 0);
        assert_eq!(cage.interior_valences(), BTreeMap::from([(2, 3)]));
    }

    #[test]
    fn vertices_in_no_face_are_reported_and_change_nothing_else() {
        let cage = cage(7, &[&[1, 2, 4], &[2, 1, 5]]);
        let unused = [0, 3, 6].map(VertexId).to_vec();
        assert_eq!(cage.warnings(), [Warning::UnusedVertices(unused)]);
        assert_eq!((cage.positions().len(), cage.num_used_vertices()), (7, 4));
        assert_eq!(cage.topology().faces().corners(FaceId(1)), [2, 1, 5].map(VertexId));
        assert_eq!(cage.num_components(), 1);
    }

    #[test]
    fn counts_of_a_cube_and_of_a_house_front() {
        let cube = cage(8, &CUBE);
        assert_eq!((cube.num_faces(), cube.num_edges(), cube.num_boundary_edges()), (6, 12, 0));
        assert_eq!(cube.interior_valences(), BTreeMap::from([(3, 8)]));
        assert!(cube.warnings().is_empty());
        // A quad, a triangle as its roof, and a pentagon apart.
        let front = cage(10, &[&[0, 1, 2, 3], &[3, 2, 4], &[5, 6, 7, 8, 9]]);
        assert_eq!(front.face_sizes(), BTreeMap::from([(3, 1), (4, 1), (5, 1)]));
        assert_eq!((front.num_components(), front.num_edges()), (2, 11));
        assert_eq!((front.num_boundary_edges(), front.interior_valences().len()), (10, 0));
    }

    #[test]
    fn cages_can_be_shared_between_threads() {
        fn shareable<T: Send + Sync>() {}
        shareable::<Arc<Cage>>();
    }
}
