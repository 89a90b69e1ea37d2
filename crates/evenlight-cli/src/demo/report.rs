//! The report of the demonstration.

use std::path::Path;

use evenlight::surface::ExtraordinaryPoint;
use evenlight::{SchemeKind, SurfaceOptions};

use super::steps::Step;
use super::subject::{CloseUp, RINGS, Subject};
use super::{CAGE_FILE, EDIT_FILE, POINTS_FILE};
use crate::analyze::{LEGEND, jump_table, point_table};
use crate::error::Failure;
use crate::spectrum;
use crate::table::Table;

/// The report in Markdown, with the pictures in it.
pub fn markdown(
    subject: &Subject,
    close_ups: &[CloseUp],
    steps: &[Step],
) -> Result<String, Failure> {
    let sections = [
        introduction(subject),
        pictures(steps),
        curvature(subject, close_ups),
        spectra()?,
        files(steps),
    ];
    Ok(sections.join("\n"))
}

/// A few lines for the terminal.
pub fn summary(folder: &Path, subject: &Subject, steps: &[Step]) -> String {
    let [cc, eg, qas4] = subject.analyses.each_ref().map(|a| a.worst_growth());
    format!(
        "{} files in {}: begin with report.md\n\
         cage: {}\n\
         range of mean curvature, ring {RINGS} : ring 1, at the worst point: cc {cc:.2}, \
         eg {eg:.2}, qas4 {qas4:.2}\n",
        steps.len() + 4,
        folder.display(),
        counts(subject)
    )
}

fn counts(subject: &Subject) -> String {
    let cage = &subject.cage;
    let valences = cage.interior_valences();
    let extraordinary = valences.iter().filter(|&(&n, _)| n != 4);
    let list: Vec<String> =
        extraordinary.map(|(n, count)| format!("{count} of valence {n}")).collect();
    let (vertices, faces) = (cage.num_used_vertices(), cage.num_faces());
    format!("{vertices} vertices, {faces} faces; extraordinary: {}", list.join(", "))
}

fn introduction(subject: &Subject) -> String {
    format!(
        "# Evenlight, demonstrated\n\n\
         One cage, three surfaces: Catmull-Clark (`cc`), Evolving-Guide (`eg`) and \
         Quadratic-Attraction (`qas4`, the default). Away from extraordinary vertices all are \
         the same bi-cubic splines; around them they differ, and highlight lines and curvature \
         show how.\n\n\
         The cage has {}.\n",
        counts(subject)
    )
}

fn pictures(steps: &[Step]) -> String {
    let mut text = "## Pictures\n".to_owned();
    for Step { file, about, .. } in steps.iter().filter(|step| step.is_picture()) {
        text += &format!("\n![{about}]({file})\n\n*{about}*\n");
    }
    text
}

fn curvature(subject: &Subject, close_ups: &[CloseUp]) -> String {
    let is_shown = |_: usize, p: &ExtraordinaryPoint| {
        p.vertex().is_some_and(|v| close_ups.iter().any(|close_up| close_up.vertex == v.0))
    };
    let points = point_table(&subject.analyses, is_shown).markdown();
    let jumps = jump_table(&subject.analyses).markdown();
    let legend: Vec<String> = LEGEND.iter().map(|line| format!("- {line}\n")).collect();
    format!(
        "## Curvature and continuity, rings 1 to {RINGS}\n\n\
         The vertex of every valence at which the curvature of Catmull-Clark varies most; \
         [analyze.json](analyze.json) has all of them.\n\n{points}\n{jumps}\n{}",
        legend.concat()
    )
}

fn spectra() -> Result<String, Failure> {
    let mut text = "## Eigenvalues\n".to_owned();
    for (scheme, name) in [
        (SchemeKind::Qas4, "Quadratic-Attraction"),
        (SchemeKind::EvolvingGuide, "Evolving-Guide"),
        (SchemeKind::CatmullClark, "Catmull-Clark"),
    ] {
        let options = SurfaceOptions { scheme, ..SurfaceOptions::default() };
        let table = spectrum::table(&spectrum::spectra(options, &(3..=10), true)?);
        text += &format!("\n{name}:\n\n{}", table.markdown());
    }
    text += "\nCurvature is bounded where mu/lambda^2 is 1 or less; with a quadratic that is so if \
             the control net dies faster, M_d/lambda^2 below 1. The surface is C1 where the \
             characteristic map is injective, proved by the coefficients of its Jacobian.\n";
    Ok(text)
}

fn files(steps: &[Step]) -> String {
    let mut table = Table::new(&["file", "what it is", "command"]);
    let mut row = |file: &str, about: &str, command: &str| {
        table.push([format!("[{file}]({file})"), about.to_owned(), command.to_owned()]);
    };
    row(CAGE_FILE, "the cage", "");
    row(POINTS_FILE, "parameters on the way to extraordinary vertices", "");
    row(EDIT_FILE, "a quadratic pushed inwards, for `--q`", "");
    for Step { file, about, command } in steps {
        row(file, about, &format!("`evenlight {command}`"));
    }
    format!(
        "## Files\n\nEach command, typed in this folder, makes its file again.\n\n{}",
        table.markdown()
    )
}
