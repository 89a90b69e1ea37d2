//! Wavefront OBJ: cages in, meshes out.
//!
//! ```text
//! v x y z [1]         a vertex; another weight than 1 is refused
//! v x y z r g b       a vertex with its colour; any other further numbers are read over
//! vt u [v [w]]        a texture coordinate; what is missing is 0
//! vn                  counted only
//! f c1 c2 ...         a face of any size; a corner is v, v/vt, v//vn or v/vt/vn
//! t NAME a/b/c ...    a tag with a whole numbers, b numbers and c words; see below
//! o g s usemtl mtllib   read over
//! # ...           a comment up to the end of the line
//! ```
//!
//! A number counts what the file holds from 1; a negative one counts back from the face's own
//! line, -1 being the latest. A positive one may be of something that comes later. A part after
//! a `/` may be empty.
//!
//! A line ends with LF, CRLF or CR; `\` at its end joins the next one to it, except in a
//! comment. Blanks may stand anywhere between words, also before the first. What is read over is
//! reported in one sentence, every other tag is counted and reported once. Only words that matter
//! are looked at: the bytes need not be UTF-8, and a byte order mark is skipped.
//!
//! Tags are those of the shapes that OpenSubdiv is tested with; they count from 0:
//!
//! ```text
//! t crease 2/1/0 V W SHARPNESS               or several pairs, one number for all or one each;
//!                                            or a chain: an odd number of vertices, or one number
//!                                            for each of its edges
//! t corner 1/1/0 V SHARPNESS                 or several, likewise
//! t hole 1/0/0 FACE                          or several
//! t interpolateboundary 1/0/0 0|1|2          none, edge-and-corner, edge-only
//! t facevaryinginterpolateboundary 1/0/0 0..5   none, corners-only, corners-plus1, corners-plus2,
//!                                            boundaries, all
//! t creasemethod 0/0/1 normal|chaikin
//! t smoothtriangles 0/0/1 catmark            anything else is ignored and reported
//! t facevaryingpropagatecorners 1/0/0 0      likewise
//! ```
//!
//! Hierarchical edits (`vertexedit`, `edgeedit`, `faceedit`) are refused. Texture coordinates
//! become the face-varying primvar `st`, colours the vertex primvar `color`.
//!
//! Coordinates are read as `str::parse::<f64>` reads them, to the nearest number of 64 bits.
//! [`write()`] writes the shortest digits that are read as the same number.

use std::fmt;
use std::io::Write;

use crate::mesh::{FaceId, Mesh, Names, Tagged, Tags, VertexId};

mod fault;
mod parse;
mod primvars;
mod skipped;
mod tag;
mod words;
mod write;

pub use fault::{Element, IndexKind, LineFault, ObjError, Reason};
pub use skipped::Skipped;

/// What an OBJ file says.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Obj {
    /// Its vertices and faces in order, its tags and primvars.
    pub mesh: Mesh,
    /// Where they stand.
    pub source: Source,
    /// The lines that were read over, which say more than a cage can hold.
    pub skipped: Option<Skipped>,
    /// The tags that were not understood, in the order of their first lines.
    pub unknown_tags: Vec<UnknownTag>,
    /// What was completed or left out, in sentences.
    pub remarks: Vec<String>,
}

/// Reads an OBJ file. One pass; time and memory are linear in its length.
///
/// The mesh is not checked, but every face's numbers exist.
///
/// # Errors
///
/// The first 20 lines with a number or a corner that cannot be read, or that is out of range,
/// and how many more there are; one fault per line. Reading ends as soon as there
/// are 2^32 lines, vertices, faces or corners.
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
/// # Ok::<(), obj::ObjError>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Obj, ObjError> {
    parse::read(bytes, parse::Limits::default())
}

/// The lines of a file on which its vertices and faces begin, counted from 1.
///
/// As [`Names`] it calls a vertex "5 (line 7)": its number in the file, from 1, and its line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    vertex_lines: Vec<u32>,
    face_lines: Vec<u32>,
    tag_lines: TagLines,
}

/// The line of everything in [`Tags`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct TagLines {
    creases: Vec<u32>,
    corners: Vec<u32>,
    holes: Vec<u32>,
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

    /// The line of the first of `tags` that is on `what`.
    pub(super) fn tag_line(&self, what: Tagged, tags: &Tags) -> Option<u32> {
        let TagLines { creases, corners, holes } = &self.tag_lines;
        let at = |k: Option<usize>, lines: &[u32]| lines.get(k?).copied();
        match what {
            Tagged::Edge(edge) => at(tags.creases.iter().position(|c| c.edge == edge), creases),
            Tagged::Vertex(v) => at(tags.corners.iter().position(|c| c.vertex == v), corners),
            Tagged::Face(face) => at(tags.holes.iter().position(|&hole| hole == face), holes),
        }
    }

    /// What is in `tags` and not known here yet is of `line`.
    fn end_tags(&mut self, line: u32, tags: &Tags) {
        let TagLines { creases, corners, holes } = &mut self.tag_lines;
        creases.resize(tags.creases.len(), line);
        corners.resize(tags.corners.len(), line);
        holes.resize(tags.holes.len(), line);
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

/// Writes `mesh` as OBJ: vertices in order with the primvar `color`, texture coordinates, faces
/// in order, tags that differ from the default; [`omitted`] tells what this leaves out.
///
/// The same mesh always gives the same bytes. Numbers have the shortest digits that are read as
/// the same 64 bits, so that [`read`] returns the mesh, except that NaN is not equal to itself,
/// that a face at a vertex that does not exist is refused there, and that primvars get the
/// names `st` and `color` and `st` becomes face-varying.
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
    write::write(mesh, out)
}

/// What [`write()`] leaves out of `mesh`, in sentences: primvars other than one of texture
/// coordinates (`st`, `uv`, or else the first face-varying one of two numbers) and one of
/// colours (`color`, `displayColor`).
pub fn omitted(mesh: &Mesh) -> Vec<String> {
    write::omitted(mesh)
}
