//! The surface around one extraordinary point: rings of patches at any depth.
//!
//! Sector `s` is the map (a,b) -> space on the unit square, a along line s-1, b along line s.
//! It is cut into L-shaped pieces, one per ring:
//!
//! ```text
//!  b ^
//!  1 +-------+---+---+   ring l = 0, 1, 2, ... covers 2^-(l+1) < max(a,b) <= 2^-l
//!    |       |       |   with three patches or more; for contractions other than
//!    |       | ring 0|   Catmull-Clark's some sigma takes the place of 1/2
//! .5 +---+---+       +
//!    | r 1   |       |
//!    +-+-+   |       |
//!    |_|_|___|_______|--> a
//!    0      .5       1
//! ```
//!
//! **Accuracy at depth.** All nets of a scheme shrink towards the limit point c_0: the extent
//! in the tangent plane by lambda per ring, the height above it by about lambda^2. In world
//! coordinates curvature would drown in rounding after some twenty rings. Therefore nets are
//! kept in a frame of the limit tangent plane at c_0, the plane coordinates divided by
//! lambda^l and the height by lambda^(2 l):
//!
//! ```text
//!   point = c_0 + F (sigma X, sigma Y, sigma zeta Z),   sigma = zeta = lambda^l.
//! ```
//!
//! X, Y, Z stay of the same size for ever, the factors cancel in the curvatures, and ring 1000 is
//! as exact as ring 1. Only one thing needs care: rounding brings a part that shrinks by lambda
//! into Z. Every step removes it.
//!
//! Primvars of N numbers have the same rings. Their first three numbers are taken as a point in
//! space; a fourth has no frame and shrinks by lambda.

mod depth;
mod frame;
mod grid;

pub(crate) use depth::{in_ring, power, ring_of, scaled_up};
pub(crate) use grid::for_each_pair;

use std::sync::{Arc, OnceLock};

use crate::net::{CNet, DNet, Expansion, Fan, Quadratic};
use crate::patch::kernel::patch_jet;
use crate::patch::{Answer, Jet, Patch, Shape, SurfacePoint};
use crate::point::{Vector, add, in_space, scale, sub};
use crate::scheme::{
    FairFan, FanLimit, PatchParameters, Rules, SchemeKind, Subdominant, Variant, fair_rules,
    fan_rules,
};
use frame::{Frame, HEIGHT, RingScale, frame_shape};

/// The rules of a scheme at one valence with their eigenstructure. All points of that valence
/// share them.
#[derive(Clone, Debug)]
pub(crate) struct ValenceRules {
    family: Family,
    rules: Rules,
    subdominant: Subdominant,
}

/// What rules belong to.
#[derive(Clone, Debug)]
enum Family {
    /// A scheme, all around a point.
    Scheme(SchemeKind),
    /// Catmull-Clark's rules of a fan between sharp edges.
    Fan(FanLimit),
    /// The fair rules of a fan on one side of a crease.
    FairFan(FanLimit),
}

impl ValenceRules {
    /// `None` if the scheme has no rules for this valence.
    pub(crate) fn new(kind: SchemeKind, variant: Variant, valence: usize) -> Option<Self> {
        let rules = kind.rules(variant, valence)?;
        let subdominant = Subdominant::new(&rules);
        Some(Self { family: Family::Scheme(kind), rules, subdominant })
    }

    /// Catmull-Clark's rules of a fan.
    pub(crate) fn of_fan(shape: Fan) -> Self {
        let (rules, limit) = fan_rules(shape);
        let subdominant = Subdominant::without_plane(&rules, limit.lambda);
        Self { family: Family::Fan(limit), rules, subdominant }
    }

    /// The fair rules of a fan on one side of a crease; `None` if there are none.
    pub(crate) fn of_fair_fan(shape: Fan) -> Option<Self> {
        let FairFan { rules, limit, subdominant } = fair_rules(shape)?.clone();
        Some(Self { family: Family::FairFan(limit), rules, subdominant })
    }

