//! Univariate bases with derivatives, and the conversions from splines to BB form.

use super::MAX_DEGREE;

/// Values and first and second derivatives of basis functions.
pub type BasisJet<const N: usize> = [[f64; N]; 3];

/// The Bernstein polynomials of degree `d` at `t`: values, first and second derivatives.
/// Entries beyond `d` are zero. `None` if `d` is above [`MAX_DEGREE`].
///
/// Computed by the recursion B_i^d = (1-t) B_i^(d-1) + t B_(i-1)^(d-1), so that the values are
/// exact at t = 0 and 1 and never negative between.
pub fn bernstein(d: usize, t: f64) -> Option<BasisJet<{ MAX_DEGREE + 1 }>> {
    (d <= MAX_DEGREE).then(|| bernstein_basis(d, t))
}

/// [`bernstein`] for a degree that is known to be low enough.
pub(crate) fn bernstein_basis(d: usize, t: f64) -> BasisJet<{ MAX_DEGREE + 1 }> {
    let mut values = [0.0; MAX_DEGREE + 1];
    values[0] = 1.0;
    let mut lower = [[0.0; MAX_DEGREE + 1]; 2]; // the values of degree d - 1 and d - 2
    for degree in 1..=d {
        lower = [values, lower[0]];
        for i in (0..=degree).rev() {
            let left = if i == 0 { 0.0 } else { values[i - 1] };
            values[i] = (1.0 - t) * values[i] + t * left;
        }
    }
    [values, derivative(d, &lower[0]), second_derivative(d, &lower[1])]
}

/// B_i' = d (B_(i-1) - B_i), the right-hand side of degree d - 1.
fn derivative(d: usize, b: &[f64; MAX_DEGREE + 1]) -> [f64; MAX_DEGREE + 1] {
    std::array::from_fn(|i| if i > d { 0.0 } else { d as f64 * (at(b, i, 1) - b[i]) })
}

/// B_i'' = d (d-1) (B_(i-2) - 2 B_(i-1) + B_i), the right-hand side of degree d - 2.
fn second_derivative(d: usize, b: &[f64; MAX_DEGREE + 1]) -> [f64; MAX_DEGREE + 1] {
    if d < 2 {
        return [0.0; MAX_DEGREE + 1];
    }
    let factor = (d * (d - 1)) as f64;
    std::array::from_fn(
        |i| {
            if i > d { 0.0 } else { factor * (at(b, i, 2) - 2.0 * at(b, i, 1) + b[i]) }
        },
    )
}

/// `b[i - back]`; zero in front of the first entry.
fn at(b: &[f64], i: usize, back: usize) -> f64 {
    if i < back { 0.0 } else { b[i - back] }
}

/// The four uniform cubic B-splines that are alive on 0 <= t <= 1: values and derivatives.
#[inline]
pub fn cubic_b_spline(t: f64) -> BasisJet<4> {
    const SIXTH: f64 = 1.0 / 6.0;
    let s = 1.0 - t;
    let (ss, tt) = (s * s, t * t);
    [
        [
            SIXTH * (s * ss),
            SIXTH * (4.0 - 6.0 * tt + 3.0 * (t * tt)),
            SIXTH * (4.0 - 6.0 * ss + 3.0 * (s * ss)),
            SIXTH * (t * tt),
        ],
        [-0.5 * ss, 1.5 * tt - 2.0 * t, 2.0 * s - 1.5 * ss, 0.5 * tt],
        [s, 3.0 * t - 2.0, 3.0 * s - 2.0, t],
    ]
}

/// Row `k` gives the BB coefficient `b_k` of a segment of a uniform cubic spline from its four
/// control points.
pub const CUBIC_B_SPLINE_TO_BB: [[f64; 4]; 4] = [
    [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0, 0.0],
    [0.0, 4.0 / 6.0, 2.0 / 6.0, 0.0],
    [0.0, 2.0 / 6.0, 4.0 / 6.0, 0.0],
    [0.0, 1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0],
];

/// Row `k` gives the BB coefficient `b_k` of a segment of a C2 quartic spline from five
/// control points, the middle one at a simple knot, its neighbours at double knots
/// ([KP23-EG, eq. 5]).
pub const QUARTIC_B_SPLINE_TO_BB: [[f64; 5]; 5] = [
    [0.25, 0.5, 0.25, 0.0, 0.0],
    [0.0, 0.5, 0.5, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 0.5, 0.5, 0.0],
    [0.0, 0.0, 0.25, 0.5, 0.25],
];

/// The binomial coefficient of `n` over `k`, 0 <= k <= n; exact up to 2^53.
pub(crate) fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bernstein_polynomials_sum_to_one_and_their_derivatives_to_zero() {
        for d in 0..=MAX_DEGREE {
            for t in [0.0, 0.1, 0.5, 0.77, 1.0] {
                let [b, d1, d2] = bernstein_basis(d, t).map(|row| row.iter().sum::<f64>());
                assert!((b - 1.0).abs() < 1e-15 && d1.abs() < 1e-14 && d2.abs() < 1e-13);
            }
        }
    }

    #[test]
    fn bernstein_agrees_with_closed_forms() {
        let t: f64 = 0.3;
        let [b, d1, d2] = bernstein_basis(4, t);
        let s = 1.0 - t;
        assert!((b[1] - 4.0 * s * s * s * t).abs() < 1e-15);
        assert!((d1[1] - 4.0 * (s * s * s - 3.0 * s * s * t)).abs() < 1e-15);
        assert!((d2[4] - 12.0 * t * t).abs() < 1e-15);
    }

    #[test]
    fn cubic_b_splines_agree_with_their_bb_form() {
        for t in [0.0, 0.2, 0.9, 1.0] {
            let (spline, bb) = (cubic_b_spline(t), bernstein_basis(3, t));
            for (order, row) in spline.iter().enumerate() {
                for (c, &value) in row.iter().enumerate() {
                    let sum: f64 = (0..4).map(|k| bb[order][k] * CUBIC_B_SPLINE_TO_BB[k][c]).sum();
                    assert!((sum - value).abs() < 1e-14, "order {order}, control point {c}, t {t}");
                }
            }
        }
    }
}
