//! The rules of Evolving-Guide subdivision [KP23-EG, eq. 7].
//!
//! For the new nodes (h,k) = (1,1), (2,1), (1,2), (2,2), (3,1), (3,2) of sector s
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
//! exactly. The files leave out the rows that follow from this: all rows of rule 12, the rows
//! r > n/2 of rules 11 and 22, and the rows r > (n+1)/2 of rules 31 and 32.

use super::{
    EgTable, Mirror, NODES, RULES, completed, eg_n03, eg_n05, eg_n06, eg_n07, eg_n08, eg_n09,
    eg_n10, eg_n11, eg_n12, eg_n13, eg_n14, eg_n15, eg_n16, rule_index, table_index, weight,
};

/// The tables of [`VALENCES`](super::VALENCES).
static TABLES: [&EgTable; 13] = [
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

/// All weights of the Evolving-Guide rules of one valence, without the weights of c_0.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EgWeights {
    /// For each of 11 21 12 22 31 32, for each r = 0..n-1, the weights of the 12 nodes of sector
    /// s + r.
    weights: [Vec<[f64; NODES]>; 6],
}

/// The weights of one valence. They are the weights of the table, to 1 ulp; if `published`, they
/// are the nearest to what [KP23-EG] prints, truncated toward zero to 5 digits.
///
/// `None` if there is no table, or nothing printed.
pub(crate) fn eg_weights(valence: usize, published: bool) -> Option<EgWeights> {
    Some(TABLES[table_index(valence, published)?].weights(published))
}

impl EgWeights {
    /// The weights of the nodes 00 10 20 30 01 11 21 31 02 12 22 32 of sector s + `r` in the rule
    /// of the new node (h,k) of sector s.
    ///
    /// # Panics
    ///
    /// If (h,k) is not one of the six nodes with rules, or `r` is not below the valence.
    pub(crate) fn row(&self, h: usize, k: usize, r: usize) -> &[f64; NODES] {
        &self.weights[rule_index(h, k)][r]
    }
}

impl EgTable {
    /// All weights.
    pub(super) fn weights(&self, published: bool) -> EgWeights {
        let numerator = |rule, at| weight(self.numerator(rule, at), published);
        let row = |rule, r| std::array::from_fn(|node| numerator(rule, (r, node)));
        let rows = |rule| (0..self.valence as isize).map(|r| row(rule, r)).collect();
        EgWeights { weights: RULES.map(rows) }
    }

    /// The numerator of the weight of a node of sector s + r, listed or not.
    pub(super) fn numerator(&self, (h, k): (usize, usize), (r, node): (isize, usize)) -> i64 {
        let (mirror, image) = Mirror::of_rule((h, k));
        let rows = match (h, k) {
            (1, 1) => self.rule_11,
            (2, 1) => self.rule_21,
            (2, 2) => self.rule_22,
            (3, 1) => self.rule_31,
            (3, 2) => self.rule_32,
            _ => return self.numerator(image, mirror.image((r, node))),
        };
        completed(rows, self.valence, mirror, (r, node))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use crate::scheme::tables::{PUBLISHED_VALENCES, VALENCES, golden, truncated};

    fn table(valence: usize) -> &'static EgTable {
        TABLES[table_index(valence, false).unwrap()]
    }

    fn rule_of(name: &str) -> (usize, usize) {
        let number: usize = name.parse().unwrap();
        (number / 10, number % 10)
    }

    #[test]
    fn every_valence_has_its_own_table_and_no_more_rows_than_it_needs() {
        for n in VALENCES {
            let table = table(n);
            assert_eq!(table.valence, n);
            assert_eq!(table.rule_21.len(), n);
            assert_eq!((table.rule_11.len(), table.rule_22.len()), (n / 2 + 1, n / 2 + 1));
            let on_line = n.div_ceil(2) + 1;
            assert_eq!((table.rule_31.len(), table.rule_32.len()), (on_line, on_line));
        }
        assert!([0, 1, 2, 4, 17].iter().all(|&n| eg_weights(n, false).is_none()));
        assert!(eg_weights(10, true).is_some() && eg_weights(11, true).is_none());
    }

    #[test]
    fn mirror_images_are_equal_to_the_last_digit() {
        for n in VALENCES {
            for rule in RULES {
                let (mirror, image) = Mirror::of_rule(rule);
                for r in 0..n as isize {
                    for node in 0..NODES {
                        let own = table(n).numerator(rule, (r, node));
                        let mirrored = table(n).numerator(image, mirror.image((r, node)));
                        assert_eq!(own, mirrored, "n = {n}, {rule:?}, r = {r}, node {node}");
                    }
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
                let own = truncated(table(n).numerator(rule, (r as isize, node)));
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
        for n in PUBLISHED_VALENCES {
            let golden = golden(&format!("n{n:02}.json"));
            let weights = eg_weights(n, false).unwrap();
            let published = eg_weights(n, true).unwrap();
            for (name, rows) in golden["EG"].as_object().unwrap() {
                let (h, k) = rule_of(name);
                for (r, node) in (0..n).flat_map(|r| (0..NODES).map(move |node| (r, node))) {
                    let expected = rows[r][node].as_f64().unwrap();
                    assert!((weights.row(h, k, r)[node] - expected).abs() < 1e-12);
                    assert!((published.row(h, k, r)[node] - expected).abs() < 1e-5);
                }
            }
        }
    }
}
