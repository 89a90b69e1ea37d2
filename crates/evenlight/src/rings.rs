//! Rings around an extraordinary point.
