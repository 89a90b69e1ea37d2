//! The d-net: the control net of bi-4 C2 splines around an extraordinary point.
//!
//! A sector owns the twelve nodes d_ij, i = 0..3, j = 0..2, numbered 4 j + i. In half steps of
//! the c-net's grid d_ij lies 3-i along line s-1 and 3-j along line s. Even indices stand in
//! the middle of a quad (simple knot), odd ones on a grid line (double knot); i = 3 is on
//! line s, and the centre is no control point:
//!
//! ```text
//!                        line s
//!   j=0  o --- o --- o --- *  d_30           i and j grow towards the centre
//!        |     |     |     |
//!   j=1  o --- o --- o --- *  d_31
//!        |     |     |     |
//!   j=2  o --- o --- o --- *  d_32
//!       i=0   i=1   i=2    |
//!   x --- x --- x          + centre          x: line s-1, owned by sector s-1
//! ```

use super::{CNet, NodeRef};
use crate::point::{Point, add_scaled, sub};

/// The number of nodes that a sector of a d-net owns.
pub(crate) const DNET_NODES: usize = 12;

/// The node d_ij of a sector, for 0 <= i,j <= 4 but not both above 2: index 3 across line s-1
/// and index 4 across either line are nodes of the neighbours.
pub(crate) fn dnet_node(i: usize, j: usize) -> NodeRef {
    let own = |i: usize, j: usize, turn| NodeRef { turn, node: 4 * j + i };
    match (i, j) {
        (0..=3, 0..=2) => own(i, j, 0),
        (0..=2, 3) => own(3, i, -1),
        (4, 0..=2) => own(j, 2, 1),
        (0..=2, 4) => own(2, i, -1),
        _ => unreachable!("d_{i}{j} lies beyond the centre"),
    }
}

/// The 12n control points of a bi-4 C2 spline with a hole at an extraordinary point.
#[derive(Clone, Debug, PartialEq)]
pub struct DNet {
    /// Per sector the nodes 00 10 20 30 01 11 21 31 02 12 22 32.
    pub sectors: Vec<[Point; 12]>,
}

impl DNet {
    /// Degree raising of a c-net [KP23-EG, Fig. 5]: the same tensor-product spline around the
    /// hole, written with bi-4 control points.
    ///
    /// In one variable a node on a grid line is (1,10,1)/12 of the grid nodes, one in the
    /// middle of a quad (1,1)/2.
    pub fn from_cnet(cnet: &CNet) -> Self {
        let sectors = (0..cnet.valence())
            .map(|s| {
                std::array::from_fn(|k| {
                    cnet.tensor(s, &degree_raising(k % 4), &degree_raising(k / 4))
                })
            })
            .collect();
        Self { sectors }
    }

    /// The valence.
    pub fn valence(&self) -> usize {
        self.sectors.len()
    }

    /// The centre that the d-net implies [KP23-EG, eq. 4]: that of the c-net whose degree-raised
    /// net is nearest in the sense of least squares.
    ///
    /// DIFFERENCE: the paper prints e_32 with a factor gamma_n / delta_n; with 48 in its place
    /// the formula agrees with the least-squares problem that it solves.
    pub fn center(&self) -> Point {
        let first = self.sectors[0][0];
        let weights = self.center_weights();
        let mut sum = first;
        for sector in &self.sectors {
            for (&w, &d) in weights.iter().zip(sector) {
                add_scaled(&mut sum, w, sub(d, first));
            }
        }
        sum
    }

    /// The weights e_ij / gamma_n of eq. (4), which sum to 1/n.
    fn center_weights(&self) -> [f64; 12] {
        let n = self.valence() as f64;
        let (gamma, e00, e20, e22, e30, e31, e32);
        if self.valence() == 3 {
            (gamma, e00, e20, e22) = (93120.0, 11.0, -73.0, 10643.0);
            (e30, e31, e32) = (-66.0, 396.0, 19062.0);
        } else {
            (gamma, e00, e20) =
                (178480.0 * n * (n + 5.0), 2587.0 * n - 8377.0, 19339.0 * n - 53929.0);
            (e22, e30) = (157051.0 * n + 50279.0, 336.0 * (153.0 * n - 448.0));
            (e31, e32) = (-6.0 * e30, 48.0 * (8483.0 * n - 5008.0));
        }
        let (e10, e11, e21) = (-6.0 * e00, 36.0 * e00, -6.0 * e20);
        [e00, e10, e20, e30, e10, e11, e21, e31, e20, e21, e22, e32].map(|e| e / gamma)
    }
}

/// The univariate degree-raising mask of index `i`, on grid positions counted from the centre.
fn degree_raising(i: usize) -> Vec<(isize, f64)> {
    let p = 3 - i as isize;
    if p % 2 == 0 {
        vec![(p / 2 - 1, 1.0 / 12.0), (p / 2, 10.0 / 12.0), (p / 2 + 1, 1.0 / 12.0)]
    } else {
        vec![(p / 2, 0.5), (p / 2 + 1, 0.5)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A c-net without any symmetry.
    fn crooked(n: usize) -> CNet {
        let mut seed = 1.0_f64;
        let mut random = move || {
            seed = (seed * 997.0 + 0.123).rem_euclid(1.0);
            seed - 0.5
        };
        let mut point = || [random(), random(), random()];
        CNet {
            center: point(),
            sectors: (0..n).map(|_| std::array::from_fn(|_| point())).collect(),
        }
    }

    #[test]
    fn the_centre_of_a_degree_raised_net_is_that_of_its_cnet() {
        for n in [3, 5, 6, 7, 8, 12, 16] {
            let cnet = crooked(n);
            let (a, b) = (DNet::from_cnet(&cnet).center(), cnet.evolving_guide_limit());
            assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-13), "n = {n}: {a:?} {b:?}");
        }
    }

    #[test]
    fn the_weights_of_the_centre_sum_to_one() {
        for n in 3..20 {
            let net = DNet { sectors: vec![[[0.0; 3]; 12]; n] };
            let sum: f64 = net.center_weights().iter().sum();
            assert!((sum * n as f64 - 1.0).abs() < 1e-14, "n = {n}: {sum}");
        }
    }

    #[test]
    fn access_across_the_lines_meets_the_owner() {
        assert_eq!(dnet_node(2, 3), NodeRef { turn: -1, node: 4 * 2 + 3 });
        assert_eq!(dnet_node(4, 1), NodeRef { turn: 1, node: 4 * 2 + 1 });
        assert_eq!(dnet_node(1, 4), NodeRef { turn: -1, node: 4 + 2 });
    }
}
