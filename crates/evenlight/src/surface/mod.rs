//! The surface as an object: position, derivatives and curvature at any (face, u, v).
//!
//! Every quad of the cage is one *parametric quad*, (u,v) in the unit square; an n-gon is n of
//! them, one per corner:
//!
//! ```text
//!  d (0,1) --- c (1,1)            quad k of an n-gon: (0,0) is corner k, u runs towards
//!     |           |               corner k+1 (half of that edge), v towards corner k-1,
//!     |  (u,v)    |               (1,1) is the face's centre.
//!     |           |
//!  a (0,0) --- b (1,0)
//! ```
//!
//! A parametric quad is one bi-3 patch, one sector of an extraordinary point, or four smaller
//! pieces ([`isolation`](crate::mesh::isolation)). Evaluation finds the piece and its own
//! parameters; all pieces are parts of one surface.

mod build;
mod caps;
mod eval;
mod grid;
mod place;
mod primvar;
mod rule;

pub use build::SurfaceError;
pub use place::{PatchPlace, PlacedPatch, Role};
pub(crate) use place::{RingPatch, Source, quadrant, to_sector};
pub use primvar::PrimvarJet;
pub use rule::{PointRule, Reason};

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use crate::mesh::isolation::{Piece, Plan};
use crate::mesh::sharpness::Beyond;
use crate::mesh::{BoundaryRule, Cage, FaceId, Fan, HalfEdgeId, INFINITELY_SHARP, VertexId};
use crate::net::Quadratic;
use crate::patch::basis::{CUBIC_B_SPLINE_TO_BB, cubic_b_spline};
use crate::patch::kernel::{square, sum, sum_of_rows, tensor_jet};
use crate::patch::{Answer, Jet, Patch, SurfacePoint};
use crate::point::{Point, Vector};
use crate::rings::Rings;
use crate::scheme::{Contraction, RuleSet, SchemeKind, Variant};
use build::{describe, refined_positions, rings, rules_of_points};
use caps::Caps;
use place::{Square, from_sector, ring_domain, turned_patch};

/// The number of a parametric quad: all quads of face 0, then of face 1, and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct QuadId(pub u32);

/// How a surface is built; by default with `qas4` at full precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceOptions {
    /// The scheme at extraordinary points.
    pub scheme: SchemeKind,
    /// The tables of that scheme.
    pub rules: RuleSet,
    /// How fast its rings contract.
    pub contraction: Contraction,
    /// The rule at the boundary; `None` for that of the cage's tags.
    pub boundary: Option<BoundaryRule>,
    /// The rings beside infinitely sharp creases and the boundary.
    pub creases: CreaseRings,
}

/// The rings of a vertex on an infinitely sharp crease or the boundary, of which the faces on one
/// side are not two.
///
/// The curve of the crease is the same with both, the cubic spline of its vertices, and so is all of the
/// surface but for these points. Darts, corners and semi-sharp features keep Catmull-Clark's rules.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CreaseRings {
    /// Catmull-Clark's \[CC78\], \[DKT98\], as in OpenSubdiv: without a tangent plane from four faces
    /// on, and with curvature that grows without bounds.
    #[default]
    CatmullClark,
    /// Fairness-optimal rings, ours: tangent plane and bounded curvature for 1 to
    /// [`MAX_FAIR_FACES`](crate::scheme::MAX_FAIR_FACES) faces; Catmull-Clark's for more.
    Fair,
}

impl SurfaceOptions {
    /// Which rules of the scheme are taken.
    pub fn variant(&self) -> Variant {
        Variant { rules: self.rules, contraction: self.contraction }
    }
}

/// A subdivision surface over a cage.
#[derive(Debug)]
pub struct Surface {
    cage: Arc<Cage>,
    options: SurfaceOptions,
    plan: Plan,
    /// The positions of the refined levels.
    refined: Vec<Vec<Point>>,
    /// The rings around every extraordinary point.
    rings: Vec<Rings>,
    points: Vec<ExtraordinaryPoint>,
    /// What closes the holes behind some rings.
    caps: Option<Caps>,
    /// The primvars, built when first asked for.
    channels: Vec<OnceLock<primvar::Channel>>,
}

