//! Surfaces have the same bits on every machine: hashes of values, derivatives and curvatures of
//! all schemes, `data/golden/bits.txt`, which was written on x86-64.
//!
//! Cages and hashes are part of the test program, so that it needs no files. On another target it
//! is built and run by
//!
//! ```sh
//! cargo test --release -p evenlight --test bits     # natively, as on aarch64
//! CARGO_TARGET_WASM32_WASIP1_RUNNER=wasmtime \
//!     cargo test --release -p evenlight --test bits --target wasm32-wasip1
//! CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER='qemu-aarch64 -L /usr/aarch64-linux-gnu' \
//! CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
//!     cargo test --release -p evenlight --test bits --target aarch64-unknown-linux-gnu
//! ```
//!
//! A change that is meant to change bits writes the hashes anew, and says so in CHANGELOG.md:
//! `EVENLIGHT_WRITE_GOLDEN=1 cargo test --release -p evenlight --test bits`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::fmt::Write as _;
use std::sync::Arc;

use evenlight::cap::CapOptions;
use evenlight::io::load::Format;
use evenlight::surface::CreaseRings;
use evenlight::{Cage, QuadId, RuleSet, SchemeKind, Surface, SurfaceOptions, SurfacePoint};

/// A cage in `data/meshes` by its path there, with its text.
macro_rules! cage {
    ($path:literal) => {
        ($path, include_str!(concat!("../../../data/meshes/", $path)))
    };
}

/// Smooth, with n-gons, open, with creases of all kinds; valences 3 to 7.
const CAGES: [(&str, &str); 9] = [
    cage!("own_polygons.obj"),
    cage!("obstacle/saddle_n7.obj"),
    cage!("features/boundary_valences.obj"),
    cage!("features/polygons_boundary.obj"),
    cage!("features/polygons_creased.obj"),
    cage!("features/star3_semi_sharp.obj"),
    cage!("features/star5_crease.obj"),
    cage!("features/star6_junction.obj"),
    cage!("features/tetrahedron_creased.obj"),
];

/// The hashes: a line per scheme and kind of surface, cage, and quantity.
const GOLDEN: &str = include_str!("../../../data/golden/bits.txt");

/// Places in a quad: its corners, which are extraordinary points among others, places near them
/// and far from them. All numbers are binary fractions but two.
const PLACES: [[f64; 2]; 12] = [
    [0.0, 0.0],
    [1.0, 0.0],
    [1.0, 1.0],
    [0.0, 1.0],
    [0.5, 0.5],
    [0.25, 0.8125],
    [1.0 / 3.0, 0.7],
    [0.9375, 0.0],
    [0.0078125, 0.00390625],
    [1.0 - 1.0 / 4096.0, 1.0 - 1.0 / 65536.0],
    [1e-9, 1.0],
    [1.0 / 1_048_576.0, 1.0],
];

/// At most so many quads of a cage are asked, evenly spread.
const QUADS: usize = 40;

#[test]
fn all_schemes_have_the_golden_bits() {
    let found = found();
    if std::env::var_os("EVENLIGHT_WRITE_GOLDEN").is_some() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/golden/bits.txt");
        return std::fs::write(file, found).unwrap();
    }
    let differ = found.lines().zip(GOLDEN.lines()).filter(|(found, golden)| found != golden);
    let differ: Vec<String> =
        differ.map(|(found, golden)| format!("{found}\n  golden: {golden}")).collect();
    assert!(differ.is_empty(), "{} hashes differ:\n{}", differ.len(), differ.join("\n"));
    assert_eq!(found.lines().count(), GOLDEN.lines().count());
}

/// The lines of all surfaces.
fn found() -> String {
    let mut text = String::new();
    let cages = CAGES.map(|(name, text)| {
        let (cage, _) = Format::Obj.read_cage(text.as_bytes()).unwrap();
        (name, Arc::new(cage))
    });
    for (kind, options, caps) in kinds() {
        for (name, cage) in &cages {
            let surface = surface(cage, options, caps);
            for (quantity, hash) in hashes(&surface) {
                writeln!(text, "{kind} {name} {quantity} {hash:016x}").unwrap();
            }
        }
    }
    text
}

/// The kinds of surfaces with their names: every scheme with rings without end and with caps
/// behind the first ring, and the options of one scheme.
fn kinds() -> Vec<(String, SurfaceOptions, Option<CapOptions>)> {
    let caps = Some(CapOptions { rings: 1, ..CapOptions::default() });
    let mut kinds = Vec::new();
    for scheme in SchemeKind::ALL {
        let options = SurfaceOptions { scheme, ..SurfaceOptions::default() };
        kinds.push((scheme.name().to_owned(), options, None));
        kinds.push((format!("{}+caps", scheme.name()), options, caps));
    }
    let fair = SurfaceOptions { creases: CreaseRings::Fair, ..SurfaceOptions::default() };
    kinds.push(("qas4+fair-creases".to_owned(), fair, None));
    kinds.push(("qas4+fair-creases+caps".to_owned(), fair, caps));
    let published = SurfaceOptions { rules: RuleSet::Published, ..SurfaceOptions::default() };
    kinds.push(("qas4+published".to_owned(), published, None));
    kinds
}

fn surface(cage: &Arc<Cage>, options: SurfaceOptions, caps: Option<CapOptions>) -> Surface {
    let mut surface = Surface::build(cage.clone(), options).unwrap();
    surface.set_caps(caps).unwrap();
    surface
}

/// The hashes of all places of a surface, a quantity each.
fn hashes(surface: &Surface) -> [(&'static str, u64); 6] {
    let quads = surface.num_quads();
    let step = quads.div_ceil(QUADS);
    let places = (0..quads).step_by(step).flat_map(|quad| PLACES.map(|[u, v]| (quad, u, v)));
    let answers = places.map(|(quad, u, v)| surface.eval(QuadId(quad as u32), u, v));
    let answers: Vec<Option<SurfacePoint>> = answers.collect();
    let hash = |numbers: fn(&SurfacePoint) -> Vec<f64>| hash(&answers, numbers);
    [
        ("position", hash(|at| at.jet.p.to_vec())),
        ("first", hash(|at| [at.jet.du, at.jet.dv].concat())),
        ("second", hash(|at| [at.jet.duu, at.jet.duv, at.jet.dvv].concat())),
        ("normal", hash(|at| at.normal.to_vec())),
        ("K", hash(|at| vec![at.gauss])),
        ("H", hash(|at| vec![at.mean])),
    ]
}

/// FNV-1a of the bits of all numbers. Places without a surface count as such; every NaN is the
/// same, since its sign and payload are the processor's choice.
fn hash(answers: &[Option<SurfacePoint>], numbers: fn(&SurfacePoint) -> Vec<f64>) -> u64 {
    let mut hash = 0xCBF2_9CE4_8422_2325_u64;
    let mut add = |bits: u64| {
        for byte in bits.to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
        }
    };
    for answer in answers {
        match answer {
            None => add(u64::MAX),
            Some(at) => numbers(at).into_iter().for_each(|x| add(bits(x))),
        }
    }
    hash
}

fn bits(x: f64) -> u64 {
    if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() }
}
