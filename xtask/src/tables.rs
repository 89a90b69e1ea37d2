//! `cargo xtask tables`: the tables of refinement weights, written or checked.

use std::error::Error;
use std::fs;
use std::io::{self, Write};

use clap::Args;
use evenlight_guide::emit::{TableFile, VALENCES, table_files};

use crate::threads::map_on_threads;

/// Derive the tables of refinement weights and write them.
#[derive(Args)]
pub struct Arguments {
    /// Write nothing; fail if a table on disk is not, byte for byte, the derived one.
    #[arg(long)]
    check: bool,
}

const FOLDER: &str = "crates/evenlight/src/scheme/tables";

/// Writes or checks the tables of every valence, with a line for each.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let (mut stale, mut count) = (0, 0);
    // The large valences take longest, and so come first.
    let valences: Vec<usize> = VALENCES.into_iter().rev().collect();
    let derived = map_on_threads(&valences, |&valence| table_files(valence));
    for (valence, tables) in valences.into_iter().zip(derived).rev() {
        for table in tables.map_err(|defect| format!("valence {valence}: {defect}"))? {
            let fresh = is_on_disk(&table);
            if !arguments.check && !fresh {
                write(&table)?;
            }
            count += 1;
            stale += usize::from(!fresh);
            writeln!(io::stdout(), "{}", report(&table, fresh, arguments.check))?;
        }
    }
    if arguments.check && stale > 0 {
        return Err(format!(
            "{stale} of {count} tables in {FOLDER} differ from the derivation in \
             crates/evenlight-guide.\n\
             Tables are never edited by hand: run `cargo xtask tables` and commit what it writes."
        )
        .into());
    }
    Ok(())
}

/// Whether the file of the table exists and holds exactly its source.
fn is_on_disk(table: &TableFile) -> bool {
    let file = crate::workspace(FOLDER).join(&table.name);
    fs::read(file).is_ok_and(|bytes| bytes == table.source.as_bytes())
}

fn write(table: &TableFile) -> Result<(), Box<dyn Error>> {
    let file = crate::workspace(FOLDER).join(&table.name);
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(&file, &table.source)
        .map_err(|error| format!("cannot write {}: {error}", file.display()).into())
}

fn report(table: &TableFile, fresh: bool, check: bool) -> String {
    let state = match (fresh, check) {
        (true, _) => "up to date",
        (false, true) => "DIFFERS",
        (false, false) => "written",
    };
    let TableFile { name, source } = table;
    format!("{name:18} {:6} bytes, symmetric, sums to 1: {state}", source.len())
}
