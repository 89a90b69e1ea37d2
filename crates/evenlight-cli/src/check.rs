//! `evenlight check`: whether a cage can be used, and what is in it.

use std::collections::BTreeMap;
use std::io::{self, Write};

use clap::Args;
use evenlight::io::load::{LoadError, Loaded, Notice};
use evenlight::mesh::isolation::{self, Extraordinary, Place};
use evenlight::{Cage, FaceId, RuleSet, SchemeKind};
use serde::Serialize;

use crate::error::{Failure, warn};
use crate::input::{self, CageArg, Source, omitted_text};
use crate::output::Target;

mod fix;

use fix::FixArgs;

/// Arguments of `evenlight check`.
#[derive(Args, Debug)]
pub struct CheckArgs {
    #[command(flatten)]
    cage: CageArg,

    /// JSON instead of text; also for a cage that is refused, with its faults in `errors`
    #[arg(long)]
    json: bool,

    /// The file to write; `-` for stdout
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: Target,

    #[command(flatten)]
    fix: FixArgs,
}

/// Runs `evenlight check`.
///
/// # Errors
///
/// All faults of the cage, if it cannot be used.
pub fn run(args: &CheckArgs) -> Result<(), Failure> {
    if let Some(target) = &args.fix.target {
        return args.fix.run(&args.cage, target, args.json, &args.output);
    }
    let result = input::read_mesh(&args.cage)?.and_then(Loaded::check);
    let report = Report::of(&result);
    if args.json {
        args.output.write_json(&report)?;
    }
    for warning in &report.warnings {
        warn(format_args!("{}: {warning}", args.cage.source));
    }
    let refused = |error: &LoadError| Failure::Unusable(format!("{}: {error}", args.cage.source));
    result.as_ref().map_err(refused)?;
    if args.json {
        Ok(())
    } else {
        args.output.write(|out| report.write_text(&args.cage.source, out))
    }
}

/// What is known of a cage. Vertices and faces are counted from 0.
#[derive(Debug, Default, Serialize)]
pub struct Report {
    /// The number of vertices that are in a face; this and the other counts are `null` if the
    /// cage is refused.
    vertices: Option<usize>,
    faces: Option<usize>,
    edges: Option<usize>,
    /// The edges with one face: 0 if the surface is closed.
    boundary_edges: Option<usize>,
    /// The connected pieces.
    components: Option<usize>,
    /// How many interior vertices there are of each valence.
    valences: BTreeMap<usize, usize>,
    /// How many faces there are of each number of corners but 4.
    ngons: BTreeMap<usize, usize>,
    /// The interior vertices with a valence other than 4.
    extraordinary: Vec<ExtraordinaryVertex>,
    /// The centres of the faces with other than 4 corners.
    face_centres: Vec<FaceCentre>,
    /// How many faces have no surface, since they touch a boundary.
    omitted_faces: Option<usize>,
    /// Why the cage is refused; empty if it can be used.
    errors: Vec<String>,
    /// What was accepted but should be known.
    warnings: Vec<String>,
}

/// An interior vertex with a valence other than 4.
#[derive(Debug, Serialize)]
struct ExtraordinaryVertex {
    vertex: u32,
    valence: usize,
    /// The level of Catmull-Clark refinement, 0 to 2, at which it is isolated.
    level: usize,
    /// Whether some face around it has a surface.
    has_surface: bool,
}

/// The centre of a face with other than 4 corners, which is extraordinary too.
#[derive(Debug, Serialize)]
struct FaceCentre {
    face: u32,
    valence: usize,
    level: usize,
    has_surface: bool,
}

impl Report {
    /// What is known of a cage that was read, or why it was not.
    pub fn of(result: &Result<(Cage, Vec<Notice>), LoadError>) -> Self {
        match result {
            Ok((cage, notices)) => Self::of_cage(cage, notices),
            Err(error) => Self {
                errors: error.faults(),
                warnings: error.notices().iter().map(ToString::to_string).collect(),
                ..Self::default()
            },
        }
    }

