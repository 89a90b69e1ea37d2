//! Fairness-optimal subdivision against the numbers of our double-precision prototype,
//! `data/golden/fair`, and its theorems.

use evenlight_guide::characteristic::characteristic_map;
use evenlight_guide::evolving_guide::NetRule;
use evenlight_guide::linear::Matrix;
use evenlight_guide::nets::{DNet, NODES_PER_SECTOR};
use evenlight_guide::optimal::local::{Footprint, gains, local_weights};
use evenlight_guide::optimal::nets::{INNER, Spline};
use evenlight_guide::optimal::regulator::{Regulator, regulators, size};
use evenlight_guide::optimal::rules::{fair, fair_evolving};
use evenlight_guide::quadratic_attraction::QasRules;
use evenlight_guide::real::Real;
use evenlight_guide::rules::{RULES, TURNS};
use serde_json::Value;

/// The valences of the prototype.
const VALENCES: [usize; 7] = [3, 5, 6, 7, 8, 9, 10];

/// The valences with tables.
const ALL: [usize; 13] = [3, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

fn golden(valence: usize) -> Value {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/golden/fair");
    let text = std::fs::read_to_string(format!("{folder}/n{valence:02}.json"));
    serde_json::from_str(&text.expect("there is a file per valence")).expect("the files are JSON")
}

fn numbers(row: &Value) -> Vec<f64> {
    let list = row.as_array().expect("a row is a list");
    list.iter().map(|x| x.as_f64().expect("a row holds numbers")).collect()
}

fn deviation(found: &[Real], golden: &[f64]) -> f64 {
    assert_eq!(found.len(), golden.len());
    let pairs = found.iter().zip(golden);
    pairs.map(|(x, y)| (*x - Real::from(*y)).abs().to_f64()).fold(0.0, f64::max)
}

/// The places of an L-net in the order of the prototype.
fn places() -> impl Iterator<Item = (usize, usize)> {
    let places = (0..5).flat_map(|j| (0..5).map(move |i| (i, j)));
    places.filter(|&(i, j)| i < 3 || j < 3)
}

/// The weights of all nodes in a rule of the prototype.
fn golden_weights(net: DNet, (h, _): (usize, usize), kappa: &[f64]) -> Vec<f64> {
    let mut weights = vec![0.0; net.num_nodes()];
    for ((i, j), weight) in places().zip(kappa) {
        if h < 3 {
            weights[net.index(0, i, j)] += weight;
        } else {
            weights[net.index(0, i, j)] += 0.5 * weight;
            weights[net.index(1, j, i)] += 0.5 * weight;
        }
    }
    weights
}

/// The weights of all nodes in a rule.
fn weights(net: DNet, rules: &QasRules, number: usize) -> Vec<Real> {
    let mut weights = vec![Real::ZERO; net.num_nodes()];
    for (row, r) in rules.nodes[number].kappa.iter().zip(TURNS) {
        for (node, &weight) in row.iter().enumerate() {
            weights[net.index(r, node % 4, node / 4)] += weight;
        }
    }
    weights
}

/// The tolerances are those of the prototype, whose iteration ends when the cost changes by less
/// than 1e-10; see `data/golden/fair/README.md`. Measured: 1.7e-5, 1.2e-4, 5.1e-6.
#[test]
fn fair4_is_that_of_the_prototype() {
    for n in VALENCES {
        let (net, golden, rules) = (DNet { valence: n }, golden(n), fair(n, Spline::BiQuartic));
        for (number, (h, k)) in RULES.into_iter().enumerate() {
            let name = format!("{h}{k}");
            let kappa = golden_weights(net, (h, k), &numbers(&golden["kappa"][&name]));
            let error = deviation(&weights(net, &rules, number), &kappa);
            assert!(error < 2e-5, "kappa, n = {n}, rule {name}: off by {error:e}");
            let error = deviation(&rules.nodes[number].tau, &numbers(&golden["tau"][&name]));
            assert!(error < 2e-4, "tau, n = {n}, rule {name}: off by {error:e}");
        }
        for (rule, m) in rules.q.iter().zip([4, 5]) {
            let error = deviation(&rule.on_net, &numbers(&golden["qrule"][m - 2]));
            assert!(error < 1e-5, "q_{m}, n = {n}: off by {error:e}");
        }
    }
}

#[test]
fn fair4d_is_that_of_the_prototype() {
    for n in VALENCES {
        let golden = golden(n);
        for (rule, (h, k)) in fair_evolving(n).iter().zip(RULES) {
            let error = deviation(&rule.on_net, &numbers(&golden["lq_d"][format!("{h}{k}")]));
            assert!(error < 1e-11, "n = {n}, rule {h}{k}: off by {error:e}");
        }
    }
}

/// The first coordinates of the bi-4 characteristic net, sector by sector; zero at the centre.
fn characteristic_net(n: usize) -> Vec<Real> {
    let chi = characteristic_map(n);
    let two_c = Real::cos_of_turn(n) + Real::cos_of_turn(n);
    let at: Vec<(usize, usize)> = evenlight_guide::border::places().collect();
    let place = |i, j| at.iter().position(|&place| place == (i, j)).expect("a place");
    let own = |node: usize| {
        let (i, j) = (node % 4, node / 4);
        let second = if i == 3 { chi.net[place(j, 3)] } else { chi.net[place(j, i)] };
        (chi.net[place(i, j)], second)
    };
    let sectors = (0..n).flat_map(|s| (0..NODES_PER_SECTOR).map(move |node| (s, node)));
    let coordinate = |(sector, node)| {
        let start: (Real, Real) = own(node);
        (0..sector).fold(start, |(u, v), _| (-v, u + two_c * v)).0
    };
    sectors.map(coordinate).collect()
}

/// q_2..q_6 of sector 0 of the first coordinate u.
fn linear_quadratic() -> [Real; 5] {
    [1, 2, 0, 1, 0].map(|k| Real::ratio(k, 5))
}

fn on_net(rule: &[Real], net: &[Real]) -> Real {
    rule.iter().zip(net).map(|(&w, &x)| w * x).sum()
}

/// Rules take the characteristic net to lambda times itself: linear functions are kept, and the
/// characteristic map is that of Catmull-Clark subdivision.
#[test]
fn rules_reproduce_the_characteristic_net() {
    for n in ALL {
        let lambda = characteristic_map(n).lambda;
        let (net, chi) = (DNet { valence: n }, characteristic_net(n));
        let near = |new: Real, node: usize, what: &str| {
            let error = (new - lambda * chi[node]).abs().to_f64();
            assert!(error < 1e-24, "{what}, n = {n}, node {node}: {error:e}");
        };
        let rules = fair(n, Spline::BiQuartic);
        for (number, node) in INNER.into_iter().enumerate() {
            let [own, next] = rules.nodes[number].on_quadratics();
            // u of sector 0 is -v of sector 1.
            let [q2, q3, q4, q5, q6] = linear_quadratic();
            let two_c = Real::cos_of_turn(n) + Real::cos_of_turn(n);
            let turned = [q4, q6, two_c * q4 - q2, q5_of_next(q4, q2, two_c), two_c * q6 - q3];
            let by_q = on_net(&own, &[q2, q3, q4, q5, q6]) + on_net(&next, &turned);
            near(on_net(&weights(net, &rules, number), &chi) + by_q, node, "fair4");
        }
        for (rule, node) in fair_evolving(n).iter().zip(INNER) {
            near(on_net(&rule.on_net, &chi), node, "fair4d");
        }
        let q = linear_quadratic();
        for (rule, m) in rules.q.iter().zip([4, 5]) {
            let error = (on_net(&rule.on_net, &chi) - q[m - 2]).abs().to_f64();
            assert!(error < 1e-24, "q_{m}, n = {n}: {error:e}");
        }
    }
}

/// q_5 of the next sector of a linear function is q_2 + q_4 there.
fn q5_of_next(q4: Real, q2: Real, two_c: Real) -> Real {
    q4 + two_c * q4 - q2
}

/// The spectral radius of lambda^-2 (A + B K) over all blocks, by repeated squaring.
fn decay(regulators: &[Regulator], gains: &[Matrix]) -> f64 {
    let radius = |(regulator, gain): (&Regulator, &Matrix)| {
        let cost = regulator.cost(gain).expect("the gain is stable");
        let (mut power, mut logarithm, mut weight) = (cost.closed_loop, 0.0, 1.0);
        for _ in 0..20 {
            let size = size(&power);
            logarithm += weight * size.ln();
            power = power.scaled(Real::ONE / Real::from(size));
            power = &power * &power;
            weight *= 0.5;
        }
        logarithm.exp()
    };
    regulators.iter().zip(gains).map(radius).fold(0.0, f64::max)
}

fn optima(regulators: &[Regulator]) -> Vec<Matrix> {
    regulators.iter().map(|regulator| regulator.gain(&regulator.optimum())).collect()
}

#[test]
fn what_is_not_quadratic_dies_faster_than_lambda_squared() {
    for n in ALL {
        for spline in [Spline::BiQuartic, Spline::BiCubic] {
            let regulators = regulators(n, spline);
            let footprint = Footprint::of_l_nets();
            let weights = local_weights(&regulators, spline, &footprint);
            let local = decay(&regulators, &gains(&regulators, &footprint, &weights));
            let best = decay(&regulators, &optima(&regulators));
            println!("n = {n}, {spline:?}: local {local:.3}, best {best:.3}");
            let limit = if spline == Spline::BiQuartic { 0.80 } else { 0.83 };
            assert!(local <= limit && best < 0.82, "n = {n}, {spline:?}: {local} {best}");
        }
    }
}

/// P solves the Riccati equation: the cost of the optimal gain is P again, and no other gain that
/// is tried costs less.
#[test]
fn the_optimal_gain_costs_what_the_riccati_equation_says() {
    for n in [3, 6, 9] {
        for regulator in regulators(n, Spline::BiQuartic) {
            let optimum = regulator.optimum();
            let gain = regulator.gain(&optimum);
            let cost = regulator.cost(&gain).expect("the optimum is stable").to_go;
            assert!(size(&(&cost - &optimum)) < 1e-24 * size(&optimum), "n = {n}");
            for k in 0..12 {
                let mut other = gain.clone();
                other[(k % 6, k)] += Real::ratio(1, 100);
                let cost = regulator.cost(&other).expect("a small change").to_go;
                assert!((cost[(k, k)] - optimum[(k, k)]).to_f64() > 0.0, "n = {n}, weight {k}");
            }
        }
    }
}

/// Refinement multiplies the nets of the quadratics by lambda^2.
#[test]
fn nets_of_quadratics_are_eigenvectors() {
    for n in ALL {
        for spline in [Spline::BiQuartic, Spline::BiCubic] {
            for regulator in regulators(n, spline) {
                let refined = &regulator.refinement * &regulator.nets;
                for (column, monomial) in regulator.monomials.iter().enumerate() {
                    let factor = monomial.eigenvalue(regulator.lambda);
                    for node in (0..NODES_PER_SECTOR).filter(|node| !INNER.contains(node)) {
                        let error =
                            refined[(node, column)] - factor * regulator.nets[(node, column)];
                        assert!(error.abs().to_f64() < 1e-25, "n = {n}, {spline:?}, {monomial:?}");
                    }
                }
            }
        }
    }
}

/// A turn of the numbering changes nothing, and the mirrors change rules into one another, exactly.
#[test]
fn rules_are_symmetric_to_the_last_bit() {
    for n in [3, 8, 13] {
        let rules: [NetRule; 6] = fair_evolving(n);
        for (number, rule) in rules.iter().enumerate() {
            let (mirror, image) = evenlight_guide::rules::mirror_of(number);
            assert_eq!(rule.on_net, rules[image].mirrored(n, mirror).on_net);
        }
        for rule in fair(n, Spline::BiCubic).nodes {
            let (_, image) = evenlight_guide::rules::mirror_of(
                RULES.iter().position(|&r| r == rule.node).expect("a rule"),
            );
            let other = &fair(n, Spline::BiCubic).nodes[image];
            assert_eq!(rule.kappa, other.mirrored().kappa);
        }
    }
}
