//! Guided C2 subdivision against the numbers of our double-precision prototype,
//! `data/golden/guided`, whose README says what they are.

use evenlight_guide::guided::cap::{Cap, cap_map};
use evenlight_guide::guided::characteristic::{CharacteristicRing, SQUARES, Square, sigma_of};
use evenlight_guide::guided::determining::{FREE_PLACES, FreeCoefs, guide};
use evenlight_guide::guided::fit::{generating_matrix, guide as fitted_guide};
use evenlight_guide::guided::net::CNet;
use evenlight_guide::guided::rings::{Form, Rings, shrinking};
use evenlight_guide::linear::Matrix;
use evenlight_guide::real::Real;
use serde_json::Value;

const VALENCES: [usize; 7] = [3, 5, 6, 7, 8, 9, 10];

/// The sector of which rings and caps are given.
const SECTOR: usize = 1;

fn golden(valence: usize) -> Value {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/golden/guided");
    let text = std::fs::read_to_string(format!("{folder}/n{valence:02}.json"));
    serde_json::from_str(&text.expect("there is a file per valence")).expect("the files are JSON")
}

/// All numbers of nested lists, in order.
fn numbers(value: &Value) -> Vec<f64> {
    match value.as_array() {
        Some(list) => list.iter().flat_map(numbers).collect(),
        None => vec![value.as_f64().expect("lists end in numbers")],
    }
}

/// Nested lists as a matrix with `num_columns` columns.
fn matrix(value: &Value, num_columns: usize) -> Matrix {
    let numbers = numbers(value);
    Matrix::from_fn(numbers.len() / num_columns, num_columns, |i, j| {
        Real::from(numbers[num_columns * i + j])
    })
}

/// The c-net of the file in the numbering of [`CNet`], three columns.
fn net(valence: usize, golden: &Value) -> Matrix {
    let given = matrix(&golden["cnet"], 3);
    let numbering = CNet { valence };
    let mut net = given.clone();
    for sector in 0..valence {
        for (k, (a, b)) in [(1, 0), (2, 0), (1, 1), (2, 1), (1, 2), (2, 2)].into_iter().enumerate()
        {
            net.set_row(numbering.index(sector as isize, a, b), given.row(6 * sector + k));
        }
    }
    net
}

fn deviation(a: &Matrix, b: &Matrix) -> f64 {
    assert_eq!((a.num_rows(), a.num_columns()), (b.num_rows(), b.num_columns()));
    let entries = (0..a.num_rows()).flat_map(|i| (0..a.num_columns()).map(move |j| (i, j)));
    entries.map(|at| (a[at] - b[at]).abs().to_f64()).fold(0.0, f64::max)
}

fn assert_near(found: &Matrix, golden: &Matrix, tolerance: f64, what: &str) {
    let deviation = deviation(found, golden);
    println!("{what}: {deviation:.1e}");
    assert!(deviation < tolerance, "{what}: off by {deviation:e}");
}

/// The free coefficients of `test_guide`.
fn test_coefs(valence: usize) -> FreeCoefs {
    let value = |q: usize| Real::ratio((7 * q as i32 + 3) % 11 - 5, 10);
    let mut free = FreeCoefs {
        quadratic: std::array::from_fn(value),
        sectors: vec![[Real::ZERO; FREE_PLACES.len()]; valence],
        extra: value(6 + 18 * valence),
    };
    for (sector, values) in free.sectors.iter_mut().enumerate() {
        for (k, x) in values.iter_mut().enumerate() {
            let rank = if k < 9 { valence * k + sector } else { 9 * valence + 9 * sector + k - 9 };
            *x = value(6 + rank);
        }
    }
    free
}