    fn of_cage(cage: &Cage, notices: &[Notice]) -> Self {
        let topology = cage.topology();
        let is_omitted = |&f: &FaceId| isolation::is_omitted(topology, f);
        let omitted = topology.faces().ids().filter(is_omitted).count();
        let mut ngons = cage.face_sizes();
        ngons.remove(&4);
        let mut report = Self {
            vertices: Some(cage.num_used_vertices()),
            faces: Some(cage.num_faces()),
            edges: Some(cage.num_edges()),
            boundary_edges: Some(cage.num_boundary_edges()),
            components: Some(cage.num_components()),
            valences: cage.interior_valences(),
            ngons,
            omitted_faces: Some(omitted),
            warnings: notices.iter().map(ToString::to_string).collect(),
            ..Self::default()
        };
        let points = isolation::extraordinary_points(topology);
        report.warnings.extend(valence_warning(&points));
        if omitted > 0 {
            report.warnings.push(omitted_text(omitted, cage.num_faces()));
        }
        points.into_iter().for_each(|point| report.add(point));
        report
    }

    fn add(&mut self, point: Extraordinary) {
        let Extraordinary { valence, level, is_covered: has_surface, .. } = point;
        match point.place {
            Place::Vertex(v) => {
                let vertex = v.0;
                self.extraordinary.push(ExtraordinaryVertex {
                    vertex,
                    valence,
                    level,
                    has_surface,
                });
            }
            Place::FaceCentre(f) => {
                let face = f.0;
                self.face_centres.push(FaceCentre { face, valence, level, has_surface });
            }
        }
    }

    /// The report for people.
    fn write_text(&self, name: &Source, out: &mut dyn Write) -> io::Result<()> {
        let count = Option::unwrap_or_default;
        writeln!(out, "{name}: can be used")?;
        writeln!(out, "  vertices        {}", count(self.vertices))?;
        writeln!(out, "  edges           {}", count(self.edges))?;
        writeln!(out, "  faces           {}", count(self.faces))?;
        writeln!(out, "  n-gons          {}", histogram(&self.ngons, "corners"))?;
        writeln!(out, "  boundary edges  {}", count(self.boundary_edges))?;
        writeln!(out, "  components      {}", count(self.components))?;
        writeln!(out, "  valences        {}", histogram(&self.valences, "edges"))?;
        writeln!(out, "  left out        {}", left_out(count(self.omitted_faces)))?;
        self.write_points(out)
    }

    fn write_points(&self, out: &mut dyn Write) -> io::Result<()> {
        if self.extraordinary.len() + self.face_centres.len() > 0 {
            writeln!(out, "  extraordinary points (numbers from 0), isolated at refinement level")?;
        }
        for p in &self.extraordinary {
            let note = note(p.has_surface);
            writeln!(
                out,
                "    vertex {:<8} valence {:<4} level {}{note}",
                p.vertex, p.valence, p.level
            )?;
        }
        for p in &self.face_centres {
            let note = note(p.has_surface);
            writeln!(
                out,
                "    face {:<10} valence {:<4} level {}{note}",
                p.face, p.valence, p.level
            )?;
        }
        Ok(())
    }
}

fn note(has_surface: bool) -> &'static str {
    if has_surface { "" } else { "  (left out)" }
}

fn left_out(omitted: usize) -> String {
    match omitted {
        0 => "nothing".to_owned(),
        _ => format!("{omitted} faces that touch a boundary"),
    }
}

fn histogram(counts: &BTreeMap<usize, usize>, of: &str) -> String {
    if counts.is_empty() {
        return "none".to_owned();
    }
    let entries: Vec<String> = counts.iter().map(|(n, k)| format!("{k} with {n}")).collect();
    format!("{} {of}", entries.join(", "))
}

/// The most points that a warning names.
const LISTED: usize = 8;

/// The sentence on points for which the default scheme has no rules.
fn valence_warning(points: &[Extraordinary]) -> Option<String> {
    let (scheme, rules) = (SchemeKind::default(), RuleSet::default());
    let without_rules = |p: &&Extraordinary| p.is_covered && !scheme.has_rules(rules, p.valence);
    let name = |p: &Extraordinary| match p.place {
        Place::Vertex(v) => format!("vertex {} has valence {}", v.0, p.valence),
        Place::FaceCentre(f) => format!("face {} has {} corners", f.0, p.valence),
    };
    let mut names: Vec<String> = points.iter().filter(without_rules).map(name).collect();
    if names.is_empty() {
        return None;
    }
    let more = names.len().saturating_sub(LISTED);
    names.truncate(LISTED);
    if more > 0 {
        names.push(format!("{more} more"));
    }
    Some(format!(
        "all schemes but cc have rules for valences {} only: {} (numbers from 0)",
        scheme.valences(rules),
        names.join(", ")
    ))
}
