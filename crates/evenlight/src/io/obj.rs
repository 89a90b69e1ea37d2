//! Wavefront OBJ: cages in, meshes out.
//!
//! ```text
//! v x y z         a vertex; further numbers (w, colours) must be numbers and are ignored
//! vt, vn          counted only: channels of faces are not kept yet
//! f c1 c2 ...     a face of any size; a corner is v, v/vt, v//vn or v/vt/vn
//! o g s usemtl mtllib   ignored
//! # ...           a comment up to the end of the line
//! ```
//!
//! A number counts what the file holds from 1; a negative one counts back from the face's own
//! line, -1 being the latest. A positive one may be of something that comes later. A part after
//! a `/` may be empty.
//!
//! A line ends with LF, CRLF or CR; `\` at its end joins the next one to it, except in a
//! comment. Blanks may stand anywhere between words, also before the first. Every other tag is
//! counted and reported once. Only words that matter are looked at: the bytes need not be
//! UTF-8, and a byte order mark is skipped.
//!
//! Coordinates are read as `str::parse::<f64>` reads them, to the nearest number of 64 bits.
//! [`write()`] writes the shortest digits that are read as the same number.

use std::fmt;
use std::io::{BufWriter, Write};

use super::digits::Digits;
use crate::mesh::{Cage, CheckError, FaceId, Mesh, Names, VertexId, Warning};
use crate::point::Point;

mod fault;
mod parse;
mod words;

pub use fault::{Channel, Element, LineFault, ReadError, Reason};

/// What an OBJ file says.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Obj {
    /// Its vertices and faces, in order.
    pub mesh: Mesh,
    /// Where they stand.
    pub source: Source,
    /// The tags that were not understood, in the order of their first lines.
    pub unknown_tags: Vec<UnknownTag>,
}

/// Reads an OBJ file. One pass; time and memory are linear in its length.
///
/// The mesh is not checked, but every face's numbers exist.
///
/// # Errors
///
/// The first 20 lines with a number or a corner that cannot be read, or that is out of range,
/// and how many more there are; one fault per line. Reading ends at the first thing of which
/// there are 2^32 or more (lines, vertices, faces, corners).
///
/// ```
/// use evenlight::io::obj;
///
/// let obj = obj::read(b"v 0 0 0\nv 1 0 0\nv 0 1 .5\nf 1 2 -1\n")?;
/// assert_eq!(obj.mesh.positions[2], [0.0, 1.0, 0.5]);
/// assert_eq!(obj.mesh.faces.len(), 1);
///
/// let error = obj::read(b"v 0 0 zero\n").unwrap_err();
/// assert!(error.to_string().starts_with("line 1, vertex 1: `zero` is not a number"));
/// # Ok::<(), obj::ReadError>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Obj, ReadError> {
    parse::read(bytes, parse::Limits::default())
}

/// Reads an OBJ file and checks its mesh; what was ignored is told beside the cage.
///
/// # Errors
///
/// As [`read`] and [`Cage::new`]. The message names vertices and faces as the file counts
/// them, from 1, with their lines, and lists 20 faults at most.
///
/// ```
/// use evenlight::io::obj;
///
/// let error = obj::read_cage(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n").unwrap_err();
/// let expected = "face 1 (line 4) comes to vertex 2 (line 2) more than once: ";
/// assert!(error.to_string().starts_with(expected));
/// ```
pub fn read_cage(bytes: &[u8]) -> Result<(Cage, Vec<Notice>), LoadError> {
    let Obj { mesh, source, unknown_tags } = read(bytes)?;
    match Cage::new(mesh) {
        Ok(cage) => {
            let notices = notices(unknown_tags, &cage, &source);
            Ok((cage, notices))
        }
        Err(error) => Err(LoadError::Check(Refusal { error, source, unknown_tags })),
    }
}

fn notices(unknown_tags: Vec<UnknownTag>, cage: &Cage, source: &Source) -> Vec<Notice> {
    let of_tags = unknown_tags.into_iter().map(Notice::UnknownTag);
    let of_mesh = cage.warnings().iter().map(|warning| match warning {
        Warning::UnusedVertices(vertices) => {
            Notice::UnusedVertices { count: vertices.len(), message: warning.describe(source) }
        }
    });
    of_tags.chain(of_mesh).collect()
}

/// The lines of a file on which its vertices and faces begin, counted from 1.
///
/// As [`Names`] it calls a vertex "5 (line 7)": its number in the file, from 1, and its line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    vertex_lines: Vec<u32>,
    face_lines: Vec<u32>,
}