/// An extraordinary point of the surface: an interior vertex of valence other than 4, the centre of
/// an n-gon, or a vertex on sharp edges or the boundary that is not regular there.
#[derive(Clone, Debug)]
pub struct ExtraordinaryPoint {
    /// The vertex of the cage; `None` for the centre of an n-gon.
    pub vertex: Option<VertexId>,
    /// The n-gon whose centre this is; `None` for a vertex.
    pub face: Option<FaceId>,
    /// The number of edges that meet here.
    pub valence: usize,
    /// The faces that it concerns: all around, or those between two sharp edges. A vertex with
    /// sharp edges is as many points as it has irregular fans.
    pub fan: Fan,
    /// The rule that it gets, and why.
    pub rule: PointRule,
    /// The level of Catmull-Clark refinement at which it is isolated: 0 to 2, more where something
    /// is semi-sharp.
    pub level: usize,
    /// The limit point.
    pub position: Point,
    /// The limit normal; NaN if there is no tangent plane.
    pub normal: Vector,
    /// The sectors counter-clockwise, without those in omitted faces.
    pub sectors: Vec<Sector>,
}

/// The piece of a parametric quad that belongs to an extraordinary point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sector {
    /// The number of the sector around its point.
    pub index: usize,
    /// The parametric quad.
    pub quad: QuadId,
    /// The parameters of the extraordinary point in that quad.
    pub center: [f64; 2],
    /// The parameter steps from the centre to the ends of the sector's two lines:
    /// `center + a * along[0] + b * along[1]` with a and b from 0 to 1 covers the sector.
    pub along: [[f64; 2]; 2],
}

impl Surface {
    /// Builds the surface over `cage`.
    ///
    /// Time and memory are linear in the number of faces; rings are made when they are first
    /// asked for.
    ///
    /// # Errors
    ///
    /// [`SurfaceError::NoRules`] if more than 1024 faces meet at a point; where the scheme has no
    /// rules, the point gets Catmull-Clark's ([`ExtraordinaryPoint::rule`]).
    /// [`SurfaceError::Contraction`] if the scheme has no such contraction
    /// ([`SchemeKind::check_contraction`]).
    pub fn build(
        cage: impl Into<Arc<Cage>>,
        options: SurfaceOptions,
    ) -> Result<Self, SurfaceError> {
        Self::build_channel(cage.into(), options, BTreeMap::new())
    }

    /// The surface over the net of a channel; `beyond` are the edges beyond its seams.
    fn build_channel(
        cage: Arc<Cage>,
        options: SurfaceOptions,
        beyond: BTreeMap<VertexId, Beyond>,
    ) -> Result<Self, SurfaceError> {
        let boundary = options.boundary.unwrap_or(cage.tags().boundary);
        let plan = Plan::new(&cage, boundary, beyond);
        let rules = rules_of_points(&cage, &plan, options)?;
        let refined = refined_positions(&cage, &plan);
        let around = |(p, (_, rules)): (usize, &(_, _))| rings(&cage, &plan, &refined, p, rules);
        let rings: Vec<Rings> = rules.iter().enumerate().map(around).collect();
        let of_point = |(p, rings)| describe(&plan, p, rules[p].0, rings);
        let points = rings.iter().enumerate().map(of_point).collect();
        let channels = primvar::unbuilt(&cage);
        Ok(Self { cage, options, plan, refined, rings, points, caps: None, channels })
    }

    /// The cage.
    pub fn cage(&self) -> &Cage {
        &self.cage
    }

    /// What covers its faces.
    pub(crate) fn plan(&self) -> &Plan {
        &self.plan
    }

    /// How it was built.
    pub fn options(&self) -> SurfaceOptions {
        self.options
    }

    /// The number of parametric quads, omitted ones included.
    pub fn num_quads(&self) -> usize {
        self.plan.first_quads.last().map_or(0, |&n| n as usize)
    }

    /// The parametric quad at `corner` of `face`; for a face with four corners the corner must
    /// be 0. `None` if there is no such face or corner.
    pub fn quad(&self, face: FaceId, corner: usize) -> Option<QuadId> {
        let first = *self.plan.first_quads.get(face.index())?;
        let end = *self.plan.first_quads.get(face.index() + 1)?;
        let quad = u32::try_from(corner).ok().and_then(|k| first.checked_add(k))?;
        (quad < end).then_some(QuadId(quad))
    }

    /// The face of `quad`, and the corner if the face is an n-gon (else 0).
    ///
    /// # Panics
    ///
    /// If there is no such quad.
    pub fn face_of(&self, quad: QuadId) -> (FaceId, usize) {
        assert!((quad.0 as usize) < self.num_quads(), "there is no quad {}", quad.0);
        let face = self.plan.first_quads.partition_point(|&first| first <= quad.0) - 1;
        (FaceId(face as u32), (quad.0 - self.plan.first_quads[face]) as usize)
    }

