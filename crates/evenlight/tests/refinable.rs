//! Refinable functions on guided surfaces [KP18-Guided, Section 6.4]: dimensions, smoothness,
//! nestedness, supports, Bezier extraction.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod golden;

use evenlight::basis::{FunctionKind, RefinableSpace};
use evenlight::patch::{Jet, Patch};
use evenlight::rings::Rings;
use evenlight::{Contraction, RuleSet, SchemeKind};

const SCHEMES: [SchemeKind; 2] = [SchemeKind::Guided5, SchemeKind::Guided6];

/// The spaces of both degrees and, where rules can be derived, both contractions.
fn spaces(valences: &[usize], rings: usize) -> Vec<RefinableSpace> {
    let contractions = [Contraction::CatmullClark, Contraction::Half];
    let can_derive = SCHEMES[0].check_contraction(Contraction::Half).is_ok();
    let known = &contractions[..if can_derive { 2 } else { 1 }];
    let mut spaces = Vec::new();
    for (&n, &contraction) in valences.iter().flat_map(|n| known.iter().map(move |c| (n, c))) {
        let of_kind = |kind| RefinableSpace::with_contraction(kind, contraction, n, rings).unwrap();
        spaces.extend(SCHEMES.map(of_kind));
    }
    spaces
}

fn name(space: &RefinableSpace) -> String {
    let [sigma, m] = [space.eigenfunctions().sigma(), space.num_rings() as f64];
    format!("bi-{} n = {} sigma = {sigma} m = {m}", space.degree(), space.valence())
}

/// Numbers without a pattern, from -1 to 1.
fn scattered(count: usize) -> Vec<f64> {
    let mut state = 1_u64;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| next()).collect()
}

/// A sum's jet by (a,b), from a given patch, at (a,b) in units of its ring.
fn jet_on(space: &RefinableSpace, coefs: &[f64], which: usize, [a, b]: [f64; 2]) -> Jet<1> {
    let [[a0, a1], [b0, b1]] = space.eigenfunctions().patch_domain(which).unwrap();
    let (u, v) = ((a - a0) / (a1 - a0), (b - b0) / (b1 - b0));
    let coefs = coefs.iter().map(|&c| [c]).collect();
    let jet = Patch::new([space.degree(); 2], coefs).unwrap().jet(u, v);
    jet.scaled(1.0, [1.0 / (a1 - a0), 1.0 / (b1 - b0)])
}

fn largest_difference(a: Jet<1>, b: Jet<1>) -> f64 {
    a.rows().iter().zip(b.rows()).fold(0.0, |m: f64, ([x], [y])| m.max((x - y).abs()))
}

/// The jet of a sector at a line, in the parameters of the next sector: a = -b', b = a'.
fn beyond_line(jet: Jet<1>) -> Jet<1> {
    let minus = |[x]: [f64; 1]| [-x];
    Jet { du: jet.dv, dv: minus(jet.du), duu: jet.dvv, duv: minus(jet.duv), dvv: jet.duu, ..jet }
}

/// The rank of rows of numbers, by elimination with the largest pivots.
fn rank(mut rows: Vec<Vec<f64>>) -> usize {
    let mut rank = 0;
    while rank < rows.len() {
        let largest = |row: &Vec<f64>| row.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let best =
            (rank..rows.len()).max_by(|&i, &j| largest(&rows[i]).total_cmp(&largest(&rows[j])));
        rows.swap(rank, best.unwrap());
        let size = largest(&rows[rank]);
        if size < 1e-9 {
            break;
        }
        let pivot = rows[rank].clone();
        let column = pivot.iter().position(|x| x.abs() == size).unwrap();
        for row in &mut rows[rank + 1..] {
            let factor = row[column] / pivot[column];
            if factor != 0.0 {
                row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= factor * p);
            }
        }
        rank += 1;
    }
    rank
}

