//! `cargo xtask shape`: the shape of all schemes over the obstacle course, as tables in the
//! documentation; or, for given cages, the curvature of ring after ring.
//!
//! A *row* is made of all extraordinary points of one valence of one cage. Planes are left out:
//! all schemes reproduce them.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use evenlight::analyse::curvature::{Range, RingCurvature, curvature_over};
use evenlight::analyse::shape::{PointShape, shape};
use evenlight::io::load::Format;
use evenlight::surface::Role;
use evenlight::{Cage, SchemeKind, Surface, SurfaceOptions};

use crate::threads::map_on_threads;

/// Measure the shape of all schemes over the obstacle course and write the tables of
/// crates/evenlight/docs/06-shape.md.
#[derive(clap::Args)]
pub struct Arguments {
    /// OBJ files: print how long the ranges of H and K are, ring by ring, and write nothing
    cages: Vec<PathBuf>,
    /// How many rings to print
    #[arg(long, default_value_t = 40, requires = "cages")]
    rings: usize,
    /// Write nothing; fail if a number in the tables differs from the measured one in its third
    /// digit
    #[arg(long, conflicts_with = "cages")]
    check: bool,
}

const DOCUMENT: &str = "crates/evenlight/docs/06-shape.md";
/// The cages of the obstacle course.
pub const OBSTACLES: &str = "data/meshes/obstacle";

/// The rings over which ranges and oscillations are measured.
const RINGS: usize = 12;

/// The schemes that are compared with Catmull-Clark, the first of [`SchemeKind::ALL`].
const OTHERS: &[SchemeKind] = SchemeKind::ALL.split_at(1).1;

/// Prints rings of the given cages, or writes or checks the tables.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    if !arguments.cages.is_empty() {
        return arguments.cages.iter().try_for_each(|path| print_rings(path, arguments.rings));
    }
    let tables = tables(&measured_obstacles()?)? + &ring_table()?;
    crate::document::write_or_check(DOCUMENT, "shape", &tables, arguments.check)
}

// ------------------------------------------------------------------------ measuring

/// What is measured of a row, for one scheme.
#[derive(Clone, Copy, Debug, Default)]
struct Measures {
    /// The sum of shape energies.
    energy: f64,
    /// The length of the longest range of H.
    mean: f64,
    /// The length of the longest range of K.
    gauss: f64,
    /// The largest oscillation along rays.
    along_rays: f64,
    /// The largest oscillation around rings.
    around_rings: f64,
}

/// All extraordinary points of one valence of one cage.
#[derive(Clone, Debug)]
struct Row {
    cage: String,
    valence: usize,
    /// In the order of [`SchemeKind::ALL`].
    schemes: Vec<Measures>,
}

impl Measures {
    fn with(self, point: &PointShape) -> Self {
        Self {
            energy: self.energy + point.energy,
            mean: self.mean.max(point.curvature.mean.length()),
            gauss: self.gauss.max(point.curvature.gauss.length()),
            along_rays: self.along_rays.max(point.along_rays),
            around_rings: self.around_rings.max(point.around_rings),
        }
    }
}

impl Row {
    /// The family of shapes: the cage's name without its number; all frames are one, and so are
    /// all that is made of three or four planes.
    fn family(&self) -> &str {
        let cut = |name: &'static str| self.cage.starts_with(name).then_some(name);
        let number = self.cage.rfind("_n").or_else(|| self.cage.rfind("_m"));
        let own = number.map_or(self.cage.as_str(), |at| &self.cage[..at]);
        cut("frame").or_else(|| cut("planes")).unwrap_or(own)
    }

    /// A measure of every scheme divided by Catmull-Clark's, schemes in the order of [`OTHERS`].
    fn ratios(&self, measure: fn(&Measures) -> f64) -> Vec<f64> {
        let cc = measure(&self.schemes[0]);
        self.schemes[1..].iter().map(|m| measure(m) / cc).collect()
    }
}

/// The cage of a file.
pub fn read(path: &Path) -> Result<Arc<Cage>, Box<dyn Error>> {
    let (cage, _) = Format::Obj.read_cage(&std::fs::read(path)?)?;
    Ok(Arc::new(cage))
}

