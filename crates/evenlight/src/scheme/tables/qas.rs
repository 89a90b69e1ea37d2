//! The rules of Quadratic-Attraction subdivision [KP23-QAS, eq. 6, 7 and S2].
//!
//! The new nodes (h,k) = (1,1), (2,1), (1,2), (2,2) of sector s are combinations of the nodes of
//! the sector's L-net and of the sector's quadratic q,
//!
//! ```text
//!   d_hk^s = p + sum over r = -1..1 and the 12 nodes (i,j) of kappa_ij^(r,hk) (d_ij^(s+r) - p)
//!              + sum over m = 2..6 of tau_m^hk (q_m^s - p);
//! ```
//!
//! those on line s, (3,1) and (3,2), take one half from each side,
//!
//! ```text
//!   d_3k^s = p + sum over r = -1..2 and the 12 nodes (i,j) of kappa_ij^(r,3k) (d_ij^(s+r) - p)
//!              + 1/2 sum over m = 2..6 of tau_m^3k (q_m^s + q_m'^(s+1) - 2p),
//! ```
//!
//! m' = 4, 6, 2, 5, 3 being the mirror images of m = 2..6. The first q comes from the first net,
//!
//! ```text
//!   q_m^s = p + sum over r = 0..n-1 and the 12 nodes (i,j) of mu_ij^(m,r) (d_ij^(s+r) - p)
//! ```
//!
//! for m = 4, 5, from which the other coefficients follow. Mirror symmetry in lines and diagonals
//! makes, with h, k, i, j below 3 and r, where it belongs to mu, modulo n,
//!
//! ```text
//!   kappa_ij^(r,hk) = kappa_ji^(-r,kh)      kappa_3j^(r,hk) = kappa_3j^(-r-1,kh)
//!   kappa_ij^(r,3k) = kappa_ji^(1-r,3k)     kappa_3j^(r,3k) = kappa_3j^(-r,3k)
//!   mu_ij^(4,r) = mu_ji^(4,1-r)             mu_3j^(4,r) = mu_3j^(4,-r)
//!   mu_ij^(5,r) = mu_ji^(5,-r)              mu_3j^(5,r) = mu_3j^(5,-r-1)
//!   tau_m^hk = tau_m'^kh
//! ```
//!
//! exactly. The files leave out what follows from this.

use super::{
    Mirror, NODES, QasTable, RULES, completed, qas_n03, qas_n05, qas_n06, qas_n07, qas_n08,
    qas_n09, qas_n10, qas_n11, qas_n12, qas_n13, qas_n14, qas_n15, qas_n16, rule_index,
    table_index, weight,
};

/// The tables of [`VALENCES`](super::VALENCES).
static TABLES: [&QasTable; 13] = [
    &qas_n03::TABLE,
    &qas_n05::TABLE,
    &qas_n06::TABLE,
    &qas_n07::TABLE,
    &qas_n08::TABLE,
    &qas_n09::TABLE,
    &qas_n10::TABLE,
    &qas_n11::TABLE,
    &qas_n12::TABLE,
    &qas_n13::TABLE,
    &qas_n14::TABLE,
    &qas_n15::TABLE,
    &qas_n16::TABLE,
];

/// For q_2..q_6, counted from 0, the images in the mirror that exchanges the lines of the sector.
const Q_MIRRORED: [usize; 5] = [2, 4, 0, 3, 1];

/// All weights of the Quadratic-Attraction rules of one valence, without the weights of p.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct QasWeights {
    /// For each of 11 21 12 22 31 32 the weights of the 12 nodes of sectors s + r, with r.
    kappa: [Vec<(isize, [f64; NODES])>; 6],
    /// For each of 11 21 12 22 31 32 the weights of q_2..q_6.
    tau: [[f64; 5]; 6],
    /// For q_4 and q_5, for each r = 0..n-1, the weights of the 12 nodes of sector s + r.
    mu: [Vec<[f64; NODES]>; 2],
}

/// The weights of one valence. They are the weights of the table, to 1 ulp; if `published`, they
/// are the nearest to what [KP23-QAS] prints, truncated toward zero to 5 digits.
///
/// `None` if there is no table, or nothing printed.
pub(crate) fn qas_weights(valence: usize, published: bool) -> Option<QasWeights> {
    Some(TABLES[table_index(valence, published)?].weights(published))
}

/// The turns r of the sectors s + r that a rule reaches.
fn turns((h, _): (usize, usize)) -> std::ops::RangeInclusive<isize> {
    if h == 3 { -1..=2 } else { -1..=1 }
}

