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
//! Caps join the last ring, or for K = 0 the surrounding surface, with first derivatives; position
//! and tangent plane are common on the lines; and all sectors have one quadratic at the centre, that
//! of the scheme's q or guide if it has one, so that curvature exists there. What freedom is left
//! follows the guide or bends least (module `rules`).
//!
//! If the patches of a ring are split themselves, a cap is split in the smallest multiple of that.

mod border;
mod guide;
mod plane;
mod rules;
mod sector;
mod spline;

use crate::angle::{cosine, sine};
use crate::dense;
use crate::patch::kernel::patch_jet;
use crate::patch::{Answer, Patch, SurfacePoint};
use crate::point::{Vector, add_scaled, scale};
use crate::rings::{Rings, ValenceRules};
use crate::scheme::{Rules, SchemeKind, guide_monomials};
use border::Border;
use rules::{CapRules, Shape, pieces};
use sector::Complex;
use spline::Space;

/// The degree of a cap's patches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CapKind {
    /// What suits the scheme best ([`CapKind::of_scheme`]).
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
    /// The rings before the cap; 0 closes the whole of every sector with a cap.
    pub rings: usize,
    /// The patches.
    pub kind: CapKind,
}

/// Why there is no cap.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
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
    /// The lines between the patches of a ring are not those of a cap.
    #[error(
        "the patches of scheme {} meet the hole at other parameters than those of a cap when rings \
         do not contract like Catmull-Clark's; take guided5 or guided6",
        scheme.name()
    )]
    Contraction {
        /// The scheme.
        scheme: SchemeKind,
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
    /// No caps at points on a boundary or on sharp edges.
    #[error("points on a boundary or on sharp edges have none")]
    Fan,
    /// No caps at this valence.
    #[error("there are caps for valences 3 to {MAX_VALENCE} (not 4), not for {valence}")]
    Valence {
        /// The valence.
        valence: usize,
    },
}

