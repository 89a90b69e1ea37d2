//! `evenlight check`: whether a cage can be used, and what is in it.

use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, Write};

use clap::Args;
use evenlight::io::load::{LoadError, Loaded, Notice};
use evenlight::mesh::BoundaryRule;
use evenlight::mesh::isolation::{self, Extraordinary, Place};
use evenlight::surface::{PointRule, SurfaceError};
use evenlight::{Cage, RuleSet, SchemeKind, SurfaceOptions};
use serde::Serialize;

use crate::error::{Failure, warn};
use crate::input::{self, CageArg, Source, WHY_OMITTED, omitted_text};
use crate::options::{BoundaryArg, scheme_parser};
use crate::output::Target;
use crate::surface::valence_warning;

mod fix;

use fix::FixArgs;

/// Arguments of `evenlight check`.
#[derive(Args, Debug)]
pub struct CheckArgs {
    #[command(flatten)]
    cage: CageArg,

    /// The scheme that extraordinary points are to get
    #[arg(long, default_value = SchemeKind::default().name(), value_parser = scheme_parser())]
    scheme: SchemeKind,

    #[command(flatten)]
    boundary: BoundaryArg,

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
    let options = SurfaceOptions { scheme: args.scheme, ..SurfaceOptions::default() };
    let options = args.boundary.applied_to(options);
    let points = result.as_ref().map_or_else(|_| Vec::new(), |(cage, _)| points(cage, options));
    let report = Report::of(&result, points, options);
    if args.json {
        args.output.write_json(&report)?;
    }
    for warning in &report.warnings {
        warn(format_args!("{}: {warning}", args.cage.source));
    }
    result.as_ref().map_err(|error| args.cage.source.refused(error))?;
    match &report.errors[..] {
        [] if args.json => Ok(()),
        [] => args.output.write(|out| report.write_text(&args.cage.source, out)),
        [error, ..] => Err(Failure::Unusable(format!("{}: {error}", args.cage.source))),
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
    /// The rule at the boundary.
    boundary: Option<&'static str>,
    /// How many extraordinary points have which rule.
    rules: BTreeMap<String, usize>,
    /// The interior vertices with a valence other than 4, and the vertices on sharp edges or the
    /// boundary that are not regular there, once for every such fan of faces.
    extraordinary: Vec<ExtraordinaryVertex>,
    /// The centres of the faces with other than 4 corners.
    face_centres: Vec<FaceCentre>,
    /// How many faces have no surface: holes, and those at the boundary under the rule "none".
    omitted_faces: Option<usize>,
    /// Why the cage is refused; empty if it can be used.
    errors: Vec<String>,
    /// What was accepted but should be known.
    warnings: Vec<String>,
}

/// An extraordinary vertex.
#[derive(Debug, Serialize)]
struct ExtraordinaryVertex {
    vertex: u32,
    valence: usize,
    /// The faces that it concerns: all, or those between two sharp edges.
    faces: usize,
    #[serde(flatten)]
    rule: RuleName,
    /// The level of Catmull-Clark refinement at which it is isolated.
    level: usize,
    /// Whether some face around it has a surface.
    has_surface: bool,
}

/// The centre of a face with other than 4 corners, which is extraordinary too.
#[derive(Debug, Serialize)]
struct FaceCentre {
    face: u32,
    valence: usize,
    #[serde(flatten)]
    rule: RuleName,
    level: usize,
    has_surface: bool,
}

/// The rule of a point, and why it is not the chosen scheme.
#[derive(Clone, Copy, Debug, Serialize)]
struct RuleName {
    /// The name of a scheme, "fair-crease", or "none" without a surface.
    rule: &'static str,
    /// Why it is not the rule of the chosen scheme; `null` if it is.
    reason: Option<&'static str>,
    /// Whether semi-sharp edges had to be refined away first.
    was_semi_sharp: bool,
    #[serde(skip)]
    words: Option<PointRule>,
}

impl Report {
    /// What is known of a cage that was read, and of its extraordinary points, or why it was not.
    fn of(
        result: &Result<(Cage, Vec<Notice>), LoadError>,
        points: Vec<Extraordinary>,
        options: SurfaceOptions,
    ) -> Self {
        match result {
            Ok((cage, notices)) => match beyond_all_rules(&points) {
                Some(error) => Self {
                    errors: vec![error.to_string()],
                    warnings: notices.iter().map(ToString::to_string).collect(),
                    ..Self::default()
                },
                None => Self::of_cage(cage, notices, points, options),
            },
            Err(error) => Self {
                errors: error.diagnostics().into_iter().map(|fault| fault.message).collect(),
                warnings: error.notices().iter().map(ToString::to_string).collect(),
                ..Self::default()
            },
        }
    }

