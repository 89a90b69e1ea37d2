//! Evolving-Guide subdivision [KP23-EG].
//!
//! The state is the d-net relative to the limit point c_0. Of its next, half as large net the
//! nodes with i = 0 or j = 0 are regular bi-4 knot insertion (eq. 1); the six nodes nearest to
//! the centre in each sector follow the rules of Section 5, whose weights are in
//! [`tables`](super::tables). The weight of c_0 drops out, since c_0 is the origin here.

use super::rules::{PatchRule, Row, RowBuilder, Rules};
use super::tables::{self, EgWeights};
use crate::net::{CNet, DNET_NODES, DNet, dnet_node};
use crate::patch::basis::QUARTIC_B_SPLINE_TO_BB;

/// The rules of Evolving-Guide subdivision at valence `n`, if there are tables for it.
pub(crate) fn rules(n: usize, published: bool) -> Option<Rules> {
    let weights = tables::eg_weights(n, published)?;
    let refine = (0..DNET_NODES).map(|k| refined_node(n, k % 4, k / 4, &weights)).collect();
    // The least refined index of the three patches, in the order of PATCH_ORIGINS.
    let patches = [(-2, -2), (-2, 0), (0, -2)].map(|(i, j)| patch(n, i, j));
    Some(Rules { valence: n, nodes_per_sector: DNET_NODES, refine, degree: 4, patches })
}

/// The state of a c-net that is relative to its limit point.
pub(crate) fn state(cnet: &CNet) -> Vec<[f64; 3]> {
    state_of_dnet(&DNet::from_cnet(cnet))
}

/// The state of a d-net that is relative to its centre.
pub(crate) fn state_of_dnet(dnet: &DNet) -> Vec<[f64; 3]> {
    dnet.sectors.iter().flatten().copied().collect()
}

/// The row of the new node d_ij.
fn refined_node(n: usize, i: usize, j: usize, weights: &EgWeights) -> Row {
    if i == 0 || j == 0 {
        return regular_node(n, i as isize, j as isize).finish();
    }
    let mut row = RowBuilder::new(n, DNET_NODES);
    for r in 0..n {
        for (node, &w) in weights.row(i, j, r).iter().enumerate() {
            row.add(crate::net::NodeRef { turn: r as isize, node }, w);
        }
    }
    row.finish()
}

/// The new node (i,j), at least one index <= 0, by knot insertion from the old net [KP23-EG,
/// eq. 1].
fn regular_node(n: usize, i: isize, j: isize) -> RowBuilder {
    let mut row = RowBuilder::new(n, DNET_NODES);
    for (a, wa) in knot_insertion(i) {
        for (b, wb) in knot_insertion(j) {
            row.add(dnet_node(a, b), wa * wb);
        }
    }
    row
}

/// Univariate bi-4 knot insertion: new index -2 to 4 from old indices.
fn knot_insertion(i: isize) -> [(usize, f64); 3] {
    let (first, weights) = match i {
        -2 => (0, [9.0, 6.0, 1.0]),
        -1 => (0, [3.0, 10.0, 3.0]),
        0 => (0, [1.0, 6.0, 9.0]),
        1 => (1, [2.0, 12.0, 2.0]),
        2 => (2, [9.0, 6.0, 1.0]),
        3 => (2, [3.0, 10.0, 3.0]),
        4 => (2, [1.0, 6.0, 9.0]),
        _ => unreachable!("a ring has the refined indices -2 to 4, not {i}"),
    };
    std::array::from_fn(|k| (first + k, weights[k] / 16.0))
}

/// The bi-4 patch over the window of refined indices (i,j) to (i+4,j+4).
///
/// Indices grow towards the centre, patch parameters away from it, so coefficient (k,l) is the
/// (4-k,4-l)th of the window [KP23-EG, eq. 6].
fn patch(n: usize, i: isize, j: isize) -> PatchRule {
    let mut rule = PatchRule::default();
    for k in (0..5).rev() {
        for l in (0..5).rev() {
            let mut old = RowBuilder::new(n, DNET_NODES);
            let mut new = RowBuilder::new(n, DNET_NODES);
            for (di, wi) in QUARTIC_B_SPLINE_TO_BB[k].into_iter().enumerate() {
                for (dj, wj) in QUARTIC_B_SPLINE_TO_BB[l].into_iter().enumerate() {
                    let (a, b) = (i + di as isize, j + dj as isize);
                    if a <= 0 || b <= 0 {
                        old.add_row(&regular_node(n, a, b).finish(), wi * wj);
                    } else {
                        new.add(dnet_node(a as usize, b as usize), wi * wj);
                    }
                }
            }
            rule.old.push(old.finish());
            rule.new.push(new.finish());
        }
    }
    rule
}
