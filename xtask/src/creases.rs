//! `cargo xtask creases`: what fair rings beside a crease change, measured over ten boundary nets,
//! as tables in the documentation.

use std::error::Error;
use std::f64::consts::PI;
use std::fmt::{self, Write as _};

use evenlight::analyse::curvature::{Range, curvature_over};
use evenlight::analyse::shape::{self, shape_energy};
use evenlight::mesh::BoundaryRule;
use evenlight::point::{cross, norm};
use evenlight::surface::{CreaseRings, PointRule, Role};
use evenlight::{Cage, Mesh, Point, Surface, SurfaceOptions, VertexId};

use crate::shape::short;
use crate::threads::map_on_threads;

/// Measure fair rings beside creases and write the tables of
/// crates/evenlight/docs/11-boundaries-and-creases.md.
#[derive(clap::Args)]
pub struct Arguments {
    /// Write nothing; fail if a number in the tables differs from the measured one in its third
    /// digit
    #[arg(long)]
    check: bool,
}

/// The numbers of faces at the vertex.
const FACES: [usize; 8] = [1, 3, 4, 5, 6, 8, 10, 12];

/// The first rings over which energies are taken: as in chapter 6, and as in chapter 8.
const ENERGY_RINGS: [usize; 2] = [shape::ENERGY_RINGS, 6];

/// All rings that are looked at, and the first of those that show what the rules do by themselves;
/// counted from 0 outside.
const RINGS: usize = 8;
const INNER_RINGS: usize = 2;

/// Writes or checks the tables.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let found = map_on_threads(&FACES, |&f| measured(f).map_err(|error| error.to_string()));
    let rows = found.into_iter().collect::<Result<Vec<Row>, String>>()?;
    let document = "crates/evenlight/docs/11-boundaries-and-creases.md";
    crate::document::write_or_check(document, "creases", &tables(&rows)?, arguments.check)
}

// ------------------------------------------------------------------------ nets

/// A surface over the half-plane y >= 0, whose boundary is the crease.
type Shape = Box<dyn Fn(f64, f64) -> Point>;

fn shapes() -> Vec<(&'static str, Shape)> {
    fn graph(height: fn(f64, f64) -> f64) -> Shape {
        Box::new(move |x, y| [x, y, height(x, y)])
    }
    let bent = |x: f64, y: f64| [x, y + 0.2 * x * x, 0.2 * x * x + 0.1 * x * y];
    vec![
        ("xy", graph(|x, y| 0.3 * x * y)),
        ("saddle", graph(|x, y| 0.2 * (x * x - y * y))),
        ("cup", graph(|x, y| 0.2 * (x * x + y * y))),
        ("x^2", graph(|x, _| 0.25 * x * x)),
        ("y^2", graph(|_, y| 0.25 * y * y)),
        ("bent", Box::new(bent)),
        ("monkey", graph(|x, y| 0.1 * (x * x * x - 3.0 * x * y * y))),
        ("random 1", random(1)),
        ("random 2", random(2)),
        ("random 3", random(3)),
    ]
}

/// A plane, bent by six functions with pseudo-random coefficients in all three coordinates.
fn random(seed: u64) -> Shape {
    const MOST: f64 = 0.1;
    let mut state = seed;
    let mut next = || {
        // Knuth's linear congruential generator; its upper bits are the good ones.
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        MOST * ((state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0)
    };
    let coefs: [[f64; 6]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| next()));
    Box::new(move |x, y| {
        let cubes = [x * x * x / 3.0, y * y * y / 3.0];
        let functions = [x * x, x * y, y * y, cubes[0], cubes[1], (2.0 * x + y).sin()];
        let bend = coefs.map(|row| row.iter().zip(functions).map(|(c, f)| c * f).sum::<f64>());
        [x + bend[0], y + bend[1], bend[2]]
    })
}

/// The faces around vertex 0 on the boundary: f sectors of 3 x 3 quads, the quarter planes of (a,b)
/// with their angles scaled by 2/f.
///
/// ```text
///         sector 1          Line s has the nodes (a,0) of sector s, which
///    (0,b) \   / (a,0)      are the nodes (0,a) of sector s-1.
///           \ /
///  ----------o----------    line 0 to the right, line f to the left
/// ```
fn half_disc(f: usize, shape: &Shape) -> Mesh {
    let at = |s: usize, a: usize, b: usize| match (a, b) {
        (0, 0) => 0,
        (0, b) => 1 + 3 * (s + 1) + b - 1,
        (a, 0) => 1 + 3 * s + a - 1,
        (a, b) => 1 + 3 * (f + 1) + 9 * s + 3 * (a - 1) + b - 1,
    };
    let position = |(s, a, b): (usize, usize, usize)| {
        let (a, b) = (a as f64, b as f64);
        let angle = (PI * s as f64 + 2.0 * b.atan2(a)) / f as f64;
        shape(a.hypot(b) * angle.cos(), a.hypot(b) * angle.sin())
    };
    let lines = (0..=f).flat_map(|s| (1..4).map(move |a| (s, a, 0)));
    let inside = (0..f).flat_map(|s| (0..9).map(move |k| (s, k / 3 + 1, k % 3 + 1)));
    let places = std::iter::once((0, 0, 0)).chain(lines).chain(inside);
    let faces = (0..f).flat_map(|s| (0..9).map(move |k| (s, k / 3, k % 3))).map(|(s, a, b)| {
        let corners = [(a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1)];
        corners.map(|(a, b)| at(s, a, b) as u32)
    });
    let mut mesh = Mesh::new(places.map(position).collect(), faces);
    mesh.tags.boundary = BoundaryRule::EdgeOnly;
    mesh
}

