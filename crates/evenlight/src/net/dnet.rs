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

use std::sync::OnceLock;

use super::{CNet, NodeRef, cnet_node};
use crate::dense::Matrix;
use crate::point::{add_scaled, sub};

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
pub struct DNet<const N: usize = 3> {
    /// Per sector the nodes 00 10 20 30 01 11 21 31 02 12 22 32.
    pub sectors: Vec<[[f64; N]; 12]>,
}

impl<const N: usize> DNet<N> {
    /// The d-net of a c-net: the same tensor-product spline around the hole, in one variable
    ///
    /// - bi-4, by degree raising [KP23-EG, Fig. 5]: a node on a grid line is (1,10,1)/12 of the
    ///   grid nodes, one in the middle of a quad (1,1)/2;
    /// - bi-3, by knot insertion [KP23-QAS, Fig. 3]: (1,6,1)/8 and (1,1)/2.
    pub fn from_cnet(cnet: &CNet<N>, spline: Spline) -> Self {
        let rows = spline.rows();
        let mut sectors = Vec::with_capacity(cnet.valence());
        for s in 0..cnet.valence() {
            let mut sector = [[0.0; N]; DNET_NODES];
            for (node, row) in sector.iter_mut().zip(rows) {
                row.iter().for_each(|&(at, w)| add_scaled(node, w, cnet.node(s, at)));
            }
            sectors.push(sector);
        }
        Self { sectors }
    }

    /// The valence.
    pub fn valence(&self) -> usize {
        self.sectors.len()
    }

    /// The centre that the d-net implies: the centre of the c-net whose d-net is nearest in the
    /// sense of least squares [KP23-EG, eq. 4]. `None` if there are no sectors.
    ///
    /// DIFFERENCE: the paper gives the solution for bi-4 in closed form, with a misprint in e_32
    /// (48 (8483 n - 5008) for n > 4); here the 7 x 7 normal equations are solved, for bi-3 too.
    pub fn center(&self, spline: Spline) -> Option<[f64; N]> {
        let first = self.sectors.first()?[0];
        let weights = center_weights(self.valence(), spline);
        let mut sum = first;
        for sector in &self.sectors {
            for (&w, &d) in weights.iter().zip(sector) {
                add_scaled(&mut sum, w, sub(d, first));
            }
        }
        Some(sum)
    }
}

/// What the nodes of a d-net are control points of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Spline {
    /// Uniform bi-3 splines with a knot at every half step.
    BiCubic,
    /// Bi-4 C2 splines with a knot at every grid line.
    BiQuartic,
}

/// A node of a d-net as weights of the nodes of a c-net.
type MaskRow = Vec<(Option<NodeRef>, f64)>;

impl Spline {
    /// The nodes of sector 0 as weights of the nodes of a c-net.
    fn rows(self) -> &'static [MaskRow; DNET_NODES] {
        static ROWS: [OnceLock<[MaskRow; DNET_NODES]>; 2] = [const { OnceLock::new() }; 2];
        let row = |k: usize| {
            let [u, v] = [k % 4, k / 4].map(|i| self.mask(i));
            let terms = u.iter().flat_map(|a| v.iter().map(move |b| (a, b)));
            terms.map(|(a, b)| (cnet_node(a.0, b.0), a.1 * b.1)).collect()
        };
        ROWS[self as usize].get_or_init(|| std::array::from_fn(row))
    }

    /// The univariate mask of d-net index `i` on the c-net, by grid positions from the centre.
    fn mask(self, i: usize) -> Vec<(isize, f64)> {
        let p = 3 - i as isize;
        let side = match self {
            Self::BiCubic => 1.0 / 8.0,
            Self::BiQuartic => 1.0 / 12.0,
        };
        if p % 2 == 0 {
            vec![(p / 2 - 1, side), (p / 2, 1.0 - 2.0 * side), (p / 2 + 1, side)]
        } else {
            vec![(p / 2, 0.5), (p / 2 + 1, 0.5)]
        }
    }
}

