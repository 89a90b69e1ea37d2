//! `--rings K --cap KIND` of all commands.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use common::{CUBE, PILLOW, arg, cage, code, json, run, run_on, stderr, stdout};
use serde_json::{Value, json};

/// The patches of the caps of a pillow.
fn caps(args: &[&str]) -> Vec<Value> {
    let pillow = cage(PILLOW);
    let fixed = ["patches", arg(&pillow), "-o", "-", "--format", "json"];
    let document = json(&run(&[&fixed[..], args].concat()));
    let all = document["patches"].as_array().unwrap();
    all.iter().filter(|patch| patch["role"] == "cap").cloned().collect()
}

#[test]
fn patches_have_the_caps_that_help_promises() {
    assert!(caps(&["--rings", "2"]).is_empty(), "none by default");
    // Two points of valence 5 and ten of valence 3.
    let sectors = 2 * 5 + 10 * 3;
    for (kind, degree, split) in [("auto", 5, 2), ("bi4", 4, 2), ("bi5", 5, 2), ("bi6", 6, 1)] {
        let found = caps(&["--rings", "0", "--cap", kind]);
        assert_eq!(found.len(), sectors * split * split, "{kind}");
        assert!(found.iter().all(|patch| patch["degree"] == json!([degree, degree])));
        assert!(found.iter().all(|patch| patch["ring"].is_null() && patch["vertex"].is_u64()));
    }
    assert_eq!(caps(&["--cap", "bi3", "--scheme", "cc"]).len(), sectors * 9);
    let pillow = cage(PILLOW);
    let bv = stdout(&run(&[
        "patches",
        arg(&pillow),
        "-o",
        "-",
        "--format",
        "bv",
        "--rings",
        "2",
        "--cap",
        "auto",
    ]));
    assert!(bv.contains("\nGroup 3 cap\n5 5 5\n"));
}

#[test]
fn closed_surfaces_have_derivatives_at_extraordinary_points() {
    let corner = |args: &[&str]| {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), CUBE).unwrap();
        let fixed = ["eval", arg(file.path()), "--points", "-"];
        stdout(&run_on("0,0,0\n", &[&fixed[..], args].concat()))
    };
    assert!(corner(&[]).contains("nan"));
    for rings in ["0", "3"] {
        assert!(!corner(&["--cap", "auto", "--rings", rings]).contains("nan"));
    }
}

#[test]
fn meshes_and_pictures_take_caps() {
    let mesh = stdout(&run_on(
        CUBE,
        &["mesh", "-", "-o", "-", "--format", "obj", "--rate", "4", "--cap", "bi6", "--rings", "0"],
    ));
    let open = stdout(&run_on(CUBE, &["mesh", "-", "-o", "-", "--format", "obj", "--rate", "4"]));
    assert_eq!(mesh.lines().count(), open.lines().count());
    assert_ne!(mesh, open);
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("cube.png");
    let args = [
        "render",
        "-",
        "-o",
        arg(&picture),
        "--size",
        "60x40",
        "--style",
        "patches",
        "--cap",
        "auto",
        "--rings",
        "1",
    ];
    assert_eq!(code(&run_on(CUBE, &args)), 0);
    assert!(picture.exists());
}

#[test]
fn the_analysis_tells_the_defects_of_caps() {
    let args = ["analyze", "-", "--json", "--schemes", "cc,qas4", "--rings", "2", "--cap", "bi5"];
    let document = json(&run_on(CUBE, &args));
    for scheme in document["schemes"].as_array().unwrap() {
        for point in scheme["points"].as_array().unwrap() {
            let cap = &point["cap"];
            assert_eq!((&cap["degree"], &cap["split"]), (&json!(5), &json!(2)));
            for borders in ["lines", "inside", "ring"] {
                assert!(cap[borders]["position"].as_f64().unwrap() < 1e-14);
                assert!(cap[borders]["tangent_plane"].as_f64().unwrap() < 1e-11);
            }
        }
    }
    let text = stdout(&run_on(CUBE, &["analyze", "-", "--rings", "0", "--cap", "bi6"]));
    assert!(text.contains("bi-6 1 x 1"), "{text}");
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
}

#[test]
fn impossible_caps_are_wrong_usage() {
    let refused = run_on(
        "no cage",
        &["mesh", "-", "-o", "-", "--format", "obj", "--scheme", "guided6", "--cap", "bi4"],
    );
    assert_eq!(code(&refused), 2);
    let message = stderr(&refused);
    assert!(
        message.contains("bi-6 rings of scheme guided6"),
        "said before anything is read: {message}"
    );
    let without = run_on(CUBE, &["mesh", "-", "-o", "-", "--format", "obj", "--rings", "3"]);
    assert_eq!(code(&without), 2, "rings say nothing without caps");
    let nothing = run_on(CUBE, &["analyze", "-", "--rings", "0"]);
    assert_eq!(code(&nothing), 2);
}
