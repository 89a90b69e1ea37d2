//! `evenlight render`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::fs;

use common::{PILLOW, arg, cage, code, run, stderr, stdout};

/// The bytes of a picture of the pillow.
fn picture(args: &[&str]) -> Vec<u8> {
    let pillow = cage(PILLOW);
    let fixed = ["render", arg(&pillow), "-o", "-", "--samples", "1"];
    let output = run(&[&fixed[..], args].concat());
    assert_eq!((stderr(&output).as_str(), code(&output)), ("", 0));
    assert!(output.stdout.starts_with(b"\x89PNG\r\n"));
    output.stdout
}

/// Width and height in the header of a PNG file.
fn size(png: &[u8]) -> [u32; 2] {
    [16, 20].map(|at| u32::from_be_bytes(png[at..at + 4].try_into().unwrap()))
}

const SMALL: [&str; 2] = ["--size", "120x90"];

#[test]
fn pictures_have_the_size_that_is_asked_for() {
    assert_eq!(size(&picture(&SMALL)), [120, 90]);
    assert_eq!(size(&picture(&["--size", "50x70", "--compare", "cc,eg"])), [50, 70]);
}

#[test]
fn every_style_and_scheme_gives_another_picture() {
    let mut pictures = Vec::new();
    for style in ["shaded", "highlight", "gauss", "mean", "patches"] {
        for scheme in ["cc", "eg", "qas3", "qas4"] {
            let args = ["--size", "120x90", "--at", "0", "--zoom", "2", "--scheme", scheme];
            pictures.push(picture(&[&args[..], &["--style", style]].concat()));
        }
    }
    for (k, a) in pictures.iter().enumerate() {
        assert!(pictures[..k].iter().all(|b| a != b), "picture {k}");
    }
}

/// The options of the boundary and of creases are those of the surface that is drawn.
#[test]
fn boundaries_and_creases_are_seen() {
    let sheet = cage("features/boundary_valences.obj");
    let fixed = ["render", arg(&sheet), "-o", "-", "--samples", "1", "--size", "120x90"];
    let look = |args: &[&str]| run(&[&fixed[..], &["--style", "mean"], args].concat()).stdout;
    let looks = [look(&[]), look(&["--creases", "fair"]), look(&["--boundary", "edge-only"])];
    assert!(looks[0].starts_with(b"\x89PNG\r\n"));
    assert!(looks[0] != looks[1] && looks[0] != looks[2]);
}

#[test]
fn the_same_arguments_give_the_same_bytes() {
    let [one, two] =
        ["1", "2"].map(|n| picture(&["--size", "90x60", "--style", "mean", "--threads", n]));
    assert!(one == two);
}

#[test]
fn the_camera_can_be_turned_and_moved() {
    let default = picture(&SMALL);
    assert!(default == picture(&["--size", "120x90", "--view", "30,25", "--zoom", "1"]));
    for args in [["--view", "-30,20"], ["--zoom", "2.5"], ["--target", "-1,0,0.5"], ["--at", "0"]] {
        assert!(default != picture(&[&SMALL[..], &args].concat()), "{args:?}");
    }
}

#[test]
fn a_vertex_that_is_not_extraordinary_cannot_be_looked_at() {
    let pillow = cage(PILLOW);
    let output = run(&["render", arg(&pillow), "-o", "-", "--at", "1"]);
    assert_eq!((code(&output), output.stdout.len()), (2, 0));
    assert!(stderr(&output).contains("--at 1: this is no extraordinary vertex"));
}

#[test]
fn options_out_of_range_are_wrong_usage() {
    let pillow = cage(PILLOW);
    for (option, value) in
        [("--samples", "9"), ("--stripes", "0"), ("--range", "0"), ("--zoom", "0")]
    {
        let output = run(&["render", arg(&pillow), "-o", "-", option, value]);
        assert_eq!((code(&output), output.stdout.len()), (2, 0), "{option}");
    }
}

#[test]
fn a_picture_is_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.png");
    let pillow = cage(PILLOW);
    let args = ["render", arg(&pillow), "-o", arg(&file), "--size", "30x20"];
    assert_eq!(stdout(&run(&args)), "");
    assert_eq!(size(&fs::read(&file).unwrap()), [30, 20]);
}
