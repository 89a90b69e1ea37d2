//! `evenlight analyze`: curvature and continuity around every extraordinary point.

use std::io::{self, Write};
use std::sync::Arc;

use clap::Args;
use evenlight::analyse::continuity::Jumps;
use evenlight::analyse::curvature::{
    CurvatureReport, PointReport, Range, RingCurvature, curvature_report,
};
use evenlight::surface::ExtraordinaryPoint;
use evenlight::{Cage, SchemeKind, Surface, SurfaceOptions};
use serde::Serialize;

use crate::error::Failure;
use crate::input::{self, Source};
use crate::options::{RulesArg, rules_name, scheme_parser};
use crate::output::Target;
use crate::progress::Progress;
use crate::table::{Table, short};

/// Arguments of `evenlight analyze`.
#[derive(Args, Debug)]
pub struct AnalyzeArgs {
    /// The cage: an OBJ file with quads and n-gons, counter-clockwise; `-` for stdin
    cage: Source,

    /// Schemes to compare
    #[arg(long, value_delimiter = ',', default_value = "cc,eg", value_parser = scheme_parser())]
    schemes: Vec<SchemeKind>,

    #[command(flatten)]
    rules: RulesArg,

    /// Number of rings around every extraordinary point; ring k reaches to 2^-k of a sector
    #[arg(long, value_name = "K", default_value_t = 6, value_parser = clap::value_parser!(u8).range(1..=24))]
    rings: u8,

    /// JSON instead of a table, with the ranges of every ring
    #[arg(long)]
    json: bool,

    /// The file to write; `-` for stdout
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: Target,
}

/// What the columns of the tables mean.
pub const LEGEND: [&str; 3] = [
    "K (1/unit^2), H (1/unit): Gauss and mean curvature over all rings.",
    "growth: the length of the range of H in the last ring over that in the first.",
    "jumps: of H between rings (1/unit); of position (units), tangent plane (radians) and \
     curvature (1/unit) across all patch borders.",
];

/// Runs `evenlight analyze`.
pub fn run(args: &AnalyzeArgs, quiet: bool) -> Result<(), Failure> {
    let cage = input::read_cage(&args.cage)?;
    let progress = Progress::new(args.schemes.len(), quiet);
    let mut analyses = Vec::new();
    for &scheme in &args.schemes {
        let options = SurfaceOptions { scheme, rules: args.rules.rules.into() };
        progress.stage(format!("Analysing {}", options.scheme.name()));
        analyses.push(Analysis::of(&cage, options, args.rings.into(), &args.cage)?);
        progress.step();
    }
    input::report_omitted(&analyses[0].surface, &args.cage)?;
    if args.json {
        args.output.write_json(&Document::new(&analyses, args.rings.into()))
    } else {
        args.output.write(|out| write_text(&analyses, out))
    }
}

/// A surface and what was measured on it.
pub struct Analysis {
    surface: Surface,
    report: CurvatureReport,
}

impl Analysis {
    /// Measures the surface over `cage`, which was read from `source`.
    pub fn of(
        cage: &Arc<Cage>,
        options: SurfaceOptions,
        rings: usize,
        source: &Source,
    ) -> Result<Self, Failure> {
        let surface = input::build(Arc::clone(cage), options, source)?;
        let report = curvature_report(&surface, rings);
        Ok(Self { surface, report })
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

    /// The largest of the growths that [`point_table`] lists.
    pub fn worst_growth(&self) -> f64 {
        self.report.points.iter().map(growth).fold(0.0, f64::max)
    }

    fn scheme(&self) -> &'static str {
        self.surface.options().scheme.name()
    }

    fn place(&self, report: &PointReport) -> &ExtraordinaryPoint {
        &self.surface.extraordinary_points()[report.point]
    }
}

fn write_text(analyses: &[Analysis], out: &mut dyn Write) -> io::Result<()> {
    write!(out, "{}\n{}", point_table(analyses, |_| true), jump_table(analyses))?;
    out.write_all(b"\n")?;
    LEGEND.iter().try_for_each(|line| writeln!(out, "{line}"))
}

/// Ranges and jumps of the extraordinary points that are `wanted`, the schemes one below the
/// other.
pub fn point_table(analyses: &[Analysis], wanted: impl Fn(&ExtraordinaryPoint) -> bool) -> Table {
    let mut table = Table::new(&[
        "point",
        "valence",
        "scheme",
        "K min",
        "K max",
        "H min",
        "H max",
        "growth",
        "H jump",
        "position jump",
        "tangent jump",
        "curvature jump",
    ]);
    let points = analyses.first().map_or(&[][..], |a| a.surface.extraordinary_points());
    let points = points.iter().enumerate().filter(|(_, place)| wanted(place));
    for (k, place) in points {
        for analysis in analyses {
            table.push(point_row(analysis.scheme(), place, &analysis.report.points[k]));
        }
    }
    table
}

