//! Spectra: the eigenvalues of the subdivision matrices and the characteristic map.
//!
//! The matrix of a scheme at valence n has the eigenvalue 1 (the limit point) and those of the
//! Fourier blocks B_m = sum_r exp(2 pi i m r / n) A_r of the rules relative to the limit point.
//! Sorted by modulus they begin 1, lambda, lambda, mu, ...:
//!
//! - lambda simple in the blocks 1 and n-1, with an injective characteristic map: the surface
//!   is C1 at the extraordinary point \[PR08\];
//! - mu = lambda^2: curvature is bounded there; mu > lambda^2: it is not.
//!
//! With a quadratic the matrix is block triangular,
//!
//! ```text
//!   | M_d  M_dq |      M_q: 1, lambda, lambda, lambda^2 (three times)
//!   |  0   M_q  |      M_d: the Fourier blocks of the control net
//! ```
//!
//! and curvature is bounded if all eigenvalues of M_d are below lambda^2 [KP23-QAS, Section 5].
//!
//! A guided surface is subdivided by shrinking its guide: the homogeneous guides of degree s, sums
//! of u^i v^j with i + j = s and i, j <= 5 that join G2, are the eigenspace of lambda^s. Their
//! dimensions for s = 0, 1, .. 10, found by [`multiplicity`], are [KP18-Guided, table 5]
//!
//! ```text
//!   1, 2, 3, n*, 2n, 3n, 3n, 3n, 3n, 2n, n,     n* = n + 1 for n = 3 and 6, else n.
//! ```
//!
//! The nodes of the library are more: powers of the pieces, whether they join or not, and data
//! along the border. The border comes from the guide alone; it adds eigenvalues 0, and pieces that
//! do not join add multiplicity. Neither is counted.

use nalgebra::{Complex, DMatrix};

use super::injectivity::jacobian_is_positive;
use crate::basis::{MAX_TOTAL_DEGREE, multiplicity};
use crate::patch::Patch;
use crate::scheme::{Rules, SchemeKind, Subdominant, Variant};

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
    /// The largest modulus among the eigenvalues of M_d, over lambda^2, for schemes with a
    /// quadratic or a guide; below 1 it proves that curvature is bounded.
    pub md_max_over_lambda2: Option<f64>,
    /// How many entries of the whole matrix are zero, in percent.
    pub zeros_percent: f64,
    /// The smallest Jacobian of the characteristic map on a grid of 17 x 17 points per patch of
    /// its first ring, relative to the largest.
    pub jacobian_min: f64,
    /// Whether the Jacobian is positive on the whole first ring: proved by Bernstein-Bezier
    /// coefficients, which bound it between the grid's points too. The map scales from ring to
    /// ring and turns once around the centre, so it is injective.
    pub injectivity_proved: bool,
}

/// The spectrum of `scheme` at `valence`; `None` if there are no rules for it.
///
/// Eigenvalues are exact to about 1e-13 where they are simple; small multiple ones (1/64 and
/// below) to about 1e-5, as their eigenvectors coincide.
pub fn spectrum(
    scheme: SchemeKind,
    variant: impl Into<Variant>,
    valence: usize,
) -> Option<Spectrum> {
    let rules = scheme.rules(variant, valence)?;
    let subdominant = Subdominant::new(&rules);
    let lambda = subdominant.lambda;
    let mut moduli = if rules.guide.is_some() {
        guided_moduli(valence, lambda)
    } else {
        (0..valence).flat_map(|m| block_moduli(&rules, m)).collect()
    };
    let largest = moduli.iter().copied().fold(0.0, f64::max);
    moduli.push(1.0);
    let has_expansion = rules.lambda_of_linear_terms().is_some();
    if has_expansion {
        moduli.extend([lambda, lambda, lambda * lambda, lambda * lambda, lambda * lambda]);
    }
    moduli.sort_by(|a, b| b.total_cmp(a));
    let ring = characteristic_ring(&rules, &subdominant);
    Some(Spectrum {
        valence,
        lambda,
        mu_over_lambda2: moduli[3] / (lambda * lambda),
        md_max_over_lambda2: has_expansion.then(|| largest / (lambda * lambda)),
        zeros_percent: zeros_percent(scheme, &rules),
        jacobian_min: smallest_jacobian(&ring),
        injectivity_proved: ring.iter().all(jacobian_is_positive),
        moduli,
    })
}

