//! Tables of refinement weights: the generated files, and the one way to read them.
//!
//! The files `eg_nNN.rs` hold the rules of Evolving-Guide subdivision [KP23-EG, eq. 7] as exact
//! integers over [`DENOMINATOR`]. For the new nodes (h,k) = (1,1), (2,1), (1,2), (2,2), (3,1),
//! (3,2) of sector s
//!
//! ```text
//!   d_hk^s = c_0 + sum over r = 0..n-1 and the 12 nodes (i,j) of a_ij^(r,hk) (d_ij^(s+r) - c_0),
//! ```
//!
//! that is, c_0 has the weight one minus the sum of all others. Mirror symmetry in lines and
//! diagonals makes, with h, k, i, j below 3 and r modulo n,
//!
//! ```text
//!   a_ij^(r,hk) = a_ji^(-r,kh)       a_3j^(r,hk) = a_3j^(-r-1,kh)
//!   a_ij^(r,3k) = a_ji^(1-r,3k)      a_3j^(r,3k) = a_3j^(-r,3k)
//! ```
//!
//! exactly; the files leave out the rows that follow: all of rule 12, and r > n/2 of 11 and 22,
//! r > (n+1)/2 of 31 and 32.
//!
//! `cargo xtask tables` derives and writes the files, `cargo xtask tables --check` compares them.
//! Should they be so broken that this crate does not compile, build the chore without it:
//! `cargo run -p xtask --release --no-default-features -- tables`.

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

/// The common denominator of all numerators, 10^18.
pub(crate) const DENOMINATOR: i64 = 1_000_000_000_000_000_000;

/// The denominator of the weights as printed, 10^5.
const PUBLISHED_DENOMINATOR: i64 = 100_000;

/// The valences with Evolving-Guide rules.
pub(crate) const EG_VALENCES: [usize; 13] = [3, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

/// The valences of which [KP23-EG] prints the rules.
pub(crate) const EG_PUBLISHED_VALENCES: [usize; 7] = [3, 5, 6, 7, 8, 9, 10];

/// The tables of [`EG_VALENCES`].
static EG_TABLES: [&EgTable; 13] = [
    &eg_n03::TABLE,
    &eg_n05::TABLE,
    &eg_n06::TABLE,
    &eg_n07::TABLE,
    &eg_n08::TABLE,
    &eg_n09::TABLE,
    &eg_n10::TABLE,
    &eg_n11::TABLE,
    &eg_n12::TABLE,
    &eg_n13::TABLE,
    &eg_n14::TABLE,
    &eg_n15::TABLE,
    &eg_n16::TABLE,
];

/// The new nodes (h,k) with rules, in the order of [`EgWeights`].
const RULES: [(usize, usize); 6] = [(1, 1), (2, 1), (1, 2), (2, 2), (3, 1), (3, 2)];

/// The Evolving-Guide rules of one valence: numerators over [`DENOMINATOR`].
///
/// A rule is a list of rows r = 0, 1, ...; a row has the weights of the nodes
/// 00 10 20 30 01 11 21 31 02 12 22 32 of sector s + r.
pub(crate) struct EgTable {
    /// The valence n.
    pub valence: usize,
    /// The rule of d_11, rows 0..=n/2.
    pub rule_11: &'static [[i64; 12]],
    /// The rule of d_22, rows 0..=n/2.
    pub rule_22: &'static [[i64; 12]],
    /// The rule of d_21, all n rows.
    pub rule_21: &'static [[i64; 12]],
    /// The rule of d_31, rows 0..=(n+1)/2.
    pub rule_31: &'static [[i64; 12]],
    /// The rule of d_32, rows 0..=(n+1)/2.
    pub rule_32: &'static [[i64; 12]],
}

/// All weights of the Evolving-Guide rules of one valence but those of c_0.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EgWeights {
    /// For each of 11 21 12 22 31 32, for each r = 0..n-1, the weights of the 12 nodes of sector
    /// s + r.
    pub weights: [Vec<[f64; 12]>; 6],
}

/// The table of one valence, if there is one.
pub(crate) fn eg(valence: usize) -> Option<&'static EgTable> {
    let index = EG_VALENCES.iter().position(|&n| n == valence)?;
    Some(EG_TABLES[index])
}

/// The weights of one valence: those of the table, to 1 ulp; or, if `published`, the nearest to
/// what [KP23-EG] prints, that is truncated toward zero to 5 digits.
///
/// `None` if there is no table, or nothing printed.
pub(crate) fn eg_weights(valence: usize, published: bool) -> Option<EgWeights> {
    if published && !EG_PUBLISHED_VALENCES.contains(&valence) {
        return None;
    }
    let table = eg(valence)?;
    let weight = |numerator: i64| {
        if published {
            truncated(numerator) as f64 / PUBLISHED_DENOMINATOR as f64
        } else {
            numerator as f64 / DENOMINATOR as f64
        }
    };
    let row = |rule, r| std::array::from_fn(|node| weight(table.numerator(rule, r, node)));
    Some(EgWeights { weights: RULES.map(|rule| (0..valence).map(|r| row(rule, r)).collect()) })
}

/// The numerator over [`PUBLISHED_DENOMINATOR`], truncated toward zero as the paper does.
fn truncated(numerator: i64) -> i64 {
    numerator / (DENOMINATOR / PUBLISHED_DENOMINATOR)
}

