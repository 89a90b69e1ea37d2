//! What input is accepted: the step from [`Mesh`] to [`Cage`].

use super::{FaceId, Mesh, Topology, VertexId};
use crate::point::Point;

/// A mesh that passed all checks, with its connectivity.
#[derive(Clone, Debug)]
pub struct Cage {
    positions: Vec<Point>,
    topology: Topology,
    warnings: Vec<Warning>,
}

impl Cage {
    /// Checks `mesh`.
    pub fn new(mesh: Mesh) -> Result<Self, CheckError> {
        let num_vertices = mesh.positions.len();
        let topology = Topology::build(mesh.faces, num_vertices)
            .map_err(|errors| CheckError { errors })?;
        Ok(Self { positions: mesh.positions, topology, warnings: Vec::new() })
    }

    /// The position of every vertex, those in no face included.
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// The connectivity.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// What was accepted but should be known.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }
}

/// Why a mesh is not a cage: every fault that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckError {
    /// The faults.
    pub errors: Vec<MeshError>,
}

/// One fault of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshError {
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
}

/// Something that was accepted but should be known.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// Vertices that are in no face; they are ignored.
    UnusedVertices(Vec<VertexId>),
}
