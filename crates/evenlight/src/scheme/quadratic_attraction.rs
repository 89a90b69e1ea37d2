//! Quadratic-Attraction subdivision QAS4, QAS3 and its point-augmented relatives PAS4, PAS3
//! [KP23-QAS].
//!
//! **QAS4** refines a d-net together with a quadratic q at the centre. Nodes with i = 0 or j = 0
//! are regular; the six others per sector have weights kappa on the sector's L-net and tau on
//! its q_2..q_6 (eq. 6; on a line the mean of both sides, eq. 7). q itself is only scaled
//! down by lambda (eq. 2): its linear terms by lambda, its quadratic terms by lambda^2. As the rest
//! dies faster than lambda^2, the surface tends to q, and curvature stays bounded.
//!
//! **QAS3** is the same in another basis: T takes the d-net of a bi-4 spline to that of a bi-3
//! spline on the half-step grid with the same border, so a step is T (QAS4) T^-1, its regular
//! nodes by bi-3 knot insertion (Section 6).
//!
//! **PAS4, PAS3** put the default q of the current net in place of q in every step (Section 7).
//!
//! All coordinates are relative to p, whose weights drop out. q is kept as its expansion alpha,
//! beta, gamma, delta, epsilon in each sector's coordinates (see [`Quadratic`]).
//!
//! [`Quadratic`]: crate::net::Quadratic

use super::rules::{QuadraticPart, Row, RowBuilder, Rules, Symmetry};
use super::tables::{self, QasWeights};
use crate::angle::sector_cosine;
use crate::net::{DNET_NODES, NodeRef, Spline, dnet_node};

/// The number of nodes of q in each sector.
const Q_NODES: usize = 5;

/// The nodes of a sector of a net with q.
const NODES: usize = DNET_NODES + Q_NODES;

/// The new nodes d_hk with special rules.
const SPECIAL: [(usize, usize); 6] = [(1, 1), (2, 1), (1, 2), (2, 2), (3, 1), (3, 2)];

/// The rules with a quadratic at valence `n`, if there are tables: QAS4 for bi-4 splines, QAS3 for
/// bi-3.
pub(crate) fn rules(n: usize, spline: Spline, published: bool) -> Option<Rules> {
    let weights = tables::qas_weights(n, published)?;
    Some(composed(n, spline, Bases::new(n, spline), &weights))
}

/// The rules with a quadratic whose weights are those of the scheme's own spline: fair4 for bi-4,
/// fair3 for bi-3.
pub(crate) fn fair_rules(n: usize, spline: Spline) -> Option<Rules> {
    let weights = tables::fair_weights(n, spline)?;
    Some(composed(n, spline, Bases::new(n, Spline::BiQuartic), &weights))
}

/// The rules with a quadratic, from weights on the nets to which `bases` lead.
fn composed(n: usize, spline: Spline, bases: Bases, weights: &QasWeights) -> Rules {
    let empty = RowBuilder::new(n, NODES);
    let step = quartic_step(n, weights);
    let mut refine: Vec<Row> = (0..DNET_NODES)
        .map(|k| match is_special(k) {
            true => bases.refined_node(&empty, &step, k),
            false => spline.regular_node(empty.clone(), k as isize % 4, k as isize / 4),
        })
        .collect();
    let lambda = contraction(n);
    let own = |k: usize, w: f64| vec![(DNET_NODES + k, w)];
    refine.extend([0, 1].map(|k| own(k, lambda)));
    refine.extend([2, 3, 4].map(|k| own(k, lambda * lambda)));
    let from_net = default_quadratic(n, weights).map(|row| bases.in_own_basis(&row));
    Rules {
        valence: n,
        symmetry: Symmetry::Turning,
        nodes_per_sector: NODES,
        refine,
        degree: spline.degree(),
        split: spline.split(),
        patches: spline.patches(&empty),
        quadratic: Some(QuadraticPart { from_net, lambda }),
        guide: None,
    }
}

/// The rules with the default quadratic of every net put in: PAS4 for bi-4 splines, PAS3 for bi-3.
pub(crate) fn point_augmented_rules(n: usize, spline: Spline, published: bool) -> Option<Rules> {
    let with_q = rules(n, spline, published)?;
    let q = &with_q.quadratic.as_ref().expect("these rules have a quadratic").from_net;
    let empty = RowBuilder::new(n, DNET_NODES);
    let substituted = |row: &Row| {
        let mut sum = empty.clone();
        for &(at, w) in row {
            let (turn, node) = ((at / NODES) as isize, at % NODES);
            match node.checked_sub(DNET_NODES) {
                Some(k) => sum.add_turned(&q[k], DNET_NODES, turn, w),
                None => sum.add(NodeRef { turn, node }, w),
            }
        }
        sum.finish()
    };
    Some(Rules {
        valence: n,
        symmetry: Symmetry::Turning,
        nodes_per_sector: DNET_NODES,
        refine: with_q.refine[..DNET_NODES].iter().map(substituted).collect(),
        degree: spline.degree(),
        split: spline.split(),
        patches: spline.patches(&empty),
        quadratic: None,
        guide: None,
    })
}

