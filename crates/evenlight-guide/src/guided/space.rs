//! The space of guides: n bi-5 pieces that join with curvature continuity.
//!
//! The piece g^s of sector s lives over the unit square in sector coordinates, u along line s-1 and
//! v along line s, the extraordinary point at (0,0). All pieces together are one function h on the
//! plane, h = g^s(L_s^-1), with L_s(u,v) = u e_(s-1) + v e_s; the guide is G2 if h is C2.
//!
//! ```text
//!            line s
//!              |    sector s          along line s-1, with a the sector ahead
//!         b    |  /  g^s              and b the one behind, arguments exchanged,
//!            \ | /                    so that the first runs along the line:
//!   behind ----+---- line s-1           a_ij = g^s_ij,  b_ij = g^(s-1)_ji
//! ```
//!
//! As e_s + e_(s-2) = 2c e_(s-1), c = cos(2 pi / n), h is C2 across the line if and only if on it,
//! v = 0, [KP18-Guided, eq. 1 and 2]
//!
//! ```text
//! a = b,    a_v + b_v = 2c a_u,    b_vv - a_vv + 4c a_uv - 4c^2 a_uu = 0.
//! ```
//!
//! In powers, a = sum a_ij u^i v^j, each condition is one relation between coefficients of equal
//! degree i + j: the conditions do not know lengths, only angles. So the space is the direct sum
//! of its parts of degree 0 to 10, and each part is the kernel of a small matrix
//! ([`homogeneous`]). Shrinking the plane by lambda multiplies the part of degree s by lambda^s:
//! the parts are the eigenspaces of the subdivision, with the multiplicities of [`multiplicity`].
//! At the centre the parts of degree 0, 1 and 2 have dimension 1, 2 and 3: all pieces share one
//! quadratic.

use std::ops::RangeInclusive;

use crate::guided::bb::{monomials, number, raise};
use crate::guided::solutions::kernel;
use crate::linear::Matrix;
use crate::real::Real;

/// The bi-degree of the guide.
pub const DEGREE: usize = 5;

/// The number of coefficients of one piece.
pub const COEFS: usize = (DEGREE + 1) * (DEGREE + 1);

/// The highest total degree of a term of a guide.
pub const MAX_TOTAL: usize = 2 * DEGREE;

/// The number of a coefficient of a guide of valence n: piece `sector` (modulo n), index (i, j).
pub fn index(valence: usize, sector: isize, i: usize, j: usize) -> usize {
    let sector = sector.rem_euclid(valence as isize) as usize;
    COEFS * sector + (DEGREE + 1) * i + j
}

/// The dimension of the part of total degree `total` at valence n = 3 or n >= 5,
/// [KP18-Guided, table 5]: 1, 2, 3, n*, 2n, 3n, 3n, 3n, 3n, 2n, n with n* = n, but n + 1 for
/// n = 3 and n = 6.
pub fn multiplicity(valence: usize, total: usize) -> usize {
    match total {
        0..=2 => total + 1,
        3 if valence == 3 || valence == 6 => valence + 1,
        3 => valence,
        4 | 9 => 2 * valence,
        5..=8 => 3 * valence,
        10 => valence,
        _ => 0,
    }
}

/// A basis, as columns of BB coefficients, of the guides of total degrees in `totals`.
pub fn basis(valence: usize, totals: RangeInclusive<usize>) -> Matrix {
    let parts: Vec<Matrix> = totals.map(|total| homogeneous(valence, total)).collect();
    let none = Matrix::zeros(COEFS * valence, 0);
    parts.iter().fold(none, |basis, part| basis.beside(part))
}

/// A basis, as columns of BB coefficients, of the guides whose pieces have only terms
/// u^i v^j with i + j = `total`.
pub fn homogeneous(valence: usize, total: usize) -> Matrix {
    homogeneous_of_degree(DEGREE, valence, total)
}

/// The same for guides of bi-`degree` 3, 4 or 5: those of bi-degree 5 without terms in which a
/// variable has a higher power [KP18-Guided, sec. 6.1]; `total` must not exceed 2 `degree`. Their
/// coefficients are given in bi-degree 5 all the same.
pub fn homogeneous_of_degree(degree: usize, valence: usize, total: usize) -> Matrix {
    let exponents = exponents(degree, total);
    let kernel = kernel(&conditions(valence, &exponents));
    let one = monomials(DEGREE);
    Matrix::from_fn(COEFS * valence, kernel.num_columns(), |row, column| {
        let (sector, i, j) = (row / COEFS, row % COEFS / (DEGREE + 1), row % (DEGREE + 1));
        let terms = exponents.iter().enumerate().map(|(k, &(p, q))| {
            one[(i, p)] * one[(j, q)] * kernel[(exponents.len() * sector + k, column)]
        });
        terms.sum()
    })
}

