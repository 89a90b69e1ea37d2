//! Scheme `cc` is OpenSubdiv's limit surface: positions, derivatives and texture coordinates, with
//! all its rules for boundaries, creases, corners, holes, polygons and seams.
//!
//! The golden results are those of OpenSubdiv at 100 points of every parametric quad, with feature
//! isolation at its deepest, 10 (`tools/osd_oracle`). At that depth OpenSubdiv's patches are exact
//! but for caps at irregular vertices, of a side of 2^-10 of a quad. Of our points only the corners
//! of quads can lie in caps. There derivatives are those of the cap and are left out; the point is
//! that of the limit surface but at darts and single faces with smooth corners, where it tends to
//! ours with the depth (star5_dart, first coordinate: -8.008e-4, -8.069e-4, -8.101e-4 for the
//! depths 8, 9, 10, so -8.137e-4 in the limit, which is ours).
#![allow(clippy::unwrap_used, reason = "a test that cannot read its data fails")]

mod common;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use common::options;
use evenlight::io::obj;
use evenlight::mesh::FaceVaryingRule;
use evenlight::{Cage, FaceId, Mesh, QuadId, SchemeKind, Surface};

/// Golden files have 13 decimals; 1e-12 is what is asked for.
const TOLERANCE: f64 = 1e-12;

/// At corners of quads that are in caps, for the reason above.
const CAP_TOLERANCE: f64 = 2e-5;

/// Likewise for cages of any size and valence.
const OWN_CAP_TOLERANCE: f64 = 1e-4;

const GRID: [f64; 10] = [0.0, 0.03, 0.125, 0.27, 0.4, 0.5, 0.61, 0.75, 0.9, 1.0];

/// Value and derivatives at the 100 points of a parametric quad.
type Points = Vec<[Vec<f64>; 3]>;

/// What OpenSubdiv says: a surface by (face, corner), and the faces without one.
#[derive(Clone, Default, PartialEq)]
struct Expected {
    quads: BTreeMap<(u32, usize), Points>,
    omitted: Vec<u32>,
}

/// The sections of a golden file: positions, then texture coordinates by rule.
fn golden(path: &Path) -> BTreeMap<String, Expected> {
    let text = std::fs::read_to_string(path).unwrap();
    let (mut sections, mut name, mut quad) = (BTreeMap::new(), String::new(), (0, 0));
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let words: Vec<&str> = line.split(' ').collect();
        match words[..] {
            ["positions"] | ["uv", _] => name = (*words.last().unwrap()).to_owned(),
            ["uv", mode, "as", other] => {
                let same: Expected = sections.get::<str>(other).cloned().unwrap();
                sections.insert(mode.to_owned(), same);
            }
            ["omitted", face] => {
                let section: &mut Expected = sections.entry(name.clone()).or_default();
                section.omitted.push(face.parse().unwrap());
            }
            ["quad", face, corner] => quad = (face.parse().unwrap(), corner.parse().unwrap()),
            _ => {
                let numbers: Vec<f64> = words.iter().map(|word| word.parse().unwrap()).collect();
                let width = numbers.len() / 3;
                let row = [0, 1, 2].map(|k| numbers[k * width..(k + 1) * width].to_vec());
                let section = sections.entry(name.clone()).or_default();
                section.quads.entry(quad).or_default().push(row);
            }
        }
    }
    sections
}

fn mesh(path: &Path) -> Mesh {
    obj::read(&std::fs::read(path).unwrap()).unwrap().mesh
}

/// The largest differences of values and derivatives, and where they are.
#[derive(Debug, Default)]
struct Difference {
    value: f64,
    derivative: f64,
    /// Of values in caps.
    cap: f64,
    place: String,
}

impl Difference {
    fn note(&mut self, kind: Kind, expected: &[f64], found: &[f64], place: impl Fn() -> String) {
        let pairs = expected.iter().zip(found);
        let size = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let size = if found.iter().any(|x| x.is_nan()) { f64::INFINITY } else { size };
        let own = match kind {
            Kind::Value => &mut self.value,
            Kind::Derivative => &mut self.derivative,
            Kind::Cap => &mut self.cap,
        };
        if size > *own {
            *own = size;
            self.place += &format!("\n    {}: {expected:?}, not {found:?}", place());
        }
    }