// ------------------------------------------------------------------------ measuring

/// What is measured for one number of faces.
struct Row {
    faces: usize,
    /// Fair over Catmull-Clark's, by net, over the first rings of both numbers.
    energies: [Vec<f64>; ENERGY_RINGS.len()],
    /// Likewise, of the length of the range of H over the inner rings.
    range: Vec<f64>,
    /// The largest |H| of the last ring over that of the one before it, on the cup: Catmull-Clark's
    /// and fair.
    growth: [f64; 2],
    /// How far the Jacobian of the fair characteristic map is from its mean: the root of the mean
    /// of the squares, and the most.
    jacobian: [f64; 2],
}

fn measured(f: usize) -> Result<Row, Box<dyn Error>> {
    let mut row = Row {
        faces: f,
        energies: [Vec::new(), Vec::new()],
        range: Vec::new(),
        growth: [0.0; 2],
        jacobian: jacobian(f)?,
    };
    for (name, shape) in shapes() {
        let mesh = half_disc(f, &shape);
        let default = rings(&mesh, CreaseRings::CatmullClark)?;
        let fair = rings(&mesh, CreaseRings::Fair)?;
        for (energies, first) in row.energies.iter_mut().zip(ENERGY_RINGS) {
            energies.push(energy(&fair[..first]) / energy(&default[..first]));
        }
        row.range.push(range_length(&fair) / range_length(&default));
        if name == "cup" {
            row.growth = [growth(&default), growth(&fair)];
        }
    }
    Ok(row)
}

/// What is measured of a ring.
#[derive(Clone, Copy)]
struct Ring {
    /// The integral of |grad H|^2.
    energy: f64,
    /// The range of H.
    mean: Range,
}

fn energy(rings: &[Ring]) -> f64 {
    rings.iter().map(|ring| ring.energy).sum()
}

fn range_length(rings: &[Ring; RINGS]) -> f64 {
    rings[INNER_RINGS..].iter().fold(Range::EMPTY, |all, ring| all.union(ring.mean)).length()
}

fn growth(rings: &[Ring; RINGS]) -> f64 {
    let [before, last] = [RINGS - 2, RINGS - 1].map(|k| rings[k].mean.max.max(-rings[k].mean.min));
    last / before
}

/// The surface over a net and the number of the extraordinary point at vertex 0.
fn build(mesh: &Mesh, creases: CreaseRings) -> Result<(Surface, usize), Box<dyn Error>> {
    let options = SurfaceOptions { creases, ..SurfaceOptions::default() };
    let surface = Surface::build(Cage::new(mesh.clone())?, options)?;
    let is_fair = creases == CreaseRings::Fair;
    let point = surface.extraordinary_points().iter().position(|point| {
        point.vertex() == Some(VertexId(0))
            && matches!(point.rule, PointRule::FairCrease(_)) == is_fair
    });
    Ok((surface, point.ok_or("vertex 0 has not the rings asked for")?))
}

/// The rings around vertex 0, from the outermost.
fn rings(mesh: &Mesh, creases: CreaseRings) -> Result<[Ring; RINGS], Box<dyn Error>> {
    let (surface, point) = build(mesh, creases)?;
    let mut rings = [Ring { energy: 0.0, mean: Range::EMPTY }; RINGS];
    for place in surface.patch_places(RINGS).filter(|place| place.point == Some(point)) {
        let Role::Ring(number) = place.role else { continue };
        let ring = &mut rings[number];
        ring.energy +=
            shape_energy(&surface.patch(&place).expect("the point is one of the surface"));
        ring.mean = ring.mean.union(curvature_over(&surface, &place).mean);
    }
    Ok(rings)
}

