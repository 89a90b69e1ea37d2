//! The guides of Guided C2 subdivision [KP18-Guided].
//!
//! The guide's piece in sector s is bi-5 with the coefficients
//!
//! ```text
//!   p_ij^s = sum over r = 0..n-1 and the nodes (a,b) of weight_ij^(r,ab) d_ab^(s+r) + rest e
//! ```
//!
//! and p_00 = c_0. By the mirrors p_ji of a net is exactly p_ij of its image in the diagonal of the
//! sector, and p_i0 is p_i0 of its image in line s-1. The files leave out what follows from this.

use super::{
    GuidedTable, guided_n03, guided_n05, guided_n06, guided_n07, guided_n08, guided_n09,
    guided_n10, guided_n11, guided_n12, guided_n13, guided_n14, guided_n15, guided_n16,
    table_index,
};
use crate::net::{CNET_NODES, NodeRef, cnet_node};

/// The tables of [`VALENCES`](super::VALENCES).
static TABLES: [&GuidedTable; 13] = [
    &guided_n03::TABLE,
    &guided_n05::TABLE,
    &guided_n06::TABLE,
    &guided_n07::TABLE,
    &guided_n08::TABLE,
    &guided_n09::TABLE,
    &guided_n10::TABLE,
    &guided_n11::TABLE,
    &guided_n12::TABLE,
    &guided_n13::TABLE,
    &guided_n14::TABLE,
    &guided_n15::TABLE,
    &guided_n16::TABLE,
];

/// The coefficients (i,j) that tables list, in their order.
#[rustfmt::skip]
const LISTED: [(usize, usize); 20] = [
    (1, 0), (2, 0), (3, 0), (4, 0), (5, 0),
    (1, 1), (2, 1), (3, 1), (4, 1), (5, 1),
    (2, 2), (3, 2), (4, 2), (5, 2),
    (3, 3), (4, 3), (5, 3),
    (4, 4), (5, 4),
    (5, 5),
];

/// The guide of one valence on the nodes of a c-net.
#[derive(Clone, Copy)]
pub(crate) struct GuideWeights {
    table: &'static GuidedTable,
}

/// The guide of one valence; `None` if there is no table.
pub(crate) fn guide_weights(valence: usize) -> Option<GuideWeights> {
    table_index(valence, false).map(|index| GuideWeights { table: TABLES[index] })
}

impl GuideWeights {
    /// The numerators over 10^18 of the weights in coefficient p_ij of sector 0: six for each
    /// sector, one for each of its nodes, then the weight of e, which is one minus all others. For
    /// p_00, which is c_0, all are zero.
    pub(crate) fn coefficient(self, i: usize, j: usize) -> Vec<i64> {
        let n = self.table.valence;
        if (i, j) == (0, 0) {
            return vec![0; CNET_NODES * n + 1];
        }
        let weight = |at| self.table.weight((i, j), at);
        let mut weights: Vec<i64> = (0..CNET_NODES * n)
            .map(|at| NodeRef { turn: (at / CNET_NODES) as isize, node: at % CNET_NODES })
            .map(weight)
            .collect();
        weights.push(super::DENOMINATOR - weights.iter().sum::<i64>());
        weights
    }
}

impl GuidedTable {
    /// The numerator of a node's weight in p_ij, listed or not.
    fn weight(&self, (i, j): (usize, usize), at: NodeRef) -> i64 {
        if i < j {
            return self.weight((j, i), in_diagonal(at));
        }
        let listed = LISTED.iter().position(|&coef| coef == (i, j)).expect("p_00 is not asked for");
        let rows = self.coefs[listed];
        let first = if j == 0 { 1 } else { 0 };
        let row = |at: NodeRef| {
            let r = (at.turn + first).rem_euclid(self.valence as isize) as usize;
            rows.get(r).map(|row| row[at.node])
        };
        let image = if j == 0 { in_line(at) } else { in_diagonal(at) };
        row(at).or_else(|| row(image)).expect("a node or its image is listed")
    }
}

/// The image in the diagonal of sector 0: (a,b) of sector r becomes (b,a) of sector -r.
fn in_diagonal(at: NodeRef) -> NodeRef {
    let (a, b) = (at.node as isize / 2, at.node as isize % 2 + 1);
    let image = cnet_node(b, a).expect("the image of e alone is e");
    NodeRef { turn: image.turn - at.turn, ..image }
}

/// The image in line -1, the first of sector 0.
fn in_line(at: NodeRef) -> NodeRef {
    in_diagonal(NodeRef { turn: at.turn + 1, ..at })
}

#[cfg(test)]
mod tests {
    use super::super::{DENOMINATOR, VALENCES};
    use super::*;

    #[test]
    fn mirrors_are_their_own_inverses() {
        for (turn, node) in (-3..4).flat_map(|turn| (0..CNET_NODES).map(move |k| (turn, k))) {
            let at = NodeRef { turn, node };
            assert_eq!(in_diagonal(in_diagonal(at)), at);
            assert_eq!(in_line(in_line(at)), at);
        }
    }

    #[test]
    fn guides_have_the_symmetries_of_the_net() {
        for n in VALENCES {
            let table = guide_weights(n).unwrap().table;
            let nodes = (0..n as isize)
                .flat_map(|turn| (0..CNET_NODES).map(move |node| NodeRef { turn, node }));
            for at in nodes {
                for (i, j) in LISTED {
                    let weight = table.weight((i, j), at);
                    assert_eq!(weight, table.weight((j, i), in_diagonal(at)), "n = {n}");
                    if j == 0 {
                        assert_eq!(weight, table.weight((i, 0), in_line(at)), "n = {n}");
                        // The piece of the sector before has the same line.
                        let before = NodeRef { turn: at.turn + 1, ..at };
                        assert_eq!(weight, table.weight((0, i), before), "n = {n}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_map_of_the_cap_is_the_identity_at_the_ends_of_the_lines() {
        for n in VALENCES {
            let map = guide_weights(n).unwrap().table.cap_map;
            // Along the second line the first coordinate is zero.
            assert!(map[0].iter().all(|x| x.abs() <= 1), "n = {n}");
            assert!((map[6][0] - DENOMINATOR).abs() <= 1, "n = {n}");
        }
    }
}