    /// Whether there is no surface over `face`: a hole, or at the boundary under the rule "none".
    pub fn is_omitted(&self, face: FaceId) -> bool {
        self.plan.omitted.binary_search(&face).is_ok()
    }

    /// Whether the surface may have a fold along an edge of the cage: it is infinitely sharp or on
    /// the boundary.
    pub fn is_infinitely_sharp(&self, h: HalfEdgeId) -> bool {
        self.plan.sharpness[0].edge(self.cage.topology(), h) >= INFINITELY_SHARP
            || self.cage.topology().twin(h).is_none()
    }

    /// The faces without a surface, in order.
    pub fn omitted_faces(&self) -> &[FaceId] {
        &self.plan.omitted
    }

    /// The extraordinary points that have a surface around them.
    pub fn extraordinary_points(&self) -> &[ExtraordinaryPoint] {
        &self.points
    }

    /// The rings around an extraordinary point, by its index.
    pub fn rings(&self, point: usize) -> &Rings {
        &self.rings[point]
    }

    /// Replaces the quadratic q of an extraordinary point, by its index; `false` if the scheme has
    /// no quadratics.
    ///
    /// # Panics
    ///
    /// If there is no such point.
    pub fn set_quadratic(&mut self, point: usize, q: &Quadratic) -> bool {
        let Some(rings) = self.rings[point].with_quadratic(q) else { return false };
        self.points[point].position = rings.center();
        self.points[point].normal = rings.normal();
        self.rings[point] = rings;
        if let Some(caps) = &mut self.caps {
            caps.forget(point);
        }
        true
    }

    /// Position, derivatives, normal and curvature at (u,v) of `quad`, which are clamped to
    /// 0..1; `None` if the face is omitted, there is no such quad or a parameter is NaN.
    ///
    /// At an extraordinary point itself, unless a cap is there, the position is the limit point and the
    /// normal the limit normal; derivatives do not exist there and are NaN, nor does curvature but for
    /// schemes with a quadratic or a guide, where it is that of q or of the guide
    /// ([`Rings::center_curvature`]). Anywhere else, however near, all are exact to rounding
    /// ([`Rings::eval`]).
    pub fn eval(&self, quad: QuadId, u: f64, v: f64) -> Option<SurfacePoint> {
        self.eval_as(quad, u, v)
    }

    /// A sector of an extraordinary point at its own parameters.
    #[inline]
    fn eval_around<A: Answer>(&self, point: usize, sector: usize, at: [f64; 2]) -> A {
        let rings = &self.rings[point];
        if let Some(cap) = self.cap(point) {
            let in_hole = rings.in_hole(cap.rings(), at);
            if in_hole[0].max(in_hole[1]) <= 1.0 {
                return cap.eval_as(rings, sector, in_hole);
            }
        }
        rings.eval_as(sector, at[0], at[1])
    }