#[test]
fn dimensions_are_those_of_the_paper() {
    for n in [3, 5, 6, 7, 8, 9, 10, 16] {
        let star = if n == 3 || n == 6 { n + 1 } else { n };
        for (kind, [border, ring]) in SCHEMES.into_iter().zip([[18 * n, 18 * n], [24 * n, 36 * n]])
        {
            for m in 0..4 {
                let space = RefinableSpace::new(kind, n, m).unwrap();
                assert_eq!(
                    [space.num_border_functions(), space.num_ring_functions()],
                    [border, ring]
                );
                assert_eq!(space.dim(), border + m * ring + 17 * n + star + 6);
                let refinement = space.refinement();
                assert_eq!(refinement.num_columns(), space.dim());
                assert_eq!(refinement.num_rows(), space.refined().unwrap().dim());
            }
        }
    }
    assert!(RefinableSpace::new(SchemeKind::Guided4, 5, 1).is_none());
    assert!(RefinableSpace::new(SchemeKind::Qas4, 5, 1).is_none());
    assert!(RefinableSpace::new(SchemeKind::Guided5, 4, 1).is_none());
}

/// The rows of value, first and second derivative at an end of a polynomial in BB form, without
/// common factors: differences at a distance h.
fn end_rows(degree: usize, at_end: bool) -> Vec<Vec<f64>> {
    let d = degree as f64;
    let differences =
        [vec![1.0], vec![-d, d], vec![d * (d - 1.0), -2.0 * d * (d - 1.0), d * (d - 1.0)]];
    let row = |(order, row): (usize, &Vec<f64>)| {
        let mut all = vec![0.0; degree + 1];
        for (k, &w) in row.iter().enumerate() {
            let sign = if at_end && order == 1 { -1.0 } else { 1.0 };
            all[if at_end { degree - k } else { k }] = sign * w;
        }
        all
    };
    differences.iter().enumerate().map(row).collect()
}

/// Coefficients by their index along a side, weights of them, and a sign.
type Term<'a> = (&'a dyn Fn(usize) -> usize, &'a Vec<f64>, f64);

/// The splines on a ring that join C2 and vanish to the second order at the outer border, counted
/// from the conditions alone, are as many as the functions of a ring.
#[test]
fn a_ring_has_no_other_splines() {
    for space in spaces(&[3, 5], 1) {
        let (n, d, sigma) = (space.valence(), space.degree(), space.eigenfunctions().sigma());
        let order = d + 1;
        let number = |sector: usize, square: usize, i: usize, j: usize| {
            ((sector * 3 + square) * order + i) * order + j
        };
        let (start, end) = (end_rows(d, false), end_rows(d, true));
        let mut rows = Vec::new();
        let mut condition = |terms: &[Term]| {
            let mut row = vec![0.0; n * 3 * order * order];
            for (at, weights, sign) in terms {
                weights.iter().enumerate().for_each(|(k, w)| row[at(k)] += sign * w);
            }
            rows.push(row);
        };
        for (s, k) in (0..n).flat_map(|s| (0..order).map(move |k| (s, k))) {
            for o in 0..3 {
                let next = (s + 1) % n;
                let sign = if o == 1 { -1.0 } else { 1.0 };
                let (one, two) = (&end[o], &start[o]);
                // Patches are sigma and 1 - sigma wide.
                let [low, high] = [sigma, 1.0 - sigma].map(|width| width.powi(-(o as i32)));
                // Square 1 below 0, square 2 left of 0, square 2 before square 1 of the next
                // sector.
                condition(&[
                    (&|j| number(s, 1, k, j), one, low),
                    (&|j| number(s, 0, k, j), two, -high),
                ]);
                condition(&[
                    (&|i| number(s, 2, i, k), one, low),
                    (&|i| number(s, 0, i, k), two, -high),
                ]);
                condition(&[
                    (&|i| number(s, 2, i, k), two, 1.0),
                    (&|j| number(next, 1, k, j), two, -sign),
                ]);
                // The outer border.
                for square in [0, 1] {
                    condition(&[(&|i| number(s, square, i, k), one, 1.0)]);
                }
                for square in [0, 2] {
                    condition(&[(&|j| number(s, square, k, j), one, 1.0)]);
                }
            }
        }
        let unknowns = n * 3 * order * order;
        assert_eq!(unknowns - rank(rows), space.num_ring_functions(), "{}", name(&space));
    }
}