impl QasWeights {
    /// The weights kappa of the nodes 00 10 20 30 01 11 21 31 02 12 22 32 of the sectors s + r in
    /// the rule of the new node (h,k) of sector s, with r = -1..=1; for (3,k), r = -1..=2. At
    /// valence 3 the sectors s-1 and s+2 are the same, and their weights add up.
    ///
    /// # Panics
    ///
    /// If (h,k) is not one of the six nodes with rules.
    pub(crate) fn kappa(&self, h: usize, k: usize) -> &[(isize, [f64; NODES])] {
        &self.kappa[rule_index(h, k)]
    }

    /// The weights tau_2..tau_6 in the rule of the new node (h,k) of sector s.
    ///
    /// For h < 3 they are the weights of q_2..q_6 of sector s. For (3,k) one half of each counts
    /// for q_m of sector s, and one half for the mirror image in sector s+1: tau_2 for q_4, tau_3
    /// for q_6, tau_4 for q_2, tau_5 for q_5, tau_6 for q_3 (eq. 7).
    ///
    /// # Panics
    ///
    /// If (h,k) is not one of the six nodes with rules.
    pub(crate) fn tau(&self, h: usize, k: usize) -> [f64; 5] {
        self.tau[rule_index(h, k)]
    }

    /// The weights mu, for each r = 0..n-1, of the nodes 00 10 20 30 01 11 21 31 02 12 22 32 of
    /// sector s + r in q_m of sector s.
    ///
    /// # Panics
    ///
    /// If `m` is not 4 or 5.
    pub(crate) fn mu(&self, m: usize) -> &[[f64; NODES]] {
        assert!(m == 4 || m == 5, "the other coefficients follow from q_4 and q_5");
        &self.mu[m - 4]
    }
}

impl QasTable {
    /// All weights.
    pub(super) fn weights(&self, published: bool) -> QasWeights {
        let weight = |numerator| weight(numerator, published);
        QasWeights {
            kappa: RULES.map(|rule| {
                let row = |r| std::array::from_fn(|node| weight(self.kappa(rule, (r, node))));
                turns(rule).map(|r| (r, row(r))).collect()
            }),
            tau: RULES.map(|rule| self.tau(rule).map(weight)),
            mu: [4, 5].map(|m| {
                let row = |r| std::array::from_fn(|node| weight(self.mu(m, (r, node))));
                (0..self.valence as isize).map(row).collect()
            }),
        }
    }

    /// The numerator of the weight kappa of a node of sector s + r, listed or not; zero out of the
    /// rule's reach.
    pub(super) fn kappa(&self, (h, k): (usize, usize), (r, node): (isize, usize)) -> i64 {
        let (mirror, image) = Mirror::of_rule((h, k));
        let listed = match (h, k) {
            (1, 1) => self.kappa_11,
            (2, 1) => self.kappa_21,
            (2, 2) => self.kappa_22,
            (3, 1) => self.kappa_31,
            (3, 2) => self.kappa_32,
            _ => return self.kappa(image, mirror.image((r, node))),
        };
        let weight = |at| listed.get(slot(at)?);
        let own = weight((r, node));
        let or_image = || weight(mirror.image((r, node))).filter(|_| image == (h, k));
        own.or_else(or_image).copied().unwrap_or(0)
    }

    /// The numerators of tau_2..tau_6.
    pub(super) fn tau(&self, (h, k): (usize, usize)) -> [i64; 5] {
        match (h, k) {
            (1, 1) => self.tau_11,
            (2, 1) => self.tau_21,
            (2, 2) => self.tau_22,
            (3, 1) => self.tau_31,
            (3, 2) => self.tau_32,
            _ => Q_MIRRORED.map(|m| self.tau((k, h))[m]),
        }
    }

    /// The numerator of the weight mu of a node of sector s + r, listed or not, in q_4 or q_5.
    pub(super) fn mu(&self, m: usize, node: (isize, usize)) -> i64 {
        let (rows, mirror) = match m {
            4 => (self.mu_4, Mirror::Line),
            _ => (self.mu_5, Mirror::Diagonal),
        };
        completed(rows, self.valence, mirror, node)
    }
}