    fn is_small(&self, cap_tolerance: f64) -> bool {
        self.value < TOLERANCE && self.derivative < TOLERANCE && self.cap < cap_tolerance
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Value,
    Derivative,
    Cap,
}

/// What is compared. Seams make vertices of primvars irregular that those of the surface are not.
#[derive(Clone, Copy)]
enum Of {
    Positions,
    Primvar,
}

/// Compares a surface or primvar that `eval` gives at (face, corner, u, v).
fn compare(
    of: Of,
    surface: &Surface,
    expected: &Expected,
    eval: impl Fn(QuadId, f64, f64) -> Option<[Vec<f64>; 3]>,
) -> Difference {
    let mut difference = Difference::default();
    for (&(face, corner), points) in &expected.quads {
        let quad = surface.quad(FaceId(face), corner).unwrap();
        let is_whole = surface.quad(FaceId(face), 1).is_none();
        let places = GRID.into_iter().flat_map(|u| GRID.into_iter().map(move |v| (u, v)));
        for ((u, v), expected) in places.zip(points) {
            let place = || format!("face {face}, corner {corner}, ({u}, {v})");
            let missing = || [0; 3].map(|_| vec![f64::NAN; expected[0].len()]);
            let found = eval(quad, u, v).unwrap_or_else(missing);
            let is_cap = match of {
                Of::Positions => is_extraordinary(surface, quad, [u, v]),
                Of::Primvar => {
                    may_be_irregular(surface, face, corner, is_whole, u, v)
                        || is_corner(u, v) && found[1].iter().any(|x| x.is_nan())
                }
            };
            let kind = if is_cap { Kind::Cap } else { Kind::Value };
            difference.note(kind, &expected[0], &found[0], place);
            for k in (1..3).filter(|_| !is_cap) {
                difference.note(Kind::Derivative, &expected[k], &found[k], place);
            }
        }
    }
    for &face in &expected.omitted {
        let corners = if surface.quad(FaceId(face), 1).is_none() { 1 } else { 3 };
        for quad in (0..corners).map(|corner| surface.quad(FaceId(face), corner).unwrap()) {
            assert!(eval(quad, 0.5, 0.5).is_none(), "face {face} has a surface");
        }
    }
    difference
}

fn is_corner(u: f64, v: f64) -> bool {
    [u, v].iter().all(|&x| x == 0.0 || x == 1.0)
}

/// Whether (u,v) of a quad is an extraordinary point, so that OpenSubdiv has a cap there. Corners
/// that are regular on a boundary, on a crease or as corners are none.
fn is_extraordinary(surface: &Surface, quad: QuadId, at: [f64; 2]) -> bool {
    let points = surface.extraordinary_points().iter();
    let mut sectors = points.flat_map(|point| &point.sectors);
    sectors.any(|sector| sector.quad == quad && sector.center == at)
}

/// Whether (u,v) is a corner of the quad that may be irregular in a primvar: not the regular vertex
/// of a smooth region.
fn may_be_irregular(
    surface: &Surface,
    face: u32,
    corner: usize,
    is_whole: bool,
    u: f64,
    v: f64,
) -> bool {
    let topology = surface.topology();
    let corners = topology.faces().corners(FaceId(face));
    let k = match (u > 0.5, v > 0.5) {
        (false, false) => 0,
        (true, false) => 1,
        (true, true) => 2,
        (false, true) => 3,
    };
    if !is_corner(u, v) {
        return false;
    }
    let vertex = match (is_whole, k) {
        (true, k) => corners[k],
        (false, 0) => corners[corner],
        (false, 2) => return true,
        // The middle of an edge.
        (false, _) => return false,
    };
    let tags = surface.tags();
    let is_quad = |f: FaceId| topology.faces().corners(f).len() == 4;
    topology.is_boundary(vertex)
        || topology.valence(vertex) != 4
        || !topology.ring(vertex).all(|h| is_quad(topology.get(h).unwrap().face()))
        || tags.corners.iter().any(|corner| corner.vertex == vertex)
        || tags.creases.iter().any(|crease| crease.edge.contains(&vertex))
}

fn position_difference(mesh: &Mesh, expected: &Expected) -> Difference {
    let cage = Cage::new(mesh.clone()).unwrap();
    let surface = Surface::build(cage, options(SchemeKind::CatmullClark)).unwrap();
    compare(Of::Positions, &surface, expected, |quad, u, v| {
        let jet = surface.eval(quad, u, v)?.jet;
        Some([jet.p, jet.du, jet.dv].map(|x| x.to_vec()))
    })
}

fn texture_difference(mesh: &Mesh, expected: &Expected, rule: FaceVaryingRule) -> Difference {
    let mut mesh = mesh.clone();
    mesh.tags.face_varying = rule;
    let cage = Cage::new(mesh).unwrap();
    let surface = Surface::build(cage, options(SchemeKind::CatmullClark)).unwrap();
    let st = surface.primvars().iter().position(|primvar| primvar.name == "st").unwrap();
    compare(Of::Primvar, &surface, expected, |quad, u, v| {
        let jet = surface.eval_primvar::<2>(st, quad, u, v)?;
        Some([jet.p, jet.du, jet.dv].map(|x| x[..2].to_vec()))
    })
}

const RULES: [(&str, FaceVaryingRule); 6] = [
    ("none", FaceVaryingRule::None),
    ("corners-only", FaceVaryingRule::CornersOnly),
    ("corners-plus1", FaceVaryingRule::CornersPlus1),
    ("corners-plus2", FaceVaryingRule::CornersPlus2),
    ("boundaries", FaceVaryingRule::Boundaries),
    ("all", FaceVaryingRule::All),
];

/// The cages of a folder with their golden files in another.
fn cases(cages: &Path, results: &Path) -> Vec<(String, PathBuf, PathBuf)> {
    let mut cases: Vec<_> = std::fs::read_dir(cages)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "obj"))
        .map(|path| {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let result = results.join(&name).with_extension("txt");
            (name, path, result)
        })
        .filter(|(_, _, result)| result.exists())
        .collect();
    cases.sort();
    cases
}

