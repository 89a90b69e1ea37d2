//! Files: cages in, meshes and patches out.

pub mod bv;
mod digits;
mod excerpt;
pub mod glb;
mod kind;
mod lines;
pub mod load;
pub mod obj;
pub mod obj_out;
pub mod ply;
pub mod ply_out;
pub mod stl;
pub mod usd;
