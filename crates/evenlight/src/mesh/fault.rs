//! What can be wrong with a mesh, and how its author is told.
//!
//! A fault holds the numbers of the library, from 0. The author of a file thinks of its lines,
//! and of numbers from 1: [`Names`] translates, so that every message is written once, here. Each
//! message says what is wrong, where, and what to do about it.

use std::fmt;

use super::{FaceId, VertexId};
use crate::point::Point;

/// One fault of a mesh.
///
/// Shown with the numbers of the library, from 0; [`MeshError::describe`] takes other names.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no face.
    NoFaces {
        /// The number of vertices.
        num_vertices: usize,
    },
    /// There are more vertices, faces or corners than 32 bits can count.
    TooLarge {
        /// What there is too much of: "vertices", "faces" or "corners".
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// A coordinate of a vertex, in a face or not, is NaN or infinite.
    NonFinitePosition {
        /// The vertex.
        vertex: VertexId,
        /// Its position.
        position: Point,
    },
    /// A face has fewer than three corners.
    TooFewCorners {
        /// The face.
        face: FaceId,
        /// Its number of corners, 0 to 2.
        num_corners: usize,
    },
    /// A face has a corner at a vertex that does not exist.
    IndexOutOfRange {
        /// The face.
        face: FaceId,
        /// The number of the vertex that does not exist.
        vertex: VertexId,
        /// The number of vertices.
        num_vertices: usize,
    },
    /// A face comes to a vertex more than once. This names the first such vertex of the face.
    RepeatedVertex {
        /// The face.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
    },
    /// Two faces have the same corners in the same or the opposite order, and so an edge has more
    /// faces than it can have. The faults of such edges are not listed on their own.
    DuplicateFace {
        /// The two faces, the lower number first.
        faces: [FaceId; 2],
    },
    /// Two faces run through an edge in the same direction.
    InconsistentOrientation {
        /// The ends of the edge.
        edge: [VertexId; 2],
        /// The two faces.
        faces: [FaceId; 2],
    },
    /// An edge has three faces or more.
    EdgeWithManyFaces {
        /// The ends of the edge.
        edge: [VertexId; 2],
        /// All its faces.
        faces: Vec<FaceId>,
    },
    /// The faces of a vertex form more than one fan.
    VertexNotAFan {
        /// The vertex.
        vertex: VertexId,
    },
    /// A sharp edge or vertex, or a hole, that is not in the mesh.
    UnknownTag {
        /// What the tag names.
        what: Tagged,
    },
    /// A sharpness is negative or NaN.
    Sharpness {
        /// What has the sharpness.
        what: Tagged,
        /// The sharpness.
        sharpness: f64,
    },
    /// A primvar is not as it must be.
    Primvar {
        /// Its name.
        name: String,
        /// What is wrong with it.
        fault: PrimvarFault,
    },
}

/// What a tag is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tagged {
    /// An edge, for a crease.
    Edge([VertexId; 2]),
    /// A vertex, for a corner.
    Vertex(VertexId),
    /// A face, for a hole.
    Face(FaceId),
}

impl Tagged {
    fn describe(self, names: &dyn Names) -> String {
        match self {
            Self::Edge([v, w]) => {
                format!("the edge of vertices {} and {}", names.vertex(v), names.vertex(w))
            }
            Self::Vertex(v) => format!("vertex {}", names.vertex(v)),
            Self::Face(f) => format!("face {}", names.face(f)),
        }
    }

    fn describe_unknown(self, names: &dyn Names) -> String {
        let state = if matches!(self, Self::Face(_)) { "a hole" } else { "sharp" };
        let what = self.describe(names);
        format!("{what} is {state}, but it is not in the mesh: correct or delete the tag")
    }
}

