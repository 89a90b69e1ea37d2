//! The two kinds of nets: C2 splines of degree 4 and cubic splines on the half-step grid.
//!
//! Both have the twelve nodes per sector of [`crate::nets`], at the same places. They differ in
//! three things: regular refinement, the map from a c-net, and the form of a ring.

use crate::guided::net::CNet;
use crate::linear::Matrix;
use crate::nets::{NODES_PER_SECTOR, home};
use crate::real::Real;
use crate::spline;

/// A linear combination of the nodes of a net: weights of node number `node` of sector s + turn.
pub type Combination = Vec<((isize, usize), Real)>;

/// The splines whose control points are the nodes of a d-net.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spline {
    /// C2 splines of degree 4, every second node on a double knot.
    BiQuartic,
    /// Uniform cubic splines, a node for every half step.
    BiCubic,
}

/// A patch of a ring: its BB coefficients as combinations of the old and of the new net.
#[derive(Clone, Debug)]
pub struct RingPatch {
    /// The part of the square that it covers, in halves if squares are split: [u, v].
    pub part: [usize; 2],
    /// For each coefficient, number (degree + 1) i + j with i along u, the nodes of the old net.
    pub old: Vec<Combination>,
    /// Likewise the nodes of the new net.
    pub new: Vec<Combination>,
}

impl Spline {
    /// The degree of the patches in each variable.
    pub fn degree(self) -> usize {
        match self {
            Self::BiQuartic => 4,
            Self::BiCubic => 3,
        }
    }

    /// The number of patches along the side of a square of a ring.
    pub fn split(self) -> usize {
        match self {
            Self::BiQuartic => 1,
            Self::BiCubic => 2,
        }
    }

    /// Univariate refinement: the new node at a position on the old ones.
    fn refined(self, position: isize) -> Vec<(isize, Real)> {
        match self {
            Self::BiQuartic => spline::refined(position),
            Self::BiCubic => spline::refined_cubic(position),
        }
    }

    /// Univariate: the node at a position on the nodes of a cubic spline with full steps.
    fn raised(self, position: isize) -> Vec<(isize, Real)> {
        match self {
            Self::BiQuartic => spline::raised_cubic(position),
            Self::BiCubic => spline::refined_cubic(position),
        }
    }

    /// Univariate: a segment in BB form on its degree + 1 nodes.
    fn to_bb(self) -> Matrix {
        match self {
            Self::BiQuartic => spline::spline_to_bb(),
            Self::BiCubic => {
                Matrix::from_fractions(&[[1, 4, 1, 0], [0, 4, 2, 0], [0, 2, 4, 0], [0, 1, 4, 1]], 6)
            }
        }
    }

    /// The new node (i, j), i <= 0 or j <= 0, of regular refinement on the old net.
    ///
    /// Indices may be negative: nodes further out than the net's own.
    pub fn regular_node(self, i: isize, j: isize) -> Combination {
        tensor(&self.refined(3 - i), &self.refined(3 - j))
            .map(|(a, b, weight)| (place(3 - a, 3 - b), weight))
            .collect()
    }

    /// The node number i + 4j on the c-net: weights of the c-net's node number `node` in
    /// [`CNet`]'s order of a sector; none of its centre.
    pub fn node_of_cnet(self, node: usize) -> Combination {
        let [i, j] = [node % 4, node / 4].map(|index| self.raised(3 - index as isize));
        tensor(&i, &j).filter_map(|(a, b, weight)| Some((cnet_place(a, b)?, weight))).collect()
    }

    /// The patches of the squares A and B of a ring, in this order. Square C is A in the mirror.
    ///
    /// The nodes of a ring have indices -2..=4 in the new net; square A begins at (-2, 0), square B
    /// at (-2, -2). Indices grow towards the centre, parameters of patches away from it.
    pub fn ring(self) -> [Vec<RingPatch>; 2] {
        let last = self.split() - 1;
        [[-2, 0], [-2, -2]].map(|[i, j]| {
            let parts = (0..=last).flat_map(|u| (0..=last).map(move |v| [u, v]));
            let patch = |part: [usize; 2]| {
                let [u, v] = part.map(|k| (last - k) as isize);
                self.patch(part, i + u, j + v)
            };
            parts.map(patch).collect()
        })
    }

