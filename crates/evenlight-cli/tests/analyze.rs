//! `evenlight analyze`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use common::{
    CONE, CUBE, PILLOW, SCHEMES, TETRAHEDRON, arg, cage, code, json, run, run_on, stderr, stdout,
};
use serde_json::{Value, json};

fn pillow(args: &[&str]) -> Value {
    let pillow = cage(PILLOW);
    json(&run(&[&["analyze", arg(&pillow), "--json"], args].concat()))
}

fn points(scheme: &Value) -> &[Value] {
    scheme["points"].as_array().unwrap()
}

#[test]
fn there_is_a_record_per_vertex_and_scheme_over_rings_1_to_6() {
    let document = pillow(&[]);
    let schemes = document["schemes"].as_array().unwrap();
    assert_eq!((&schemes[0]["scheme"], &schemes[1]["scheme"]), (&json!("cc"), &json!("qas4")));
    for point in schemes.iter().flat_map(points) {
        assert!(point["vertex"].is_u64() && point["face"].is_null());
        let rings = point["rings"].as_array().unwrap();
        assert_eq!(rings.iter().map(|r| &r["ring"]).collect::<Vec<_>>(), [1, 2, 3, 4, 5, 6]);
    }
    assert!(schemes.iter().all(|scheme| points(scheme).len() == 12));
}

#[test]
fn ranges_of_a_point_are_those_of_its_rings_together() {
    let document = pillow(&["--schemes", "eg", "--rings", "3"]);
    for point in points(&document["schemes"][0]) {
        for quantity in ["gauss", "mean"] {
            let ends = |key: &str| -> Vec<f64> {
                let rings = point["rings"].as_array().unwrap().iter();
                rings.map(|ring| ring[quantity][key].as_f64().unwrap()).collect()
            };
            let least = ends("min").into_iter().fold(f64::MAX, f64::min);
            let largest = ends("max").into_iter().fold(f64::MIN, f64::max);
            assert_eq!(point[quantity], json!({"min": least, "max": largest}));
        }
    }
}

#[test]
fn all_schemes_join_their_patches_with_continuous_curvature() {
    let document = pillow(&["--schemes", &SCHEMES.join(",")]);
    assert_eq!(document["schemes"].as_array().unwrap().len(), SCHEMES.len());
    for scheme in document["schemes"].as_array().unwrap() {
        for jumps in points(scheme).iter().map(|p| &p["jumps"]).chain([&scheme["jumps"]]) {
            assert!(jumps["position"].as_f64().unwrap() < 1e-13);
            assert!(jumps["tangent_plane"].as_f64().unwrap() < 1e-12);
            assert!(jumps["curvature"].as_f64().unwrap() < 1e-9);
        }
        let between_rings = points(scheme).iter().map(|p| &p["mean_jump_across_rings"]);
        assert!(between_rings.into_iter().all(|jump| jump.as_f64().unwrap() < 1e-9));
    }
}

#[test]
fn curvature_settles_with_all_schemes_but_cc() {
    let document = pillow(&["--schemes", &SCHEMES.join(",")]);
    for scheme in document["schemes"].as_array().unwrap() {
        let point = points(scheme).iter().find(|p| p["valence"] == 5).unwrap();
        let growth = point["mean_span_growth"].as_f64().unwrap();
        if scheme["scheme"] == "cc" {
            assert!(growth > 0.5, "{growth}");
        } else {
            assert!(growth < 0.2, "{}: {growth}", scheme["scheme"]);
        }
    }
}

#[test]
fn oscillation_and_energy_are_measured_in_units_that_schemes_share() {
    let document = pillow(&["--schemes", "cc,qas4"]);
    let [cc, qas4] = [0, 1].map(|k| points(&document["schemes"][k]));
    for (a, b) in cc.iter().zip(qas4) {
        let both = |key: &str| [a, b].map(|p| p[key].as_f64().unwrap());
        let [of_cc, of_qas4] = both("curvature_scale");
        assert!(of_cc > 0.0 && (of_qas4 / of_cc - 1.0).abs() < 1e-9);
        for key in ["mean_oscillation_along_rays", "mean_oscillation_around_rings", "shape_energy"]
        {
            assert!(both(key).into_iter().all(|x| x >= 0.0), "{key}");
        }
        let [of_cc, of_qas4] = both("shape_energy");
        assert!(of_qas4 < of_cc);
    }
    // At the vertex of valence 5 the highlight lines of Catmull-Clark are pinched.
    for key in ["mean_oscillation_along_rays", "mean_oscillation_around_rings"] {
        let [of_cc, of_qas4] = [cc, qas4].map(|points| points[0][key].as_f64().unwrap());
        assert!(of_qas4 < 0.2 * of_cc, "{key}: {of_cc}, {of_qas4}");
    }
}

#[test]
fn the_table_has_a_line_per_point_and_scheme() {
    let text = stdout(&run_on(CUBE, &["analyze", "-"]));
    let lines = |scheme: &str| {
        text.lines().filter(|l| l.starts_with("vertex") && l.contains(scheme)).count()
    };
    assert_eq!((lines(" cc "), lines(" qas4 ")), (8, 8));
    for column in ["K min", "K max", "H min", "H max", "growth", "along rays", "around rings"] {
        assert!(text.lines().next().unwrap().contains(column), "{column}");
    }
    for column in ["energy", "H jump"] {
        assert!(text.lines().next().unwrap().contains(column), "{column}");
    }
    let jumps = text.lines().find(|line| line.starts_with("all borders")).unwrap();
    for column in ["position jump", "tangent jump", "curvature jump"] {
        assert!(jumps.contains(column), "{column}");
    }
}

#[test]
fn the_table_is_short_unless_all_points_are_asked_for() {
    let blob = cage("own_blob_quadriflow_300.obj");
    let rows = |args: &[&str]| {
        let text = stdout(&run(args));
        assert_eq!(text.contains("12 of 34 points; all of them with --all"), args.len() == 2);
        text.lines().filter(|line| line.starts_with("vertex")).count()
    };
    assert_eq!(rows(&["analyze", arg(&blob)]), 2 * 12);
    assert_eq!(rows(&["analyze", arg(&blob), "--all"]), 2 * 34);
}

#[test]
fn centres_of_n_gons_are_points_too() {
    let document = json(&run_on(TETRAHEDRON, &["analyze", "-", "--json", "--schemes", "cc"]));
    let points = points(&document["schemes"][0]);
    assert_eq!(points.len(), 8);
    assert!(points[4..].iter().all(|p| p["vertex"].is_null() && p["face"].is_u64()));
}

#[test]
fn open_cages_are_analysed_where_they_have_a_surface() {
    let cone = cage(CONE);
    let output = run(&["analyze", arg(&cone), "--json"]);
    assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
    assert_eq!(points(&json(&output)["schemes"][0]).len(), 1);
    let output = run(&["analyze", arg(&cone), "--json", "--boundary", "none"]);
    assert_eq!(code(&output), 0);
    assert_eq!(points(&json(&output)["schemes"][0]).len(), 1);
    assert_eq!(stderr(&output).matches("left out").count(), 1);
}

#[test]
fn the_report_can_be_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("report.json");
    assert_eq!(stdout(&run_on(CUBE, &["analyze", "-", "--json", "-o", arg(&file)])), "");
    let text = std::fs::read_to_string(&file).unwrap();
    assert_eq!(text, stdout(&run_on(CUBE, &["analyze", "-", "--json"])));
}
