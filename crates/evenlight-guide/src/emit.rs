//! The rules as tables: exact integers over a common denominator, and the Rust source that holds
//! them.
//!
//! Each weight is averaged with its mirror image, multiplied by 10^18 and rounded to the nearest
//! integer. So the symmetries hold exactly; and since the weight of the extraordinary point is
//! *defined* as 10^18 minus the sum of all others, the weights of a rule sum to 1 exactly. A table
//! lists only the rows that the symmetries do not repeat.

use std::fmt::{self, Write};

use crate::nets::{DNet, NODES_PER_SECTOR};
use crate::real::Real;
use crate::rules::{EG_ORDER, EgRule, RULES, evolving_guide, mirrored, symmetrised};

/// The common denominator of the tables.
pub const DENOMINATOR: i64 = 1_000_000_000_000_000_000;

/// The valences with tables.
pub const EG_VALENCES: [usize; 13] = [3, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

/// The rules that tables list, in their order, as (h, k); (1, 2) is the mirror image of (2, 1).
const LISTED: [(usize, usize); 5] = [(1, 1), (2, 2), (2, 1), (3, 1), (3, 2)];

/// The Evolving-Guide rules of one valence in integers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EgTable {
    /// The valence n.
    pub valence: usize,
    /// For each of [`RULES`] the numerators of the 12n nodes' weights, numbered by
    /// [`DNet::index`].
    pub numerators: [Vec<i64>; 6],
    /// For each of [`RULES`] the numerator of the derived weight of c_0, rounded by itself.
    pub centre: [i64; 6],
}

/// What can be wrong with a table; the rule is given as (h, k).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableDefect {
    /// The weight a_ij^r differs from its mirror image.
    Asymmetric {
        /// The rule.
        rule: (usize, usize),
        /// The indices r, i, j.
        weight: (usize, usize, usize),
    },
    /// The weights do not sum to 1, the derived one of c_0 included, by more than rounding.
    NotUnity {
        /// The rule.
        rule: (usize, usize),
        /// The sum less 10^18.
        excess: i128,
    },
}

/// Derives the table of valence n >= 3.
pub fn eg_table(valence: usize) -> EgTable {
    let rules = symmetrised(valence, &evolving_guide(valence, EG_ORDER));
    let numerator = |weight: &Real| weight.numerator_over(DENOMINATOR);
    let numerators = |rule: &EgRule| rule.on_net.iter().map(numerator).collect();
    EgTable {
        valence,
        numerators: rules.each_ref().map(numerators),
        centre: rules.each_ref().map(|rule| numerator(&rule.on_centre)),
    }
}

impl EgTable {
    /// The file of the table.
    pub fn file_name(&self) -> String {
        format!("eg_n{:02}.rs", self.valence)
    }

    /// Checks that the mirror symmetries hold exactly, and the partition of unity up to the
    /// rounding of 12n + 1 weights.
    ///
    /// # Errors
    ///
    /// The first defect found.
    pub fn check(&self) -> Result<(), TableDefect> {
        for number in 0..RULES.len() {
            self.check_symmetry(number)?;
            self.check_unity(number)?;
        }
        Ok(())
    }

    fn check_symmetry(&self, number: usize) -> Result<(), TableDefect> {
        for (node, &own) in self.numerators[number].iter().enumerate() {
            let (r, place) = (node / NODES_PER_SECTOR, node % NODES_PER_SECTOR);
            let weight = (r, place % 4, place / 4);
            let (mirror, r, i, j) = mirrored(self.valence, number, weight);
            let index = DNet { valence: self.valence }.index(r as isize, i, j);
            if own != self.numerators[mirror][index] {
                return Err(TableDefect::Asymmetric { rule: RULES[number], weight });
            }
        }
        Ok(())
    }

    fn check_unity(&self, number: usize) -> Result<(), TableDefect> {
        let weights = self.numerators[number].iter().chain([&self.centre[number]]);
        let sum: i128 = weights.map(|&weight| i128::from(weight)).sum();
        let excess = sum - i128::from(DENOMINATOR);
        let rounding = self.numerators[number].len() as i128 / 2 + 1;
        if excess.abs() > rounding {
            return Err(TableDefect::NotUnity { rule: RULES[number], excess });
        }
        Ok(())
    }

