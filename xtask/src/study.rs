//! `cargo xtask study`: all schemes over the obstacle course by independent measures of fairness,
//! as tables in the documentation.
//!
//! A *row* is made of all extraordinary points of one valence of one cage, as in
//! [`shape`](crate::shape). What is measured is said in the chapter.

use std::collections::BTreeMap;
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::{self, Write as _};
use std::path::Path;
use std::sync::Arc;

use evenlight::analyse::shape::{gauss_energy, shape, shape_energy};
use evenlight::io::obj;
use evenlight::rings::Rings;
use evenlight::surface::ExtraordinaryPoint;
use evenlight::{Cage, Mesh, SchemeKind, Surface};

use crate::shape::{OBSTACLES, build, read, short};
use crate::threads::map_on_threads;

/// Measure the fairness of all schemes over the obstacle course in several ways and write the
/// tables of crates/evenlight/docs/08-fair.md.
#[derive(clap::Args)]
pub struct Arguments {
    /// Write nothing; fail if a number in the tables differs from the measured one in its third
    /// digit
    #[arg(long)]
    check: bool,
}

const DOCUMENT: &str = "crates/evenlight/docs/08-fair.md";

/// The schemes, in the order of the tables.
const SCHEMES: [SchemeKind; 13] = [
    SchemeKind::CatmullClark,
    SchemeKind::EvolvingGuide,
    SchemeKind::Pas4,
    SchemeKind::Qas4,
    SchemeKind::Qas3,
    SchemeKind::Pas3,
    SchemeKind::Fair4,
    SchemeKind::Fair4d,
    SchemeKind::Fair3,
    SchemeKind::Guided3,
    SchemeKind::Guided4,
    SchemeKind::Guided5,
    SchemeKind::Guided6,
];

/// The place of a scheme in [`SCHEMES`].
const QAS4: usize = 3;
const FAIR4: usize = 6;

/// The rings of which energies are taken, and those of which H is sampled; counted from 0 outside.
const ENERGY_RINGS: usize = 6;
const RINGS: usize = 8;

/// The first of the rings that show what the scheme does by itself.
const INNER_RINGS: usize = 2;

/// Rays in each sector, samples of a ray in each ring, samples of a curve in each sector.
const RAYS: usize = 4;
const RAY_STEPS: usize = 12;
const CURVE_STEPS: usize = 32;

/// What H must turn back by to count as an extremum, as a part of the curvature scale.
const TURN: f64 = 0.02;

/// Writes or checks the tables.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    let rows = measured_obstacles()?;
    tables(&mut text, &rows)?;
    convex_table(&mut text, &rows)?;
    spike_table(&mut text, &spikes()?)?;
    losses(&mut text, &rows)?;
    crate::document::write_or_check(DOCUMENT, "study", &text, arguments.check)
}

// ------------------------------------------------------------------------ measuring

/// What is measured of a row, for one scheme: sums over its points, but for `least`.
#[derive(Clone, Copy, Debug, Default)]
struct Measures {
    /// The integral of |grad H|^2 over the first rings.
    mean_energy: f64,
    /// That of |grad K|^2.
    gauss_energy: f64,
    /// The length of the range of H over the inner rings.
    range: f64,
    /// The total variation of H along rays, their mean.
    along: f64,
    /// The total variation of H around rings, its mean over the curves of the inner rings.
    around: f64,
    /// The extrema of H along all rays.
    along_extrema: f64,
    /// The extrema of H around the curves of the inner rings.
    around_extrema: f64,
    /// The least K, as a multiple of the squared curvature scale; of convex nets only.
    least: f64,
}

/// All extraordinary points of one valence of one cage.
struct Row {
    cage: String,
    valence: usize,
    /// In the order of [`SCHEMES`].
    schemes: Vec<Measures>,
}

fn measured_obstacles() -> Result<Vec<Row>, Box<dyn Error>> {
    let files = std::fs::read_dir(crate::workspace(OBSTACLES))?;
    let mut files = files.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>()?;
    files.sort();
    let rows = map_on_threads(&files, |file| measured(file).map_err(|error| error.to_string()));
    Ok(rows.into_iter().collect::<Result<Vec<_>, String>>()?.into_iter().flatten().collect())
}

