//! Sine and cosine of the angles between sectors.
//!
//! The standard library's may round differently from platform to platform, and with them every
//! coordinate of a surface; these use only operations that round alike everywhere.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// cos x for 0 <= x <= 2 pi, exact to 4e-16.
pub(crate) fn cosine(x: f64) -> f64 {
    if x > PI { cosine(TAU - x) } else { sine(FRAC_PI_2 - x) }
}

/// sin x for |x| <= 2 pi, exact to 4e-16, by its power series.
pub(crate) fn sine(x: f64) -> f64 {
    if x < 0.0 {
        return -sine(-x);
    }
    if x > PI {
        return -sine(x - PI);
    }
    let x = if x > FRAC_PI_2 { PI - x } else { x };
    // 13 terms: (pi/2)^27 / 27! is 2e-23.
    let series = |sum: f64, k: i32| 1.0 - x * x / f64::from(2 * k * (2 * k + 1)) * sum;
    x * (1..=13).rev().fold(1.0, series)
}

/// The cosine of the angle between two lines of a point of valence `n`.
pub(crate) fn sector_cosine(n: usize) -> f64 {
    cosine(TAU / n as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_are_exact_to_rounding() {
        for k in 0..=1000 {
            let x = TAU * f64::from(k) / 1000.0;
            assert!((sine(x) - x.sin()).abs() < 4e-16, "{x}");
            assert!((cosine(x) - x.cos()).abs() < 4e-16, "{x}");
        }
    }
}