/// The surface of a scheme over it.
pub fn build(cage: &Arc<Cage>, scheme: SchemeKind) -> Result<Surface, Box<dyn Error>> {
    let options = SurfaceOptions { scheme, ..SurfaceOptions::default() };
    Ok(Surface::build(cage.clone(), options)?)
}

/// All rows, in the order of file names.
fn measured_obstacles() -> Result<Vec<Row>, Box<dyn Error>> {
    let files = std::fs::read_dir(crate::workspace(OBSTACLES))?;
    let mut files = files.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>()?;
    files.sort();
    let rows = map_on_threads(&files, |file| measured(file).map_err(|error| error.to_string()));
    let rows = rows.into_iter().collect::<Result<Vec<_>, String>>()?;
    Ok(rows.into_iter().flatten().collect())
}

/// The rows of one cage.
fn measured(file: &Path) -> Result<Vec<Row>, Box<dyn Error>> {
    let cage = read(file)?;
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut rows: BTreeMap<usize, Vec<Measures>> = BTreeMap::new();
    for (k, scheme) in SchemeKind::ALL.into_iter().enumerate() {
        let surface = build(&cage, scheme)?;
        for found in shape(&surface, RINGS).iter().filter(|found| found.scale > 0.0) {
            let valence = surface.extraordinary_points()[found.point].valence;
            let empty = || vec![Measures::default(); SchemeKind::ALL.len()];
            let row = rows.entry(valence).or_insert_with(empty);
            row[k] = row[k].with(found);
        }
    }
    let row = |(valence, schemes)| Row { cage: name.clone(), valence, schemes };
    Ok(rows.into_iter().map(row).collect())
}

// ------------------------------------------------------------------------ tables

fn tables(rows: &[Row]) -> Result<String, std::fmt::Error> {
    let mut out = String::new();
    let families: BTreeSet<&str> = rows.iter().map(Row::family).collect();
    let by_family: Vec<Group> = families
        .into_iter()
        .map(|family| Group::of(family, rows, |row| row.family() == family))
        .collect();
    let valences: BTreeSet<usize> = rows.iter().map(|row| row.valence).collect();
    let mut by_valence: Vec<Group> = valences
        .into_iter()
        .map(|n| Group::of(&format!("n = {n}"), rows, |row| row.valence == n))
        .collect();
    by_valence.push(Group::of("all", rows, |_| true));

    writeln!(out, "\n### Shape energy over that of Catmull-Clark, geometric means\n")?;
    ratio_table(&mut out, &by_family, |m| m.energy)?;
    ratio_table(&mut out, &by_valence, |m| m.energy)?;
    writeln!(out, "### Length of the range of H, rings 1 to {RINGS}, likewise\n")?;
    ratio_table(&mut out, &by_valence, |m| m.mean)?;
    writeln!(out, "### Length of the range of K, rings 1 to {RINGS}, likewise\n")?;
    ratio_table(&mut out, &by_valence, |m| m.gauss)?;
    writeln!(out, "### Oscillation of H along rays, rings 1 to {RINGS}, means\n")?;
    mean_table(&mut out, &by_valence, |m| m.along_rays)?;
    writeln!(out, "### Oscillation of H around rings, rings 1 to {RINGS}, means\n")?;
    mean_table(&mut out, &by_valence, |m| m.around_rings)?;
    counts(&mut out, rows)?;
    writeln!(out, "### All rows with more shape energy than Catmull-Clark (ratio)\n")?;
    worse(&mut out, rows, |row| row.ratios(|m| m.energy), 1.005)?;
    writeln!(out, "### All rows with a longer range of H than Catmull-Clark (ratio)\n")?;
    worse(&mut out, rows, |row| row.ratios(|m| m.mean), 1.005)?;
    writeln!(
        out,
        "### All rows with more oscillation around rings than Catmull-Clark (difference)\n"
    )?;
    worse(&mut out, rows, |row| differences(row, |m| m.around_rings), 0.005)?;
    Ok(out)
}

/// Rows under one name.
struct Group<'a> {
    name: String,
    rows: Vec<&'a Row>,
}

impl<'a> Group<'a> {
    fn of(name: &str, rows: &'a [Row], belongs: impl Fn(&Row) -> bool) -> Self {
        Self { name: name.to_owned(), rows: rows.iter().filter(|row| belongs(row)).collect() }
    }
}

