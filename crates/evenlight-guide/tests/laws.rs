//! Laws of the derived rules that hold whatever the numbers are.

use evenlight_guide::border::{place_index, places};
use evenlight_guide::evolving_guide::{EG_ORDER, NetRule, evolving_guide, symmetrised};
use evenlight_guide::linear::Matrix;
use evenlight_guide::nets::{DNet, own_nodes};
use evenlight_guide::quadratic::{Q_POINTS, functional, turn};
use evenlight_guide::quadratic_attraction::{Q_RULES, QAS_ORDER, quadratic_attraction};
use evenlight_guide::real::Real;
use evenlight_guide::rules::{
    RULES, Step, StepRule, TURNS, mirror_of, step, symmetrised as symmetrised_step,
};
use evenlight_guide::spline::{refined, spline_to_bb};

/// A reproducible number in [-1, 1) for every index.
fn scattered(index: usize) -> Real {
    let mixed = (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    Real::from((mixed >> 33) as i32 as f64 / (1u64 << 30) as f64 - 1.0)
}

fn scattered_net(valence: usize) -> Vec<Real> {
    (0..DNet { valence }.num_nodes()).map(scattered).collect()
}

fn error(a: Real, b: Real) -> f64 {
    (a - b).abs().to_f64()
}

/// The new node by a rule on net and centre.
fn applied(rule: &NetRule, net: &[Real], centre: Real) -> Real {
    combined(&rule.on_net, net) + rule.on_centre * centre
}

/// The new node by a rule of the step, with q of sector 0: q_1..q_6.
fn stepped(step: &Step, rule: &StepRule, net: &[Real], q: &Matrix) -> Real {
    let next = &turn(step.net.valence) * q;
    let by_net: Real = TURNS
        .into_iter()
        .zip(&rule.kappa)
        .flat_map(|(r, row)| own_nodes().zip(row).map(move |(node, &weight)| (r, node, weight)))
        .map(|(r, (i, j), weight)| weight * net[step.net.index(r, i, j)])
        .sum();
    let [on_own, on_next] = rule.on_quadratics();
    let free = |q: &Matrix| -> Vec<Real> { (1..6).map(|m| q[(m, 0)]).collect() };
    by_net
        + combined(&on_own, &free(q))
        + combined(&on_next, &free(&next))
        + rule.on_centre * q[(0, 0)]
}

fn combined(weights: &[Real], values: &[Real]) -> Real {
    assert_eq!(weights.len(), values.len());
    weights.iter().zip(values).map(|(&weight, &value)| weight * value).sum()
}

fn column(values: &[Real]) -> Matrix {
    Matrix::from_fn(values.len(), 1, |row, _| values[row])
}

/// One coordinate, 0 for u and 1 for v in the frame of sector 0, of the degree-raised
/// characteristic net.
fn characteristic_net(step: &Step, coordinate: usize) -> Vec<Real> {
    let c = Real::cos_of_turn(step.net.valence);
    let sectors = (0..step.net.valence).flat_map(|s| own_nodes().map(move |(i, j)| (s, i, j)));
    sectors
        .map(|(s, i, j)| {
            let own = [step.chi.net[place_index(i, j)], step.chi.net[place_index(j, i)]];
            // u e_(s-1) + v e_s = -v e_(s-2) + (u + 2c v) e_(s-1)
            (0..s).fold(own, |[u, v], _| [-v, u + (c + c) * v])[coordinate]
        })
        .collect()
}

/// q_1..q_6 of the map u (0) or v (1): the points (a, b) of total degree 5 are a/5 and b/5.
fn quadratic_of_coordinate(coordinate: usize) -> Matrix {
    column(&Q_POINTS.map(|(a, b)| Real::ratio([a, b][coordinate] as i32, 5)))
}

#[test]
fn constants_are_reproduced() {
    for n in 3..=16 {
        for order in [EG_ORDER, QAS_ORDER] {
            let qas = quadratic_attraction(n, order);
            assert!(qas.nodes.iter().all(|rule| error(rule.sum(), Real::ONE) < 1e-28), "n = {n}");
            for rule in evolving_guide(n, order).iter().chain(&qas.q) {
                let ones = vec![Real::ONE; rule.on_net.len()];
                assert!(error(applied(rule, &ones, Real::ONE), Real::ONE) < 1e-28, "n = {n}");
            }
        }
    }
}

#[test]
fn the_characteristic_net_is_refined_to_lambda_times_itself() {
    for n in 3..=16 {
        let step = step(n);
        let eg = evolving_guide(n, EG_ORDER);
        for coordinate in [0, 1] {
            let net = characteristic_net(&step, coordinate);
            let q = quadratic_of_coordinate(coordinate);
            for (rule, (h, k)) in eg.iter().zip(RULES) {
                let place = [place_index(h, k), place_index(k, h)][coordinate];
                let expected = step.chi.lambda * step.chi.net[place];
                let by_eg = applied(rule, &net, Real::ZERO);
                assert!(error(by_eg, expected) < 1e-28, "EG, n = {n}, rule {h}{k}");
                let by_qas = stepped(&step, &step.rule(h, k), &net, &q);
                assert!(error(by_qas, expected) < 1e-28, "QAS, n = {n}, rule {h}{k}");
            }
        }
    }
}

#[test]
fn the_first_quadratic_of_the_characteristic_net_is_the_plane() {
    for n in 3..=16 {
        let step = step(n);
        for coordinate in [0, 1] {
            let net = characteristic_net(&step, coordinate);
            let q = quadratic_of_coordinate(coordinate);
            for ((m, _), rule) in Q_RULES.iter().zip(quadratic_attraction(n, QAS_ORDER).q) {
                let by_net = applied(&rule, &net, Real::ZERO);
                assert!(error(by_net, q[(m - 1, 0)]) < 1e-28, "q_{m}, n = {n}");
            }
        }
    }
}

#[test]
fn regular_nodes_of_the_characteristic_net_shrink_by_lambda_too() {
    for n in 3..=16 {
        let step = step(n);
        for (h, k) in own_nodes().filter(|&(h, k)| h == 0 || k == 0) {
            let (along_u, along_v) = (refined(3 - h as isize), refined(3 - k as isize));
            let products = along_u.iter().flat_map(|&(a, wa)| {
                let places = along_v
                    .iter()
                    .map(move |&(b, wb)| ((3 - a) as usize, (3 - b) as usize, wa * wb));
                places.map(|(i, j, weight)| weight * step.chi.net[place_index(i, j)])
            });
            let old = step.chi.net[place_index(h, k)];
            assert!(error(products.sum(), step.chi.lambda * old) < 1e-28, "n = {n}, node {h}{k}");
        }
    }
}

#[test]
fn the_rules_have_all_mirror_symmetries() {
    for n in 3..=16 {
        let rules = evolving_guide(n, EG_ORDER);
        let exact = symmetrised(n, &rules);
        for number in 0..RULES.len() {
            let (mirror, image) = mirror_of(number);
            let mirrored = rules[image].mirrored(n, mirror);
            for (&own, &image) in rules[number].on_net.iter().zip(&mirrored.on_net) {
                assert!(error(own, image) < 1e-28, "n = {n}, rule {number}");
            }
            assert_eq!(exact[number], exact[image].mirrored(n, mirror));
        }
    }
}

#[test]
fn the_rules_of_the_step_have_all_mirror_symmetries() {
    for n in 3..=16 {
        let step = step(n);
        let rules = RULES.map(|(h, k)| step.rule(h, k));
        let exact = symmetrised_step(&rules);
        for number in 0..RULES.len() {
            let image = &rules[mirror_of(number).1].mirrored();
            let weights = |rule: &StepRule| -> Vec<Real> {
                rule.kappa.iter().flatten().chain(&rule.tau).copied().collect()
            };
            for (own, image) in weights(&rules[number]).into_iter().zip(weights(image)) {
                assert!(error(own, image) < 1e-28, "n = {n}, rule {number}");
            }
            assert_eq!(exact[number], exact[mirror_of(number).1].mirrored());
        }
    }
}

#[test]
fn the_first_quadratic_has_the_symmetries_of_the_net() {
    for n in 3..=16 {
        let q = step(n).quadratic(QAS_ORDER);
        for ((m, mirror), exact) in Q_RULES.into_iter().zip(quadratic_attraction(n, QAS_ORDER).q) {
            assert_eq!(exact.mirrored(n, mirror), exact, "q_{m}, n = {n}");
            let derived = &q.row(m - 1)[..12 * n];
            for (&derived, &exact) in derived.iter().zip(&exact.on_net) {
                assert!(error(derived, exact) < 1e-28, "q_{m}, n = {n}");
            }
        }
    }
}

/// The extraordinary point of the scattered nets.
fn centre() -> Real {
    Real::ratio(3, 4)
}

/// q of a net around [`centre`].
fn best_quadratic(step: &Step, net: &[Real], order: usize) -> Matrix {
    let given = [net, &[centre()]].concat();
    &step.quadratic(order) * &column(&given)
}

#[test]
fn evolving_guide_is_the_step_with_the_best_quadratic() {
    for n in [3, 5, 6, 9, 16] {
        let (step, net) = (step(n), scattered_net(n));
        for order in [EG_ORDER, QAS_ORDER] {
            let q = best_quadratic(&step, &net, order);
            for (rule, (h, k)) in evolving_guide(n, order).iter().zip(RULES) {
                let by_step = stepped(&step, &step.rule(h, k), &net, &q);
                let by_rule = applied(rule, &net, centre());
                assert!(error(by_rule, by_step) < 1e-27, "F_{order}, n = {n}, rule {h}{k}");
            }
        }
    }
}

#[test]
fn the_best_quadratic_makes_the_functional_stationary_and_keeps_p() {
    for n in [3, 5, 8] {
        let (step, net) = (step(n), scattered_net(n));
        for order in [EG_ORDER, QAS_ORDER] {
            let q = best_quadratic(&step, &net, order);
            assert_eq!(q[(0, 0)], centre());
            for m in 1..6 {
                let moved = |by: i32| {
                    let step_to = |row| if row == m { Real::from(by) } else { Real::ZERO };
                    let there = Matrix::from_fn(6, 1, |row, _| q[(row, 0)] + step_to(row));
                    energy(&step, &net, &there, order)
                };
                let (back, here, forth) = (moved(-1), moved(0), moved(1));
                assert!(back > here && error(back, forth) < 1e-24 * here.to_f64(), "n = {n}");
            }
        }
    }
}

/// The sum of F_`order` over the sectors of the guide.
fn energy(step: &Step, net: &[Real], q: &Matrix, order: usize) -> Real {
    let functional = functional(order);
    let mut turned = q.clone();
    let mut sum = Real::ZERO;
    for sector in 0..step.net.valence {
        let nodes: Vec<Real> =
            places().map(|(i, j)| net[step.net.index(sector as isize, i, j)]).collect();
        let g = &(&step.guide.on_net * &column(&nodes)) + &(&step.guide.on_q * &turned);
        sum += (&g.transposed() * &(&functional * &g))[(0, 0)];
        turned = &turn(step.net.valence) * &turned;
    }
    sum
}

#[test]
fn the_rules_of_q4_and_q5_give_all_of_the_best_quadratic() {
    for n in [3, 5, 6, 7, 16] {
        let (step, net) = (step(n), scattered_net(n));
        let expected = best_quadratic(&step, &net, QAS_ORDER);
        let [q4, q5] = quadratic_attraction(n, QAS_ORDER).q.map(|rule| -> Vec<Real> {
            (0..n).map(|s| applied(&rule, &net_from_sector(&net, s), centre())).collect()
        });
        let c = Real::cos_of_turn(n);
        let q6 = |s: usize| {
            let sides = q5[s] + q5[(s + 1) % n];
            (sides - Real::from(2) * (Real::ONE - c) * q4[s]) / (c + c)
        };
        let last = n - 1;
        let all = [centre(), q4[last], q6(last), q4[0], q5[0], q6(0)];
        for (m, value) in all.into_iter().enumerate() {
            assert!(error(value, expected[(m, 0)]) < 1e-27, "q_{}, n = {n}", m + 1);
        }
    }
}

/// The net with sector s named 0.
fn net_from_sector(net: &[Real], s: usize) -> Vec<Real> {
    [&net[12 * s..], &net[..12 * s]].concat()
}

/// A bi-4 C2 spline on the plane: its nodes at the positions -3..=3 in both directions. Around the
/// centre it is a d-net of valence 4; line 0 points along x, line 1 along y.
struct RegularSpline;

impl RegularSpline {
    fn at(x: isize, y: isize) -> Real {
        scattered((x + 3 + 7 * (y + 3)) as usize)
    }

    /// The node a half steps along line s-1 and b along line s.
    fn in_sector(s: usize, a: isize, b: isize) -> Real {
        let (x, y) = (0..s).fold((b, -a), |(x, y), _| (-y, x));
        Self::at(x, y)
    }

    /// q_1..q_6 of sector 0, from the Taylor coefficients of its patch at the centre.
    fn quadratic() -> Vec<Real> {
        let one = spline_to_bb();
        let nodes =
            Matrix::from_fn(5, 5, |i, j| Self::in_sector(0, 3 - i as isize, 3 - j as isize));
        let bb = &(&one * &nodes) * &one.transposed();
        let g = |a: usize, b: usize| bb[(4 - a, 4 - b)];
        let four = Real::from(4);
        let twelve = Real::from(12);
        let [fu, fv] = [four * (g(1, 0) - g(0, 0)), four * (g(0, 1) - g(0, 0))];
        let fuu = twelve * (g(2, 0) - g(1, 0) - g(1, 0) + g(0, 0));
        let fvv = twelve * (g(0, 2) - g(0, 1) - g(0, 1) + g(0, 0));
        let fuv = four * four * (g(1, 1) - g(1, 0) - g(0, 1) + g(0, 0));
        let point = |(a, b): (usize, usize)| {
            let (x, y) = (Real::ratio(a as i32, 5), Real::ratio(b as i32, 5));
            let square = |m: usize| Real::ratio((m * m) as i32 - m as i32, 40);
            let mixed = Real::ratio((a * b) as i32, 20);
            g(0, 0) + fu * x + fv * y + fuu * square(a) + fuv * mixed + fvv * square(b)
        };
        Q_POINTS.map(point).to_vec()
    }

    /// The new node at the positions (a, b) of sector 0.
    fn refined(a: isize, b: isize) -> Real {
        let (along_u, along_v) = (refined(a), refined(b));
        let products = along_u.iter().flat_map(|&(a, wa)| {
            along_v.iter().map(move |&(b, wb)| wa * wb * Self::in_sector(0, a, b))
        });
        products.sum()
    }
}

#[test]
fn at_valence_4_the_step_with_the_splines_own_quadratic_is_regular_refinement() {
    let step = step(4);
    let net: Vec<Real> = (0..4)
        .flat_map(|s| own_nodes().map(move |(i, j)| (s, 3 - i as isize, 3 - j as isize)))
        .map(|(s, a, b)| RegularSpline::in_sector(s, a, b))
        .collect();
    let q = column(&RegularSpline::quadratic());
    for rule in quadratic_attraction(4, QAS_ORDER).nodes {
        let (h, k) = rule.node;
        let regular = RegularSpline::refined(3 - h as isize, 3 - k as isize);
        assert!(error(stepped(&step, &rule, &net, &q), regular) < 1e-29, "node {h}{k}");
    }
}

/// The 36 BB coefficients of the guide in `sector` for scattered nodes and a scattered quadratic.
fn scattered_guide(step: &Step, valence: usize, sector: usize) -> Matrix {
    let net = DNet { valence };
    let nodes: Vec<Real> =
        places().map(|(i, j)| scattered(net.index(sector as isize, i, j))).collect();
    let nodes = Matrix::from_fn(nodes.len(), 1, |row, _| nodes[row]);
    let own = Matrix::from_fn(6, 1, |row, _| scattered(1000 + row));
    let q = (0..sector).fold(own, |q, _| &turn(valence) * &q);
    &(&step.guide.on_net * &nodes) + &(&step.guide.on_q * &q)
}

#[test]
fn sectors_of_the_guide_join_with_one_tangent_plane_along_the_lines() {
    for n in [3, 5, 6, 9] {
        let step = step(n);
        let two_c = Real::cos_of_turn(n) + Real::cos_of_turn(n);
        let (own, next) = (scattered_guide(&step, n, 0), scattered_guide(&step, n, 1));
        let edge = |a: usize| own[(6 * a, 0)];
        for a in 0..6 {
            assert!(error(edge(a), next[(a, 0)]) < 1e-27, "edge, n = {n}");
            // e_(s+1) = 2c e_s - e_(s-1): the derivatives along the three, in degree 5.
            let share = Real::ratio(a as i32, 5);
            let back = if a > 0 { edge(a) - edge(a - 1) } else { Real::ZERO };
            let forth = if a < 5 { edge(a + 1) - edge(a) } else { Real::ZERO };
            let along = share * back + (Real::ONE - share) * forth;
            let before = own[(6 * a + 1, 0)] - edge(a);
            let after = next[(a + 6, 0)] - edge(a);
            assert!(error(after, two_c * along - before) < 1e-27, "tangents, n = {n}");
        }
    }
}