    /// Whether they are the fair rules of a fan on one side of a crease.
    pub(crate) fn is_fair_fan(&self) -> bool {
        matches!(self.family, Family::FairFan(_))
    }

    /// The limit point and tangent plane of a fan between sharp edges.
    pub(crate) fn fan_limit(&self) -> Option<&FanLimit> {
        match &self.family {
            Family::Scheme(_) => None,
            Family::Fan(limit) | Family::FairFan(limit) => Some(limit),
        }
    }

    /// The scheme; fans count as Catmull-Clark.
    pub(crate) fn kind(&self) -> SchemeKind {
        match self.family {
            Family::Scheme(kind) => kind,
            Family::Fan(_) | Family::FairFan(_) => SchemeKind::CatmullClark,
        }
    }

    pub(crate) fn rules(&self) -> &Rules {
        &self.rules
    }

    /// The number of weights in all rows, a measure of the memory that the rules take.
    pub(crate) fn num_weights(&self) -> usize {
        let rules = &self.rules;
        let patches = rules.patches.iter().flat_map(|rule| rule.old.iter().chain(&rule.new));
        rules.refine.iter().chain(patches).map(Vec::len).sum()
    }

    pub(crate) fn subdominant(&self) -> &Subdominant {
        &self.subdominant
    }
}

/// The surface around one extraordinary point.
///
/// ```
/// use evenlight::{RuleSet, SchemeKind};
/// use evenlight::rings::Rings;
/// use evenlight::net::DNet;
///
/// // A flat d-net of valence 5, all nodes at the origin but for one: c_0 follows by eq. (4).
/// let mut net = DNet { sectors: vec![[[0.0; 3]; 12]; 5] };
/// net.sectors[0][11] = [0.0, 0.0, 1.0];
/// let rings = Rings::from_dnet(&net, SchemeKind::EvolvingGuide, RuleSet::Generated).unwrap();
/// assert_eq!(rings.valence(), 5);
/// assert_eq!(rings.patches(0).map(|ring| ring.len()), Some(15));
/// ```
#[derive(Debug)]
pub struct Rings<const N: usize = 3> {
    rules: Arc<ValenceRules>,
    center: [f64; N],
    /// The normal at the limit point, or NaN.
    normal: Vector,
    quadratic: Option<Quadratic<N>>,
    frame: Frame<N>,
    /// The net in front of ring 0, in the frame.
    first: Vec<[f64; N]>,
    cached: [OnceLock<Box<Ring<N>>>; CACHED_RINGS],
}

/// Rings can be asked for by the numbers from 0 up to this one, excluded. A later ring is smaller
/// than the least `f64`, whatever the contraction.
pub const MAX_RINGS: usize = 4096;

/// This many rings are kept once they were asked for. Deeper rings, closer to the centre than
/// 2^-64 (sigma^64), are made anew from the last kept ring, in time proportional to the depth.
pub(crate) const CACHED_RINGS: usize = 64;

/// The BB coefficients of patches, one after the other.
type Coefs<const N: usize> = Box<[[f64; N]]>;

/// One ring in frame coordinates, scaled as the module says.
#[derive(Debug)]
struct Ring<const N: usize> {
    /// The BB coefficients of the patches of each sector, made when it is first evaluated: they
    /// take most of the memory.
    sectors: Box<[OnceLock<Coefs<N>>]>,
    /// The net in front of the next ring, in its own scale.
    next: Vec<[f64; N]>,
    scale: RingScale<N>,
}

impl Rings {
    /// Position, derivatives by a and b, normal and curvature at (a,b) of sector `s`.
    ///
    /// `None` if `s` is not below the valence or a, b are not from 0 to 1.
    ///
    /// At (0,0) the position is the limit point and the normal the limit normal; derivatives are
    /// NaN there, curvature is [`Rings::center_curvature`] or NaN. Elsewhere curvature is exact to
    /// rounding at any depth. Derivatives are in world coordinates; beyond ring 500 or so the
    /// second derivatives may exceed the range of f64.
    pub fn eval(&self, s: usize, a: f64, b: f64) -> Option<SurfacePoint> {
        let is_inside = [a, b].iter().all(|x| (0.0..=1.0).contains(x));
        (s < self.valence() && is_inside).then(|| self.eval_as(s, a, b))
    }

