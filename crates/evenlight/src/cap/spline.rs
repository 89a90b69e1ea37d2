//! The functions that a cap is made of in one parameter: splines on [0,1] of degree D with m
//! pieces of equal length.
//!
//! ```text
//!   c0 c1 c2 ...              c_(dim-1)      D = 5, m = 2, C2: knots 0 (six times),
//!   +-----------+-----------+                1/2 (three times), 1 (six times); dim = 9
//!   0          1/2          1
//! ```
//!
//! At a joint at least two knots meet, so the first three and the last three coefficients are BB
//! coefficients of the first and of the last piece.

use crate::dense::Matrix;
use crate::pairs::pairs;
use crate::patch::basis::{bernstein_basis, binomial};

/// A space of splines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Space {
    /// The degree D.
    pub(super) degree: usize,
    /// The number of pieces m.
    pub(super) pieces: usize,
    /// The continuous derivatives at the joints.
    pub(super) smooth: usize,
}

impl Space {
    /// One polynomial.
    pub(super) fn polynomials(degree: usize) -> Self {
        Self { degree, pieces: 1, smooth: degree - 1 }
    }

    /// The dimension.
    pub(super) fn dim(self) -> usize {
        self.degree + 1 + (self.pieces - 1) * (self.degree - self.smooth)
    }

    /// The part [[a0, a1], [b0, b1]] of the unit square that piece `which` covers, the index along
    /// b fastest.
    pub(super) fn patch_domain(self, which: usize) -> [[f64; 2]; 2] {
        let m = self.pieces;
        [which / m, which % m].map(|k| [k as f64 / m as f64, (k + 1) as f64 / m as f64])
    }

    /// The piece in which (a,b) is, 0 to 1; on a line between two the one before.
    pub(super) fn patch_at(self, at: [f64; 2]) -> usize {
        let m = self.pieces;
        let [i, j] = at.map(|x| ((x * m as f64).ceil() as usize).saturating_sub(1).min(m - 1));
        i * m + j
    }

    /// The length of a piece.
    pub(super) fn step(self) -> f64 {
        1.0 / self.pieces as f64
    }

    /// The knots inside the support of spline `i`; its coefficient is the blossom at these knots.
    fn knots(self, i: usize) -> Vec<f64> {
        (i + 1..=i + self.degree).map(|k| self.knot(k)).collect()
    }

    fn knot(self, k: usize) -> f64 {
        let joint = (k + self.degree - self.smooth).saturating_sub(self.degree + 1)
            / (self.degree - self.smooth);
        if k <= self.degree { 0.0 } else { joint.min(self.pieces) as f64 * self.step() }
    }

    /// The rows of the BB coefficients of all pieces, D+1 each, on the coefficients.
    pub(super) fn to_bb(self) -> Matrix {
        let (order, dim) = (self.degree + 1, self.dim());
        // The inverse of the blossoms, piece by piece: D+1 splines are alive on a piece.
        let mut result = Matrix::zeros(self.pieces * order, dim);
        for piece in 0..self.pieces {
            let first = piece * (self.degree - self.smooth);
            let ends = [piece as f64 * self.step(), (piece + 1) as f64 * self.step()];
            let rows: Vec<Vec<f64>> = (0..order)
                .map(|k| blossom_weights(self.degree, ends, &self.knots(first + k)))
                .collect();
            let inverse = inverted(&Matrix::from_rows(order, &rows));
            for (i, k) in pairs(order, order) {
                result[(piece * order + i, first + k)] = inverse[(i, k)];
            }
        }
        result
    }

    /// The rows of the Taylor coefficients of orders 0 to `orders` - 1 at t of piece `piece`, t its
    /// own parameter from 0 to 1, but in units of the whole interval.
    pub(super) fn taylor(
        self,
        to_bb: &Matrix,
        piece: usize,
        t: f64,
        orders: usize,
    ) -> Vec<Vec<f64>> {
        let order = self.degree + 1;
        let mut factor = 1.0;
        let row = |r: usize| {
            // The r-th derivative over r! is C(D,r) times the r-th differences of degree D - r.
            let values = bernstein_basis(self.degree - r, t)[0];
            let mut bb = vec![0.0; order];
            for (i, &value) in values.iter().enumerate().take(order - r) {
                for k in 0..=r {
                    let sign = if (r - k).is_multiple_of(2) { 1.0 } else { -1.0 };
                    bb[i + k] += sign * binomial(r, k) * binomial(self.degree, r) * value * factor;
                }
            }
            factor *= self.pieces as f64;
            let rows = Matrix::from_rows(order, &[bb]);
            let piece = to_bb.select_rows(piece * order..(piece + 1) * order);
            rows.times(&piece).row(0).to_vec()
        };
        (0..orders.min(order)).map(row).collect()
    }

    /// The rows of the coefficients on the BB coefficients of degree `degree` of a spline with the
    /// joints `knots` (the ends 0 and 1 included), one piece after the other.
    ///
    /// That spline must be in the space. It may have more joints, or be one polynomial.
    pub(super) fn through_pieces(self, knots: &[f64], degree: usize) -> Matrix {
        let order = degree + 1;
        let raise = raising(degree, self.degree);
        let mut rows = Vec::new();
        for i in 0..self.dim() {
            let arguments = self.knots(i);
            let middle = arguments.iter().sum::<f64>() / arguments.len() as f64;
            // The polynomials on both sides of a joint in the middle have the same blossom.
            let around = (0..knots.len() - 1)
                .filter(|&k| knots[k] <= middle + NEAR && middle - NEAR <= knots[k + 1]);
            let around: Vec<usize> = around.collect();
            let mut row = vec![0.0; (knots.len() - 1) * order];
            for &k in &around {
                let weights = blossom_weights(self.degree, [knots[k], knots[k + 1]], &arguments);
                let weights = Matrix::from_rows(self.degree + 1, &[weights]).times(&raise);
                for (j, w) in weights.row(0).iter().enumerate() {
                    row[k * order + j] += w / around.len() as f64;
                }
            }
            rows.push(row);
        }
        Matrix::from_rows((knots.len() - 1) * order, &rows)
    }
}

