//! Files: cages in, meshes and patches out.

pub mod bv;
mod digits;
pub mod load;
pub mod obj;
pub mod obj_out;
pub mod ply;
pub mod stl;
