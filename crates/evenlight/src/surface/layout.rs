//! The layout of a surface: all that depends on topology, tags and options, and on no value.
//!
//! ```text
//!   Cage --+-- topology, tags --+
//!          |                    +--> Layout --+
//!          |       options -----+             +--> Surface<3>: positions
//!          +-- positions, primvars -----------+--> Surface<N>: a primvar of N numbers
//! ```
//!
//! Which pieces cover which face, where the extraordinary points are and which rules they have. It
//! is shared by all poses of a cage and by its primvars.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use super::cache::{RuleCache, SharedRules};
use super::place::from_sector_parameters;
use super::{PointRule, QuadId, SurfaceError, SurfaceOptions};
use crate::mesh::isolation::{Extraordinary, Place, Plan};
use crate::mesh::sharpness::Beyond;
use crate::mesh::{
    Cage, FaceId, Fan, HalfEdgeId, INFINITELY_SHARP, Tags, Topology, VertexId, cnet_vertices,
    fan_vertices,
};
use crate::scheme::MAX_CATMULL_CLARK_VALENCE;

/// Topology, tags and options of a surface, and all that follows from them.
///
/// To be shared as `Arc<Layout>`. Two layouts are equal if their faces, tags and options are;
/// comparing and hashing take no time but where they are equal and not the same.
///
/// ```
/// use std::sync::Arc;
/// use evenlight::surface::Layout;
/// use evenlight::{Cage, Mesh, Surface, SurfaceOptions};
///
/// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
/// let cage = Cage::new(Mesh::new(square.clone(), [[0, 1, 2, 3]]))?;
/// let layout = Arc::new(Layout::new(&cage, SurfaceOptions::default())?);
/// // A temperature at every vertex, on the same layout as the positions.
/// let temperature = Surface::over(&layout, vec![[20.0], [30.0], [25.0], [25.0]])?;
/// let positions = Surface::over(&layout, square)?;
/// assert!(Arc::ptr_eq(temperature.layout(), positions.layout()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Layout {
    topology: Arc<Topology>,
    tags: Arc<Tags>,
    options: SurfaceOptions,
    pub(super) plan: Plan,
    points: Vec<ExtraordinaryPoint>,
    /// The rules of every point.
    rules: Vec<Arc<SharedRules>>,
    /// The vertices of the net of every point, at its level, one net after the other.
    net_vertices: Vec<VertexId>,
    /// Where the net of every point begins, and the number of all.
    net_starts: Vec<usize>,
    /// Where rules come from, for positions and for primvars.
    cache: RuleCache,
    /// A hash of topology, tags and options.
    fingerprint: u64,
}

/// An extraordinary point of the surface: an interior vertex of valence other than 4, the centre of
/// an n-gon, or a vertex on sharp edges or the boundary that is not regular there.
#[derive(Clone, Debug, PartialEq)]
pub struct ExtraordinaryPoint {
    /// Where it is in the cage.
    pub place: Place,
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
    /// The sectors counter-clockwise, without those in omitted faces.
    pub sectors: Vec<Sector>,
}

impl ExtraordinaryPoint {
    /// The vertex of the cage; `None` for the centre of an n-gon.
    pub fn vertex(&self) -> Option<VertexId> {
        match self.place {
            Place::Vertex(v) => Some(v),
            Place::FaceCentre(_) => None,
        }
    }

    /// The n-gon whose centre this is; `None` for a vertex.
    pub fn face(&self) -> Option<FaceId> {
        match self.place {
            Place::Vertex(_) => None,
            Place::FaceCentre(f) => Some(f),
        }
    }
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

impl Layout {
    /// The layout of surfaces over `cage`, with the rules of the process's cache.
    ///
    /// Time and memory are linear in the number of faces.
    ///
    /// # Errors
    ///
    /// As of [`Surface::build`](super::Surface::build).
    pub fn new(cage: &Cage, options: SurfaceOptions) -> Result<Self, SurfaceError> {
        Self::with_cache(cage, options, &RuleCache::global())
    }

