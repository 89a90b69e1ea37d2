//! Tables of refinement weights: the generated files, and the one way to read them.
//!
//! The files `eg_nNN.rs` hold the rules of Evolving-Guide subdivision, read in [`eg`]; the files
//! `qas_nNN.rs` the rules of Quadratic-Attraction subdivision, read in [`qas`]; the files
//! `guided_nNN.rs` the guides of Guided C2 subdivision, read in [`guided`]; the folder `fair` our
//! own rules, read in [`fair`]. Module [`forms`] says what they hold: exact integers over
//! [`DENOMINATOR`]. The weight of the extraordinary point is never listed, as it is one minus the
//! sum of all others. The files leave out what a mirror symmetry repeats, up to a few weights that
//! make rows complete; [`Mirror`] fills it in.
//!
//! `cargo xtask tables` derives and writes the files, `cargo xtask tables --check` compares them.
//! Should they be so broken that this crate does not compile, build the chore without it:
//! `cargo run -p xtask --release --no-default-features -- tables`.

mod eg;
mod eg_n03;
mod eg_n05;
mod eg_n06;
mod eg_n07;
mod eg_n08;
mod eg_n09;
mod eg_n10;
mod eg_n11;
mod eg_n12;
mod eg_n13;
mod eg_n14;
mod eg_n15;
mod eg_n16;
mod fair;
mod forms;
mod guided;
mod guided_n03;
mod guided_n05;
mod guided_n06;
mod guided_n07;
mod guided_n08;
mod guided_n09;
mod guided_n10;
mod guided_n11;
mod guided_n12;
mod guided_n13;
mod guided_n14;
mod guided_n15;
mod guided_n16;
mod qas;
mod qas_n03;
mod qas_n05;
mod qas_n06;
mod qas_n07;
mod qas_n08;
mod qas_n09;
mod qas_n10;
mod qas_n11;
mod qas_n12;
mod qas_n13;
mod qas_n14;
mod qas_n15;
mod qas_n16;

pub(crate) use eg::{EgWeights, eg_weights};
pub(crate) use fair::{fair_evolving_weights, fair_weights};
pub(crate) use guided::{GuideWeights, guide_weights};
pub(crate) use qas::{QasWeights, qas_weights};

use forms::{EgTable, GuidedTable, QasTable};

/// The common denominator of all numerators, 10^18.
const DENOMINATOR: i64 = 1_000_000_000_000_000_000;

/// The denominator of the weights as printed, 10^5.
const PUBLISHED_DENOMINATOR: i64 = 100_000;

/// The valences with tables.
pub(crate) const VALENCES: [usize; 13] = [3, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

/// The valences of which [KP23-EG] and [KP23-QAS] print the rules.
const PUBLISHED_VALENCES: [usize; 7] = [3, 5, 6, 7, 8, 9, 10];

/// The new nodes (h,k) with rules.
const RULES: [(usize, usize); 6] = [(1, 1), (2, 1), (1, 2), (2, 2), (3, 1), (3, 2)];

/// The nodes of a sector, 00 10 20 30 01 11 21 31 02 12 22 32; d_ij is number i + 4j.
const NODES: usize = crate::net::DNET_NODES;

/// The place of a valence among the tables, if there is one and, for `published`, a paper prints
/// it.
fn table_index(valence: usize, published: bool) -> Option<usize> {
    if published && !PUBLISHED_VALENCES.contains(&valence) {
        return None;
    }
    VALENCES.iter().position(|&n| n == valence)
}

/// The weight with this numerator to 1 ulp; or, if `published`, the `f64` nearest to what the
/// papers print.
fn weight(numerator: i64, published: bool) -> f64 {
    if published {
        truncated(numerator) as f64 / PUBLISHED_DENOMINATOR as f64
    } else {
        numerator as f64 / DENOMINATOR as f64
    }
}

/// The numerator over [`PUBLISHED_DENOMINATOR`], truncated toward zero as the papers do.
fn truncated(numerator: i64) -> i64 {
    numerator / (DENOMINATOR / PUBLISHED_DENOMINATOR)
}

/// The place of the rule of the new node (h,k) in [`RULES`].
///
/// # Panics
///
/// If (h,k) is not one of the six nodes with rules.
fn rule_index(h: usize, k: usize) -> usize {
    let rule = RULES.iter().position(|&rule| rule == (h, k));
    rule.expect("the other nodes have regular rules")
}

/// A mirror that maps the d-net to itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mirror {
    /// In line s: sectors s and s+1 change places.
    Line,
    /// In the diagonal of sector s: lines s-1 and s change places.
    Diagonal,
}

impl Mirror {
    /// The mirror that maps the rule of the new node (h,k) to a rule of the same sector, and the
    /// node of that rule.
    fn of_rule((h, k): (usize, usize)) -> (Self, (usize, usize)) {
        if h == 3 { (Self::Line, (h, k)) } else { (Self::Diagonal, (k, h)) }
    }

    /// The image of node number i + 4j of sector s + r, as r and number; its own inverse.
    ///
    /// ```text
    ///   Line      (r, i, j) -> (1 - r, j, i)     (r, 3, j) -> (-r, 3, j)        (i below 3)
    ///   Diagonal  (r, i, j) -> (-r, j, i)        (r, 3, j) -> (-1 - r, 3, j)
    /// ```
    fn image(self, (r, node): (isize, usize)) -> (isize, usize) {
        let (i, j) = (node % 4, node / 4);
        let on_line = match self {
            Self::Line => -r,
            Self::Diagonal => -1 - r,
        };
        if i == 3 { (on_line, node) } else { (on_line + 1, j + 4 * i) }
    }
}

/// The numerator in row `r`, modulo n, of rows 0..n of which only the first are listed: those that
/// `mirror` does not map to listed ones.
fn completed(
    rows: &[[i64; NODES]],
    valence: usize,
    mirror: Mirror,
    (r, node): (isize, usize),
) -> i64 {
    let modulo = |r: isize| r.rem_euclid(valence as isize) as usize;
    let (image_r, image) = mirror.image((r, node));
    let listed = rows.get(modulo(r)).map(|row| row[node]);
    listed.unwrap_or_else(|| rows[modulo(image_r)][image])
}

/// A file of `data/golden/eg`.
#[cfg(test)]
fn golden(file: &str) -> serde_json::Value {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/golden/eg");
    serde_json::from_str(&std::fs::read_to_string(format!("{folder}/{file}")).unwrap()).unwrap()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mirrors_are_their_own_inverses_and_keep_rules() {
        for mirror in [Mirror::Line, Mirror::Diagonal] {
            for (r, node) in (-3..=3).flat_map(|r| (0..NODES).map(move |node| (r, node))) {
                assert_eq!(mirror.image(mirror.image((r, node))), (r, node));
            }
        }
        for rule in RULES {
            let (mirror, image) = Mirror::of_rule(rule);
            assert_eq!(Mirror::of_rule(image), (mirror, rule));
        }
    }

    #[test]
    fn printed_numbers_are_truncated_toward_zero() {
        assert_eq!(truncated(19_999_999_999_999), 1);
        assert_eq!(truncated(-19_999_999_999_999), -1);
        assert_eq!(weight(-616_381_761_043_350_922, true), -0.61638);
    }
}
