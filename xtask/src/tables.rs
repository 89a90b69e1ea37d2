//! `cargo xtask tables`: the tables of refinement weights, written or checked.

use std::error::Error;
use std::fs;
use std::io::{self, Write};

use clap::Args;
use evenlight_guide::emit::{EG_VALENCES, EgTable, eg_table};

/// Derive the tables of refinement weights and write them.
#[derive(Args)]
pub struct Arguments {
    /// Write nothing; fail if a table on disk is not, byte for byte, the derived one.
    #[arg(long)]
    check: bool,
}

const FOLDER: &str = "crates/evenlight/src/scheme/tables";

/// Writes or checks the table of every valence, with a line for each.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let mut stale = 0;
    for valence in EG_VALENCES {
        let table = eg_table(valence);
        table.check().map_err(|defect| format!("valence {valence}: {defect}"))?;
        let fresh = is_on_disk(&table);
        if !arguments.check && !fresh {
            write(&table)?;
        }
        stale += usize::from(!fresh);
        writeln!(io::stdout(), "{}", report(&table, fresh, arguments.check))?;
    }
    if arguments.check && stale > 0 {
        return Err(format!(
            "{stale} of {} tables in {FOLDER} differ from the derivation in crates/evenlight-guide.\n\
             Tables are never edited by hand: run `cargo xtask tables` and commit what it writes.",
            EG_VALENCES.len()
        )
        .into());
    }
    Ok(())
}

/// Whether the file of the table exists and holds exactly its source.
fn is_on_disk(table: &EgTable) -> bool {
    let file = crate::workspace(FOLDER).join(table.file_name());
    fs::read(file).is_ok_and(|bytes| bytes == table.source().as_bytes())
}

fn write(table: &EgTable) -> Result<(), Box<dyn Error>> {
    let file = crate::workspace(FOLDER).join(table.file_name());
    fs::write(&file, table.source())
        .map_err(|error| format!("cannot write {}: {error}", file.display()).into())
}

fn report(table: &EgTable, fresh: bool, check: bool) -> String {
    let state = match (fresh, check) {
        (true, _) => "up to date",
        (false, true) => "DIFFERS",
        (false, false) => "written",
    };
    let (file, rows) = (table.file_name(), table.num_rows());
    format!("{file}: {rows:2} rows, symmetric, sums to 1: {state}")
}
