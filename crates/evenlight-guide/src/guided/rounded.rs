//! The numbers that a surface needs for a valence and a contraction, computed when they are asked
//! for and rounded once.
//!
//! The tables of [`emit`](crate::emit) hold Catmull-Clark's contraction and valences up to 16. A
//! library takes everything else from here; valence 32 needs half a second.

use std::ops::RangeInclusive;

use crate::guided::bb::choose;
use crate::guided::cap::cap_map;
use crate::guided::characteristic::{CharacteristicRing, Square, sigma_of};
use crate::guided::fit::generating_matrix_of_degree;
use crate::guided::net::CNet;
use crate::guided::space::DEGREE;
use crate::guided::symmetry::symmetric_rows;
use crate::linear::Matrix;
use crate::real::Real;

/// The valences for which guides are computed, without 4.
pub const VALENCES: RangeInclusive<usize> = 3..=32;

/// The contractions lambda, ends excluded, for which guides are computed.
pub const LAMBDAS: [f64; 2] = [0.3, 0.7];

/// The guide of one valence and contraction.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundedGuide {
    /// The valence n.
    pub valence: usize,
    /// The inserted knot: the width of a ring's hole if the ring is 1 wide.
    pub sigma: f64,
    /// The contraction per ring.
    pub lambda: f64,
    /// The characteristic ring in the domain of the guide: for the squares at the outer corner,
    /// along the first line, along the second (B, A, C of [`super::characteristic`]) the bi-3 BB
    /// coefficients of the two sector coordinates.
    pub characteristic: [[Vec<f64>; 2]; 3],
    /// For each of `exponents` (i, j) the coefficient of u^i v^j in the piece of sector 0, on the
    /// 6n + 1 nodes of a c-net numbered by [`CNet::index`] and relative to its c_0: p_00 is zero.
    pub powers: Vec<Vec<f64>>,
    /// The BB coefficients, number 7i + j, of the first coordinate of the cap's map.
    pub cap_map: Vec<f64>,
}

impl RoundedGuide {
    /// The guide of valence `valence` with the contraction `lambda`, or, if that is `None`, of
    /// Catmull-Clark subdivision; guides of bi-`degree` 5, or 4 or 3 [KP18-Guided, sec. 6.1].
    ///
    /// `None` if the valence is not one of [`VALENCES`], or is 4, or `lambda` is not between
    /// [`LAMBDAS`].
    pub fn new(
        valence: usize,
        lambda: Option<f64>,
        degree: usize,
        exponents: &[(usize, usize)],
    ) -> Option<Self> {
        let is_known = |lambda: f64| LAMBDAS[0] < lambda && lambda < LAMBDAS[1];
        if !VALENCES.contains(&valence) || valence == 4 || !lambda.is_none_or(is_known) {
            return None;
        }
        let chi = match lambda {
            Some(lambda) => CharacteristicRing::new(valence, sigma_of(valence, lambda.into())),
            None => CharacteristicRing::catmull_clark(valence),
        };
        let generating = generating_matrix_of_degree(degree, &chi);
        let rows = symmetric_rows(&generating, valence);
        Some(Self {
            valence,
            sigma: chi.sigma.to_f64(),
            lambda: chi.lambda.to_f64(),
            characteristic: [Square::B, Square::A, Square::C].map(|square| {
                chi.square(square).map(|map| rounded(&map.scaled(chi.domain_scale())))
            }),
            powers: exponents.iter().map(|&exponent| power(&rows, valence, exponent)).collect(),
            cap_map: rounded(&cap_map(&chi)),
        })
    }
}

/// The coefficient of u^i v^j: C(5,i) C(5,j) times the differences of the BB coefficients, p_00
/// being c_0.
fn power(rows: &[Vec<Real>], valence: usize, (i, j): (usize, usize)) -> Vec<f64> {
    let weight = |node: usize| {
        let terms = (0..=i).flat_map(|k| (0..=j).map(move |l| (k, l))).map(|(k, l)| {
            let sign = if (i - k + j - l).is_multiple_of(2) { Real::ONE } else { -Real::ONE };
            let p_kl = if k + l == 0 { Real::ZERO } else { rows[(DEGREE + 1) * k + l][node] };
            sign * choose(i, k) * choose(j, l) * p_kl
        });
        (choose(DEGREE, i) * choose(DEGREE, j) * terms.sum()).to_f64()
    };
    (0..CNet { valence }.num_nodes()).map(weight).collect()
}

/// The entries by rows.
fn rounded(matrix: &Matrix) -> Vec<f64> {
    (0..matrix.num_rows()).flat_map(|i| matrix.row(i)).map(|x| x.to_f64()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (1,0), (0,1), (1,1), (5,5).
    const SOME: [(usize, usize); 4] = [(1, 0), (0, 1), (1, 1), (5, 5)];

    #[test]
    fn the_speed_of_catmull_clark_is_one_half_in_the_domain() {
        for n in [3, 5, 8] {
            let guide = RoundedGuide::new(n, None, 5, &SOME).unwrap();
            assert_eq!(guide.sigma, 0.5);
            let again = RoundedGuide::new(n, Some(guide.lambda), 5, &SOME).unwrap();
            assert!((again.sigma - 0.5).abs() < 1e-15);
            for (a, b) in guide.powers.iter().flatten().zip(again.powers.iter().flatten()) {
                assert!((a - b).abs() < 1e-12, "n = {n}: {a} {b}");
            }
        }
    }

    #[test]
    fn there_are_guides_for_valences_to_32_and_speeds_between_the_limits_only() {
        let exists = |n, lambda| RoundedGuide::new(n, lambda, 5, &SOME).is_some();
        assert!(!exists(2, None) && !exists(4, None) && !exists(33, None));
        for lambda in [0.3, 0.7, -1.0, f64::NAN, f64::INFINITY] {
            assert!(!exists(5, Some(lambda)));
        }
        assert!(exists(32, Some(0.300_001)) && exists(3, Some(0.699_999)));
    }
}