fn point_row(scheme: &str, place: &ExtraordinaryPoint, report: &PointReport) -> Vec<String> {
    let RingCurvature { gauss, mean } = report.total;
    let Jumps { position, tangent_plane, curvature, .. } = report.jumps;
    let ranges = [gauss.min, gauss.max, mean.min, mean.max, growth(report)];
    let jumps = [report.mean_jump_across_rings, position, tangent_plane, curvature];
    let names = [name(place), place.valence.to_string(), scheme.to_owned()];
    names.into_iter().chain(ranges.into_iter().chain(jumps).map(short)).collect()
}

/// The largest jumps over all patch borders of each surface.
pub fn jump_table(analyses: &[Analysis]) -> Table {
    let mut table = Table::new(&["all borders", "position jump", "tangent jump", "curvature jump"]);
    for analysis in analyses {
        let Jumps { position, tangent_plane, curvature, .. } = analysis.report.jumps;
        let numbers = [position, tangent_plane, curvature].map(short);
        table.push([analysis.scheme().to_owned()].into_iter().chain(numbers));
    }
    table
}

fn name(place: &ExtraordinaryPoint) -> String {
    match (place.vertex, place.face) {
        (Some(v), _) => format!("vertex {}", v.0),
        (_, Some(f)) => format!("face {}", f.0),
        _ => String::new(),
    }
}

/// How much longer the range of H is in the last ring than in the first: above 1 where
/// curvature oscillates more and more, as under pinched highlight lines.
fn growth(report: &PointReport) -> f64 {
    let length = |ring: Option<&RingCurvature>| ring.map_or(f64::NAN, |r| r.mean.length());
    length(report.rings.last()) / length(report.rings.first())
}

/// The JSON document.
#[derive(Serialize)]
pub struct Document {
    rings: usize,
    schemes: Vec<SchemeRecord>,
}

/// What was measured with one scheme.
#[derive(Serialize)]
struct SchemeRecord {
    scheme: &'static str,
    /// `null` for schemes without tables.
    rules: Option<&'static str>,
    /// One record per extraordinary vertex, then per centre of an n-gon.
    points: Vec<PointRecord>,
    /// The largest jumps across all patch borders of the surface.
    jumps: JumpRecord,
}

/// What was measured around one extraordinary point.
#[derive(Serialize)]
struct PointRecord {
    /// `null` at the centre of an n-gon, whose number is then in `face`.
    vertex: Option<u32>,
    face: Option<u32>,
    valence: usize,
    level: usize,
    /// Gauss curvature over all rings, in 1/unit^2.
    gauss: RangeRecord,
    /// Mean curvature over all rings, in 1/unit.
    mean: RangeRecord,
    /// The range of the mean curvature in the last ring over that in the first.
    mean_span_growth: f64,
    /// The largest jump of the mean curvature across a border between rings, in 1/unit.
    mean_jump_across_rings: f64,
    /// The largest jumps across the borders of all patches around the point.
    jumps: JumpRecord,
    rings: Vec<RingRecord>,
}

/// The ranges in one ring.
#[derive(Serialize)]
struct RingRecord {
    ring: usize,
    gauss: RangeRecord,
    mean: RangeRecord,
}

/// A range; both ends are `null` if there is no value.
#[derive(Serialize)]
struct RangeRecord {
    min: f64,
    max: f64,
}

/// The largest jumps.
#[derive(Serialize)]
struct JumpRecord {
    /// In units of the cage.
    position: f64,
    /// The angle between the normals, in radians.
    tangent_plane: f64,
    /// Of the principal curvatures, in 1/unit.
    curvature: f64,
    /// Of the derivatives up to order two in matched parameters, relative to the patch.
    parametric: f64,
}

impl Document {
    /// The document on `analyses` over `rings` rings.
    pub fn new(analyses: &[Analysis], rings: usize) -> Self {
        Self { rings, schemes: analyses.iter().map(SchemeRecord::new).collect() }
    }
}

impl SchemeRecord {
    fn new(analysis: &Analysis) -> Self {
        let point = |report| PointRecord::new(analysis.place(report), report);
        Self {
            scheme: analysis.scheme(),
            rules: rules_name(analysis.surface.options()),
            points: analysis.report.points.iter().map(point).collect(),
            jumps: analysis.report.jumps.into(),
        }
    }
}

impl PointRecord {
    fn new(place: &ExtraordinaryPoint, report: &PointReport) -> Self {
        let ring = |(k, r): (usize, &RingCurvature)| RingRecord {
            ring: k + 1,
            gauss: r.gauss.into(),
            mean: r.mean.into(),
        };
        Self {
            vertex: place.vertex.map(|v| v.0),
            face: place.face.map(|f| f.0),
            valence: place.valence,
            level: place.level,
            gauss: report.total.gauss.into(),
            mean: report.total.mean.into(),
            mean_span_growth: growth(report),
            mean_jump_across_rings: report.mean_jump_across_rings,
            jumps: report.jumps.into(),
            rings: report.rings.iter().enumerate().map(ring).collect(),
        }
    }
}

impl From<Range> for RangeRecord {
    fn from(range: Range) -> Self {
        Self { min: range.min, max: range.max }
    }
}

impl From<Jumps> for JumpRecord {
    fn from(jumps: Jumps) -> Self {
        let Jumps { position, tangent_plane, curvature, parametric } = jumps;
        Self { position, tangent_plane, curvature, parametric }
    }
}
