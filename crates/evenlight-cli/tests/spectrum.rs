//! `evenlight spectrum`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use common::{SCHEMES, code, json, run, stderr, stdout};
use serde_json::{Value, json};

fn spectra(args: &[&str]) -> Vec<Value> {
    let document = json(&run(&[&["spectrum", "--json"], args].concat()));
    document["spectra"].as_array().unwrap().clone()
}

#[test]
fn json_has_the_promised_keys() {
    let document = json(&run(&["spectrum", "--json", "--rules", "published"]));
    assert_eq!((&document["scheme"], &document["rules"]), (&json!("qas4"), &json!("published")));
    for spectrum in document["spectra"].as_array().unwrap() {
        let number = |key: &str| spectrum[key].as_f64().unwrap();
        let moduli = spectrum["eigenvalues"].as_array().unwrap();
        let moduli: Vec<f64> = moduli.iter().map(|m| m.as_f64().unwrap()).collect();
        assert!(moduli.is_sorted_by(|a, b| a >= b) && (moduli[0] - 1.0).abs() < 1e-12);
        assert!((moduli[1] - number("lambda")).abs() < 1e-6);
        assert!((moduli[3] / number("lambda").powi(2) - number("mu_over_lambda2")).abs() < 1e-6);
        assert!((0.0..1.0).contains(&number("jacobian_min")));
        assert!((0.0..100.0).contains(&number("zeros_percent")));
        assert_eq!(spectrum["injectivity_proved"], true);
        assert!((0.0..1.0).contains(&number("md_max_over_lambda2")));
    }
}

#[test]
fn every_scheme_has_spectra_for_all_its_valences() {
    for scheme in SCHEMES {
        let spectra = spectra(&["--scheme", scheme, "--valence", "3..16"]);
        assert_eq!(spectra.len(), 13);
        for spectrum in spectra {
            let name = format!("{scheme} n = {}", spectrum["valence"]);
            // Curvature is bounded with a quadratic: mu is its lambda^2, all else is below.
            let has_quadratic = scheme.starts_with("qas");
            assert_eq!(spectrum["md_max_over_lambda2"].is_null(), !has_quadratic, "{name}");
            if has_quadratic {
                assert!(spectrum["md_max_over_lambda2"].as_f64().unwrap() < 1.0, "{name}");
                let mu = spectrum["mu_over_lambda2"].as_f64().unwrap();
                assert!((mu - 1.0).abs() < 1e-12, "{name}");
            }
            assert_eq!(spectrum["injectivity_proved"], true, "{name}");
        }
    }
}

/// Eigenvalues are powers of 1/2 at every valence, as often as at Catmull-Clark's contraction.
#[test]
fn guided_schemes_contract_as_they_are_told_and_others_refuse() {
    let of = |contraction| {
        let args = ["--scheme", "guided5", "--valence", "3..20", "--contraction", contraction];
        spectra(&args)
    };
    let (usual, half) = (of("cc"), of("half"));
    for (usual, half) in usual.iter().zip(&half) {
        assert_eq!(half["injectivity_proved"], true);
        let moduli = |spectrum: &Value, lambda: f64| -> Vec<f64> {
            let moduli = spectrum["eigenvalues"].as_array().unwrap().iter();
            moduli.map(|m| (m.as_f64().unwrap().ln() / lambda.ln()).round()).collect()
        };
        let lambda = usual["lambda"].as_f64().unwrap();
        assert!((half["lambda"].as_f64().unwrap() - 0.5).abs() < 1e-15);
        assert_eq!(moduli(half, 0.5), moduli(usual, lambda));
    }
    let refused = |args: &[&str]| {
        let output = run(&[&["spectrum"], args].concat());
        assert_eq!(code(&output), 2);
        stderr(&output)
    };
    assert!(refused(&["--contraction", "half"]).contains("scheme qas4 contracts like"));
    let message = refused(&["--scheme", "guided5", "--contraction", "0.7"]);
    assert!(message.contains("between 0.3 and 0.7"), "{message}");
    let message = refused(&["--scheme", "guided5", "--valence", "33"]);
    assert!(message.contains("3 and 5 to 32"), "{message}");
}

