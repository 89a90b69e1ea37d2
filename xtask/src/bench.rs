//! `cargo xtask bench`: time and memory of the pipeline, on cages of our own making or given.
//!
//! The large cage is a torus of 25 x 50 cells, 24 x 24 quads each, with a block of 8 x 8 quads
//! pulled out by 7 layers: 4 vertices of valence 5 at its foot, 4 of valence 3 on top, all far
//! apart. That makes 1,000,000 quads with 10,000 extraordinary vertices. A smaller one has 29,200
//! quads with 800 extraordinary vertices.
//!
//! ```text
//!        3-----3
//!       /|    /|
//!      3-----3 |      one cell
//!   ___| 5___|_5___
//!  /   5-----5    /
//! ```

mod peer;
mod pose;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use evenlight::io::load::Format;
use evenlight::io::obj;
use evenlight::{Mesh, Point, QuadId, SchemeKind, Surface, SurfaceOptions};

/// A torus with blocks pulled out of it.
#[derive(Clone, Copy)]
struct Studs {
    /// Cells around the torus, the short way and the long way.
    cells: [usize; 2],
    /// Quads along the side of a cell.
    cell: usize,
    /// Quads along the side of the pulled-out block.
    block: usize,
    /// Layers by which it is pulled out.
    layers: usize,
}

const LARGE: Studs = Studs { cells: [25, 50], cell: 24, block: 8, layers: 7 };
const SMALL: Studs = Studs { cells: [10, 10], cell: 10, block: 6, layers: 8 };

/// Measure time and memory: of given cages, then of one with 1,000,000 quads and 10,000
/// extraordinary vertices. Prints; asserts nothing.
#[derive(clap::Args)]
pub struct Arguments {
    /// OBJ files to measure first
    cages: Vec<std::path::PathBuf>,
    /// Beside OpenSubdiv, which must be installed (libosd-dev and g++): the given cages, or two of
    /// ours, on one thread
    #[arg(long)]
    peer: bool,
}

/// Measures the given cages and the large one.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn std::error::Error>> {
    if arguments.peer {
        return peer::run(&arguments.cages);
    }
    for path in &arguments.cages {
        measure(&path.display().to_string(), &std::fs::read(path)?)?;
    }
    pose::run("regular torus", &torus([250, 400]))?;
    pose::run("studded torus", &studded_torus(SMALL))?;
    let mut text = Vec::new();
    obj::write(&studded_torus(LARGE), &mut text)?;
    measure("studded torus", &text)
}

fn measure(name: &str, text: &[u8]) -> Result<(), Box<dyn std::error::Error>> {
    println!("{name}, {:.1} MB of OBJ", text.len() as f64 / 1e6);
    let clock = Instant::now();
    let (cage, _) = Format::Obj.read_cage(text)?;
    report("read and check", clock, cage.topology().faces().len(), "faces");
    let cage = Arc::new(cage);
    for scheme in SchemeKind::ALL {
        let options = SurfaceOptions { scheme, ..SurfaceOptions::default() };
        let clock = Instant::now();
        let surface = Surface::build(cage.clone(), options)?;
        let points = surface.extraordinary_points().len();
        report(&format!("{}: build", scheme.name()), clock, points, "extraordinary points");
        let clock = Instant::now();
        let patches = surface.patches(6).count();
        report(&format!("{}: patches, 6 rings", scheme.name()), clock, patches, "patches");
        evaluate(scheme, &surface);
    }
    if let Some(peak) = peak_memory() {
        println!("  peak memory so far: {peak:.2} GiB");
    }
    Ok(())
}

/// Evaluates at random places, with the random sequence of the project's other benchmarks.
fn evaluate(scheme: SchemeKind, surface: &Surface) {
    let mut state = 88_172_645_463_325_252_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let count = 500_000;
    let clock = Instant::now();
    let mut sum = 0.0;
    for _ in 0..count {
        let quad = QuadId((random() * surface.num_quads() as f64) as u32);
        let (u, v) = (random(), random());
        sum += surface.eval(quad, u, v).map_or(0.0, |p| p.jet.p[0]);
    }
    std::hint::black_box(sum);
    report(&format!("{}: eval", scheme.name()), clock, count, "points");
}

