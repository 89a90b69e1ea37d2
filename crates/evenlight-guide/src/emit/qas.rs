//! The table of the Quadratic-Attraction rules, and of others with the same layout.

use std::fmt::{self, Write};

use super::{DENOMINATOR, TableDefect, TableFile, check_unity, write_line, write_rows};
use crate::evolving_guide::NetRule;
use crate::nets::{DNet, Mirror, NODES_PER_SECTOR, own_nodes};
use crate::optimal::nets::Spline;
use crate::optimal::rules::fair;
use crate::quadratic::Q_MIRRORED;
use crate::quadratic_attraction::{Q_RULES, QAS_ORDER, QasRules, quadratic_attraction};
use crate::real::Real;
use crate::rules::{RULES, StepRule, TURNS, mirror_of, number_of};

/// The rules that tables list, in their order, as (h, k); (1, 2) is the mirror image of (2, 1).
const LISTED: [(usize, usize); 5] = [(1, 1), (2, 2), (2, 1), (3, 1), (3, 2)];

/// The schemes with such a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QasTitle {
    /// Quadratic-Attraction subdivision.
    QuadraticAttraction,
    /// Fairness-optimal subdivision with bi-4 splines.
    Fair4,
    /// Fairness-optimal subdivision with bi-3 splines.
    Fair3,
}

impl QasTitle {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::QuadraticAttraction, Self::Fair4, Self::Fair3];

    fn rules(self, valence: usize) -> QasRules {
        match self {
            Self::QuadraticAttraction => quadratic_attraction(valence, QAS_ORDER),
            Self::Fair4 => fair(valence, Spline::BiQuartic),
            Self::Fair3 => fair(valence, Spline::BiCubic),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::QuadraticAttraction => "qas",
            Self::Fair4 => "fair/fair4",
            Self::Fair3 => "fair/fair3",
        }
    }

    /// The lines that say what the table is.
    fn about(self, valence: usize) -> String {
        let splines = match self {
            Self::QuadraticAttraction => {
                return format!(
                    "\
// The Quadratic-Attraction refinement rules of valence {valence} [KP23-QAS, eq. 6, 7 and S2], \
derived by
// the crate `evenlight-guide`: numerators over 10^18, each the nearest integer to the exact weight.
{LAYOUT}
use super::QasTable;"
                );
            }
            Self::Fair4 => "fair4 (bi-4 splines)",
            Self::Fair3 => "fair3 (bi-3 splines)",
        };
        format!(
            "\
// The refinement rules of {splines}, valence {valence}, in the layout of Quadratic-Attraction
// rules, derived by the crate `evenlight-guide`, module `optimal`: numerators over 10^18.
{LAYOUT}
use crate::scheme::tables::QasTable;"
        )
    }

    /// The visibility of the table.
    fn visibility(self) -> &'static str {
        match self {
            Self::QuadraticAttraction => "pub(super)",
            Self::Fair4 | Self::Fair3 => "pub(in crate::scheme::tables)",
        }
    }
}

/// The lines about the order of the weights.
const LAYOUT: &str = "\
// kappa, line by line: d_00 d_10 d_20 d_30, d_01 d_11 d_21 d_31, d_02 d_12 d_22 d_32 of sector s;
// d_30 d_31 d_32, d_20 d_21 d_22 of sector s-1; for rule 21 also d_02 d_12 d_22 of sector s+1.
// tau: q_2 q_3, q_4 q_5, q_6 of sector s. mu: a row holds the twelve nodes of sector s + r, r = 0,
// 1, ... from the top. What a mirror symmetry repeats is left out.
";

/// The Quadratic-Attraction rules of one valence in integers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QasTable {
    /// The scheme.
    pub title: QasTitle,
    /// The valence n.
    pub valence: usize,
    /// The rules of the new nodes, in the order of [`RULES`].
    pub nodes: [NodeNumerators; 6],
    /// The rules of q_4 and q_5, in the order of [`Q_RULES`].
    pub q: [QuadraticNumerators; 2],
}

/// One rule of a new node: the numerators of [`StepRule`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeNumerators {
    /// For each r of [`TURNS`] the numerators of kappa_ij^r, in flat order.
    pub kappa: [[i64; NODES_PER_SECTOR]; 4],
    /// The numerators of tau_2..tau_6.
    pub tau: [i64; 5],
    /// That of the derived weight of the extraordinary point, rounded by itself.
    pub centre: i64,
}

/// The rule of one coefficient of the first q.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QuadraticNumerators {
    /// The numerators of mu_ij^r, numbered by [`DNet::index`].
    pub mu: Vec<i64>,
    /// That of the derived weight of the extraordinary point, rounded by itself.
    pub centre: i64,
}

