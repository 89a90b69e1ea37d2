//! Fair subdivision surfaces from quad meshes.

pub mod mesh;
pub mod patch;
pub mod point;
pub mod scheme;
pub mod surface;

pub use mesh::{Cage, FaceId, Mesh, VertexId};
pub use point::{Point, Vector};
pub use scheme::{RuleSet, SchemeKind};
pub use patch::SurfacePoint;
pub use surface::{QuadId, Surface, SurfaceOptions};
