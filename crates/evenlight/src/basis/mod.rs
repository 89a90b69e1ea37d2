//! Functions on a guided surface around one extraordinary point.
//!
//! A guided scheme is known by its guides: n polynomial pieces g that join with curvature
//! continuity. This module has the functions that follow from that, for interpolation, analysis and
//! pictures:
//!
//! - [`HomogeneousGuide`]: guides of one degree s, the eigenvectors, with their number
//!   ([`multiplicity`]), found by solving the conditions of curvature continuity;
//! - [`Eigenfunctions`]: the functions that follow them, f(a/2, b/2) = lambda^s f(a,b).

mod eigen;
mod guide;
mod scalar;

pub use eigen::Eigenfunctions;
pub use guide::{HomogeneousGuide, MAX_TOTAL_DEGREE, Parity, multiplicity};
pub use scalar::ScalarJet;
