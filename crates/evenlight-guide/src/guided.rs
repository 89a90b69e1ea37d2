//! Guided C2 subdivision: the derivation.
//!
//! A guided surface [KP18-Guided] around an extraordinary point is made in two steps. The first
//! makes a *guide*: n bi-5 pieces that join with curvature continuity and need not meet the
//! surrounding surface. The second makes an infinite sequence of *rings* of patches that join each
//! other and the surrounding surface with continuous second derivatives. They take everything else
//! from the guide: ring l samples it at lambda^l chi, where chi is a characteristic ring and lambda
//! its eigenvalue.
//!
//! ```text
//!    c-net ----------------> outer border of ring 0 ---.
//!      |                                               v
//!      '--> guide g (fit) --> jets of g(chi^T) --> ring 0   C2   ring 1   C2   ring 2  ...
//!                                |                               ^             ^
//!                                '--- g shrunk by lambda --------'-------------'
//! ```
//!
//! - [`space`]: the G2 guides of valence n, the direct sum of the eigenspaces of the subdivision;
//!   [`determining`] has the paper's explicit formulas for them, [`waves`] takes them apart by
//!   frequencies around the point.
//! - [`net`]: the c-net, its centre and the second-order data of the surrounding surface.
//! - [`characteristic`]: chi, for Catmull-Clark subdivision and for any other speed lambda.
//! - [`composition`]: jets of a guide composed with a map.
//! - [`rings`]: the rings in degree bi-6, bi-5, bi-4 and bi-3 ([`pieces`]).
//! - [`fit`]: the guide of a c-net, the fairest by the measures of [`fairness`].
//! - [`cap`]: bi-6 patches that close the hole after any ring.
//! - [`symmetry`]: the mirrors of a sector.
//! - [`rounded`]: the numbers that a library needs at run time for any valence and contraction;
//!   [`crate::emit`] has the same numbers as integers in tables.
//! - [`bb`]: univariate Bernstein-Bezier tools; [`solutions`]: systems with many solutions.
//!
//! Sectors and lines are as everywhere in this crate: sector s lies between line s-1, along which
//! u runs, and line s, along which v runs. A patch of bi-degree d has its coefficients b_ij in the
//! order i (d + 1) + j, i along u.
//!
//! \[KP18-Guided\] K. Karciauskas, J. Peters: A New Class of Guided C2 Subdivision Surfaces
//! Combining Good Shape with Nested Refinement. Computer Graphics Forum 37, 2018, doi
//! 10.1111/cgf.13313.

pub mod bb;
pub mod cap;
pub mod characteristic;
pub mod composition;
pub mod determining;
pub mod fairness;
pub mod fit;
pub mod net;
pub mod pieces;
pub mod rings;
pub mod rounded;
pub mod solutions;
pub mod space;
pub mod symmetry;
pub mod waves;
