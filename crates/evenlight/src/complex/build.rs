//! From the places of the patches to the complex.

use std::sync::Arc;

use super::carrier::{Carrier, Meeting, QuadOfFace, Side};
use super::exact::{AxisLines, Exact, MAX_RINGS, ONE, ratio};
use super::pair::{Pair, pairs};
use super::piece::{Numbers, rectangle};
use super::{
    ComplexError, EdgeKind, EdgePlace, EdgeUse, Lists, PatchComplex, PatchEdge, PatchEdgeId,
    PatchId, PatchVertexId, VertexPlace,
};
use crate::cap::CapOptions;
use crate::mesh::HalfEdgeId;
use crate::surface::{CapPlan, Layout, PatchPlace, QuadId, Surface};

impl PatchComplex {
    /// The complex of all regular patches and of `rings` rings around every extraordinary point,
    /// for all surfaces over a layout; of surfaces that are closed by caps no more rings than they
    /// have, and if it is all of them the caps.
    ///
    /// Takes time n log n in the number of patches, and memory as they do.
    ///
    /// # Errors
    ///
    /// [`ComplexError::TooDeep`] if rings are more than 100, or if they contract so fast that
    /// positions in the last of them are not told apart (more than about 30 of those that contract
    /// fastest). [`ComplexError::Cap`] if there are no such caps. [`ComplexError::TooMany`] if
    /// there are 2^31 edges or more.
    pub fn new(
        layout: &Arc<Layout>,
        rings: usize,
        caps: Option<CapOptions>,
    ) -> Result<Self, ComplexError> {
        let caps = caps.map(|options| CapPlan::new(layout, options)).transpose()?;
        Self::with_caps(layout.clone(), rings, caps.map(Arc::new))
    }

    /// [`PatchComplex::new`] with the layout and the caps of a surface.
    ///
    /// # Errors
    ///
    /// As of [`PatchComplex::new`].
    pub fn of<const N: usize>(surface: &Surface<N>, rings: usize) -> Result<Self, ComplexError> {
        Self::with_caps(surface.layout().clone(), rings, surface.cap_plan().cloned())
    }

    /// So many rings can have a complex around every point of a layout.
    pub fn most_rings(layout: &Layout) -> usize {
        let points = 0..layout.extraordinary_points().len();
        let lines = points.map(|point| AxisLines::new(layout.rules(point).rules().rules(), 0, 0));
        lines.map(|lines| lines.most_rings()).fold(MAX_RINGS, usize::min)
    }

    fn with_caps(
        layout: Arc<Layout>,
        rings: usize,
        caps: Option<Arc<CapPlan>>,
    ) -> Result<Self, ComplexError> {
        let rings = caps.as_ref().map_or(rings, |caps| rings.min(caps.options.rings));
        let caps = caps.filter(|caps| caps.options.rings == rings);
        let lines = lines_of_points(&layout, rings, caps.as_deref())?;
        let places: Vec<PatchPlace> = layout.places(rings, caps.as_deref()).collect();
        if places.len() >= MOST_PATCHES {
            return Err(ComplexError::TooMany);
        }
        let sides = sides_of_patches(&layout, &places, &lines);
        let pairs = pairs(&sides);
        if pairs.len() >= MOST_EDGES {
            return Err(ComplexError::TooMany);
        }
        let (meetings, vertices) = vertices(&layout, &pairs);
        let ends = pairs.iter().zip(vertices);
        let edges: Vec<PatchEdge> =
            ends.map(|(pair, vertices)| edge(&layout, &sides, pair, vertices)).collect();
        let points = 0..layout.extraordinary_points().len();
        let rules = points.map(|point| layout.rules(point).rules().rules());
        Ok(Self {
            numbers: Numbers::of(&places, rings, rules),
            edges_of_sides: edges_of_sides(&edges, places.len()),
            edges_of_vertices: edges_of_vertices(&edges, meetings.len()),
            vertices: meetings.into_iter().map(VertexPlace::from).collect(),
            layout,
            caps,
            places,
            edges,
        })
    }
}

/// The sides of so many patches can be numbered with 32 bits.
const MOST_PATCHES: usize = u32::MAX as usize / 4;

/// The ends of so many edges can be.
const MOST_EDGES: usize = u32::MAX as usize / 2;