#[test]
fn characteristic_rings() {
    for n in VALENCES {
        let golden = golden(n);
        let half = Real::ratio(1, 2);
        let c = Real::cos_of_turn(n);
        let s = (Real::ONE - c * c).sqrt();
        for (prefix, sigma) in [("chi", half), ("chi_half", sigma_of(n, half))] {
            let ring = CharacteristicRing::new(n, sigma);
            for (square, name) in SQUARES.into_iter().zip(["A", "B", "C"]) {
                let [u, v] = ring.square(square);
                let plane = (&u + &v.scaled(c)).above(&v.scaled(s));
                let expected = matrix(&golden[format!("{prefix}_{name}")], 4);
                assert_near(&plane, &expected, 1e-13, &format!("{prefix} {name}, n = {n}"));
            }
        }
        let ring = CharacteristicRing::catmull_clark(n);
        let near = |found: Real, key: &str| {
            let error = found.to_f64() - golden[key].as_f64().unwrap();
            assert!(error.abs() < 1e-14, "{key}, n = {n}: off by {error:e}");
        };
        near(ring.lambda, "lambda");
        near(ring.domain_scale(), "domain_scale");
        near(sigma_of(n, half), "sigma_half");
    }
}

#[test]
fn the_explicit_formulas() {
    for n in VALENCES {
        let expected = matrix(&golden(n)["test_guide"], 1);
        assert_near(&guide(&test_coefs(n)), &expected, 1e-12, &format!("test guide, n = {n}"));
    }
}

#[test]
fn rings_of_a_given_guide() {
    for n in VALENCES {
        let golden = golden(n);
        let chi = CharacteristicRing::catmull_clark(n);
        let net = Matrix::zeros(6 * n + 1, 1);
        for (form, key) in [(Form::Bi5, "test_ring1_bi5"), (Form::Bi6, "test_ring1_bi6")] {
            let ring = Rings::new(&chi, form).ring(1, &guide(&test_coefs(n)), &net);
            let found = stacked(&ring[SECTOR]);
            let what = format!("{key}, n = {n}");
            assert_near(&found, &matrix(&golden[key], 1), 1e-12, &what);
        }
    }
}

#[test]
fn the_fitted_guide() {
    for n in VALENCES {
        let golden = golden(n);
        let generating = generating_matrix(&CharacteristicRing::catmull_clark(n));
        let found = fitted_guide(&generating, n, &net(n, &golden));
        let expected = matrix(&golden["guide"], 3);
        assert_near(&found, &expected, 1e-11, &format!("guide, n = {n}"));
    }
}

#[test]
fn rings_of_the_fitted_guide() {
    for n in VALENCES {
        let golden = golden(n);
        let chi = CharacteristicRing::catmull_clark(n);
        let (net, guide) = (net(n, &golden), matrix(&golden["guide"], 3));
        for form in [Form::Bi5, Form::Bi6] {
            let rings = Rings::new(&chi, form);
            for level in 0..2 {
                let key = format!("ring{level}_bi{}", form.degree());
                let found = stacked(&rings.ring(level, &guide, &net)[SECTOR]);
                let what = format!("{key}, n = {n}");
                assert_near(&found, &matrix(&golden[&key], 3), 1e-12, &what);
            }
        }
    }
}

#[test]
fn the_cap() {
    for n in VALENCES {
        let golden = golden(n);
        let chi = CharacteristicRing::catmull_clark(n);
        let (c, u) = (Real::cos_of_turn(n), cap_map(&chi));
        let s = (Real::ONE - c * c).sqrt();
        let plane = (&u + &u.transposed().scaled(c)).above(&u.transposed().scaled(s));
        assert_near(&plane, &matrix(&golden["sigma_hat"], 7), 1e-12, &format!("map, n = {n}"));
        let twice = &shrinking(chi.lambda) * &shrinking(chi.lambda);
        let guide = &Matrix::identity(n).kronecker(&twice) * &matrix(&golden["guide"], 3);
        let found = &Cap::new(&chi, Form::Bi6).pieces(&guide)[SECTOR];
        assert_near(found, &matrix(&golden["cap_bi6"], 3), 1e-12, &format!("cap, n = {n}"));
    }
}

/// The coefficients of A, B, C below each other.
fn stacked(squares: &[Matrix; 3]) -> Matrix {
    let [a, b, c] = [Square::A, Square::B, Square::C].map(|square| &squares[square as usize]);
    a.above(b).above(c)
}
