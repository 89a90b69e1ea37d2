//! Files for `--q` that cannot be used.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::path::Path;

use common::{CUBE, PILLOW, arg, cage, code, file, run, run_on, stderr};

/// Six points of a legal quadratic.
const SIX: &str = "[[0,0,0],[1,0,0],[2,0,0],[0,1,0],[1,1,0],[0,2,0]]";

/// What is said of a file that is refused; it must cost no output.
fn fault(cage_name: &str, text: &str) -> String {
    fault_on(&cage(cage_name), text)
}

fn fault_on(cage: &Path, text: &str) -> String {
    fault_by_rule(cage, text, "edge-and-corner")
}

fn fault_by_rule(cage: &Path, text: &str, boundary: &str) -> String {
    let (_folder, path) = file("q.json", &text.replace("SIX", SIX));
    let args = ["mesh", arg(cage), "-o", "-", "--format", "obj", "--q", arg(&path), "--boundary"];
    let output = run(&[&args[..], &[boundary]].concat());
    assert_eq!((code(&output), output.stdout.len()), (1, 0), "{text}");
    let all = stderr(&output);
    let last = all.lines().last().unwrap();
    let prefix = format!("error: {}: ", path.display());
    last.strip_prefix(&prefix).unwrap_or_else(|| panic!("{last}")).to_owned()
}

#[test]
fn text_that_is_no_list_is_refused_with_its_line() {
    for (text, place) in [
        ("", "line 1 column 0"),
        ("7", "line 1 column 1"),
        ("[{\"vertex\": 0, \"affine\": {}}", "EOF while parsing a list at line 1"),
        ("[\n{\"vertex\": nan}]", "line 2 column"),
        ("{\"quadratics\": []}", "unknown field `quadratics`"),
        ("{}", "missing field `points`"),
        ("[] []", "trailing characters at line 1 column 4"),
    ] {
        let message = fault(PILLOW, text);
        let start = "this is no list of quadratics, nor {\"points\": [...]} with one: ";
        assert!(message.starts_with(start) && message.contains(place), "{message}");
    }
}

#[test]
fn entries_that_cannot_be_understood_are_numbered() {
    let good = "{\"vertex\": 0, \"affine\": {}}";
    for (entry, message) in [
        ("[0]", "[0] is no object {\"vertex\": ..., ...}"),
        ("{\"affine\": {}}", "give either vertex or face, the number of the point from 0"),
        ("{\"vertex\": 1, \"face\": 1, \"affine\": {}}", "give either vertex or face"),
        ("{\"vertex\": -1, \"affine\": {}}", "vertex is -1, no number counted from 0"),
        ("{\"vertex\": 1.5, \"affine\": {}}", "vertex is 1.5, no number counted from 0"),
        ("{\"face\": \"a\", \"affine\": {}}", "face is \"a\", no number counted from 0"),
        ("{\"vertex\": 4294967296, \"affine\": {}}", "vertex is 4294967296, no number"),
        ("{\"vertex\": 1}", "give one of affine, coefficients and sectors"),
        ("{\"vertex\": 1, \"affine\": {}, \"coefficients\": SIX}", "give one of affine"),
        ("{\"vertex\": 1, \"matrix\": []}", "unknown field `matrix`, expected one of `vertex`"),
        ("{\"vertex\": 1, \"vertex\": 1, \"affine\": {}}", "duplicate field `vertex`"),
        ("{\"vertex\": 1, \"affine\": []}", "affine is an object with matrix, translation or"),
        ("{\"vertex\": 1, \"affine\": {\"scale\": 2}}", "affine: unknown field `scale`, expected"),
    ] {
        let text = fault(PILLOW, &format!("[{good}, {entry}]"));
        assert!(text.starts_with(&format!("entry 2: {message}")), "{text}");
    }
}

#[test]
fn numbers_that_are_none_or_too_few_are_named_by_their_places() {
    for (key, value, message) in [
        ("coefficients", "7", "coefficients is 7, no list"),
        ("coefficients", "[]", "coefficients has 0 items; it needs 6 points, q_1 to q_6"),
        ("coefficients", "[[0,0,0],[0,0],0,0,0,0]", "coefficients[1] has 2 items; it needs 3"),
        ("coefficients", "[[0,0,0],[0,null,0]]", "coefficients[1][1] is null, no finite number"),
        ("coefficients", "[[0,0,\"1\"]]", "coefficients[0][2] is \"1\", no finite number"),
        ("coefficients", "[[0,0,1e999]]", "number out of range"),
        ("sectors", "[SIX, [[0,0,0]]]", "sectors[1] has 1 items; it needs 6 points, q_1 to q_6"),
        ("affine", "{\"matrix\": [[1,0,0],[0,1,0]]}", "affine.matrix has 2 items; it needs 3 rows"),
        ("affine", "{\"matrix\": [[1,0],2,3]}", "affine.matrix[0] has 2 items; it needs 3 numbers"),
        ("affine", "{\"translation\": 1}", "affine.translation is 1, no list"),
    ] {
        let text = fault(PILLOW, &format!("[{{\"vertex\": 0, \"{key}\": {value}}}]"));
        assert!(text.starts_with(&format!("entry 1: {message}")), "{text}");
    }
}

