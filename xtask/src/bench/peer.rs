//! `cargo xtask bench --peer`: our times beside OpenSubdiv's, measured in one run.
//!
//! Both do on one thread what a user of them does, from arrays of positions and faces, in double
//! precision; the CPU time of the process counts, and the median of seven runs after a warm-up.
//! `tools/osd_oracle/bench.cpp` says what OpenSubdiv does.
//!
//! | operation | ours |
//! | --- | --- |
//! | build | check, connectivity, surface, all patches to ring 6 |
//! | evaluate | 500,000 random places, the same for both: position and first derivatives, or second derivatives too |
//! | tessellate | check, surface, 8 x 8 per quad: shared vertices, normals, curvature, triangles |

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use cpu_time::ProcessTime;
use evenlight::io::obj;
use evenlight::tessellate::tessellate;
use evenlight::{Cage, Mesh, QuadId, SchemeKind, Surface, SurfaceOptions};

use super::{LARGE, Studs, studded_torus};

const RUNS: usize = 7;
const SAMPLES: usize = 500_000;
const RATE: usize = 8;
const RINGS: usize = 6;

/// The schemes that are measured.
const SCHEMES: [SchemeKind; 4] =
    [SchemeKind::CatmullClark, SchemeKind::EvolvingGuide, SchemeKind::Qas4, SchemeKind::Guided5];

/// Measures the given cages, or two of ours.
pub fn run(cages: &[PathBuf]) -> Result<(), Box<dyn Error>> {
    // Our library would use all cores otherwise.
    const THREADS: &str = "RAYON_NUM_THREADS";
    if std::env::var_os(THREADS).is_none_or(|number| number != "1") {
        let mut again = Command::new(std::env::current_exe()?);
        let status = again.args(std::env::args_os().skip(1)).env(THREADS, "1").status()?;
        return if status.success() { Ok(()) } else { Err("the measurement failed".into()) };
    }
    let program = crate::osd::compile("bench", &["-O3"])?;
    println!("milliseconds, and in brackets ours / OpenSubdiv's (less than 1: ours is faster)\n");
    println!(
        "| cage | quads | | build | evaluate, first derivatives | evaluate, second | tessellate |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    if cages.is_empty() {
        let blob = crate::workspace("data/meshes/own_blob_quadriflow_1500.obj");
        compare("own_blob_quadriflow_1500", &program, read(&blob)?)?;
        return compare(
            "studded torus",
            &program,
            studded_torus(Studs { cells: [5, 10], ..LARGE }),
        );
    }
    for path in cages {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        compare(&name, &program, read(path)?)?;
    }
    Ok(())
}

/// Positions and faces of a file alone: creases and primvars are not measured.
fn read(path: &Path) -> Result<Mesh, Box<dyn Error>> {
    let mesh = obj::read(&fs::read(path)?)?.mesh;
    Ok(Mesh { positions: mesh.positions, faces: mesh.faces, ..Mesh::default() })
}

/// Times in milliseconds.
#[derive(Clone, Copy, Default)]
struct Times {
    build: f64,
    first: f64,
    second: f64,
    tessellate: f64,
}

fn compare(name: &str, program: &Path, mesh: Mesh) -> Result<(), Box<dyn Error>> {
    let quads = Cage::new(mesh.clone())?.face_sizes();
    let quads: usize = quads.iter().map(|(&size, &k)| if size == 4 { k } else { size * k }).sum();
    let peer = theirs(program, &mesh)?;
    let Times { build, first, second, tessellate } = peer;
    println!(
        "| {name} | {quads} | OpenSubdiv | {build:.1} | {first:.0} | {second:.0} | {tessellate:.1} |"
    );
    for scheme in SCHEMES {
        let own = ours(scheme, &mesh)?;
        let cell = |own: f64, peer: f64| format!("{own:.1} ({:.2})", own / peer);
        println!(
            "| | | {} | {} | {} | {} | {} |",
            scheme.name(),
            cell(own.build, peer.build),
            cell(own.first, peer.first),
            cell(own.second, peer.second),
            cell(own.tessellate, peer.tessellate)
        );
    }
    Ok(())
}

/// Runs the program on the mesh.
fn theirs(program: &Path, mesh: &Mesh) -> Result<Times, Box<dyn Error>> {
    let file = program.with_extension("obj");
    obj::write(mesh, &mut fs::File::create(&file)?)?;
    let numbers = [SAMPLES, RATE, RUNS].map(|number| number.to_string());
    let output = Command::new(program).arg(&file).args(numbers).output()?;
    fs::remove_file(&file)?;
    if !output.status.success() {
        return Err("OpenSubdiv refuses the cage".into());
    }
    let text = String::from_utf8(output.stdout)?;
    let time = |name: &str| -> Result<f64, Box<dyn Error>> {
        let line = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
        Ok(line.ok_or("OpenSubdiv's times are incomplete")?.parse()?)
    };
    Ok(Times {
        build: time("build")?,
        first: time("eval1")?,
        second: time("eval2")?,
        tessellate: time("tessellate")?,
    })
}

fn ours(scheme: SchemeKind, mesh: &Mesh) -> Result<Times, Box<dyn Error>> {
    let options = SurfaceOptions { scheme, ..SurfaceOptions::default() };
    let build = || -> Result<Surface, Box<dyn Error>> {
        Ok(Surface::build(Cage::new(mesh.clone())?, options)?)
    };
    let surface = build()?;
    let places = places(surface.num_quads());
    Ok(Times {
        build: median(|| build().map_or(0, |surface| surface.patches(RINGS).count())),
        first: median(|| first_derivatives(&surface, &places)),
        second: median(|| second_derivatives(&surface, &places)),
        tessellate: median(|| {
            let triangles = build().map(|surface| tessellate(&surface, RATE));
            triangles.map_or(0, |triangles| triangles.map_or(0, |mesh| mesh.triangles.len()))
        }),
    })
}

/// The median time of some runs.
fn median<T>(run: impl Fn() -> T) -> f64 {
    std::hint::black_box(run());
    let mut times: Vec<f64> = (0..RUNS)
        .map(|_| {
            let clock = ProcessTime::now();
            std::hint::black_box(run());
            clock.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[RUNS / 2]
}

/// The places at which OpenSubdiv evaluates.
fn places(num_quads: usize) -> Vec<(QuadId, f64, f64)> {
    let mut state = 88_172_645_463_325_252_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 32) as f64 / 4_294_967_296.0
    };
    let mut place = || (QuadId((random() * num_quads as f64) as u32), random(), random());
    (0..SAMPLES).map(|_| place()).collect()
}

/// The sum of everything that is evaluated, as theirs.
fn first_derivatives(surface: &Surface, places: &[(QuadId, f64, f64)]) -> f64 {
    let jets = places.iter().filter_map(|&(quad, u, v)| surface.eval_first(quad, u, v));
    jets.map(|jet| [jet.p, jet.du, jet.dv].iter().flatten().sum::<f64>()).sum()
}

fn second_derivatives(surface: &Surface, places: &[(QuadId, f64, f64)]) -> f64 {
    let jets = places.iter().filter_map(|&(quad, u, v)| surface.eval_second(quad, u, v));
    jets.map(|jet| jet.rows().iter().flatten().sum::<f64>()).sum()
}