/// The place of a node of sector s + r in a list of [`QasTable`], if it has one.
fn slot((r, node): (isize, usize)) -> Option<usize> {
    let (i, j) = (node % 4, node / 4);
    match (r, i, j) {
        (0, _, _) => Some(node),
        (-1, 3, _) => Some(12 + j),
        (-1, 2, _) => Some(15 + j),
        (1, 0..=2, 2) => Some(18 + i),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use serde_json::Value;

    use super::*;
    use crate::scheme::tables::{PUBLISHED_VALENCES, VALENCES, golden, truncated};

    fn table(valence: usize) -> &'static QasTable {
        TABLES[table_index(valence, false).unwrap()]
    }

    /// Every node within reach of some rule.
    fn nodes() -> impl Iterator<Item = (isize, usize)> {
        (-1..=2).flat_map(|r| (0..NODES).map(move |node| (r, node)))
    }

    #[test]
    fn every_valence_has_its_own_table_and_no_more_rows_than_it_needs() {
        for n in VALENCES {
            let table = table(n);
            assert_eq!(table.valence, n);
            let on_line_or_diagonal =
                [table.kappa_11, table.kappa_22, table.kappa_31, table.kappa_32];
            assert!(on_line_or_diagonal.iter().all(|list| list.len() == 18));
            assert_eq!(table.kappa_21.len(), 21);
            assert_eq!((table.mu_4.len(), table.mu_5.len()), (n.div_ceil(2) + 1, n / 2 + 1));
        }
        assert!([0, 1, 2, 4, 17].iter().all(|&n| qas_weights(n, false).is_none()));
        assert!(qas_weights(10, true).is_some() && qas_weights(11, true).is_none());
    }

    #[test]
    fn mirror_images_are_equal_to_the_last_digit() {
        for table in TABLES {
            for rule in RULES {
                let (mirror, image) = Mirror::of_rule(rule);
                for node in nodes() {
                    let mirrored = table.kappa(image, mirror.image(node));
                    assert_eq!(table.kappa(rule, node), mirrored, "{rule:?}, {node:?}");
                }
                if mirror == Mirror::Diagonal {
                    assert_eq!(table.tau(rule), Q_MIRRORED.map(|m| table.tau(image)[m]));
                }
            }
            for (m, mirror) in [(4, Mirror::Line), (5, Mirror::Diagonal)] {
                for node in
                    (0..table.valence as isize).flat_map(|r| (0..NODES).map(move |k| (r, k)))
                {
                    assert_eq!(table.mu(m, node), table.mu(m, mirror.image(node)), "q_{m}");
                }
            }
        }
    }

    #[test]
    fn rules_reach_no_further_than_they_say() {
        for table in TABLES {
            for rule in RULES {
                let far = nodes().filter(|(r, _)| !turns(rule).contains(r));
                assert!(far.into_iter().all(|node| table.kappa(rule, node) == 0));
            }
        }
    }

    /// Compares a row of printed numbers, `null` where they are garbled; the number of the others.
    fn assert_printed(printed: &Value, own: impl Fn(usize) -> i64, what: &str) -> usize {
        let row = printed.as_array().unwrap().iter().enumerate();
        let legible: Vec<_> = row.filter_map(|(k, number)| Some((k, number.as_i64()?))).collect();
        for &(node, number) in &legible {
            assert_eq!(truncated(own(node)), number, "{what}, node {node}");
        }
        legible.len()
    }

    #[test]
    fn truncated_tables_are_the_printed_ones() {
        let published = &golden("published.json")["QAS"];
        let mut numbers = 0;
        for (key, rows) in published.as_object().unwrap() {
            for (r, row) in rows.as_object().into_iter().flatten() {
                let r: isize = r.parse().unwrap();
                let what = format!("{key}, row {r}");
                numbers += match key.as_str() {
                    "K_11^3" => assert_printed(row, |k| table(3).kappa((1, 1), (r, k)), &what),
                    "K_32^3" => assert_printed(row, |k| table(3).kappa((3, 2), (r, k)), &what),
                    "Q_3^4" => assert_printed(row, |k| table(3).mu(4, (r, k)), &what),
                    "Q_9^4" => assert_printed(row, |k| table(9).mu(4, (r, k)), &what),
                    "Q_10^5" => assert_printed(row, |k| table(10).mu(5, (r, k)), &what),
                    _ => panic!("a table that no test compares: {key}"),
                };
            }
        }
        assert_eq!(numbers, 3 * 12 + 12 + (12 + 8) + 3 * 12 + 10);
    }

    /// Compares full and printed weights with the prototype's, which are good to 2e-14.
    fn assert_near_golden(numerator: i64, golden: &Value, what: &str) {
        let golden = golden.as_f64().unwrap();
        assert!((weight(numerator, false) - golden).abs() < 1e-12, "{what}");
        assert_eq!(truncated(numerator), (golden * 1e5).trunc() as i64, "{what}, truncated");
    }

    #[test]
    fn weights_are_those_of_the_prototype() {
        for n in PUBLISHED_VALENCES {
            let (table, golden) = (table(n), golden(&format!("n{n:02}.json")));
            for (h, k) in RULES {
                let (name, what) = (format!("{h}{k}"), format!("n = {n}, rule {h}{k}"));
                for (r, node) in nodes() {
                    let golden = &golden["QAS_K"][&name][r.to_string()][node];
                    assert_near_golden(table.kappa((h, k), (r, node)), golden, &what);
                }
                for (m, numerator) in table.tau((h, k)).into_iter().enumerate() {
                    assert_near_golden(numerator, &golden["QAS_T"][&name][m], &what);
                }
            }
            for m in [4, 5] {
                let golden = &golden["QAS_q_from_d_F5"][format!("q{m}")];
                for (r, node) in (0..n).flat_map(|r| (0..NODES).map(move |node| (r, node))) {
                    let numerator = table.mu(m, (r as isize, node));
                    assert_near_golden(numerator, &golden[r][node], &format!("n = {n}, q_{m}"));
                }
            }
        }
    }

    #[test]
    fn weights_are_the_tables_full_or_truncated() {
        for n in PUBLISHED_VALENCES {
            for published in [false, true] {
                let weights = qas_weights(n, published).unwrap();
                let expect = |numerator| weight(numerator, published);
                for (h, k) in RULES {
                    let kappa = weights.kappa(h, k);
                    assert!(kappa.iter().map(|&(r, _)| r).eq(turns((h, k))));
                    for (r, row) in kappa {
                        let own = |node| expect(table(n).kappa((h, k), (*r, node)));
                        assert_eq!(*row, std::array::from_fn(own));
                    }
                    assert_eq!(weights.tau(h, k), table(n).tau((h, k)).map(expect));
                }
                for m in [4, 5] {
                    for (r, row) in weights.mu(m).iter().enumerate() {
                        let own = |node| expect(table(n).mu(m, (r as isize, node)));
                        assert_eq!(*row, std::array::from_fn(own));
                    }
                }
            }
        }
    }

    /// A combination of the 12n nodes, row by row: n rows.
    type OnNet = Vec<[f64; NODES]>;

    /// Adds `factor` times a combination that belongs to the sector `turn` sectors on.
    fn add(sum: &mut OnNet, turn: isize, terms: &OnNet, factor: f64) {
        let n = sum.len() as isize;
        for (r, row) in terms.iter().enumerate() {
            let target = &mut sum[(r as isize + turn).rem_euclid(n) as usize];
            target.iter_mut().zip(row).for_each(|(sum, term)| *sum += factor * term);
        }
    }

    /// q_2..q_6 of sector 0 by S2, exact at full precision.
    fn quadratic(n: usize, weights: &QasWeights) -> [OnNet; 5] {
        let c = (TAU / n as f64).cos();
        let zero = || vec![[0.0; NODES]; n];
        let combined = |terms: &[(isize, &OnNet, f64)]| {
            let mut sum = zero();
            terms.iter().for_each(|&(turn, term, factor)| add(&mut sum, turn, term, factor));
            sum
        };
        let (q4, q5) = (weights.mu(4).to_vec(), weights.mu(5).to_vec());
        let half = 0.5 / c;
        let q6 = combined(&[(0, &q5, half), (1, &q5, half), (0, &q4, (c - 1.0) / c)]);
        let (q2, q3) = (combined(&[(-1, &q4, 1.0)]), combined(&[(-1, &q6, 1.0)]));
        [q2, q3, q4, q5, q6]
    }

    #[test]
    fn with_the_first_quadratic_put_in_they_are_the_rules_of_pas4() {
        for n in PUBLISHED_VALENCES {
            let golden = &golden(&format!("n{n:02}.json"))["EG_F5"];
            let weights = qas_weights(n, false).unwrap();
            let q = quadratic(n, &weights);
            for (h, k) in RULES {
                let mut rule = vec![[0.0; NODES]; n];
                for &(r, row) in weights.kappa(h, k) {
                    add(&mut rule, r, &vec![row], 1.0);
                }
                for (m, tau) in weights.tau(h, k).into_iter().enumerate() {
                    if h < 3 {
                        add(&mut rule, 0, &q[m], tau);
                    } else {
                        add(&mut rule, 0, &q[m], 0.5 * tau);
                        add(&mut rule, 1, &q[Q_MIRRORED[m]], 0.5 * tau);
                    }
                }
                let golden = &golden[format!("{h}{k}")];
                for (r, node) in (0..n).flat_map(|r| (0..NODES).map(move |node| (r, node))) {
                    let error = rule[r][node] - golden[r][node].as_f64().unwrap();
                    assert!(error.abs() < 1e-12, "n = {n}, rule {h}{k}, {r}, {node}: {error:e}");
                }
            }
        }
    }
}
