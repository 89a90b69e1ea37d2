//! Files: cages in, meshes and patches out.
//!
//! [`read_cage`] reads a cage from a file of any kind, [`MeshFormat`] and [`PatchFormat`] write
//! surfaces; the modules do so for one format each.

pub mod bv;
mod diagnostic;
mod digits;
mod excerpt;
mod file;
mod formats;
pub mod glb;
mod kind;
mod lines;
pub mod load;
pub mod obj;
pub mod obj_out;
pub mod patch_json;
pub mod ply;
pub mod ply_out;
pub mod stl;
pub mod usd;

pub use diagnostic::{Diagnostic, Severity};
pub use file::{FileError, read_cage};
pub use formats::{MeshFormat, PatchFormat};