fn header(out: &mut String, first: &[&str], schemes: &[SchemeKind]) -> std::fmt::Result {
    let titles = first.iter().copied().chain(schemes.iter().map(|scheme| scheme.name()));
    writeln!(out, "| {} |", titles.collect::<Vec<_>>().join(" | "))?;
    let rules = vec!["---"; first.len() + schemes.len()];
    writeln!(out, "| {} |", rules.join(" | "))
}

fn line(out: &mut String, first: &[String], numbers: &[f64]) -> std::fmt::Result {
    let cells = first.iter().cloned().chain(numbers.iter().map(|&x| short(x)));
    writeln!(out, "| {} |", cells.collect::<Vec<_>>().join(" | "))
}

/// Geometric means of ratios to Catmull-Clark.
fn ratio_table(
    out: &mut String,
    groups: &[Group],
    measure: fn(&Measures) -> f64,
) -> std::fmt::Result {
    header(out, &["", "rows"], OTHERS)?;
    for Group { name, rows } in groups {
        let ratios: Vec<Vec<f64>> = rows.iter().map(|row| row.ratios(measure)).collect();
        let mean = |k: usize| {
            let logarithms = ratios.iter().map(|r| r[k].ln()).sum::<f64>();
            (logarithms / ratios.len() as f64).exp()
        };
        let means: Vec<f64> = (0..OTHERS.len()).map(mean).collect();
        line(out, &[name.clone(), rows.len().to_string()], &means)?;
    }
    writeln!(out)
}

/// Arithmetic means of all schemes.
fn mean_table(
    out: &mut String,
    groups: &[Group],
    measure: fn(&Measures) -> f64,
) -> std::fmt::Result {
    header(out, &["", "rows"], &SchemeKind::ALL)?;
    for Group { name, rows } in groups {
        let mean = |k: usize| {
            rows.iter().map(|row| measure(&row.schemes[k])).sum::<f64>() / rows.len() as f64
        };
        let means: Vec<f64> = (0..SchemeKind::ALL.len()).map(mean).collect();
        line(out, &[name.clone(), rows.len().to_string()], &means)?;
    }
    writeln!(out)
}

fn differences(row: &Row, measure: fn(&Measures) -> f64) -> Vec<f64> {
    let cc = measure(&row.schemes[0]);
    row.schemes[1..].iter().map(|m| measure(m) - cc).collect()
}

/// In how many rows every scheme is worse than Catmull-Clark.
fn counts(out: &mut String, rows: &[Row]) -> std::fmt::Result {
    writeln!(out, "### In how many of {} rows a scheme is worse than Catmull-Clark\n", rows.len())?;
    header(out, &[""], OTHERS)?;
    let count = |values: &dyn Fn(&Row) -> Vec<f64>, limit: f64| -> Vec<f64> {
        let values: Vec<Vec<f64>> = rows.iter().map(values).collect();
        (0..OTHERS.len()).map(|k| values.iter().filter(|v| v[k] > limit).count() as f64).collect()
    };
    let lines = [
        ("shape energy", count(&|row| row.ratios(|m| m.energy), 1.005)),
        ("range of H", count(&|row| row.ratios(|m| m.mean), 1.005)),
        ("range of K", count(&|row| row.ratios(|m| m.gauss), 1.005)),
        ("along rays", count(&|row| differences(row, |m| m.along_rays), 0.005)),
        ("around rings", count(&|row| differences(row, |m| m.around_rings), 0.005)),
    ];
    for (name, counts) in lines {
        let counts: Vec<String> = counts.iter().map(|x| format!("{x:.0}")).collect();
        writeln!(out, "| {name} | {} |", counts.join(" | "))?;
    }
    writeln!(out)
}

/// All rows in which some value is above a limit, with these values.
fn worse(
    out: &mut String,
    rows: &[Row],
    values: impl Fn(&Row) -> Vec<f64>,
    limit: f64,
) -> std::fmt::Result {
    header(out, &["cage", "n"], OTHERS)?;
    for row in rows {
        let values = values(row);
        if values.iter().any(|&x| x > limit) {
            let cells = values.iter().map(|&x| if x > limit { short(x) } else { "-".to_owned() });
            let cells: Vec<String> = cells.collect();
            writeln!(out, "| {} | {} | {} |", row.cage, row.valence, cells.join(" | "))?;
        }
    }
    writeln!(out)
}

