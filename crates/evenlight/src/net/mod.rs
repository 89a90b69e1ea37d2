//! Nets around an extraordinary point.
