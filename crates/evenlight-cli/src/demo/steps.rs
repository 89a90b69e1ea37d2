//! The commands of the demonstration.

use super::subject::{CloseUp, Handle};

/// One command, the file that it writes, and what that is.
pub struct Step {
    /// The name of the file.
    pub file: String,
    /// The words behind `evenlight`, with one blank between them; none contains a blank.
    pub command: String,
    /// What the file shows.
    pub about: String,
}

impl Step {
    fn new(command: &str, file: &str, about: &str) -> Self {
        let command = format!("{command} -o {file}");
        Self { file: file.to_owned(), command, about: about.to_owned() }
    }

    /// Whether the file is a picture.
    pub fn is_picture(&self) -> bool {
        self.file.ends_with(".png")
    }
}

/// All commands, in the order of the report. Single pictures have `size` pixels.
pub fn steps(close_ups: &[CloseUp], handle: &Handle, size: [usize; 2]) -> Vec<Step> {
    let pictures = pictures(size).into_iter();
    let close_ups = close_ups.iter().map(|close_up| close_up_picture(close_up, wide(size)));
    let of_handle = [mean_picture(handle, wide(size)), edited_picture(handle, size)];
    pictures.chain(close_ups).chain(of_handle).chain(numbers()).chain(geometry()).collect()
}

/// The schemes of [`SCHEMES`](super::subject::SCHEMES) by their names.
const COMPARE: &str = "--compare cc,eg,qas4";

fn pictures([width, height]: [usize; 2]) -> Vec<Step> {
    let [w, h] = wide([width, height]);
    let one = format!("render cage.obj --size {width}x{height}");
    let all = format!("render cage.obj {COMPARE} --size {w}x{h}");
    let step = |command: &str, style: &str, about: &str| {
        Step::new(&format!("{command} --style {style}"), &format!("{style}.png"), about)
    };
    vec![
        step(&one, "shaded", "the surface"),
        step(&one, "patches", "the layout of its patches"),
        step(&all, "highlight", &format!("highlight lines: {NAMES}")),
        // Thin rims and legs would take most of the range.
        step(&format!("{all} --range 1"), "mean", &format!("mean curvature: {NAMES}")),
        step(&one, "gauss", "Gauss curvature"),
    ]
}

fn close_up_picture(close_up: &CloseUp, [width, height]: [usize; 2]) -> Step {
    let CloseUp { vertex, valence, zoom } = close_up;
    let command = format!(
        "render cage.obj {COMPARE} --size {width}x{height} --style highlight --at {vertex} \
         --zoom {zoom}"
    );
    let about = format!("highlight lines around vertex {vertex} of valence {valence}: {NAMES}");
    Step::new(&command, &format!("highlight-valence-{valence}.png"), &about)
}

fn mean_picture(handle: &Handle, [width, height]: [usize; 2]) -> Step {
    let Handle { vertex, valence, zoom, largest_mean, .. } = handle;
    let command = format!(
        "render cage.obj {COMPARE} --size {width}x{height} --style mean --range {largest_mean} \
         --at {vertex} --zoom {zoom}"
    );
    let about = format!("mean curvature around vertex {vertex} of valence {valence}: {NAMES}");
    Step::new(&command, &format!("mean-valence-{valence}.png"), &about)
}

fn edited_picture(handle: &Handle, [width, height]: [usize; 2]) -> Step {
    let Handle { vertex, valence, position, zoom, .. } = handle;
    // Adding 0 turns -0 into 0.
    let [x, y, z] = position.map(|t| (100.0 * t).round() / 100.0 + 0.0);
    let command = format!(
        "render cage.obj --q edit.json --size {width}x{height} --style shaded \
         --target {x},{y},{z} --zoom {zoom}"
    );
    let about = format!("the quadratic of vertex {vertex} of valence {valence} pushed inwards");
    Step::new(&command, "edited.png", &about)
}

/// The schemes of a comparison, for captions.
const NAMES: &str = "Catmull-Clark, Evolving-Guide, Quadratic-Attraction";

/// The size of a comparison: as many pixels as a picture of `size`, in three panels.
fn wide([width, height]: [usize; 2]) -> [usize; 2] {
    [width * 3 / 2, height * 2 / 3]
}

fn numbers() -> Vec<Step> {
    vec![
        Step::new("check cage.obj --json", "check.json", "what is in the cage"),
        Step::new(
            "analyze cage.obj --schemes cc,eg,qas4 --json",
            "analyze.json",
            "curvature and continuity",
        ),
        spectrum("qas4", "Quadratic-Attraction"),
        spectrum("eg", "Evolving-Guide"),
        spectrum("cc", "Catmull-Clark"),
        Step::new("q cage.obj --json", "q.json", "the quadratics at extraordinary vertices"),
        Step::new(
            "eval cage.obj --points points.csv",
            "points-evaluated.csv",
            "the surface on the way to extraordinary vertices",
        ),
    ]
}

fn spectrum(scheme: &str, name: &str) -> Step {
    let command = format!("spectrum --scheme {scheme} --json");
    Step::new(&command, &format!("spectrum-{scheme}.json"), &format!("eigenvalues of {name}"))
}

fn geometry() -> Vec<Step> {
    vec![
        Step::new("patches cage.obj", "patches.bv", "its patches for BezierView"),
        Step::new("patches cage.obj", "patches.json", "its patches as JSON"),
        Step::new("mesh cage.obj", "mesh.obj", "triangles with normals"),
        Step::new("mesh cage.obj", "mesh.ply", "triangles with normals and curvatures"),
        Step::new("mesh cage.obj", "mesh.stl", "triangles"),
    ]
}