fn feature_cases() -> Vec<(String, PathBuf, PathBuf)> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data");
    cases(&data.join("meshes/features"), &data.join("golden/osd"))
}

/// Compares all, and fails with a table of those that differ.
fn check(cases: &[(String, PathBuf, PathBuf)], cap_tolerance: f64) {
    let mut faults = Vec::new();
    for (name, path, result) in cases {
        let (mesh, golden) = (mesh(path), golden(result));
        let mut note = |what: &str, difference: Difference| {
            let Difference { value, derivative, cap, place } = &difference;
            let numbers = format!("{value:.1e}  derivative {derivative:.1e}  caps {cap:.1e}");
            println!("{name:24} {what:14} value {numbers}");
            if !difference.is_small(cap_tolerance) {
                faults.push(format!("{name}, {what}: value {numbers}{place}"));
            }
        };
        note("positions", position_difference(&mesh, &golden["positions"]));
        for (mode, rule) in RULES {
            if let Some(expected) = golden.get(mode) {
                note(mode, texture_difference(&mesh, expected, rule));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn catmull_clark_surfaces_and_textures_are_those_of_opensubdiv() {
    let cases = feature_cases();
    assert!(cases.len() > 30);
    check(&cases, CAP_TOLERANCE);
}

/// Other cages: EVENLIGHT_OSD_CAGES names a folder of OBJ files, EVENLIGHT_OSD_RESULTS one with
/// what `cargo xtask osd CAGES RESULTS` made of them.
#[test]
#[ignore = "needs cages and results of OpenSubdiv in folders named by environment variables"]
fn cages_of_your_own_are_those_of_opensubdiv() {
    let folder = |name| PathBuf::from(std::env::var_os(name).unwrap());
    let cases = cases(&folder("EVENLIGHT_OSD_CAGES"), &folder("EVENLIGHT_OSD_RESULTS"));
    assert!(!cases.is_empty());
    check(&cases, OWN_CAP_TOLERANCE);
}
