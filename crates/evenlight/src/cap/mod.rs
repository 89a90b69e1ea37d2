//! Caps: finitely many patches that close the hole after any number of rings.
//!
//! ```text
//!  b, line s
//!  1 +-------+-------+   n sectors of m x m patches of bi-degree D. After K rings the hole is
//!    |       |       |   2^-K of a sector:
//!    |       |       |
//! .5 +---+---+       |   bi-6   1 x 1   C2 inside a sector, tangent planes common on the lines
//!    |cap|cap|       |   bi-5   2 x 2   C2
//!    +---+---+       |   bi-4   2 x 2   C1
//!    |cap|cap| rings |   bi-3   3 x 3   C1; tangent planes common to about a degree's fraction
//!  0 +---+---+-------+
//!    0      .5       1  a, line s-1
//! ```
//!
//! Caps join the last ring, or for K = 0 the surrounding surface, with first derivatives. Position
//! and tangent plane are common on the lines. All sectors have one quadratic at the centre, so that
//! curvature exists there: the scheme's q or the quadratic of its guide, if it has one. The freedom
//! that is left follows the guide or bends least (module `rules`).
//!
//! If a ring has m x m patches per square, the number of patches along a side of a cap is the
//! smallest suitable multiple of m.
//!
//! All this is for points that are smooth all around. Other points have plain caps (module
//! `plain`): at boundaries, creases, corners and darts, and at valences 2, above [`MAX_VALENCE`],
//! and 4 (of nets by themselves; in cages that is regular). A plain cap is one bi-4 patch per
//! sector (bi-3, if the options ask for it). It joins the last ring with first derivatives, and its
//! creases are exact. At fans its tangent planes are common on the lines, if the point has a
//! tangent plane. Behind fair rings beside a crease a cap has 2 x 2 patches per sector (module
//! `fair`).

mod border;
mod fair;
mod guide;
mod plain;
mod plane;
mod round;
mod rules;
mod sector;
mod spline;

use std::fmt;
use std::str::FromStr;

use crate::names::UnknownName;
use crate::patch::kernel::patch_jet;
use crate::patch::{Answer, Jet, Patch, Shape, SurfacePoint};
use crate::rings::{MAX_RINGS, Rings, ValenceRules};
use crate::scheme::{Rules, SchemeKind};
use fair::FairCap;
pub(crate) use plain::FanLines;
use plain::PlainCap;
use round::RoundCap;
use spline::Space;

/// The degree of a cap's patches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CapKind {
    /// The kind that suits the scheme best ([`CapKind::of_scheme`]).
    #[default]
    Auto,
    /// Bi-3, 3 x 3 patches per sector.
    Bi3,
    /// Bi-4, 2 x 2 patches per sector.
    Bi4,
    /// Bi-5, 2 x 2 patches per sector.
    Bi5,
    /// Bi-6, one patch per sector.
    Bi6,
}

/// How holes are closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CapOptions {
    /// The rings before the cap, at most [`MAX_RINGS`]; 0 closes the whole of every sector with a
    /// cap.
    pub rings: usize,
    /// The patches.
    pub kind: CapKind,
}

impl CapOptions {
    /// Checks that there are this many rings.
    pub(crate) fn check_rings(self) -> Result<(), CapError> {
        let Self { rings, .. } = self;
        if rings > MAX_RINGS { Err(CapError::Rings { rings }) } else { Ok(()) }
    }
}

/// Why there is no cap.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CapError {
    /// The rings are of a higher degree than the cap.
    #[error(
        "a bi-{cap} cap cannot join the bi-{ring} rings of scheme {} with first derivatives; take \
         bi-{ring} or more, or auto",
        scheme.name()
    )]
    Degree {
        /// The scheme.
        scheme: SchemeKind,
        /// The degree of its rings.
        ring: usize,
        /// The degree asked for.
        cap: usize,
    },
    /// The lines between the patches of a ring do not match the lines of a cap.
    #[error(
        "the patches of scheme {} meet the hole at other parameters than those of a cap when rings \
         do not contract like Catmull-Clark's; take guided5 or guided6",
        scheme.name()
    )]
    Contraction {
        /// The scheme.
        scheme: SchemeKind,
    },
    /// More rings are asked for in front of the cap than there are.
    #[error("{rings} rings in front of a cap: there may be {MAX_RINGS} at most")]
    Rings {
        /// The number asked for.
        rings: usize,
    },
    /// The rings are cut elsewhere than a cap.
    #[error(
        "scheme {} cuts its rings in {split} unequal parts at this contraction, which a cap cannot \
         continue; take contraction cc, or guided5 or guided6",
        scheme.name()
    )]
    Cuts {
        /// The scheme.
        scheme: SchemeKind,
        /// The patches along each side of a square of its rings.
        split: usize,
    },
}

/// The highest valence with caps of the kind asked for. Beyond it caps are plain, as sectors are
/// slivers and the rules would take seconds.
pub const MAX_VALENCE: usize = 64;

