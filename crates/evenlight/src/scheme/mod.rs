//! The schemes: the linear rules that make the rings around an extraordinary point.
//!
//! A scheme is a pair of linear maps per valence (module `rules`): net to refined net, and both to
//! a ring of Bernstein-Bezier patches. Nothing here knows a mesh.

mod catmull_clark;
mod contraction;
mod evolving_guide;
mod fan;
mod guided;
mod quadratic_attraction;
mod rules;
mod spline;
mod subdominant;
mod tables;

pub use contraction::{Contraction, ContractionError, Variant};
pub use fan::MAX_FAIR_FACES;
pub(crate) use fan::{FairFan, FanLimit, fair_rules, is_fair, rules as fan_rules};
pub(crate) use guided::{guide_monomials, sampled_guide};
pub(crate) use rules::{Cuts, PatchParameters, Row, Rules};
pub(crate) use subdominant::Subdominant;

use crate::names::names;
use crate::net::{CNet, DNet, MAX_VALENCE, Spline};

/// Which subdivision scheme makes the surface around extraordinary points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum SchemeKind {
    /// Catmull-Clark subdivision \[CC78\]: bi-3 rings, C1 at the centre, unbounded curvature there.
    CatmullClark,
    /// Evolving-Guide subdivision [KP23-EG]: bi-4 rings, C1 at the centre, without pinching.
    EvolvingGuide,
    /// Point-augmented subdivision [KP23-QAS, Section 7]: 2 x 2 bi-3 macro-patches, C1 at the
    /// centre.
    Pas3,
    /// Point-augmented subdivision [KP23-QAS, Section 7]: bi-4 rings, C1 at the centre.
    Pas4,
    /// Quadratic-Attraction subdivision [KP23-QAS]: 2 x 2 bi-3 macro-patches, curvature bounded
    /// at the centre.
    Qas3,
    /// Quadratic-Attraction subdivision [KP23-QAS]: bi-4 rings, curvature bounded at the centre.
    #[default]
    Qas4,
    /// Guided C2 subdivision [KP18-Guided]: 3 x 3 bi-3 macro-patches, curvature bounded at the
    /// centre.
    Guided3,
    /// Guided C2 subdivision [KP18-Guided]: 2 x 2 bi-4 macro-patches, curvature bounded at the
    /// centre.
    Guided4,
    /// Guided C2 subdivision [KP18-Guided]: bi-5 rings, curvature bounded at the centre.
    Guided5,
    /// Guided C2 subdivision [KP18-Guided]: bi-6 rings, curvature continuous at the centre.
    Guided6,
    /// Fairness-optimal subdivision, ours: the net of [`Self::Qas4`] with the rules of least
    /// energy, bi-4 rings, curvature bounded at the centre.
    Fair4,
    /// Fairness-optimal subdivision without a quadratic that can be set: the net of
    /// [`Self::EvolvingGuide`], bi-4 rings; curvature is bounded at the centre, but not given.
    Fair4d,
    /// Fairness-optimal subdivision: the net of [`Self::Qas3`], 2 x 2 bi-3 macro-patches, curvature
    /// bounded at the centre.
    Fair3,
}

/// Which tables of weights are used, by schemes that have tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum RuleSet {
    /// Full precision, valences 3 and 5 to 16; of guided subdivision, with the feature `derive`, to
    /// 32.
    #[default]
    Generated,
    /// As the papers print them, truncated to 5 digits: valences 3 and 5 to 10. No paper prints the
    /// weights of guided and fairness-optimal subdivision.
    Published,
}

names! { SchemeKind, "scheme":
    CatmullClark => "cc",
    EvolvingGuide => "eg",
    Pas3 => "pas3",
    Pas4 => "pas4",
    Qas3 => "qas3",
    Qas4 => "qas4",
    Guided3 => "guided3",
    Guided4 => "guided4",
    Guided5 => "guided5",
    Guided6 => "guided6",
    Fair4 => "fair4",
    Fair4d => "fair4d",
    Fair3 => "fair3",
}

names! { RuleSet, "set of rules": Published => "published", Generated => "generated" }

impl SchemeKind {
    /// Whether there are rules for valence `n`.
    pub fn has_rules(self, variant: impl Into<Variant>, n: usize) -> bool {
        let is_tabulated = |last: usize| n == 3 || (5..=last).contains(&n);
        match self.last_valence(variant.into()) {
            None => false,
            Some(last) if self == Self::CatmullClark => (2..=last).contains(&n),
            Some(last) => is_tabulated(last),
        }
    }

