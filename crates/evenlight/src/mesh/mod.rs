//! The cage: positions and faces as a file says them, and the checked form of them.
//!
//! [`Mesh`] is what was read; it may have any fault. [`Cage`] is a mesh that passed
//! the checks of [`Cage::new`]: an orientable surface, possibly with boundary, whose connectivity
//! ([`Topology`]) can be walked without a case that fails. All code behind the cage is
//! total: it cannot meet bad input any more.

mod check;
mod fan;
mod fault;
pub mod fix;
pub mod isolation;
mod marks;
mod nets;
pub(crate) mod primvar_net;
pub(crate) mod refine;
pub(crate) mod sharpness;
mod tags;
mod topology;

pub(crate) use check::check_values;
pub use check::{Cage, ValuesError};
pub use fault::{CheckError, LibraryNumbers, MeshError, Names, PrimvarFault, Tagged, Warning};
pub(crate) use fault::{MAX_LISTED, one_per_line};
pub use marks::Marks;
pub(crate) use nets::{RegularNet, cnet_vertices, fan_vertices};
pub use tags::{
    BoundaryRule, Corner, Crease, CreaseMethod, FaceVaryingRule, INFINITELY_SHARP, Interpolation,
    Primvar, Tags,
};
pub use topology::{HalfEdge, HalfEdgeId, Ring, Topology};

pub use crate::net::{Fan, VertexRule};
use crate::point::Point;

/// The number of a vertex, counted from 0 in the order of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct VertexId(pub u32);

/// The number of a face, counted from 0 in the order of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceId(pub u32);

impl VertexId {
    /// The number as an index into an array.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl FaceId {
    /// The number as an index into an array.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A mesh as read; [`Cage::new`] checks it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The position of every vertex.
    pub positions: Vec<Point>,
    /// The corners of every face, counter-clockwise seen from outside.
    pub faces: Faces,
    /// Boundary rule, creases, corners, holes.
    pub tags: Tags,
    /// Values beside the positions.
    pub primvars: Vec<Primvar>,
}

impl Mesh {
    /// Builds a mesh without tags or primvars from positions and lists of vertex numbers (from 0).
    pub fn new<F: AsRef<[u32]>>(positions: Vec<Point>, faces: impl IntoIterator<Item = F>) -> Self {
        let mut list = Faces::default();
        for face in faces {
            list.push(face.as_ref().iter().map(|&v| VertexId(v)));
        }
        Self { positions, faces: list, ..Self::default() }
    }
}

/// The corners of all faces, one after the other, each counter-clockwise.
///
/// ```
/// use evenlight::mesh::{FaceId, Faces, VertexId};
///
/// let mut faces = Faces::default();
/// faces.push([0, 1, 2].map(VertexId));
/// faces.push([2, 1, 3, 4].map(VertexId));
/// assert_eq!(faces.len(), 2);
/// assert_eq!(faces.corners(FaceId(1)), [2, 1, 3, 4].map(VertexId));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Faces {
    /// Where each face begins in `corners`; one entry more than there are faces.
    offsets: Vec<usize>,
    corners: Vec<VertexId>,
}

impl Default for Faces {
    fn default() -> Self {
        Self { offsets: vec![0], corners: Vec::new() }
    }
}

impl Faces {
    /// Appends a face.
    pub fn push(&mut self, corners: impl IntoIterator<Item = VertexId>) {
        self.corners.extend(corners);
        self.offsets.push(self.corners.len());
    }

    /// The number of faces.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there is no face.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The corners of `face`; none if there is no such face.
    pub fn corners(&self, face: FaceId) -> &[VertexId] {
        match self.offsets.get(face.index()..) {
            Some(&[start, end, ..]) => &self.corners[start..end],
            _ => &[],
        }
    }

    /// All faces in order.
    pub fn iter(&self) -> impl Iterator<Item = &[VertexId]> {
        self.offsets.windows(2).map(|w| &self.corners[w[0]..w[1]])
    }

    /// The numbers of all faces.
    pub fn ids(&self) -> impl Iterator<Item = FaceId> + use<> {
        (0..self.len() as u32).map(FaceId)
    }

    /// All corners of all faces, one after the other.
    pub fn all_corners(&self) -> &[VertexId] {
        &self.corners
    }

    /// Where the corners of `face` stand in [`Faces::all_corners`]; `face` must exist.
    pub(crate) fn corner_range(&self, face: FaceId) -> std::ops::Range<usize> {
        self.offsets[face.index()]..self.offsets[face.index() + 1]
    }
}
