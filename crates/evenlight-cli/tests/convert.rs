//! `evenlight convert`, and that every command takes every kind of cage file.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::fs;

use common::{CONE, CUBE, PILLOW, arg, cage, code, evenlight, run, run_on, stderr, stdout};

#[test]
fn a_cage_comes_back_from_every_format_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in [PILLOW, CONE] {
        let original = cage(name);
        let obj = path("a.obj");
        assert_eq!(stdout(&run(&["convert", arg(&original), arg(&obj)])), "");
        for (other, flags) in [("a.ply", &[][..]), ("b.ply", &["--ascii"]), ("c.usda", &[])] {
            let (other, back) = (path(other), path("back.obj"));
            stdout(&run(&[&["convert", arg(&obj), arg(&other)], flags].concat()));
            stdout(&run(&["convert", arg(&other), arg(&back)]));
            assert_eq!(fs::read(&back).unwrap(), fs::read(&obj).unwrap());
        }
    }
}

#[test]
fn every_command_reads_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let obj = cage(PILLOW);
    for name in ["pillow.ply", "pillow.usda"] {
        let other = folder.path().join(name);
        stdout(&run(&["convert", arg(&obj), arg(&other)]));
        for command in ["check", "analyze", "q"] {
            let expected = stdout(&run(&[command, arg(&obj), "--json"]));
            let found = stdout(&run(&[command, arg(&other), "--json"]));
            assert!(!expected.is_empty());
            assert_eq!(found.replace(arg(&other), arg(&obj)), expected, "{command}");
        }
        let mesh = |path| run(&["mesh", arg(path), "-o", "-", "--format", "obj"]);
        assert_eq!(stdout(&mesh(&other)), stdout(&mesh(&obj)));
    }
}

#[test]
fn stdin_is_recognised_by_its_content() {
    let ply = run_on(CUBE, &["convert", "-", "-", "--format", "ply", "--ascii"]);
    let text = stdout(&ply);
    assert!(text.starts_with("ply\nformat ascii 1.0\n"), "{text}");
    let back = run_on(&text, &["convert", "-", "-", "--format", "obj"]);
    assert_eq!(stdout(&back), CUBE);
    let bytes = run_on(CUBE, &["convert", "-", "-", "--format", "ply"]).stdout;
    let output = evenlight().args(["check", "-"]).write_stdin(bytes).output().unwrap();
    assert!(stdout(&output).starts_with("stdin: can be used"));
}

#[test]
fn what_a_format_cannot_hold_is_said() {
    let tagged = CUBE.to_owned() + "t crease 2/1/0 0 1 2\n";
    let output = run_on(&tagged, &["convert", "-", "-", "--format", "ply"]);
    assert_eq!(code(&output), 0);
    let warning = "warning: stdout: PLY has no place for creases, corners, holes and rules";
    assert!(stderr(&output).starts_with(warning), "{}", stderr(&output));
    for format in ["obj", "usda"] {
        let kept = stdout(&run_on(&tagged, &["convert", "-", "-", "--format", format]));
        let back = run_on(&kept, &["convert", "-", "-", "--format", "obj"]);
        assert_eq!(stdout(&back), tagged);
    }
}

#[test]
fn faults_are_told_in_the_terms_of_the_file() {
    let output = run_on("ply\nformat ascii 1.0\nelement vertex 1\n", &["check", "-"]);
    assert_eq!(code(&output), 1);
    assert_eq!(
        stderr(&output),
        "error: stdin: line 3: the header has no end: add the line `end_header`\n"
    );
    let folder = tempfile::tempdir().unwrap();
    let output = run(&["convert", arg(&cage(CONE)), arg(&folder.path().join("a.stl"))]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("it can be .obj, .ply, .usda"), "{}", stderr(&output));
}

#[test]
fn a_mesh_of_several_in_a_usd_file_is_chosen_by_its_path() {
    let one = stdout(&run_on(CUBE, &["convert", "-", "-", "--format", "usda"]));
    let (_, mesh) = one.split_once("\ndef").unwrap();
    let two = one.clone() + "\ndef" + &mesh.replace("\"Cage\"", "\"Other\"");
    let (_folder, path) = common::file("two.usda", &two);
    let output = run(&["check", arg(&path)]);
    assert_eq!(code(&output), 1);
    let expected = "there are 2 meshes (/Cage, /Other): choose one by its path (--prim)";
    assert!(stderr(&output).contains(expected), "{}", stderr(&output));
    let chosen = run(&["convert", "--prim", "/Other", arg(&path), "-", "--format", "obj"]);
    assert_eq!(stdout(&chosen), CUBE);
    let output = run_on(CUBE, &["check", "-", "--prim", "/Other"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("--prim is for USD files only"), "{}", stderr(&output));
}

#[test]
fn what_obj_says_beyond_a_cage_is_told_in_one_line() {
    let text = CUBE.replace("f 1 4", "g a\nvn 0 0 1\nusemtl b\ns 1\no c\nf 1 4");
    let expected = "warning: stdin: line 9 and 4 more: objects, groups, smoothing groups, materials \
                    and normals (o, g, s, usemtl, vn) are not kept\n";
    for words in [
        &["convert", "-", "-", "--format", "obj"][..],
        &["mesh", "-", "-o", "-", "--format", "obj", "--rate", "1"],
        &["check", "-"],
    ] {
        let output = run_on(&text, words);
        assert_eq!((code(&output), stderr(&output).as_str()), (0, expected), "{words:?}");
    }
}

#[test]
fn files_of_another_kind_than_their_name_says_are_told_so() {
    let ply = stdout(&run_on(CUBE, &["convert", "-", "-", "--format", "ply", "--ascii"]));
    for (name, text, expected) in [
        (
            "a.obj",
            ply.as_str(),
            "line 1: the file is read as OBJ, but it looks like PLY: let its name end in .ply\n\
             note: it is read as OBJ because of its name\n",
        ),
        (
            "a.ply",
            CUBE,
            "line 1: the file does not begin with the line `ply`: it looks like OBJ: let its name \
             end in .obj\n",
        ),
        (
            "a.fbx",
            "Kaydara FBX Binary  ",
            "line 1: the file is read as OBJ, but it looks like FBX, which is not read: convert it \
             to one of OBJ, PLY, USD\n",
        ),
        (
            "a.txt",
            "1 2 3\n",
            "there are no faces (0 vertices): give the mesh its faces\n\
             note: line 1 is ignored: the tag `1` is not supported\n\
             note: it is read as OBJ, since neither its name nor its beginning tells what it is; the \
             names of cages end in .obj, .ply, .usda\n",
        ),
    ] {
        let (_folder, path) = common::file(name, text);
        let (check, mesh) = (["check", arg(&path)], ["mesh", arg(&path), "-o", "a.stl"]);
        for words in [&check[..], &mesh] {
            let output = run(words);
            let lines: Vec<String> = stderr(&output)
                .lines()
                .filter(|line| !line.starts_with("warning: "))
                .map(|line| format!("{line}\n"))
                .collect();
            assert_eq!(code(&output), 1);
            assert_eq!(lines.concat(), format!("error: {}: {expected}", arg(&path)));
        }
    }
    // The beginning tells, where the name does not.
    let (_folder, path) = common::file("a.txt", &ply);
    assert_eq!(code(&run(&["check", arg(&path)])), 0);
}
