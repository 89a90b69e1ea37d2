//! Cages from files of any kind.
//!
//! ```text
//!   bytes --Format::read--> Loaded { mesh, naming, notices } --check--> Cage, notices
//!               |                                                |
//!               +------------------> LoadError <-----------------+
//! ```
//!
//! A file is read strictly, and then its mesh is checked. What a message calls vertices and
//! faces is what the file calls them: [`Naming`].

use std::fmt;

pub use super::kind::Format;
pub use super::lines::Lines;

use super::obj::{self, Obj, Skipped, UnknownTag};
use super::ply::{self, Ply};
use super::usd::{self, Usd};
use crate::mesh::{
    Cage, CheckError, FaceId, Marks, Mesh, MeshError, Names, Tags, VertexId, Warning,
};

impl Format {
    /// Reads `bytes` as a file of this kind; of USD the mesh at the path `prim`, or the only one.
    ///
    /// # Errors
    ///
    /// Those of the reader.
    ///
    /// ```
    /// use evenlight::io::load::Format;
    ///
    /// let bytes = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    /// let (cage, notices) = Format::of_content(bytes).read(bytes, None)?.check()?;
    /// assert!(cage.num_faces() == 1 && notices.is_empty());
    /// # Ok::<(), evenlight::io::load::LoadError>(())
    /// ```
    pub fn read(self, bytes: &[u8], prim: Option<&str>) -> Result<Loaded, LoadError> {
        Ok(match self {
            Self::Obj => obj::read(bytes)?.into(),
            Self::Ply => ply::read(bytes)?.into(),
            Self::Usda => usd::read(bytes, prim)?.into(),
        })
    }

    /// Reads `bytes` as a file of this kind, of USD the only mesh, and checks the mesh; what was
    /// ignored is told beside the cage.
    ///
    /// # Errors
    ///
    /// Those of [`Format::read`] and [`Loaded::check`]. The message names vertices and faces as the
    /// file counts them, with their lines if it is text, and lists 20 faults at most.
    ///
    /// ```
    /// use evenlight::io::load::Format;
    ///
    /// let error = Format::Obj.read_cage(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n").unwrap_err();
    /// let expected = "face 1 (line 4) comes to vertex 2 (line 2) more than once: ";
    /// assert!(error.to_string().starts_with(expected));
    /// ```
    pub fn read_cage(self, bytes: &[u8]) -> Result<(Cage, Vec<Notice>), LoadError> {
        self.read(bytes, None)?.check()
    }
}

/// A mesh as read, not yet checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The mesh.
    pub mesh: Mesh,
    /// What the file calls its vertices and faces.
    pub naming: Naming,
    /// What was ignored or completed.
    pub notices: Vec<Notice>,
}

impl Loaded {
    /// Checks the mesh; what was ignored is told beside the cage.
    ///
    /// # Errors
    ///
    /// As [`Cage::new`], in the numbers of the file.
    pub fn check(self) -> Result<(Cage, Vec<Notice>), LoadError> {
        let Self { mesh, naming, mut notices } = self;
        let tags = mesh.tags.clone();
        match Cage::new(mesh) {
            Ok(cage) => {
                let of_mesh = cage.warnings().iter().map(|w| Notice::of_warning(w, &naming));
                notices.extend(of_mesh);
                Ok((cage, notices))
            }
            Err(error) => {
                let lines = error.errors.iter().map(|fault| naming.line(fault, &tags)).collect();
                Err(LoadError::Check(Box::new(Refusal { error, naming, lines, notices })))
            }
        }
    }
}

impl From<Obj> for Loaded {
    fn from(obj: Obj) -> Self {
        let Obj { mesh, source, skipped, unknown_tags, remarks } = obj;
        let skipped = skipped.into_iter().map(Notice::Skipped);
        let tags = unknown_tags.into_iter().map(Notice::UnknownTag);
        let notices = skipped.chain(tags).chain(remarks.into_iter().map(Notice::Remark)).collect();
        Self { mesh, naming: Naming::Lines(source), notices }
    }
}

impl From<Ply> for Loaded {
    fn from(Ply { mesh, lines, remarks }: Ply) -> Self {
        let notices = remarks.into_iter().map(Notice::Remark).collect();
        Self { mesh, naming: Naming::LinesFromZero(lines), notices }
    }
}

impl From<Usd> for Loaded {
    fn from(Usd { mesh, lines, remarks, .. }: Usd) -> Self {
        let notices = remarks.into_iter().map(Notice::Remark).collect();
        Self { mesh, naming: Naming::LinesFromZero(lines), notices }
    }
}

/// What a file calls its vertices and faces.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Naming {
    /// By their numbers from 1, and by lines.
    Lines(obj::Source),
    /// By their numbers from 0, and by lines.
    LinesFromZero(Lines),
}

