//! Polynomials in two variables, cut off after the second degree in each: the 2-jets of patches.

use std::ops::Mul;

use crate::real::Real;

/// The Taylor coefficients t_ij of x^i y^j, 0 <= i, j <= 2, at a corner of a patch.
#[derive(Clone, Copy, Debug)]
pub struct Jet([[Real; 3]; 3]);

impl Jet {
    /// The jet of the constant `value`.
    pub fn constant(value: Real) -> Self {
        let mut taylor = [[Real::ZERO; 3]; 3];
        taylor[0][0] = value;
        Self(taylor)
    }

    /// The jet with the bi-4 BB coefficients b_kl, 0 <= k, l <= 2, at its corner.
    pub fn from_bb(coefs: [[Real; 3]; 3]) -> Self {
        Self(in_both_indices(coefs, |[b0, b1, b2]| {
            [b0, Real::from(4) * (b1 - b0), Real::from(6) * (b0 - b1 - b1 + b2)]
        }))
    }

    /// The bi-4 BB coefficients b_kl, 0 <= k, l <= 2, at the corner: in one variable b_0 = t_0,
    /// b_1 = t_0 + t_1/4, b_2 = t_0 + t_1/2 + t_2/6.
    pub fn to_bb(self) -> [[Real; 3]; 3] {
        in_both_indices(self.0, |[t0, t1, t2]| {
            let quarter = t1 * Real::ratio(1, 4);
            [t0, t0 + quarter, t0 + quarter + quarter + t2 * Real::ratio(1, 6)]
        })
    }

    /// The Bernstein polynomials C(d,a) (1-f)^(d-a) f^a, a = 0..=d, of this jet f.
    pub fn bernstein(self, degree: usize) -> Vec<Self> {
        let one_minus = self.subtracted_from_one();
        (0..=degree)
            .map(|a| {
                let factors = [vec![self; a], vec![one_minus; degree - a]].concat();
                let factor = Self::constant(Real::from(binomial(degree, a) as i32));
                factors.into_iter().fold(factor, Self::mul)
            })
            .collect()
    }

    fn subtracted_from_one(self) -> Self {
        let mut taylor = self.0.map(|row| row.map(|t| -t));
        taylor[0][0] += Real::ONE;
        Self(taylor)
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let entry = |i: usize, j: usize| -> Real {
            let splits = (0..=i).flat_map(|k| (0..=j).map(move |l| (k, l)));
            splits.map(|(k, l)| self.0[k][l] * other.0[i - k][j - l]).sum()
        };
        Self(std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))))
    }
}

/// The binomial coefficient C(n, k).
pub fn binomial(n: usize, k: usize) -> usize {
    (0..k).fold(1, |c, i| c * (n - i) / (i + 1))
}

/// The linear `map` of three numbers, applied along the second index and then along the first.
fn in_both_indices(
    mut array: [[Real; 3]; 3],
    map: impl Fn([Real; 3]) -> [Real; 3],
) -> [[Real; 3]; 3] {
    for _ in 0..2 {
        let mapped = array.map(&map);
        array = std::array::from_fn(|i| std::array::from_fn(|j| mapped[j][i]));
    }
    array
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> [[Real; 3]; 3] {
        std::array::from_fn(|k| {
            std::array::from_fn(|l| Real::ratio((7 * k + 3 * l + k * l) as i32, 10))
        })
    }

    #[test]
    fn bb_form_and_taylor_form_are_inverse() {
        let back = Jet::from_bb(ramp()).to_bb();
        for (a, b) in ramp().iter().flatten().zip(back.iter().flatten()) {
            assert!((*a - *b).abs().to_f64() < 1e-30);
        }
    }

    #[test]
    fn bernstein_polynomials_of_a_jet_sum_to_one() {
        let polynomials = Jet::from_bb(ramp()).bernstein(5);
        for i in 0..3 {
            for j in 0..3 {
                let sum: Real = polynomials.iter().map(|p| p.0[i][j]).sum();
                let one = if i + j == 0 { 1.0 } else { 0.0 };
                assert!((sum - Real::from(one)).abs().to_f64() < 1e-27);
            }
        }
    }
}
