//! `evenlight q` and what `--q` does with its answer.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use common::{CONE, PILLOW, arg, cage, code, file, json, numbers, run, run_on, stderr, stdout};
use serde_json::{Value, json};

/// A cage with triangles, pentagons and vertices of several valences.
const NGONS: &str = "own_polygons.obj";

fn q(cage_name: &str, args: &[&str]) -> String {
    let cage = cage(cage_name);
    stdout(&run(&[&["q", arg(&cage)], args].concat()))
}

fn entries(text: &str) -> Vec<Value> {
    serde_json::from_str(text).unwrap()
}

/// All coefficients of the patches of a surface.
fn patches(cage_name: &str, args: &[&str]) -> Vec<f64> {
    let cage = cage(cage_name);
    let fixed = ["patches", arg(&cage), "-o", "-", "--format", "json", "--rings", "5"];
    let document = json(&run(&[&fixed[..], args].concat()));
    let patches = document["patches"].as_array().unwrap();
    patches.iter().flat_map(|patch| numbers(&patch["coefficients"])).collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Two lists of numbers that agree but for rounding.
#[track_caller]
fn assert_close(a: &[f64], b: &[f64]) {
    let difference = largest_difference(a, b);
    assert!(difference < 1e-12, "{difference}: {a:?}, {b:?}");
}

#[test]
fn what_q_prints_gives_the_same_surface_again() {
    for name in [PILLOW, CONE, NGONS, "obstacle/saddle_n10.obj"] {
        for scheme in ["qas3", "qas4"] {
            for form in ["--json", "--sectors"] {
                let cage = cage(name);
                let printed = run(&["q", arg(&cage), "--scheme", scheme, form]);
                let (_folder, path) = file("q.json", &String::from_utf8_lossy(&printed.stdout));
                let default = patches(name, &["--scheme", scheme]);
                let again = patches(name, &["--scheme", scheme, "--q", arg(&path)]);
                assert_close(&default, &again);
            }
        }
    }
}

#[test]
fn every_point_is_listed_with_its_valence_and_either_form_of_its_quadratic() {
    let list = entries(&q(NGONS, &["--json"]));
    let in_sectors = entries(&q(NGONS, &["--json", "--sectors"]));
    assert_eq!(q(NGONS, &["--sectors"]), q(NGONS, &["--json", "--sectors"]));
    assert!(list.iter().any(|entry| entry.get("vertex").is_some()));
    assert!(list.iter().any(|entry| entry.get("face").is_some()));
    for (entry, sectors) in list.iter().zip(&in_sectors) {
        assert!(entry.get("vertex").is_some() != entry.get("face").is_some());
        let valence = entry["valence"].as_u64().unwrap();
        assert_eq!(numbers(&entry["coefficients"]).len(), 18);
        assert_eq!(numbers(&sectors["sectors"]).len() as u64, 18 * valence);
        assert!(entry.get("sectors").is_none() && sectors.get("coefficients").is_none());
        for key in ["center", "normal", "principal_curvatures"] {
            assert_eq!(entry[key], sectors[key]);
        }
        assert_eq!(entry["center"], entry["coefficients"][0]);
        assert_close(&numbers(&entry["coefficients"]), &numbers(&sectors["sectors"][0]));
        // Line s is shared by sectors s and s+1: q_4 and q_6 of the one, q_2 and q_3 of the next.
        for s in 0..valence as usize {
            let [one, next] = [s, (s + 1) % valence as usize].map(|s| &sectors["sectors"][s]);
            assert_close(&numbers(&json!([one[3], one[5]])), &numbers(&json!([next[1], next[2]])));
        }
    }
}

#[test]
fn the_table_has_a_line_per_point() {
    let text = q(PILLOW, &[]);
    let header: Vec<&str> = text.lines().next().unwrap().split_whitespace().collect();
    assert_eq!(header, ["point", "valence", "center", "normal", "k1", "k2"]);
    assert_eq!(text.lines().count(), 1 + 12);
    assert!(text.lines().nth(1).unwrap().starts_with("vertex 0"));
    assert!(q(NGONS, &[]).lines().any(|line| line.starts_with("face ")));
}

#[test]
fn principal_curvatures_are_those_of_the_surface_at_the_point() {
    let entries = entries(&q(PILLOW, &["--json"]));
    let entry = entries.iter().find(|entry| entry["vertex"] == 0).unwrap();
    let row = &at_vertex(PILLOW, &[])[0];
    let [k1, k2] = [0, 1].map(|k| entry["principal_curvatures"][k].as_f64().unwrap());
    assert!(k1 >= k2);
    assert_close(&row.position, &numbers(&entry["center"]));
    assert_close(&row.normal, &numbers(&entry["normal"]));
    assert_close(&[row.gauss, row.mean], &[k1 * k2, 0.5 * (k1 + k2)]);
}

/// The surface at a vertex.
#[derive(Debug, PartialEq)]
struct Point {
    position: Vec<f64>,
    normal: Vec<f64>,
    gauss: f64,
    mean: f64,
}

/// What `eval` answers at the corners that are vertex 0.
fn at_vertex(cage_name: &str, args: &[&str]) -> Vec<Point> {
    let path = cage(cage_name);
    let text = std::fs::read_to_string(&path).unwrap();
    let faces = text.lines().filter_map(|line| line.strip_prefix("f "));
    let corner = |face: &str| face.split(' ').position(|v| v.split('/').next() == Some("1"));
    let corners = faces.map(corner).enumerate().filter_map(|(f, corner)| Some((f, corner?)));
    let uv = |corner: usize| [[0, 0], [1, 0], [1, 1], [0, 1]][corner];
    let row = |(f, corner)| format!("{f},{},{}\n", uv(corner)[0], uv(corner)[1]);
    let points: String = corners.map(row).collect();
    let fixed = ["eval", arg(&path), "--points", "-"];
    let answers = stdout(&run_on(&points, &[&fixed[..], args].concat()));
    answers.lines().skip(1).map(point).collect()
}

fn point(row: &str) -> Point {
    let x: Vec<f64> = row.split(',').skip(3).map(|x| x.parse().unwrap()).collect();
    Point { position: x[..3].to_vec(), normal: x[18..21].to_vec(), gauss: x[21], mean: x[22] }
}

/// The surface of the pillow at vertex 0 with another quadratic there, seen from each of its
/// faces, which must agree.
fn with_change(change: &Value) -> Point {
    let mut entry = change.clone();
    entry["vertex"] = 0.into();
    let (_folder, path) = file("q.json", &json!([entry]).to_string());
    let mut points = at_vertex(PILLOW, &["--q", arg(&path)]);
    assert_eq!(points.len(), 5);
    let last = points.pop().unwrap();
    for other in points {
        assert_eq!(other, last);
    }
    last
}

#[test]
fn a_translation_moves_the_limit_point_and_nothing_else_there() {
    let (before, t) = (with_change(&json!({"affine": {}})), [0.1, -0.2, 0.3]);
    let after = with_change(&json!({"affine": {"translation": t}}));
    let moved: Vec<f64> = before.position.iter().zip(t).map(|(p, t)| p + t).collect();
    assert_close(&after.position, &moved);
    assert_close(&after.normal, &before.normal);
    assert_close(&[after.gauss, after.mean], &[before.gauss, before.mean]);
}

#[test]
fn a_matrix_acts_about_the_limit_point() {
    let before = with_change(&json!({"affine": {}}));
    // Twice as large: curvatures half as large, the limit point where it was.
    let after = with_change(&json!({"affine": {"matrix": [[2, 0, 0], [0, 2, 0], [0, 0, 2]]}}));
    assert_close(&after.position, &before.position);
    assert_close(&after.normal, &before.normal);
    assert_close(&[4.0 * after.gauss, 2.0 * after.mean], &[before.gauss, before.mean]);
    // A quarter turn about the x axis, rows first: (x,y,z) -> (x,-z,y).
    let turn = json!([[1, 0, 0], [0, 0, -1], [0, 1, 0]]);
    let after = with_change(&json!({"affine": {"matrix": turn}}));
    let [x, y, z] = [0, 1, 2].map(|k| before.normal[k]);
    assert_close(&after.position, &before.position);
    assert_close(&after.normal, &[x, -z, y]);
    assert_close(&[after.gauss, after.mean], &[before.gauss, before.mean]);
}

#[test]
fn coefficients_of_a_known_quadratic_give_its_curvature() {
    // In sector 0, u and v along lines at an angle of 72 degrees, x = u + cos v, y = sin v; the
    // height h(x,y) = (x^2 + y^2) / 2 has both principal curvatures 1 towards the normal.
    let (sin, cos) = (std::f64::consts::TAU / 5.0).sin_cos();
    let p = [0.3, 0.4, 0.5];
    let at = |a: f64, b: f64, h: f64| [p[0] + a + b * cos, p[1] + b * sin, p[2] + h];
    // h = u^2/2 + cos u v + v^2/2: gamma = epsilon = 1/2, delta = cos.
    let coefficients = json!([
        at(0.0, 0.0, 0.0),
        at(0.2, 0.0, 0.0),
        at(0.4, 0.0, 0.05),
        at(0.0, 0.2, 0.0),
        at(0.2, 0.2, cos / 20.0),
        at(0.0, 0.4, 0.05)
    ]);
    let found = with_change(&json!({"coefficients": coefficients}));
    assert_close(&found.position, &p);
    assert_close(&found.normal, &[0.0, 0.0, 1.0]);
    assert_close(&[found.gauss, found.mean], &[1.0, 1.0]);
}

#[test]
fn proposals_of_sectors_are_averaged() {
    let before = with_change(&json!({"affine": {}}));
    let list = entries(&q(PILLOW, &["--sectors"]));
    let entry = list.iter().find(|entry| entry["vertex"] == 0).unwrap();
    let mut sectors = entry["sectors"].clone();
    let again = with_change(&json!({"sectors": sectors}));
    assert_close(&again.position, &before.position);
    assert_close(&[again.gauss, again.mean], &[before.gauss, before.mean]);
    // All points of one of five sectors move by t: the mean moves by t/5.
    for k in 0..6 {
        sectors[2][k][2] = (sectors[2][k][2].as_f64().unwrap() + 0.5).into();
    }
    let after = with_change(&json!({"sectors": sectors}));
    let [x, y, z] = [0, 1, 2].map(|k| before.position[k]);
    assert_close(&after.position, &[x, y, z + 0.1]);
    assert_close(&after.normal, &before.normal);
}

#[test]
fn the_surface_keeps_its_border_and_all_patches_away_from_the_point() {
    let edit = json!({"points": [{"vertex": 0, "affine": {"translation": [0, 0, 0.3]}}]});
    let (_folder, path) = file("q.json", &edit.to_string());
    let cage = cage(PILLOW);
    let document = |args: &[&str]| {
        let fixed = ["patches", arg(&cage), "-o", "-", "--format", "json", "--rings", "2"];
        json(&run(&[&fixed[..], args].concat()))
    };
    let [before, after] = [document(&[]), document(&["--q", arg(&path)])];
    let pairs =
        before["patches"].as_array().unwrap().iter().zip(after["patches"].as_array().unwrap());
    let mut changed = 0;
    for (a, b) in pairs {
        let is_near = a["vertex"] == 0;
        assert!(is_near || a == b, "{}", a["role"]);
        changed += usize::from(is_near && a != b);
    }
    assert_eq!(changed, 2 * 3 * 5);
    // Joined as smoothly as before, on its border too.
    let report =
        json(&run(&["analyze", arg(&cage), "--schemes", "qas4", "--json", "--q", arg(&path)]));
    let jumps = &report["schemes"][0]["jumps"];
    assert!(jumps["position"].as_f64().unwrap() < 1e-13);
    assert!(jumps["tangent_plane"].as_f64().unwrap() < 1e-12);
    assert!(jumps["curvature"].as_f64().unwrap() < 1e-9);
}

#[test]
fn all_commands_take_the_quadratics_and_schemes_without_are_left_alone() {
    let edit = json!([{"vertex": 0, "affine": {"translation": [0, 0, 0.3]}}]);
    let (_folder, path) = file("q.json", &edit.to_string());
    let cage = cage(PILLOW);
    let both = |args: &[&str]| {
        let run = |more: &[&str]| {
            let output = run(&[args, more].concat());
            assert_eq!((stderr(&output).as_str(), code(&output)), ("", 0));
            output.stdout
        };
        [run(&[]), run(&["--q", arg(&path)])]
    };
    for args in [
        &["mesh", arg(&cage), "-o", "-", "--format", "ply"][..],
        &["patches", arg(&cage), "-o", "-", "--format", "bv"],
        &["render", arg(&cage), "-o", "-", "--size", "90x60"],
        &["render", arg(&cage), "-o", "-", "--size", "90x60", "--compare", "cc,qas4", "--at", "0"],
        &["q", arg(&cage), "--json"],
        &["analyze", arg(&cage)],
    ] {
        let [before, after] = both(args);
        assert!(before != after, "{args:?}");
    }
    let [before, after] = both(&["analyze", arg(&cage), "--schemes", "cc,qas3", "--json"])
        .map(|text| serde_json::from_slice::<Value>(&text).unwrap());
    assert_eq!(before["schemes"][0], after["schemes"][0]);
    assert_ne!(before["schemes"][1]["points"][0], after["schemes"][1]["points"][0]);
    assert_eq!(before["schemes"][1]["points"][1], after["schemes"][1]["points"][1]);
}

#[test]
fn centres_of_faces_are_edited_too() {
    let list = entries(&q(NGONS, &["--json"]));
    let entry = list.iter().find(|entry| entry.get("face").is_some()).unwrap();
    let edit = json!([{"face": entry["face"], "affine": {"translation": [0.0, 0.0, 0.25]}}]);
    let (_folder, path) = file("q.json", &edit.to_string());
    let moved = entries(&q(NGONS, &["--json", "--q", arg(&path)]));
    for (before, after) in list.iter().zip(&moved) {
        if before["face"] == entry["face"] && before.get("face").is_some() {
            let [x, y, z] = [0, 1, 2].map(|k| before["center"][k].as_f64().unwrap());
            assert_close(&numbers(&after["center"]), &[x, y, z + 0.25]);
        } else {
            assert_eq!(before, after);
        }
    }
}

#[test]
fn a_quadratic_without_tangent_plane_is_warned_of_and_null_in_json() {
    let edit = json!([{"vertex": 0, "affine": {"matrix": [[0, 0, 0], [0, 0, 0], [0, 0, 0]]}}]);
    let (_folder, path) = file("q.json", &edit.to_string());
    let cage = cage(PILLOW);
    let output = run(&["q", arg(&cage), "--json", "--q", arg(&path)]);
    assert_eq!(code(&output), 0);
    let warning = format!(
        "warning: {}: entry 1: with this q there is no tangent plane at vertex 0\n",
        path.display()
    );
    assert_eq!(stderr(&output), warning);
    let printed = json(&output);
    assert!(printed[0]["normal"].is_null() && printed[0]["principal_curvatures"].is_null());
    assert!(printed[1]["normal"].is_array());
    let table = run(&["q", arg(&cage), "--q", arg(&path)]);
    let first = String::from_utf8_lossy(&table.stdout).lines().nth(1).unwrap().to_owned();
    let cells: Vec<&str> = first.split_whitespace().collect();
    assert_eq!(cells[cells.len() - 5..], ["-"; 5], "{first}");
}
