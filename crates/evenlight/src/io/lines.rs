//! Where the vertices and faces of a file stand.

use crate::mesh::{FaceId, Names, VertexId};

/// The lines, from 1, on which vertices and faces begin in a file that counts them from 0; empty
/// where they are not known, as in binary files.
///
/// As [`Names`] it calls a vertex "5 (line 17)": its number, from 0, and its line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lines {
    pub(super) vertices: Vec<u32>,
    pub(super) faces: Vec<u32>,
}

impl Names for Lines {
    fn vertex(&self, vertex: VertexId) -> String {
        numbered(vertex.0, self.vertices.get(vertex.index()))
    }

    fn face(&self, face: FaceId) -> String {
        numbered(face.0, self.faces.get(face.index()))
    }
}

fn numbered(id: u32, line: Option<&u32>) -> String {
    line.map_or_else(|| id.to_string(), |line| format!("{id} (line {line})"))
}
