//! The c-net: two rings of quads around an extraordinary vertex.
//!
//! In sector `s` the node (a,b) lies `a` steps along line `s-1` and `b` steps along line `s`,
//! 0 <= a,b <= 2; (0,0) is the extraordinary vertex e. A sector owns the six nodes with b > 0
//! (those with b = 0 belong to the sector before it):
//!
//! ```text
//!   line s
//!   (0,2) --- (1,2) --- (2,2)
//!     |         |         |          number of a node in its sector: 2 a + b - 1
//!   (0,1) --- (1,1) --- (2,1)
//!     |         |         |
//!     e ------(1,0)-----(2,0)  line s-1
//! ```

use super::NodeRef;

/// The number of nodes that a sector of a c-net owns.
pub(crate) const CNET_NODES: usize = 6;

/// The node (a,b) of a sector, for -2 <= a,b <= 2; `None` for e itself.
///
/// A node beyond a line has its name in the neighbour: (-a,b) is (b,a) of the next sector, (a,-b)
/// is (b,a) of the sector before.
pub(crate) fn cnet_node(a: isize, b: isize) -> Option<NodeRef> {
    match (a, b) {
        (0, 0) => None,
        (a, b) if a < 0 => cnet_node(b, -a).map(|at| NodeRef { turn: at.turn + 1, ..at }),
        (a, b) if b < 0 => cnet_node(-b, a).map(|at| NodeRef { turn: at.turn - 1, ..at }),
        (a, 0) => Some(NodeRef { turn: -1, node: a as usize - 1 }),
        (a, b) => Some(NodeRef { turn: 0, node: 2 * a as usize + b as usize - 1 }),
    }
}

/// The 6n + 1 control points of two rings of quads around an extraordinary vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct CNet<const N: usize = 3> {
    /// The extraordinary vertex e.
    pub center: [f64; N],
    /// Per sector the nodes (0,1), (0,2), (1,1), (1,2), (2,1), (2,2).
    pub sectors: Vec<[[f64; N]; 6]>,
}

impl<const N: usize> CNet<N> {
    /// The valence.
    pub fn valence(&self) -> usize {
        self.sectors.len()
    }

    /// The limit of e under Catmull-Clark subdivision \[HKD93\]:
    /// (n e + 4/n sum c_6 + 1/n sum c_5) / (n + 5).
    pub fn catmull_clark_limit(&self) -> [f64; N] {
        let n = self.valence() as f64;
        self.weighted(n / (n + 5.0), 4.0 / (n * (n + 5.0)), 1.0 / (n * (n + 5.0)))
    }

    /// The limit point c_0 of all schemes but Catmull-Clark [KP23-EG, eq. 3]: Catmull-Clark's,
    /// slightly corrected for n = 3.
    pub fn evolving_guide_limit(&self) -> [f64; N] {
        if self.valence() == 3 {
            self.weighted(11.0 / 32.0, 1.0 / 6.0, 5.0 / 96.0)
        } else {
            self.catmull_clark_limit()
        }
    }

    /// `e` times `center` + every direct neighbour (0,1) times `direct` + every diagonal
    /// neighbour (1,1) times `diagonal`. The sums are formed relative to e, so that a net far
    /// from the origin loses no digits.
    fn weighted(&self, center: f64, direct: f64, diagonal: f64) -> [f64; N] {
        let mut sum = self.center;
        for sector in &self.sectors {
            for k in 0..N {
                sum[k] += direct * (sector[0][k] - self.center[k])
                    + diagonal * (sector[2][k] - self.center[k]);
            }
        }
        debug_assert!(
            self.sectors.is_empty()
                || (center + self.valence() as f64 * (direct + diagonal) - 1.0).abs() < 1e-12
        );
        sum
    }

    /// The net moved so that `origin` becomes the origin.
    pub(crate) fn relative_to(&self, origin: [f64; N]) -> Self {
        let moved = |p: [f64; N]| crate::point::sub(p, origin);
        Self {
            center: moved(self.center),
            sectors: self.sectors.iter().map(|s| s.map(moved)).collect(),
        }
    }

    /// A node seen from sector `s`; e if no sector owns the node.
    pub(super) fn node(&self, s: usize, at: Option<NodeRef>) -> [f64; N] {
        let n = self.valence() as isize;
        at.map_or(self.center, |at| {
            self.sectors[(s as isize + at.turn).rem_euclid(n) as usize][at.node]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_on_lines_have_one_owner() {
        assert_eq!(cnet_node(1, 0), Some(NodeRef { turn: -1, node: 0 }));
        assert_eq!(cnet_node(2, 0), Some(NodeRef { turn: -1, node: 1 }));
        // Across line s, (-1,2) is (2,1) of the next sector.
        assert_eq!(cnet_node(-1, 2), Some(NodeRef { turn: 1, node: 4 }));
        // Across line s-1, (1,-1) is (1,1) of the sector before; (0,1) stays on line s.
        assert_eq!(cnet_node(1, -1), Some(NodeRef { turn: -1, node: 2 }));
        assert_eq!(cnet_node(0, 1), Some(NodeRef { turn: 0, node: 0 }));
    }
}
