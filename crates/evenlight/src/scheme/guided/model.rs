//! The parts that make the rules of a valence and a contraction: the characteristic ring and the
//! guide.
//!
//! At Catmull-Clark's contraction the guides of valences up to 16 are tabulated, and the scheme
//! `cc` gives the characteristic ring. All others are derived when they are asked for, with some
//! 30 digits, by the crate that wrote the tables (feature `derive`).

#[cfg(feature = "derive")]
use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, PoisonError},
};

#[cfg(feature = "derive")]
use evenlight_guide::guided::rounded::RoundedGuide;

use super::monomials;
use crate::angle::{cosine, sine};
use crate::net::CNET_NODES;
use crate::pairs::pairs;
use crate::scheme::catmull_clark;
use crate::scheme::contraction::Contraction;
use crate::scheme::quadratic_attraction::contraction;
use crate::scheme::subdominant::Subdominant;
use crate::scheme::tables::{self, GuideWeights};

/// The largest valence with guides.
#[cfg(feature = "derive")]
pub(in crate::scheme) const LAST_VALENCE: usize = *evenlight_guide::guided::rounded::VALENCES.end();
/// The largest valence with guides.
#[cfg(not(feature = "derive"))]
pub(in crate::scheme) const LAST_VALENCE: usize = crate::scheme::TABULATED_VALENCE;

/// The bi-degree of guides.
#[cfg(feature = "derive")]
const GUIDE_DEGREE: usize = 5;

/// The parts that make the rules of a valence.
pub(super) struct Model {
    /// The width of a ring's hole, the ring being 1 wide.
    pub(super) sigma: f64,
    /// The contraction.
    pub(super) lambda: f64,
    /// The characteristic ring in the domain of the guide: for squares 0, 1, 2 the bi-3 patches of
    /// the sector coordinates u and v of sector 0.
    ///
    /// It is scaled such that the ends of the outer edges are (1,0) and (0,1). But for n = 3
    /// chi(1,1) would lie outside the unit square of the guide; there that corner is (1,1).
    pub(super) characteristic: [[Vec<f64>; 2]; 3],
    /// The coefficients a_ij of [`monomials`] of the guide relative to c_0, on the nodes of a
    /// c-net.
    pub(super) guide: Vec<Vec<f64>>,
}

impl Model {
    /// `None` if there is no guide for valence `n` or no such contraction.
    pub(super) fn new(n: usize, contraction: Contraction) -> Option<Self> {
        let tabulated = match contraction {
            Contraction::CatmullClark => tables::guide_weights(n),
            _ => None,
        };
        tabulated
            .map(|weights| Self::tabulated(n, weights))
            .or_else(|| Self::derived(n, contraction))
    }

    fn tabulated(n: usize, weights: GuideWeights) -> Self {
        Self {
            sigma: 0.5,
            lambda: contraction(n),
            characteristic: characteristic_ring(n),
            guide: guide_of_cnet(n, weights),
        }
    }

    #[cfg(feature = "derive")]
    fn derived(n: usize, contraction: Contraction) -> Option<Self> {
        let guide = derived_guide(n, contraction)?;
        Some(Self {
            sigma: guide.sigma,
            lambda: guide.lambda,
            characteristic: guide.characteristic.clone(),
            guide: guide.powers.clone(),
        })
    }

    #[cfg(not(feature = "derive"))]
    fn derived(_: usize, _: Contraction) -> Option<Self> {
        None
    }
}

/// Guides by valence and the bits of lambda.
#[cfg(feature = "derive")]
type Guides = BTreeMap<(usize, Option<u64>), Arc<RoundedGuide>>;

/// The guides that were derived last. They are kept, as each takes some tenths of a second.
#[cfg(feature = "derive")]
static DERIVED: Mutex<Guides> = Mutex::new(BTreeMap::new());

/// At most this many guides are kept, of 10 to 60 kB each.
#[cfg(feature = "derive")]
const MOST_DERIVED: usize = 256;