/// Parameters closer than this count as one: thirds are rounded.
const NEAR: f64 = 1e-9;

/// The weights of the BB coefficients over [t0, t1] in the blossom at the arguments.
fn blossom_weights(degree: usize, [t0, t1]: [f64; 2], arguments: &[f64]) -> Vec<f64> {
    let mut weights = vec![1.0];
    for &t in arguments {
        let local = (t - t0) / (t1 - t0);
        let mut next = vec![0.0; weights.len() + 1];
        for (i, &w) in weights.iter().enumerate() {
            next[i] += (1.0 - local) * w;
            next[i + 1] += local * w;
        }
        weights = next;
    }
    debug_assert_eq!(weights.len(), degree + 1);
    weights
}

/// The BB coefficients over [t0, t1] on those over [0,1].
pub(super) fn restriction(degree: usize, [t0, t1]: [f64; 2]) -> Matrix {
    let row = |i: usize| {
        let arguments: Vec<f64> = (0..degree).map(|k| if k < i { t1 } else { t0 }).collect();
        blossom_weights(degree, [0.0, 1.0], &arguments)
    };
    Matrix::from_rows(degree + 1, &(0..=degree).map(row).collect::<Vec<_>>())
}

/// The matrix of degree raising from `from` to `to`.
pub(super) fn raising(from: usize, to: usize) -> Matrix {
    let mut result = Matrix::zeros(to + 1, from + 1);
    for (i, j) in pairs(to + 1, from + 1) {
        if j <= i && i - j <= to - from {
            result[(i, j)] = binomial(from, j) * binomial(to - from, i - j) / binomial(to, i);
        }
    }
    result
}

/// The inverse of a regular matrix.
pub(super) fn inverted(a: &Matrix) -> Matrix {
    let n = a.num_rows();
    let mut unit = Matrix::zeros(n, n);
    (0..n).for_each(|k| unit[(k, k)] = 1.0);
    crate::dense::Qr::new(a.clone()).least_squares(unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spaces() -> impl Iterator<Item = Space> {
        [(3, 3, 1), (3, 4, 1), (4, 2, 1), (4, 3, 1), (5, 2, 2), (5, 3, 2), (6, 1, 2), (6, 2, 2)]
            .into_iter()
            .map(|(degree, pieces, smooth)| Space { degree, pieces, smooth })
    }

    fn column(values: &[f64]) -> Matrix {
        Matrix::from_rows(1, &values.iter().map(|&x| vec![x]).collect::<Vec<_>>())
    }

    #[test]
    fn splines_are_smooth_at_the_joints_and_sum_to_one() {
        for space in spaces() {
            let to_bb = space.to_bb();
            for i in 0..to_bb.num_rows() {
                assert!((to_bb.row(i).iter().sum::<f64>() - 1.0).abs() < 1e-13, "{space:?}");
            }
            for joint in 1..space.pieces {
                let before = space.taylor(&to_bb, joint - 1, 1.0, space.smooth + 1);
                let after = space.taylor(&to_bb, joint, 0.0, space.smooth + 1);
                for (a, b) in before.concat().iter().zip(after.concat()) {
                    assert!((a - b).abs() < 1e-11, "{space:?} {a} {b}");
                }
            }
        }
    }

    #[test]
    fn the_first_and_the_last_three_coefficients_are_those_of_the_end_pieces() {
        for space in spaces() {
            let to_bb = space.to_bb();
            let last = to_bb.num_rows() - 1;
            for k in 0..3 {
                assert!((to_bb[(k, k)] - 1.0).abs() < 1e-14, "{space:?}");
                assert!((to_bb[(last - k, space.dim() - 1 - k)] - 1.0).abs() < 1e-14);
            }
        }
    }

    /// The coefficients of a polynomial given in pieces give its values.
    #[test]
    fn polynomials_in_pieces_are_found_again() {
        let cubic = [0.3, -0.7, 0.2, 0.9];
        let value = |t: f64| {
            let b = bernstein_basis(3, t)[0];
            (0..4).map(|i| b[i] * cubic[i]).sum::<f64>()
        };
        for (space, knots) in
            spaces().flat_map(|s| [vec![0.0, 1.0], vec![0.0, 0.5, 1.0]].map(|k| (s, k)))
        {
            let pieces: Vec<f64> = knots
                .windows(2)
                .flat_map(|ends| {
                    (0..4).map(|i| {
                        let at = |k: usize| ends[usize::from(k < i)];
                        let arguments = [at(0), at(1), at(2)];
                        let w = blossom_weights(3, [0.0, 1.0], &arguments);
                        (0..4).map(|j| w[j] * cubic[j]).sum::<f64>()
                    })
                })
                .collect();
            let coefs = space.through_pieces(&knots, 3).times(&column(&pieces));
            let to_bb = space.to_bb();
            for (piece, t) in (0..space.pieces).flat_map(|p| [0.0, 0.3, 1.0].map(|t| (p, t))) {
                let row = space.taylor(&to_bb, piece, t, 1).concat();
                let found = Matrix::from_rows(space.dim(), &[row]).times(&coefs)[(0, 0)];
                let exact = value((piece as f64 + t) * space.step());
                assert!((found - exact).abs() < 1e-13, "{space:?} {found} {exact}");
            }
        }
    }
}