    /// Like [`Rings::eval`], but from a given patch, numbered as in [`Rings::patch_domain`]; the
    /// polynomial is extrapolated if (a,b) is not in the patch. `None` if there is no such patch,
    /// or a or b is NaN.
    pub fn eval_on(
        &self,
        ring: usize,
        s: usize,
        which: usize,
        a: f64,
        b: f64,
    ) -> Option<SurfacePoint> {
        let is_known = self.has_patch(ring, s, which) && !a.is_nan() && !b.is_nan();
        is_known.then(|| self.eval_on_as(ring, s, which, [a, b]))
    }
}

impl<const N: usize> Rings<N> {
    /// The surface over a c-net; `None` if the scheme has no rules for its valence.
    pub fn from_cnet(
        cnet: &CNet<N>,
        kind: SchemeKind,
        variant: impl Into<Variant>,
    ) -> Option<Self> {
        let rules = Arc::new(ValenceRules::new(kind, variant.into(), cnet.valence())?);
        Some(Self::with_rules(cnet, rules))
    }

    /// The surface over a d-net with c_0 by [`DNet::center`]; `None` if the scheme has no rules
    /// for its valence or does not work on d-nets.
    pub fn from_dnet(
        dnet: &DNet<N>,
        kind: SchemeKind,
        variant: impl Into<Variant>,
    ) -> Option<Self> {
        let rules = Arc::new(ValenceRules::new(kind, variant.into(), dnet.valence())?);
        let center = dnet.center(kind.spline()?)?;
        let net: Vec<[f64; N]> = dnet.sectors.iter().flatten().map(|&p| sub(p, center)).collect();
        Some(Self::start(&net, center, None, rules))
    }

    /// The same surface with another quadratic q at the centre, whose point q_1 becomes the
    /// limit point; `None` if the scheme has no quadratic.
    ///
    /// The control net, and so the outer border up to second derivatives, stays as it is.
    pub fn with_quadratic(&self, q: &Quadratic<N>) -> Option<Self> {
        let rules = &self.rules.rules;
        rules.quadratic.as_ref()?;
        let control = rules.control_nodes_per_sector();
        let sectors = self.first.chunks(rules.nodes_per_sector);
        let moved: Vec<[f64; N]> = sectors
            .flat_map(|sector| &sector[..control])
            .map(|&p| sub(add(self.center, self.frame.world(p)), q.center()))
            .collect();
        Some(Self::start(&moved, q.center(), Some(q.expansion()), self.rules.clone()))
    }

    pub(crate) fn with_rules(cnet: &CNet<N>, rules: Arc<ValenceRules>) -> Self {
        let center = rules.kind().limit_point(cnet);
        let cnet = cnet.relative_to(center);
        let net = rules.rules.guided_net(&cnet).unwrap_or_else(|| rules.kind().net(&cnet));
        Self::start(&net, center, None, rules)
    }

    /// The surface over the net of a fan: two nodes on every line, four in every sector, the
    /// vertex.
    pub(crate) fn over_fan(net: &[[f64; N]], rules: Arc<ValenceRules>) -> Option<Self> {
        let limit = rules.fan_limit()?;
        let center = limit.limit_point(net);
        let in_space: Vec<Vector> = net.iter().map(|&p| in_space(p)).collect();
        let normal = limit.normal(&in_space);
        let mut rings = Self::start(&limit.first_net(net), center, None, rules.clone());
        rings.normal = normal.unwrap_or(rings.normal);
        Some(rings)
    }