#[test]
fn functions_are_independent() {
    for space in spaces(&[3, 5], 1) {
        let mut rows = vec![Vec::new(); space.dim()];
        for (ring, s, which) in (0..4)
            .flat_map(|l| (0..space.valence()).flat_map(move |s| [0, 1, 2].map(|w| (l, s, w))))
        {
            let element = space.element(ring, s, which).unwrap();
            let size = element.coefs[0].len();
            let mut functions = element.functions.iter().zip(&element.coefs).peekable();
            for (k, row) in rows.iter_mut().enumerate() {
                match functions.next_if(|(function, _)| **function == k) {
                    Some((_, coefs)) => row.extend(coefs),
                    None => row.extend(std::iter::repeat_n(0.0, size)),
                }
            }
        }
        assert_eq!(rank(rows), space.dim(), "{}", name(&space));
    }
}

#[test]
fn every_function_of_a_space_is_in_the_next() {
    for space in spaces(&[3, 5, 6, 8], 0) {
        let mut space = space;
        let mut values = scattered(space.dim());
        for _ in 0..3 {
            let (next, refined) =
                (space.refined().unwrap(), space.refinement().apply_to_numbers(&values).unwrap());
            for (ring, s, which) in (0..5).flat_map(|l| [0, 1, 2].map(|w| (l, w % 3, w))) {
                let coarse = space.coefs_of_sum(&values, ring, s, which).unwrap();
                let fine = next.coefs_of_sum(&refined, ring, s, which).unwrap();
                let size = coarse.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
                let worst =
                    coarse.iter().zip(&fine).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
                assert!(worst < 1e-12 * size, "{} ring {ring}: {worst:e}", name(&space));
            }
            for (s, a, b) in [(0, 0.9, 0.3), (1, 0.26, 0.4), (2, 0.01, 0.07), (0, 0.5, 0.5)] {
                let [coarse, fine] = [
                    space.eval_sum(&values, s, a, b).unwrap(),
                    next.eval_sum(&refined, s, a, b).unwrap(),
                ];
                assert!((coarse.p[0] - fine.p[0]).abs() < 1e-12 * (1.0 + coarse.p[0].abs()));
            }
            (space, values) = (next, refined);
        }
    }
}

/// A sum of all functions with scattered values joins C2 across every border but the outer one,
/// on rings with functions of their own, on those of the guide, and between.
#[test]
fn functions_are_c2() {
    for space in spaces(&[3, 5, 6, 8], 2) {
        let (n, sigma) = (space.valence(), space.eigenfunctions().sigma());
        let values = scattered(space.dim());
        for ring in 0..5 {
            let patch =
                |s: usize, which: usize| space.coefs_of_sum(&values, ring, s % n, which).unwrap();
            for s in 0..n {
                let squares = [0, 1, 2].map(|which| patch(s, which));
                let next = patch(s + 1, 1);
                let inside =
                    [0, 1, 2].map(|which| space.coefs_of_sum(&values, ring + 1, s, which).unwrap());
                let size = squares.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
                for t in [0.0, 0.21, 0.5, 0.83, 1.0] {
                    let (h, a) = (sigma * t, sigma + (1.0 - sigma) * t);
                    let on = |which: usize, place: [f64; 2]| {
                        jet_on(&space, &squares[which], which, place)
                    };
                    // Ring l+1 in its own units.
                    let in_hole = |which: usize, [a, b]: [f64; 2]| {
                        jet_on(&space, &inside[which], which, [a / sigma, b / sigma])
                            .scaled(1.0, [1.0 / sigma; 2])
                    };
                    let part = |x: f64, low: usize| if x < sigma * sigma { low } else { 0 };
                    let jumps = [
                        largest_difference(on(1, [a, sigma]), on(0, [a, sigma])),
                        largest_difference(on(2, [sigma, a]), on(0, [sigma, a])),
                        largest_difference(
                            beyond_line(on(2, [0.0, a])),
                            jet_on(&space, &next, 1, [a, 0.0]),
                        ),
                        largest_difference(on(1, [sigma, h]), in_hole(part(h, 1), [sigma, h])),
                        largest_difference(on(2, [h, sigma]), in_hole(part(h, 2), [h, sigma])),
                    ];
                    let worst = jumps.iter().fold(0.0, |m: f64, x| m.max(*x));
                    // Second derivatives are some hundred times as large as the coefficients.
                    assert!(worst < 1e-10 * size, "{} ring {ring}: {jumps:?}", name(&space));
                }
            }
        }
    }
}

