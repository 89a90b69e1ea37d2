//! Rows that go back through the refinements of a fan of many faces.
//!
//! ```text
//!   x_0 --A--> x_1 --A--> x_2 ...      coefficient = o x_l + n x_(l+1),  x_0 = nodes - limit point
//!   v_0 <--A^T-- v_1 <--A^T-- v_2      v_l = o + A^T n,   v_0 = (A^T / lambda)^l v_l
//! ```

use crate::rings::ValenceRules;
use crate::scheme::{FanLimit, Row};

/// The weights of all nodes of the net of a fan in the coefficients of a patch, relative to the
/// limit point and scaled as its ring. The first net of the rules must be the nodes.
pub(super) fn patch(
    valence_rules: &ValenceRules,
    ring: usize,
    sector: usize,
    which: usize,
) -> Vec<f64> {
    let (rules, lambda) = (valence_rules.rules(), valence_rules.subdominant().lambda);
    let limit = valence_rules.fan_limit().map(limit).unwrap_or_default();
    let rule = &rules.patches[sector * rules.patches_per_sector() + which];
    let mut weights = Vec::new();
    for (old, new) in rule.old.iter().zip(&rule.new) {
        let mut row = step_back(&rules.refine, &dense(new, rules.num_nodes()));
        old.iter().for_each(|&(k, w)| row[k] += w);
        for _ in 0..ring {
            row = step_back(&rules.refine, &row);
            row.iter_mut().for_each(|w| *w /= lambda);
        }
        // Less the limit point; the vertex itself is no node of the rules.
        let sum: f64 = row.iter().sum();
        row.push(0.0);
        weights.extend(row.iter().zip(&limit).map(|(w, of_limit)| w - sum * of_limit));
    }
    weights
}

/// The weights of all nodes of the net of a fan in its limit point.
pub(super) fn limit(limit: &FanLimit) -> Vec<f64> {
    dense(limit.point(), limit.num_nodes())
}

fn dense(row: &Row, count: usize) -> Vec<f64> {
    let mut weights = vec![0.0; count];
    row.iter().for_each(|&(k, w)| weights[k] += w);
    weights
}

/// The weights of a net from those of its refinement.
fn step_back(refine: &[Row], row: &[f64]) -> Vec<f64> {
    let mut before = vec![0.0; row.len()];
    for (of_node, x) in refine.iter().zip(row).filter(|&(_, &x)| x != 0.0) {
        of_node.iter().for_each(|&(k, w)| before[k] += x * w);
    }
    before
}