    /// The layout of surfaces over `cage`, with the rules of `cache`.
    ///
    /// # Errors
    ///
    /// As of [`Surface::build`](super::Surface::build).
    pub fn with_cache(
        cage: &Cage,
        options: SurfaceOptions,
        cache: &RuleCache,
    ) -> Result<Self, SurfaceError> {
        let (topology, tags) = (cage.shared_topology().clone(), cage.shared_tags().clone());
        Self::of_net(topology, tags, BTreeMap::new(), options, cache)
    }

    /// The layout over faces with tags; of a face-varying primvar, `beyond` are the edges beyond
    /// its seams.
    pub(super) fn of_net(
        topology: Arc<Topology>,
        tags: Arc<Tags>,
        beyond: BTreeMap<VertexId, Beyond>,
        options: SurfaceOptions,
        cache: &RuleCache,
    ) -> Result<Self, SurfaceError> {
        options.scheme.check_contraction(options.contraction)?;
        let fingerprint = fingerprint(&topology, &tags, &options);
        let plan = Plan::new(&topology, &tags, options.boundary.unwrap_or(tags.boundary), beyond);
        refuse_high_valences(&plan)?;
        let (mut points, mut rules) = (Vec::new(), Vec::new());
        let mut met: BTreeMap<(PointRule, Fan), Arc<SharedRules>> = BTreeMap::new();
        for (p, found) in plan.points.iter().enumerate() {
            let rule = PointRule::of(&topology, found, options);
            let of_point = match met.get(&(rule, found.fan)) {
                Some(rules) => rules.clone(),
                None => cache.rules(rule, found.fan, options).ok_or_else(|| no_rules([found]))?,
            };
            met.insert((rule, found.fan), of_point.clone());
            rules.push(of_point);
            points.push(describe(&plan, p, rule));
        }
        let (mut net_vertices, mut net_starts) = (Vec::new(), vec![0]);
        for point in 0..points.len() {
            add_net_vertices(&topology, &plan, point, &mut net_vertices);
            net_starts.push(net_vertices.len());
        }
        let cache = cache.clone();
        Ok(Self {
            topology,
            tags,
            options,
            plan,
            points,
            rules,
            net_vertices,
            net_starts,
            cache,
            fingerprint,
        })
    }

    /// The connectivity.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// The connectivity to keep.
    pub(crate) fn shared_topology(&self) -> &Arc<Topology> {
        &self.topology
    }

    /// Boundary rule, creases, corners, holes.
    pub fn tags(&self) -> &Tags {
        &self.tags
    }

    /// How surfaces are built.
    pub fn options(&self) -> SurfaceOptions {
        self.options
    }