impl MeshError {
    /// The fault in one sentence, and what to do about it.
    pub fn describe(&self, names: &dyn Names) -> String {
        let vertex = |v: &VertexId| names.vertex(*v);
        let face = |f: &FaceId| names.face(*f);
        match self {
            Self::NoFaces { num_vertices } => {
                let vertices = if *num_vertices == 1 { "vertex" } else { "vertices" };
                format!("there are no faces ({num_vertices} {vertices}): give the mesh its faces")
            }
            Self::TooLarge { what, count, limit } => format!(
                "there are {count} {what}, but at most {limit} can be numbered: split the mesh"
            ),
            Self::NonFinitePosition { vertex: v, position: [x, y, z] } => format!(
                "vertex {} is at ({x}, {y}, {z}): give it coordinates that are finite numbers",
                vertex(v)
            ),
            Self::TooFewCorners { face: f, num_corners } => format!(
                "face {} has {num_corners} of at least 3 corners: complete or delete it",
                face(f)
            ),
            Self::IndexOutOfRange { face: f, vertex: v, num_vertices } => format!(
                "face {} has a corner at vertex {}, but there are {num_vertices} vertices: correct \
                 the corner or add the vertex",
                face(f),
                vertex(v)
            ),
            Self::RepeatedVertex { face: f, vertex: v } => format!(
                "face {} comes to vertex {} more than once: remove the repeated corner, or split \
                 the face there",
                face(f),
                vertex(v)
            ),
            Self::DuplicateFace { faces: [a, b] } => format!(
                "faces {} and {} have the same corners: delete one of them",
                face(a),
                face(b)
            ),
            Self::InconsistentOrientation { edge: [v, w], faces: [a, b] } => format!(
                "faces {} and {} both run from vertex {} to vertex {}: flip one of them (reverse \
                 the order of its corners); if that only moves the fault to another edge, the \
                 surface is one-sided and must be cut",
                face(a),
                face(b),
                vertex(v),
                vertex(w)
            ),
            Self::EdgeWithManyFaces { edge: [v, w], faces } => format!(
                "the edge of vertices {} and {} has {} faces ({}), but 2 at most can meet: delete \
                 the others, or give them vertices of their own",
                vertex(v),
                vertex(w),
                faces.len(),
                list(faces, face)
            ),
            Self::VertexNotAFan { vertex: v } => format!(
                "the faces around vertex {} form more than one fan: split the vertex, so that \
                 each fan has its own",
                vertex(v)
            ),
            Self::UnknownTag { what } => what.describe_unknown(names),
            Self::Sharpness { what, sharpness } => format!(
                "{} has sharpness {sharpness}: give it one from 0 (smooth) to 10 (sharp for ever)",
                what.describe(names)
            ),
            Self::Primvar { name, fault } => format!("primvar `{name}`: {fault}"),
        }
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.describe(&LibraryNumbers))
    }
}

impl std::error::Error for MeshError {}

/// Why a mesh is not a cage: every fault that was found.
///
/// Shown with the numbers of the library, from 0; [`CheckError::describe`] takes other names.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckError {
    /// The faults, at least one.
    pub errors: Vec<MeshError>,
}

/// How many faults a message lists before it only counts them.
pub(crate) const MAX_LISTED: usize = 20;

impl CheckError {
    /// The faults one per line, 20 at most, then the number of the others.
    pub fn describe(&self, names: &dyn Names) -> String {
        let listed = self.errors.iter().take(MAX_LISTED).map(|error| error.describe(names));
        one_per_line(listed.collect(), self.errors.len())
    }
}

impl fmt::Display for CheckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (vertices and faces are counted from 0)", self.describe(&LibraryNumbers))
    }
}

impl std::error::Error for CheckError {}

/// A single fault alone; else the number `total` of faults, then all that are `listed`.
pub(crate) fn one_per_line(listed: Vec<String>, total: usize) -> String {
    if let ([only], 1) = (&listed[..], total) {
        return only.clone();
    }
    let mut text = format!("{total} faults:");
    for fault in &listed {
        text += "\n  ";
        text += fault;
    }
    if total > listed.len() {
        text += &format!("\n  and {} more", total - listed.len());
    }
    text
}

/// What is wrong with a primvar. Values and corners are counted from 0.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PrimvarFault {
    /// An earlier primvar has the same name.
    RepeatedName,
    /// A value has no numbers, or more than four.
    Width {
        /// The numbers in a value.
        width: usize,
    },
    /// The last value is not complete.
    BrokenValue {
        /// How many numbers there are.
        numbers: usize,
        /// The numbers in a value.
        width: usize,
    },
    /// There are too few or too many values of vertices, or indices of corners.
    Count {
        /// How many there are.
        found: usize,
        /// How many there should be.
        needed: usize,
        /// True if there should be one for every corner; false if for every vertex.
        corners: bool,
    },
    /// A corner has a value that does not exist.
    IndexOutOfRange {
        /// The corner, of all corners of all faces.
        corner: usize,
        /// The number of its value.
        index: u32,
        /// How many values there are.
        count: usize,
    },
    /// A value is NaN or infinite.
    NotFinite {
        /// The value.
        value: usize,
    },
}

impl fmt::Display for PrimvarFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RepeatedName => write!(f, "there is another primvar of that name: rename one"),
            Self::Width { width } => {
                write!(f, "has {width} numbers per value: give it 1 to 4, or split it")
            }
            Self::BrokenValue { numbers, width } => {
                write!(f, "has {numbers} numbers, no multiple of {width}: complete its last value")
            }
            Self::Count { found, needed, corners } => {
                let what = if *corners { ["indices", "corners"] } else { ["values", "vertices"] };
                let [own, of] = what;
                write!(f, "has {found} {own} for {needed} {of}: give it one for each")
            }
            Self::IndexOutOfRange { corner, index, count } => write!(
                f,
                "corner {corner} has value {index}, but there are {count} values: correct the index"
            ),
            Self::NotFinite { value } => {
                write!(f, "value {value} is not finite: give it finite numbers")
            }
        }
    }
}

