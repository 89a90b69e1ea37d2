//! `evenlight analyze`: curvature and continuity around every extraordinary point.

mod record;

use std::collections::BTreeSet;
use std::io::{self, Write};
use std::sync::Arc;

use clap::Args;
use evenlight::analyse::caps::{CapReport, cap_report};
use evenlight::analyse::curvature::{
    CurvatureReport, PointReport, RingCurvature, curvature_report,
};
use evenlight::analyse::defect::Defect;
use evenlight::analyse::shape::{PointShape, shape};
use evenlight::cap::CapKind;
use evenlight::surface::ExtraordinaryPoint;
use evenlight::{SchemeKind, Surface};

use crate::cap::{self, CapArg};
use crate::edits::QArg;
use crate::error::Failure;
use crate::input::{self, CageArg};
use crate::options::{BoundaryArg, RulesArg, scheme_parser};
use crate::output::Target;
use crate::progress::Progress;
use crate::surface;
use crate::table::{Table, point_name, short};
use record::Document;

/// Arguments of `evenlight analyze`.
#[derive(Args, Debug)]
pub struct AnalyzeArgs {
    #[command(flatten)]
    cage: CageArg,

    /// Schemes to compare
    #[arg(long, value_delimiter = ',', default_value = "cc,qas4", value_parser = scheme_parser())]
    schemes: Vec<SchemeKind>,

    #[command(flatten)]
    rules: RulesArg,

    #[command(flatten)]
    boundary: BoundaryArg,

    #[command(flatten)]
    q: QArg,

    /// Number of rings around every extraordinary point, 1 to 100 (0 with --cap); ring k reaches to
    /// 2^-k of a sector (at contraction cc)
    #[arg(long, value_name = "K", default_value_t = 6, value_parser = clap::value_parser!(u8).range(0..=100))]
    rings: u8,

    #[command(flatten)]
    cap: CapArg,

    /// All extraordinary points in the table, not only the dozen where H varies most near the
    /// point (the JSON has all anyway)
    #[arg(long)]
    all: bool,

    /// JSON instead of a table, with the ranges of every ring
    #[arg(long)]
    json: bool,

    /// The file to write; `-` for stdout
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: Target,
}

/// What the columns of the tables mean.
pub const LEGEND: [&str; 5] = [
    "K (1/unit^2), H (1/unit): Gauss and mean curvature over all rings.",
    "growth: the length of the range of H in the last ring over that in the first.",
    "H along rays, around rings: oscillation, that is how far H rises and falls in vain on the way \
     to the point, and how much more around it than on the outer border of ring 1; relative to \
     the curvature on that border.",
    "energy: the integral of |grad H|^2 over rings 1 to 4 (1/unit^2), for comparison of schemes.",
    "jumps: of H between rings (1/unit); of position (units), tangent plane (radians) and \
     curvature (1/unit) across all patch borders but those of caps.",
];

/// What the columns of the table of caps mean.
const CAP_LEGEND: [&str; 2] = [
    "caps: the largest jumps of position (G0, units), tangent plane (G1, radians) and curvature (G2, \
     over the largest curvature of the cap) across the lines between sectors, between the patches \
     inside a sector, and to the last ring.",
    "H outside: how far H of the cap leaves its range over the last two rings, over the largest \
     curvature of the cap.",
];

/// Runs `evenlight analyze`.
pub fn run(args: &AnalyzeArgs, quiet: bool) -> Result<(), Failure> {
    let cap = args.cap.kind(&args.schemes)?;
    if cap.is_none() && args.rings == 0 {
        return Err(Failure::Usage("--rings 0 is for surfaces with caps: add --cap".to_owned()));
    }
    let edits = args.q.read(&args.cage.source, &args.schemes)?;
    let cage = input::read_cage(&args.cage)?;
    let progress = Progress::new(args.schemes.len(), quiet);
    let mut analyses = Vec::new();
    for &scheme in &args.schemes {
        let options = args.boundary.applied_to(args.rules.options_among(&args.schemes, scheme));
        progress.stage(format!("Analysing {}", scheme.name()));
        let mut surface = surface::build(Arc::clone(&cage), options, &args.cage.source)?;
        edits.apply(&mut surface)?;
        let mut analysis = Analysis::of(surface, args.rings.into())?;
        analysis.close(cap, args.rings.into())?;
        analyses.push(analysis);
        progress.step();
    }
    surface::report_omitted(&analyses[0].surface, &args.cage.source)?;
    if args.json {
        args.output.write_json(&Document::new(&analyses, args.rings.into()))
    } else {
        args.output.write(|out| write_text(&analyses, args.all, out))
    }
}

