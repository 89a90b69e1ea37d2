//! One variable: C2 splines of degree 4, uniform, every second node on a double knot.
//!
//! ```text
//! index of the node      0   1   2   3   4
//!                        o   x   o   x   o     x: on a grid line, a double knot
//! position in the net    3   2   1   0  -1     o: between two of them, a simple knot
//!                            |-------|
//!                      the segment of nodes 0..4, b_0 at x = 1 and b_4 at x = 3
//! ```
//!
//! Positions count half steps from the line or point that the net is about. The tensor products of
//! the masks below make everything regular: from the cage to the d-net, from the d-net to
//! Bernstein-Bezier (BB) form and back, and the refinement of the regular nodes.

use crate::{linear::Matrix, real::Real};

/// B to BB: the five BB coefficients of the segment on its nodes d_0..d_4, [KP23-EG, eq. 5].
pub fn spline_to_bb() -> Matrix {
    Matrix::from_fractions(
        &[[1, 2, 1, 0, 0], [0, 2, 2, 0, 0], [0, 0, 4, 0, 0], [0, 0, 2, 2, 0], [0, 0, 1, 2, 1]],
        4,
    )
}

/// BB to B, the inverse of [`spline_to_bb`]: d_0..d_4 on the BB coefficients.
pub fn bb_to_spline() -> Matrix {
    Matrix::from_fractions(
        &[[4, -4, 1, 0, 0], [0, 2, -1, 0, 0], [0, 0, 1, 0, 0], [0, 0, -1, 2, 0], [0, 0, 1, -4, 4]],
        1,
    )
}

/// Degree raising: the spline node at `position` on the nodes of a uniform cubic spline, as pairs
/// of (cubic node, weight); the cubic node k stands at position 2k. [KP23-EG, fig. 5]
pub fn raised_cubic(position: isize) -> Vec<(isize, Real)> {
    let k = position.div_euclid(2);
    if position.rem_euclid(2) == 0 {
        vec![(k - 1, Real::ratio(1, 12)), (k, Real::ratio(10, 12)), (k + 1, Real::ratio(1, 12))]
    } else {
        vec![(k, Real::ratio(1, 2)), (k + 1, Real::ratio(1, 2))]
    }
}

/// Refinement of the uniform cubic spline: the new node k on the old ones, as pairs of
/// (old node, weight); the old node k becomes the new node 2k.
pub fn refined_cubic(k: isize) -> Vec<(isize, Real)> {
    let old = k.div_euclid(2);
    if k.rem_euclid(2) == 0 {
        vec![(old - 1, Real::ratio(1, 8)), (old, Real::ratio(6, 8)), (old + 1, Real::ratio(1, 8))]
    } else {
        vec![(old, Real::ratio(1, 2)), (old + 1, Real::ratio(1, 2))]
    }
}

/// Refinement of the spline: the new node at `position` on the old ones, as pairs of
/// (old position, weight). [KP23-EG, eq. 1]
///
/// The pattern has period 4 in the new and 2 in the old positions. Even positions are double
/// knots: every second of the new ones is an old one.
pub fn refined(position: isize) -> Vec<(isize, Real)> {
    let old = 2 * position.div_euclid(4);
    let weights = match position.rem_euclid(4) {
        0 => [(old - 1, 3), (old, 10), (old + 1, 3)],
        1 => [(old - 1, 1), (old, 6), (old + 1, 9)],
        2 => [(old, 2), (old + 1, 12), (old + 2, 2)],
        _ => [(old + 1, 9), (old + 2, 6), (old + 3, 1)],
    };
    weights.map(|(node, weight)| (node, Real::ratio(weight, 16))).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::largest;

    /// The weights of `second` after `first`, over the positions -20..=20.
    fn composed(first: Vec<(isize, Real)>, second: fn(isize) -> Vec<(isize, Real)>) -> [Real; 41] {
        let mut weights = [Real::ZERO; 41];
        for (node, outer) in first {
            for (k, inner) in second(node) {
                weights[(k + 20) as usize] += outer * inner;
            }
        }
        weights
    }

    #[test]
    fn the_conversions_are_inverse() {
        let identity = &spline_to_bb() * &bb_to_spline();
        assert!(largest(&(&identity - &Matrix::identity(5))) == 0.0);
    }

    #[test]
    fn raising_then_refining_is_refining_then_raising() {
        for position in -8..=8 {
            let raised_first = composed(refined(position), raised_cubic);
            let refined_first = composed(raised_cubic(position), refined_cubic);
            for (a, b) in raised_first.into_iter().zip(refined_first) {
                assert!((a - b).abs().to_f64() < 1e-30, "at {position}");
            }
        }
    }
}