/// Something that was accepted but should be known.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Warning {
    /// Vertices that are in no face; they are ignored, and the others keep their numbers.
    UnusedVertices(Vec<VertexId>),
}

impl Warning {
    /// The warning in one sentence.
    pub fn describe(&self, names: &dyn Names) -> String {
        match self {
            Self::UnusedVertices(vertices) => {
                let vertices_are = if vertices.len() == 1 { "vertex is" } else { "vertices are" };
                let which = list(vertices, |v| names.vertex(*v));
                format!("{} {vertices_are} in no face and ignored: {which}", vertices.len())
            }
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.describe(&LibraryNumbers))
    }
}

/// What the author of a mesh calls its vertices and faces.
pub trait Names {
    /// The name of a vertex, to follow the word "vertex"; `vertex` need not exist.
    fn vertex(&self, vertex: VertexId) -> String;
    /// The name of a face, to follow the word "face".
    fn face(&self, face: FaceId) -> String;
}

/// The numbers of the library, from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LibraryNumbers;

impl Names for LibraryNumbers {
    fn vertex(&self, vertex: VertexId) -> String {
        vertex.0.to_string()
    }

    fn face(&self, face: FaceId) -> String {
        face.0.to_string()
    }
}

/// The names of the first few of `items`, and the number of the others.
pub(super) fn list<T>(items: &[T], name: impl Fn(&T) -> String) -> String {
    /// Enough to find the place; a pole may have thousands.
    const SHOWN: usize = 5;
    let mut text = items.iter().take(SHOWN).map(name).collect::<Vec<_>>().join(", ");
    if items.len() > SHOWN {
        text += &format!(" and {} more", items.len() - SHOWN);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names as in a file that has a vertex per line from line 1, then a face per line.
    struct Lines {
        num_vertices: u32,
    }

    impl Names for Lines {
        fn vertex(&self, vertex: VertexId) -> String {
            format!("#{}", vertex.0 + 1)
        }

        fn face(&self, face: FaceId) -> String {
            format!("#{} (line {})", face.0 + 1, face.0 + 1 + self.num_vertices)
        }
    }

    #[test]
    fn the_same_fault_reads_in_the_numbers_of_the_library_and_of_the_author() {
        let fault = MeshError::RepeatedVertex { face: FaceId(2), vertex: VertexId(4) };
        assert!(fault.to_string().starts_with("face 2 comes to vertex 4 more than once: "));
        let text = fault.describe(&Lines { num_vertices: 8 });
        assert!(text.starts_with("face #3 (line 11) comes to vertex #5 more than once: "));
    }

    #[test]
    fn every_fault_says_what_to_do() {
        let (vertex, face) = (VertexId(0), FaceId(0));
        let (edge, faces) = ([vertex; 2], [face; 2]);
        for (fault, remedy) in [
            (MeshError::NoFaces { num_vertices: 1 }, "give the mesh its faces"),
            (MeshError::TooLarge { what: "faces", count: 3, limit: 2 }, "split the mesh"),
            (MeshError::NonFinitePosition { vertex, position: [f64::NAN; 3] }, "finite numbers"),
            (MeshError::TooFewCorners { face, num_corners: 2 }, "complete or delete"),
            (MeshError::IndexOutOfRange { face, vertex, num_vertices: 0 }, "correct the corner"),
            (MeshError::RepeatedVertex { face, vertex }, "remove the repeated corner"),
            (MeshError::DuplicateFace { faces }, "delete one of them"),
            (MeshError::InconsistentOrientation { edge, faces }, "flip one of them"),
            (MeshError::EdgeWithManyFaces { edge, faces: faces.to_vec() }, "delete the others"),
            (MeshError::VertexNotAFan { vertex }, "split the vertex"),
            (MeshError::UnknownTag { what: Tagged::Edge(edge) }, "delete the tag"),
            (MeshError::Sharpness { what: Tagged::Vertex(vertex), sharpness: -1.0 }, "from 0"),
        ] {
            let text = fault.to_string();
            let (_, advice) = text.split_once(": ").unwrap();
            assert!(advice.contains(remedy), "{text}");
        }
    }

    #[test]
    fn long_lists_are_cut_and_the_rest_is_counted() {
        let errors = vec![MeshError::VertexNotAFan { vertex: VertexId(7) }; 23];
        let text = CheckError { errors }.to_string();
        assert_eq!(text.lines().count(), 1 + 20 + 1);
        assert!(text.starts_with("23 faults:\n") && text.contains("\n  and 3 more"));
        let unused = Warning::UnusedVertices((0..8).map(VertexId).collect());
        let expected = "8 vertices are in no face and ignored: 0, 1, 2, 3, 4 and 3 more";
        assert_eq!(unused.to_string(), expected);
    }
}
