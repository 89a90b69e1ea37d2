//! What a tool can honestly repair in a mesh, on request only.
//!
//! ```text
//!  merge d        vertices not further than d from a lower-numbered one become that one; corners
//!                 of a face that fall together, or did before, are one; faces with fewer than
//!                 3 are deleted
//!  flip           in every piece whose faces disagree, the fewer are flipped
//!  split          every fan of faces around a vertex gets a vertex of its own; an edge with
//!                 three faces or more joins none of them (but what is joined round both its
//!                 ends stays joined: two cubes that share an edge become two closed cubes)
//!
//!        +---+                +---+                three faces on an edge:
//!        |   |                |   |                      +   +   +       +  + +  + +  +
//!        +---+---+   ---->    +---+'                      \  |  /         \  | |  | |/
//!            |   |                +---+                    \ | /    -->    \ | |  | |
//!            +---+                |   |                      +              ++ ++ ++
//!                                 +---+
//!  drop unused    vertices in no face are deleted
//! ```
//!
//! The repairs are made in this order. Nothing else changes: positions stay where they are, tags
//! and primvars go with their vertices, faces and corners. A one-sided surface stays as it is, and
//! so does every fault that is not named here.

use super::fault::list;
use super::{CheckError, FaceId, Mesh, MeshError, Names, VertexId};

mod draft;
mod merge;
mod orient;
mod split;

use draft::Draft;

/// What to repair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Repairs {
    /// Merge vertices that are not further apart than this, in the units of the mesh; 0 merges
    /// vertices at the same place. Repeated corners of a face are joined.
    pub merge: Option<f64>,
    /// Flip faces that disagree with most of their piece.
    pub flip: bool,
    /// Split vertices and edges where more than one sheet meets.
    pub split: bool,
    /// Delete vertices in no face.
    pub drop_unused: bool,
}

/// A mesh after repairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Repaired {
    /// The mesh. It is not checked, as it can have other faults.
    pub mesh: Mesh,
    /// What was done, in order; empty if there was nothing to do.
    pub changes: Vec<Change>,
    /// What was asked for but cannot be done.
    pub obstacles: Vec<Obstacle>,
}

/// What was done to a mesh, in the numbers that it had before the repairs.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Change {
    /// Vertices became others.
    Merged {
        /// Each vertex and what it became.
        pairs: Vec<[VertexId; 2]>,
        /// The largest distance between the two.
        distance: f64,
    },
    /// Corners that followed each other at one vertex became one.
    Joined {
        /// The faces, deleted ones among them.
        faces: Vec<FaceId>,
    },
    /// Faces lost all but two of their corners and were deleted.
    Collapsed {
        /// The faces.
        faces: Vec<FaceId>,
    },
    /// The order of the corners of faces was reversed.
    Flipped {
        /// The faces.
        faces: Vec<FaceId>,
    },
    /// Vertices became several, one for every fan of faces.
    Split {
        /// Each vertex and the number of its fans.
        vertices: Vec<(VertexId, usize)>,
    },
    /// Vertices in no face were deleted.
    Dropped {
        /// The vertices.
        vertices: Vec<VertexId>,
    },
}

impl Change {
    /// The change in one sentence.
    pub fn describe(&self, names: &dyn Names) -> String {
        let vertex = |v: &VertexId| names.vertex(*v);
        let face = |f: &FaceId| names.face(*f);
        match self {
            Self::Merged { pairs, distance } => {
                let pair = |[a, b]: &[VertexId; 2]| format!("{} into {}", vertex(a), vertex(b));
                format!(
                    "{} merged, from a distance of {distance} or less: {}",
                    count(pairs.len(), "vertex", "vertices"),
                    list(pairs, pair)
                )
            }
            Self::Joined { faces } => {
                let count = count(faces.len(), "face", "faces");
                format!("repeated corners of {count} joined: {}", list(faces, face))
            }
            Self::Collapsed { faces } => {
                let count = count(faces.len(), "face", "faces");
                format!("{count} deleted, without 3 corners left: {}", list(faces, face))
            }
            Self::Flipped { faces } => {
                format!("{} flipped: {}", count(faces.len(), "face", "faces"), list(faces, face))
            }
            Self::Split { vertices } => {
                let into = |(v, fans): &(VertexId, usize)| format!("{} into {fans}", vertex(v));
                let count = count(vertices.len(), "vertex", "vertices");
                format!("{count} split: {}", list(vertices, into))
            }
            Self::Dropped { vertices } => {
                let count = count(vertices.len(), "vertex", "vertices");
                format!("{count} in no face deleted: {}", list(vertices, vertex))
            }
        }
    }
}

