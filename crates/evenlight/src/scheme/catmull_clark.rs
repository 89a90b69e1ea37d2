//! Catmull-Clark subdivision as a scheme of rings [CC78], [Stam98].
//!
//! The net is the c-net relative to the limit point. The extraordinary vertex e itself is no
//! part of it: as the limit point is the origin, n^2 e + 4 sum c_6 + sum c_5 = 0, and e
//! follows. (This also takes the eigenvalue 1 out of the matrix, so that rounding cannot bring it
//! back.) One refinement gives the nodes (a,b), a,b <= 3. They hold the next c-net, half as large,
//! and three bi-3 patches per sector.

use super::rules::{PatchRule, Row, RowBuilder, Rules, Symmetry};
use crate::net::{CNET_NODES, NodeRef, cnet_node};
use crate::patch::basis::CUBIC_B_SPLINE_TO_BB;

/// The rules of Catmull-Clark subdivision at valence `n`.
pub(crate) fn rules(n: usize) -> Rules {
    let refine =
        (0..CNET_NODES).map(|k| refined_node(n, k as isize / 2, k as isize % 2 + 1)).collect();
    // The corners of the three squares on the refined grid, in the order of `Rules`.
    let patches = [(1, 1), (1, 0), (0, 1)].map(|(a, b)| patch(n, a, b)).into();
    Rules {
        valence: n,
        symmetry: Symmetry::Turning,
        nodes_per_sector: CNET_NODES,
        refine,
        degree: 3,
        split: 1,
        patches,
        quadratic: None,
        guide: None,
    }
}

/// e as a function of the other nodes.
fn center_row(n: usize) -> Row {
    let mut row = RowBuilder::new(n, CNET_NODES);
    let n2 = (n * n) as f64;
    for s in 0..n as isize {
        row.add(NodeRef { turn: s, node: 0 }, -4.0 / n2);
        row.add(NodeRef { turn: s, node: 2 }, -1.0 / n2);
    }
    row.finish()
}

/// The node (a,b), -1 <= a,b <= 3, of the refined grid as a row on the old c-net.
fn refined_node(n: usize, a: isize, b: isize) -> Row {
    match (a, b) {
        (0, 0) => refined_center(n),
        (a, b) if a < 0 => turned(n, &refined_node(n, b, -a), 1),
        (a, b) if b < 0 => turned(n, &refined_node(n, -b, a), -1),
        (a, 0) => turned(n, &refined_node(n, 0, a), -1),
        (a, b) => inner_node(n, a, b),
    }
}

/// The refined node (a,b) with a >= 0 and b > 0.
fn inner_node(n: usize, a: isize, b: isize) -> Row {
    let center = center_row(n);
    let mut row = RowBuilder::new(n, CNET_NODES);
    for (x, wx) in knot_insertion(a) {
        for (y, wy) in knot_insertion(b) {
            match cnet_node(x, y) {
                Some(at) => row.add(at, wx * wy),
                None => row.add_row(&center, wx * wy),
            }
        }
    }
    row.finish()
}

/// The refined e. The vertex rule keeps the limit point, so the new e follows from the new
/// nodes as the old one from the old nodes.
fn refined_center(n: usize) -> Row {
    let neighbours = [refined_node(n, 0, 1), refined_node(n, 1, 1)];
    let mut row = RowBuilder::new(n, CNET_NODES);
    for (node, w) in center_row(n) {
        let (s, kind) = (node / CNET_NODES, node % CNET_NODES / 2);
        row.add_row(&turned(n, &neighbours[kind], s as isize), w);
    }
    row.finish()
}

/// The row `s` sectors further on.
fn turned(n: usize, row: &Row, s: isize) -> Row {
    let turn = |node: usize| {
        let r = (node / CNET_NODES) as isize + s;
        r.rem_euclid(n as isize) as usize * CNET_NODES + node % CNET_NODES
    };
    row.iter().map(|&(node, w)| (turn(node), w)).collect()
}

/// Uniform cubic knot insertion: the new node `k` from old nodes.
fn knot_insertion(k: isize) -> Vec<(isize, f64)> {
    let p = k.div_euclid(2);
    if k % 2 == 0 {
        vec![(p - 1, 0.125), (p, 0.75), (p + 1, 0.125)]
    } else {
        vec![(p, 0.5), (p + 1, 0.5)]
    }
}

/// The bi-3 patch over the refined square (a,b) to (a+1,b+1).
fn patch(n: usize, a: isize, b: isize) -> PatchRule {
    let nodes: Vec<Row> = (0..16).map(|k| refined_node(n, a - 1 + k / 4, b - 1 + k % 4)).collect();
    let coef = |k: usize| {
        let mut row = RowBuilder::new(n, CNET_NODES);
        for (m, node) in nodes.iter().enumerate() {
            let w = CUBIC_B_SPLINE_TO_BB[k / 4][m / 4] * CUBIC_B_SPLINE_TO_BB[k % 4][m % 4];
            row.add_row(node, w);
        }
        row.finish()
    };
    PatchRule { old: (0..16).map(coef).collect(), new: vec![Row::new(); 16] }
}