/// The centre of a d-net of valence `n`, as weights of the twelve nodes of every sector. The
/// weights of one sector sum to 1/n.
///
/// Only means over all sectors matter: the means x of the c-net's nodes (e and six more) and the
/// means R x of the d-net's nodes, where R is the same for all valences. The centre is w^T x, so
/// the weights are R (R^T R)^-1 w / n.
fn center_weights(n: usize, spline: Spline) -> [f64; 12] {
    let mut r = [[0.0; 7]; 12];
    for (k, row) in r.iter_mut().enumerate() {
        for (a, wa) in spline.mask(k % 4) {
            for (b, wb) in spline.mask(k / 4) {
                row[cnet_node(a, b).map_or(0, |at| at.node + 1)] += wa * wb;
            }
        }
    }
    let r = Matrix::from_rows(7, &r.map(Vec::from));
    let count = n as f64;
    // The centre of a c-net, eq. (3), with means in place of sums.
    let mut w = [0.0; 7];
    [w[0], w[1], w[3]] = if n == 3 {
        [11.0 / 32.0, 0.5, 5.0 / 32.0]
    } else {
        [count, 4.0, 1.0].map(|x| x / (count + 5.0))
    };
    let transposed = r.transposed();
    let y = transposed.times(&r).solve(Matrix::from_rows(1, &w.map(|x| vec![x])));
    let weights = r.times(&y).scaled(1.0 / count);
    std::array::from_fn(|k| weights[(k, 0)])
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
    fn the_centre_of_a_dnet_is_that_of_its_cnet() {
        for n in [3, 5, 6, 7, 8, 12, 16] {
            for spline in [Spline::BiCubic, Spline::BiQuartic] {
                let cnet = crooked(n);
                let a = DNet::from_cnet(&cnet, spline).center(spline).expect("there are sectors");
                let b = cnet.evolving_guide_limit();
                assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-12), "n = {n}: {a:?} {b:?}");
            }
        }
    }

    /// [KP23-EG, eq. 4] with e_32 corrected.
    #[test]
    fn the_weights_of_the_centre_are_the_printed_ones() {
        for n in (3..=16).filter(|&n| n != 4) {
            let x = n as f64;
            let (gamma, e00, e20, e22, e30, e31, e32);
            if n == 3 {
                (gamma, e00, e20, e22) = (93120.0, 11.0, -73.0, 10643.0);
                (e30, e31, e32) = (-66.0, 396.0, 19062.0);
            } else {
                (gamma, e00) = (178480.0 * x * (x + 5.0), 2587.0 * x - 8377.0);
                (e20, e22) = (19339.0 * x - 53929.0, 157051.0 * x + 50279.0);
                e30 = 336.0 * (153.0 * x - 448.0);
                (e31, e32) = (-6.0 * e30, 48.0 * (8483.0 * x - 5008.0));
            }
            let (e10, e11, e21) = (-6.0 * e00, 36.0 * e00, -6.0 * e20);
            let printed = [e00, e10, e20, e30, e10, e11, e21, e31, e20, e21, e22, e32];
            let weights = center_weights(n, Spline::BiQuartic);
            for (w, e) in weights.iter().zip(printed) {
                assert!((w - e / gamma).abs() < 1e-13, "n = {n}: {w} {}", e / gamma);
            }
            assert!((weights.iter().sum::<f64>() * x - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn access_across_the_lines_meets_the_owner() {
        assert_eq!(dnet_node(2, 3), NodeRef { turn: -1, node: 4 * 2 + 3 });
        assert_eq!(dnet_node(4, 1), NodeRef { turn: 1, node: 4 * 2 + 1 });
        assert_eq!(dnet_node(1, 4), NodeRef { turn: -1, node: 4 + 2 });
    }
}