/// The eigenvalues of a guide of degree 3 and more, each as often as there are homogeneous guides.
fn guided_moduli(n: usize, lambda: f64) -> Vec<f64> {
    let mut power = lambda * lambda;
    let eigenvalues = (3..=MAX_TOTAL_DEGREE).map(|degree| {
        power *= lambda;
        vec![power; multiplicity(n, degree).unwrap_or(0)]
    });
    eigenvalues.collect::<Vec<_>>().concat()
}

/// The moduli of the eigenvalues of Fourier block `m` of the control net.
fn block_moduli(rules: &Rules, m: usize) -> Vec<f64> {
    let (n, all, size) = (rules.valence, rules.nodes_per_sector, rules.control_nodes_per_sector());
    let mut block = DMatrix::<Complex<f64>>::zeros(size, size);
    for (i, row) in rules.refine[..size].iter().enumerate() {
        for &(at, w) in row.iter().filter(|(at, _)| at % all < size) {
            let turns = (m * (at / all)) % n;
            let angle = std::f64::consts::TAU * turns as f64 / n as f64;
            block[(i, at % all)] += Complex::from_polar(w, angle);
        }
    }
    let (_, triangular) = block.schur().unpack();
    triangular.diagonal().iter().map(|z| z.norm()).collect()
}

/// The zeros of the whole matrix in percent, as the paper counts them [KP23-QAS, Section 8]: nets
/// of 12 nodes per sector and the centre (for Catmull-Clark three rings of quads and e), with a
/// quadratic 5 more per sector, q_2 to q_6, each sector for itself; of guided schemes the nodes are
/// the library's own, relative to the centre.
fn zeros_percent(scheme: SchemeKind, rules: &Rules) -> f64 {
    let n = rules.valence;
    let (per_sector, nodes, center_row) = if scheme == SchemeKind::CatmullClark {
        // Node (a,b), a = 0..3, b = 1..3: 2 or 3 old nodes in either direction.
        let old = |k: usize| if k.is_multiple_of(2) { 3 } else { 2 };
        let pairs = (0..4).flat_map(|a| (1..4).map(move |b| (a, b)));
        (pairs.map(|(a, b)| old(a) * old(b)).sum::<usize>(), 12, 2 * n + 1)
    } else if rules.guide.is_some() {
        let of_sector: usize = rules.refine.iter().map(Vec::len).sum();
        (of_sector, rules.nodes_per_sector, 1)
    } else {
        let control = &rules.refine[..rules.control_nodes_per_sector()];
        let of_net: usize =
            control.iter().map(|row| row.len() + usize::from(has_center(row))).sum();
        // The rows of S in eq. (2) for q_2 to q_6 have 2, 3, 2, 4 and 3 entries.
        let [of_q, q] = if rules.quadratic.is_some() { [14, 5] } else { [0, 0] };
        (of_net + of_q, 12 + q, 1)
    };
    let (entries, size) = (n * per_sector + center_row, n * nodes + 1);
    100.0 * (1.0 - entries as f64 / (size * size) as f64)
}

/// Whether a row leaves weight for the centre: its weights do not sum to one.
fn has_center(row: &[(usize, f64)]) -> bool {
    (row.iter().map(|(_, w)| w).sum::<f64>() - 1.0).abs() > 1e-9
}

/// Sector 0 of the first ring of the characteristic map.
fn characteristic_ring(rules: &Rules, subdominant: &Subdominant) -> Vec<Patch> {
    let net = subdominant.characteristic_net();
    let refined = rules.refine(&net);
    (0..rules.patches_per_sector())
        .map(|which| Patch::of([rules.degree; 2], rules.patch(0, which, &net, &refined)))
        .collect()
}

fn smallest_jacobian(ring: &[Patch]) -> f64 {
    let at = |k: usize| k as f64 / (GRID - 1) as f64;
    let mut jacobians = Vec::new();
    for patch in ring {
        for k in 0..GRID * GRID {
            let jet = patch.jet(at(k / GRID), at(k % GRID));
            jacobians.push(jet.du[0] * jet.dv[1] - jet.du[1] * jet.dv[0]);
        }
    }
    let largest = jacobians.iter().fold(0.0_f64, |m, j| m.max(j.abs()));
    jacobians.into_iter().fold(f64::INFINITY, f64::min) / largest
}
