//! The rules of fair4, fair4d and fair3, out of the Fourier blocks.
//!
//! A quadratic q of sector 0 is, in the coordinate z of the characteristic map,
//!
//! ```text
//!   q = p + 2 Re(a z) + 2 Re(b z^2) + c |z|^2,
//! ```
//!
//! The waves of frequency 1 and 2 of the net determine the complex numbers a and b; its mean over
//! the sectors determines the real number c. With u along line s-1 and v along line s,
//! z = u exp(-i pi/n) + v exp(i pi/n), and so the five real numbers of a, b, c determine q_2..q_6.
//!
//! The weights of p are one minus the sum of the others: everything here concerns nets less p.

use crate::evolving_guide::NetRule;
use crate::evolving_guide::symmetrised as symmetrised_evolving;
use crate::linear::Matrix;
use crate::nets::{DNet, Mirror, NODES_PER_SECTOR};
use crate::optimal::block::{Complex, HalfTurns, applied};
use crate::optimal::eigennets::Monomial;
use crate::optimal::local::{Footprint, gains, local_weights, weight};
use crate::optimal::nets::Spline;
use crate::optimal::regulator::{Regulator, regulators};
use crate::quadratic_attraction::{Q_RULES, QasRules};
use crate::real::Real;
use crate::rules::{RULES, StepRule, TURNS, symmetrised};

/// The real numbers Re a, Im a, Re b, Im b, c of a quadratic.
const PARAMETERS: usize = 5;

/// The rules of fair4 (bi-4 splines) or of fair3 (bi-3), valence n = 3 or n >= 5.
///
/// At n = 4 there is no extraordinary point, and nothing to find.
///
/// # Panics
///
/// If the iteration for the local gain does not converge.
pub fn fair(valence: usize, spline: Spline) -> QasRules {
    let regulators = regulators(valence, spline);
    let footprint = Footprint::of_l_nets();
    let weights = local_weights(&regulators, spline, &footprint);
    let gains = gains(&regulators, &footprint, &weights);
    let costs = regulators.iter().zip(&gains).map(|(regulator, gain)| {
        regulator.cost(gain).expect("the iteration keeps the gain stable").to_go
    });
    let costs: Vec<Matrix> = costs.collect();
    let kappa = kappa(&footprint, &weights);
    let nodes = std::array::from_fn(|number| {
        let tau = tau(&regulators, &gains, number);
        let sum: Real = kappa[number].iter().flatten().chain(&tau).copied().sum();
        StepRule { node: RULES[number], kappa: kappa[number], tau, on_centre: Real::ONE - sum }
    });
    QasRules { valence, nodes: symmetrised(&nodes), q: quadratic_rules(&regulators, &costs) }
}

/// The six rules of fair4d, in the order of [`RULES`]: the optimal gain, with q found anew in each
/// step.
pub fn fair_evolving(valence: usize) -> [NetRule; 6] {
    let regulators = regulators(valence, Spline::BiQuartic);
    let steps: Vec<Matrix> = regulators.iter().map(evolving_step).collect();
    let rules = std::array::from_fn(|number| {
        net_rule(valence, |turn, node| weight(&regulators, &steps, number, (turn, node)))
    });
    symmetrised_evolving(valence, &rules)
}

/// The inner nodes on the net alone: K + (D S - K D) (D^T P D)^-1 D^T P.
fn evolving_step(regulator: &Regulator) -> Matrix {
    let to_go = regulator.optimum();
    let gain = regulator.gain(&to_go);
    if regulator.monomials.is_empty() {
        return gain;
    }
    &gain + &(&regulator.on_quadratic(&gain) * &regulator.quadratic(&to_go))
}

/// The rule with these weights of the nodes of sector s + turn.
fn net_rule(valence: usize, weight: impl Fn(usize, usize) -> Real) -> NetRule {
    let net = DNet { valence };
    let at = |k: usize| weight(k / NODES_PER_SECTOR, k % NODES_PER_SECTOR);
    let on_net: Vec<Real> = (0..net.num_nodes()).map(at).collect();
    let sum: Real = on_net.iter().copied().sum();
    NetRule { on_net, on_centre: Real::ONE - sum }
}

/// The weights of a footprint; the weights of rule 12 are the mirror images of those of rule 21.
fn kappa(footprint: &Footprint, weights: &[Real]) -> [[[Real; NODES_PER_SECTOR]; 4]; 6] {
    let mut kappa = [[[Real::ZERO; NODES_PER_SECTOR]; 4]; 6];
    let mut set = |rule: usize, (r, node): (isize, usize), weight: Real| {
        kappa[rule][(r - TURNS[0]) as usize][node] = weight;
    };
    for ((rule, orbit), &weight) in footprint.weights.iter().zip(weights) {
        for &(r, node) in orbit {
            set(*rule, (r, node), weight);
            if RULES[*rule] == (2, 1) {
                let (r, i, j) = Mirror::Diagonal.image((r, node % 4, node / 4));
                set(crate::rules::number_of(1, 2), (r, i + 4 * j), weight);
            }
        }
    }
    kappa
}