#[test]
fn the_functions_of_rings_are_a_partition_of_unity_beside_the_guide() {
    for space in spaces(&[3, 5, 6, 8], 2) {
        let constant = space.constant();
        for (ring, s, which) in (0..5).flat_map(|l| [0, 1, 2].map(|w| (l, w, w))) {
            for b in space.coefs_of_sum(&constant, ring, s, which).unwrap() {
                assert!((b - 1.0).abs() < 1e-13, "{} ring {ring}: {b}", name(&space));
            }
            let element = space.element(ring, s, which).unwrap();
            for (&k, coefs) in element.functions.iter().zip(&element.coefs) {
                if k < space.first_guide() {
                    assert!(coefs.iter().all(|&b| b >= 0.0), "{} function {k}", name(&space));
                    assert!(coefs.iter().all(|&b| b <= 1.0), "{} function {k}", name(&space));
                }
            }
        }
        let fine = space.refinement().apply_to_numbers(&constant).unwrap();
        let exact = space.refined().unwrap().constant();
        assert!(fine.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-12), "{}", name(&space));
    }
}

/// The constant, the characteristic map and all other eigenfunctions are in every space; the
/// quadratics of the map are with bi-6 rings.
#[test]
fn eigenfunctions_are_in_every_space() {
    for space in spaces(&[3, 5, 6, 8], 2) {
        let functions = space.eigenfunctions();
        let (refinement, next) = (space.refinement(), space.refined().unwrap());
        for k in 0..functions.len() {
            let values = space.eigenfunction(k).unwrap();
            let refined = refinement.apply_to_numbers(&values).unwrap();
            for (a, b) in refined.iter().zip(next.eigenfunction(k).unwrap()) {
                assert!((a - b).abs() < 1e-12, "{} eigenfunction {k}: {a} {b}", name(&space));
            }
            for (ring, s, which) in (0..4).flat_map(|l| [0, 1, 2].map(|w| (l, w, w))) {
                let (found, exact) = (
                    space.coefs_of_sum(&values, ring, s, which).unwrap(),
                    functions.coefs(k, ring, s, which).unwrap(),
                );
                let size = exact.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
                let worst =
                    found.iter().zip(&exact).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
                assert!(worst < 1e-12 * size, "{} eigenfunction {k}: {worst:e}", name(&space));
            }
        }
        let [x, y] = [1, 2].map(|k| space.eigenfunction(k).unwrap());
        let quadratic = |p: f64, q: f64| p * p - 0.3 * p * q + 0.7 * q * q;
        // x^2, xy and y^2 are sums of functions 3, 4, 5: found from three values on ring 3.
        if space.degree() == 6 {
            let parts = [3, 4, 5].map(|k| space.eigenfunction(k).unwrap());
            let points = [(0, 1.0, 0.2), (1, 0.7, 0.9), (2, 0.3, 0.8)]
                .map(|(s, a, b)| (s, a / 8.0, b / 8.0));
            let value =
                |f: &[f64], (s, a, b): (usize, f64, f64)| space.eval_sum(f, s, a, b).unwrap().p[0];
            let rows = points.map(|p| parts.each_ref().map(|f| value(f, p)));
            let right = points.map(|p| quadratic(value(&x, p), value(&y, p)));
            let weights = solved(rows, right);
            let sum: Vec<f64> = (0..space.dim())
                .map(|k| (0..3).map(|part| weights[part] * parts[part][k]).sum())
                .collect();
            for (s, a, b) in [(0, 0.9, 0.1), (1, 0.6, 0.6), (2, 0.2, 0.4), (0, 0.05, 0.02)] {
                let exact = quadratic(value(&x, (s, a, b)), value(&y, (s, a, b)));
                let error = (value(&sum, (s, a, b)) - exact).abs();
                assert!(error < 1e-12 * (1.0 + exact), "{}: {error:e}", name(&space));
            }
        }
    }
}

