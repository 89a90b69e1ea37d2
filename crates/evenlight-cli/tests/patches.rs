//! `evenlight patches`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::collections::BTreeMap;

use common::{CUBE, PILLOW, SCHEMES, TETRAHEDRON, arg, cage, json, numbers, run, run_on, stdout};
use evenlight::io::bv;
use serde_json::{Value, json};

fn patches(document: &Value) -> &[Value] {
    document["patches"].as_array().unwrap()
}

fn pillow(args: &[&str]) -> Value {
    let pillow = cage(PILLOW);
    let fixed = ["patches", arg(&pillow), "-o", "-", "--format", "json"];
    json(&run(&[&fixed[..], args].concat()))
}

#[test]
fn json_has_the_promised_keys() {
    let document = pillow(&["--rings", "2"]);
    assert_eq!((&document["scheme"], &document["rules"]), (&json!("qas4"), &json!("generated")));
    for patch in patches(&document) {
        let [du, dv] = [0, 1].map(|k| patch["degree"][k].as_u64().unwrap());
        let coefficients = patch["coefficients"].as_array().unwrap();
        assert_eq!(coefficients.len() as u64, (du + 1) * (dv + 1));
        assert!(coefficients.iter().all(|b| b.as_array().unwrap().len() == 3));
        assert!(patch["face"].is_u64());
        let is_regular = patch["role"] == "regular";
        for key in ["vertex", "sector", "ring"] {
            assert_eq!(patch[key].is_null(), is_regular, "{key}");
        }
    }
}

#[test]
fn rings_have_the_patches_and_the_degree_that_help_promises() {
    let help = stdout(&run(&["patches", "--help"]));
    for scheme in SCHEMES {
        let about = help.lines().find(|l| l.contains(&format!("- {scheme}:"))).unwrap();
        let degree = if about.contains("bi-3") { 3 } else { 4 };
        let per_sector = if about.contains(" 12n patches") { 12 } else { 3 };
        let document = pillow(&["--rings", "3", "--scheme", scheme]);
        let mut rings: BTreeMap<(u64, u64), usize> = BTreeMap::new();
        for patch in patches(&document).iter().filter(|p| !p["ring"].is_null()) {
            let ring = patch["ring"].as_u64().unwrap();
            assert_eq!(patch["role"], format!("ring-{ring}"));
            assert_eq!(patch["degree"], json!([degree, degree]));
            *rings.entry((patch["vertex"].as_u64().unwrap(), ring)).or_default() += 1;
        }
        assert_eq!(rings.len(), 12 * 3);
        for ((vertex, ring), count) in rings {
            let valence = if [0, 61].contains(&vertex) { 5 } else { 3 };
            assert_eq!(count, per_sector * valence, "{scheme}: ring {ring} of vertex {vertex}");
        }
    }
}

#[test]
fn without_rings_the_regular_patches_remain() {
    let document = pillow(&["--rings", "0"]);
    assert!(!patches(&document).is_empty());
    assert!(
        patches(&document).iter().all(|p| p["role"] == "regular" && p["degree"] == json!([3, 3]))
    );
}

#[test]
fn rings_around_the_centre_of_an_n_gon_have_no_vertex() {
    let args = ["patches", "-", "-o", "-", "--format", "json", "--rings", "1"];
    let document = json(&run_on(TETRAHEDRON, &args));
    let centred = |p: &&Value| p["ring"] == 1 && p["vertex"].is_null();
    let centred: Vec<&Value> = patches(&document).iter().filter(centred).collect();
    assert_eq!(centred.len(), 4 * 3 * 3);
    assert!(centred.iter().all(|p| p["centre_of"] == p["face"] && p["sector"].is_u64()));
}

#[test]
fn bv_has_one_group_per_role_with_the_patches_of_the_json() {
    let args = |format| ["patches", "-", "-o", "-", "--rings", "4", "--format", format];
    let text = stdout(&run_on(CUBE, &args("bv")));
    let groups = bv::read(&text).unwrap();
    let mut roles: BTreeMap<String, usize> = BTreeMap::new();
    for patch in patches(&json(&run_on(CUBE, &args("json")))) {
        *roles.entry(patch["role"].as_str().unwrap().to_owned()).or_default() += 1;
    }
    let found = groups.iter().map(|g| (g.name.clone(), g.patches.len())).collect();
    assert_eq!(roles, found);
    assert_eq!(text.matches("Group ").count(), roles.len());
    let headers =
        text.lines().filter(|line| line.starts_with("5 ") && line.split(' ').count() == 3);
    assert!(headers.count() >= roles.values().sum());
}

#[test]
fn both_formats_have_the_same_coefficients_to_the_last_digit() {
    let args = |format| ["patches", "-", "-o", "-", "--rings", "1", "--format", format];
    let groups = bv::read(&stdout(&run_on(CUBE, &args("bv")))).unwrap();
    let text = stdout(&run_on(CUBE, &args("json")));
    for patch in groups.iter().flat_map(|group| &group.patches) {
        // As text, since the JSON reader at hand may be off by the last bit.
        let coefficients = serde_json::to_string(patch.coefs()).unwrap();
        assert!(text.contains(&format!("\"coefficients\":{coefficients}")));
    }
}

#[test]
fn published_rules_differ_a_little_from_the_generated_ones() {
    let coordinates = |document: &Value| -> Vec<f64> {
        patches(document).iter().flat_map(|p| numbers(&p["coefficients"])).collect()
    };
    for scheme in &SCHEMES[1..] {
        let with =
            |rules| coordinates(&pillow(&["--rings", "1", "--scheme", scheme, "--rules", rules]));
        let (generated, published) = (with("generated"), with("published"));
        let differences = generated.iter().zip(&published).map(|(a, b)| (a - b).abs());
        let largest = differences.fold(0.0, f64::max);
        assert!(largest > 0.0 && largest < 1e-3, "{scheme}: {largest}");
    }
}
