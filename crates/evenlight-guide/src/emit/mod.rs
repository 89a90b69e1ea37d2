//! The rules as tables: exact integers over a common denominator, and the Rust source that holds
//! them.
//!
//! Each weight is averaged with its mirror image, multiplied by 10^18 and rounded to the nearest
//! integer. So the symmetries hold exactly; and since the weight of the extraordinary point is
//! *defined* as 10^18 minus the sum of all others, the weights of a rule sum to 1 exactly. A table
//! lists only what the symmetries do not repeat, up to a few weights that make its rows readable.
//!
//! A table is checked before it becomes a file ([`TableDefect`]).

mod eg;
mod guided;
mod qas;

pub use eg::{EgTable, EgTitle};
pub use guided::{GuidedTable, LISTED};
pub use qas::{QasTable, QasTitle};

use std::fmt::{self, Write};

use crate::nets::NODES_PER_SECTOR;

/// The common denominator of the tables.
pub const DENOMINATOR: i64 = 1_000_000_000_000_000_000;

/// The valences with tables.
pub const VALENCES: [usize; 13] = [3, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

/// A table as a file of Rust source, for the folder of the module `evenlight::scheme::tables`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableFile {
    /// The name of the file.
    pub name: String,
    /// Its text.
    pub source: String,
}

/// What can be wrong with a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TableDefect {
    /// A weight differs from its mirror image.
    Asymmetric {
        /// The weight.
        weight: String,
    },
    /// The weights of a rule do not sum to 1, the derived one of the extraordinary point included,
    /// by more than rounding.
    NotUnity {
        /// The rule.
        rule: String,
        /// The sum less 10^18.
        excess: i128,
    },
}

/// The tables of valence n >= 3, checked, as files: of Evolving-Guide, of Quadratic-Attraction, of
/// Guided C2 and of fairness-optimal subdivision.
///
/// # Errors
///
/// The first defect found.
pub fn table_files(valence: usize) -> Result<[TableFile; 6], TableDefect> {
    let eg = EgTitle::ALL.map(|title| EgTable::derive(valence, title));
    let qas = QasTitle::ALL.map(|title| QasTable::derive(valence, title));
    let guided = GuidedTable::derive(valence);
    eg.iter().try_for_each(EgTable::check)?;
    qas.iter().try_for_each(QasTable::check)?;
    guided.check()?;
    let [eg, fair4d] = eg.map(|table| table.file());
    let [qas, fair4, fair3] = qas.map(|table| table.file());
    Ok([eg, qas, guided.file(), fair4, fair4d, fair3])
}

/// Checks that the weights of a rule sum to 1, up to the rounding of each.
fn check_unity<'a>(
    rule: String,
    weights: impl Iterator<Item = &'a i64>,
) -> Result<(), TableDefect> {
    let (mut excess, mut count) = (-i128::from(DENOMINATOR), 0);
    for &weight in weights {
        excess += i128::from(weight);
        count += 1;
    }
    if excess.abs() > count / 2 + 1 {
        return Err(TableDefect::NotUnity { rule, excess });
    }
    Ok(())
}

/// Writes rows of twelve weights as the field `name`, `&[[i64; 12]]`.
fn write_rows<'a>(
    out: &mut String,
    name: &str,
    rows: impl Iterator<Item = &'a [i64]>,
) -> fmt::Result {
    writeln!(out, "    {name}: &[")?;
    for row in rows {
        assert_eq!(row.len(), NODES_PER_SECTOR, "a row has one weight per node");
        writeln!(out, "        [")?;
        for four in row.chunks_exact(4) {
            write_line(out, 12, four)?;
        }
        writeln!(out, "        ],")?;
    }
    writeln!(out, "    ],")
}

/// Writes numbers on one line, in columns.
fn write_line(out: &mut String, indent: usize, numbers: &[i64]) -> fmt::Result {
    let columns: Vec<String> = numbers.iter().map(|number| format!("{number:>19},")).collect();
    writeln!(out, "{:indent$}{}", "", columns.join(" "))
}

impl fmt::Display for TableDefect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Asymmetric { weight } => {
                write!(f, "{weight} differs from its mirror image")
            }
            Self::NotUnity { rule, excess } => {
                write!(f, "the weights of {rule} sum to 1 + {excess} / 10^18")
            }
        }
    }
}

impl std::error::Error for TableDefect {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_symmetric_and_sum_to_one() {
        for valence in VALENCES {
            assert_eq!(table_files(valence).err(), None, "valence {valence}");
        }
    }

    #[test]
    fn files_are_named_after_their_valence_and_keep_to_100_columns() {
        let files = table_files(3).unwrap();
        let names = files.each_ref().map(|file| file.name.as_str());
        let own = ["fair/fair4_n03.rs", "fair/fair4d_n03.rs", "fair/fair3_n03.rs"];
        assert_eq!(names[..3], ["eg_n03.rs", "qas_n03.rs", "guided_n03.rs"]);
        assert_eq!(names[3..], own);
        for file in files {
            assert!(file.source.lines().all(|line| line.len() <= 100), "{}", file.name);
            assert!(file.source.starts_with("// GENERATED by cargo xtask tables. DO NOT EDIT.\n"));
        }
    }
}