/// The lines around every point, of these rings and of the caps behind them.
fn lines_of_points(
    layout: &Layout,
    rings: usize,
    caps: Option<&CapPlan>,
) -> Result<Vec<AxisLines>, ComplexError> {
    let of_point = |point: usize| {
        let cap_split = caps.map_or(0, |caps| caps.rules(point).split());
        let lines = AxisLines::new(layout.rules(point).rules().rules(), rings, cap_split);
        let most = lines.most_rings();
        if rings > most { Err(ComplexError::TooDeep { rings, most }) } else { Ok(lines) }
    };
    (0..layout.extraordinary_points().len()).map(of_point).collect()
}

fn quad_of_face(layout: &Layout, quad: u32) -> QuadOfFace<'_> {
    let (face, corner) = layout.face_of_quad(QuadId(quad));
    QuadOfFace { topology: layout.topology(), quad, face, corner }
}

fn sides_of_patches(layout: &Layout, places: &[PatchPlace], lines: &[AxisLines]) -> Vec<Side> {
    let mut sides = Vec::with_capacity(4 * places.len());
    let mut quad: Option<QuadOfFace> = None;
    for (place, number) in places.iter().zip(0..) {
        let known = quad.filter(|known| known.quad == place.quad.0);
        let here = known.unwrap_or_else(|| quad_of_face(layout, place.quad.0));
        quad = Some(here);
        let rules = |point: usize| layout.rules(point).rules().rules();
        sides.extend(here.sides(number, rectangle(place, lines, rules)));
    }
    sides
}

/// The vertices in order, and those at both ends of every pair.
fn vertices(layout: &Layout, pairs: &[Pair]) -> (Vec<Meeting>, Vec<[PatchVertexId; 2]>) {
    let quad = |quad: u32| quad_of_face(layout, quad);
    let mut ends: Vec<(Meeting, usize)> = Vec::with_capacity(2 * pairs.len());
    for (k, pair) in pairs.iter().enumerate() {
        let at = pair.interval.map(|at| pair.carrier.meeting(layout.topology(), at, quad));
        ends.extend([(at[0], 2 * k), (at[1], 2 * k + 1)]);
    }
    ends.sort_unstable();
    let mut meetings: Vec<Meeting> = Vec::with_capacity(pairs.len());
    let mut vertices = vec![[PatchVertexId(0); 2]; pairs.len()];
    for (meeting, end) in ends {
        if meetings.last() != Some(&meeting) {
            meetings.push(meeting);
        }
        vertices[end / 2][end % 2] = PatchVertexId(meetings.len() as u32 - 1);
    }
    (meetings, vertices)
}

/// The edge of a pair, whose vertices are at the lower and at the higher coordinate.
fn edge(
    layout: &Layout,
    sides: &[Side],
    pair: &Pair,
    [low, high]: [PatchVertexId; 2],
) -> PatchEdge {
    let use_of = |k: u32| use_of_side(&sides[k as usize], pair.interval);
    // With two uses the patch on the left of the line is the first; the edge runs as its first use.
    let forward = pair.forward.map(use_of);
    let backward = pair.backward.map(use_of);
    let is_along = forward.is_some();
    let num_uses = u8::from(forward.is_some()) + u8::from(backward.is_some());
    let first = forward.or(backward).expect("a pair has a side");
    let second = if is_along { backward.unwrap_or(first) } else { first };
    let (place, length) = edge_place(pair.carrier);
    let interval = pair.interval.map(|at| ratio(at, length));
    PatchEdge {
        vertices: if is_along { [low, high] } else { [high, low] },
        kind: kind(layout, pair),
        place,
        interval: if is_along { interval } else { [interval[1], interval[0]] },
        uses: [
            EdgeUse { is_forward: true, ..first },
            EdgeUse { is_forward: num_uses == 1, ..second },
        ],
        num_uses,
    }
}

/// The part of a side that lies in an interval of its carrier.
fn use_of_side(side: &Side, [from, to]: [Exact; 2]) -> EdgeUse {
    let [start, end] = side.interval;
    let along = [from - start, to - start].map(|at| ratio(at, end - start));
    let against = [end - to, end - from].map(|at| ratio(at, end - start));
    EdgeUse {
        patch: PatchId(side.patch),
        side: side.side,
        interval: if side.is_forward { along } else { against },
        is_forward: true,
    }
}

