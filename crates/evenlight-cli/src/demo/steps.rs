//! The commands of the demonstration.

use super::subject::CloseUp;

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
pub fn steps(close_ups: &[CloseUp], size: [usize; 2]) -> Vec<Step> {
    let pictures = pictures(size).into_iter();
    let close_ups = close_ups.iter().map(|close_up| close_up_picture(close_up, wide(size)));
    pictures.chain(close_ups).chain(numbers()).chain(geometry()).collect()
}

fn pictures([width, height]: [usize; 2]) -> Vec<Step> {
    let [w, h] = wide([width, height]);
    let one = format!("render cage.obj --size {width}x{height}");
    let both = format!("render cage.obj --compare cc,eg --size {w}x{h}");
    let step = |command: &str, style: &str, about: &str| {
        Step::new(&format!("{command} --style {style}"), &format!("{style}.png"), about)
    };
    vec![
        step(&one, "shaded", "the surface"),
        step(&one, "patches", "the layout of its patches"),
        step(&both, "highlight", "highlight lines, Catmull-Clark beside Evolving-Guide"),
        step(&both, "mean", "mean curvature, Catmull-Clark beside Evolving-Guide"),
        step(&one, "gauss", "Gauss curvature"),
    ]
}

fn close_up_picture(close_up: &CloseUp, [width, height]: [usize; 2]) -> Step {
    let CloseUp { vertex, valence, zoom } = close_up;
    let command = format!(
        "render cage.obj --compare cc,eg --size {width}x{height} --style highlight --at {vertex} \
         --zoom {zoom}"
    );
    let about = format!("highlight lines around vertex {vertex} of valence {valence}");
    Step::new(&command, &format!("highlight-valence-{valence}.png"), &about)
}

/// The size of a comparison: as many pixels as a picture of `size`, times 8/9.
fn wide([width, height]: [usize; 2]) -> [usize; 2] {
    [width * 4 / 3, height * 2 / 3]
}

fn numbers() -> Vec<Step> {
    vec![
        Step::new("check cage.obj --json", "check.json", "what is in the cage"),
        Step::new("analyze cage.obj --json", "analyze.json", "curvature and continuity"),
        Step::new("spectrum --json", "spectrum.json", "eigenvalues of Evolving-Guide"),
        Step::new(
            "spectrum --scheme cc --json",
            "spectrum-cc.json",
            "eigenvalues of Catmull-Clark",
        ),
        Step::new(
            "eval cage.obj --points points.csv",
            "points-evaluated.csv",
            "the surface on the way to extraordinary vertices",
        ),
    ]
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