    /// The number of values that a surface takes: one for each vertex of the cage.
    pub fn num_vertices(&self) -> usize {
        self.topology.num_vertices()
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

    /// The face of `quad`, and the corner if the face is an n-gon (else 0); `None` if there is no
    /// such quad.
    pub fn face_of(&self, quad: QuadId) -> Option<(FaceId, usize)> {
        ((quad.0 as usize) < self.num_quads()).then(|| self.face_of_quad(quad))
    }

    /// [`Layout::face_of`] a quad that exists.
    pub(crate) fn face_of_quad(&self, quad: QuadId) -> (FaceId, usize) {
        let face = self.plan.first_quads.partition_point(|&first| first <= quad.0) - 1;
        (FaceId(face as u32), (quad.0 - self.plan.first_quads[face]) as usize)
    }

    /// Whether there is no surface over `face`: a hole, or at the boundary under the rule "none".
    pub fn is_omitted(&self, face: FaceId) -> bool {
        self.plan.omitted.binary_search(&face).is_ok()
    }

    /// The faces without a surface, in order.
    pub fn omitted_faces(&self) -> &[FaceId] {
        &self.plan.omitted
    }

    /// Whether the surface may have a fold along an edge of the cage: it is infinitely sharp or on
    /// the boundary. No edge has none.
    pub fn is_infinitely_sharp(&self, h: HalfEdgeId) -> bool {
        h.index() < self.topology.half_edges().len()
            && (self.plan.sharpness[0].edge(&self.topology, h) >= INFINITELY_SHARP
                || self.topology.twin(h).is_none())
    }

    /// The extraordinary points that have a surface around them.
    pub fn extraordinary_points(&self) -> &[ExtraordinaryPoint] {
        &self.points
    }

    /// What covers the faces.
    pub(crate) fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The rules of an extraordinary point, by its index.
    pub(crate) fn rules(&self, point: usize) -> &SharedRules {
        &self.rules[point]
    }

    /// The vertices of the net of a point, at the level at which it is isolated: of a c-net the
    /// centre and six for each sector, of a fan as in [`fan_vertices`].
    pub(crate) fn net_vertices(&self, point: usize) -> &[VertexId] {
        &self.net_vertices[self.net_starts[point]..self.net_starts[point + 1]]
    }

    /// The cache of its rules.
    pub(super) fn cache(&self) -> &RuleCache {
        &self.cache
    }

    /// A hash of faces, tags and options: equal layouts have equal ones. Not to be stored, as
    /// another version of the library may hash otherwise.
    pub fn fingerprint(&self) -> u64 {
        self.fingerprint
    }
}

impl PartialEq for Layout {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
            || self.fingerprint == other.fingerprint
                && self.options == other.options
                && self.tags == other.tags
                && self.topology.num_vertices() == other.topology.num_vertices()
                && self.topology.faces() == other.topology.faces()
    }
}

impl Eq for Layout {}

impl Hash for Layout {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u64(self.fingerprint);
    }
}

fn fingerprint(topology: &Topology, tags: &Tags, options: &SurfaceOptions) -> u64 {
    let mut hasher = DefaultHasher::new();
    topology.num_vertices().hash(&mut hasher);
    for corners in topology.faces().iter() {
        corners.hash(&mut hasher);
    }
    // Few, and their text has all of them.
    format!("{tags:?} {options:?}").hash(&mut hasher);
    hasher.finish()
}

fn refuse_high_valences(plan: &Plan) -> Result<(), SurfaceError> {
    let mut without =
        plan.points.iter().filter(|p| p.fan.faces > MAX_CATMULL_CLARK_VALENCE).peekable();
    if without.peek().is_some() { Err(no_rules(without)) } else { Ok(()) }
}

fn no_rules<'a>(points: impl IntoIterator<Item = &'a Extraordinary>) -> SurfaceError {
    SurfaceError::NoRules { points: points.into_iter().map(|p| (p.place, p.valence)).collect() }
}

fn add_net_vertices(topology: &Topology, plan: &Plan, point: usize, net: &mut Vec<VertexId>) {
    let topology = plan.topology(topology, plan.points[point].level);
    if !plan.points[point].fan.is_smooth() {
        return net.extend(fan_vertices(topology, plan.placed_fan(point)));
    }
    let first = plan.first_half_edges[point];
    net.push(topology.origin(first));
    cnet_vertices(topology, first).iter().for_each(|sector| net.extend(sector));
}

/// A point for users of the library.
fn describe(plan: &Plan, point: usize, rule: PointRule) -> ExtraordinaryPoint {
    let Extraordinary { place, valence, fan, level, .. } = plan.points[point];
    let mut sectors: Vec<Sector> = plan.sectors[point]
        .iter()
        .map(|place| {
            let on_quad = |[a, b]: [f64; 2]| {
                let [u, v] = from_sector_parameters(place.corner as u8, [a, b]);
                [place.origin[0] + place.size * u, place.origin[1] + place.size * v]
            };
            let center = on_quad([0.0, 0.0]);
            let step = |end: [f64; 2]| [end[0] - center[0], end[1] - center[1]];
            let along = [step(on_quad([1.0, 0.0])), step(on_quad([0.0, 1.0]))];
            Sector { index: place.sector, quad: QuadId(place.quad), center, along }
        })
        .collect();
    sectors.sort_by_key(|s| s.index);
    ExtraordinaryPoint { place, valence, fan, rule, level, sectors }
}
