//! The d-net around an extraordinary point: its nodes, and how sectors see their neighbours.
//!
//! Lines 0..n-1 leave the extraordinary point counter-clockwise; sector s lies between line s-1
//! and line s, all modulo the valence n. Sector s owns twelve nodes d_ij^s, 0 <= i <= 3 and
//! 0 <= j <= 2; d_ij^s lies 3-i half steps along line s-1 and 3-j along line s from the point.
//!
//! ```text
//!             line s
//!   j=3 . . . x        x: the place (i, 3) of sector s is d_3i of sector s-1, on line s-1
//!   j=2 o o o * d_32   *: i = 3, on line s
//!   j=1 o o o * d_31   flat order of the twelve: 00 10 20 30 01 11 21 31 02 12 22 32
//!   j=0 o o o * d_30
//!       i=0     i=3
//! ```
//!
//! Each node of the net is asked for by (sector, i, j) through [`DNet::index`], which also knows
//! the nodes one step beyond the two lines: i = 4 or j = 4, the places of the sector's L-net.

/// The number of nodes of one sector.
pub const NODES_PER_SECTOR: usize = 12;

/// The numbering of the 12n nodes of a d-net of valence n.
#[derive(Clone, Copy, Debug)]
pub struct DNet {
    /// The valence n.
    pub valence: usize,
}

impl DNet {
    /// The number of nodes, 12n.
    pub fn num_nodes(self) -> usize {
        NODES_PER_SECTOR * self.valence
    }

    /// The number of the node at the place (i, j) of `sector` (taken modulo n).
    ///
    /// # Panics
    ///
    /// If (i, j) is no place of an L-net: above 4, or both above 2.
    pub fn index(self, sector: isize, i: usize, j: usize) -> usize {
        let (turn, i, j) = home(i, j);
        let sector = (sector + turn).rem_euclid(self.valence as isize) as usize;
        NODES_PER_SECTOR * sector + 4 * j + i
    }
}

/// The own nodes (i, j) of a sector in flat order.
pub fn own_nodes() -> impl Iterator<Item = (usize, usize)> + Clone {
    (0..3).flat_map(|j| (0..4).map(move |i| (i, j)))
}

/// A mirror that maps the d-net to itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mirror {
    /// The mirror in line s: sectors s and s+1 change places.
    Line,
    /// The mirror in the diagonal of sector s: lines s-1 and s change places.
    Diagonal,
}

impl Mirror {
    /// The image of the own node (i, j) of sector s + r, as (r, i, j) of the same kind; its own
    /// inverse. `r` may be any integer.
    ///
    /// ```text
    ///   Line      (r, i, j) -> (1 - r, j, i)     (r, 3, j) -> (-r, 3, j)        (i below 3)
    ///   Diagonal  (r, i, j) -> (-r, j, i)        (r, 3, j) -> (-1 - r, 3, j)
    /// ```
    pub fn image(self, (r, i, j): (isize, usize, usize)) -> (isize, usize, usize) {
        let on_line = match self {
            Self::Line => -r,
            Self::Diagonal => -1 - r,
        };
        if i == 3 { (on_line, i, j) } else { (on_line + 1, j, i) }
    }
}

/// Where the node at the place (i, j) of an L-net is at home: (sectors to go, i, j) there.
///
/// # Panics
///
/// If (i, j) is no place of an L-net: above 4, or both above 2.
pub fn home(i: usize, j: usize) -> (isize, usize, usize) {
    match (i, j) {
        (0..=3, 0..=2) => (0, i, j),
        (4, 0..=2) => (1, j, 2),
        (0..=2, 3) => (-1, 3, i),
        (0..=2, 4) => (-1, 2, i),
        _ => panic!("({i}, {j}) is no place of an L-net"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_nodes_are_numbered_in_flat_order() {
        let net = DNet { valence: 5 };
        let numbers = (0..5).flat_map(|s| own_nodes().map(move |(i, j)| net.index(s, i, j)));
        assert!(numbers.eq(0..net.num_nodes()));
    }

    #[test]
    fn neighbours_see_the_same_nodes() {
        let net = DNet { valence: 3 };
        for j in 0..3 {
            assert_eq!(net.index(0, 4, j), net.index(1, j, 2)); // beyond line 0, seen from behind
            assert_eq!(net.index(0, 2, j), net.index(1, j, 4));
            assert_eq!(net.index(0, 3, j), net.index(1, j, 3));
        }
    }

    #[test]
    fn mirrors_exchange_the_places_of_l_nets() {
        let net = DNet { valence: 7 };
        let number = |(r, i, j)| net.index(r, i, j);
        for (r, (i, j)) in (-3..=3).flat_map(|r| own_nodes().map(move |node| (r, node))) {
            for mirror in [Mirror::Line, Mirror::Diagonal] {
                assert_eq!(mirror.image(mirror.image((r, i, j))), (r, i, j));
            }
            // Place (i, j) of sector r <-> place (j, i) of sector 1 - r, or of sector -r.
            assert_eq!(number(Mirror::Line.image((r, i, j))), net.index(1 - r, j, i));
            assert_eq!(number(Mirror::Diagonal.image((r, i, j))), net.index(-r, j, i));
        }
    }
}