/// The exponents (i, j) of bi-degree `degree` with i + j = `total`.
pub(crate) fn exponents(degree: usize, total: usize) -> Vec<(usize, usize)> {
    let i = total.saturating_sub(degree)..=total.min(degree);
    i.map(|i| (i, total - i)).collect()
}

/// The conditions on the power coefficients of degree `total`, three per line.
fn conditions(valence: usize, exponents: &[(usize, usize)]) -> Matrix {
    let total = exponents[0].0 + exponents[0].1;
    let mut matrix = Matrix::zeros(3 * valence, exponents.len() * valence);
    for line in 0..valence {
        for (k, condition) in conditions_on_line(valence, total).into_iter().enumerate() {
            for Term { is_ahead, exponent, weight } in condition {
                let sector = if is_ahead { line } else { (line + valence - 1) % valence };
                if let Some(at) = exponents.iter().position(|&known| known == exponent) {
                    matrix[(3 * line + k, exponents.len() * sector + at)] += weight;
                }
            }
        }
    }
    matrix
}

/// A power coefficient of the piece ahead of a line, or of the one behind it, in a condition.
pub(crate) struct Term {
    pub(crate) is_ahead: bool,
    /// The exponents in the piece's own coordinates.
    pub(crate) exponent: (usize, usize),
    pub(crate) weight: Real,
}

/// The conditions across a line on power coefficients of degree `total`:
/// a_i0 = b_i0; a_i1 + b_i1 = 2c (i+1) a_(i+1)0;
/// b_i2 - a_i2 + 2c (i+1) a_(i+1)1 = 2c^2 (i+2)(i+1) a_(i+2)0.
/// Terms of guides of lower degree are among them; those that do not exist are zero.
pub(crate) fn conditions_on_line(valence: usize, total: usize) -> [Vec<Term>; 3] {
    let c = Real::cos_of_turn(valence);
    let (one, two) = (Real::ONE, Real::from(2));
    let ahead = |exponent, weight| Term { is_ahead: true, exponent, weight };
    let behind = |(i, j): (usize, usize)| Term { is_ahead: false, exponent: (j, i), weight: one };
    let mut conditions = [Vec::new(), Vec::new(), Vec::new()];
    if total <= DEGREE {
        conditions[0] = vec![behind((total, 0)), ahead((total, 0), -one)];
    }
    if (1..=DEGREE + 1).contains(&total) {
        let along = ahead((total, 0), -two * c * number(total));
        conditions[1] = vec![ahead((total - 1, 1), one), behind((total - 1, 1)), along];
    }
    if (2..=DEGREE + 2).contains(&total) {
        conditions[2] = vec![
            behind((total - 2, 2)),
            ahead((total - 2, 2), -one),
            ahead((total - 1, 1), two * c * number(total - 1)),
            ahead((total, 0), -two * c * c * number(total * (total - 1))),
        ];
    }
    conditions
}

/// The columns of `basis` made orthonormal, from the left, by two rounds of Gram-Schmidt; they must
/// be independent.
pub fn orthonormal(basis: &Matrix) -> Matrix {
    let columns = basis.transposed();
    let mut done: Vec<Vec<Real>> = Vec::with_capacity(columns.num_rows());
    for k in 0..columns.num_rows() {
        let mut column = columns.row(k).to_vec();
        for _ in 0..2 {
            for other in &done {
                let share = dot(other, &column);
                column.iter_mut().zip(other).for_each(|(x, &y)| *x = *x - share * y);
            }
        }
        let inverse = Real::ONE / dot(&column, &column).sqrt();
        column.iter_mut().for_each(|x| *x = inverse * *x);
        done.push(column);
    }
    Matrix::from_fn(basis.num_rows(), basis.num_columns(), |i, j| done[j][i])
}

fn dot(a: &[Real], b: &[Real]) -> Real {
    a.iter().zip(b).map(|(&x, &y)| x * y).sum()
}

