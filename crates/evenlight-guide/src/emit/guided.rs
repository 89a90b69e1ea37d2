//! The table of guided subdivision: the generating matrix and the map of the cap, in integers.
//!
//! For each valence a library cannot compute two things in a moment: the fit of the guide
//! ([`crate::guided::fit`]) and the choice of the cap's map ([`crate::guided::cap`]). All else, the
//! characteristic ring and the tables of rings and cap, follows from the cosine of the turn by
//! `+ - * /` and square roots ([`crate::guided::characteristic`], [`crate::guided::rings`]).
//!
//! The weights are numerators over 10^18. The mirrors make, for the coefficients of sector 0,
//!
//! ```text
//!   p_ji = p_ij of the net mirrored in the diagonal of the sector:  listed are i >= j,
//!                                                                   of p_ii half the sectors
//!   p_i0 = p_i0 of the net mirrored in line -1:                     half the sectors
//! ```
//!
//! exactly. p_00 is c_0, and the weight of e is one minus the sum of all others; neither is listed.

use std::fmt::{self, Write};
use std::ops::Range;

use super::{DENOMINATOR, TableDefect, TableFile};
use crate::guided::cap::{self, cap_map};
use crate::guided::characteristic::CharacteristicRing;
use crate::guided::fit::generating_matrix;
use crate::guided::net::{CNet, NODES_PER_SECTOR};
use crate::guided::space::DEGREE;
use crate::guided::symmetry::{mirrored_in_line, number, symmetric_rows};
use crate::real::Real;

/// The coefficients (i, j) that tables list, in their order.
#[rustfmt::skip]
pub const LISTED: [(usize, usize); 20] = [
    (1, 0), (2, 0), (3, 0), (4, 0), (5, 0),
    (1, 1), (2, 1), (3, 1), (4, 1), (5, 1),
    (2, 2), (3, 2), (4, 2), (5, 2),
    (3, 3), (4, 3), (5, 3),
    (4, 4), (5, 4),
    (5, 5),
];

/// The table of one valence, for the characteristic ring of Catmull-Clark subdivision.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GuidedTable {
    /// The valence n.
    pub valence: usize,
    /// For each coefficient 6i + j of the piece of sector 0 the numerators of the 6n + 1 nodes,
    /// numbered by [`CNet::index`]; the numerator of e is rounded by itself.
    pub coefs: Vec<Vec<i64>>,
    /// The numerators of the first coordinate of the cap's map, number 7i + j.
    pub cap_map: Vec<i64>,
}

impl GuidedTable {
    /// Derives the table of valence n = 3 or 5 <= n <= 16 (beyond 19 weights exceed 9.2, which
    /// 64 bits cannot hold).
    pub fn derive(valence: usize) -> Self {
        let chi = CharacteristicRing::catmull_clark(valence);
        let coefs = symmetric_rows(&generating_matrix(&chi), valence);
        let numerators = |row: &[Real]| -> Vec<i64> {
            row.iter().map(|weight| weight.numerator_over(DENOMINATOR)).collect()
        };
        let map = cap_map(&chi);
        let cap_map = (0..cap::DEGREE + 1).flat_map(|i| numerators(map.row(i))).collect();
        Self { valence, coefs: coefs.iter().map(|row| numerators(row)).collect(), cap_map }
    }

    /// Checks that the mirror symmetries hold exactly, and the partition of unity up to the
    /// rounding of 6n + 1 weights.
    ///
    /// # Errors
    ///
    /// The first defect found.
    pub fn check(&self) -> Result<(), TableDefect> {
        for (i, j) in (0..=DEGREE).flat_map(|i| (0..=DEGREE).map(move |j| (i, j))) {
            let weights = &self.coefs[number(i, j)];
            let net = CNet { valence: self.valence };
            for node in 0..net.num_nodes() {
                let mut images = vec![self.coefs[number(j, i)][net.mirrored(node)]];
                if j == 0 {
                    images.push(weights[mirrored_in_line(net, node)]);
                }
                if images.iter().any(|&image| image != weights[node]) {
                    let weight = format!("weight {node} of coefficient {i}{j}");
                    return Err(TableDefect::Asymmetric { weight });
                }
            }
            let sum: i128 = weights.iter().map(|&weight| i128::from(weight)).sum();
            let excess = sum - i128::from(DENOMINATOR);
            if excess.abs() > net.num_nodes() as i128 / 2 + 1 {
                return Err(TableDefect::NotUnity { rule: format!("coefficient {i}{j}"), excess });
            }
        }
        Ok(())
    }