fn is_special(node: usize) -> bool {
    SPECIAL.contains(&(node % 4, node / 4))
}

/// lambda = (c + 5 + sqrt((c + 1) (c + 9))) / 16, Catmull-Clark's subdominant eigenvalue.
pub(super) fn contraction(n: usize) -> f64 {
    let c = sector_cosine(n);
    (c + 5.0 + ((c + 1.0) * (c + 9.0)).sqrt()) / 16.0
}

/// The new d-net of one QAS4 step, on the bi-4 d-net and q.
fn quartic_step(n: usize, weights: &QasWeights) -> Vec<Row> {
    let empty = RowBuilder::new(n, NODES);
    let node = |k: usize| {
        let (i, j) = (k % 4, k / 4);
        if is_special(k) {
            special_node(empty.clone(), i, j, weights)
        } else {
            Spline::BiQuartic.regular_node(empty.clone(), i as isize, j as isize)
        }
    };
    (0..DNET_NODES).map(node).collect()
}

/// The new node d_hk by eq. (6), (7).
fn special_node(mut row: RowBuilder, h: usize, k: usize, weights: &QasWeights) -> Row {
    for &(turn, ref kappa) in weights.kappa(h, k) {
        for (node, &w) in kappa.iter().enumerate() {
            row.add(NodeRef { turn, node }, w);
        }
    }
    let tau = weights.tau(h, k);
    if h == 3 {
        add_on_q(&mut row, 0, tau.map(|w| 0.5 * w));
        // The line from the other side, where q_2, q_3 and q_4, q_6 change places.
        let [t2, t3, t4, t5, t6] = tau;
        add_on_q(&mut row, 1, [t4, t6, t2, t5, t3].map(|w| 0.5 * w));
    } else {
        add_on_q(&mut row, 0, tau);
    }
    row.finish()
}

/// Adds weights of q_2..q_6, relative to q_1, as weights of the expansion.
fn add_on_q(row: &mut RowBuilder, turn: isize, [t2, t3, t4, t5, t6]: [f64; 5]) {
    let expansion =
        [(t2 + 2.0 * t3 + t5) / 5.0, (t4 + t5 + 2.0 * t6) / 5.0, t3 / 10.0, t5 / 20.0, t6 / 10.0];
    for (k, w) in expansion.into_iter().enumerate() {
        row.add(NodeRef { turn, node: DNET_NODES + k }, w);
    }
}

/// The default quadratic of a bi-4 d-net, sector 0, by S1 to S3 of Section 4.2: every sector
/// proposes q_4 and q_5 by the tables, its other points follow from its neighbours', and the
/// proposals' mean is an exact quadratic even if the weights are truncated.
fn default_quadratic(n: usize, weights: &QasWeights) -> [Row; 5] {
    let c = sector_cosine(n);
    let empty = RowBuilder::new(n, DNET_NODES);
    let from_table = |k: usize| {
        let mut row = empty.clone();
        for (turn, sector) in weights.mu(k).iter().enumerate() {
            for (node, &w) in sector.iter().enumerate() {
                row.add(NodeRef { turn: turn as isize, node }, w);
            }
        }
        row.finish()
    };
    let sum = |terms: &[(&Row, isize, f64)]| {
        let mut row = empty.clone();
        terms.iter().for_each(|&(term, turn, w)| row.add_turned(term, DNET_NODES, turn, w));
        row.finish()
    };
    let (q4, q5) = (from_table(4), from_table(5));
    let q2 = sum(&[(&q4, -1, 1.0)]);
    let q6 = sum(&[(&q5, 0, 0.5 / c), (&q5, 1, 0.5 / c), (&q4, 0, (c - 1.0) / c)]);
    let q3 = sum(&[(&q6, -1, 1.0)]);
    let proposal = [
        sum(&[(&q2, 0, 5.0)]),
        sum(&[(&q4, 0, 5.0)]),
        sum(&[(&q3, 0, 10.0), (&q2, 0, -20.0)]),
        sum(&[(&q5, 0, 20.0), (&q2, 0, -20.0), (&q4, 0, -20.0)]),
        sum(&[(&q6, 0, 10.0), (&q4, 0, -20.0)]),
    ];
    mean_of_proposals(n, c, &empty, &proposal)
}