impl Naming {
    /// The line on which a vertex stands, if it is known.
    pub fn vertex_line(&self, vertex: VertexId) -> Option<u32> {
        match self {
            Self::Lines(source) => source.vertex_line(vertex),
            Self::LinesFromZero(Lines { vertices, .. }) => vertices.get(vertex.index()).copied(),
        }
    }

    /// The line on which a face begins, if it is known.
    pub fn face_line(&self, face: FaceId) -> Option<u32> {
        match self {
            Self::Lines(source) => source.face_line(face),
            Self::LinesFromZero(Lines { faces, .. }) => faces.get(face.index()).copied(),
        }
    }

    /// The line where a fault of a mesh with `tags` is to be mended: the line of the tag, or else
    /// of the first face, or else of the first vertex that the fault is about.
    fn line(&self, fault: &MeshError, tags: &Tags) -> Option<u32> {
        match (fault, self) {
            (
                MeshError::UnknownTag { what } | MeshError::Sharpness { what, .. },
                Self::Lines(source),
            ) => source.tag_line(*what, tags),
            (MeshError::UnknownTag { .. } | MeshError::Sharpness { .. }, _) => None,
            _ => self.line_of(&fault.marks()),
        }
    }

    /// The line of the first face among `marks`, or else of the first vertex.
    fn line_of(&self, marks: &Marks) -> Option<u32> {
        let face = marks.faces.first().and_then(|face| self.face_line(*face));
        face.or_else(|| marks.vertices.first().and_then(|vertex| self.vertex_line(*vertex)))
    }
}

impl Names for Naming {
    fn vertex(&self, vertex: VertexId) -> String {
        match self {
            Self::Lines(source) => source.vertex(vertex),
            Self::LinesFromZero(source) => source.vertex(vertex),
        }
    }

    fn face(&self, face: FaceId) -> String {
        match self {
            Self::Lines(source) => source.face(face),
            Self::LinesFromZero(source) => source.face(face),
        }
    }
}

/// Something in a file that was ignored or completed.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Notice {
    /// The lines with a tag that is not known.
    UnknownTag(UnknownTag),
    /// The lines of groups, materials, normals and the like.
    Skipped(Skipped),
    /// What the check of the mesh accepted, as vertices in no face.
    OfMesh {
        /// What it is.
        warning: Warning,
        /// The line of the first vertex that it is about, if it is known.
        line: Option<u32>,
        /// The sentence, in the numbers of the file.
        message: String,
    },
    /// Anything else, in a sentence.
    Remark(String),
}

impl Notice {
    fn of_warning(warning: &Warning, naming: &Naming) -> Self {
        let line = naming.line_of(&warning.marks());
        Self::OfMesh { warning: warning.clone(), line, message: warning.describe(naming) }
    }
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownTag(tag) => tag.fmt(f),
            Self::Skipped(skipped) => skipped.fmt(f),
            Self::OfMesh { message, .. } | Self::Remark(message) => f.write_str(message),
        }
    }
}

/// Why a file gives no cage.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// It is no OBJ file.
    #[error(transparent)]
    Obj(#[from] obj::ObjError),
    /// It is no PLY file.
    #[error(transparent)]
    Ply(#[from] ply::PlyError),
    /// It is no USD file with a mesh.
    #[error(transparent)]
    Usd(#[from] usd::UsdError),
    /// Its mesh cannot be used.
    #[error("{0}")]
    Check(Box<Refusal>),
}

impl LoadError {
    /// What was ignored or completed before the fault was found.
    pub fn notices(&self) -> &[Notice] {
        match self {
            Self::Check(refusal) => &refusal.notices,
            Self::Obj(_) | Self::Ply(_) | Self::Usd(_) => &[],
        }
    }
}

/// The faults of a mesh and what the file calls its parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The faults.
    pub error: CheckError,
    /// What the file calls its vertices and faces.
    pub naming: Naming,
    /// The line where each fault is to be mended, if it is known.
    pub lines: Vec<Option<u32>>,
    /// What was ignored or completed.
    pub notices: Vec<Notice>,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.naming {
            Naming::Lines(_) => f.write_str(&self.error.describe(&self.naming))?,
            Naming::LinesFromZero(_) => {
                let faults = self.error.describe(&self.naming);
                write!(f, "{faults} (vertices and faces are counted from 0)")?;
            }
        }
        // Most likely the cause, when what was read is not a mesh: the file is of another kind.
        let is_cause = |notice: &&Notice| !matches!(notice, Notice::Skipped(_));
        match self.notices.iter().filter(is_cause).collect::<Vec<_>>()[..] {
            [] => Ok(()),
            [notice] => write!(f, "\nnote: {notice}"),
            [notice, ref others @ ..] => write!(f, "\nnote: {notice}, and {} more", others.len()),
        }
    }
}