/// The conditions of the module's head on BB coefficients, 18 rows per line; zero on guides.
///
/// Per line and i = 0..5: a_i0 - b_i0; (a_v + b_v - 2c a_u)_i / 5; and the second-order condition
/// / 20; all as BB coefficients of quintics along the line.
pub fn bb_conditions(valence: usize) -> Matrix {
    let c = Real::cos_of_turn(valence);
    let raises = [raise(DEGREE - 1, DEGREE), raise(DEGREE - 2, DEGREE)];
    let mut matrix = Matrix::zeros(18 * valence, COEFS * valence);
    for (line, i) in (0..valence).flat_map(|line| (0..=DEGREE).map(move |i| (line, i))) {
        let ahead = |i, j| index(valence, line as isize, i, j);
        let behind = |i, j| index(valence, line as isize - 1, j, i);
        let row = 18 * line + 3 * i;
        across(&mut matrix, row, i, Real::ONE, ahead);
        across(&mut matrix, row, i, -Real::ONE, behind);
        along(&mut matrix, row, c, raises.each_ref().map(|raise| raise.row(i)), ahead);
    }
    matrix
}

/// The differences across the line, of one side: in the second condition of both sides the same, in
/// the others with the sign of the side.
fn across(
    matrix: &mut Matrix,
    row: usize,
    i: usize,
    sign: Real,
    side: impl Fn(usize, usize) -> usize,
) {
    matrix[(row, side(i, 0))] += sign;
    for (j, weight) in [(0, -1), (1, 1)] {
        matrix[(row + 1, side(i, j))] += Real::from(weight);
    }
    for (j, weight) in [(0, -1), (1, 2), (2, -1)] {
        matrix[(row + 2, side(i, j))] += sign * Real::from(weight);
    }
}

/// The derivatives along the line, all of the side ahead, raised to degree 5.
fn along(
    matrix: &mut Matrix,
    row: usize,
    c: Real,
    raises: [&[Real]; 2],
    ahead: impl Fn(usize, usize) -> usize,
) {
    for (q, &weight) in raises[0].iter().enumerate() {
        let (first, mixed) = (Real::from(-2) * c * weight, Real::from(5) * c * weight);
        matrix[(row + 1, ahead(q + 1, 0))] += first;
        matrix[(row + 1, ahead(q, 0))] += -first;
        for (i, j, weight) in [(1, 1, mixed), (0, 1, -mixed), (1, 0, -mixed), (0, 0, mixed)] {
            matrix[(row + 2, ahead(q + i, j))] += weight;
        }
    }
    for (q, &weight) in raises[1].iter().enumerate() {
        let second = Real::from(-4) * c * c * weight;
        for (i, weight) in [(0, second), (1, Real::from(-2) * second), (2, second)] {
            matrix[(row + 2, ahead(q + i, 0))] += weight;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::largest;

    const VALENCES: [usize; 8] = [3, 5, 6, 7, 8, 9, 10, 16];

    #[test]
    fn the_parts_have_the_dimensions_of_the_eigenspaces() {
        for n in VALENCES {
            for total in 0..=MAX_TOTAL {
                let dimension = homogeneous(n, total).num_columns();
                assert_eq!(dimension, multiplicity(n, total), "valence {n}, degree {total}");
            }
        }
    }

    #[test]
    fn the_conditions_have_no_other_solutions() {
        for n in [3, 5, 6, 8] {
            let all: usize = (0..=MAX_TOTAL).map(|total| multiplicity(n, total)).sum();
            let star = if n == 3 || n == 6 { n + 1 } else { n };
            assert_eq!(all, 17 * n + star + 6);
            assert_eq!(kernel(&bb_conditions(n)).num_columns(), all, "valence {n}");
        }
    }

    #[test]
    fn guides_join_with_curvature_continuity() {
        for n in VALENCES {
            let residual = &bb_conditions(n) * &basis(n, 0..=MAX_TOTAL);
            assert!(largest(&residual) < 1e-26, "valence {n}: {:e}", largest(&residual));
        }
    }

    #[test]
    fn orthonormal_columns_span_the_same_guides() {
        let n = 6;
        let guides = orthonormal(&basis(n, 0..=MAX_TOTAL));
        let products = &guides.transposed() * &guides;
        let identity = Matrix::identity(guides.num_columns());
        assert!(largest(&(&products - &identity)) < 1e-28);
        assert!(largest(&(&bb_conditions(n) * &guides)) < 1e-26);
    }
}
