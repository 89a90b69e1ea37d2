//! Evolving-Guide subdivision [KP23-EG].
//!
//! The net is the d-net relative to the limit point c_0. The next net is half as large. Its
//! nodes with i = 0 or j = 0 follow by regular bi-4 knot insertion (eq. 1). The six nodes nearest
//! to the centre in each sector follow the rules of Section 5, whose weights are in
//! [`tables`](super::tables). The weight of c_0 drops out, since c_0 is the origin here.

use super::rules::{Row, RowBuilder, Rules, Symmetry};
use super::tables::{self, EgWeights};
use crate::net::{DNET_NODES, NodeRef, Spline};

/// The rules of Evolving-Guide subdivision at valence `n`, if there are tables for it.
pub(crate) fn rules(n: usize, published: bool) -> Option<Rules> {
    Some(rules_of(n, &tables::eg_weights(n, published)?))
}

/// The rules of fair4d at valence `n`, if there are tables for it: the same layout.
pub(crate) fn fair_rules(n: usize) -> Option<Rules> {
    Some(rules_of(n, &tables::fair_evolving_weights(n)?))
}

fn rules_of(n: usize, weights: &EgWeights) -> Rules {
    let empty = RowBuilder::new(n, DNET_NODES);
    let node = |k: usize| refined_node(&empty, k % 4, k / 4, weights);
    Rules {
        valence: n,
        symmetry: Symmetry::Turning,
        nodes_per_sector: DNET_NODES,
        refine: (0..DNET_NODES).map(node).collect(),
        degree: Spline::BiQuartic.degree(),
        split: Spline::BiQuartic.split(),
        patches: Spline::BiQuartic.patches(&empty),
        quadratic: None,
        guide: None,
    }
}

/// The row of the new node d_ij.
fn refined_node(empty: &RowBuilder, i: usize, j: usize, weights: &EgWeights) -> Row {
    let mut row = empty.clone();
    if i == 0 || j == 0 {
        return Spline::BiQuartic.regular_node(row, i as isize, j as isize);
    }
    for r in 0..empty.valence() {
        for (node, &w) in weights.row(i, j, r).iter().enumerate() {
            row.add(NodeRef { turn: r as isize, node }, w);
        }
    }
    row.finish()
}
