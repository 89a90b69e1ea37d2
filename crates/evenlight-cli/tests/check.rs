//! `evenlight check`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use common::{CONE, CUBE, PILLOW, TETRAHEDRON, arg, cage, code, json, run, run_on, stderr, stdout};
use serde_json::json;

#[test]
fn json_has_the_promised_keys_and_obeys_eulers_formula() {
    let pillow = cage(PILLOW);
    let output = run(&["check", arg(&pillow), "--json"]);
    assert_eq!((stderr(&output).as_str(), code(&output)), ("", 0));
    let report = json(&output);
    for key in ["vertices", "faces", "boundary_edges", "components", "omitted_faces"] {
        assert!(report[key].is_u64(), "{key}");
    }
    let count = |key: &str| report[key].as_i64().unwrap();
    assert_eq!(count("vertices") - count("edges") + count("faces"), 2);
    assert_eq!((count("boundary_edges"), count("components"), count("omitted_faces")), (0, 1, 0));
    assert_eq!((&report["errors"], &report["warnings"]), (&json!([]), &json!([])));
}

#[test]
fn valences_count_every_vertex_and_list_the_extraordinary_ones() {
    let pillow = cage(PILLOW);
    let report = json(&run(&["check", arg(&pillow), "--json"]));
    assert_eq!(report["valences"], json!({"3": 10, "4": 140, "5": 2}));
    let points = report["extraordinary"].as_array().unwrap();
    assert_eq!(points.len(), 12);
    assert_eq!((&points[0]["vertex"], &points[0]["valence"]), (&json!(0), &json!(5)));
    assert!(points.iter().all(|p| (0..=2).contains(&p["level"].as_u64().unwrap())));
    // On a closed surface of genus 0 the sum of 4 - valence is 8.
    let sum: i64 = points.iter().map(|p| 4 - p["valence"].as_i64().unwrap()).sum();
    assert_eq!(sum, 8);
}

#[test]
fn vertices_of_a_cube_are_isolated_one_level_deeper() {
    let report = json(&run_on(CUBE, &["check", "-", "--json"]));
    let levels = report["extraordinary"].as_array().unwrap().iter().map(|p| p["level"].clone());
    assert_eq!(levels.collect::<Vec<_>>(), vec![json!(1); 8]);
}

#[test]
fn centres_of_n_gons_are_listed_on_their_own() {
    let report = json(&run_on(TETRAHEDRON, &["check", "-", "--json"]));
    assert_eq!(report["ngons"], json!({"3": 4}));
    assert_eq!(report["face_centres"].as_array().unwrap().len(), 4);
    assert_eq!(report["extraordinary"].as_array().unwrap().len(), 4);
}

#[test]
fn faces_at_a_boundary_are_counted_and_said_so_on_stderr() {
    let cone = cage(CONE);
    let report = json(&run(&["check", arg(&cone), "--json"]));
    assert_eq!(
        (&report["omitted_faces"], &report["boundary"]),
        (&json!(0), &json!("edge-and-corner"))
    );
    let output = run(&["check", arg(&cone), "--json", "--boundary", "none"]);
    assert_eq!(code(&output), 0);
    let report = json(&output);
    assert_eq!((&report["omitted_faces"], &report["boundary_edges"]), (&json!(25), &json!(30)));
    let sentence = "25 of 45 faces are left out (holes, or at the boundary under the rule none)";
    assert_eq!(report["warnings"], json!([sentence]));
    assert!(stderr(&output).starts_with("warning: ") && stderr(&output).contains(sentence));
}

#[test]
fn text_tells_the_same_as_json() {
    let text = stdout(&run_on(CUBE, &["check", "-"]));
    for line in ["stdin: can be used", "vertices        8", "valences        8 with 3 edges"] {
        assert!(text.contains(line), "{text}");
    }
    assert_eq!(text.matches("valence 3    level 1").count(), 8);
}

#[test]
fn a_refused_cage_gives_exit_code_1_and_its_faults_in_json_and_on_stderr() {
    let bow_tie = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n";
    let output = run_on(bow_tie, &["check", "-", "--json"]);
    assert_eq!(code(&output), 1);
    let report = json(&output);
    let fault = report["errors"][0].as_str().unwrap();
    assert!(fault.contains("vertex 1 (line 1)") && fault.contains("more than one fan"), "{fault}");
    assert!(stderr(&output).contains(fault));
    assert!(report["vertices"].is_null());
}

#[test]
fn faults_name_the_line_of_the_file() {
    let output = run_on("v 0 0 zero\n", &["check", "-"]);
    assert_eq!((code(&output), output.stdout.len()), (1, 0));
    assert!(stderr(&output).starts_with("error: stdin: line 1, vertex 1: `zero`"));
}

#[test]
fn names_and_tags_cannot_steer_the_terminal() {
    let output = run_on(&format!("\u{1b}[2J\u{9b}7m 1\n{CUBE}"), &["check", "-"]);
    assert_eq!(code(&output), 0);
    let tag = stderr(&output);
    assert!(tag.contains("[2J") && tag.contains("is not supported"), "{tag}");
    let name = stderr(&run(&["check", "a\u{1b}[2Jb"]));
    assert!(name.starts_with("error: a\\u{1b}[2Jb: "), "{name}");
    assert!(tag.chars().chain(name.chars()).all(|c| c == '\n' || !c.is_control()));
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let output = run(&["check", "no/such/cage.obj", "--json"]);
    assert_eq!((code(&output), output.stdout.len()), (1, 0));
    assert!(stderr(&output).starts_with("error: no/such/cage.obj: "));
}

#[test]
fn valences_without_rules_are_a_warning() {
    let output = run_on(&text_of_pyramid(), &["check", "-"]);
    assert_eq!(code(&output), 0);
    let sentence = "only, cc takes their place: vertex 0 has valence 20, vertex 1 has valence 20";
    assert!(stderr(&output).contains(sentence));
    let rule = "vertex 0        valence 20   level 2  cc: no rules of the scheme for this valence";
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains(rule), "{text}");
    let output = run_on(&text_of_pyramid(), &["mesh", "-", "-o", "-", "--format", "obj"]);
    assert_eq!(code(&output), 0);
}

/// A double pyramid over a polygon with 20 sides.
fn text_of_pyramid() -> String {
    let mut text = "v 0 0 1\nv 0 0 -1\n".to_owned();
    for k in 0..20 {
        let angle = std::f64::consts::TAU * f64::from(k) / 20.0;
        text += &format!("v {} {} 0\n", angle.cos(), angle.sin());
    }
    for k in 0..20 {
        let (a, b) = (k + 3, (k + 1) % 20 + 3);
        text += &format!("f 1 {a} {b}\nf 2 {b} {a}\n");
    }
    text
}
