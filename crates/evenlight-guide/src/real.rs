//! Numbers of about 31 digits.
//!
//! A [`Real`] is an unevaluated sum of two `f64` ("double-double"). Sums, products and square
//! roots come from the crate `twofloat`, exact to a relative 2^-102 or better. Quotients are
//! our own: `twofloat` 0.8.4 divides by way of `1 - y * (1/y)` and rounds where its source (Joldes,
//! Muller, Popescu 2017, algorithm 18) has a fused multiply-add. So it keeps 16 digits only.
//! Its cosine keeps 22; we need one cosine per valence and sum its series.
//!
//! Every operation is made of `+ - * /`, `sqrt` and fused multiply-add on `f64`, which round
//! alike on every machine. So the tables are the same everywhere.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use twofloat::{TwoFloat, consts::TAU};

/// A real number, to a relative accuracy of about 1e-31.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Real(TwoFloat);

impl Real {
    /// Zero.
    pub const ZERO: Self = Self(TwoFloat::from_f64(0.0));
    /// One.
    pub const ONE: Self = Self(TwoFloat::from_f64(1.0));

    /// The fraction `numerator / denominator`.
    pub fn ratio(numerator: i32, denominator: i32) -> Self {
        Self::from(numerator) / Self::from(denominator)
    }

    /// cos(2 pi / n), to 1e-30, for `n >= 1`.
    pub fn cos_of_turn(n: usize) -> Self {
        cos(Self(TAU) / Self::from(n as f64))
    }

    /// The square root; NaN below zero.
    pub fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    /// The absolute value.
    pub fn abs(self) -> Self {
        Self(self.0.abs())
    }

    /// The nearest `f64`.
    pub fn to_f64(self) -> f64 {
        self.0.hi()
    }

    /// The integer nearest to `self * denominator`; its absolute value must be below 2^63.
    pub fn numerator_over(self, denominator: i64) -> i64 {
        let scaled = (self * Self(TwoFloat::from(denominator))).0;
        let whole = scaled.hi().round();
        // Above 2^53 the high word is an integer and the fraction sits in the low word.
        let rest = (scaled.hi() - whole) + scaled.lo();
        whole as i64 + rest.round() as i64
    }
}

/// The cosine series for `x` in [0, 2 pi], up to x^60 / 60! < 1e-33.
fn cos(x: Real) -> Real {
    let mut term = Real::ONE;
    let mut terms = vec![term];
    for k in 1..=30 {
        term = -(term * x * x / Real::from((2 * k - 1) * (2 * k)));
        terms.push(term);
    }
    terms.into_iter().rev().sum() // smallest first
}

impl From<f64> for Real {
    fn from(value: f64) -> Self {
        Self(TwoFloat::from(value))
    }
}

impl From<i32> for Real {
    fn from(value: i32) -> Self {
        Self(TwoFloat::from(value))
    }
}

impl Add for Real {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl AddAssign for Real {
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl Sub for Real {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Neg for Real {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Mul for Real {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl Div for Real {
    type Output = Self;

    /// Long division: three digits in base 2^53, the last one for the rounding of the second.
    fn div(self, other: Self) -> Self {
        let digit = |rest: TwoFloat| rest.hi() / other.0.hi();
        let q0 = digit(self.0);
        let rest = self.0 - other.0 * q0;
        let q1 = digit(rest);
        let q2 = digit(rest - other.0 * q1);
        Self(TwoFloat::new_add(q0, q1) + q2)
    }
}

impl Sum for Real {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::ZERO, Add::add)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(a: Real, b: Real, tolerance: f64) {
        let error = (a - b).abs().to_f64();
        assert!(error <= tolerance, "{} against {}: off by {error:e}", a.to_f64(), b.to_f64());
    }

    #[test]
    fn quotients_times_divisors_are_the_dividends() {
        for p in 1..60 {
            for q in 1..60 {
                assert_near(Real::ratio(p, q) * Real::from(q), Real::from(p), 2e-32 * f64::from(p));
                let y = Real::ratio(q, 7) + Real::from(1e-17);
                assert_near(Real::from(p) / y * y, Real::from(p), 4e-32 * f64::from(p));
            }
        }
    }

    #[test]
    fn square_roots_square_back() {
        for p in 1..100 {
            assert_near(Real::from(p).sqrt() * Real::from(p).sqrt(), Real::from(p), 1e-29);
        }
    }

    #[test]
    fn cosines_of_constructible_polygons_are_their_radicals() {
        let root = |x: i32| Real::from(x).sqrt();
        let half = Real::ratio(1, 2);
        let closed_forms = [
            (1, Real::ONE),
            (2, -Real::ONE),
            (3, -half),
            (4, Real::ZERO),
            (5, (root(5) - Real::ONE) / Real::from(4)),
            (6, half),
            (8, root(2) * half),
            (10, (root(5) + Real::ONE) / Real::from(4)),
            (12, root(3) * half),
            (16, (Real::from(2) + root(2)).sqrt() * half),
        ];
        for (n, cos) in closed_forms {
            assert_near(Real::cos_of_turn(n), cos, 1e-30);
        }
    }

    #[test]
    fn numerators_are_exact_beyond_the_53_bits_of_a_float() {
        let denominator = 1_000_000_000_000_000_000;
        assert_eq!(Real::ratio(1, 3).numerator_over(denominator), 333_333_333_333_333_333);
        assert_eq!(Real::ratio(-2, 3).numerator_over(denominator), -666_666_666_666_666_667);
        assert_eq!(Real::ratio(9, 1).numerator_over(denominator), 9 * denominator);
        assert_eq!(Real::ZERO.numerator_over(denominator), 0);
    }
}