impl EgWeights {
    /// The weights of the nodes 00 10 20 30 01 11 21 31 02 12 22 32 of sector s + `r` in the rule
    /// of the new node (h,k) of sector s.
    ///
    /// # Panics
    ///
    /// If (h,k) is not one of the six nodes with rules, or `r` is not below the valence.
    pub(crate) fn row(&self, h: usize, k: usize, r: usize) -> &[f64; 12] {
        let rule = RULES.iter().position(|&rule| rule == (h, k));
        &self.weights[rule.expect("the other nodes have regular rules")][r]
    }
}

impl EgTable {
    /// The numerator of the weight of `node` = i + 4j in sector s + r, listed or not.
    fn numerator(&self, rule: (usize, usize), r: usize, node: usize) -> i64 {
        if let Some(row) = self.rows(rule).get(r) {
            return row[node];
        }
        let (rule, r, node) = self.mirrored(rule, r, node);
        self.rows(rule)[r][node]
    }

    /// The listed rows; rule 12 has none, being the mirror image of 21.
    fn rows(&self, rule: (usize, usize)) -> &'static [[i64; 12]] {
        match rule {
            (1, 1) => self.rule_11,
            (2, 1) => self.rule_21,
            (2, 2) => self.rule_22,
            (3, 1) => self.rule_31,
            (3, 2) => self.rule_32,
            _ => &[],
        }
    }

    /// The weight that is equal for reasons of symmetry; its own inverse.
    fn mirrored(
        &self,
        (h, k): (usize, usize),
        r: usize,
        node: usize,
    ) -> ((usize, usize), usize, usize) {
        let n = self.valence;
        let (i, j) = (node % 4, node / 4);
        let node = if i == 3 { node } else { j + 4 * i };
        match (h, i) {
            (3, 3) => ((3, k), (n - r) % n, node),
            (3, _) => ((3, k), (n + 1 - r) % n, node),
            (_, 3) => ((k, h), n - 1 - r, node),
            (_, _) => ((k, h), (n - r) % n, node),
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;

    fn golden(file: &str) -> Value {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/golden/eg");
        serde_json::from_str(&std::fs::read_to_string(format!("{folder}/{file}")).unwrap()).unwrap()
    }

    fn rule_of(name: &str) -> (usize, usize) {
        let number: usize = name.parse().unwrap();
        (number / 10, number % 10)
    }

    #[test]
    fn every_valence_has_its_own_table_and_no_more_rows_than_it_needs() {
        for n in EG_VALENCES {
            let table = eg(n).unwrap();
            assert_eq!(table.valence, n);
            assert_eq!(table.rule_21.len(), n);
            assert_eq!((table.rule_11.len(), table.rule_22.len()), (n / 2 + 1, n / 2 + 1));
            let on_line = n.div_ceil(2) + 1;
            assert_eq!((table.rule_31.len(), table.rule_32.len()), (on_line, on_line));
        }
        for n in [0, 1, 2, 4, 17] {
            assert!(eg(n).is_none() && eg_weights(n, false).is_none());
        }
        assert!(eg_weights(11, true).is_none());
    }

    #[test]
    fn mirror_images_are_equal_to_the_last_digit() {
        for n in EG_VALENCES {
            let table = eg(n).unwrap();
            for rule in RULES {
                for (r, node) in (0..n).flat_map(|r| (0..12).map(move |node| (r, node))) {
                    let (rule2, r2, node2) = table.mirrored(rule, r, node);
                    assert_eq!(table.mirrored(rule2, r2, node2), (rule, r, node));
                    let image = table.numerator(rule2, r2, node2);
                    assert_eq!(table.numerator(rule, r, node), image, "n = {n}, {rule:?}");
                }
            }
        }
    }

    #[test]
    fn truncated_tables_are_the_printed_ones() {
        let published = golden("published.json");
        let mut numbers = 0;
        let mut check = |n: usize, rule, r: usize, row: &Value| {
            for (node, printed) in row.as_array().unwrap().iter().enumerate() {
                let own = truncated(eg(n).unwrap().numerator(rule, r, node));
                assert_eq!(own, printed.as_i64().unwrap(), "n = {n}, {rule:?}, {r}, {node}");
                numbers += 1;
            }
        };
        for (n, rules) in published["EG"].as_object().unwrap() {
            for (name, rows) in rules.as_object().unwrap() {
                for (r, row) in rows.as_array().unwrap().iter().enumerate() {
                    check(n.parse().unwrap(), rule_of(name), r, row);
                }
            }
        }
        for row in published["EG_single_rows"].as_array().unwrap() {
            let name = row["rule"].as_str().unwrap();
            let index = |key: &str| row[key].as_u64().unwrap() as usize;
            check(index("n"), rule_of(name), index("r"), &row["weights"]);
        }
        assert_eq!(numbers, 384 + 12 * 25);
    }

    #[test]
    fn weights_are_those_of_the_prototype() {
        for n in EG_PUBLISHED_VALENCES {
            let golden = golden(&format!("n{n:02}.json"));
            let weights = eg_weights(n, false).unwrap();
            let published = eg_weights(n, true).unwrap();
            for (name, rows) in golden["EG"].as_object().unwrap() {
                let (h, k) = rule_of(name);
                for r in 0..n {
                    for node in 0..12 {
                        let expected = rows[r][node].as_f64().unwrap();
                        assert!((weights.row(h, k, r)[node] - expected).abs() < 1e-12);
                        assert!((published.row(h, k, r)[node] - expected).abs() < 1e-5);
                    }
                }
            }
        }
    }
}
