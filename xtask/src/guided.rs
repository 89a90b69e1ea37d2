//! `cargo xtask guided`: how even guided surfaces are at the centre, what the contraction and the
//! degree of the guide change, as tables in the documentation.

use std::error::Error;
use std::fmt::Write as _;
use std::sync::Arc;

use evenlight::analyse::curvature::{Range, curvature_over};
use evenlight::analyse::shape::shape_energy;
use evenlight::patch::Patch;
use evenlight::surface::Role;
use evenlight::{Cage, Contraction, SchemeKind, Surface, SurfaceOptions};
use evenlight_guide::guided::characteristic::CharacteristicRing;
use evenlight_guide::guided::fit::{generating_matrix_of_degree, guide};
use evenlight_guide::guided::net::CNet;
use evenlight_guide::guided::rings::{Form, Rings};
use evenlight_guide::linear::Matrix;
use evenlight_guide::real::Real;

use crate::shape::{OBSTACLES, read, short};
use crate::threads::map_on_threads;

/// Measure guided surfaces and write the tables of crates/evenlight/docs/07-guided.md.
#[derive(clap::Args)]
pub struct Arguments {
    /// Write nothing; fail if a number in the tables differs from the measured one in its third
    /// digit
    #[arg(long)]
    check: bool,
}

/// Writes or checks the tables.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let tables = range_table()? + &contraction_table()? + &guide_table()?;
    let document = "crates/evenlight/docs/07-guided.md";
    crate::document::write_or_check(document, "guided", &tables, arguments.check)
}

fn build(
    cage: &Arc<Cage>,
    scheme: SchemeKind,
    contraction: Contraction,
) -> Result<Surface, Box<dyn Error>> {
    let options = SurfaceOptions { scheme, contraction, ..SurfaceOptions::default() };
    Ok(Surface::build(cage.clone(), options)?)
}

/// The geometric mean.
fn mean(values: &[f64]) -> f64 {
    (values.iter().map(|x| x.ln()).sum::<f64>() / values.len() as f64).exp()
}

// ------------------------------------------------------------------------ ranges of H

const RING_VALENCES: [usize; 7] = [3, 5, 6, 7, 8, 9, 10];
const SHOWN_RINGS: [usize; 6] = [2, 6, 9, 12, 20, 21];

/// The surfaces of the table, by name.
const SHOWN: [(&str, SchemeKind, Contraction); 7] = [
    ("cc", SchemeKind::CatmullClark, Contraction::CatmullClark),
    ("guided3", SchemeKind::Guided3, Contraction::CatmullClark),
    ("guided4", SchemeKind::Guided4, Contraction::CatmullClark),
    ("guided5", SchemeKind::Guided5, Contraction::CatmullClark),
    ("guided6", SchemeKind::Guided6, Contraction::CatmullClark),
    ("guided5, half", SchemeKind::Guided5, Contraction::Half),
    ("guided6, half", SchemeKind::Guided6, Contraction::Half),
];

fn range_table() -> Result<String, Box<dyn Error>> {
    let mut out = String::from("### Length of the range of H over ring k, `saddle_nN`\n\n");
    let rings = SHOWN_RINGS.map(|ring| ring.to_string()).join(" | ");
    writeln!(out, "| n | scheme | lambda | {rings} | ratio of the last two |")?;
    writeln!(out, "|{}", " --- |".repeat(SHOWN_RINGS.len() + 4))?;
    for n in RING_VALENCES {
        let cage = read(&crate::workspace(&format!("{OBSTACLES}/saddle_n{n}.obj")))?;
        for (name, scheme, contraction) in SHOWN {
            let surface = build(&cage, scheme, contraction)?;
            let lengths = range_lengths(&surface);
            let cells = lengths.map(short).join(" | ");
            let (lambda, ratio) = (
                surface.rings(0).expect("the point is one of the surface").lambda(),
                lengths[5] / lengths[4],
            );
            writeln!(out, "| {n} | {name} | {lambda:.3} | {cells} | {ratio:.3} |")?;
        }
    }
    writeln!(out)?;
    Ok(out)
}

