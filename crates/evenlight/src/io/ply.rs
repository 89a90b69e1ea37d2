//! PLY: cages in and out; triangle meshes are written by [`ply_out`](super::ply_out).
//!
//! ```text
//! ply
//! format ascii 1.0                    or binary_little_endian, binary_big_endian
//! comment, obj_info ...               ignored
//! element vertex 8
//! property float x                    x, y, z of any type, in any order among others
//! property uchar red                  other numbers are kept as vertex primvars, see below
//! element face 6
//! property list uchar int vertex_indices    or vertex_index; any whole-number types
//! property list uchar float texcoord        two numbers for each corner: face-varying `st`
//! element edge 12                     other elements and properties are skipped and reported
//! end_header
//! ```
//!
//! Types are `char uchar short ushort int uint float double`, also as `int8 uint8 int16 uint16
//! int32 uint32 float32 float64`. The header's lines end like its first one (LF, CRLF or CR). In
//! the ascii form values may be spread over lines in any way. What follows the last element is
//! reported.
//!
//! | properties | primvar | |
//! | --- | --- | --- |
//! | `red green blue [alpha]` | `color` | whole numbers are taken as fractions of their type's largest |
//! | `s t`, `u v`, `texture_u texture_v` | `st` | |
//! | `nx ny nz` | `normals` | |
//! | `a_0 a_1 ...`, up to four | `a` | |
//! | any other | its own name | one number |
//!
//! Vertices and faces are counted from 0. Reading stops at the first fault.

use std::fmt;
use std::io::Write;

use super::lines::Lines;
use crate::mesh::Mesh;

mod body;
mod cage;
mod header;
mod primvars;
mod write;

pub use header::Encoding;

/// What a PLY file says.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Ply {
    /// Its vertices and faces in order, and its primvars.
    pub mesh: Mesh,
    /// Where its vertices and faces stand, in text.
    pub lines: Lines,
    /// What was skipped or completed, in sentences.
    pub remarks: Vec<String>,
}

/// Why a file cannot be read: its first fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlyError {
    /// Where it is.
    pub place: PlyPlace,
    /// The element and the number of the item in it, from 0, if it is not in the header.
    pub item: Option<(String, usize)>,
    /// What is wrong and what to do, in a sentence.
    pub message: String,
}

impl fmt::Display for PlyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.item {
            Some((element, k)) => write!(f, "{}, {element} {k}: {}", self.place, self.message),
            None => write!(f, "{}: {}", self.place, self.message),
        }
    }
}

impl std::error::Error for PlyError {}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlyPlace {
    /// A line, from 1: of the header, or of an ascii file.
    Line(usize),
    /// The number of bytes before it, in a binary file.
    Byte(usize),
}

impl fmt::Display for PlyPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// Reads a PLY file. Time and memory are linear in its length.
///
/// The mesh is not checked, but every face's numbers exist.
///
/// # Errors
///
/// The first fault: of the header, a value that is not of its type, an index that no vertex has,
/// or the file's end before its last element.
///
/// ```
/// use evenlight::io::ply;
///
/// let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
///             property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
///             end_header\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2\n";
/// let ply = ply::read(text.as_bytes())?;
/// assert_eq!(ply.mesh.positions[2], [0.0, 1.0, 0.5]);
///
/// let error = ply::read(text.replace("3 0 1 2", "3 0 1 3").as_bytes()).unwrap_err();
/// let expected = "line 13, face 0: a corner asks for vertex 3, but the file has 3";
/// assert!(error.to_string().starts_with(expected));
/// # Ok::<(), ply::PlyError>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Ply, PlyError> {
    cage::read(bytes)
}

/// Writes `mesh` as PLY: positions and primvars with 64 bits, colours of 8 bits as such, faces
/// with 32-bit indices and, if there is a face-varying `st`, `texcoord`. [`omitted`] tells what
/// this leaves out.
///
/// The same mesh always gives the same bytes, and [`read`] returns it, except that NaN is not
/// equal to itself in ascii and that equal texture coordinates of a vertex become one.
///
/// # Errors
///
/// Those of `out`.
pub fn write(mesh: &Mesh, encoding: Encoding, out: &mut impl Write) -> std::io::Result<()> {
    write::write(mesh, encoding, out)
}

/// What [`write()`] leaves out of `mesh`, in sentences: tags, varying primvars, face-varying ones
/// but one of two numbers, primvars whose names are taken.
pub fn omitted(mesh: &Mesh) -> Vec<String> {
    write::omitted(mesh)
}