/// The rows of one cage; planes have none.
fn measured(file: &Path) -> Result<Vec<Row>, Box<dyn Error>> {
    let cage = read(file)?;
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut rows: BTreeMap<usize, Vec<Measures>> = BTreeMap::new();
    let scales = shape(&build(&cage, SchemeKind::CatmullClark)?, 0);
    for (k, scheme) in SCHEMES.into_iter().enumerate() {
        let surface = build(&cage, scheme)?;
        for at in scales.iter().filter(|at| at.scale > 0.0) {
            let point = &surface.extraordinary_points()[at.point];
            let around = Around {
                point,
                rings: surface.rings(at.point).expect("the point is one of the surface"),
                scale: at.scale,
            };
            let empty = Measures { least: f64::INFINITY, ..Measures::default() };
            let row = rows.entry(point.valence).or_insert_with(|| vec![empty; SCHEMES.len()]);
            around.add_to(&mut row[k]);
            if is_convex(&name) {
                row[k].least = row[k].least.min(around.least_gauss());
            }
        }
    }
    let row = |(valence, schemes)| Row { cage: name.clone(), valence, schemes };
    Ok(rows.into_iter().map(row).collect())
}

/// A point, and the curvature scale of its border.
struct Around<'a> {
    point: &'a ExtraordinaryPoint,
    rings: &'a Rings,
    scale: f64,
}

impl Around<'_> {
    fn add_to(&self, sum: &mut Measures) {
        for patch in (0..ENERGY_RINGS)
            .flat_map(|ring| self.rings.patches(ring).expect("it is a place of the surface"))
        {
            sum.mean_energy += shape_energy(&patch);
            sum.gauss_energy += gauss_energy(&patch);
        }
        let turn = TURN * self.scale;
        let rays = self.rays();
        for ray in &rays {
            sum.along += variation(ray) / rays.len() as f64;
            sum.along_extrema += extrema(ray, turn) as f64;
        }
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let radii = (2 * INNER_RINGS..2 * RINGS).map(|k| self.radius(k / 2, 0.5 * (k % 2) as f64));
        for curve in radii.map(|r| self.curve(r)) {
            let mean: Vec<f64> = curve.iter().map(|&(mean, _)| mean).collect();
            sum.around += variation(&mean) / (2 * (RINGS - INNER_RINGS)) as f64;
            sum.around_extrema += extrema(&mean, turn) as f64;
            least = mean.iter().copied().fold(least, f64::min);
            most = mean.iter().copied().fold(most, f64::max);
        }
        sum.range += most - least;
    }

    /// The radius at `part` in [0,1] of the way through a ring.
    fn radius(&self, ring: usize, part: f64) -> f64 {
        let sigma = self.rings.sigma();
        (0..ring).fold(1.0 - part * (1.0 - sigma), |r, _| sigma * r)
    }

    /// H along every ray, from the outer border inwards.
    fn rays(&self) -> Vec<Vec<f64>> {
        let sectors = self.point.sectors.iter().map(|sector| sector.index);
        let ray = |(s, k): (usize, usize)| {
            let [a, b] = on_corner(k as f64 / RAYS as f64);
            let steps = (0..=RINGS * RAY_STEPS).map(|step| {
                let part = (step % RAY_STEPS) as f64 / RAY_STEPS as f64;
                let r = self.radius(step / RAY_STEPS, part);
                self.rings.eval(s, r * a, r * b).expect("it is a place of the surface").mean
            });
            steps.filter(|mean| mean.is_finite()).collect()
        };
        sectors.flat_map(|s| (0..RAYS).map(move |k| (s, k))).map(ray).collect()
    }

    /// H and K on the curve max(a,b) = r, in all sectors.
    fn curve(&self, r: f64) -> Vec<(f64, f64)> {
        let sectors = self.point.sectors.iter().map(|sector| sector.index);
        let places = sectors.flat_map(|s| (0..=CURVE_STEPS).map(move |k| (s, k)));
        let points = places.map(|(s, k)| {
            let [a, b] = on_corner(k as f64 / CURVE_STEPS as f64);
            let point = self.rings.eval(s, r * a, r * b).expect("it is a place of the surface");
            (point.mean, point.gauss)
        });
        points.filter(|(mean, _)| mean.is_finite()).collect()
    }

    /// The least K over all rings but the outermost, whose border the cage determines, on four
    /// curves in each; over the squared scale.
    fn least_gauss(&self) -> f64 {
        let radii = (4..4 * RINGS).map(|k| self.radius(k / 4, 0.25 * (k % 4) as f64));
        let values = radii.flat_map(|r| self.curve(r)).map(|(_, gauss)| gauss);
        values.fold(f64::INFINITY, f64::min) / (self.scale * self.scale)
    }
}

/// The point at `t` in [0,1] of the way (1,0) - (1,1) - (0,1).
fn on_corner(t: f64) -> [f64; 2] {
    if t < 0.5 { [1.0, 2.0 * t] } else { [2.0 - 2.0 * t, 1.0] }
}

/// The total variation of a sequence.
fn variation(values: &[f64]) -> f64 {
    values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum()
}

