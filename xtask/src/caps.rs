//! `cargo xtask caps`: how well caps join and how fair they are over the obstacle course, as the
//! tables of the documentation.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use evenlight::analyse::caps::{CapReport, cap_report};
use evenlight::cap::{CapKind, CapOptions};
use evenlight::io::load::Format;
use evenlight::mesh::BoundaryRule;
use evenlight::{SchemeKind, Surface, SurfaceOptions};

use crate::threads::map_on_threads;

/// Measure caps over the obstacle course and write the tables of
/// crates/evenlight/docs/09-caps.md.
#[derive(clap::Args)]
pub struct Arguments {}

const DOCUMENT: &str = "crates/evenlight/docs/09-caps.md";
const OBSTACLES: &str = "data/meshes/obstacle";
const MARKERS: [&str; 2] =
    ["<!-- written by `cargo xtask caps` -->\n", "<!-- end of what is written -->\n"];

/// The rings in front of caps, where nothing else is said.
const RINGS: usize = 3;

/// Other caps that are measured.
const OTHERS: [(SchemeKind, usize, CapKind); 8] = [
    (SchemeKind::CatmullClark, RINGS, CapKind::Bi3),
    (SchemeKind::Qas3, RINGS, CapKind::Bi3),
    (SchemeKind::Guided3, RINGS, CapKind::Bi3),
    (SchemeKind::Guided3, RINGS, CapKind::Bi4),
    (SchemeKind::Guided4, RINGS, CapKind::Bi4),
    (SchemeKind::Qas4, RINGS, CapKind::Bi4),
    (SchemeKind::Qas4, RINGS, CapKind::Bi6),
    (SchemeKind::Guided5, RINGS, CapKind::Bi6),
];

/// H may leave the range of the rings in front by this part of the curvature.
const SLACK: f64 = 0.01;

/// The caps of one kind over the course, with the names of their cages.
type Course = Vec<(String, CapReport)>;

/// Writes the tables.
pub fn run(_arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let file = crate::workspace(DOCUMENT);
    let text = std::fs::read_to_string(&file)?;
    let lost = || format!("{DOCUMENT} has lost its markers");
    let first = text.find(MARKERS[0]).ok_or_else(lost)? + MARKERS[0].len();
    let last = text.find(MARKERS[1]).ok_or_else(lost)?;
    let own = SchemeKind::ALL.map(|scheme| (scheme, RINGS, CapKind::Auto));
    let mut joins = String::from(JOINS);
    let mut outside = String::from(OUTSIDE);
    for (scheme, rings, kind) in own.into_iter().chain(OTHERS) {
        let course = measured_course(scheme, CapOptions { rings, kind })?;
        write_joins(&mut joins, scheme, &course)?;
        if kind == CapKind::Auto {
            write_outside(&mut outside, scheme, &course)?;
        }
    }
    std::fs::write(&file, [&text[..first], &joins, &outside, &text[last..]].concat())?;
    println!("{DOCUMENT}: written");
    Ok(())
}

const JOINS: &str = "
| scheme | cap | G0 | G1 lines | G1 ring | G2 lines | | G2 inside | | G2 ring | | H outside | |
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |
";

const OUTSIDE: &str = "
| scheme | caps with H outside of the range of the last two rings by more than 0.01: shape, valences, the most |
| --- | --- |
";

fn write_joins(out: &mut String, scheme: SchemeKind, course: &Course) -> std::fmt::Result {
    let most = |f: &dyn Fn(&CapReport) -> f64| course.iter().map(|(_, r)| f(r)).fold(0.0, f64::max);
    let mean = |f: &dyn Fn(&CapReport) -> f64| {
        course.iter().map(|(_, r)| f(r)).sum::<f64>() / course.len() as f64
    };
    let both = |f: &dyn Fn(&CapReport) -> f64| format!("{:.3} | {:.3}", mean(f), most(f));
    let cap = course.first().map_or((0, 0), |(_, cap)| (cap.degree, cap.split));
    writeln!(
        out,
        "| {} | bi-{} {m} x {m} | {:.0e} | {:.1e} | {:.0e} | {} | {} | {} | {} |",
        scheme.name(),
        cap.0,
        most(&|r| r.lines.position.max(r.ring.position).max(r.inside.position)),
        most(&|r| r.lines.tangent_plane.to_degrees()),
        most(&|r| r.ring.tangent_plane.max(r.inside.tangent_plane).to_degrees()),
        both(&|r| r.lines.curvature),
        both(&|r| r.inside.curvature),
        both(&|r| r.ring.curvature),
        both(&|r| r.excess().unwrap_or(0.0)),
        m = cap.1,
    )
}

fn write_outside(out: &mut String, scheme: SchemeKind, course: &Course) -> std::fmt::Result {
    let mut shapes: BTreeMap<&str, (Vec<&str>, f64)> = BTreeMap::new();
    let mut count = 0;
    for (name, report) in course {
        let excess = report.excess().unwrap_or(0.0);
        if excess > SLACK {
            count += 1;
            let (shape, valence) = name.rsplit_once("_n").unwrap_or((name, ""));
            let entry = shapes.entry(shape).or_default();
            if entry.0.last() != Some(&valence) && !valence.is_empty() {
                entry.0.push(valence);
            }
            entry.1 = entry.1.max(excess);
        }
    }
    let list = shapes.iter().map(|(shape, (valences, most))| {
        let valences = if valences.is_empty() { "-".to_owned() } else { valences.join(" ") };
        format!("{shape} {valences} ({most:.2})")
    });
    let list = list.collect::<Vec<_>>().join("; ");
    writeln!(out, "| {} | {count} of {}: {list} |", scheme.name(), course.len())
}

fn measured_course(scheme: SchemeKind, options: CapOptions) -> Result<Course, Box<dyn Error>> {
    let mut files = std::fs::read_dir(crate::workspace(OBSTACLES))?
        .map(|entry| Ok(entry?.path()))
        .collect::<std::io::Result<Vec<_>>>()?;
    files.sort();
    let found = map_on_threads(&files, |file| {
        measured(file, scheme, options).map_err(|error| error.to_string())
    });
    Ok(found.into_iter().collect::<Result<Vec<_>, String>>()?.into_iter().flatten().collect())
}

/// The caps of a cage that are not flat.
fn measured(
    file: &Path,
    scheme: SchemeKind,
    options: CapOptions,
) -> Result<Course, Box<dyn Error>> {
    let (cage, _) = Format::Obj.read_cage(&std::fs::read(file)?)?;
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let boundary = Some(BoundaryRule::None);
    let mut surface =
        Surface::build(cage, SurfaceOptions { scheme, boundary, ..SurfaceOptions::default() })?;
    surface.set_caps(Some(options))?;
    let reports = cap_report(&surface).into_iter().filter(|report| report.scale > 0.0);
    Ok(reports.map(|report| (name.clone(), report)).collect())
}