impl QasTable {
    /// Derives the table of valence n >= 3.
    pub fn derive(valence: usize, title: QasTitle) -> Self {
        let rules = title.rules(valence);
        Self {
            title,
            valence,
            nodes: rules.nodes.each_ref().map(NodeNumerators::of),
            q: rules.q.each_ref().map(QuadraticNumerators::of),
        }
    }

    /// Checks that the mirror symmetries hold exactly, and the partition of unity up to rounding.
    ///
    /// # Errors
    ///
    /// The first defect found.
    pub fn check(&self) -> Result<(), TableDefect> {
        for (number, (h, k)) in RULES.into_iter().enumerate() {
            self.check_kappa(number)?;
            self.check_tau(number)?;
            let NodeNumerators { kappa, tau, centre } = &self.nodes[number];
            let weights = kappa.iter().flatten().chain(tau).chain([centre]);
            check_unity(format!("rule {h}{k}"), weights)?;
        }
        for ((m, mirror), rule) in Q_RULES.into_iter().zip(&self.q) {
            self.check_mu(m, mirror, &rule.mu)?;
            check_unity(format!("q_{m}"), rule.mu.iter().chain([&rule.centre]))?;
        }
        Ok(())
    }

    fn check_kappa(&self, number: usize) -> Result<(), TableDefect> {
        let (mirror, image) = mirror_of(number);
        for (r, (i, j)) in TURNS.into_iter().flat_map(|r| own_nodes().map(move |node| (r, node))) {
            let own = self.nodes[number].kappa((r, i, j));
            if own != self.nodes[image].kappa(mirror.image((r, i, j))) {
                let (h, k) = RULES[number];
                let weight = format!("weight kappa_{i}{j}^{r} of rule {h}{k}");
                return Err(TableDefect::Asymmetric { weight });
            }
        }
        Ok(())
    }

    fn check_tau(&self, number: usize) -> Result<(), TableDefect> {
        let (mirror, image) = mirror_of(number);
        if mirror == Mirror::Line {
            return Ok(()); // the rule itself has both sides
        }
        for (m, number_of_q) in (1..6).zip(2..) {
            if self.nodes[number].tau[m - 1] != self.nodes[image].tau[Q_MIRRORED[m] - 1] {
                let (h, k) = RULES[number];
                let weight = format!("weight tau_{number_of_q} of rule {h}{k}");
                return Err(TableDefect::Asymmetric { weight });
            }
        }
        Ok(())
    }

    fn check_mu(&self, m: usize, mirror: Mirror, mu: &[i64]) -> Result<(), TableDefect> {
        let net = DNet { valence: self.valence };
        for (r, (i, j)) in (0..self.valence).flat_map(|r| own_nodes().map(move |node| (r, node))) {
            let (r2, i2, j2) = mirror.image((r as isize, i, j));
            if mu[net.index(r as isize, i, j)] != mu[net.index(r2, i2, j2)] {
                let weight = format!("weight mu_{i}{j}^{r} of q_{m}");
                return Err(TableDefect::Asymmetric { weight });
            }
        }
        Ok(())
    }

    /// The file of the table: a `static TABLE: QasTable`.
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
{visibility} static TABLE: QasTable = QasTable {{
    valence: {n},",
            about = self.title.about(self.valence),
            visibility = self.title.visibility(),
            n = self.valence
        )?;
        for (h, k) in LISTED {
            self.write_kappa(out, h, k)?;
        }
        for (h, k) in LISTED {
            self.write_tau(out, h, k)?;
        }
        // As for Evolving-Guide: row -r of q_5 is the mirror image of row r, row 1-r that of q_4.
        let num_listed_rows = [self.valence.div_ceil(2) + 1, self.valence / 2 + 1];
        for (((m, _), rule), listed) in Q_RULES.iter().zip(&self.q).zip(num_listed_rows) {
            let rows = rule.mu.chunks_exact(NODES_PER_SECTOR).take(listed);
            write_rows(out, &format!("mu_{m}"), rows)?;
        }
        writeln!(out, "}};")
    }

    fn write_kappa(&self, out: &mut String, h: usize, k: usize) -> fmt::Result {
        let rule = &self.nodes[number_of(h, k)];
        writeln!(out, "    kappa_{h}{k}: &[")?;
        for j in 0..3 {
            write_line(out, 8, &[0, 1, 2, 3].map(|i| rule.kappa((0, i, j))))?;
        }
        write_line(out, 8, &[0, 1, 2].map(|j| rule.kappa((-1, 3, j))))?;
        write_line(out, 8, &[0, 1, 2].map(|j| rule.kappa((-1, 2, j))))?;
        if (h, k) == (2, 1) {
            write_line(out, 8, &[0, 1, 2].map(|i| rule.kappa((1, i, 2))))?;
        }
        writeln!(out, "    ],")
    }

