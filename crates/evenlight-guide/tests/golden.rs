//! The derived rules against the numbers of our double-precision prototype, `data/golden/eg`.

use evenlight_guide::nets::{DNet, NODES_PER_SECTOR};
use evenlight_guide::quadratic::turn;
use evenlight_guide::real::Real;
use evenlight_guide::rules::{EG_ORDER, QAS_ORDER, RULES, StepRule, evolving_guide, step};
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
fn local_weights_of_the_step() {
    for n in VALENCES {
        let (step, golden) = (step(n), golden(n));
        for rule in RULES {
            let derived = step.rule(rule.0, rule.1);
            let mut expected = vec![0.0; NODES_PER_SECTOR * n];
            for (r, row) in golden["QAS_K"][name(rule)].as_object().unwrap() {
                let sector = r.parse().unwrap();
                let first = DNet { valence: n }.index(sector, 0, 0);
                for (k, weight) in numbers(row).into_iter().enumerate() {
                    expected[first + k] += weight; // at n = 3 the sectors -1 and 2 are the same
                }
            }
            assert_near(&derived.on_net, &expected, &format!("K, n = {n}, {rule:?}"));
            assert_quadratic_weights(&derived, rule, &golden["QAS_T"], n);
        }
    }
}

/// The tables list tau_2..tau_6 on q_2..q_6 of the own sector. For nodes on a line half of them,
/// mirrored, count for the next sector [KP23-QAS, eq. 7], here turned back to sector 0.
fn assert_quadratic_weights(derived: &StepRule, rule: (usize, usize), golden: &Value, n: usize) {
    let tau: Vec<Real> = numbers(&golden[name(rule)]).into_iter().map(Real::from).collect();
    let expected: Vec<f64> = if rule.0 < 3 {
        tau.iter().map(|t| t.to_f64()).collect()
    } else {
        let mirrored = [2, 4, 0, 3, 1].map(|k| tau[k]); // on q_2..q_6 of the next sector
        let turn = turn(n);
        let next = |column: usize| -> Real {
            (0..5).map(|row| mirrored[row] * turn[(row + 1, column)]).sum()
        };
        (0..5).map(|k| 0.5 * (tau[k] + next(k + 1)).to_f64()).collect()
    };
    assert_near(&derived.on_q[1..], &expected, &format!("T, n = {n}, {rule:?}"));
}

#[test]
fn first_quadratic() {
    for n in VALENCES {
        let (derived, golden) = (step(n).quadratic(QAS_ORDER), golden(n));
        for row in 0..5 {
            let expected = net_numbers(&golden["QAS_q_from_d_F5"][format!("q{}", row + 2)]);
            let derived = &derived.row(row)[..NODES_PER_SECTOR * n];
            assert_near(derived, &expected, &format!("q{}, n = {n}", row + 2));
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