    /// All regular patches and the rings 1 to `rings` of every extraordinary point, quad by
    /// quad; of a closed surface no more rings than it has, and if it is all of them the caps.
    pub fn patches(&self, rings: usize) -> impl Iterator<Item = PlacedPatch> + '_ {
        self.patch_places(rings).map(|place| {
            let PatchPlace { role, quad, domain, point, sector, .. } = place;
            PlacedPatch { role, quad, domain, point, sector, patch: self.patch(&place) }
        })
    }

    /// Where the patches of [`Surface::patches`] lie.
    pub fn patch_places(&self, rings: usize) -> impl Iterator<Item = PatchPlace> + '_ {
        (0..self.num_quads() as u32).flat_map(move |quad| {
            let mut places = Vec::new();
            let whole = Square { quad: QuadId(quad), origin: [0.0; 2], size: 1.0 };
            self.collect_places(self.plan.pieces[quad as usize], whole, rings, &mut places);
            places
        })
    }

    /// The polynomial of a patch.
    pub fn patch(&self, place: &PatchPlace) -> Patch {
        match place.source {
            Source::Net(net) => self.regular_patch(net),
            Source::Ring(RingPatch { point, sector, ring, which, corner, .. }) => {
                turned_patch(corner, self.rings[point].patch(ring, sector, which))
            }
            Source::Cap(RingPatch { point, sector, which, corner, .. }) => {
                let cap = self.cap(point).expect("places of caps are those of caps");
                turned_patch(corner, cap.patch(&self.rings[point], sector, which))
            }
        }
    }

    /// What a patch says at (u,v) of its quad, on its borders too: [`Surface::eval`] chooses the
    /// patch by itself. Derivatives are in the quad's parameters and, unlike those of the
    /// polynomial in world coordinates, exact to rounding at any depth.
    pub fn eval_on(&self, place: &PatchPlace, u: f64, v: f64) -> SurfacePoint {
        match place.source {
            Source::Net(net) => {
                let [[u0, u1], [v0, v1]] = place.domain;
                let jet = self.regular_jet(2, net, [(u - u0) / (u1 - u0), (v - v0) / (v1 - v0)]);
                jet.scaled_parameters(1.0 / (u1 - u0)).into()
            }
            Source::Ring(RingPatch { point, sector, ring, which, square, corner }) => {
                let [a, b] = to_sector(corner, square.parameters([u, v]));
                let found = self.rings[point].eval_on(ring, sector, which, a, b);
                let jet = from_sector(corner, &found.jet).scaled_parameters(1.0 / square.size);
                SurfacePoint { jet, ..found }
            }
            Source::Cap(RingPatch { point, sector, ring, which, square, corner }) => {
                let cap = self.cap(point).expect("places of caps are those of caps");
                let rings = &self.rings[point];
                let at = rings.in_hole(ring, to_sector(corner, square.parameters([u, v])));
                let found = cap.eval_on(rings, sector, which, at);
                let jet = from_sector(corner, &found.jet).scaled_parameters(1.0 / square.size);
                SurfacePoint { jet, ..found }
            }
        }
    }

    fn collect_places(
        &self,
        piece: Piece,
        square: Square,
        rings: usize,
        out: &mut Vec<PatchPlace>,
    ) {
        match piece {
            Piece::Omitted => {}
            Piece::Regular(net) => out.push(PatchPlace {
                role: Role::Regular,
                quad: square.quad,
                domain: square.part([[0.0, 1.0], [0.0, 1.0]]),
                point: None,
                sector: None,
                source: Source::Net(net),
            }),
            Piece::Sector { point, sector, corner } => {
                let (point, sector) = (point as usize, sector as usize);
                self.collect_sector(point, sector, corner, square, rings, out);
            }
            Piece::Split(first) => {
                for k in 0..4 {
                    let child = self.plan.pieces[first as usize + k];
                    self.collect_places(child, square.child(k), rings, out);
                }
            }
        }
    }

    fn collect_sector(
        &self,
        point: usize,
        sector: usize,
        corner: u8,
        square: Square,
        rings: usize,
        out: &mut Vec<PatchPlace>,
    ) {
        let around = &self.rings[point];
        let place = |role, ring, which, domain| {
            let patch = RingPatch { point, sector, ring, which, square, corner };
            PatchPlace {
                role,
                quad: square.quad,
                domain: square.part(ring_domain(corner, around.sigma(), ring, domain)),
                point: Some(point),
                sector: Some(sector),
                source: if role == Role::Cap { Source::Cap(patch) } else { Source::Ring(patch) },
            }
        };
        let cap = self.cap(point);
        let count = cap.map_or(rings, |cap| rings.min(cap.rings()));
        for (ring, which) in
            (0..count).flat_map(|ring| (0..around.patches_per_sector()).map(move |k| (ring, k)))
        {
            out.push(place(Role::Ring(ring + 1), ring, which, around.patch_domain(which)));
        }
        if let Some(cap) = cap.filter(|cap| cap.rings() <= rings) {
            let all = 0..cap.patches_per_sector();
            out.extend(all.map(|k| place(Role::Cap, cap.rings(), k, cap.patch_domain(k))));
        }
    }

    #[inline]
    fn positions(&self, level: usize) -> &[Point] {
        if level == 0 { self.cage.positions() } else { &self.refined[level - 1] }
    }

    #[inline]
    fn net_points(&self, net: u32) -> [Point; 16] {
        let net = &self.plan.nets[net as usize];
        net.points(self.positions(net.level as usize))
    }

    #[inline(always)]
    fn regular_jet(&self, order: usize, net: u32, [u, v]: [f64; 2]) -> Jet {
        let points = self.net_points(net);
        tensor_jet(order, &cubic_b_spline(u), &cubic_b_spline(v), square(&points))
    }

    fn regular_patch(&self, net: u32) -> Patch {
        let points = self.net_points(net);
        let along_u = CUBIC_B_SPLINE_TO_BB.map(|row| sum_of_rows(&row, square(&points)));
        let along_v = |p: [Point; 4]| CUBIC_B_SPLINE_TO_BB.map(|row| sum(&row, &p));
        Patch::new([3, 3], along_u.map(along_v).as_flattened().to_vec())
    }
}