/// A surface and what was measured on it.
pub struct Analysis {
    surface: Surface,
    report: CurvatureReport,
    shapes: Vec<PointShape>,
    /// Of the caps behind these rings, if there are any.
    caps: Vec<CapReport>,
}

impl Analysis {
    /// Measures `surface` over `rings` rings around every extraordinary point.
    pub fn of(surface: Surface, rings: usize) -> Result<Self, Failure> {
        let report = curvature_report(&surface, rings)
            .map_err(|error| Failure::Unusable(error.to_string()))?;
        let shapes = shape(&surface, rings);
        Ok(Self { surface, report, shapes, caps: Vec::new() })
    }

    /// Closes the surface and measures the caps too.
    fn close(&mut self, kind: Option<CapKind>, rings: usize) -> Result<(), Failure> {
        cap::close(&mut self.surface, kind, rings)?;
        self.caps = cap_report(&self.surface);
        Ok(())
    }

    /// The surface.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// For every point the length of the range of H in the last ring.
    pub fn last_spans(&self) -> impl Iterator<Item = f64> {
        let last = |p: &PointReport| p.rings.last().map_or(0.0, |ring| ring.mean.length());
        self.report.points.iter().map(last)
    }

    /// The largest absolute mean curvature around an extraordinary point, by its index.
    pub fn largest_mean(&self, point: usize) -> f64 {
        let mean = self.report.points[point].total.mean;
        mean.max.abs().max(mean.min.abs())
    }

    /// The largest of the growths that [`point_table`] lists.
    pub fn worst_growth(&self) -> f64 {
        self.report.points.iter().map(growth).fold(0.0, f64::max)
    }

    fn scheme(&self) -> &'static str {
        self.surface.options().scheme.name()
    }

    /// Every point with what was measured there.
    fn points(&self) -> impl Iterator<Item = Point<'_>> {
        let places = self.surface.extraordinary_points().iter();
        let measured = self.report.points.iter().zip(&self.shapes);
        places.zip(measured).map(|(place, (report, shape))| {
            let cap = self.caps.iter().find(|cap| cap.point == report.point);
            Point { place, report, shape, cap }
        })
    }
}

/// An extraordinary point and what was measured there.
#[derive(Clone, Copy)]
struct Point<'a> {
    place: &'a ExtraordinaryPoint,
    report: &'a PointReport,
    shape: &'a PointShape,
    cap: Option<&'a CapReport>,
}

/// The most points of a table that is to be short.
const SHORT: usize = 12;

fn write_text(analyses: &[Analysis], all: bool, out: &mut dyn Write) -> io::Result<()> {
    let shown = if all { None } else { most_varied(analyses) };
    let wanted = |point: usize| shown.as_ref().is_none_or(|shown| shown.contains(&point));
    writeln!(out, "{}", point_table(analyses, |point, _| wanted(point)))?;
    if let Some(shown) = &shown {
        let count = analyses[0].report.points.len();
        writeln!(out, "{} of {count} points; all of them with --all\n", shown.len())?;
    }
    writeln!(out, "{}", jump_table(analyses))?;
    if analyses.iter().any(|analysis| !analysis.caps.is_empty()) {
        writeln!(out, "{}", cap_table(analyses, wanted))?;
        CAP_LEGEND.iter().try_for_each(|line| writeln!(out, "{line}"))?;
    }
    LEGEND.iter().try_for_each(|line| writeln!(out, "{line}"))
}

/// The points with the longest range of H in the last ring, under any of the schemes; `None` if
/// there are not more than [`SHORT`] in all.
fn most_varied(analyses: &[Analysis]) -> Option<BTreeSet<usize>> {
    let count = analyses[0].report.points.len();
    if count <= SHORT {
        return None;
    }
    let mut spans = vec![0.0_f64; count];
    for analysis in analyses {
        let largest = spans.iter_mut().zip(analysis.last_spans());
        largest.for_each(|(span, own)| *span = span.max(own));
    }
    let mut points: Vec<usize> = (0..count).collect();
    points.sort_by(|&a, &b| spans[b].total_cmp(&spans[a]));
    Some(points.into_iter().take(SHORT).collect())
}

