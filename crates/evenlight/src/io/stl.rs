//! stl.