/// Eq. (4), (5): the proposal of the sector r sectors back is carried r sectors on.
fn mean_of_proposals(n: usize, c: f64, empty: &RowBuilder, proposal: &[Row; 5]) -> [Row; 5] {
    let mut mean = [(); 5].map(|()| empty.clone());
    // Row k holds the expansion's term k after r turns in terms of the one before them.
    let mut carried = [0, 1, 2, 3, 4].map(|k| [0, 1, 2, 3, 4].map(|m| f64::from(u8::from(k == m))));
    for r in 0..n as isize {
        for (sum, weights) in mean.iter_mut().zip(&carried) {
            for (row, &w) in proposal.iter().zip(weights) {
                sum.add_turned(row, DNET_NODES, -r, w / n as f64);
            }
        }
        carried = turned_weights(c, &carried);
    }
    mean.map(RowBuilder::finish)
}

/// One more turn of an expansion whose terms are given by weights; see [`crate::net::turned`].
fn turned_weights(c: f64, [a, b, uu, uv, vv]: &[[f64; 5]; 5]) -> [[f64; 5]; 5] {
    let sum = |terms: &[(f64, &[f64; 5])]| {
        [0, 1, 2, 3, 4].map(|k| terms.iter().map(|(w, x)| w * x[k]).sum())
    };
    [
        *b,
        sum(&[(2.0 * c, b), (-1.0, a)]),
        *vv,
        sum(&[(4.0 * c, vv), (-1.0, uv)]),
        sum(&[(4.0 * c * c, vv), (-2.0 * c, uv), (1.0, uu)]),
    ]
}

/// The change between the d-net of a scheme and the d-net of bi-4 splines, row by row: T and its
/// inverse for bi-3 (Section 3), the identity for bi-4.
///
/// Tensor products of a mask: even indices stay, odd indices become (1,6,1)/8 of themselves and
/// their neighbours; inverse (-1,8,-1)/6.
struct Bases {
    valence: usize,
    to_own: Vec<Row>,
    to_quartic: Vec<Row>,
}

impl Bases {
    fn new(n: usize, spline: Spline) -> Self {
        let (to_own, to_quartic) = match spline {
            Spline::BiQuartic => ([0.0, 1.0, 0.0], [0.0, 1.0, 0.0]),
            Spline::BiCubic => ([0.125, 0.75, 0.125], [-1.0 / 6.0, 8.0 / 6.0, -1.0 / 6.0]),
        };
        let rows = |mask| (0..DNET_NODES).map(|k| tensor(n, mask, k)).collect();
        Self { valence: n, to_own: rows(to_own), to_quartic: rows(to_quartic) }
    }

    /// Node `k` of the scheme's refined net: T applied to `step`, a map of the bi-4 d-net and q,
    /// applied to T^-1 of the scheme's net.
    fn refined_node(&self, empty: &RowBuilder, step: &[Row], k: usize) -> Row {
        let mut on_quartic = empty.clone();
        for &(at, w) in &self.to_own[k] {
            let (turn, node) = ((at / DNET_NODES) as isize, at % DNET_NODES);
            on_quartic.add_turned(&step[node], NODES, turn, w);
        }
        let mut row = empty.clone();
        for (at, w) in on_quartic.finish() {
            let (turn, node) = ((at / NODES) as isize, at % NODES);
            if node < DNET_NODES {
                row.add_turned(&self.to_quartic[node], DNET_NODES, turn, w);
            } else {
                row.add(NodeRef { turn, node }, w);
            }
        }
        row.finish()
    }

    /// A row on the bi-4 d-net as one on the scheme's net.
    fn in_own_basis(&self, row: &Row) -> Row {
        let mut sum = RowBuilder::new(self.valence, DNET_NODES);
        for &(at, w) in row {
            let (turn, node) = ((at / DNET_NODES) as isize, at % DNET_NODES);
            sum.add_turned(&self.to_quartic[node], DNET_NODES, turn, w);
        }
        sum.finish()
    }
}

/// Node `k` under the tensor product of a mask on odd indices.
fn tensor(n: usize, mask: [f64; 3], k: usize) -> Row {
    let univariate = |i: usize| match i % 2 {
        0 => vec![(i, 1.0)],
        _ => (0..3).map(|m| (i + m - 1, mask[m])).filter(|&(_, w)| w != 0.0).collect(),
    };
    let mut row = RowBuilder::new(n, DNET_NODES);
    for (i, wi) in univariate(k % 4) {
        for &(j, wj) in &univariate(k / 4) {
            row.add(dnet_node(i, j), wi * wj);
        }
    }
    row.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_change_of_basis_and_its_inverse_compose_to_the_identity() {
        for n in [3, 5, 8, 16] {
            let bases = Bases::new(n, Spline::BiCubic);
            for k in 0..DNET_NODES {
                let row = bases.in_own_basis(&bases.to_own[k]);
                for (at, w) in row {
                    let expected = if at == k { 1.0 } else { 0.0 };
                    assert!((w - expected).abs() < 1e-15, "n = {n}, node {k}: {w} on {at}");
                }
            }
        }
    }
}