#[test]
fn a_long_fault_is_cut_short() {
    let list = "0,".repeat(500) + "0";
    let text = fault(PILLOW, &format!("[{{\"vertex\": [{list}], \"affine\": {{}}}}]"));
    assert!(text.contains("vertex is [0,0,") && text.len() < 120, "{text}");
}

#[test]
fn points_that_are_not_on_the_surface_are_told_why() {
    let only = "only extraordinary vertices, and centres of faces that are no quads, have a q \
                ('evenlight q' lists them)";
    for (name, place, message) in [
        (PILLOW, "\"vertex\": 152", "there is no vertex 152: the cage has the vertices 0 to 151"),
        (PILLOW, "\"vertex\": 1", &format!("vertex 1 has valence 4: {only}")),
        (PILLOW, "\"face\": 150", "there is no face 150: the cage has the faces 0 to 149"),
        (PILLOW, "\"face\": 3", &format!("face 3 is a quad: {only}")),
    ] {
        let text = fault(name, &format!("[{{{place}, \"coefficients\": SIX}}]"));
        assert_eq!(text, format!("entry 1: {message}"));
    }
}

/// A cube, vertex 8 in no face, three quads around vertex 9, and a pentagon.
fn with_open_pieces() -> String {
    let mut text = CUBE.to_owned();
    for k in 0..13 {
        text += &format!("v {k} {} 7\n", k * k);
    }
    text + "f 10 11 12 13\nf 10 13 14 15\nf 10 15 16 11\nf 17 18 19 20 21\n"
}

#[test]
fn points_without_a_surface_are_told_why() {
    let (_folder, path) = file("cage.obj", &with_open_pieces());
    for (place, message) in [
        ("\"vertex\": 8", "vertex 8 is in no face: take one that is"),
        ("\"vertex\": 9", "all faces at vertex 9 are left out (holes, or at"),
        ("\"vertex\": 10", "all faces at vertex 10 are left out (holes, or at"),
        ("\"vertex\": 21", "there is no vertex 21: the cage has the vertices 0 to 20"),
        ("\"face\": 9", "face 9 is left out (holes, or at the boundary under the rule none): take"),
    ] {
        let text = format!("[{{{place}, \"affine\": {{}}}}]");
        let text = fault_by_rule(&path, &text, "none");
        assert!(text.starts_with(&format!("entry 1: {message}")), "{text}");
    }
}

#[test]
fn a_point_is_given_once_with_as_many_sectors_as_it_has() {
    let twice = "[{\"vertex\": 0, \"affine\": {}}, {\"vertex\": 12, \"affine\": {}}, \
                 {\"vertex\": 0, \"coefficients\": SIX}]";
    let expected = "entry 3: vertex 0 is that of entry 1 too: keep one of the two";
    assert_eq!(fault(PILLOW, twice), expected);
    let text = fault(PILLOW, "[{\"vertex\": 0, \"sectors\": [SIX, SIX, SIX, SIX]}]");
    let expected = "entry 1: sectors has 4 lists, but the point has valence 5: give one per sector";
    assert_eq!(text, expected);
}

#[test]
fn numbers_that_overflow_are_refused() {
    let text = "[{\"vertex\": 0, \"coefficients\": \
                [[1e308,0,0],[-1e308,0,0],[2,0,0],[0,1,0],[1,1,0],[0,2,0]]}]";
    assert_eq!(fault(PILLOW, text), "entry 1: the numbers are too large to compute with");
}

#[test]
fn schemes_without_a_quadratic_are_wrong_usage_before_anything_is_read() {
    for args in [
        &["mesh", "no.obj", "-o", "-", "--format", "obj", "--scheme", "cc"][..],
        &["patches", "no.obj", "-o", "a.bv", "--scheme", "eg"],
        &["eval", "no.obj", "--points", "no.csv", "--scheme", "pas3"],
        &["render", "no.obj", "-o", "a.png", "--compare", "cc,pas4"],
        &["analyze", "no.obj", "--schemes", "cc,eg"],
        &["q", "no.obj", "--scheme", "eg"],
    ] {
        let output = run(&[args, &["--q", "no.json"]].concat());
        assert_eq!((code(&output), output.stdout.len()), (2, 0), "{args:?}");
        let text = stderr(&output);
        assert!(text.contains("no quadratic; choose --scheme qas3 or qas4"), "{args:?}: {text}");
    }
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let cage = cage(PILLOW);
    let output = run(&["analyze", arg(&cage), "--q", "no/such/q.json"]);
    assert_eq!((code(&output), output.stdout.len()), (1, 0));
    assert!(stderr(&output).starts_with("error: no/such/q.json: "));
}

#[test]
fn the_file_can_be_stdin() {
    let cage = cage(PILLOW);
    let output = run_on("[{\"vertex\": 1, \"affine\": {}}]", &["q", arg(&cage), "--q", "-"]);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).starts_with("error: stdin: entry 1: vertex 1 has valence 4: "));
}