/// A number with three digits.
pub fn short(x: f64) -> String {
    let digits = match x.abs() {
        0.0 => return "0".to_owned(),
        size if !(9.995e-4..9999.5).contains(&size) => return format!("{x:.2e}"),
        size => [9.995e-3, 0.09995, 0.9995, 9.995, 99.95].iter().filter(|&&end| size < end).count(),
    };
    format!("{x:.digits$}")
}

// ------------------------------------------------------------------------ rings

/// The schemes whose rings are shown.
const RING_SCHEMES: [SchemeKind; 6] = [
    SchemeKind::CatmullClark,
    SchemeKind::EvolvingGuide,
    SchemeKind::Qas3,
    SchemeKind::Qas4,
    SchemeKind::Guided5,
    SchemeKind::Guided6,
];

/// The cages and rings of the table in the documentation.
const RING_CAGES: [&str; 5] =
    ["saddle_n3", "saddle_n5", "saddle_n8", "paraboloid_n8", "cone_flat_n10"];
const SHOWN_RINGS: [usize; 8] = [1, 2, 4, 8, 16, 24, 32, 40];

/// The longest ranges of one ring over all points.
fn ring_lengths(surface: &Surface, rings: &[usize]) -> Vec<[f64; 2]> {
    let last = rings.iter().copied().max().unwrap_or(0);
    let points = surface.extraordinary_points().len();
    let empty = RingCurvature { gauss: Range::EMPTY, mean: Range::EMPTY };
    let mut found = vec![vec![empty; points]; rings.len()];
    for place in surface.patch_places(last) {
        let (Some(point), Role::Ring(ring)) = (place.point, place.role) else { continue };
        if let Some(k) = rings.iter().position(|&shown| shown == ring + 1) {
            let here = curvature_over(surface, &place);
            let all = &mut found[k][point];
            (all.mean, all.gauss) = (all.mean.union(here.mean), all.gauss.union(here.gauss));
        }
    }
    let longest = |ranges: &Vec<RingCurvature>| {
        [|r: &RingCurvature| r.mean.length(), |r: &RingCurvature| r.gauss.length()]
            .map(|length| ranges.iter().map(length).fold(0.0, f64::max))
    };
    found.iter().map(longest).collect()
}

fn ring_table() -> Result<String, Box<dyn Error>> {
    let mut out = String::from("### Length of the range of H over single rings\n\n");
    let titles = SHOWN_RINGS.map(|ring| ring.to_string()).join(" | ");
    writeln!(out, "| cage | scheme | {titles} |\n|{}", " --- |".repeat(SHOWN_RINGS.len() + 2))?;
    for name in RING_CAGES {
        let cage = read(&crate::workspace(OBSTACLES).join(format!("{name}.obj")))?;
        for scheme in RING_SCHEMES {
            let lengths = ring_lengths(&build(&cage, scheme)?, &SHOWN_RINGS);
            let lengths: Vec<f64> = lengths.into_iter().map(|[mean, _]| mean).collect();
            line(&mut out, &[name.to_owned(), scheme.name().to_owned()], &lengths)?;
        }
    }
    writeln!(out)?;
    Ok(out)
}

fn print_rings(path: &Path, rings: usize) -> Result<(), Box<dyn Error>> {
    let cage = read(path)?;
    let all: Vec<usize> = (1..=rings).collect();
    let lengths = RING_SCHEMES.map(|scheme| Ok(ring_lengths(&build(&cage, scheme)?, &all)));
    let lengths = lengths.into_iter().collect::<Result<Vec<_>, Box<dyn Error>>>()?;
    println!("{}: length of the longest ranges of H and K over a ring", path.display());
    let titles =
        RING_SCHEMES.map(|scheme| format!("{:>12} H {:>12} K", scheme.name(), scheme.name()));
    println!("ring{}", titles.concat());
    for ring in 0..rings {
        let cells = lengths.iter().flat_map(|of| of[ring]).map(|x| format!("{:>14}", short(x)));
        println!("{:4}{}", ring + 1, cells.collect::<String>());
    }
    Ok(())
}