/// The deviations of the Jacobian of the characteristic map, which is what a flat net tends to, but
/// for an affine map.
fn jacobian(f: usize) -> Result<[f64; 2], Box<dyn Error>> {
    /// What is not of the characteristic map halves with every ring.
    const RING: usize = 20;
    const GRID: usize = 8;
    let flat: Shape = Box::new(|x, y| [x, y, 0.0]);
    let (surface, point) = build(&half_disc(f, &flat), CreaseRings::Fair)?;
    let middle = |k: usize| (k as f64 + 0.5) / GRID as f64;
    let mut values = Vec::new();
    let rings = surface.rings(point).expect("the point is one of the surface");
    for patch in rings.patches(RING).expect("there are so many rings") {
        let jets = (0..GRID * GRID).map(|k| patch.jet(middle(k / GRID), middle(k % GRID)));
        values.extend(jets.map(|jet| norm(cross(jet.du, jet.dv))));
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let deviations = values.iter().map(|value| (value / mean - 1.0).abs());
    let squares = deviations.clone().map(|d| d * d).sum::<f64>();
    Ok([(squares / values.len() as f64).sqrt(), deviations.fold(0.0, f64::max)])
}

// ------------------------------------------------------------------------ eigenvalues

/// The eigenvalue of Catmull-Clark subdivision for cos t, t = j pi / f.
fn catmull_clark(t: f64) -> f64 {
    (t.cos() + 5.0 + ((t.cos() + 1.0) * (t.cos() + 9.0)).sqrt()) / 16.0
}

/// The eigenvalue of [BLZ00]'s rules for j = 2: the larger root mu of
/// (mu - gamma - cos(2t)/8) (mu - 1/4) = (cos t)^2 / 16, t = j pi / (2f).
fn blz(f: usize) -> f64 {
    let f = f as f64;
    let t = PI / f;
    let gamma = 3.0 / 8.0 - (PI / f).cos() / 4.0;
    let (p, q) = (gamma + (2.0 * t).cos() / 8.0, 0.25);
    (p + q + ((p - q) * (p - q) + 0.25 * t.cos() * t.cos()).sqrt()) / 2.0
}

// ------------------------------------------------------------------------ tables

fn tables(rows: &[Row]) -> Result<String, fmt::Error> {
    let mut out = String::new();
    rules_table(&mut out, rows)?;
    ratio_table(&mut out, rows)?;
    by_net(&mut out, "Energy, rings 0 to 3", rows, |row| &row.energies[0])?;
    by_net(&mut out, "Energy, rings 0 to 5", rows, |row| &row.energies[1])?;
    by_net(&mut out, "Range of H, rings 2 to 7", rows, |row| &row.range)?;
    writeln!(out)?;
    Ok(out)
}

/// What does not depend on the net, and how H grows on the cup.
fn rules_table(out: &mut String, rows: &[Row]) -> fmt::Result {
    writeln!(out, "\n### Eigenvalues, growth of H, and the fair Jacobian\n")?;
    let names = "lambda cc | mu cc | mu [BLZ00] | growth cc | growth fair | Jacobian | most";
    writeln!(out, "| f | {names} |\n|{}", " --- |".repeat(8))?;
    for row in rows {
        let angle = PI / row.faces as f64;
        // With a single face there are no such modes.
        let eigenvalues = match row.faces {
            1 => ["-", "-", "-"].map(str::to_owned),
            f => [catmull_clark(angle), catmull_clark(2.0 * angle), blz(f)].map(short),
        };
        let found = row.growth.into_iter().chain(row.jacobian).map(short).collect::<Vec<_>>();
        writeln!(out, "| {} | {} | {} |", row.faces, eigenvalues.join(" | "), found.join(" | "))?;
    }
    Ok(())
}

/// Means over all nets.
fn ratio_table(out: &mut String, rows: &[Row]) -> fmt::Result {
    writeln!(out, "\n### Fair over Catmull-Clark's, ten nets: geometric mean and most\n")?;
    let names = "energy, rings 0 to 3 | most | energy, rings 0 to 5 | most | range of H | most";
    writeln!(out, "| f | {names} |\n|{}", " --- |".repeat(7))?;
    for row in rows {
        let [outer, all] = &row.energies;
        let cells = [outer, all, &row.range].map(|ratios| {
            let most = ratios.iter().copied().fold(0.0, f64::max);
            format!("{} | {}", short(mean(ratios)), short(most))
        });
        writeln!(out, "| {} | {} |", row.faces, cells.join(" | "))?;
    }
    Ok(())
}

fn by_net(out: &mut String, what: &str, rows: &[Row], of: fn(&Row) -> &[f64]) -> fmt::Result {
    let names: Vec<&str> = shapes().iter().map(|&(name, _)| name).collect();
    writeln!(out, "\n### {what}, fair over Catmull-Clark's, net by net\n")?;
    writeln!(out, "| f | {} |\n|{}", names.join(" | "), " --- |".repeat(names.len() + 1))?;
    for row in rows {
        let cells: Vec<String> = of(row).iter().map(|&ratio| short(ratio)).collect();
        writeln!(out, "| {} | {} |", row.faces, cells.join(" | "))?;
    }
    Ok(())
}

/// The geometric mean.
fn mean(values: &[f64]) -> f64 {
    (values.iter().map(|x| x.ln()).sum::<f64>() / values.len() as f64).exp()
}
