//! Output files are written whole or not at all; `-` is stdin and stdout.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::fs;
use std::path::Path;

use common::{CONE, PILLOW, arg, cage, code, evenlight, run, run_on, stderr, stdout};

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_run_that_succeeds_leaves_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("surface.bv");
    fs::write(&file, "old").unwrap();
    let pillow = cage(PILLOW);
    assert_eq!(stdout(&run(&["patches", arg(&pillow), "-o", arg(&file)])), "");
    assert!(fs::read_to_string(&file).unwrap().starts_with("Group"));
    assert_eq!(names(folder.path()), ["surface.bv"]);
}

#[test]
fn a_run_that_fails_leaves_the_old_file_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("out.csv");
    fs::write(&file, "old").unwrap();
    let pillow = cage(PILLOW);
    let output = run_on("0,0.5,7\n", &["eval", arg(&pillow), "--points", "-", "-o", arg(&file)]);
    assert_eq!(code(&output), 1);
    assert_eq!(fs::read_to_string(&file).unwrap(), "old");
    assert_eq!(names(folder.path()), ["out.csv"]);
}

#[test]
fn a_folder_that_is_not_there_is_exit_code_1_and_named() {
    let pillow = cage(PILLOW);
    for file in ["no/such/folder/a.bv", "no/such/folder/a.json"] {
        let output = run(&["patches", arg(&pillow), "-o", file]);
        assert_eq!(code(&output), 1);
        let expected =
            format!("error: {file}: the folder no/such/folder does not exist: create it\n");
        assert_eq!(stderr(&output), expected);
    }
}

#[test]
fn a_folder_is_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("folder.obj");
    fs::create_dir(&target).unwrap();
    let pillow = cage(PILLOW);
    let output = run(&["mesh", arg(&pillow), "-o", arg(&target)]);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("folder.obj"));
    assert_eq!(names(folder.path()), ["folder.obj"]);
}

#[cfg(unix)]
#[test]
fn what_cannot_be_written_in_full_is_not_written() {
    // The limit on the size of files makes a write fail in the middle, as a full disk does.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("surface.json");
    fs::write(&file, "old").unwrap();
    let script = r#"trap '' XFSZ; ulimit -f 8; exec "$0" patches "$1" -o "$2""#;
    let pillow = cage(PILLOW);
    let output = assert_cmd::Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_evenlight"), arg(&pillow), arg(&file)])
        .output()
        .unwrap();
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("surface.json: "), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(&file).unwrap(), "old");
    assert_eq!(names(folder.path()), ["surface.json"]);
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_and_permissions_stay() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let (file, link) = (folder.path().join("file.bv"), folder.path().join("link.bv"));
    fs::write(&file, "old").unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    let pillow = cage(PILLOW);
    stdout(&run(&["patches", arg(&pillow), "-o", arg(&link)]));
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_ne!(fs::read_to_string(&file).unwrap(), "old");
    assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
}

#[cfg(unix)]
#[test]
fn a_device_is_written_to_and_not_replaced() {
    let pillow = cage(PILLOW);
    stdout(&run(&["patches", arg(&pillow), "-o", "/dev/null", "--format", "bv"]));
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[test]
fn dash_reads_stdin_and_writes_stdout() {
    let pillow = cage(PILLOW);
    let text = fs::read_to_string(&pillow).unwrap();
    let piped = run_on(&text, &["patches", "-", "-o", "-", "--format", "bv"]);
    let named = run(&["patches", arg(&pillow), "-o", "-", "--format", "bv"]);
    assert_eq!(stdout(&piped), stdout(&named));
}

#[cfg(unix)]
#[test]
fn a_reader_that_leaves_early_is_no_error() {
    let script = r#""$0" patches "$1" -o - --format bv | head -n 1; exit ${PIPESTATUS[0]}"#;
    let pillow = cage(PILLOW);
    let output = assert_cmd::Command::new("bash")
        .args(["-c", script, env!("CARGO_BIN_EXE_evenlight"), arg(&pillow)])
        .output()
        .unwrap();
    assert!(stdout(&output).starts_with("Group 0 regular"));
}

#[test]
fn quiet_silences_the_bar_but_no_warning() {
    let cone = cage(CONE);
    let output =
        run(&["mesh", arg(&cone), "-o", "-", "--format", "obj", "--quiet", "--boundary=none"]);
    assert_eq!(code(&output), 0);
    let expected = "25 of 45 faces are left out (holes, or at the boundary under the rule none)\n";
    assert!(stderr(&output).starts_with("warning: ") && stderr(&output).ends_with(expected));
}

#[test]
fn a_cage_without_inner_faces_gives_nothing() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    let args = ["mesh", "-", "-o", "-", "--format", "obj", "--boundary", "none"];
    let output = run_on(square, &args);
    assert_eq!((code(&output), output.stdout.len()), (1, 0));
    assert!(stderr(&output).contains("the only face is left out"));
    assert_eq!(code(&run_on(square, &args[..6])), 0, "it has one by the other rules");
}

#[test]
fn one_face_is_left_out_and_two_are() {
    let strip = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 3 1 0\n\
                 f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n";
    for (holes, expected) in
        [("1/0/0 1", "1 of 3 faces is left out"), ("2/0/0 0 1", "2 of 3 faces are")]
    {
        let output = run_on(&format!("{strip}t hole {holes}\n"), &["check", "-"]);
        assert_eq!(code(&output), 0);
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
    }
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let pillow = cage(PILLOW);
    let with = |threads: &str| {
        let args = ["mesh", arg(&pillow), "-o", "-", "--format", "ply", "--threads", threads];
        evenlight().args(args).output().unwrap().stdout
    };
    assert!(with("1") == with("3"));
}
