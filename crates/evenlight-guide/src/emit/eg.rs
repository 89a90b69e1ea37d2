//! The table of the Evolving-Guide rules, and of others with the same layout.

use std::fmt::{self, Write};

use super::{DENOMINATOR, TableDefect, TableFile, check_unity, write_rows};
use crate::evolving_guide::{EG_ORDER, NetRule, evolving_guide, symmetrised};
use crate::nets::{DNet, NODES_PER_SECTOR, own_nodes};
use crate::optimal::rules::fair_evolving;
use crate::real::Real;
use crate::rules::{RULES, mirror_of, number_of};

/// The rules that tables list, in their order, as (h, k); (1, 2) is the mirror image of (2, 1).
const LISTED: [(usize, usize); 5] = [(1, 1), (2, 2), (2, 1), (3, 1), (3, 2)];

/// The schemes with such a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EgTitle {
    /// Evolving-Guide subdivision.
    EvolvingGuide,
    /// Fairness-optimal subdivision with q found anew in each step.
    Fair4d,
}

impl EgTitle {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::EvolvingGuide, Self::Fair4d];

    fn rules(self, valence: usize) -> [NetRule; 6] {
        match self {
            Self::EvolvingGuide => symmetrised(valence, &evolving_guide(valence, EG_ORDER)),
            Self::Fair4d => fair_evolving(valence),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::EvolvingGuide => "eg",
            Self::Fair4d => "fair/fair4d",
        }
    }

    /// The lines that say what the table is.
    fn about(self, valence: usize) -> String {
        match self {
            Self::EvolvingGuide => format!(
                "\
// The Evolving-Guide refinement rules of valence {valence} [KP23-EG, eq. 7], derived by the crate
// `evenlight-guide`: numerators over 10^18, each the nearest integer to the exact weight. A row
// holds the weights of d_00 d_10 d_20 d_30, d_01 d_11 d_21 d_31, d_02 d_12 d_22 d_32 of sector
// s + r, r = 0, 1, ... from the top; rows that a mirror symmetry repeats are left out.

use super::EgTable;"
            ),
            Self::Fair4d => format!(
                "\
// The refinement rules of fair4d, valence {valence}, in the layout of Evolving-Guide rules, \
derived by
// the crate `evenlight-guide`, module `optimal`: numerators over 10^18. A row holds the weights of
// d_00 d_10 d_20 d_30, d_01 d_11 d_21 d_31, d_02 d_12 d_22 d_32 of sector s + r, r = 0, 1, ... from
// the top; rows that a mirror symmetry repeats are left out.

use crate::scheme::tables::EgTable;"
            ),
        }
    }

    /// The visibility of the table.
    fn visibility(self) -> &'static str {
        match self {
            Self::EvolvingGuide => "pub(super)",
            Self::Fair4d => "pub(in crate::scheme::tables)",
        }
    }
}

/// The Evolving-Guide rules of one valence in integers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EgTable {
    /// The scheme.
    pub title: EgTitle,
    /// The valence n.
    pub valence: usize,
    /// For each of [`RULES`] the numerators of the 12n nodes' weights, numbered by
    /// [`DNet::index`].
    pub numerators: [Vec<i64>; 6],
    /// For each of [`RULES`] the numerator of the derived weight of c_0, rounded by itself.
    pub centre: [i64; 6],
}

impl EgTable {
    /// Derives the table of valence n >= 3.
    pub fn derive(valence: usize, title: EgTitle) -> Self {
        let rules = title.rules(valence);
        let numerator = |weight: &Real| weight.numerator_over(DENOMINATOR);
        let numerators = |rule: &NetRule| rule.on_net.iter().map(numerator).collect();
        Self {
            title,
            valence,
            numerators: rules.each_ref().map(numerators),
            centre: rules.each_ref().map(|rule| numerator(&rule.on_centre)),
        }
    }

    /// Checks that the mirror symmetries hold exactly, and the partition of unity up to the
    /// rounding of 12n + 1 weights.
    ///
    /// # Errors
    ///
    /// The first defect found.
    pub fn check(&self) -> Result<(), TableDefect> {
        for (number, (h, k)) in RULES.into_iter().enumerate() {
            self.check_symmetry(number)?;
            let weights = self.numerators[number].iter().chain([&self.centre[number]]);
            check_unity(format!("rule {h}{k}"), weights)?;
        }
        Ok(())
    }

    fn check_symmetry(&self, number: usize) -> Result<(), TableDefect> {
        let net = DNet { valence: self.valence };
        let (mirror, image) = mirror_of(number);
        for (r, (i, j)) in (0..self.valence).flat_map(|r| own_nodes().map(move |node| (r, node))) {
            let own = self.numerators[number][net.index(r as isize, i, j)];
            let (r2, i2, j2) = mirror.image((r as isize, i, j));
            if own != self.numerators[image][net.index(r2, i2, j2)] {
                let (h, k) = RULES[number];
                let weight = format!("weight a_{i}{j}^{r} of rule {h}{k}");
                return Err(TableDefect::Asymmetric { weight });
            }
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

    /// The file of the table: a `static TABLE: EgTable`.
    pub fn file(&self) -> TableFile {
        let mut source = String::new();
        self.write_source(&mut source).expect("writing to a string cannot fail");
        TableFile { name: format!("{}_n{:02}.rs", self.title.name(), self.valence), source }
    }

    fn write_source(&self, out: &mut String) -> fmt::Result {
        writeln!(
            out,
            "\
// GENERATED by cargo xtask tables. DO NOT EDIT.
//
{about}

#[rustfmt::skip]
{visibility} static TABLE: EgTable = EgTable {{
    valence: {n},",
            about = self.title.about(self.valence),
            visibility = self.title.visibility(),
            n = self.valence
        )?;
        for (h, k) in LISTED {
            let rows = self.numerators[number_of(h, k)].chunks_exact(NODES_PER_SECTOR);
            let listed = rows.take(self.num_listed_rows((h, k)));
            write_rows(out, &format!("rule_{h}{k}"), listed)?;
        }
        writeln!(out, "}};")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defects_are_found() {
        let mut table = EgTable::derive(3, EgTitle::EvolvingGuide);
        table.numerators[0][1] += 1;
        let weight = "weight a_10^0 of rule 11".to_owned();
        assert_eq!(table.check(), Err(TableDefect::Asymmetric { weight }));
        let mut table = EgTable::derive(3, EgTitle::EvolvingGuide);
        table.numerators[0][0] += 1_000; // d_00 of the own sector is its own mirror image
        let Err(TableDefect::NotUnity { rule, excess }) = table.check() else {
            panic!("the sum is wrong");
        };
        assert_eq!(rule, "rule 11");
        assert!((900..1_100).contains(&excess));
    }

    #[test]
    fn the_source_lists_the_rows_that_no_symmetry_repeats() {
        let table = EgTable::derive(5, EgTitle::EvolvingGuide);
        let source = table.file().source;
        assert_eq!(source.matches("        [\n").count(), 5 + 2 * 3 + 2 * 4);
        for weight in &table.numerators[0][..12] {
            assert!(source.contains(&format!(" {weight},")));
        }
    }
}