#[test]
fn ranges_include_both_ends_and_skip_4() {
    let valences =
        |range| spectra(&["--valence", range]).iter().map(|s| s["valence"].clone()).collect();
    let default: Vec<Value> = valences("3..10");
    assert_eq!(default, [3, 5, 6, 7, 8, 9, 10]);
    assert_eq!(default, spectra(&[]).iter().map(|s| s["valence"].clone()).collect::<Vec<_>>());
    let single: Vec<Value> = valences("5");
    assert_eq!(single, [5]);
}

#[test]
fn catmull_clark_has_the_eigenvalues_of_the_books() {
    // [PR08]: lambda = (c + 5 + sqrt((c + 1) (c + 9))) / 16 with c = cos(2 pi / n).
    for spectrum in spectra(&["--scheme", "cc", "--valence", "3..10"]) {
        let n = spectrum["valence"].as_f64().unwrap();
        let c = (std::f64::consts::TAU / n).cos();
        let lambda = (c + 5.0 + ((c + 1.0) * (c + 9.0)).sqrt()) / 16.0;
        assert!((spectrum["lambda"].as_f64().unwrap() - lambda).abs() < 1e-12);
    }
    let document = json(&run(&["spectrum", "--scheme", "cc", "--json"]));
    assert!(document["rules"].is_null());
}

#[test]
fn valence_4_is_regular() {
    let regular = &spectra(&["--scheme", "cc", "--valence", "4"])[0];
    assert!((regular["lambda"].as_f64().unwrap() - 0.5).abs() < 1e-12);
    assert!((regular["mu_over_lambda2"].as_f64().unwrap() - 1.0).abs() < 1e-12);
    let output = run(&["spectrum", "--valence", "4"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("rules for the valences 3 and 5 to 16, not for 4"));
}

#[test]
fn valences_without_rules_are_wrong_usage() {
    let output = run(&["spectrum", "--rules", "published", "--valence", "3..11"]);
    assert_eq!((code(&output), output.stdout.len()), (2, 0));
    let text = stderr(&output);
    assert!(text.contains("qas4 has published rules for the valences 3 and 5 to 10, not for 11"));
    assert!(text.contains("; its generated rules are for 3 and 5 to 16"));
    let output = run(&["spectrum", "--valence", "17"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("rules for the valences 3 and 5 to 16, not for 17\n"));
}

#[test]
fn the_table_has_a_line_per_valence() {
    let text = stdout(&run(&["spectrum", "--valence", "3..6"]));
    assert_eq!(text.lines().count(), 1 + 3);
    for column in ["lambda", "mu/lambda^2", "M_d/lambda^2", "zeros %", "min Jacobian", "injective"]
    {
        assert!(text.lines().next().unwrap().contains(column), "{column}");
    }
    assert!(text.lines().skip(1).all(|line| line.contains(" proved ")));
    assert!(text.lines().nth(1).unwrap().trim_start().starts_with("3  0.410097"));
}

#[test]
fn eigenfunctions_are_drawn_degree_by_degree() {
    let folder = tempfile::tempdir().unwrap();
    let into = folder.path().join("new").display().to_string();
    let args = ["spectrum", "--scheme", "guided5", "--valence", "3", "--eigenfunctions", &into];
    assert_eq!(code(&run(&args)), 0);
    for s in 0..=10 {
        let file = folder.path().join(format!("new/guided5_n03_s{s:02}.png"));
        assert!(std::fs::read(&file).unwrap().starts_with(b"\x89PNG"), "{}", file.display());
    }
    let output = run(&["spectrum", "--scheme", "qas4", "--eigenfunctions", &into]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("choose one of guided3 to guided6"), "{}", stderr(&output));
}
