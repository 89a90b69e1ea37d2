//! Laws of the derived rules that hold whatever the numbers are.

use evenlight_guide::border::{place_index, places};
use evenlight_guide::linear::Matrix;
use evenlight_guide::nets::{DNet, own_nodes};
use evenlight_guide::quadratic::{Q_POINTS, turn};
use evenlight_guide::real::Real;
use evenlight_guide::rules::{
    EG_ORDER, EgRule, QAS_ORDER, RULES, Step, evolving_guide, mirrored, step, symmetrised,
};
use evenlight_guide::spline::{refined, spline_to_bb};

/// A reproducible number in [-1, 1) for every index.
fn scattered(index: usize) -> Real {
    let mixed = (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    Real::from((mixed >> 33) as i32 as f64 / (1u64 << 30) as f64 - 1.0)
}

fn error(a: Real, b: Real) -> f64 {
    (a - b).abs().to_f64()
}

/// The coordinates, in the frame of sector 0, of the degree-raised characteristic net.
fn characteristic_net(step: &Step, valence: usize) -> Vec<[Real; 2]> {
    let two_c = Real::cos_of_turn(valence) + Real::cos_of_turn(valence);
    let sectors = (0..valence).flat_map(|s| own_nodes().map(move |(i, j)| (s, i, j)));
    sectors
        .map(|(s, i, j)| {
            let own = [step.chi.net[place_index(i, j)], step.chi.net[place_index(j, i)]];
            // u e_(s-1) + v e_s = -v e_(s-2) + (u + 2c v) e_(s-1)
            (0..s).fold(own, |[u, v], _| [-v, u + two_c * v])
        })
        .collect()
}

fn applied(rule: &EgRule, values: impl Iterator<Item = Real>, centre: Real) -> Real {
    let terms = rule.on_net.iter().zip(values).map(|(&weight, value)| weight * value);
    terms.sum::<Real>() + rule.on_centre * centre
}

#[test]
fn constants_are_reproduced() {
    for n in 3..=16 {
        for order in [EG_ORDER, QAS_ORDER] {
            for rule in evolving_guide(n, order) {
                let ones = rule.on_net.iter().map(|_| Real::ONE);
                assert!(error(applied(&rule, ones, Real::ONE), Real::ONE) < 1e-28, "n = {n}");
            }
        }
    }
}

#[test]
fn the_characteristic_net_is_refined_to_lambda_times_itself() {
    for n in 3..=16 {
        let step = step(n);
        let net = characteristic_net(&step, n);
        for (rule, (h, k)) in evolving_guide(n, EG_ORDER).iter().zip(RULES) {
            for (coordinate, place) in [(0, (h, k)), (1, (k, h))] {
                let values = net.iter().map(|node| node[coordinate]);
                let new = applied(rule, values, Real::ZERO);
                let old = step.chi.net[place_index(place.0, place.1)];
                assert!(error(new, step.chi.lambda * old) < 1e-28, "n = {n}, rule {h}{k}");
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
        let net = DNet { valence: n };
        let rules = evolving_guide(n, EG_ORDER);
        let symmetric = symmetrised(n, &rules);
        for number in 0..RULES.len() {
            for (r, (i, j)) in (0..n).flat_map(|r| own_nodes().map(move |node| (r, node))) {
                let (mirror, r2, i2, j2) = mirrored(n, number, (r, i, j));
                assert_eq!(mirrored(n, mirror, (r2, i2, j2)), (number, r, i, j));
                let weight = |rules: &[EgRule; 6], number: usize, r: usize, i, j| {
                    rules[number].on_net[net.index(r as isize, i, j)]
                };
                let own = weight(&rules, number, r, i, j);
                let image = weight(&rules, mirror, r2, i2, j2);
                assert!(error(own, image) < 1e-28, "n = {n}, rule {number}, {r} {i}{j}");
                let own = weight(&symmetric, number, r, i, j);
                assert_eq!(own, weight(&symmetric, mirror, r2, i2, j2));
            }
        }
    }
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
    let q = RegularSpline::quadratic();
    for (h, k) in RULES {
        let rule = step.rule(h, k);
        let by_net: Real = rule.on_net.iter().zip(&net).map(|(&w, &d)| w * d).sum();
        let by_q: Real = rule.on_q.iter().zip(&q).map(|(&w, &q)| w * q).sum();
        let regular = RegularSpline::refined(3 - h as isize, 3 - k as isize);
        assert!(error(by_net + by_q, regular) < 1e-29, "node {h}{k}");
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
