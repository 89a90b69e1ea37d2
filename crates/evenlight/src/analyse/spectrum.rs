//! Spectra: the eigenvalues of the subdivision matrices and the characteristic map.
//!
//! The matrix of a scheme at valence n has the eigenvalue 1 (the limit point) and those of the
//! Fourier blocks B_m = sum_r exp(2 pi i m r / n) A_r of the rules relative to the limit point.
//! Sorted by modulus they begin 1, lambda, lambda, mu, ...:
//!
//! - lambda simple in the blocks 1 and n-1, with an injective characteristic map: the surface
//!   is C1 at the extraordinary point [PR08];
//! - mu = lambda^2: curvature is bounded there; mu > lambda^2: it is not.

use nalgebra::{Complex, DMatrix};

use crate::patch::Patch;
use crate::scheme::{RuleSet, Rules, SchemeKind, Subdominant};

/// Grid points along each side of a patch, ends included, for the Jacobian.
const GRID: usize = 17;

/// The spectrum of one scheme at one valence.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// The valence.
    pub valence: usize,
    /// The moduli of all eigenvalues, falling.
    pub moduli: Vec<f64>,
    /// The subdominant eigenvalue.
    pub lambda: f64,
    /// The modulus of the subsubdominant eigenvalue over lambda^2.
    pub mu_over_lambda2: f64,
    /// The smallest Jacobian of the characteristic map on a grid of 17 x 17 points per patch of
    /// its first ring, relative to the largest; positive if the map is locally injective there.
    pub jacobian_min: f64,
}

/// The spectrum of `scheme` at `valence`; `None` if there are no rules for it.
///
/// Eigenvalues are exact to about 1e-13 where they are simple; small multiple ones (1/64 and
/// below) to about 1e-5, as their eigenvectors coincide.
pub fn spectrum(scheme: SchemeKind, set: RuleSet, valence: usize) -> Option<Spectrum> {
    let rules = scheme.rules(set, valence)?;
    let mut moduli = vec![1.0];
    moduli.extend((0..valence).flat_map(|m| block_moduli(&rules, m)));
    moduli.sort_by(|a, b| b.total_cmp(a));
    let subdominant = Subdominant::new(&rules);
    let lambda = subdominant.lambda;
    Some(Spectrum {
        valence,
        lambda,
        mu_over_lambda2: moduli[3] / (lambda * lambda),
        jacobian_min: smallest_jacobian(&rules, &subdominant),
        moduli,
    })
}

/// The moduli of the eigenvalues of Fourier block `m`.
fn block_moduli(rules: &Rules, m: usize) -> Vec<f64> {
    let (n, size) = (rules.valence, rules.nodes_per_sector);
    let mut block = DMatrix::<Complex<f64>>::zeros(size, size);
    for (i, row) in rules.refine.iter().enumerate() {
        for &(node, w) in row {
            let turns = (m * (node / size)) % n;
            let angle = std::f64::consts::TAU * turns as f64 / n as f64;
            block[(i, node % size)] += Complex::from_polar(w, angle);
        }
    }
    let (_, triangular) = block.schur().unpack();
    triangular.diagonal().iter().map(|z| z.norm()).collect()
}

fn smallest_jacobian(rules: &Rules, subdominant: &Subdominant) -> f64 {
    let net = subdominant.characteristic_net();
    let refined = rules.refine(&net);
    let mut jacobians = Vec::new();
    for which in 0..rules.patches_per_sector() {
        let patch = Patch::new([rules.degree; 2], rules.patch(0, which, &net, &refined));
        for i in 0..GRID {
            for j in 0..GRID {
                let at = |k: usize| k as f64 / (GRID - 1) as f64;
                let jet = patch.jet(at(i), at(j));
                jacobians.push(jet.du[0] * jet.dv[1] - jet.du[1] * jet.dv[0]);
            }
        }
    }
    let largest = jacobians.iter().fold(0.0_f64, |m, j| m.max(j.abs()));
    jacobians.into_iter().fold(f64::INFINITY, f64::min) / largest
}