    /// The patch over the nodes from (i, j) on.
    fn patch(self, part: [usize; 2], i: isize, j: isize) -> RingPatch {
        let to_bb = self.to_bb();
        let order = self.degree() + 1;
        let mut patch = RingPatch { part, old: Vec::new(), new: Vec::new() };
        for k in (0..order).rev() {
            for l in (0..order).rev() {
                let (mut old, mut new) = (Vec::new(), Vec::new());
                for (a, b) in (0..order).flat_map(|a| (0..order).map(move |b| (a, b))) {
                    let weight = to_bb[(k, a)] * to_bb[(l, b)];
                    let (i, j) = (i + a as isize, j + b as isize);
                    if weight == Real::ZERO {
                        continue;
                    }
                    if i <= 0 || j <= 0 {
                        let node = self.regular_node(i, j);
                        old.extend(node.into_iter().map(|(at, own)| (at, own * weight)));
                    } else {
                        new.push((place(i, j), weight));
                    }
                }
                patch.old.push(old);
                patch.new.push(new);
            }
        }
        patch
    }
}

/// The products of two univariate rules.
fn tensor(
    first: &[(isize, Real)],
    second: &[(isize, Real)],
) -> impl Iterator<Item = (isize, isize, Real)> {
    first.iter().flat_map(move |&(a, wa)| second.iter().map(move |&(b, wb)| (a, b, wa * wb)))
}

/// The node at the place (i, j) of sector s: (turns, number).
fn place(i: isize, j: isize) -> (isize, usize) {
    let (turn, i, j) = home(i as usize, j as usize);
    (turn, i + 4 * j)
}

/// The node (a, b) of a c-net as seen from sector s: (turns, number in its sector), if it is not
/// the centre.
pub fn cnet_place(a: isize, b: isize) -> Option<(isize, usize)> {
    match (a, b) {
        (0, 0) => None,
        (a, b) if a < 0 => cnet_place(b, -a).map(|(turn, node)| (turn + 1, node)),
        (a, b) if b < 0 => cnet_place(-b, a).map(|(turn, node)| (turn - 1, node)),
        (a, 0) => cnet_place(0, a).map(|(turn, node)| (turn - 1, node)),
        (a, b) => Some((0, (2 * a + b - 1) as usize)),
    }
}

/// The weights of a sector's c-net nodes in the extraordinary point p; the centre has the rest.
pub fn point_weights(valence: usize) -> Vec<Real> {
    CNet { valence }.central_point()[..crate::guided::net::NODES_PER_SECTOR].to_vec()
}

/// The nodes of a d-net with rules of their own, as numbers, in the order of
/// [`RULES`](crate::rules::RULES).
pub const INNER: [usize; 6] = [5, 6, 9, 10, 7, 11];

/// The nodes of a d-net that regular refinement gives, as numbers.
pub fn regular_nodes() -> impl Iterator<Item = usize> {
    (0..NODES_PER_SECTOR).filter(|node| !INNER.contains(node))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(combination: &Combination) -> Real {
        combination.iter().map(|&(_, weight)| weight).sum()
    }

    #[test]
    fn all_combinations_sum_to_one() {
        for spline in [Spline::BiQuartic, Spline::BiCubic] {
            for patch in spline.ring().iter().flatten() {
                assert_eq!(patch.old.len(), (spline.degree() + 1).pow(2));
                for (old, new) in patch.old.iter().zip(&patch.new) {
                    let sum = sum(old) + sum(new);
                    assert!((sum - Real::ONE).abs().to_f64() < 1e-29, "{spline:?}");
                }
            }
        }
    }

    #[test]
    fn the_inner_nodes_are_those_with_rules() {
        assert_eq!(INNER, crate::rules::RULES.map(|(h, k)| h + 4 * k));
        let regular: Vec<usize> = regular_nodes().collect();
        assert_eq!(regular, [0, 1, 2, 3, 4, 8]);
    }
}
