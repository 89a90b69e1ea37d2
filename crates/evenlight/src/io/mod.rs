//! Files: cages in, meshes and patches out.

pub mod bv;
pub mod obj;
pub mod ply;
pub mod stl;