/// The line of an edge for its user, and its length.
fn edge_place(carrier: Carrier) -> (EdgePlace, Exact) {
    let quad = QuadId;
    match carrier {
        Carrier::CageEdge(h) => (EdgePlace::CageEdge(h), 2 * ONE),
        Carrier::FaceLine(face, k) => (EdgePlace::FaceLine { face, corner: k as usize }, ONE),
        Carrier::Inside(q, 0, at) => (EdgePlace::AlongV { quad: quad(q), at: ratio(at, ONE) }, ONE),
        Carrier::Inside(q, _, at) => (EdgePlace::AlongU { quad: quad(q), at: ratio(at, ONE) }, ONE),
    }
}

impl From<Meeting> for VertexPlace {
    fn from(meeting: Meeting) -> Self {
        match meeting {
            Meeting::Vertex(v) => Self::Vertex(v),
            Meeting::FaceCentre(face) => Self::FaceCentre(face),
            Meeting::OnEdge(h, at) => Self::OnEdge(h, ratio(at, 2 * ONE)),
            Meeting::OnFaceLine(face, k, at) => {
                Self::OnFaceLine { face, corner: k as usize, at: ratio(at, ONE) }
            }
            Meeting::Inside(quad, at) => Self::Inside(QuadId(quad), at.map(|x| ratio(x, ONE))),
        }
    }
}

fn kind(layout: &Layout, pair: &Pair) -> EdgeKind {
    let has_two = pair.forward.is_some() && pair.backward.is_some();
    match pair.carrier {
        Carrier::CageEdge(h) if has_two && layout.is_infinitely_sharp(h) => EdgeKind::Sharp,
        Carrier::CageEdge(h) if !has_two && is_boundary(layout, h) => EdgeKind::Boundary,
        _ if has_two => EdgeKind::Smooth,
        _ => EdgeKind::Rim,
    }
}

/// Whether an edge of the cage has a face without a surface, or one face only.
fn is_boundary(layout: &Layout, h: HalfEdgeId) -> bool {
    let topology = layout.topology();
    let is_covered = |h: HalfEdgeId| !layout.is_omitted(topology.face(h));
    !is_covered(h) || !topology.twin(h).is_some_and(is_covered)
}

fn edges_of_sides(edges: &[PatchEdge], num_patches: usize) -> Lists {
    let slot = |used: &EdgeUse| 4 * used.patch.index() + usize::from(used.side);
    let mut lists = lists(edges, 4 * num_patches, |edge| edge.uses().iter().map(slot));
    // Edges follow each other along their carriers; sides may run the other way.
    for side in 0..4 * num_patches {
        let range = lists.starts[side] as usize..lists.starts[side + 1] as usize;
        let from = |id: &PatchEdgeId| {
            let uses = edges[id.index()].uses();
            uses.iter().find(|used| slot(used) == side).map_or(0.0, |used| used.interval[0])
        };
        let of_side = &mut lists.edges[range];
        if let [first, .., last] = of_side
            && from(last) < from(first)
        {
            of_side.reverse();
        }
    }
    lists
}

fn edges_of_vertices(edges: &[PatchEdge], num_vertices: usize) -> Lists {
    lists(edges, num_vertices, |edge| edge.vertices.iter().map(|v| v.index()))
}

/// The edges in each of so many lists, in their order.
fn lists<'a, I: Iterator<Item = usize>>(
    edges: &'a [PatchEdge],
    count: usize,
    lists_of: impl Fn(&'a PatchEdge) -> I,
) -> Lists {
    let mut starts = vec![0_u32; count + 1];
    edges.iter().flat_map(&lists_of).for_each(|list| starts[list + 1] += 1);
    for list in 0..count {
        starts[list + 1] += starts[list];
    }
    let mut free = starts.clone();
    let mut all = vec![PatchEdgeId(0); starts[count] as usize];
    for (edge, id) in edges.iter().zip(0..) {
        for list in lists_of(edge) {
            let slot = &mut free[list];
            all[*slot as usize] = PatchEdgeId(id);
            *slot += 1;
        }
    }
    Lists { starts, edges: all }
}