/// How often a sequence turns back by more than `turn`.
fn extrema(values: &[f64], turn: f64) -> usize {
    let Some((&first, rest)) = values.split_first() else { return 0 };
    let (mut count, mut direction) = (0, 0.0);
    let (mut low, mut high) = (first, first);
    for &x in rest {
        (low, high) = (low.min(x), high.max(x));
        if direction <= 0.0 && x > low + turn {
            count += usize::from(direction < 0.0);
            (direction, high) = (1.0, x);
        } else if direction >= 0.0 && x < high - turn {
            count += usize::from(direction > 0.0);
            (direction, low) = (-1.0, x);
        }
    }
    count
}

/// A valence and, for a node across a face and one along an edge, a number for every scheme.
type Spikes = (usize, [Vec<f64>; 2]);

/// For each valence and scheme the far-side |H| of a spike over its largest |H|: at a node across a
/// face, and at one along an edge.
fn spikes() -> Result<Vec<Spikes>, Box<dyn Error>> {
    let valences = [3, 5, 6, 7, 8, 9, 10];
    let measured = map_on_threads(&valences, |&n| {
        let file = crate::workspace(OBSTACLES).join(format!("flat_n{n}.obj"));
        let bytes = std::fs::read(file).map_err(|error| error.to_string())?;
        let flat = obj::read(&bytes).map_err(|error| error.to_string())?.mesh;
        let [face, edge] = [2, 1].map(|corner| {
            let of = |scheme| far_side(&flat, corner, scheme).map_err(|error| error.to_string());
            SCHEMES.into_iter().map(of).collect::<Result<Vec<f64>, String>>()
        });
        Ok::<_, String>((n, [face?, edge?]))
    });
    Ok(measured.into_iter().collect::<Result<Vec<_>, String>>()?)
}

/// The largest |H| beyond 100 degrees from a node that is lifted out of a plane, over the largest
/// |H| at all; rings 0 to 3. The node is that `corner` of a face around the point, counted from it.
fn far_side(flat: &Mesh, corner: usize, scheme: SchemeKind) -> Result<f64, Box<dyn Error>> {
    let mut mesh = flat.clone();
    let surface = build(&Arc::new(Cage::new(mesh.clone())?), scheme)?;
    let center = surface.extraordinary_points()[0].vertex().ok_or("the point is a vertex")?;
    let node = mesh.faces.iter().find_map(|face| {
        let at = face.iter().position(|&v| v == center)?;
        Some(face[(at + corner) % face.len()].index())
    });
    let node = node.ok_or("a face has the point")?;
    let (at, from) = (mesh.positions[node], mesh.positions[center.index()]);
    let spike = [at[0] - from[0], at[1] - from[1]];
    mesh.positions[node][2] += 0.5 * spike[0].hypot(spike[1]);
    Ok(far_over_largest(&build(&Arc::new(Cage::new(mesh)?), scheme)?, from, spike))
}

fn far_over_largest(surface: &Surface, from: [f64; 3], spike: [f64; 2]) -> f64 {
    let point = &surface.extraordinary_points()[0];
    let rings = surface.rings(0).expect("the point is one of the surface");
    let (mut far, mut largest) = (0.0_f64, 0.0_f64);
    let sectors = point.sectors.iter().flat_map(|s| (0..64).map(move |step| (s.index, step)));
    for (sector, step) in sectors {
        let r = 0.5_f64.powf(f64::from(step) / 16.0);
        for k in 0..=CURVE_STEPS {
            let [a, b] = on_corner(k as f64 / CURVE_STEPS as f64);
            let found = rings.eval(sector, r * a, r * b).expect("it is a place of the surface");
            let [x, y] = [0, 1].map(|d| found.jet.p[d] - from[d]);
            let angle = (spike[0] * y - spike[1] * x).atan2(spike[0] * x + spike[1] * y);
            largest = largest.max(found.mean.abs());
            if angle.abs() > TAU * 100.0 / 360.0 {
                far = far.max(found.mean.abs());
            }
        }
    }
    far / largest
}

// ------------------------------------------------------------------------ tables

fn header(out: &mut String, first: &str) -> fmt::Result {
    let names: Vec<&str> = SCHEMES.iter().map(|scheme| scheme.name()).collect();
    writeln!(out, "| {first} | {} |", names.join(" | "))?;
    writeln!(out, "|{}", " --- |".repeat(SCHEMES.len() + 1))
}

fn line(out: &mut String, first: &str, numbers: impl Iterator<Item = f64>) -> fmt::Result {
    let cells: Vec<String> = numbers.map(short).collect();
    writeln!(out, "| {first} | {} |", cells.join(" | "))
}

