//! The cages that the integration tests share.
#![allow(dead_code, reason = "every test file uses a part of this")]
#![allow(clippy::unwrap_used, reason = "a test that cannot read its cages fails")]

pub mod fans;
pub mod refine;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use evenlight::io::load::Format;
use evenlight::io::obj;
use evenlight::surface::{PointRule, Reason};
use evenlight::{Cage, Contraction, Mesh, RuleSet, SchemeKind, Surface, SurfaceOptions, Variant};

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/meshes")
}

/// The cage of a file in data/meshes, by its path there.
pub fn mesh(name: &str) -> Mesh {
    let bytes = std::fs::read(data().join(name)).unwrap();
    obj::read(&bytes).unwrap().mesh
}

pub fn cage(name: &str) -> Arc<Cage> {
    Arc::new(Cage::new(mesh(name)).unwrap())
}

/// All cages in data/meshes and, if the environment variable EVENLIGHT_EXTRA_MESHES names a
/// folder, all OBJ files in that, with their names.
pub fn all_cages() -> Vec<(String, Arc<Cage>)> {
    let mut folders = vec![data(), data().join("obstacle")];
    folders.extend(std::env::var_os("EVENLIGHT_EXTRA_MESHES").map(PathBuf::from));
    cages_in(&folders)
}

/// Our cages with boundaries, creases, corners, darts, holes and seams.
pub fn feature_cages() -> Vec<(String, Arc<Cage>)> {
    cages_in(&[data().join("features")])
}

fn cages_in(folders: &[PathBuf]) -> Vec<(String, Arc<Cage>)> {
    let mut files: Vec<PathBuf> = folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "obj"))
        .collect();
    files.sort();
    files
        .into_iter()
        .map(|path| {
            let bytes = std::fs::read(&path).unwrap();
            let (cage, _) = Format::Obj.read_cage(&bytes).unwrap();
            (path.file_name().unwrap().to_string_lossy().into_owned(), Arc::new(cage))
        })
        .collect()
}

pub fn options(scheme: SchemeKind) -> SurfaceOptions {
    SurfaceOptions { scheme, ..SurfaceOptions::default() }
}

pub fn surface(cage: &Arc<Cage>, scheme: SchemeKind) -> Surface {
    Surface::build(cage.clone(), options(scheme)).unwrap()
}

/// Whether a scheme is to have rules at valence `n`, said independently of the library:
/// Catmull-Clark from 2 to 1024; the others at 3 and from 5 on, as far as papers print them, tables
/// reach, or guided rules can be derived.
pub fn has_rules(scheme: SchemeKind, Variant { rules, contraction }: Variant, n: usize) -> bool {
    use SchemeKind::{
        CatmullClark, EvolvingGuide, Fair3, Fair4, Fair4d, Guided3, Guided4, Guided5, Guided6,
        Pas3, Pas4, Qas3, Qas4,
    };
    let is_own_contraction = contraction == Contraction::CatmullClark;
    let last = match (scheme, rules) {
        (CatmullClark, _) => return is_own_contraction && (2..=1024).contains(&n),
        (EvolvingGuide | Pas3 | Pas4 | Qas3 | Qas4, RuleSet::Published) => 10,
        (Guided3 | Guided4 | Guided5 | Guided6 | Fair3 | Fair4 | Fair4d, RuleSet::Published) => 0,
        (Guided3 | Guided4 | Guided5 | Guided6, _) if cfg!(feature = "derive") => 32,
        (EvolvingGuide | Pas3 | Pas4 | Qas3 | Qas4 | Fair3 | Fair4 | Fair4d, _) => 16,
        (Guided3 | Guided4 | Guided5 | Guided6, _) => 16,
        _ => panic!("{scheme:?} is new: say where it has rules"),
    };
    let is_guided = matches!(scheme, Guided3 | Guided4 | Guided5 | Guided6);
    let is_derivable = is_guided && cfg!(feature = "derive");
    (is_own_contraction || is_derivable) && n <= last && (n == 3 || n >= 5)
}

/// Checks that every smooth extraordinary point has the rules of the scheme if [`has_rules`] says
/// so, and else, for its valence, those of Catmull-Clark; and that all have rings.
pub fn assert_rules(name: &str, surface: &Surface) {
    let SurfaceOptions { scheme, rules, contraction, .. } = surface.options();
    for (k, point) in surface.extraordinary_points().iter().enumerate() {
        let n = point.valence;
        assert!(surface.rings(k).is_some(), "{name}, {}, valence {n}: no rings", scheme.name());
        if point.fan.is_smooth() {
            let expected = match has_rules(scheme, Variant { rules, contraction }, n) {
                true => PointRule::Scheme,
                false => PointRule::CatmullClark(Reason::Valence),
            };
            assert_eq!(point.rule, expected, "{name}, {}, valence {n}", scheme.name());
        }
    }
}

/// A torus of `m` x `n` quads, all vertices regular.
pub fn torus(m: u32, n: u32) -> Mesh {
    let angle = |k: u32, of: u32| std::f64::consts::TAU * f64::from(k) / f64::from(of);
    let point = |i: u32, j: u32| {
        let (a, b) = (angle(i, m), angle(j, n));
        let r = 3.0 + b.cos();
        [r * a.cos(), r * a.sin(), b.sin()]
    };
    let positions = (0..m * n).map(|k| point(k / n, k % n)).collect();
    let at = |i: u32, j: u32| (i % m) * n + j % n;
    let quad = |k: u32| {
        let (i, j) = (k / n, k % n);
        [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
    };
    Mesh::new(positions, (0..m * n).map(quad))
}

/// Numbers in [0,1) for tests, the same in every run.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }
}
