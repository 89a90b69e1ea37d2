//! The Evolving-Guide rules: the step with q itself expressed by the net.
//!
//! Evolving-Guide subdivision, EG [KP23-EG, eq. 7], is the step of [`crate::rules`] with q replaced
//! by the quadratic that makes the guide's F_4 least ([`Step::quadratic`]). So each step
//! evolves the guide anew, and depends on the net and the extraordinary point c_0 = p alone:
//!
//! ```text
//!   d_hk(new, sector s) = a_0^hk c_0 + sum over r, i, j of a_ij^(r,hk) d_ij^(s+r)
//! ```
//!
//! With the symmetry of the step, and (h, k) below 3, i, j below 3, r modulo n:
//!
//! ```text
//!   a_ij^(r,hk) = a_ji^(-r,kh)       a_3j^(r,hk) = a_3j^(-1-r,kh)
//!   a_ij^(r,3k) = a_ji^(1-r,3k)      a_3j^(r,3k) = a_3j^(-r,3k)
//! ```
//!
//! With F_5 in place of F_4 the same substitution gives the scheme PAS4 of [KP23-QAS, sec. 7].

use crate::linear::Matrix;
use crate::nets::{DNet, Mirror, own_nodes};
use crate::quadratic::turn;
use crate::real::Real;
use crate::rules::{RULES, Step, StepRule, TURNS, average, mirror_of, step};

/// The order k of the functional F_k that determines q in the Evolving-Guide rules.
pub const EG_ORDER: usize = 4;

/// A point of sector 0 as a combination of the net and the extraordinary point: an Evolving-Guide
/// rule, or a rule of the first q.
#[derive(Clone, Debug, PartialEq)]
pub struct NetRule {
    /// The weights of the 12n nodes of the d-net, numbered by [`DNet::index`].
    pub on_net: Vec<Real>,
    /// The weight of the extraordinary point, derived, not one minus the sum of the others.
    pub on_centre: Real,
}

/// The six Evolving-Guide rules of valence n >= 3, in the order of [`RULES`], with q minimising
/// F_`order`; the scheme has `order` = [`EG_ORDER`].
///
/// At n = 4 the result is not the regular refinement and of no use.
pub fn evolving_guide(valence: usize, order: usize) -> [NetRule; 6] {
    let step = step(valence);
    let own = step.quadratic(order);
    let next = &turn(valence) * &own;
    RULES.map(|(h, k)| substituted(&step, &step.rule(h, k), [&own, &next]))
}

/// The rule with q of sectors s and s+1 replaced by their rules on net and centre, six rows each.
fn substituted(step: &Step, rule: &StepRule, quadratics: [&Matrix; 2]) -> NetRule {
    let by_q = |column: usize| -> Real {
        let sides = rule.on_quadratics().into_iter().zip(quadratics);
        sides.map(|(tau, q)| (0..5).map(|m| tau[m] * q[(m + 1, column)]).sum::<Real>()).sum()
    };
    let mut on_net: Vec<Real> = (0..step.net.num_nodes()).map(by_q).collect();
    for (r, row) in TURNS.into_iter().zip(&rule.kappa) {
        for ((i, j), &weight) in own_nodes().zip(row) {
            on_net[step.net.index(r, i, j)] += weight;
        }
    }
    NetRule { on_net, on_centre: rule.on_centre + by_q(step.net.num_nodes()) }
}

/// The six rules with each weight averaged with its mirror image.
///
/// In exact arithmetic nothing changes; after it the symmetries hold to the last bit.
pub fn symmetrised(valence: usize, rules: &[NetRule; 6]) -> [NetRule; 6] {
    std::array::from_fn(|number| {
        let (mirror, image) = mirror_of(number);
        rules[number].averaged_with(&rules[image].mirrored(valence, mirror))
    })
}

impl NetRule {
    /// The rule as seen in a mirror of sector 0 or line 0.
    pub fn mirrored(&self, valence: usize, mirror: Mirror) -> Self {
        let net = DNet { valence };
        let own = (0..valence).flat_map(|r| own_nodes().map(move |(i, j)| (r as isize, i, j)));
        let on_net = own.map(|node| {
            let (r, i, j) = mirror.image(node);
            self.on_net[net.index(r, i, j)]
        });
        Self { on_net: on_net.collect(), ..*self }
    }

    /// Each weight averaged with the weight of `other`.
    pub fn averaged_with(&self, other: &Self) -> Self {
        let pairs = self.on_net.iter().zip(&other.on_net);
        Self {
            on_net: pairs.map(|(&a, &b)| average(a, b)).collect(),
            on_centre: average(self.on_centre, other.on_centre),
        }
    }
}