/// How long the ranges of H over the rings shown are, around the first extraordinary point.
fn range_lengths(surface: &Surface) -> [f64; SHOWN_RINGS.len()] {
    let mut ranges = SHOWN_RINGS.map(|_| Range::EMPTY);
    for place in surface.patch_places(SHOWN_RINGS[SHOWN_RINGS.len() - 1]) {
        let (Some(0), Role::Ring(ring)) = (place.point, place.role) else { continue };
        if let Some(k) = SHOWN_RINGS.iter().position(|&shown| shown == ring + 1) {
            ranges[k] = ranges[k].union(curvature_over(surface, &place).mean);
        }
    }
    ranges.map(Range::length)
}

// ------------------------------------------------------------------------ contraction

/// Rings that cover the hole but for a part that has no energy to speak of: .65^12 is .006.
const RINGS: usize = 12;

const COMPARED: [SchemeKind; 2] = [SchemeKind::Guided5, SchemeKind::Guided6];

/// The energies of one cage: for each of [`COMPARED`] as Catmull-Clark's and as 1/2.
struct Energies {
    valence: usize,
    of: [[f64; 2]; COMPARED.len()],
}

fn contraction_table() -> Result<String, Box<dyn Error>> {
    let mut files: Vec<_> = std::fs::read_dir(crate::workspace(OBSTACLES))?
        .map(|entry| Ok(entry?.path()))
        .collect::<std::io::Result<_>>()?;
    files.sort();
    let measured = map_on_threads(&files, |file| energies(file).map_err(|e| e.to_string()));
    let measured = measured.into_iter().collect::<Result<Vec<_>, String>>()?;
    let rows: Vec<Energies> = measured.into_iter().flatten().collect();
    let mut out =
        String::from("### Shape energy of contraction 1/2 over that of Catmull-Clark's\n\n");
    writeln!(out, "Obstacle course, all {RINGS} rings; geometric mean, least and largest.\n")?;
    writeln!(out, "| n | cages | guided5 | | | guided6 | | |\n|{}", " --- |".repeat(8))?;
    let of = |n: usize| rows.iter().filter(|row| row.valence == n).collect::<Vec<_>>();
    let groups = RING_VALENCES.map(|n| (n.to_string(), of(n)));
    for (name, rows) in groups.into_iter().chain([("all".to_owned(), rows.iter().collect())]) {
        write!(out, "| {name} | {} |", rows.len())?;
        for k in 0..COMPARED.len() {
            let ratios: Vec<f64> = rows.iter().map(|row| row.of[k][1] / row.of[k][0]).collect();
            let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
            let largest = ratios.iter().copied().fold(0.0, f64::max);
            write!(out, " {} | {} | {} |", short(mean(&ratios)), short(least), short(largest))?;
        }
        writeln!(out)?;
    }
    writeln!(out)?;
    Ok(out)
}

/// The energies of a cage with points of one valence; `None` if it has others or is flat.
fn energies(file: &std::path::Path) -> Result<Option<Energies>, Box<dyn Error>> {
    /// Relative to a curvature of 1: rounding of planes.
    const FLAT: f64 = 1e-9;
    let cage = read(file)?;
    let valences: Vec<usize> = cage.interior_valences().into_keys().filter(|&n| n != 4).collect();
    let [valence] = valences[..] else { return Ok(None) };
    let energy = |scheme, contraction| -> Result<f64, Box<dyn Error>> {
        let surface = build(&cage, scheme, contraction)?;
        let rings = surface.patches(RINGS).filter(|patch| patch.place.role != Role::Regular);
        Ok(rings.map(|patch| shape_energy(&patch.patch)).sum())
    };
    let mut of = [[0.0; 2]; COMPARED.len()];
    for (of, scheme) in of.iter_mut().zip(COMPARED) {
        *of = [energy(scheme, Contraction::CatmullClark)?, energy(scheme, Contraction::Half)?];
    }
    Ok((of[0][0] > FLAT).then_some(Energies { valence, of }))
}

// ------------------------------------------------------------------------ degree of the guide

const GUIDE_VALENCES: [usize; 5] = [3, 5, 6, 8, 10];

/// The rings whose energy is compared, as for all schemes.
const GUIDE_RINGS: usize = 4;

