//! The derived rules against the numbers of our double-precision prototype, `data/golden/eg`.

use evenlight_guide::evolving_guide::{EG_ORDER, evolving_guide};
use evenlight_guide::nets::NODES_PER_SECTOR;
use evenlight_guide::quadratic_attraction::{Q_RULES, QAS_ORDER, quadratic_attraction};
use evenlight_guide::real::Real;
use evenlight_guide::rules::{RULES, TURNS, step};
use serde_json::Value;

const VALENCES: [usize; 7] = [3, 5, 6, 7, 8, 9, 10];

/// The prototype computes in `f64`; measured deviation: 1.6e-14 (n = 3).
const TOLERANCE: f64 = 1e-12;

fn golden(valence: usize) -> Value {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/golden/eg");
    let file = format!("{folder}/n{valence:02}.json");
    let text = std::fs::read_to_string(&file).expect("data/golden/eg has a file per valence");
    serde_json::from_str(&text).expect("golden files are JSON")
}

fn numbers(row: &Value) -> Vec<f64> {
    let list = row.as_array().expect("a row is a list");
    list.iter().map(|x| x.as_f64().expect("a row holds numbers")).collect()
}

/// n rows of 12 as one list.
fn net_numbers(rows: &Value) -> Vec<f64> {
    rows.as_array().expect("a net is a list of rows").iter().flat_map(numbers).collect()
}

fn assert_near(derived: &[Real], golden: &[f64], what: &str) {
    assert_eq!(derived.len(), golden.len(), "{what}");
    for (k, (derived, golden)) in derived.iter().zip(golden).enumerate() {
        let error = (*derived - Real::from(*golden)).abs().to_f64();
        assert!(error < TOLERANCE, "{what}, number {k}: off by {error:e}");
    }
}

fn name((h, k): (usize, usize)) -> String {
    format!("{h}{k}")
}

#[test]
fn evolving_guide_rules_with_both_functionals() {
    for n in VALENCES {
        for (order, key) in [(EG_ORDER, "EG"), (QAS_ORDER, "EG_F5")] {
            let golden = &golden(n)[key];
            for (rule, derived) in RULES.into_iter().zip(evolving_guide(n, order)) {
                let expected = net_numbers(&golden[name(rule)]);
                assert_near(&derived.on_net, &expected, &format!("{key}, n = {n}, {rule:?}"));
            }
        }
    }
}

#[test]
fn quadratic_attraction_rules_of_the_nodes() {
    for n in VALENCES {
        let golden = golden(n);
        for (rule, (h, k)) in quadratic_attraction(n, QAS_ORDER).nodes.iter().zip(RULES) {
            for (row, r) in rule.kappa.iter().zip(TURNS) {
                let expected = numbers(&golden["QAS_K"][name((h, k))][r.to_string()]);
                assert_near(row, &expected, &format!("kappa, n = {n}, rule {h}{k}, r = {r}"));
            }
            let expected = numbers(&golden["QAS_T"][name((h, k))]);
            assert_near(&rule.tau, &expected, &format!("tau, n = {n}, rule {h}{k}"));
        }
    }
}

#[test]
fn first_quadratic() {
    for n in VALENCES {
        let (derived, golden) = (step(n).quadratic(QAS_ORDER), &golden(n)["QAS_q_from_d_F5"]);
        for m in 2..=6 {
            let expected = net_numbers(&golden[format!("q{m}")]);
            let derived = &derived.row(m - 1)[..NODES_PER_SECTOR * n];
            assert_near(derived, &expected, &format!("q_{m}, n = {n}"));
        }
        for ((m, _), rule) in Q_RULES.iter().zip(quadratic_attraction(n, QAS_ORDER).q) {
            let expected = net_numbers(&golden[format!("q{m}")]);
            assert_near(&rule.on_net, &expected, &format!("mu of q_{m}, n = {n}"));
        }
    }
}

#[test]
fn eigenvalue() {
    for n in VALENCES {
        let lambda = golden(n)["lambda"].as_f64().unwrap();
        assert!((step(n).chi.lambda.to_f64() - lambda).abs() < 1e-15, "n = {n}");
    }
}