/// A derived guide; `None` if there is none.
#[cfg(feature = "derive")]
fn derived_guide(n: usize, contraction: Contraction) -> Option<Arc<RoundedGuide>> {
    let lambda = contraction.lambda();
    let key = (n, lambda.map(f64::to_bits));
    let known = || DERIVED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(guide) = known().get(&key) {
        return Some(guide.clone());
    }
    // Not under the lock: threads may derive different guides at once.
    let guide = Arc::new(RoundedGuide::new(n, lambda, GUIDE_DEGREE, &monomials())?);
    let mut all = known();
    if all.len() >= MOST_DERIVED {
        all.clear();
    }
    all.insert(key, guide.clone());
    Some(guide)
}

/// The rows of the coefficients a_ij on a c-net: C(5,i) C(5,j) times the differences of p_ij,
/// formed in integers and rounded once.
fn guide_of_cnet(n: usize, weights: GuideWeights) -> Vec<Vec<f64>> {
    let coef = |i: usize, j: usize| weights.coefficient(i, j);
    let table: Vec<Vec<Vec<i64>>> =
        (0..=5).map(|i| (0..=5).map(|j| coef(i, j)).collect()).collect();
    let row = |(i, j): (usize, usize)| {
        let weight = |node: usize| {
            let mut sum = 0_i128;
            for (k, l) in pairs(i + 1, j + 1) {
                let sign = if (i - k + j - l).is_multiple_of(2) { 1 } else { -1 };
                sum += sign * binomial(i, k) * binomial(j, l) * i128::from(table[k][l][node]);
            }
            (binomial(5, i) * binomial(5, j) * sum) as f64 / 1e18
        };
        (0..=CNET_NODES * n).map(weight).collect()
    };
    monomials().into_iter().map(row).collect()
}

fn binomial(n: usize, k: usize) -> i128 {
    crate::patch::basis::binomial(n, k) as i128
}

/// The characteristic ring of Catmull-Clark subdivision.
fn characteristic_ring(n: usize) -> [[Vec<f64>; 2]; 3] {
    let rules = catmull_clark::rules(n);
    let net = Subdominant::new(&rules).characteristic_net();
    let refined = rules.refine(&net);
    let angle = std::f64::consts::TAU / n as f64;
    let (c, s) = (cosine(angle), sine(angle));
    let squares = [0, 1, 2].map(|square| rules.patch(0, square, &net, &refined));
    // The end of line -1, u = 1 and v = 0.
    let [x, y, _] = squares[1][12];
    let in_sector = |p: &[f64; 3]| {
        let size = x * x + y * y;
        let [p, q] = [(x * p[0] + y * p[1]) / size, (x * p[1] - y * p[0]) / size];
        [p - c / s * q, q / s]
    };
    let corner = in_sector(&squares[0][15]);
    let scale = 1.0 / corner[0].max(1.0);
    squares.map(|square| [0, 1].map(|k| square.iter().map(|p| scale * in_sector(p)[k]).collect()))
}

#[cfg(all(test, feature = "derive"))]
mod tests {
    use super::*;

    /// Table and derivation agree on everything.
    #[test]
    fn tables_are_what_is_derived() {
        for n in tables::VALENCES {
            let model = Model::new(n, Contraction::CatmullClark).unwrap();
            let derived = Model::derived(n, Contraction::CatmullClark).unwrap();
            assert_eq!(model.sigma, derived.sigma);
            assert!((model.lambda - derived.lambda).abs() < 1e-15);
            let chi = |model: &Model| model.characteristic.concat().concat();
            for (a, b) in chi(&model).iter().zip(chi(&derived)) {
                assert!((a - b).abs() < 1e-13, "n = {n}: {a} {b}");
            }
            for (a, b) in model.guide.iter().flatten().zip(derived.guide.iter().flatten()) {
                assert!((a - b).abs() < 1e-12 * (1.0 + a.abs()), "n = {n}: {a} {b}");
            }
        }
    }

    /// A lambda that happens to be Catmull-Clark's.
    #[test]
    fn speeds_are_continued_by_that_of_catmull_clark() {
        for n in [3, 5, 7, 16] {
            let model = Model::new(n, Contraction::CatmullClark).unwrap();
            let same = Model::new(n, Contraction::Lambda(model.lambda)).unwrap();
            assert!((same.sigma - 0.5).abs() < 1e-14);
            for (a, b) in model.guide.iter().flatten().zip(same.guide.iter().flatten()) {
                assert!((a - b).abs() < 1e-12 * (1.0 + a.abs()), "n = {n}: {a} {b}");
            }
        }
    }
}
