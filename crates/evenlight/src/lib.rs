//! Fair subdivision surfaces from quad meshes.

pub mod analyse;
mod angle;
pub mod io;
pub mod mesh;
pub mod net;
mod parallel;
pub mod patch;
#[cfg(feature = "picture")]
pub mod picture;
pub mod point;
pub mod rings;
pub mod scheme;
pub mod surface;
pub mod tessellate;

pub use mesh::{Cage, FaceId, Mesh, VertexId};
pub use patch::SurfacePoint;
pub use point::{Point, Vector};
pub use scheme::{RuleSet, SchemeKind};
pub use surface::{QuadId, Surface, SurfaceOptions};