    /// The number of rows that are listed: all n for rule 21; 0..=n/2 for 11 and 22, where row -r
    /// is the mirror image of row r; 0..=(n+1)/2 for 31 and 32, where it is that of row 1-r.
    fn num_listed_rows(&self, (h, k): (usize, usize)) -> usize {
        match h {
            3 => self.valence.div_ceil(2) + 1,
            _ if h == k => self.valence / 2 + 1,
            _ => self.valence,
        }
    }

    /// The number of rows of 12 weights in the file.
    pub fn num_rows(&self) -> usize {
        LISTED.map(|rule| self.num_listed_rows(rule)).iter().sum()
    }

    /// The Rust source of the table: a `static TABLE: EgTable` for the module
    /// `evenlight::scheme::tables`.
    pub fn source(&self) -> String {
        let mut source = String::new();
        self.write_source(&mut source).expect("writing to a string cannot fail");
        source
    }

    fn write_source(&self, out: &mut String) -> fmt::Result {
        writeln!(
            out,
            "\
// GENERATED by cargo xtask tables. DO NOT EDIT.
//
// The Evolving-Guide refinement rules of valence {n} [KP23-EG, eq. 7], derived by the crate
// `evenlight-guide`: numerators over 10^18, each the nearest integer to the exact weight. A row
// holds the weights of d_00 d_10 d_20 d_30, d_01 d_11 d_21 d_31, d_02 d_12 d_22 d_32 of sector
// s + r, r = 0, 1, ... from the top; rows that a mirror symmetry repeats are left out.

use super::EgTable;

#[rustfmt::skip]
pub(super) static TABLE: EgTable = EgTable {{
    valence: {n},",
            n = self.valence
        )?;
        for rule in LISTED {
            self.write_rule(out, rule)?;
        }
        writeln!(out, "}};")
    }

    fn write_rule(&self, out: &mut String, rule: (usize, usize)) -> fmt::Result {
        let number = RULES.iter().position(|&r| r == rule).expect("listed rules are rules");
        writeln!(out, "    rule_{}{}: &[", rule.0, rule.1)?;
        let rows = self.numerators[number].chunks_exact(NODES_PER_SECTOR);
        for row in rows.take(self.num_listed_rows(rule)) {
            writeln!(out, "        [")?;
            for four in row.chunks_exact(4) {
                let [a, b, c, d] = [four[0], four[1], four[2], four[3]];
                writeln!(out, "            {a:>19}, {b:>19}, {c:>19}, {d:>19},")?;
            }
            writeln!(out, "        ],")?;
        }
        writeln!(out, "    ],")
    }
}

impl fmt::Display for TableDefect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Asymmetric { rule: (h, k), weight: (r, i, j) } => {
                write!(f, "weight a_{i}{j}^{r} of rule {h}{k} differs from its mirror image")
            }
            Self::NotUnity { rule: (h, k), excess } => {
                write!(f, "the weights of rule {h}{k} sum to 1 + {excess} / 10^18")
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
        for valence in EG_VALENCES {
            assert_eq!(eg_table(valence).check(), Ok(()), "valence {valence}");
        }
    }

    #[test]
    fn defects_are_found() {
        let mut table = eg_table(3);
        table.numerators[0][1] += 1;
        let asymmetric = TableDefect::Asymmetric { rule: (1, 1), weight: (0, 1, 0) };
        assert_eq!(table.check(), Err(asymmetric));
        let mut table = eg_table(3);
        table.numerators[0][0] += 1_000; // d_00 of the own sector is its own mirror image
        let defect = table.check().unwrap_err();
        assert!(matches!(defect, TableDefect::NotUnity { rule: (1, 1), excess: 900..1_100 }));
    }

    #[test]
    fn the_source_lists_every_number_once() {
        let table = eg_table(5);
        let source = table.source();
        let rows = source.matches("        [\n").count();
        assert_eq!(rows, table.num_rows());
        assert_eq!(rows, 5 + 2 * 3 + 2 * 4);
        for weight in &table.numerators[0][..12] {
            assert!(source.contains(&format!(" {weight},")));
        }
        assert!(source.lines().all(|line| line.len() <= 100));
    }
}