    fn of_cage(
        cage: &Cage,
        notices: &[Notice],
        points: Vec<Extraordinary>,
        options: SurfaceOptions,
    ) -> Self {
        let boundary = boundary_of(cage, options);
        let omitted = isolation::omitted_faces(cage, boundary).len();
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
            boundary: Some(boundary.name()),
            omitted_faces: Some(omitted),
            warnings: notices.iter().map(ToString::to_string).collect(),
            ..Self::default()
        };
        let smooth = points.iter().filter(|p| p.is_covered && p.fan.is_smooth());
        report.warnings.extend(valence_warning(smooth.map(|p| (p.place, p.valence)), options));
        if omitted > 0 {
            report.warnings.push(omitted_text(omitted, cage.num_faces()));
        }
        points.into_iter().for_each(|point| report.add(point, rule_name(cage, &point, options)));
        report
    }

    fn add(&mut self, point: Extraordinary, rule: RuleName) {
        let Extraordinary { valence, level, is_covered: has_surface, fan, .. } = point;
        *self.rules.entry(rule.to_string()).or_insert(0) += 1;
        match point.place {
            Place::Vertex(v) => {
                let vertex = v.0;
                self.extraordinary.push(ExtraordinaryVertex {
                    vertex,
                    valence,
                    faces: fan.faces,
                    rule,
                    level,
                    has_surface,
                });
            }
            Place::FaceCentre(f) => {
                let face = f.0;
                self.face_centres.push(FaceCentre { face, valence, rule, level, has_surface });
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
        writeln!(out, "  boundary rule   {}", self.boundary.unwrap_or_default())?;
        writeln!(out, "  components      {}", count(self.components))?;
        writeln!(out, "  valences        {}", histogram(&self.valences, "edges"))?;
        writeln!(out, "  left out        {}", left_out(count(self.omitted_faces)))?;
        self.write_points(out)
    }

    fn write_points(&self, out: &mut dyn Write) -> io::Result<()> {
        if self.extraordinary.len() + self.face_centres.len() > 0 {
            writeln!(out, "  rules of extraordinary points")?;
        }
        for (rule, count) in &self.rules {
            writeln!(out, "    {count:<6} {rule}")?;
        }
        if self.extraordinary.len() + self.face_centres.len() > 0 {
            writeln!(out, "  extraordinary points (numbers from 0), isolated at refinement level")?;
        }
        for p in &self.extraordinary {
            let of_faces = match p.faces {
                faces if faces == p.valence => String::new(),
                1 => " (1 face)".to_owned(),
                faces => format!(" ({faces} faces)"),
            };
            writeln!(
                out,
                "    vertex {:<8} valence {:<4} level {}  {}{of_faces}",
                p.vertex, p.valence, p.level, p.rule
            )?;
        }
        for p in &self.face_centres {
            writeln!(
                out,
                "    face {:<10} valence {:<4} level {}  {}",
                p.face, p.valence, p.level, p.rule
            )?;
        }
        Ok(())
    }
}

fn boundary_of(cage: &Cage, options: SurfaceOptions) -> BoundaryRule {
    options.boundary.unwrap_or(cage.tags().boundary)
}

fn points(cage: &Cage, options: SurfaceOptions) -> Vec<Extraordinary> {
    isolation::extraordinary_points(cage, boundary_of(cage, options))
}

/// Why no surface can be built over a cage with such points: more faces meet at some of them than
/// even Catmull-Clark has rules for.
fn beyond_all_rules(points: &[Extraordinary]) -> Option<SurfaceError> {
    let has_rules =
        |faces: usize| faces < 2 || SchemeKind::CatmullClark.has_rules(RuleSet::default(), faces);
    let beyond = points.iter().filter(|p| p.is_covered && !has_rules(p.fan.faces));
    let points: Vec<_> = beyond.map(|p| (p.place, p.valence)).collect();
    (!points.is_empty()).then_some(SurfaceError::NoRules { points })
}

fn rule_name(cage: &Cage, point: &Extraordinary, options: SurfaceOptions) -> RuleName {
    let rule = point.is_covered.then(|| PointRule::of(cage.topology(), point, options));
    RuleName {
        rule: rule.map_or("none", |rule| rule.name(options.scheme)),
        reason: match rule {
            Some(PointRule::CatmullClark(reason) | PointRule::FairCrease(reason)) => {
                Some(reason.name())
            }
            _ => None,
        },
        was_semi_sharp: point.was_semi_sharp,
        words: rule,
    }
}

impl fmt::Display for RuleName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.words {
            None => f.write_str("left out")?,
            Some(PointRule::Scheme) => f.write_str(self.rule)?,
            Some(PointRule::CatmullClark(reason)) => write!(f, "cc: {reason}")?,
            Some(PointRule::FairCrease(reason)) => write!(f, "fair rings: {reason}")?,
            Some(_) => f.write_str(self.rule)?,
        }
        f.write_str(if self.was_semi_sharp { ", after semi-sharp creases have gone" } else { "" })
    }
}

fn left_out(omitted: usize) -> String {
    match omitted {
        0 => "nothing".to_owned(),
        1 => format!("1 face ({WHY_OMITTED})"),
        _ => format!("{omitted} faces ({WHY_OMITTED})"),
    }
}

fn histogram(counts: &BTreeMap<usize, usize>, of: &str) -> String {
    if counts.is_empty() {
        return "none".to_owned();
    }
    let entries: Vec<String> = counts.iter().map(|(n, k)| format!("{k} with {n}")).collect();
    format!("{} {of}", entries.join(", "))
}