/// Ranges of the extraordinary points that are `wanted` (by their index and place), the schemes
/// one below the other.
pub fn point_table(
    analyses: &[Analysis],
    wanted: impl Fn(usize, &ExtraordinaryPoint) -> bool,
) -> Table {
    let mut table = Table::new(&[
        "point",
        "valence",
        "scheme",
        "K min",
        "K max",
        "H min",
        "H max",
        "growth",
        "H along rays",
        "H around rings",
        "energy",
        "H jump",
    ]);
    let mut rows: Vec<(&str, Point)> = Vec::new();
    for analysis in analyses {
        let points = analysis.points().filter(|p| wanted(p.report.point, p.place));
        rows.extend(points.map(|point| (analysis.scheme(), point)));
    }
    // All schemes have the same points; the sort is stable and keeps the schemes in order.
    rows.sort_by_key(|(_, point)| point.report.point);
    rows.into_iter().for_each(|(scheme, point)| table.push(point_row(scheme, point)));
    table
}

fn point_row(scheme: &str, Point { place, report, shape, .. }: Point) -> Vec<String> {
    let RingCurvature { gauss, mean } = report.total;
    let ranges = [gauss.min, gauss.max, mean.min, mean.max, growth(report)];
    let shape = [shape.along_rays, shape.around_rings, shape.energy];
    let names = [point_name(place), place.valence.to_string(), scheme.to_owned()];
    let numbers = ranges.into_iter().chain(shape).chain([report.mean_jump_across_rings]);
    names.into_iter().chain(numbers.map(short)).collect()
}

/// The largest jumps over all patch borders of each surface.
pub fn jump_table(analyses: &[Analysis]) -> Table {
    let mut table = Table::new(&["all borders", "position jump", "tangent jump", "curvature jump"]);
    for analysis in analyses {
        let Defect { position, tangent_plane, curvature } = analysis.report.jumps.defect;
        let numbers = [position, tangent_plane, curvature].map(short);
        table.push([analysis.scheme().to_owned()].into_iter().chain(numbers));
    }
    table
}

/// The caps of the extraordinary points that are `wanted`, the schemes one below the other.
fn cap_table(analyses: &[Analysis], wanted: impl Fn(usize) -> bool) -> Table {
    let mut table = Table::new(&[
        "point",
        "scheme",
        "cap",
        "G0",
        "G1 lines",
        "G1 ring",
        "G2 lines",
        "G2 inside",
        "G2 ring",
        "H min",
        "H max",
        "H outside",
    ]);
    let points = analyses[0].surface.extraordinary_points();
    for (point, place) in points.iter().enumerate().filter(|&(point, _)| wanted(point)) {
        for analysis in analyses {
            let caps = analysis.caps.iter().filter(|cap| cap.point == point);
            caps.for_each(|cap| table.push(cap_row(&point_name(place), analysis.scheme(), cap)));
        }
    }
    table
}

fn cap_row(point: &str, scheme: &str, cap: &CapReport) -> Vec<String> {
    let position = [cap.lines, cap.inside, cap.ring].map(|d| d.position).into_iter();
    let numbers = [
        position.fold(0.0, f64::max),
        cap.lines.tangent_plane,
        cap.ring.tangent_plane,
        cap.lines.curvature,
        cap.inside.curvature,
        cap.ring.curvature,
        cap.curvature.mean.min,
        cap.curvature.mean.max,
        cap.excess().unwrap_or(f64::NAN),
    ];
    let kind = format!("bi-{} {m} x {m}", cap.degree, m = cap.split);
    let names = [point.to_owned(), scheme.to_owned(), kind];
    names.into_iter().chain(numbers.map(short)).collect()
}

/// How much longer the range of H is in the last ring than in the first: above 1 where
/// curvature oscillates more and more, as under pinched highlight lines.
fn growth(report: &PointReport) -> f64 {
    let length = |ring: Option<&RingCurvature>| ring.map_or(f64::NAN, |r| r.mean.length());
    length(report.rings.last()) / length(report.rings.first())
}
