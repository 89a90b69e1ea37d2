//! What the tests of the command line share.

#![allow(dead_code, reason = "each test file uses a part of it")]

use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;

/// A closed cage of quads with 150 faces: two vertices of valence 5 and ten of valence 3.
pub const PILLOW: &str = "obstacle/pillow_n5.obj";

/// An open cage: 45 faces around one vertex of valence 5, of which 25 touch the boundary.
pub const CONE: &str = "obstacle/cone_flat_n5.obj";

/// A cube, whose eight vertices have valence 3.
pub const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n\
    v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// A tetrahedron: four triangles.
pub const TETRAHEDRON: &str =
    "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// The short names of all schemes.
pub const SCHEMES: [&str; 6] = ["cc", "eg", "pas3", "pas4", "qas3", "qas4"];

/// The path of one of the project's test cages.
pub fn cage(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/meshes").join(name)
}

/// The program under test.
pub fn evenlight() -> Command {
    Command::new(env!("CARGO_BIN_EXE_evenlight"))
}

/// Runs it with `args`.
pub fn run(args: &[&str]) -> Output {
    evenlight().args(args).output().unwrap()
}

/// Runs it with `input` on stdin.
pub fn run_on(input: &str, args: &[&str]) -> Output {
    evenlight().args(args).write_stdin(input).output().unwrap()
}

/// The exit code.
pub fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

/// What was written to stdout by a run that must be good and silent.
pub fn stdout(output: &Output) -> String {
    assert_eq!((stderr(output).as_str(), code(output)), ("", 0));
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// What was written to stderr.
pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// The JSON on stdout.
pub fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

/// All numbers in `value`, in order.
pub fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Number(x) => vec![x.as_f64().unwrap()],
        Value::Array(values) => values.iter().flat_map(numbers).collect(),
        Value::Object(values) => values.values().flat_map(numbers).collect(),
        _ => Vec::new(),
    }
}

/// A file with `text` in a folder of its own, which lives as long as the first of the two.
pub fn file(name: &str, text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

/// `path` as an argument.
pub fn arg(path: &Path) -> &str {
    path.to_str().unwrap()
}
