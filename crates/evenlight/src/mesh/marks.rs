//! A fault as data: a word for its kind, and the vertices, edges and faces that a front end can
//! mark in its view of the mesh.

use super::{FaceId, MeshError, Tagged, VertexId, Warning};

/// Vertices, edges and faces of a mesh, to be marked. They need not exist: a fault may be that one
/// does not exist.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// The vertices.
    pub vertices: Vec<VertexId>,
    /// The edges by their ends.
    pub edges: Vec<[VertexId; 2]>,
    /// The faces.
    pub faces: Vec<FaceId>,
}

impl Marks {
    fn vertices(vertices: &[VertexId]) -> Self {
        Self { vertices: vertices.to_vec(), ..Self::default() }
    }

    fn faces(faces: &[FaceId]) -> Self {
        Self { faces: faces.to_vec(), ..Self::default() }
    }

    fn corner(face: FaceId, vertex: VertexId) -> Self {
        Self { vertices: vec![vertex], faces: vec![face], ..Self::default() }
    }

    fn edge(edge: [VertexId; 2], faces: &[FaceId]) -> Self {
        Self { edges: vec![edge], faces: faces.to_vec(), ..Self::default() }
    }

    fn tagged(what: Tagged) -> Self {
        match what {
            Tagged::Edge(edge) => Self::edge(edge, &[]),
            Tagged::Vertex(vertex) => Self::vertices(&[vertex]),
            Tagged::Face(face) => Self::faces(&[face]),
        }
    }
}

impl MeshError {
    /// The kind of the fault: a word that stays the same when messages change.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NoFaces { .. } => "no-faces",
            Self::TooLarge { .. } => "too-large",
            Self::NonFinitePosition { .. } => "non-finite-position",
            Self::TooFewCorners { .. } => "too-few-corners",
            Self::IndexOutOfRange { .. } => "index-out-of-range",
            Self::RepeatedVertex { .. } => "repeated-vertex",
            Self::DuplicateFace { .. } => "duplicate-face",
            Self::InconsistentOrientation { .. } => "inconsistent-orientation",
            Self::EdgeWithManyFaces { .. } => "edge-with-many-faces",
            Self::VertexNotAFan { .. } => "vertex-not-a-fan",
            Self::UnknownTag { .. } => "unknown-tag",
            Self::Sharpness { .. } => "sharpness",
            Self::Primvar { .. } => "primvar",
        }
    }

    /// What the fault is about; nothing if it is about the mesh as a whole or a primvar.
    pub fn marks(&self) -> Marks {
        match self {
            Self::NoFaces { .. } | Self::TooLarge { .. } | Self::Primvar { .. } => Marks::default(),
            Self::NonFinitePosition { vertex, .. } | Self::VertexNotAFan { vertex } => {
                Marks::vertices(&[*vertex])
            }
            Self::TooFewCorners { face, .. } => Marks::faces(&[*face]),
            Self::IndexOutOfRange { face, vertex, .. } | Self::RepeatedVertex { face, vertex } => {
                Marks::corner(*face, *vertex)
            }
            Self::DuplicateFace { faces } => Marks::faces(faces),
            Self::InconsistentOrientation { edge, faces } => Marks::edge(*edge, faces),
            Self::EdgeWithManyFaces { edge, faces } => Marks::edge(*edge, faces),
            Self::UnknownTag { what } | Self::Sharpness { what, .. } => Marks::tagged(*what),
        }
    }
}

impl Warning {
    /// The kind of the warning: a word that stays the same when messages change.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::UnusedVertices(_) => "unused-vertices",
        }
    }

    /// What the warning is about.
    pub fn marks(&self) -> Marks {
        match self {
            Self::UnusedVertices(vertices) => Marks::vertices(vertices),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_marked_with_its_faces() {
        let [v, w] = [VertexId(3), VertexId(5)];
        let faces = vec![FaceId(0), FaceId(1), FaceId(7)];
        let fault = MeshError::EdgeWithManyFaces { edge: [v, w], faces: faces.clone() };
        assert_eq!(fault.kind(), "edge-with-many-faces");
        assert_eq!(fault.marks(), Marks { edges: vec![[v, w]], faces, vertices: Vec::new() });
    }

    #[test]
    fn a_tag_is_marked_where_it_stands() {
        let fault = MeshError::Sharpness { what: Tagged::Vertex(VertexId(2)), sharpness: -1.0 };
        assert_eq!(fault.marks(), Marks::vertices(&[VertexId(2)]));
        let fault = MeshError::UnknownTag { what: Tagged::Face(FaceId(9)) };
        assert_eq!(fault.marks(), Marks::faces(&[FaceId(9)]));
    }
}