fn guide_table() -> Result<String, Box<dyn Error>> {
    let mut out =
        String::from("### Shape energy of bi-5 rings with a guide of lower degree, over bi-5\n\n");
    let names = SHAPES.map(|(name, _)| name).join(" | ");
    writeln!(out, "| n | guide | {names} | mean |\n|{}", " --- |".repeat(SHAPES.len() + 3))?;
    let found = map_on_threads(&GUIDE_VALENCES, |&n| guide_energies(n));
    for (n, [bi3, bi4, bi5]) in GUIDE_VALENCES.into_iter().zip(found) {
        for (degree, energies) in [(4, bi4), (3, bi3)] {
            let ratios: Vec<f64> = energies.iter().zip(&bi5).map(|(e, best)| e / best).collect();
            let cells: Vec<String> = ratios.iter().map(|&x| short(x)).collect();
            let mean = short(mean(&ratios));
            writeln!(out, "| {n} | bi-{degree} | {} | {mean} |", cells.join(" | "))?;
        }
    }
    writeln!(out)?;
    Ok(out)
}

/// The energies of all shapes with guides of degree 3, 4 and 5.
fn guide_energies(n: usize) -> [Vec<f64>; 3] {
    let chi = CharacteristicRing::catmull_clark(n);
    let rings = Rings::new(&chi, Form::Bi5);
    let nets: Vec<Matrix> = SHAPES.iter().map(|&(_, shape)| net(&chi, shape)).collect();
    [3, 4, 5].map(|degree| {
        let generating = generating_matrix_of_degree(degree, &chi);
        let energy = |net: &Matrix| {
            let guide = guide(&generating, n, net);
            let rings = (0..GUIDE_RINGS).flat_map(|level| rings.ring(level, &guide, net));
            rings.flatten().map(|square| shape_energy(&patch(&square))).sum()
        };
        nets.iter().map(energy).collect()
    })
}

/// A bi-5 patch from its coefficients, one coordinate per column.
fn patch(square: &Matrix) -> Patch {
    let coef = |k: usize| [0, 1, 2].map(|d| square[(k, d)].to_f64());
    Patch::new([5, 5], (0..square.num_rows()).map(coef).collect()).expect("a bi-5 patch")
}

/// What a node of a net is pulled up by: its place in the plane, its sector and (a, b) there.
type Shape = fn([f64; 2], Option<(usize, usize, usize)>) -> f64;

/// Heights over the characteristic net of Catmull-Clark subdivision.
const SHAPES: [(&str, Shape); 7] = [
    ("bowl", |[x, y], _| 0.3 * (x * x + y * y)),
    ("elliptic bowl", |[x, y], _| 0.3 * (x * x + 0.35 * y * y)),
    ("saddle", |[x, y], _| 0.3 * (x * x - y * y)),
    ("monkey saddle", |[x, y], _| 0.15 * (x * x * x - 3.0 * x * y * y)),
    ("spike beside", |_, node| spike(node, Some((0, 1, 1)))),
    ("spike on a line", |_, node| spike(node, Some((0, 0, 1)))),
    ("spike in the middle", |_, node| spike(node, None)),
];

fn spike(node: Option<(usize, usize, usize)>, pulled: Option<(usize, usize, usize)>) -> f64 {
    if node == pulled { 0.5 } else { 0.0 }
}

/// The c-net of a shape, one coordinate per column.
fn net(chi: &CharacteristicRing, shape: Shape) -> Matrix {
    let numbering = CNet { valence: chi.valence };
    let plane = chi.net();
    let angle = std::f64::consts::TAU / chi.valence as f64;
    let point = |node: usize| {
        let [u, v] = [0, 1].map(|k| plane[(node, k)].to_f64());
        let at = [u + v * angle.cos(), v * angle.sin()];
        // Node (a, b) of a sector is number 2a + b - 1, b being 1 or 2.
        let own = (node / 6, node % 6 / 2, node % 2 + 1);
        let place = (node != numbering.centre()).then_some(own);
        [at[0], at[1], shape(at, place)]
    };
    Matrix::from_fn(numbering.num_nodes(), 3, |node, k| Real::from(point(node)[k]))
}