/// The name in commands and files.
impl fmt::Display for CapKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for CapKind {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        const NAMES: [&str; 5] = ["auto", "bi3", "bi4", "bi5", "bi6"];
        let found = [Self::Auto].into_iter().chain(Self::ALL).find(|kind| kind.name() == text);
        found.ok_or_else(|| UnknownName::new("kind of cap", text, &NAMES))
    }
}

impl CapKind {
    /// All kinds but `Auto`.
    pub const ALL: [Self; 4] = [Self::Bi3, Self::Bi4, Self::Bi5, Self::Bi6];

    /// The name in commands and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Bi3 => "bi3",
            Self::Bi4 => "bi4",
            Self::Bi5 => "bi5",
            Self::Bi6 => "bi6",
        }
    }

    /// The kind that `Auto` means for a scheme.
    pub fn of_scheme(scheme: SchemeKind) -> Self {
        match scheme {
            SchemeKind::Guided6 => Self::Bi6,
            _ => Self::Bi5,
        }
    }

    /// The degree for a scheme.
    fn degree(self, scheme: SchemeKind) -> usize {
        match self {
            Self::Auto => Self::of_scheme(scheme).degree(scheme),
            Self::Bi3 => 3,
            Self::Bi4 => 4,
            Self::Bi5 => 5,
            Self::Bi6 => 6,
        }
    }

    /// Whether caps of this kind can join the rings of a scheme.
    ///
    /// # Errors
    ///
    /// [`CapError::Degree`] if the rings are of a higher degree.
    pub fn check(self, scheme: SchemeKind) -> Result<(), CapError> {
        let (ring, cap) = (scheme.degree(), self.degree(scheme));
        if cap < ring { Err(CapError::Degree { scheme, ring, cap }) } else { Ok(()) }
    }

    /// The splines of a sector behind rings whose squares are split in `split`.
    fn space(self, scheme: SchemeKind, split: usize) -> Space {
        let degree = self.degree(scheme);
        let (least, smooth) = match degree {
            3 => (3, 1),
            4 => (2, 1),
            5 => (2, 2),
            _ => (1, 2),
        };
        Space { degree, pieces: usize::div_ceil(least, split) * split, smooth }
    }
}

/// The cap around one extraordinary point.
#[derive(Clone, Debug)]
pub struct Cap<const N: usize = 3> {
    rings: usize,
    space: Space,
    /// The patches of all sectors in the frame of the rings, scaled as ring `rings`.
    patches: Vec<Patch<N>>,
}

impl Cap {
    /// Position, derivatives by a and b, normal and curvature at (a,b) of sector `s`, where the
    /// hole is the unit square. Derivatives are by the sector's own parameters, as in
    /// [`Rings::eval`].
    ///
    /// `rings` must be the rings that the cap was made for. The centre has the curvature of the
    /// common quadratic. The centre of a plain cap has the limit normal, if there is one, and no
    /// curvature (NaN), as it differs between sectors. `None` if `s` is not below the valence or
    /// a, b are not from 0 to 1.
    pub fn eval(&self, rings: &Rings, s: usize, at: [f64; 2]) -> Option<SurfacePoint> {
        let is_inside = at.iter().all(|x| (0.0..=1.0).contains(x));
        (self.has_patch(s, 0) && is_inside).then(|| self.eval_as(rings, s, at))
    }

    /// Like [`Cap::eval`], but from a given patch, which is extrapolated if (a,b) is not in it.
    /// `None` if there is no such patch, or a or b is NaN.
    pub fn eval_on(
        &self,
        rings: &Rings,
        s: usize,
        which: usize,
        at: [f64; 2],
    ) -> Option<SurfacePoint> {
        let is_known = self.has_patch(s, which) && !at.iter().any(|x| x.is_nan());
        is_known.then(|| self.eval_in_patch(rings, s, which, at))
    }
}

impl<const N: usize> Cap<N> {
    /// The cap behind `options.rings` rings.
    ///
    /// # Errors
    ///
    /// [`CapError`], if no such cap fits the rings.
    pub fn new(rings: &Rings<N>, options: CapOptions) -> Result<Self, CapError> {
        options.check_rings()?;
        let rules = ValenceCap::new(rings.rules(), options.kind)?;
        Ok(Self::with_rules(rings, options.rings, &rules))
    }

    pub(crate) fn with_rules(rings: &Rings<N>, count: usize, rules: &ValenceCap) -> Self {
        let patches = match rules {
            ValenceCap::Round(cap) => cap.patches(rings, count),
            ValenceCap::Plain(cap) => cap.patches(rings, count),
            ValenceCap::Fair(cap) => {
                let limit = rings.rules().fan_limit().expect("these are the rules of a fan");
                cap.patches(rings, limit, count)
            }
        };
        Self { rings: count, space: rules.space(), patches }
    }

    /// The number of rings in front of it.
    pub fn rings(&self) -> usize {
        self.rings
    }

