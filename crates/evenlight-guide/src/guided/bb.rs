//! Univariate Bernstein-Bezier tools of any degree: Taylor data, degree raising, restriction.
//!
//! A polynomial of degree d on `[0,1]` is the column of its coefficients b_0..b_d. Everything here
//! is a matrix on such columns; a patch of bi-degree d, numbered i (d + 1) + j with i along u and j
//! along v, is treated by Kronecker products of two of them.

use crate::jet::binomial;
use crate::linear::Matrix;
use crate::real::Real;

/// An end of the unit interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// t = 0.
    Start,
    /// t = 1.
    Finish,
}

/// Both ends, the start first.
pub const ENDS: [End; 2] = [End::Start, End::Finish];

impl End {
    /// The parameter, 0 or 1.
    pub fn parameter(self) -> Real {
        match self {
            Self::Start => Real::ZERO,
            Self::Finish => Real::ONE,
        }
    }

    /// The index of the first of the `count` coefficients next to this end.
    pub fn first(self, degree: usize, count: usize) -> usize {
        match self {
            Self::Start => 0,
            Self::Finish => degree + 1 - count,
        }
    }
}

/// The Taylor coefficients of orders 0..`count` at `t`: `count` rows on b_0..b_d.
///
/// Order r is C(d,r) times the r-th differences of the coefficients, evaluated in degree d - r.
pub fn taylor(degree: usize, count: usize, t: Real) -> Matrix {
    let mut differences = Matrix::identity(degree + 1);
    let mut rows = Matrix::zeros(count, degree + 1);
    for r in 0..count.min(degree + 1) {
        let value = &evaluation(degree - r, t) * &differences;
        rows.set_row(r, value.scaled(choose(degree, r)).row(0));
        differences = Matrix::from_fn(degree - r, degree + 1, |i, j| {
            differences[(i + 1, j)] - differences[(i, j)]
        });
    }
    rows
}

/// The Taylor coefficients of orders 0..`count` at an end.
pub fn taylor_at(degree: usize, count: usize, end: End) -> Matrix {
    taylor(degree, count, end.parameter())
}

/// The Bernstein polynomials at `t`, as one row.
fn evaluation(degree: usize, t: Real) -> Matrix {
    let s = Real::ONE - t;
    Matrix::from_fn(1, degree + 1, |_, i| choose(degree, i) * power(t, i) * power(s, degree - i))
}

/// The `count` BB coefficients next to an end, in increasing index, from the Taylor coefficients
/// there: at the start b_i = sum over r <= i of C(i,r) / C(d,r) t_r.
pub fn bb_from_taylor(degree: usize, count: usize, end: End) -> Matrix {
    let entry = |i: usize, r: usize| choose(i, r) / choose(degree, r);
    Matrix::from_fn(count, count, |i, r| match end {
        End::Start => entry(i, r),
        End::Finish if r % 2 == 0 => entry(count - 1 - i, r),
        End::Finish => -entry(count - 1 - i, r),
    })
}

/// Degree raising: `to + 1` rows on the coefficients of degree `from <= to`.
pub fn raise(from: usize, to: usize) -> Matrix {
    (from..to).fold(Matrix::identity(from + 1), |raised, degree| {
        let d = number(degree + 1);
        let one_more = Matrix::from_fn(degree + 2, degree + 1, |i, j| match i.checked_sub(j) {
            Some(0) => number(degree + 1 - i) / d,
            Some(1) => number(i) / d,
            _ => Real::ZERO,
        });
        &one_more * &raised
    })
}

/// De Casteljau: the coefficients over `[a,b]`, with parameter again in `[0,1]`.
///
/// Coefficient i is the blossom at d - i times a and i times b.
pub fn restrict(degree: usize, a: Real, b: Real) -> Matrix {
    let mut rows = Matrix::zeros(degree + 1, degree + 1);
    for i in 0..=degree {
        let mut points = Matrix::identity(degree + 1);
        for step in 0..degree {
            let t = if step < i { b } else { a };
            let count = degree - step;
            points = Matrix::from_fn(count, degree + 1, |k, j| {
                (Real::ONE - t) * points[(k, j)] + t * points[(k + 1, j)]
            });
        }
        rows.set_row(i, points.row(0));
    }
    rows
}

/// The BB coefficients of the monomials 1, t, .., t^d, as columns.
pub fn monomials(degree: usize) -> Matrix {
    Matrix::from_fn(degree + 1, degree + 1, |i, power| choose(i, power) / choose(degree, power))
}

/// The diagonal matrix of 1, h, h^2, ..: Taylor coefficients in units `h` times as long.
pub fn units(count: usize, h: Real) -> Matrix {
    Matrix::from_fn(count, count, |i, j| if i == j { power(h, i) } else { Real::ZERO })
}

/// `base` to the power `exponent`.
pub fn power(base: Real, exponent: usize) -> Real {
    (0..exponent).fold(Real::ONE, |product, _| product * base)
}

/// The binomial coefficient C(n, k), zero for k > n.
pub fn choose(n: usize, k: usize) -> Real {
    if k > n { Real::ZERO } else { number(binomial(n, k)) }
}

/// A small integer as a real number.
pub fn number(value: usize) -> Real {
    Real::from(value as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::largest;

    fn scattered(degree: usize) -> Matrix {
        Matrix::from_fn(degree + 1, 1, |i, _| Real::ratio((7 * i as i32 + 3) % 11 - 5, 10))
    }

    fn assert_equal(a: &Matrix, b: &Matrix) {
        assert!(largest(&(a - b)) < 1e-27);
    }

    #[test]
    fn taylor_data_at_an_end_and_the_coefficients_next_to_it_are_inverse() {
        for degree in 3..=6 {
            for end in ENDS {
                for count in 1..=degree.min(4) {
                    let first = end.first(degree, count);
                    let next = taylor_at(degree, count, end).columns(first..first + count);
                    let product = &bb_from_taylor(degree, count, end) * &next;
                    assert_equal(&product, &Matrix::identity(count));
                }
            }
        }
    }

    #[test]
    fn raising_and_restricting_do_not_change_the_polynomial() {
        let (a, b, t) = (Real::ratio(1, 3), Real::ratio(4, 5), Real::ratio(2, 7));
        for degree in 3..=5 {
            let p = scattered(degree);
            let raised = &raise(degree, 6) * &p;
            let before = &taylor(degree, 4, t) * &p;
            assert_equal(&(&taylor(6, 4, t) * &raised), &before);
            let part = &restrict(degree, a, b) * &p;
            let local = (t - a) / (b - a);
            let after = &taylor(degree, 4, local) * &part;
            assert_equal(&after, &(&units(4, b - a) * &before));
        }
    }

    #[test]
    fn the_taylor_coefficients_of_monomials_at_the_start_are_unit_vectors() {
        let product = &taylor_at(5, 6, End::Start) * &monomials(5);
        assert_equal(&product, &Matrix::identity(6));
    }
}
