//! Triangle meshes of the limit surface.