    /// The surface of a control net relative to its limit point `center`, with the given or the
    /// default quadratic if the scheme has one.
    fn start(
        net: &[[f64; N]],
        center: [f64; N],
        q: Option<Expansion<N>>,
        rules: Arc<ValenceRules>,
    ) -> Self {
        let q = rules.rules.default_quadratic(net).map(|default| q.unwrap_or(default));
        let net = match q {
            Some(q) => rules.rules.with_quadratic(net, q),
            None => net.to_vec(),
        };
        let frame = Frame::new(&rules.subdominant, &net);
        let mut first: Vec<[f64; N]> = net.iter().map(|&p| frame.coordinates(p)).collect();
        if frame.has_height() {
            rules.subdominant.remove_from_coordinate(HEIGHT, &mut first);
        }
        let quadratic = q.map(|q| Quadratic::from_expansion(center, q));
        let cached = [const { OnceLock::new() }; CACHED_RINGS];
        let normal = frame.normal();
        Self { rules, center, normal, quadratic, frame, first, cached }
    }

    /// The rings of a net relative to its limit point, whose coordinates are N independent numbers.
    /// There is no tangent plane, so all numbers shrink by lambda.
    pub(crate) fn over_numbers(first: Vec<[f64; N]>, rules: Arc<ValenceRules>) -> Self {
        let frame = Frame::WORLD;
        let cached = [const { OnceLock::new() }; CACHED_RINGS];
        let (center, normal) = ([0.0; N], [f64::NAN; 3]);
        Self { rules, center, normal, quadratic: None, frame, first, cached }
    }

    /// The number of sectors: the valence, or for a fan the number of its faces.
    pub fn valence(&self) -> usize {
        self.rules.rules.valence
    }

    /// The factor by which the rings shrink: the subdominant eigenvalue of the scheme.
    pub fn lambda(&self) -> f64 {
        self.rules.subdominant.lambda
    }

    /// The factor by which the parameters of the rings shrink: 1/2 with Catmull-Clark's
    /// contraction, else sigma.
    pub fn sigma(&self) -> f64 {
        self.rules.rules.sigma()
    }

    /// The limit point c_0.
    pub fn center(&self) -> [f64; N] {
        self.center
    }

    /// The quadratic at the centre, for schemes that have one.
    pub fn quadratic(&self) -> Option<&Quadratic<N>> {
        self.quadratic.as_ref()
    }

    /// The unit normal at the limit point; NaN if there is no tangent plane. For primvars it is the
    /// normal of their first three numbers.
    pub fn normal(&self) -> Vector {
        self.normal
    }

    /// The number of patches in each sector of a ring.
    pub fn patches_per_sector(&self) -> usize {
        self.rules.rules.patches_per_sector()
    }

    /// The part [[a0, a1], [b0, b1]] of a sector that patch `which` of ring 0 covers; in ring l
    /// it is sigma^l as large. The patch's own parameters run the same way. `None` if there is no
    /// such patch.
    ///
    /// With s = sigma patches lie in three squares, \[s,1\] x \[s,1\], \[s,1\] x \[0,s\] and
    /// \[0,s\] x \[s,1\]. Each square has one patch, 2 x 2 or 3 x 3; the index along b is fastest.
    pub fn patch_domain(&self, which: usize) -> Option<[[f64; 2]; 2]> {
        (which < self.patches_per_sector()).then(|| self.rules.rules.patch_domain(which))
    }

    /// All patches of ring `ring` (from 0), sector by sector; `None` if it is not below
    /// [`MAX_RINGS`].
    pub fn patches(&self, ring: usize) -> Option<Vec<Patch<N>>> {
        let all = || self.frame_patches(ring).iter().map(|p| self.to_world(ring, p)).collect();
        (ring < MAX_RINGS).then(all)
    }

    /// Patch `which` of sector `s` of ring `ring`; `None` if there is no such patch.
    pub fn patch(&self, ring: usize, s: usize, which: usize) -> Option<Patch<N>> {
        self.has_patch(ring, s, which).then(|| self.patch_at(ring, s, which))
    }

    /// Whether there is such a patch.
    fn has_patch(&self, ring: usize, s: usize, which: usize) -> bool {
        ring < MAX_RINGS && s < self.valence() && which < self.patches_per_sector()
    }

