//! What the commands write stays the same byte for byte: patches, triangles and evaluations of
//! every cage in `data/meshes`, of all schemes on some, and the files of `evenlight demo`.
//!
//! `data/golden/bytes.txt` has a line per file: a hash and the command. It was written by the
//! program as it stood before topology and values were separated (commit fe5a6fc). A change that is
//! meant to change bytes writes it anew, and says so in CHANGELOG.md:
//!
//! ```sh
//! EVENLIGHT_WRITE_GOLDEN=1 cargo test --release -p evenlight-cli --test bytes
//! ```

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use common::{arg, cage, evenlight, numbers};
use serde_json::Value;

/// Cages on which all schemes are run: smooth, open, creased, with n-gons and texture coordinates.
const ALL_SCHEMES: [&str; 5] = [
    "own_polygons.obj",
    "obstacle/saddle_n7.obj",
    "features/star5_crease.obj",
    "features/uv_polygons.obj",
    "features/boundary_valences.obj",
];

/// All schemes by their names.
const SCHEMES: [&str; 13] = [
    "cc", "eg", "pas3", "pas4", "qas3", "qas4", "guided3", "guided4", "guided5", "guided6",
    "fair4", "fair4d", "fair3",
];

#[test]
fn every_command_writes_the_bytes_that_it_wrote() {
    let mut found = String::new();
    let cages = cages(&cage(""));
    let halves = cages.chunks(cages.len().div_ceil(2));
    let texts = std::thread::scope(|scope| {
        let threads: Vec<_> = halves.map(|half| scope.spawn(|| lines_of_all(half))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect::<Vec<_>>()
    });
    found.extend(texts);
    found.push_str(&demo_lines());
    compare(&found);
}

/// The names of all cages below a folder, in order.
fn cages(folder: &Path) -> Vec<String> {
    let mut paths: Vec<PathBuf> = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "obj") {
                paths.push(path);
            }
        }
    }
    let name = |path: &PathBuf| path.strip_prefix(folder).unwrap().display().to_string();
    let mut names: Vec<String> = paths.iter().map(name).collect();
    names.sort();
    names
}

fn lines_of_all(cages: &[String]) -> String {
    cages.iter().map(|cage| lines_of_cage(cage)).collect()
}

/// The hashes of one cage.
fn lines_of_cage(name: &str) -> String {
    let mut lines = lines_of_options(name, &[]);
    if ALL_SCHEMES.contains(&name) {
        for scheme in SCHEMES {
            lines.push_str(&lines_of_options(name, &["--scheme", scheme]));
            let cap = ["--scheme", scheme, "--cap", "auto", "--rings", "1"];
            lines.push_str(&lines_of_options(name, &cap));
        }
        for options in [
            &["--scheme", "guided5", "--contraction", "half"][..],
            &["--scheme", "guided3", "--contraction", "0.45"],
            &["--scheme", "qas4", "--rules", "published"],
            &["--creases", "fair"],
            &["--creases", "fair", "--cap", "bi4", "--rings", "2"],
            &["--cap", "bi4", "--rings", "0"],
            &["--boundary", "edge-only"],
        ] {
            lines.push_str(&lines_of_options(name, options));
        }
    }
    lines
}

/// The hashes of the patches, the triangles and an evaluation.
fn lines_of_options(name: &str, options: &[&str]) -> String {
    let path = cage(name);
    let mut lines = String::new();
    let mut add = |command: &str, options: &[&str], input: &[u8]| {
        let words: Vec<&str> = command.split(' ').chain(options.iter().copied()).collect();
        let (file, rest) = (arg(&path), &words[1..]);
        let output = evenlight()
            .arg(words[0])
            .arg(file)
            .args(rest)
            .args(["-o", "-", "-q"])
            .write_stdin(input)
            .output()
            .unwrap();
        // A run that is refused counts as well, by its message.
        let message = String::from_utf8_lossy(&output.stderr).replace(file, name);
        let bytes = [&output.stdout, message.as_bytes()].concat();
        writeln!(lines, "{:016x} {name} {}", hash(&bytes), words.join(" ")).unwrap();
        output.stdout
    };
    let has_rings = options.contains(&"--rings");
    let rings: &[&str] = if has_rings { &[] } else { &["--rings", "3"] };
    let patches = add("patches --format json", &[options, rings].concat(), b"");
    let points = points_in_patches(&patches);
    add("eval --points - --primvars", options, points.as_bytes());
    add("mesh --format glb --rate 4", options, b"");
    add("mesh --format ply --rate 3", options, b"");
    add("mesh --format obj --rate 2", options, b"");
    lines
}

/// A row `face,u,v,corner` inside of every patch.
fn points_in_patches(json: &[u8]) -> String {
    let mut rows = "face,u,v,corner\n".to_owned();
    let Ok(file) = serde_json::from_slice::<Value>(json) else { return rows };
    for patch in file["patches"].as_array().unwrap() {
        let domain = numbers(&patch["domain"]);
        let [u, v] = [0, 2].map(|k| domain[k] + 0.375 * (domain[k + 1] - domain[k]));
        let corner = patch["corner"].as_u64().unwrap_or(0);
        writeln!(rows, "{},{u},{v},{corner}", patch["face"]).unwrap();
    }
    rows
}

/// The hashes of the files of the demonstration.
fn demo_lines() -> String {
    let folder = tempfile::tempdir().unwrap();
    evenlight().args(["demo", arg(folder.path()), "-q"]).assert().success();
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let line = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap();
        format!("{:016x} demo {name}\n", hash(&fs::read(path).unwrap()))
    };
    files.iter().map(line).collect()
}

/// FNV-1a, 64 bits.
fn hash(bytes: &[u8]) -> u64 {
    let step = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step)
}

fn compare(found: &str) {
    let path = cage("../golden/bytes.txt");
    if std::env::var_os("EVENLIGHT_WRITE_GOLDEN").is_some() {
        fs::write(path, found).unwrap();
        return;
    }
    let expected = fs::read_to_string(path).unwrap();
    let mut differing = Vec::new();
    for (found, expected) in found.lines().zip(expected.lines()) {
        if found != expected {
            differing.push(format!("{found}\n  was {expected}"));
        }
    }
    assert_eq!(found.lines().count(), expected.lines().count(), "the list of commands changed");
    assert!(differing.is_empty(), "{} differ:\n{}", differing.len(), differing.join("\n"));
}