/// The solution of three equations, by Cramer's rule.
fn solved(rows: [[f64; 3]; 3], right: [f64; 3]) -> [f64; 3] {
    let det = |m: [[f64; 3]; 3]| -> f64 {
        (0..3)
            .map(|k| {
                let [a, b] = [(k + 1) % 3, (k + 2) % 3];
                m[0][k] * (m[1][a] * m[2][b] - m[1][b] * m[2][a])
            })
            .sum()
    };
    [0, 1, 2].map(|k| {
        let mut replaced = rows;
        replaced.iter_mut().zip(right).for_each(|(row, x)| row[k] = x);
        det(replaced) / det(rows)
    })
}

#[test]
fn functions_live_where_their_support_says() {
    for space in spaces(&[3, 5], 2) {
        let n = space.valence();
        let mut seen = vec![Vec::new(); space.dim()];
        for (ring, s, which) in
            (0..5).flat_map(|l| (0..n).flat_map(move |s| [0, 1, 2].map(|w| (l, s, w))))
        {
            let element = space.element(ring, s, which).unwrap();
            assert!(element.functions.windows(2).all(|pair| pair[0] < pair[1]));
            let values = element.eval(0.3, 0.6);
            assert_eq!(values.len(), element.functions.len());
            for (&k, coefs) in element.functions.iter().zip(&element.coefs) {
                assert!(k >= space.first_guide() || coefs.iter().any(|&b| b != 0.0));
                seen[k].push((ring, s));
            }
        }
        for (k, seen) in seen.iter().enumerate() {
            let support = space.support(k).unwrap();
            let rings = support.first_ring..=support.last_ring.unwrap_or(4);
            assert!(seen.iter().all(|(l, s)| rings.contains(l) && support.sectors.contains(s)));
            for l in rings {
                for &s in &support.sectors {
                    assert!(seen.contains(&(l, s)), "{} function {k}: ring {l}, {s}", name(&space));
                }
            }
            match space.kind(k).unwrap() {
                FunctionKind::Level { level, sector } => {
                    assert_eq!(
                        (support.first_ring, support.last_ring),
                        (level.saturating_sub(1), Some(level))
                    );
                    assert!(support.sectors.contains(&sector));
                }
                FunctionKind::Ring { ring, sector } => {
                    assert_eq!((support.first_ring, support.last_ring), (ring, Some(ring)));
                    assert!(space.degree() == 6 && support.sectors.contains(&sector));
                }
                FunctionKind::Guide { eigenfunction } => {
                    assert_eq!((support.first_ring, support.last_ring), (2, None));
                    assert_eq!(eigenfunction, k - space.first_guide());
                }
            }
        }
    }
}