    /// [`Rings::patch`] for a patch that is known to exist.
    pub(crate) fn patch_at(&self, ring: usize, s: usize, which: usize) -> Patch<N> {
        self.with_ring(ring, |net, r| {
            let mut coefs = self.coefs(net, r, s, which);
            coefs.iter_mut().for_each(|p| *p = add(self.center, r.scale.world(r.scale.sigma, *p)));
            Patch::of([self.rules.rules.degree; 2], coefs)
        })
    }

    /// [`Rings::eval`] for any [`Answer`], in a sector that is known to exist.
    #[inline]
    pub(crate) fn eval_as<A: Answer<N>>(&self, s: usize, a: f64, b: f64) -> A {
        debug_assert!(s < self.valence() && (0.0..=1.0).contains(&a) && (0.0..=1.0).contains(&b));
        if a.max(b) == 0.0 {
            return self.at_center();
        }
        let (ring, at) = in_ring([a, b], self.sigma());
        let place = self.rules.rules.locate(at);
        self.eval_in_patch(ring, s, place)
    }

    /// [`Rings::eval_on`] for any [`Answer`], on a patch that is known to exist.
    pub(crate) fn eval_on_as<A: Answer<N>>(
        &self,
        ring: usize,
        s: usize,
        which: usize,
        [a, b]: [f64; 2],
    ) -> A {
        let ([a0, b0], size) = self.rules.rules.patch_square(which);
        let [a, b] = self.in_hole(ring, [a, b]);
        let at = [(a - a0) / size[0], (b - b0) / size[1]];
        self.eval_in_patch(ring, s, PatchParameters { which, at, size })
    }

    /// Turns parameters of a sector into parameters of the hole in front of ring `ring`, where the
    /// hole is the unit square.
    pub(crate) fn in_hole(&self, ring: usize, at: [f64; 2]) -> [f64; 2] {
        at.map(|x| scaled_up(x, ring, self.sigma()))
    }

    /// The inverse of [`Rings::in_hole`].
    pub(crate) fn out_of_hole(&self, ring: usize, at: [f64; 2]) -> [f64; 2] {
        at.map(|x| (0..ring).fold(x, |x, _| self.sigma() * x))
    }

    /// A place in a patch of sector `s`, its size as in ring 0.
    #[inline]
    fn eval_in_patch<A: Answer<N>>(&self, ring: usize, s: usize, place: PatchParameters) -> A {
        let PatchParameters { which, at, size } = place;
        let mut deep = None;
        let (scale, coefs) = self.scale_and_coefs(ring, s, which, &mut deep);
        let jet = patch_jet(A::ORDER, self.rules.rules.degree, coefs, at);
        self.placed(scale, size, &jet)
    }

