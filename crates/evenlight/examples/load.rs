//! Reads a cage and says what is in it, or every fault with its place in the file.
//!
//! ```sh
//! cargo run --example load [CAGE]     # .obj, .ply or .usda
//! ```

use std::process::ExitCode;

use evenlight::io::{self, Diagnostic, FileError};
use evenlight::{Cage, mesh};

/// A cube, if no cage is named.
const CUBE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/cube.obj");

fn main() -> ExitCode {
    let path = std::env::args().nth(1).unwrap_or(CUBE.to_owned());
    match io::read_cage(&path) {
        Ok((cage, notices)) => {
            notices.iter().for_each(|notice| show(&notice.diagnostic()));
            describe(&cage);
            ExitCode::SUCCESS
        }
        Err(error) => {
            refuse(&error);
            ExitCode::FAILURE
        }
    }
}

fn describe(cage: &Cage) {
    println!("{} vertices, {} faces", cage.num_used_vertices(), cage.num_faces());
    println!("{} edges, {} of them at the boundary", cage.num_edges(), cage.num_boundary_edges());
    for (valence, count) in cage.interior_valences() {
        println!("{count} interior vertices of valence {valence}");
    }
}

/// The faults as a front end could mark them.
fn refuse(error: &FileError) {
    error.notices().iter().for_each(|notice| show(&notice.diagnostic()));
    error.diagnostics().iter().for_each(show);
}

fn show(diagnostic: &Diagnostic) {
    let Diagnostic { severity, kind, message, line, marks, .. } = diagnostic;
    println!("{severity:?} {kind}: {message}");
    if let Some(line) = line {
        println!("  line {line}");
    }
    let mesh::Marks { vertices, edges, faces } = marks;
    println!("  mark {vertices:?} {edges:?} {faces:?}");
}
