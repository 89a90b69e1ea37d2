//! The c-net, its centre and the border of the surface that it defines.
//!
//! Two rings of quads around an extraordinary point: the point's own node e and six nodes in each
//! sector. In sector s the node (a, b) lies a steps along line s-1 and b along line s:
//!
//! ```text
//!   line s
//!   (0,2) --- (1,2) --- (2,2)
//!     |         |         |          number in its sector: 2a + b - 1, for b > 0;
//!   (0,1) --- (1,1) --- (2,1)        those with b = 0 belong to the sector before
//!     |         |         |
//!     e ------(1,0)-----(2,0)  line s-1
//! ```
//!
//! The bi-3 patch that these nodes would have over the unit square of a sector lacks one
//! coefficient, b_00 at e. The others are the *tensor border*: its layers next to u = 1 and v = 1
//! continue the surrounding surface to the second order.

use crate::guided::bb::{End, raise, taylor_at};
use crate::linear::Matrix;
use crate::real::Real;

/// The number of nodes that a sector owns.
pub const NODES_PER_SECTOR: usize = 6;

/// The coefficients of a cubic on [0,1] from the uniform B-spline nodes -1, 0, 1, 2, times 6.
const NODES_TO_BB: [[i32; 4]; 4] = [[1, 4, 1, 0], [0, 4, 2, 0], [0, 2, 4, 0], [0, 1, 4, 1]];

/// The numbering of the 6n + 1 nodes of a c-net of valence n; e is the last.
#[derive(Clone, Copy, Debug)]
pub struct CNet {
    /// The valence n.
    pub valence: usize,
}

impl CNet {
    /// The number of nodes, 6n + 1.
    pub fn num_nodes(self) -> usize {
        NODES_PER_SECTOR * self.valence + 1
    }

    /// The number of e.
    pub fn centre(self) -> usize {
        NODES_PER_SECTOR * self.valence
    }

    /// The number of the node (a, b) of `sector` (modulo n), -1 <= a, b <= 2, not both negative.
    /// Beyond a line the neighbour's names are meant: (-a, b) is (b, a) of the next sector.
    pub fn index(self, sector: isize, a: isize, b: isize) -> usize {
        match (a, b) {
            (0, 0) => self.centre(),
            (a, b) if a < 0 => self.index(sector + 1, b, -a),
            (a, b) if b < 0 => self.index(sector - 1, -b, a),
            (a, 0) => self.index(sector - 1, 0, a),
            (a, b) => {
                let sector = sector.rem_euclid(self.valence as isize) as usize;
                NODES_PER_SECTOR * sector + (2 * a + b - 1) as usize
            }
        }
    }

    /// The number of the node that `node` becomes when the net is turned by `turns` sectors.
    pub fn turned(self, node: usize, turns: isize) -> usize {
        if node == self.centre() {
            return node;
        }
        let sector = (node / NODES_PER_SECTOR) as isize + turns;
        let sector = sector.rem_euclid(self.valence as isize) as usize;
        NODES_PER_SECTOR * sector + node % NODES_PER_SECTOR
    }

    /// The number of the mirror image of `node` in the diagonal of sector 0, which exchanges the
    /// lines -1 and 0: node (a, b) of sector s becomes (b, a) of sector -s.
    pub fn mirrored(self, node: usize) -> usize {
        if node == self.centre() {
            return node;
        }
        let (sector, own) = (node / NODES_PER_SECTOR, (node % NODES_PER_SECTOR) as isize);
        self.index(-(sector as isize), own % 2 + 1, own / 2)
    }

    /// The weights of the central point c_0, [KP23-EG, eq. 3]: the limit of Catmull-Clark
    /// subdivision, slightly corrected for n = 3.
    pub fn central_point(self) -> Vec<Real> {
        let n = self.valence as i32;
        let [own, direct, diagonal] = if n == 3 {
            [Real::ratio(11, 32), Real::ratio(1, 6), Real::ratio(5, 96)]
        } else {
            let m = n * (n + 5);
            [Real::ratio(n, n + 5), Real::ratio(4, m), Real::ratio(1, m)]
        };
        let mut weights = vec![Real::ZERO; self.num_nodes()];
        weights[self.centre()] = own;
        for sector in 0..self.valence as isize {
            weights[self.index(sector, 0, 1)] = direct;
            weights[self.index(sector, 1, 1)] = diagonal;
        }
        weights
    }

    /// The tensor border of sector 0: 16 rows b_ij, number 4i + j, on the nodes. Row b_00 is no
    /// part of it and zero.
    pub fn border(self) -> Matrix {
        let mut rows = Matrix::zeros(16, self.num_nodes());
        for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).skip(1) {
            for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
                let weight = NODES_TO_BB[i][a] * NODES_TO_BB[j][b];
                if weight != 0 {
                    let node = self.index(0, a as isize - 1, b as isize - 1);
                    rows[(4 * i + j, node)] += Real::ratio(weight, 36);
                }
            }
        }
        rows
    }

    /// The second-order data of the surrounding surface along the two outer edges of sector 0:
    /// along u = 1, and along v = 1. Rows (order across) (degree + 1) + (index along): the Taylor
    /// coefficients of orders 0..2 across, degree-raised along.
    pub fn outer_data(self, degree: usize) -> [Matrix; 2] {
        let border = self.border();
        let transposed =
            border.select_rows(&(0..16).map(|k| 4 * (k % 4) + k / 4).collect::<Vec<_>>());
        let data = taylor_at(3, 3, End::Finish).kronecker(&raise(3, degree));
        [&data * &border, &data * &transposed]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::largest;

    #[test]
    fn neighbours_see_the_same_nodes() {
        let net = CNet { valence: 5 };
        for a in 1..3 {
            assert_eq!(net.index(2, 0, a), net.index(3, a, 0)); // on line 2
            assert_eq!(net.index(2, -1, a), net.index(3, a, 1)); // beyond it
            assert_eq!(net.index(3, a, -1), net.index(2, 1, a));
        }
        assert_eq!(net.index(2, 0, -1), net.index(1, 1, 0));
    }

    #[test]
    fn turns_and_mirrors_move_the_names_along() {
        let net = CNet { valence: 7 };
        for (a, b) in [(0, 1), (0, 2), (1, 1), (1, 2), (2, 1), (2, 2)] {
            assert_eq!(net.turned(net.index(5, a, b), 3), net.index(8, a, b));
            assert_eq!(net.mirrored(net.index(3, a, b)), net.index(-3, b, a));
            assert_eq!(net.mirrored(net.mirrored(net.index(3, a, b))), net.index(3, a, b));
        }
    }

    #[test]
    fn weights_of_points_sum_to_one() {
        for n in [3, 5, 6, 11] {
            let net = CNet { valence: n };
            let sum: Real = net.central_point().into_iter().sum();
            assert!((sum - Real::ONE).abs().to_f64() < 1e-30);
            let sums = &net.border() * &Matrix::from_fn(net.num_nodes(), 1, |_, _| Real::ONE);
            let ones = Matrix::from_fn(16, 1, |k, _| Real::from(i32::from(k > 0)));
            assert!(largest(&(&sums - &ones)) < 1e-30);
        }
    }

    #[test]
    fn the_missing_coefficient_does_not_enter_the_outer_data() {
        let weights = taylor_at(3, 3, End::Finish);
        assert!((0..3).all(|order| weights[(order, 0)] == Real::ZERO));
    }
}
