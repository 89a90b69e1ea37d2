//! Functions on a guided surface around one extraordinary point.
//!
//! A guided scheme is known by its guides: n polynomial pieces g that join with curvature
//! continuity. This module has the functions that follow from that, for interpolation, analysis and
//! pictures:
//!
//! - [`HomogeneousGuide`]: guides of one degree s, the eigenvectors, with their number
//!   ([`multiplicity`]), found by solving the conditions of curvature continuity;
//! - [`Eigenfunctions`]: the functions that follow them, f(a/2, b/2) = lambda^s f(a,b);
//! - [`RefinableSpace`]: nested spaces V_m of C2 functions, splines on m rings and a guide inside,
//!   element by element with Bezier extraction ([`Element`]), and the sparse matrices from each to
//!   the next.

mod eigen;
mod guide;
mod layout;
mod scalar;
mod space;

pub use crate::sparse::Stencils;
pub use eigen::Eigenfunctions;
pub use guide::{HomogeneousGuide, MAX_TOTAL_DEGREE, Parity, multiplicity};
pub use scalar::ScalarJet;
pub use space::{Element, FunctionKind, RefinableSpace, Support};

/// The examples of the chapter are tested.
#[cfg(doctest)]
#[doc = include_str!("../../docs/10-basis.md")]
struct Chapter;
