//! The schemes: which linear rules make the rings around an extraordinary point.
//!
//! A scheme is a pair of linear maps per valence ([`rules`]): net to refined net, and both to a
//! ring of Bernstein-Bezier patches. Nothing here knows a mesh.

mod catmull_clark;
mod evolving_guide;
mod rules;
mod spline;
mod subdominant;
mod tables;

pub(crate) use rules::Rules;
pub(crate) use subdominant::Subdominant;

use crate::net::{CNet, DNet};
use crate::point::Point;

/// Which subdivision scheme makes the surface around extraordinary points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SchemeKind {
    /// Catmull-Clark subdivision [CC78]: bi-3 rings, C1 at the centre, unbounded curvature there.
    CatmullClark,
    /// Evolving-Guide subdivision [KP23-EG]: bi-4 rings, C1 at the centre, without pinching.
    EvolvingGuide,
}

/// Catmull-Clark has rules for every valence; the limit keeps a face with a million corners from
/// using up the memory.
const MAX_CATMULL_CLARK_VALENCE: usize = 1024;

/// Which tables of weights are used, by schemes that have tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RuleSet {
    /// Full precision, valences 3 and 5 to 16.
    #[default]
    Generated,
    /// As the paper prints them, truncated to 5 digits: valences 3 and 5 to 10.
    Published,
}

impl SchemeKind {
    /// All schemes, in the order in which they are listed to users.
    pub const ALL: [Self; 2] = [Self::CatmullClark, Self::EvolvingGuide];

    /// The short name used in commands and files: `cc`, `eg`.
    pub fn name(self) -> &'static str {
        match self {
            Self::CatmullClark => "cc",
            Self::EvolvingGuide => "eg",
        }
    }

    /// Whether there are rules for valence `n`.
    pub fn has_rules(self, rules: RuleSet, n: usize) -> bool {
        match (self, rules) {
            (Self::CatmullClark, _) => (2..=MAX_CATMULL_CLARK_VALENCE).contains(&n),
            (Self::EvolvingGuide, RuleSet::Generated) => n == 3 || (5..=16).contains(&n),
            (Self::EvolvingGuide, RuleSet::Published) => n == 3 || (5..=10).contains(&n),
        }
    }

    /// The valences with rules, in words.
    pub fn valences(self, rules: RuleSet) -> &'static str {
        match (self, rules) {
            (Self::CatmullClark, _) => "2 to 1024",
            (Self::EvolvingGuide, RuleSet::Generated) => "3 and 5 to 16",
            (Self::EvolvingGuide, RuleSet::Published) => "3 and 5 to 10",
        }
    }

    /// The rules at valence `n`, if there are any.
    pub(crate) fn rules(self, set: RuleSet, n: usize) -> Option<Rules> {
        if !self.has_rules(set, n) {
            return None;
        }
        match self {
            Self::CatmullClark => Some(catmull_clark::rules(n)),
            Self::EvolvingGuide => evolving_guide::rules(n, set == RuleSet::Published),
        }
    }

    /// The limit point of a c-net.
    pub(crate) fn limit_point(self, cnet: &CNet) -> Point {
        match self {
            Self::CatmullClark => cnet.catmull_clark_limit(),
            Self::EvolvingGuide => cnet.evolving_guide_limit(),
        }
    }

    /// The net on which the rules work, from a c-net relative to its limit point.
    pub(crate) fn net(self, cnet: &CNet) -> Vec<[f64; 3]> {
        match self {
            Self::CatmullClark => cnet.sectors.iter().flatten().copied().collect(),
            Self::EvolvingGuide => DNet::from_cnet(cnet).sectors.into_iter().flatten().collect(),
        }
    }

    /// Whether the rules work on d-nets.
    pub(crate) fn takes_dnets(self) -> bool {
        match self {
            Self::CatmullClark => false,
            Self::EvolvingGuide => true,
        }
    }
}