/// The weights tau of q_2..q_6 in rule `number`, from the weights of the five parameters.
fn tau(regulators: &[Regulator], gains: &[Matrix], number: usize) -> [Real; 5] {
    let mut on_parameters = Matrix::zeros(1, PARAMETERS);
    for (regulator, gain) in regulators.iter().zip(gains) {
        let steps = regulator.on_quadratic(gain);
        for (column, monomial) in regulator.monomials.iter().enumerate() {
            let wave = std::array::from_fn(|i| Complex { re: steps[(i, column)], im: Real::ZERO });
            let value = regulator.block.value(number, &wave);
            let twice = value.scaled(Real::from(2));
            // 2 Re(value a) = 2 Re value Re a - 2 Im value Im a, and likewise with conj(b).
            let (first, [re, im]) = match monomial {
                Monomial::Linear => (0, [twice.re, -twice.im]),
                Monomial::Square => (2, [twice.re, -twice.im]),
                Monomial::ConjugateSquare => (2, [twice.re, twice.im]),
                Monomial::Norm => {
                    on_parameters[(0, 4)] += value.re;
                    continue;
                }
            };
            on_parameters[(0, first)] += re;
            on_parameters[(0, first + 1)] += im;
        }
    }
    let points = points(&regulators[0].block.half_turns);
    let tau = points.transposed().solve(&on_parameters.transposed());
    let tau = tau.expect("q_2..q_6 determine the quadratic");
    std::array::from_fn(|m| tau[(m, 0)])
}

/// q_2..q_6 of sector 0 less p, as rows on the five parameters.
fn points(half_turns: &HalfTurns) -> Matrix {
    let [one, two] = [1, 2].map(|k| half_turns.power(k));
    let zero = Real::ZERO;
    let twice = |x: Real| x + x;
    // The coefficients of u, v, u^2, uv, v^2.
    let expansion = [
        [twice(one.re), twice(one.im), zero, zero, zero],
        [twice(one.re), -twice(one.im), zero, zero, zero],
        [zero, zero, twice(two.re), twice(two.im), Real::ONE],
        [zero, zero, Real::from(4), zero, twice(two.re)],
        [zero, zero, twice(two.re), -twice(two.im), Real::ONE],
    ];
    // BB form of total degree 5: a/5 for u, a(a-1)/20 for u^2, ab/20 for uv.
    let to_bb = Matrix::from_fractions(
        &[[4, 0, 0, 0, 0], [8, 0, 2, 0, 0], [0, 4, 0, 0, 0], [4, 4, 0, 1, 0], [0, 8, 0, 0, 2]],
        20,
    );
    &to_bb * &Matrix::from_fn(PARAMETERS, PARAMETERS, |i, j| expansion[i][j])
}

/// The rules of q_4 and q_5 in the order of [`Q_RULES`], for the costs P of all blocks.
fn quadratic_rules(regulators: &[Regulator], costs: &[Matrix]) -> [NetRule; 2] {
    let valence = regulators[0].block.valence;
    let points = points(&regulators[0].block.half_turns);
    let rules: Vec<Matrix> =
        regulators.iter().zip(costs).map(|(regulator, cost)| regulator.quadratic(cost)).collect();
    let parameters = |turn: usize, node: usize| {
        let mut found = [Real::ZERO; PARAMETERS];
        for (regulator, rows) in regulators.iter().zip(&rules) {
            let unit = regulator.block.unit(turn, node);
            let values: [Complex; 2] = match regulator.monomials.len() {
                0 => continue,
                1 => [applied::<1>(rows, &unit)[0], Complex::ZERO],
                _ => applied::<2>(rows, &unit),
            };
            for (monomial, value) in regulator.monomials.iter().zip(values) {
                match monomial {
                    Monomial::Linear => [found[0], found[1]] = [value.re, value.im],
                    Monomial::Square => [found[2], found[3]] = [value.re, value.im],
                    Monomial::ConjugateSquare => [found[2], found[3]] = [value.re, -value.im],
                    Monomial::Norm => found[4] = value.re,
                }
            }
        }
        found
    };
    Q_RULES.map(|(m, mirror)| {
        let point = points.row(m - 2);
        let rule = net_rule(valence, |turn, node| {
            parameters(turn, node).into_iter().zip(point).map(|(x, &weight)| weight * x).sum()
        });
        rule.averaged_with(&rule.mirrored(valence, mirror))
    })
}