/// The highest valence with caps: beyond it sectors are slivers, and the rules take seconds.
pub const MAX_VALENCE: usize = 64;

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

    /// What `Auto` is for a scheme.
    pub fn of_scheme(scheme: SchemeKind) -> Self {
        match scheme {
            SchemeKind::Guided6 => Self::Bi6,
            SchemeKind::Guided3 | SchemeKind::Guided4 => Self::Bi4,
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
pub struct Cap {
    rings: usize,
    space: Space,
    /// The patches of all sectors in the frame of the rings, scaled as ring `rings`.
    patches: Vec<Patch>,
}

impl Cap {
    /// The cap behind `options.rings` rings.
    ///
    /// # Errors
    ///
    /// [`CapError`], if no such cap fits the rings.
    pub fn new(rings: &Rings, options: CapOptions) -> Result<Self, CapError> {
        let rules = ValenceCap::new(rings.rules(), options.kind)?;
        Ok(Self::with_rules(rings, options.rings, &rules))
    }

    pub(crate) fn with_rules(rings: &Rings, count: usize, rules: &ValenceCap) -> Self {
        let net = rings.net(count);
        let data = rules.data(rings, count, &net);
        let center = rules.center(rings, &net);
        let space = rules.cap.sector.space;
        let patches = (0..rings.valence()).flat_map(|s| {
            let coefs = rules.cap.coefs(s, &data, &center);
            pieces(&rules.cap.sector, &coefs)
        });
        let patches = patches.map(|coefs| Patch::new([space.degree; 2], coefs)).collect();
        Self { rings: count, space, patches }
    }

    /// The number of rings in front of it.
    pub fn rings(&self) -> usize {
        self.rings
    }

    /// The degree of its patches in both parameters.
    pub fn degree(&self) -> usize {
        self.space.degree
    }

    /// Along each side of a sector so many patches.
    pub fn split(&self) -> usize {
        self.space.pieces
    }

    /// The number of patches in each sector.
    pub fn patches_per_sector(&self) -> usize {
        self.space.pieces * self.space.pieces
    }

    /// The part [[a0, a1], [b0, b1]] of the hole that patch `which` of a sector covers, the hole
    /// being the unit square; the index along b is fastest.
    pub fn patch_domain(&self, which: usize) -> [[f64; 2]; 2] {
        let m = self.space.pieces;
        [which / m, which % m].map(|k| [k as f64 / m as f64, (k + 1) as f64 / m as f64])
    }

    /// Patch `which` of sector `s`, in world coordinates.
    pub fn patch(&self, rings: &Rings, s: usize, which: usize) -> Patch {
        rings.to_world(self.rings, &self.patches[s * self.patches_per_sector() + which])
    }

    /// Position, derivatives by a and b, normal and curvature at (a,b) of sector `s`, the hole being
    /// the unit square; derivatives are by the sector's own parameters, as those of the rings.
    ///
    /// `rings` must be those that the cap was made for. At the centre the curvature is that of the
    /// common quadratic.
    ///
    /// # Panics
    ///
    /// If `s` is not below the valence.
    pub fn eval(&self, rings: &Rings, s: usize, at: [f64; 2]) -> SurfacePoint {
        self.eval_as(rings, s, at)
    }

    /// [`Cap::eval`] of what is wanted alone.
    pub(crate) fn eval_as<A: Answer>(&self, rings: &Rings, s: usize, [a, b]: [f64; 2]) -> A {
        let m = self.space.pieces;
        let part = |x: f64| ((x * m as f64).ceil() as usize).saturating_sub(1).min(m - 1);
        self.eval_in_patch(rings, s, part(a) * m + part(b), [a, b])
    }

    /// Like [`Cap::eval`], but from a given patch, which is extrapolated if (a,b) is not in it.
    pub fn eval_on(&self, rings: &Rings, s: usize, which: usize, at: [f64; 2]) -> SurfacePoint {
        self.eval_in_patch(rings, s, which, at)
    }

    fn eval_in_patch<A: Answer>(
        &self,
        rings: &Rings,
        s: usize,
        which: usize,
        [a, b]: [f64; 2],
    ) -> A {
        let [[a0, _], [b0, _]] = self.patch_domain(which);
        let m = self.space.pieces as f64;
        let coefs = self.patches[s * self.patches_per_sector() + which].coefs();
        let at = [(a - a0) * m, (b - b0) * m];
        let jet = patch_jet(A::ORDER, self.space.degree, coefs, at);
        rings.in_world(self.rings, [1.0 / m; 2], &jet)
    }
}

/// The rules of the caps of a scheme at one valence.
#[derive(Clone, Debug)]
pub(crate) struct ValenceCap {
    border: Border,
    cap: CapRules,
    /// chi over the coordinate of the plane: chi = kappa zeta.
    kappa: Complex,
}

impl ValenceCap {
    pub(crate) fn new(rules: &ValenceRules, kind: CapKind) -> Result<Self, CapError> {
        if rules.is_fan() {
            return Err(CapError::Fan);
        }
        let (scheme, rules, subdominant) = (rules.kind(), rules.rules(), rules.subdominant());
        let valence = rules.valence;
        if valence == 4 || !(3..=MAX_VALENCE).contains(&valence) {
            return Err(CapError::Valence { valence });
        }
        kind.check(scheme)?;
        let space = kind.space(scheme, rules.split);
        if rules.cuts().is_some() && rules.split > 1 {
            return Err(CapError::Contraction { scheme });
        }
        if !cuts_fit(rules, space) {
            return Err(CapError::Cuts { scheme, split: rules.split });
        }
        let net = subdominant.characteristic_net();
        let refined = rules.refine(&net);
        let ring: Vec<Vec<Vector>> = (0..rules.patches_per_sector())
            .map(|which| rules.patch(0, which, &net, &refined))
            .collect();
        let kappa = kappa(rules, &ring);
        let size = kappa[0] * kappa[0] + kappa[1] * kappa[1];
        let zeta = |[x, y, _]: Vector| {
            [(x * kappa[0] + y * kappa[1]) / size, (y * kappa[0] - x * kappa[1]) / size]
        };
        let border = |space: Space| Border::new(rules.degree, &domains(rules), space);
        let chi = |space: Space| border(space).data(&ring).into_iter().map(zeta).collect();
        let shape = match (&rules.guide, &rules.quadratic) {
            (Some(_), _) => Shape::Guide(size.sqrt()),
            (_, Some(_)) => Shape::Quadratic,
            _ => Shape::Fair,
        };
        let cap = CapRules::new(valence, space, shape, chi);
        Ok(Self { border: border(space), cap, kappa })
    }

    /// The data of all sectors for a hole behind `count` rings.
    fn data(&self, rings: &Rings, count: usize, net: &[Vector]) -> Vec<Vector> {
        let rules = rings.rules().rules();
        let ring = rings.frame_patches(count);
        let nodes = net.chunks(rules.nodes_per_sector);
        let sectors = ring.chunks(rules.patches_per_sector()).zip(nodes);
        let mut data = Vec::new();
        for (patches, nodes) in sectors {
            let coefs: Vec<Vec<Vector>> = patches.iter().map(|p| p.coefs().to_vec()).collect();
            data.extend(self.border.data(&coefs));
            if rules.guide.is_some() {
                let first = rules.control_nodes_per_sector();
                data.extend(&nodes[first..first + guide_monomials().len()]);
            }
        }
        data
    }

    /// What is given at the centre, as weights of x, y, x^2 + y^2, Re (x + iy)^2, Im (x + iy)^2.
    fn center(&self, rings: &Rings, net: &[Vector]) -> [Vector; rules::PLANE_FUNCTIONS] {
        let (rules, subdominant) = (rings.rules().rules(), rings.rules().subdominant());
        let [along_x, along_y] = subdominant.tangential(net);
        let [x, y] = self.kappa;
        let sum = |v: f64, w: f64| {
            let mut sum = scale(v, along_x);
            add_scaled(&mut sum, w, along_y);
            sum
        };
        let (linear, zero) = ([sum(x, y), sum(-y, x)], [0.0; 3]);
        let [radius, real, imaginary] = if rules.lambda_of_linear_terms().is_some() {
            let first = rules.control_nodes_per_sector() + 2;
            let terms = [net[first], net[first + 1], net[first + 2]];
            second_order(rules.valence, x * x + y * y, terms)
        } else {
            [zero; 3]
        };
        [linear[0], linear[1], radius, real, imaginary]
    }
}

/// Whether a cap has joints wherever the inner border of a ring has.
fn cuts_fit(rules: &Rules, space: Space) -> bool {
    let fits = |[_, [b0, b1]]: [[f64; 2]; 2]| {
        let at = b0 / rules.sigma() * space.pieces as f64;
        b1 > rules.sigma() + 1e-9 || (at - at.round()).abs() < 1e-9
    };
    domains(rules).into_iter().all(fits)
}

/// The parts of a sector that the patches of ring 0 cover.
fn domains(rules: &Rules) -> Vec<[[f64; 2]; 2]> {
    (0..rules.patches_per_sector()).map(|which| rules.patch_domain(which)).collect()
}

/// chi(1,0) turned by half a sector: chi over a coordinate whose real axis is the bisectrix of sector
/// 0 and in which chi(1,0) has distance 1. `ring` is sector 0 of the characteristic ring.
fn kappa(rules: &Rules, ring: &[Vec<Vector>]) -> Complex {
    let at_corner = domains(rules).iter().position(|[a, b]| a[1] > 1.0 - 1e-9 && b[0] == 0.0);
    let which = at_corner.expect("a ring reaches to a = 1 on its line");
    let [x, y, _] = ring[which][rules.degree * (rules.degree + 1)];
    let half = std::f64::consts::PI / rules.valence as f64;
    let (c, s) = (cosine(half), sine(half));
    [x * c - y * s, x * s + y * c]
}

/// gamma u^2 + delta u v + epsilon v^2 in sector 0, whose lines have unit length in coordinates
/// `size` = |kappa|^2 of ours, as weights of x^2 + y^2, Re (x + iy)^2, Im (x + iy)^2.
fn second_order(n: usize, size: f64, [gamma, delta, epsilon]: [Vector; 3]) -> [Vector; 3] {
    let half = std::f64::consts::PI / n as f64;
    // u = x / (2c) - y / (2s), v = x / (2c) + y / (2s)
    let (c, s) = (cosine(half), sine(half));
    let xx = size / (4.0 * c * c);
    let yy = size / (4.0 * s * s);
    let xy = size / (2.0 * c * s);
    std::array::from_fn(|k| {
        let combination = |k: usize, at: usize| {
            let (outer, inner) = (gamma[at] + epsilon[at], delta[at]);
            let (p, r) = (xx * (outer + inner), yy * (outer - inner));
            match k {
                0 => 0.5 * (p + r),
                1 => 0.5 * (p - r),
                _ => 0.5 * xy * (epsilon[at] - gamma[at]),
            }
        };
        [0, 1, 2].map(|at| combination(k, at))
    })
}
