//! Control nets around one extraordinary point.
//!
//! A point of valence n has n *lines*, the edges that leave it, numbered 0 to n-1
//! counter-clockwise, and n *sectors*; sector `s` lies between line `s-1` and line `s`:
//!
//! ```text
//!              line s
//!                |
//!       sector s |  sector s+1
//!   line s-1 ----e----
//! ```
//!
//! (Seen from outside the sectors follow counter-clockwise, so sector `s+1` is on the far side
//! of line `s`.) Sector and line numbers are modulo n everywhere.

mod cnet;
mod dnet;
mod fan;
mod quadratic;

pub use cnet::CNet;
pub(crate) use cnet::{CNET_NODES, cnet_node};
pub(crate) use dnet::{DNET_NODES, dnet_node};
pub use dnet::{DNet, Spline};
pub use fan::{Fan, VertexRule};
pub use quadratic::Quadratic;
pub(crate) use quadratic::{Expansion, turned};

/// The highest valence of a point: a face with a million corners must not use up the memory.
pub(crate) const MAX_VALENCE: usize = 1024;

/// A node of a net seen from some sector: how many sectors further on its own sector is, and its
/// number within that sector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NodeRef {
    /// Sectors to go on, counter-clockwise; may be negative.
    pub(crate) turn: isize,
    /// The number of the node among the nodes of its sector.
    pub(crate) node: usize,
}