    /// The sectors r whose weights are listed for a coefficient; -1 is the last.
    ///
    /// For p_i0 the sectors from -1 to (n-1)/2: there the nodes of sector r off the lines mirror
    /// nodes of sector -1-r, and nodes on a line mirror nodes of sector -2-r. For p_ii the sectors
    /// from 0 to n/2: there the nodes mirror sectors -r and -1-r.
    pub fn listed_sectors(&self, (i, j): (usize, usize)) -> Range<isize> {
        let n = self.valence as isize;
        match j {
            0 => -1..(n - 1) / 2 + 1,
            _ if i == j => 0..n / 2 + 1,
            _ => 0..n,
        }
    }

    /// The file of the table: a `static TABLE: GuidedTable`.
    pub fn file(&self) -> TableFile {
        let mut source = String::new();
        self.write_source(&mut source).expect("writing to a string cannot fail");
        TableFile { name: format!("guided_n{:02}.rs", self.valence), source }
    }

    fn write_source(&self, out: &mut String) -> fmt::Result {
        writeln!(
            out,
            "\
// GENERATED by cargo xtask tables. DO NOT EDIT.
//
// The guide of Guided C2 subdivision [KP18-Guided] at valence {n}, derived by the crate
// `evenlight-guide`: numerators over 10^18, each the nearest integer to the exact weight. A row
// holds the weights of the nodes (0,1) (0,2) (1,1), (1,2) (2,1) (2,2) of sector s + r in one
// coefficient of sector s: r = -1, 0, 1, ... for p_i0, r = 0, 1, ... for all others; rows that a
// mirror symmetry repeats are left out.

use super::GuidedTable;

#[rustfmt::skip]
pub(super) static TABLE: GuidedTable = GuidedTable {{
    valence: {n},
    coefs: [",
            n = self.valence
        )?;
        for (i, j) in LISTED {
            writeln!(out, "        // p_{i}{j}\n        &[")?;
            for sector in self.listed_sectors((i, j)) {
                let first = CNet { valence: self.valence }.index(sector, 0, 1);
                let row = &self.coefs[number(i, j)][first..first + NODES_PER_SECTOR];
                write_row(out, row, 3)?;
            }
            writeln!(out, "        ],")?;
        }
        writeln!(out, "    ],\n    cap_map: [")?;
        for row in self.cap_map.chunks_exact(cap::DEGREE + 1) {
            write_row(out, row, 4)?;
        }
        writeln!(out, "    ],\n}};")
    }
}

/// Writes one row of weights, so many on a line.
fn write_row(out: &mut String, row: &[i64], per_line: usize) -> fmt::Result {
    writeln!(out, "            [")?;
    for part in row.chunks(per_line) {
        let columns: Vec<String> = part.iter().map(|weight| format!("{weight:>20},")).collect();
        writeln!(out, "             {}", columns.join(" "))?;
    }
    writeln!(out, "            ],")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_symmetric_and_sum_to_one() {
        for valence in [3, 5, 6, 9] {
            assert_eq!(GuidedTable::derive(valence).check(), Ok(()), "valence {valence}");
        }
    }

    #[test]
    fn defects_are_found() {
        let mut table = GuidedTable::derive(3);
        table.coefs[number(2, 1)][4] += 1;
        assert!(matches!(table.check(), Err(TableDefect::Asymmetric { .. })));
        let mut table = GuidedTable::derive(3);
        table.coefs[0][CNet { valence: 3 }.centre()] += 1_000;
        assert!(matches!(table.check(), Err(TableDefect::NotUnity { excess: 990..1_010, .. })));
    }

    #[test]
    fn what_is_not_listed_has_a_listed_image() {
        for valence in [3, 5, 6, 7, 8, 16] {
            let net = CNet { valence };
            let table = GuidedTable { valence, coefs: Vec::new(), cap_map: Vec::new() };
            for (i, j) in LISTED {
                let is_listed = |node: usize| {
                    let mut sectors = table.listed_sectors((i, j));
                    sectors
                        .any(|s| s.rem_euclid(valence as isize) as usize == node / NODES_PER_SECTOR)
                };
                for node in 0..net.centre() {
                    let image = match j {
                        0 => mirrored_in_line(net, node),
                        _ if i == j => net.mirrored(node),
                        _ => node,
                    };
                    assert!(is_listed(node) || is_listed(image), "n = {valence}, ({i}, {j})");
                }
            }
        }
    }

    #[test]
    fn the_source_holds_the_weights_in_100_columns() {
        let table = GuidedTable::derive(5);
        let TableFile { name, source } = table.file();
        assert_eq!(name, "guided_n05.rs");
        assert!(source.lines().all(|line| line.len() <= 100));
        for (i, j) in LISTED {
            assert!(source.contains(&format!(" {},", table.coefs[number(i, j)][0])));
        }
        assert_eq!(source.matches("            [\n").count(), 5 * 4 + 5 * 3 + 10 * 5 + 7);
    }
}