#[test]
fn elements_and_evaluators_agree() {
    for space in spaces(&[5], 1) {
        let sigma = space.eigenfunctions().sigma();
        for (s, a, b) in [(0, 0.7, 0.9), (1, 0.9, 0.2), (4, 0.1, 0.26), (2, 0.1, 0.02)] {
            let (mut ring, mut place): (usize, [f64; 2]) = (0, [a, b]);
            while place[0].max(place[1]) <= sigma {
                (ring, place) = (ring + 1, place.map(|x| x / sigma));
            }
            let which = match place.map(|x| x > sigma) {
                [true, true] => 0,
                [true, false] => 1,
                _ => 2,
            };
            let element = space.element(ring, s, which).unwrap();
            let [[a0, a1], [b0, b1]] = element.domain;
            assert!((a0..=a1).contains(&a) && (b0..=b1).contains(&b));
            let jets = element.eval((a - a0) / (a1 - a0), (b - b0) / (b1 - b0));
            let mut sum = Jet::<1>::default();
            let values = scattered(space.dim());
            let mut expected = element.functions.iter().zip(jets).peekable();
            for (k, &value) in values.iter().enumerate() {
                let found = space.eval(k, s, a, b).unwrap();
                let jet = expected
                    .next_if(|(f, _)| **f == k)
                    .map_or_else(Jet::<1>::default, |(_, jet)| jet);
                let jet = jet.scaled(1.0, [1.0 / (a1 - a0), 1.0 / (b1 - b0)]);
                assert!(largest_difference(found, jet) < 1e-12 * (1.0 + jet.duu[0].abs()), "{k}");
                sum.p[0] += value * found.p[0];
                sum.duv[0] += value * found.duv[0];
            }
            let whole = space.eval_sum(&values, s, a, b).unwrap();
            assert!(
                (whole.p[0] - sum.p[0]).abs() < 1e-11 && (whole.duv[0] - sum.duv[0]).abs() < 1e-8
            );
        }
        let center = space.eval_sum(&space.constant(), 0, 0.0, 0.0).unwrap();
        assert!(center.p == [1.0] && center.du[0].is_nan());
    }
}

/// The surface itself is in every space: of the golden files (rings 0 and 1 of sector 1, computed
/// by an independent program) and of `Rings`.
#[test]
fn the_surface_of_a_net_is_in_every_space() {
    for (n, m) in [(3, 0), (5, 1), (6, 2), (8, 3), (10, 1)] {
        let golden = golden::guided(n);
        let net = golden::cnet(&golden, n);
        let nodes: Vec<[f64; 3]> =
            net.sectors.iter().flatten().copied().chain([net.center]).collect();
        for (kind, name) in SCHEMES.into_iter().zip(["bi5", "bi6"]) {
            let space = RefinableSpace::new(kind, n, m).unwrap();
            let values = space.cnet_matrix().apply(&nodes).unwrap();
            let rings = Rings::from_cnet(&net, kind, RuleSet::Generated).unwrap();
            for k in 0..3 {
                let values: Vec<f64> = values.iter().map(|p| p[k]).collect();
                for (ring, s, which) in (0..5).flat_map(|l| [0, 1, 2].map(|w| (l, l % n, w))) {
                    let found = space.coefs_of_sum(&values, ring, s, which).unwrap();
                    for (a, b) in found.iter().zip(rings.patch(ring, s, which).unwrap().coefs()) {
                        assert!(
                            (a - b[k]).abs() < 1e-12,
                            "{name} n = {n} ring {ring}: {a} {}",
                            b[k]
                        );
                    }
                }
                for (ring, (square, which)) in [0, 1]
                    .into_iter()
                    .flat_map(|ring| [1, 0, 2].into_iter().enumerate().map(move |w| (ring, w)))
                {
                    let order = space.degree() + 1;
                    for (at, b) in
                        space.coefs_of_sum(&values, ring, 1, which).unwrap().iter().enumerate()
                    {
                        let exact =
                            &golden[format!("ring{ring}_{name}")][square][at / order][at % order];
                        assert!(
                            (b - golden::point(exact)[k]).abs() < 1e-12,
                            "{name} n = {n} ring {ring}"
                        );
                    }
                }
            }
        }
    }
}