    /// The valences with rules, in words.
    pub fn valences(self, variant: impl Into<Variant>) -> &'static str {
        match self.last_valence(variant.into()) {
            None => "none",
            Some(_) if self == Self::CatmullClark => "2 to 1024",
            Some(PUBLISHED_VALENCE) => "3 and 5 to 10",
            Some(TABULATED_VALENCE) => "3 and 5 to 16",
            Some(_) => "3 and 5 to 32",
        }
    }

    /// The largest valence with rules; `None` if there are none.
    fn last_valence(self, Variant { rules, contraction }: Variant) -> Option<usize> {
        self.check_contraction(contraction).ok()?;
        match (self, rules) {
            (Self::CatmullClark, _) => Some(MAX_CATMULL_CLARK_VALENCE),
            (_, RuleSet::Published) => self.is_published().then_some(PUBLISHED_VALENCE),
            (_, RuleSet::Generated) if self.guided_degree().is_some() => Some(guided::LAST_VALENCE),
            (_, RuleSet::Generated) => Some(TABULATED_VALENCE),
        }
    }

    /// Whether there is a paper that prints the weights.
    fn is_published(self) -> bool {
        let ours = matches!(self, Self::Fair4 | Self::Fair4d | Self::Fair3);
        !ours && self.guided_degree().is_none()
    }

    /// Whether the scheme carries a quadratic q along, which can be set; curvature is bounded at
    /// extraordinary points then.
    pub fn has_quadratic(self) -> bool {
        matches!(self, Self::Qas3 | Self::Qas4 | Self::Fair3 | Self::Fair4)
    }

    /// Whether curvature is bounded at extraordinary points, and known there as the curvature of
    /// the quadratic or of the guide. With `guided6` it is continuous.
    pub fn has_center_curvature(self) -> bool {
        self.has_quadratic() || self.guided_degree().is_some()
    }

    /// The degree of the rings in both parameters.
    pub fn degree(self) -> usize {
        let of_spline = match self.spline() {
            Some(Spline::BiQuartic) => 4,
            Some(Spline::BiCubic) | None => 3,
        };
        self.guided_degree().unwrap_or(of_spline)
    }

    /// The degree of the rings of guided subdivision.
    pub(crate) fn guided_degree(self) -> Option<usize> {
        match self {
            Self::Guided3 => Some(3),
            Self::Guided4 => Some(4),
            Self::Guided5 => Some(5),
            Self::Guided6 => Some(6),
            _ => None,
        }
    }

    /// The splines whose control points are the scheme's nets; `None` for Catmull-Clark and guided
    /// subdivision, which work on c-nets.
    pub fn spline(self) -> Option<Spline> {
        match self {
            Self::CatmullClark => None,
            Self::Guided3 | Self::Guided4 | Self::Guided5 | Self::Guided6 => None,
            Self::EvolvingGuide | Self::Pas4 | Self::Qas4 => Some(Spline::BiQuartic),
            Self::Fair4 | Self::Fair4d => Some(Spline::BiQuartic),
            Self::Pas3 | Self::Qas3 | Self::Fair3 => Some(Spline::BiCubic),
        }
    }

    /// The rules at valence `n`, if there are any.
    pub(crate) fn rules(self, variant: impl Into<Variant>, n: usize) -> Option<Rules> {
        let variant = variant.into();
        if !self.has_rules(variant, n) {
            return None;
        }
        if let Some(degree) = self.guided_degree() {
            return guided::rules(n, degree, variant.contraction);
        }
        let published = variant.rules == RuleSet::Published;
        match self {
            Self::CatmullClark => Some(catmull_clark::rules(n)),
            Self::EvolvingGuide => evolving_guide::rules(n, published),
            Self::Pas3 => {
                quadratic_attraction::point_augmented_rules(n, Spline::BiCubic, published)
            }
            Self::Pas4 => {
                quadratic_attraction::point_augmented_rules(n, Spline::BiQuartic, published)
            }
            Self::Qas3 => quadratic_attraction::rules(n, Spline::BiCubic, published),
            Self::Qas4 => quadratic_attraction::rules(n, Spline::BiQuartic, published),
            Self::Guided3 | Self::Guided4 | Self::Guided5 | Self::Guided6 => None,
            Self::Fair4 => quadratic_attraction::fair_rules(n, Spline::BiQuartic),
            Self::Fair4d => evolving_guide::fair_rules(n),
            Self::Fair3 => quadratic_attraction::fair_rules(n, Spline::BiCubic),
        }
    }

    /// The limit point of a c-net.
    pub(crate) fn limit_point<const N: usize>(self, cnet: &CNet<N>) -> [f64; N] {
        match self {
            Self::CatmullClark => cnet.catmull_clark_limit(),
            _ => cnet.evolving_guide_limit(),
        }
    }

    /// The control net on which the rules of schemes without a guide work, from a c-net relative to
    /// its limit point.
    pub(crate) fn net<const N: usize>(self, cnet: &CNet<N>) -> Vec<[f64; N]> {
        match self.spline() {
            None => cnet.sectors.iter().flatten().copied().collect(),
            Some(spline) => DNet::from_cnet(cnet, spline).sectors.into_iter().flatten().collect(),
        }
    }
}

/// The largest valence whose rules are tabulated, and whose rules the papers print.
const TABULATED_VALENCE: usize = 16;
const PUBLISHED_VALENCE: usize = 10;

/// Catmull-Clark has rules for every valence.
pub(crate) const MAX_CATMULL_CLARK_VALENCE: usize = MAX_VALENCE;
