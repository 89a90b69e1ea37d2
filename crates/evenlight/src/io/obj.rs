//! obj.
