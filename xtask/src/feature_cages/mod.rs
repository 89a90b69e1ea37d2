//! `cargo xtask feature-cages`: small cages that together need every rule for boundaries,
//! creases, corners, holes, polygons and texture seams.
//!
//! Every cage is one of a few sheets, with tags and texture coordinates put on it:
//!
//! ```text
//!   sheet: m x n quads       star: n sectors of r x r quads     fan: a star with a gap
//!   +--+--+--+                    \  |  /                            \  |  /
//!   |  |  |  |                  ---- v ----                         -- v --
//!   +--+--+--+                    /  |  \                          (no faces here)
//! ```
//!
//! Heights are uneven by a formula, so that no result is right by accident.

mod build;
mod list;

use std::error::Error;
use std::fs;

use clap::Args;

/// Write the cages that need every rule for boundaries, creases, corners, holes and seams
#[derive(Args)]
pub struct Arguments {
    /// Write nothing; fail if a file on disk is not, byte for byte, the one made
    #[arg(long)]
    check: bool,
}

const FOLDER: &str = "data/meshes/features";

/// Writes or checks the cages.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let folder = crate::workspace(FOLDER);
    let cages = list::all();
    if !arguments.check {
        fs::create_dir_all(&folder)?;
    }
    for (name, cage) in &cages {
        let path = folder.join(format!("{name}.obj"));
        let text = cage.to_obj(name);
        if fs::read(&path).is_ok_and(|bytes| bytes == text.as_bytes()) {
            continue;
        }
        if arguments.check {
            let file = path.display();
            return Err(format!("{file} differs: run `cargo xtask feature-cages`").into());
        }
        fs::write(&path, text)?;
        println!("{FOLDER}/{name}.obj: written");
    }
    println!("{FOLDER}: {} cages are up to date", cages.len());
    Ok(())
}