    fn write_tau(&self, out: &mut String, h: usize, k: usize) -> fmt::Result {
        let [q_2, q_3, q_4, q_5, q_6] = self.nodes[number_of(h, k)].tau;
        writeln!(out, "    tau_{h}{k}: [")?;
        for line in [[q_2, q_3].as_slice(), &[q_4, q_5], &[q_6]] {
            write_line(out, 8, line)?;
        }
        writeln!(out, "    ],")
    }
}

impl NodeNumerators {
    fn of(rule: &StepRule) -> Self {
        Self {
            kappa: rule.kappa.map(|row| row.map(numerator)),
            tau: rule.tau.map(numerator),
            centre: numerator(rule.on_centre),
        }
    }

    /// The numerator of kappa_ij^r, zero out of reach.
    fn kappa(&self, (r, i, j): (isize, usize, usize)) -> i64 {
        let row = TURNS.iter().position(|&turn| turn == r);
        row.map_or(0, |row| self.kappa[row][i + 4 * j])
    }
}

impl QuadraticNumerators {
    fn of(rule: &NetRule) -> Self {
        let mu = rule.on_net.iter().map(|&weight| numerator(weight)).collect();
        Self { mu, centre: numerator(rule.on_centre) }
    }
}

fn numerator(weight: Real) -> i64 {
    weight.numerator_over(DENOMINATOR)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn defect(damage: fn(&mut QasTable)) -> TableDefect {
        let mut table = QasTable::derive(5, QasTitle::QuadraticAttraction);
        assert_eq!(table.check(), Ok(()));
        damage(&mut table);
        table.check().unwrap_err()
    }

    #[test]
    fn broken_symmetries_are_found() {
        let asymmetric = |weight: &str| TableDefect::Asymmetric { weight: weight.to_owned() };
        let found = defect(|table| table.nodes[4].kappa[0][3] += 1);
        assert_eq!(found, asymmetric("weight kappa_30^-1 of rule 31"));
        let found = defect(|table| table.nodes[0].tau[0] += 1);
        assert_eq!(found, asymmetric("weight tau_2 of rule 11"));
        let found = defect(|table| table.q[0].mu[0] += 1);
        assert_eq!(found, asymmetric("weight mu_00^0 of q_4"));
    }

    #[test]
    fn wrong_sums_are_found() {
        let sum = |defect| match defect {
            TableDefect::NotUnity { rule, excess } => (rule, excess / 900),
            TableDefect::Asymmetric { weight } => panic!("{weight}"),
        };
        // The sums are off by less than 100 without.
        let found = defect(|table| table.nodes[5].tau[2] += 1_000);
        assert_eq!(sum(found), ("rule 32".to_owned(), 1));
        let found = defect(|table| table.q[1].mu[0] -= 1_000); // its own mirror image
        assert_eq!(sum(found), ("q_5".to_owned(), -1));
    }

    /// Whether the table lists kappa_ij^r of the rule.
    fn is_listed(rule: (usize, usize), (r, i, j): (isize, usize, usize)) -> bool {
        match r {
            -1 => i >= 2,
            0 => true,
            1 => rule == (2, 1) && j == 2 && i < 3,
            _ => false,
        }
    }

    #[test]
    fn weights_that_are_neither_listed_nor_images_of_listed_ones_are_zero() {
        let nodes = || TURNS.into_iter().flat_map(|r| own_nodes().map(move |(i, j)| (r, i, j)));
        for (h, k) in LISTED {
            let number = number_of(h, k);
            let (mirror, image) = mirror_of(number);
            let is_known = |node| {
                is_listed((h, k), node) || image == number && is_listed((h, k), mirror.image(node))
            };
            let rule = &QasTable::derive(8, QasTitle::QuadraticAttraction).nodes[number];
            assert!(nodes().all(|node| is_known(node) || rule.kappa(node) == 0), "rule {h}{k}");
        }
    }

    #[test]
    fn the_source_lists_as_many_weights_as_the_library_expects() {
        let source = QasTable::derive(5, QasTitle::QuadraticAttraction).file().source;
        let count = |field: &str| {
            let (_, rest) = source.split_once(&format!("    {field}: ")).unwrap();
            let (list, _) = rest.split_once("\n    ],").unwrap();
            list.matches(',').count() - list.matches("],").count()
        };
        let fields = ["kappa_11", "kappa_22", "kappa_21", "kappa_31", "kappa_32"].map(count);
        assert_eq!(fields, [18, 18, 21, 18, 18]);
        let fields = ["tau_11", "tau_22", "tau_21", "tau_31", "tau_32"].map(count);
        assert_eq!(fields, [5; 5]);
        assert_eq!(["mu_4", "mu_5"].map(count), [4 * 12, 3 * 12]);
    }
}
