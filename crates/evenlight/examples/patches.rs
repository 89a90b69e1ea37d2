//! Writes the Bernstein-Bezier patches of a surface, closed by caps, and counts them by role and
//! degree.
//!
//! ```sh
//! cargo run --example patches [CAGE [FILE]]    # the file .bv or .json
//! ```

use std::collections::BTreeMap;
use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};

use evenlight::cap::CapOptions;
use evenlight::io::{self, PatchFormat};
use evenlight::{Surface, SurfaceOptions};

/// A cube, if no cage is named.
const CUBE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/cube.obj");

/// The rings around every extraordinary point, before its cap.
const RINGS: usize = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (cage, _) = io::read_cage(arguments.next().unwrap_or(CUBE.to_owned()))?;
    let mut surface = Surface::build(cage, SurfaceOptions::default())?;
    surface.set_caps(Some(CapOptions { rings: RINGS, ..CapOptions::default() }))?;
    count(&surface);
    match arguments.next() {
        Some(path) => write(&surface, &path),
        None => Ok(()),
    }
}

fn count(surface: &Surface) {
    let mut counts = BTreeMap::new();
    for placed in surface.patches(RINGS) {
        let kind = (placed.place.role.to_string(), placed.patch.degree());
        *counts.entry(kind).or_insert(0) += 1;
    }
    for ((role, [du, dv]), count) in counts {
        println!("{count} patches of degree {du} x {dv}: {role}");
    }
}

fn write(surface: &Surface, path: &str) -> Result<(), Box<dyn Error>> {
    let format = PatchFormat::from_path(path).ok_or("the file must end in .bv or .json")?;
    let mut out = BufWriter::new(File::create(path)?);
    format.write(surface, RINGS, &mut out)?;
    Ok(out.flush()?)
}
