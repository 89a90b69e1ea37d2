//! `evenlight demo`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use common::{arg, evenlight, run, stdout};
use serde_json::json;

const FILES: [&str; 19] = [
    "analyze.json",
    "cage.obj",
    "check.json",
    "edit.json",
    "edited.png",
    "gauss.png",
    "highlight.png",
    "mean.png",
    "mesh.obj",
    "mesh.ply",
    "mesh.stl",
    "patches.bv",
    "patches.json",
    "patches.png",
    "points-evaluated.csv",
    "points.csv",
    "q.json",
    "report.md",
    "shaded.png",
];

fn demo(folder: &Path) -> String {
    stdout(&run(&["demo", arg(folder), "--size", "48x36"]))
}

fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    entries.map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap())).collect()
}

/// The commands in a report, without the program's name.
fn commands(report: &str) -> Vec<Vec<String>> {
    let quoted = report.split('`').skip(1).step_by(2);
    let commands = quoted.filter_map(|text| text.strip_prefix("evenlight "));
    commands.map(|command| command.split(' ').map(str::to_owned).collect()).collect()
}

#[test]
fn every_file_is_there_reported_and_reproducible() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("new/folder");
    let summary = demo(&place);
    let first = contents(&place);
    assert!(FILES.iter().all(|file| first.contains_key(*file)), "{:?}", first.keys());
    assert!(summary.contains(&format!("{} files in {}", first.len(), place.display())));

    let report = String::from_utf8(first["report.md"].clone()).unwrap();
    for file in first.keys().filter(|file| *file != "report.md") {
        assert!(report.contains(&format!("[{file}]({file})")), "{file}");
        assert_eq!(report.contains(&format!("]({file})\n")), file.ends_with(".png"), "{file}");
    }
    assert!(!report.contains(arg(&place)), "the report is the same in any folder");

    // Each command of the report, in an otherwise empty folder, gives the same bytes.
    let again = tempfile::tempdir().unwrap();
    for file in ["cage.obj", "points.csv", "edit.json", "report.md"] {
        fs::write(again.path().join(file), &first[file]).unwrap();
    }
    for command in commands(&report) {
        evenlight().args(command).current_dir(again.path()).assert().success();
    }
    let second = contents(again.path());
    assert_eq!(first.keys().collect::<Vec<_>>(), second.keys().collect::<Vec<_>>());
    assert!(first.iter().all(|(file, bytes)| second[file] == *bytes));
}

#[test]
fn the_cage_has_interior_vertices_of_valence_3_5_6_and_8_with_a_picture_each() {
    let folder = tempfile::tempdir().unwrap();
    demo(folder.path());
    let text = fs::read(folder.path().join("check.json")).unwrap();
    let check: serde_json::Value = serde_json::from_slice(&text).unwrap();
    assert_eq!((&check["boundary_edges"], &check["components"]), (&0.into(), &1.into()));
    assert_eq!((&check["ngons"], &check["warnings"]), (&json!({}), &json!([])));
    let valences: Vec<&String> = check["valences"].as_object().unwrap().keys().collect();
    assert_eq!(valences, ["3", "4", "5", "6", "8"]);
    // Isolated in the cage itself: rings as large as faces, and pictures that show them.
    let points = check["extraordinary"].as_array().unwrap();
    assert!(points.iter().all(|point| point["level"] == 0 && point["has_surface"] == true));
    for valence in [3, 5, 6, 8] {
        assert!(folder.path().join(format!("highlight-valence-{valence}.png")).is_file());
    }
    assert!(folder.path().join("mean-valence-8.png").is_file());
}

#[test]
fn a_second_run_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let one = (demo(folder.path()), contents(folder.path()));
    let two = (demo(folder.path()), contents(folder.path()));
    assert!(one == two);
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let output = run(&["demo", arg(&file.join("below"))]);
    assert_eq!(common::code(&output), 1);
    assert!(common::stderr(&output).contains(arg(&file)));
}