fn report(what: &str, clock: Instant, count: usize, unit: &str) {
    let seconds = clock.elapsed().as_secs_f64();
    let rate = count as f64 / seconds / 1e6;
    println!("  {what:24} {seconds:8.3} s {count:10} {unit} ({rate:.2} M/s)");
}

/// The largest resident size of this process so far in GiB, where the system tells it.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / (1024.0 * 1024.0))
}

/// A torus of so many quads, all regular.
fn torus(size: [usize; 2]) -> Mesh {
    studded_torus(Studs { cells: size, cell: 1, block: 0, layers: 0 })
}

fn studded_torus(studs: Studs) -> Mesh {
    let size = studs.cells.map(|cells| cells * studs.cell);
    let mut builder =
        Builder { studs, size, ids: BTreeMap::new(), positions: Vec::new(), faces: Vec::new() };
    let [rows, columns] = builder.size;
    for i in 0..rows {
        for j in 0..columns {
            // Height 0 outside the blocks, on their tops the full height.
            let in_block = |k: usize| studs.in_block(k);
            let height = if in_block(i) && in_block(j) { studs.layers } else { 0 };
            builder.quad([
                (i, j, height),
                (i + 1, j, height),
                (i + 1, j + 1, height),
                (i, j + 1, height),
            ]);
            if height > 0 {
                builder.walls(i, j);
            }
        }
    }
    Mesh::new(builder.positions, builder.faces)
}

impl Studs {
    /// Whether quad `k` of a row is in a block.
    fn in_block(self, k: usize) -> bool {
        let k = 2 * (k % self.cell);
        self.cell - self.block <= k && k < self.cell + self.block && self.block > 0
    }
}

struct Builder {
    studs: Studs,
    /// Quads around the torus, the short way and the long way.
    size: [usize; 2],
    ids: BTreeMap<(usize, usize, usize), u32>,
    positions: Vec<Point>,
    faces: Vec<[u32; 4]>,
}

impl Builder {
    /// The walls below the sides of a top quad at which its block ends.
    fn walls(&mut self, i: usize, j: usize) {
        let in_block = |k: usize| self.studs.in_block(k);
        let sides = [
            (!in_block(i.wrapping_sub(1)), (i, j + 1), (i, j)),
            (!in_block(i + 1), (i + 1, j), (i + 1, j + 1)),
            (!in_block(j.wrapping_sub(1)), (i, j), (i + 1, j)),
            (!in_block(j + 1), (i + 1, j + 1), (i, j + 1)),
        ];
        for (_, (a, b), (c, d)) in sides.into_iter().filter(|side| side.0) {
            for layer in 0..self.studs.layers {
                self.quad([(a, b, layer), (c, d, layer), (c, d, layer + 1), (a, b, layer + 1)]);
            }
        }
    }

    fn quad(&mut self, corners: [(usize, usize, usize); 4]) {
        let ids = corners.map(|corner| self.vertex(corner));
        self.faces.push(ids);
    }

    fn vertex(&mut self, (i, j, height): (usize, usize, usize)) -> u32 {
        let [rows, columns] = self.size;
        let (i, j) = (i % rows, j % columns);
        *self.ids.entry((i, j, height)).or_insert_with(|| {
            let angle = |k: usize, of: usize| std::f64::consts::TAU * k as f64 / of as f64;
            let (a, b) = (angle(i, rows), angle(j, columns));
            let tube = 1.0 + 0.01 * height as f64;
            let r = 3.0 + tube * a.cos();
            self.positions.push([r * b.cos(), -r * b.sin(), tube * a.sin()]);
            self.positions.len() as u32 - 1
        })
    }
}