impl Source {
    /// The line of `vertex`; `None` if there is no such vertex.
    pub fn vertex_line(&self, vertex: VertexId) -> Option<u32> {
        self.vertex_lines.get(vertex.index()).copied()
    }

    /// The line on which `face` begins; `None` if there is no such face.
    pub fn face_line(&self, face: FaceId) -> Option<u32> {
        self.face_lines.get(face.index()).copied()
    }
}

impl Names for Source {
    fn vertex(&self, vertex: VertexId) -> String {
        numbered(vertex.0, self.vertex_line(vertex))
    }

    fn face(&self, face: FaceId) -> String {
        numbered(face.0, self.face_line(face))
    }
}

fn numbered(id: u32, line: Option<u32>) -> String {
    let number = u64::from(id) + 1;
    line.map_or_else(|| number.to_string(), |line| format!("{number} (line {line})"))
}

/// A tag that this reader does not know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownTag {
    /// The first word of its lines; shortened if it is long, and with `\u{fffd}` for bytes
    /// that are not text.
    pub name: String,
    /// The number of its lines.
    pub count: usize,
    /// The first of its lines, from 1.
    pub first_line: u32,
}

impl fmt::Display for UnknownTag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, count, first_line } = self;
        match count {
            1 => write!(f, "line {first_line} is ignored: the tag `{name}` is not supported"),
            _ => write!(
                f,
                "{count} lines from line {first_line} are ignored: the tag `{name}` is not supported"
            ),
        }
    }
}

/// Something in a file that was ignored.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Notice {
    /// The lines with a tag that is not known.
    UnknownTag(UnknownTag),
    /// The vertices in no face.
    UnusedVertices {
        /// How many there are.
        count: usize,
        /// The sentence that names the first of them.
        message: String,
    },
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownTag(tag) => tag.fmt(f),
            Self::UnusedVertices { message, .. } => f.write_str(message),
        }
    }
}

/// Why a file gives no cage.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoadError {
    /// It cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Its mesh cannot be used.
    #[error("{0}")]
    Check(Refusal),
}

/// The faults of a mesh and where in the file it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The faults.
    pub error: CheckError,
    /// The lines of the file.
    pub source: Source,
    /// The tags that were not understood.
    pub unknown_tags: Vec<UnknownTag>,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.error.describe(&self.source))?;
        // Most likely the cause, when what was read is not a mesh: the file is of another kind.
        match &self.unknown_tags[..] {
            [] => Ok(()),
            [tag] => write!(f, "\nnote: {tag}"),
            [tag, others @ ..] => write!(f, "\nnote: {tag}, and {} more tags", others.len()),
        }
    }
}

/// Writes `mesh` as OBJ: vertices in order, then faces in order, nothing else.
///
/// The same mesh always gives the same bytes. Numbers have the shortest digits that are read as
/// the same 64 bits, so that [`read`] returns the mesh, except that NaN is not equal to itself
/// and that a face at a vertex that does not exist is refused there.
///
/// # Errors
///
/// Those of `out`.
///
/// ```
/// use evenlight::Mesh;
/// use evenlight::io::obj;
///
/// let mesh = Mesh::new(vec![[0., 0., 0.], [0.1, 0., -2.], [0., 1e-9, 3.]], [[0, 1, 2]]);
/// let mut text = Vec::new();
/// obj::write(&mesh, &mut text)?;
/// assert_eq!(text, b"v 0 0 0\nv 0.1 0 -2\nv 0 1e-9 3\nf 1 2 3\n");
/// assert_eq!(obj::read(&text).map(|obj| obj.mesh), Ok(mesh));
/// # std::io::Result::Ok(())
/// ```
pub fn write(mesh: &Mesh, out: &mut impl Write) -> std::io::Result<()> {
    let mut out = BufWriter::new(out);
    for position in &mesh.positions {
        write_vertex(*position, &mut out)?;
    }
    for corners in mesh.faces.iter() {
        write_face(corners, &mut out)?;
    }
    out.flush()
}

fn write_vertex(position: Point, out: &mut impl Write) -> std::io::Result<()> {
    out.write_all(b"v")?;
    for x in position {
        // `Digits` stands for results that do not exist; a coordinate must not turn into 0.
        if x.is_nan() { out.write_all(b" NaN")? } else { write!(out, " {}", Digits(x))? }
    }
    out.write_all(b"\n")
}

fn write_face(corners: &[VertexId], out: &mut impl Write) -> std::io::Result<()> {
    out.write_all(b"f")?;
    for corner in corners {
        write!(out, " {}", u64::from(corner.0) + 1)?;
    }
    out.write_all(b"\n")
}