fn count(count: usize, one: &str, many: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {many}") }
}

/// What cannot be done to a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Obstacle {
    /// A piece is one-sided, as a Moebius strip is: whichever faces are flipped, some disagree.
    OneSided {
        /// The lowest face of the piece, in the numbers before the repairs.
        face: FaceId,
        /// The number of its faces.
        num_faces: usize,
    },
}

impl Obstacle {
    /// The obstacle in one sentence, and what to do about it.
    pub fn describe(&self, names: &dyn Names) -> String {
        let Self::OneSided { face, num_faces } = self;
        format!(
            "the piece of face {} ({num_faces} faces) is one-sided, and no flipping orients it: \
             cut it along a line of edges",
            names.face(*face)
        )
    }
}

/// Makes `repairs` on a copy of `mesh`. Time is linear in its size, apart from sorting; merging is
/// linear if few vertices remain within a few distances of each other.
///
/// # Errors
///
/// Corners at vertices that do not exist; more corners or vertices than can be numbered.
///
/// ```
/// use evenlight::mesh::fix::{Change, Repairs, fix};
/// use evenlight::{Cage, FaceId, Mesh};
///
/// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
/// let mesh = Mesh::new(square, [[0, 1, 2], [0, 3, 2]]);
/// assert!(Cage::new(mesh.clone()).is_err());
/// let repaired = fix(&mesh, &Repairs { flip: true, ..Repairs::default() })?;
/// assert_eq!(repaired.changes, [Change::Flipped { faces: vec![FaceId(1)] }]);
/// assert!(Cage::new(repaired.mesh).is_ok());
/// # Ok::<(), evenlight::mesh::CheckError>(())
/// ```
pub fn fix(mesh: &Mesh, repairs: &Repairs) -> Result<Repaired, CheckError> {
    check_numbers(mesh)?;
    let mut draft = Draft::new(mesh);
    let (mut changes, mut obstacles) = (Vec::new(), Vec::new());
    if let Some(distance) = repairs.merge {
        changes.extend(merge::merge(&mut draft, distance));
    }
    if repairs.flip {
        changes.extend(orient::orient(&mut draft, &mut obstacles));
    }
    if repairs.split {
        changes.extend(split::split(&mut draft));
    }
    if repairs.drop_unused {
        changes.extend(draft.drop_unused());
    }
    let mesh = if changes.is_empty() { mesh.clone() } else { draft.finish() };
    Ok(Repaired { mesh, changes, obstacles })
}

/// Checks what the repairs rely on: every corner is at a vertex that exists, and numbers have 31
/// bits, so that every corner can get a vertex of its own.
fn check_numbers(mesh: &Mesh) -> Result<(), CheckError> {
    const LIMIT: usize = i32::MAX as usize;
    let num_vertices = mesh.positions.len();
    let counts = [("vertices", num_vertices), ("corners", mesh.faces.all_corners().len())];
    let large = counts.into_iter().filter(|&(_, count)| count > LIMIT);
    let large = large.map(|(what, count)| MeshError::TooLarge { what, count, limit: LIMIT });
    let out_of_range = mesh.faces.ids().filter_map(|face| {
        let mut corners = mesh.faces.corners(face).iter();
        let vertex = *corners.find(|v| v.index() >= num_vertices)?;
        Some(MeshError::IndexOutOfRange { face, vertex, num_vertices })
    });
    let errors: Vec<MeshError> = large.chain(out_of_range).collect();
    if errors.is_empty() { Ok(()) } else { Err(CheckError { errors }) }
}
