//! The rules of Quadratic-Attraction subdivision: kappa, tau and mu.
//!
//! Quadratic-Attraction subdivision, QAS4 [KP23-QAS], is the step (d, q) -> d of [`crate::rules`],
//! with its weights kappa of the net and tau of q. Here q is chosen once, and each step only
//! restricts it to the smaller domain. So the surface is attracted to one quadratic and its
//! curvature stays bounded.
//!
//! The first q comes from the first net, as the quadratic that makes F_5 of the guide least
//! ([`Step::quadratic`](crate::rules::Step::quadratic)). The tables hold two of its coefficients,
//!
//! ```text
//!   q_m^s = sum over r = 0..n-1, i, j of mu_ij^(m,r) d_ij^(s+r) + (1 - sum) p,   m = 4, 5:
//! ```
//!
//! Neighbouring sectors share the coefficients along their line, and the matrix A takes the
//! quadratic across line s ([`crate::quadratic::turn`]). So q_4 and q_5 of all sectors determine q
//! [KP23-QAS, sec. 4.2, S2]:
//!
//! ```text
//!   q_2^(s+1) = q_4^s,   q_6^s = (q_5^s + q_5^(s+1) - 2 (1-c) q_4^s) / (2c),   q_3^(s+1) = q_6^s,
//! ```
//!
//! c = cos(2 pi / n), not zero at the valences with tables. DIFFERENCE: (S2) prints q_i where the
//! node d_ij is meant.
//!
//! q_4 lies on line s and q_5 on the diagonal of the sector. Hence, for i, j below 3, r modulo n:
//!
//! ```text
//!   mu_ij^(4,r) = mu_ji^(4,1-r)     mu_3j^(4,r) = mu_3j^(4,-r)
//!   mu_ij^(5,r) = mu_ji^(5,-r)      mu_3j^(5,r) = mu_3j^(5,-1-r)
//! ```

use crate::evolving_guide::NetRule;
use crate::linear::Matrix;
use crate::nets::Mirror;
use crate::rules::{RULES, StepRule, step, symmetrised};

/// The order k of the functional F_k that determines the first q.
pub const QAS_ORDER: usize = 5;

/// The coefficients q_m with rules of their own, and the mirror that keeps each of them.
pub const Q_RULES: [(usize, Mirror); 2] = [(4, Mirror::Line), (5, Mirror::Diagonal)];

/// The rules of one valence; symmetric to the last bit.
#[derive(Clone, Debug, PartialEq)]
pub struct QasRules {
    /// The valence n.
    pub valence: usize,
    /// The rules of the new nodes (h, k), in the order of [`RULES`].
    pub nodes: [StepRule; 6],
    /// The rules mu of q_4 and q_5, in the order of [`Q_RULES`].
    pub q: [NetRule; 2],
}

/// The rules of valence n >= 3, with the first q minimising F_`order`; the scheme has `order` =
/// [`QAS_ORDER`].
///
/// At n = 4 the rules of the nodes with a C2 spline's own q are the regular refinement.
pub fn quadratic_attraction(valence: usize, order: usize) -> QasRules {
    let step = step(valence);
    let q = step.quadratic(order);
    QasRules {
        valence,
        nodes: symmetrised(&RULES.map(|(h, k)| step.rule(h, k))),
        q: Q_RULES.map(|(m, mirror)| {
            let rule = net_rule(&q, m - 1);
            rule.averaged_with(&rule.mirrored(valence, mirror))
        }),
    }
}

/// Row `row` of a matrix on the nodes and the centre.
fn net_rule(rows: &Matrix, row: usize) -> NetRule {
    let (on_centre, on_net) = rows.row(row).split_last().expect("the last column is the centre");
    NetRule { on_net: on_net.to_vec(), on_centre: *on_centre }
}
