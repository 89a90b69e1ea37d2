//! `evenlight check`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use common::{
    CONE, CUBE, PILLOW, TETRAHEDRON, arg, cage, code, file, json, run, run_on, stderr, stdout,
};
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

/// Fair rings are for irregular vertices of creases and boundaries, on request.
#[test]
fn fair_rings_beside_creases_are_said() {
    let sheet = cage("features/boundary_valences.obj");
    let report = json(&run(&["check", arg(&sheet), "--json"]));
    let fair = json(&run(&["check", arg(&sheet), "--json", "--creases", "fair"]));
    let rules = |report: &serde_json::Value| -> Vec<[serde_json::Value; 2]> {
        let points = report["extraordinary"].as_array().unwrap().iter();
        points.map(|p| ["rule", "reason"].map(|key| p[key].clone())).collect()
    };
    let is_fair = |rule: &[serde_json::Value; 2]| rule[0] == json!("fair-crease");
    assert!(!rules(&report).iter().any(is_fair));
    assert_eq!(rules(&fair).iter().filter(|rule| is_fair(rule)).count(), 4);
    for (before, after) in rules(&report).iter().zip(&rules(&fair)) {
        let changed = [json!("fair-crease"), before[1].clone()];
        assert!(after == before || (*after == changed && before[0] == json!("cc")));
    }
    let text = stdout(&run(&["check", arg(&sheet), "--creases", "fair"]));
    assert!(text.contains("    4      fair rings: on the boundary"), "{text}");
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

/// What `mesh` refuses, `check` refuses in the same words, whatever the scheme and the point.
#[test]
fn valences_beyond_all_rules_are_refused_as_a_surface_is() {
    let fan = {
        let mut text = "v 0 0 1\n".to_owned();
        for k in 0..2051 {
            let angle = std::f64::consts::PI * f64::from(k) / 2050.0;
            text += &format!("v {} {} 0\n", angle.cos(), angle.sin());
        }
        (0..1025).for_each(|k| text += &format!("f 1 {} {} {}\n", 2 * k + 2, 2 * k + 3, 2 * k + 4));
        text
    };
    let limit = "error: stdin: there are rules for valences up to 1024, but vertex 0 ";
    for (cage, is_refused) in
        [(double_pyramid(1025), true), (double_pyramid(1024), false), (fan, true)]
    {
        for scheme in ["cc", "qas4"] {
            let output = run_on(&cage, &["check", "-", "--json", "--scheme", scheme]);
            let mesh = ["mesh", "-", "-o", "-", "--format", "stl", "--rate", "1"];
            let mesh = run_on(&cage, &[&mesh[..], &["--scheme", scheme]].concat());
            assert_eq!((code(&output), code(&mesh)), (is_refused.into(), is_refused.into()));
            assert_eq!(json(&output)["errors"].as_array().unwrap().len(), usize::from(is_refused));
            assert_eq!(stderr(&output), stderr(&mesh));
            assert_eq!(stderr(&output).starts_with(limit), is_refused, "{}", stderr(&output));
            if scheme == "cc" {
                assert!(!stderr(&output).contains("takes their place"));
            }
        }
    }
}

fn text_of_pyramid() -> String {
    double_pyramid(20)
}

/// A double pyramid over a polygon with `n` sides.
fn double_pyramid(n: usize) -> String {
    let mut text = "v 0 0 1\nv 0 0 -1\n".to_owned();
    for k in 0..n {
        let angle = std::f64::consts::TAU * k as f64 / n as f64;
        text += &format!("v {} {} 0\n", angle.cos(), angle.sin());
    }
    for k in 0..n {
        let (a, b) = (k + 3, (k + 1) % n + 3);
        text += &format!("f 1 {a} {b}\nf 2 {b} {a}\n");
    }
    text
}

/// A cube with its last face flipped, a vertex twice and one in no face.
const BROKEN_CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n\
    v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nv -1 -1 -1\nv 5 5 5\n\
    f 1 4 3 2\nf 5 6 7 8\nf 9 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 8 5 1 4\n";

#[test]
fn repairs_are_made_on_request_only_and_listed() {
    let (folder, path) = file("broken.obj", BROKEN_CUBE);
    let out = folder.path().join("fixed.obj");
    let all = ["--merge", "0", "--flip", "--drop-unused"];
    let output = run(&[&["check", arg(&path), "--fix", arg(&out)], &all[..]].concat());
    let expected = format!(
        "{}: written\n  1 vertex merged, from a distance of 0 or less: 9 (line 9) into 1 (line 1)\n  \
         1 face flipped: 6 (line 16)\n  1 vertex in no face deleted: 10 (line 10)\n",
        out.display()
    );
    assert_eq!(stdout(&output), expected);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), BROKEN_CUBE);
    let check = json(&run(&["check", arg(&out), "--json"]));
    assert_eq!((&check["boundary_edges"], &check["vertices"]), (&0.into(), &8.into()));
    // The same again finds nothing to do, and leaves the file that is there.
    let output = run(&[&["check", arg(&out), "--fix", arg(&path)], &all[..]].concat());
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("nothing is changed, and nothing written: none of these"));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), BROKEN_CUBE);
}

#[test]
fn faults_that_remain_are_said() {
    let (folder, path) = file("broken.obj", BROKEN_CUBE);
    let out = folder.path().join("fixed.ply");
    let fix = ["check", arg(&path), "--fix", arg(&out), "--drop-unused"];
    let output = run(&[&fix[..], &["--json"]].concat());
    assert_eq!(code(&output), 1);
    let message = format!("error: {}: still cannot be used: ", out.display());
    assert!(stderr(&output).starts_with(&message), "{}", stderr(&output));
    let report = json(&output);
    assert_eq!(report["changes"], serde_json::json!(["1 vertex in no face deleted: 10 (line 10)"]));
    assert!(!report["errors"].as_array().unwrap().is_empty() && out.exists());
}

#[test]
fn a_moebius_strip_cannot_be_oriented() {
    let strip =
        "v 0 0 0\n".repeat(10) + "f 2 4 3 1\nf 4 6 5 3\nf 6 8 7 5\nf 8 10 9 7\nf 10 1 2 9\n";
    let (folder, path) = file("strip.obj", &strip);
    let out = folder.path().join("fixed.obj");
    let output = run(&["check", arg(&path), "--fix", arg(&out), "--flip"]);
    assert_eq!(code(&output), 1);
    let expected = "nothing is changed, and nothing written: the piece of face 1 (line 11) (5 faces) \
                    is one-sided";
    assert!(stderr(&output).contains(expected), "{}", stderr(&output));
    assert!(!out.exists());
}

#[test]
fn repairs_must_be_chosen_and_need_a_file() {
    let (folder, path) = file("broken.obj", BROKEN_CUBE);
    let out = folder.path().join("fixed.obj");
    for (words, expected) in [
        (&["--fix", arg(&out)][..], "--fix needs to be told what to repair: --merge DISTANCE"),
        (&["--flip"], "--fix <OUT>"),
        (&["--fix", arg(&out), "--merge", "-1"], "a distance is a number from 0"),
        (&["--fix", "out.stl", "--flip"], "it can be .obj, .ply, .usda"),
        (&["--fix", "-", "--flip"], "--fix needs a file, .obj, .ply or .usda: on stdout there is"),
    ] {
        let output = run(&[&["check", arg(&path)], words].concat());
        assert_eq!(code(&output), 2, "{words:?}");
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
    }
}