    /// The scale and the BB coefficients of a patch; those of rings that are not kept are put in
    /// `deep`.
    #[inline]
    fn scale_and_coefs<'a>(
        &'a self,
        ring: usize,
        s: usize,
        which: usize,
        deep: &'a mut Option<(RingScale<N>, Vec<[f64; N]>)>,
    ) -> (&'a RingScale<N>, &'a [[f64; N]]) {
        if ring >= CACHED_RINGS {
            let (scale, coefs) = deep.insert(self.deep_coefs(ring, s, which));
            return (scale, coefs);
        }
        let r = self.cached_ring(ring);
        let coefs = r.sectors[s].get_or_init(|| self.coefs_of_sector(ring, s));
        let per_patch = (self.rules.rules.degree + 1) * (self.rules.rules.degree + 1);
        (&r.scale, &coefs[which * per_patch..][..per_patch])
    }

    /// The scale and the coefficients of a patch of a ring that is not kept.
    #[cold]
    fn deep_coefs(&self, ring: usize, s: usize, which: usize) -> (RingScale<N>, Vec<[f64; N]>) {
        self.with_ring(ring, |net, r| (r.scale, self.coefs(net, r, s, which)))
    }

    /// The coefficients of all patches of a sector of a ring that is kept.
    #[cold]
    fn coefs_of_sector(&self, ring: usize, s: usize) -> Coefs<N> {
        let (net, r) = (self.net_in_front(ring), self.cached_ring(ring));
        let mut coefs = Vec::new();
        for which in 0..self.patches_per_sector() {
            coefs.extend_from_slice(&self.coefs(net, r, s, which));
        }
        coefs.into()
    }

    fn at_center<A: Answer<N>>(&self) -> A {
        let jet = Jet { p: self.center, ..<Jet<N> as Answer<N>>::NAN };
        A::from_parts(jet, |_| {
            let (gauss, mean) = self.center_curvature().unwrap_or((f64::NAN, f64::NAN));
            Shape { normal: self.normal(), gauss, mean }
        })
    }

    /// K and H at the limit point: the curvatures of q or of the guide, if the scheme has one and
    /// there is a tangent plane. Otherwise curvature has no limit (it grows, or oscillates, from
    /// ring to ring).
    ///
    /// With `guided6` curvature is continuous: these are its limits. With other schemes it varies
    /// with the direction around the centre, within a band around these values that does not
    /// shrink: bounded curvature is not continuous curvature.
    pub fn center_curvature(&self) -> Option<(f64, f64)> {
        let [du, dv, uu, duv, vv] = self.expansion().filter(|_| self.frame.has_plane)?;
        let jet = Jet { p: self.center, du, dv, duu: scale(2.0, uu), duv, dvv: scale(2.0, vv) };
        let Shape { gauss, mean, .. } = jet.shape();
        Some((gauss, mean))
    }

    /// The expansion of q or of the guide in sector 0, in world coordinates.
    fn expansion(&self) -> Option<Expansion<N>> {
        if self.rules.rules.guide.is_none() {
            return self.quadratic.map(|q| q.expansion());
        }
        let first = self.rules.rules.control_nodes_per_sector();
        let world = |k: usize| self.frame.world(self.first[first + k]);
        Some([0, 1, 2, 3, 4].map(world))
    }

    /// The rules, shared by all points of this valence.
    pub(crate) fn rules(&self) -> &ValenceRules {
        &self.rules
    }

    /// The net in front of ring `ring`, in the frame and scaled like that ring.
    pub(crate) fn net(&self, ring: usize) -> Vec<[f64; N]> {
        self.with_ring(ring, |net, _| net.to_vec())
    }

    /// All patches of ring `ring` in the frame, scaled like that ring.
    pub(crate) fn frame_patches(&self, ring: usize) -> Vec<Patch<N>> {
        let all = |net: &[[f64; N]], r: &Ring<N>| {
            let per_sector = self.patches_per_sector();
            let numbers = 0..per_sector * self.valence();
            let patch = |k: usize| self.frame_patch(net, r, k / per_sector, k % per_sector);
            numbers.map(patch).collect()
        };
        self.with_ring(ring, all)
    }

    /// Patch `which` of sector `s` of the ring behind `net`.
    fn frame_patch(&self, net: &[[f64; N]], ring: &Ring<N>, s: usize, which: usize) -> Patch<N> {
        Patch::of([self.rules.rules.degree; 2], self.coefs(net, ring, s, which))
    }

    /// The BB coefficients of patch `which` of sector `s` of the ring behind `net`.
    fn coefs(&self, net: &[[f64; N]], ring: &Ring<N>, s: usize, which: usize) -> Vec<[f64; N]> {
        // Both nets in the scale of `net`.
        let next = (&ring.next[..], self.shrinkage());
        self.rules.rules.patch_of_scaled(s, which, net, next)
    }

    /// Turns a jet of ring `ring` in patch parameters and frame coordinates into a point of the
    /// surface in (a,b). The size is the size of the patch in ring 0.
    pub(crate) fn in_world<A: Answer<N>>(&self, ring: usize, size: [f64; 2], jet: &Jet<N>) -> A {
        self.placed(&self.ring_scale(ring), size, jet)
    }

    #[inline]
    fn placed<A: Answer<N>>(&self, scale: &RingScale<N>, [u, v]: [f64; 2], jet: &Jet<N>) -> A {
        let RingScale { sigma, first, second, .. } = *scale;
        let mut found = Jet { p: add(self.center, scale.world(sigma, jet.p)), ..Jet::default() };
        if A::ORDER >= 1 {
            found.du = scale.world(first / u, jet.du);
            found.dv = scale.world(first / v, jet.dv);
        }
        if A::ORDER >= 2 {
            found.duu = scale.world(second / (u * u), jet.duu);
            found.duv = scale.world(second / (u * v), jet.duv);
            found.dvv = scale.world(second / (v * v), jet.dvv);
        }
        A::from_parts(found, |_| {
            let shape = frame_shape(jet, sigma, scale.zeta);
            Shape { normal: self.frame.direction(shape.normal), ..shape }
        })
    }

    fn ring_scale(&self, ring: usize) -> RingScale<N> {
        let (lambda, step) = (self.lambda(), self.sigma());
        let sigma = power(lambda, ring);
        let zeta = if self.frame.has_height() { sigma } else { 1.0 };
        let mut axes = self.frame.axes;
        if let Some(height) = axes.get_mut(HEIGHT) {
            *height = scale(zeta, *height);
        }
        RingScale {
            axes,
            zeta,
            sigma,
            // A patch parameter runs step^-ring / size times as fast as a and b.
            first: power(lambda / step, ring),
            second: power(lambda / (step * step), ring),
        }
    }

    /// A patch of ring `ring` in world coordinates.
    pub(crate) fn to_world(&self, ring: usize, patch: &Patch<N>) -> Patch<N> {
        let scale = self.ring_scale(ring);
        let point = |&r: &[f64; N]| add(self.center, scale.world(scale.sigma, r));
        Patch::of(patch.degree(), patch.coefs().iter().map(point).collect())
    }

    /// Calls `f` with the net in front of ring `ring` and the ring.
    fn with_ring<T>(&self, ring: usize, f: impl FnOnce(&[[f64; N]], &Ring<N>) -> T) -> T {
        if ring < CACHED_RINGS {
            return f(self.net_in_front(ring), self.cached_ring(ring));
        }
        let mut net = self.cached_ring(CACHED_RINGS - 1).next.clone();
        for _ in CACHED_RINGS..ring {
            net = self.normalised(self.rules.rules.refine(&net));
        }
        f(&net, &self.ring_from(ring, &net))
    }

    /// The net in front of a kept ring.
    fn net_in_front(&self, ring: usize) -> &[[f64; N]] {
        if ring == 0 { &self.first } else { &self.cached_ring(ring - 1).next }
    }

    #[inline]
    fn cached_ring(&self, ring: usize) -> &Ring<N> {
        self.cached[ring].get_or_init(|| Box::new(self.ring_from(ring, self.net_in_front(ring))))
    }

    /// The ring behind `net`, and the net behind it.
    fn ring_from(&self, ring: usize, net: &[[f64; N]]) -> Ring<N> {
        let next = self.normalised(self.rules.rules.refine(net));
        let sectors = std::iter::repeat_with(OnceLock::new).take(self.valence()).collect();
        Ring { sectors, next, scale: self.ring_scale(ring) }
    }

    /// The factors by which the coordinates of a net become smaller from ring to ring.
    fn shrinkage(&self) -> [f64; N] {
        let lambda = self.lambda();
        let mut factors = [lambda; N];
        if self.frame.has_height() {
            factors[HEIGHT] = lambda * lambda;
        }
        factors
    }

    /// A refined net in its own scale.
    fn normalised(&self, mut net: Vec<[f64; N]>) -> Vec<[f64; N]> {
        let factors = self.shrinkage();
        for p in &mut net {
            for k in 0..N {
                p[k] /= factors[k];
            }
        }
        if self.frame.has_height() {
            self.rules.subdominant.remove_from_coordinate(HEIGHT, &mut net);
        }
        net
    }
}