/// A measure with its name.
type Named = (&'static str, fn(&Measures) -> f64);

/// The measures that are compared with QAS4's.
const RATIOS: [Named; 5] = [
    ("integral of grad H squared", |m| m.mean_energy),
    ("integral of grad K squared", |m| m.gauss_energy),
    ("range of H, rings 2 to 7", |m| m.range),
    ("total variation along rays", |m| m.along),
    ("total variation around rings", |m| m.around),
];

/// The measures that are added up.
const COUNTS: [Named; 2] =
    [("extrema along rays", |m| m.along_extrema), ("extrema around rings", |m| m.around_extrema)];

/// A title and the valences under it.
type Group = (&'static str, fn(usize) -> bool);

fn tables(out: &mut String, rows: &[Row]) -> fmt::Result {
    let groups: [Group; 3] =
        [("n = 3, 5, 6", |n| n < 7), ("n = 7 to 10", |n| n >= 7), ("all", |_| true)];
    for (title, belongs) in groups {
        let rows: Vec<&Row> = rows.iter().filter(|row| belongs(row.valence)).collect();
        let count = rows.len();
        writeln!(out, "\n### {title}: {count} rows, geometric means over qas4; counts\n")?;
        header(out, "")?;
        for (name, measure) in RATIOS {
            line(out, name, (0..SCHEMES.len()).map(|k| geometric_mean(&rows, k, measure)))?;
        }
        for (name, count) in COUNTS {
            let sum = |k: usize| rows.iter().map(|row| count(&row.schemes[k])).sum::<f64>();
            let sums: Vec<String> = (0..SCHEMES.len()).map(|k| format!("{:.0}", sum(k))).collect();
            writeln!(out, "| {name} | {} |", sums.join(" | "))?;
        }
    }
    Ok(())
}

fn geometric_mean(rows: &[&Row], k: usize, measure: fn(&Measures) -> f64) -> f64 {
    let logarithm = |row: &&Row| (measure(&row.schemes[k]) / measure(&row.schemes[QAS4])).ln();
    (rows.iter().map(logarithm).sum::<f64>() / rows.len() as f64).exp()
}

/// The families of convex nets.
const CONVEX: [&str; 3] = ["paraboloid_n", "paraboloid_par_n", "pillow_n"];

fn is_convex(cage: &str) -> bool {
    CONVEX.iter().any(|family| cage.starts_with(family))
}

fn convex_table(out: &mut String, rows: &[Row]) -> fmt::Result {
    let rows: Vec<&Row> = rows.iter().filter(|row| is_convex(&row.cage)).collect();
    writeln!(out, "\n### K on {} rows of convex nets\n", rows.len())?;
    header(out, "")?;
    let negative = |k: usize| rows.iter().filter(|row| row.schemes[k].least < -1e-6).count();
    let counts: Vec<String> = (0..SCHEMES.len()).map(|k| negative(k).to_string()).collect();
    writeln!(out, "| rows with K < 0 | {} |", counts.join(" | "))?;
    let least =
        |k: usize| rows.iter().map(|row| row.schemes[k].least).fold(f64::INFINITY, f64::min);
    line(out, "least K over scale squared", (0..SCHEMES.len()).map(least))
}

fn spike_table(out: &mut String, spikes: &[Spikes]) -> fmt::Result {
    for (kind, title) in ["across a face", "along an edge"].into_iter().enumerate() {
        writeln!(out, "\n### Far-side H of a spike {title}, over its largest H\n")?;
        header(out, "n")?;
        for (n, found) in spikes {
            line(out, &n.to_string(), found[kind].iter().copied())?;
        }
    }
    Ok(())
}

/// Where fair4 is worse than qas4 by more than 5 %.
fn losses(out: &mut String, rows: &[Row]) -> fmt::Result {
    writeln!(out, "\n### Rows in which fair4 is more than 5 % worse than qas4\n")?;
    writeln!(out, "| measure | rows | worst | cages |\n| --- | --- | --- | --- |")?;
    for (name, measure) in RATIOS {
        let ratio = |row: &Row| measure(&row.schemes[FAIR4]) / measure(&row.schemes[QAS4]);
        let mut worse: Vec<&Row> = rows.iter().filter(|row| ratio(row) > 1.05).collect();
        worse.sort_by(|a, b| ratio(b).total_cmp(&ratio(a)));
        let worst = worse.first().map_or(1.0, |row| ratio(row));
        let names: Vec<&str> = worse.iter().take(5).map(|row| row.cage.as_str()).collect();
        let count = format!("{} of {}", worse.len(), rows.len());
        writeln!(out, "| {name} | {count} | {} | {} |", short(worst), names.join(", "))?;
    }
    writeln!(out)
}
