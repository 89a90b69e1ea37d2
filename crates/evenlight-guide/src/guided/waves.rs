//! Guides that go around the point like waves.
//!
//! The space of guides is invariant under turns, so it is the sum of *waves*: complex guides whose
//! piece of sector s is omega^(m s) times that of sector 0, omega = exp(2 pi i / n), with the
//! frequencies m = 0, .., n-1. One piece, 36 complex coefficients, determines a wave. Every problem
//! on all guides falls apart into small problems, one for each frequency; the problems of m and
//! n - m are conjugate.
//!
//! A complex column is kept as twice as many real rows, the real parts first.

use std::ops::RangeInclusive;

use crate::guided::bb::monomials;
use crate::guided::solutions::kernel;
use crate::guided::space::{COEFS, DEGREE, Term, conditions_on_line, exponents};
use crate::linear::Matrix;
use crate::real::Real;

/// The waves of one valence.
#[derive(Clone, Debug)]
pub struct Waves {
    /// The valence n.
    pub valence: usize,
    /// omega^k, k = 0, .., n-1, as real and imaginary part.
    roots: Vec<[Real; 2]>,
}

impl Waves {
    /// The waves of valence n >= 3.
    pub fn new(valence: usize) -> Self {
        let c = Real::cos_of_turn(valence);
        let s = (Real::ONE - c * c).sqrt();
        let next = |&[x, y]: &[Real; 2]| Some([c * x - s * y, s * x + c * y]);
        let roots = std::iter::successors(Some([Real::ONE, Real::ZERO]), next);
        Self { valence, roots: roots.take(valence).collect() }
    }

    /// The frequencies up to n/2.
    pub fn frequencies(&self) -> RangeInclusive<usize> {
        0..=self.valence / 2
    }

    /// The factor omega^(m s) of sector s (modulo n), as real and imaginary part.
    pub fn factor(&self, frequency: usize, sector: isize) -> [Real; 2] {
        let sector = sector.rem_euclid(self.valence as isize) as usize;
        self.roots[frequency * sector % self.valence]
    }

    /// The share of a frequency and its conjugate in an impulse on one sector: 2/n, or 1/n if it is
    /// its own conjugate.
    pub fn share(&self, frequency: usize) -> Real {
        let is_real = frequency == 0 || 2 * frequency == self.valence;
        Real::ratio(if is_real { 1 } else { 2 }, self.valence as i32)
    }

    /// A basis over the real numbers of the waves of one frequency with terms of total degrees in
    /// `totals`, of bi-`degree` 3, 4 or 5: columns of 36 + 36 BB coefficients of bi-degree 5.
    pub fn basis(&self, frequency: usize, degree: usize, totals: RangeInclusive<usize>) -> Matrix {
        let parts = totals.map(|total| self.homogeneous(frequency, degree, total));
        parts.fold(Matrix::zeros(2 * COEFS, 0), |all, part| all.beside(&part))
    }

    /// The part of total degree `total`.
    fn homogeneous(&self, frequency: usize, degree: usize, total: usize) -> Matrix {
        let exponents = exponents(degree, total);
        let kernel = kernel(&self.conditions(frequency, &exponents, total));
        let one = monomials(DEGREE);
        Matrix::from_fn(2 * COEFS, kernel.num_columns(), |row, column| {
            let (half, i, j) = (row / COEFS, row % COEFS / (DEGREE + 1), row % (DEGREE + 1));
            let terms = exponents.iter().enumerate().map(|(k, &(p, q))| {
                one[(i, p)] * one[(j, q)] * kernel[(exponents.len() * half + k, column)]
            });
            terms.sum()
        })
    }

    /// The conditions across line -1 on the power coefficients of sector 0, the piece behind being
    /// omega^(-m) times that of sector 0; real parts first.
    fn conditions(&self, frequency: usize, exponents: &[(usize, usize)], total: usize) -> Matrix {
        let count = exponents.len();
        let mut matrix = Matrix::zeros(6, 2 * count);
        for (k, condition) in conditions_on_line(self.valence, total).into_iter().enumerate() {
            for Term { is_ahead, exponent, weight } in condition {
                let Some(at) = exponents.iter().position(|&known| known == exponent) else {
                    continue;
                };
                let [re, im] = self.factor(frequency, if is_ahead { 0 } else { -1 });
                matrix[(k, at)] += weight * re;
                matrix[(k, count + at)] += -(weight * im);
                matrix[(3 + k, at)] += weight * im;
                matrix[(3 + k, count + at)] += weight * re;
            }
        }
        matrix
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guided::space::{MAX_TOTAL, bb_conditions, homogeneous_of_degree};
    use crate::linear::largest;

    /// The dimension over the complex numbers of all waves with terms of one total degree.
    fn dimension(n: usize, degree: usize, total: usize) -> usize {
        let waves = Waves::new(n);
        let of = |m| waves.homogeneous(m, degree, total).num_columns() / 2;
        (0..n).map(|m| of(m.min(n - m))).sum()
    }

    #[test]
    fn waves_are_all_guides() {
        for n in [3, 5, 6, 8] {
            for degree in [3, 4, 5] {
                for total in 0..=2 * degree {
                    let all = homogeneous_of_degree(degree, n, total).num_columns();
                    assert_eq!(dimension(n, degree, total), all, "n = {n}, {degree}, {total}");
                }
            }
        }
    }

    /// [KP18-Guided, sec. 6.1]: 17n + 6 + n*, 9n + 6 + n* and 3n + 6 + n*, at every valence.
    #[test]
    fn guides_of_lower_degree_have_the_dimensions_of_the_paper() {
        for n in (3..=32).filter(|&n| n != 4) {
            let star = if n == 3 || n == 6 { n + 1 } else { n };
            for (degree, factor) in [(5, 17), (4, 9), (3, 3)] {
                let all: usize = (0..=2 * degree).map(|total| dimension(n, degree, total)).sum();
                assert_eq!(all, factor * n + 6 + star, "n = {n}, bi-{degree}");
            }
        }
    }

    #[test]
    fn waves_join_with_curvature_continuity() {
        for n in [3, 6, 7, 20] {
            let waves = Waves::new(n);
            for m in waves.frequencies() {
                let basis = waves.basis(m, 5, 0..=MAX_TOTAL);
                let guide = Matrix::from_fn(COEFS * n, basis.num_columns(), |row, column| {
                    let [re, im] = waves.factor(m, (row / COEFS) as isize);
                    let k = row % COEFS;
                    re * basis[(k, column)] - im * basis[(COEFS + k, column)]
                });
                let residual = largest(&(&bb_conditions(n) * &guide));
                assert!(residual < 1e-26, "n = {n}, m = {m}: {residual:e}");
            }
        }
    }
}