    /// The degree of its patches in both parameters.
    pub fn degree(&self) -> usize {
        self.space.degree
    }

    /// The number of patches along each side of a sector.
    pub fn split(&self) -> usize {
        self.space.pieces
    }

    /// The number of patches in each sector.
    pub fn patches_per_sector(&self) -> usize {
        self.space.pieces * self.space.pieces
    }

    /// The part [[a0, a1], [b0, b1]] of the hole that patch `which` of a sector covers, the hole
    /// being the unit square; the index along b is fastest. `None` if there is no such patch.
    pub fn patch_domain(&self, which: usize) -> Option<[[f64; 2]; 2]> {
        (which < self.patches_per_sector()).then(|| self.space.patch_domain(which))
    }

    /// Patch `which` of sector `s`, in world coordinates; `None` if there is no such patch.
    pub fn patch(&self, rings: &Rings<N>, s: usize, which: usize) -> Option<Patch<N>> {
        self.has_patch(s, which).then(|| self.patch_at(rings, s, which))
    }

    /// Whether there is such a patch.
    fn has_patch(&self, s: usize, which: usize) -> bool {
        let per_sector = self.patches_per_sector();
        which < per_sector && s < self.patches.len() / per_sector
    }

    /// [`Cap::patch`] for a patch that is known to exist.
    pub(crate) fn patch_at(&self, rings: &Rings<N>, s: usize, which: usize) -> Patch<N> {
        rings.to_world(self.rings, &self.patches[s * self.patches_per_sector() + which])
    }

    /// [`Cap::eval`] for any [`Answer`], in a sector that is known to exist.
    pub(crate) fn eval_as<A: Answer<N>>(&self, rings: &Rings<N>, s: usize, [a, b]: [f64; 2]) -> A {
        let which = self.space.patch_at([a, b]);
        if a.max(b) == 0.0 && plain::is_plain(rings.rules()) {
            // Derivatives may be parallel, and curvature differs between sectors.
            let jet: Jet<N> = self.eval_in_patch(rings, s, which, [a, b]);
            let (normal, none) = (rings.normal(), f64::NAN);
            return A::from_parts(jet, |_| Shape { normal, gauss: none, mean: none });
        }
        self.eval_in_patch(rings, s, which, [a, b])
    }

    /// [`Cap::eval_on`] for any [`Answer`], on a patch that is known to exist.
    pub(crate) fn eval_in_patch<A: Answer<N>>(
        &self,
        rings: &Rings<N>,
        s: usize,
        which: usize,
        [a, b]: [f64; 2],
    ) -> A {
        let [[a0, _], [b0, _]] = self.space.patch_domain(which);
        let m = self.space.pieces as f64;
        let coefs = self.patches[s * self.patches_per_sector() + which].coefs();
        let at = [(a - a0) * m, (b - b0) * m];
        let jet = patch_jet(A::ORDER, self.space.degree, coefs, at);
        rings.in_world(self.rings, [1.0 / m; 2], &jet)
    }
}

/// The rules of the caps of a scheme at one valence or fan.
#[derive(Clone, Debug)]
pub(crate) enum ValenceCap {
    Round(Box<RoundCap>),
    Plain(Box<PlainCap>),
    Fair(Box<FairCap>),
}

impl ValenceCap {
    pub(crate) fn new(rules: &ValenceRules, kind: CapKind) -> Result<Self, CapError> {
        if let Some(limit) = rules.fan_limit().filter(|_| rules.is_fair_fan()) {
            return Ok(Self::Fair(Box::new(FairCap::new(rules, limit, kind))));
        }
        if plain::is_plain(rules) {
            return Ok(Self::Plain(Box::new(PlainCap::new(rules, kind))));
        }
        Ok(Self::Round(Box::new(RoundCap::new(rules, kind)?)))
    }

    fn space(&self) -> Space {
        match self {
            Self::Round(cap) => cap.space(),
            Self::Plain(cap) => cap.space(),
            Self::Fair(cap) => cap.space(),
        }
    }

    /// The number of patches along each side of a sector.
    pub(crate) fn split(&self) -> usize {
        self.space().pieces
    }

    /// The number of the patch in which a place of the hole is.
    pub(crate) fn patch_at(&self, in_hole: [f64; 2]) -> usize {
        self.space().patch_at(in_hole)
    }

    /// [`Cap::patches_per_sector`].
    pub(crate) fn patches_per_sector(&self) -> usize {
        self.space().pieces * self.space().pieces
    }

    /// [`Cap::patch_domain`].
    pub(crate) fn patch_domain(&self, which: usize) -> [[f64; 2]; 2] {
        self.space().patch_domain(which)
    }
}

/// The parts of a sector that the patches of ring 0 cover.
fn domains(rules: &Rules) -> Vec<[[f64; 2]; 2]> {
    (0..rules.patches_per_sector()).map(|which| rules.patch_domain(which)).collect()
}
