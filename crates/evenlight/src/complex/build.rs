//! From the places of the patches to the complex.

use super::carrier::{Carrier, Meeting, QuadOfFace, Side};
use super::exact::{Exact, Lines, ONE, ratio};
use super::pair::{Pair, pairs};
use super::piece::{Pieces, rectangle};
use super::{
    ComplexError, EdgeKind, EdgePlace, EdgeUse, Lists, PatchComplex, PatchEdge, PatchEdgeId,
    PatchId, PatchVertexId, VertexPlace,
};
use crate::mesh::{HalfEdgeId, Topology};
use crate::surface::{PatchPlace, QuadId, Surface};

impl PatchComplex {
    /// The complex of all regular patches and of `rings` rings around every extraordinary point; of a
    /// closed surface no more rings than it has, and if it is all of them the caps.
    ///
    /// Takes time n log n in the number of patches, and the same memory as they do.
    ///
    /// # Errors
    ///
    /// [`ComplexError::TooDeep`] if rings are more than 100, or if they contract so fast that positions in
    /// the last of them are not told apart (more than about 30 of those that contract fastest).
    /// [`ComplexError::TooMany`] if there are 2^32 edges or more.
    pub fn new(surface: &Surface, rings: usize) -> Result<Self, ComplexError> {
        let lines = lines_of_points(surface, rings)?;
        let places: Vec<PatchPlace> = surface.patch_places(rings).collect();
        // A patch has four edges at least, of which two patches share one.
        if places.len() >= u32::MAX as usize / 4 {
            return Err(ComplexError::TooMany);
        }
        let sides = sides_of_patches(surface, &places, &lines);
        let pairs = pairs(&sides);
        if pairs.len() >= u32::MAX as usize / 2 {
            return Err(ComplexError::TooMany);
        }
        let topology = surface.cage().topology();
        let (meetings, vertices) = vertices(surface, topology, &pairs);
        let edges: Vec<PatchEdge> = pairs
            .iter()
            .zip(vertices)
            .map(|(pair, vertices)| edge(surface, &sides, pair, vertices))
            .collect();
        let edges_of_sides = edges_of_sides(&edges, places.len());
        let edges_of_vertices = edges_of_vertices(&edges, meetings.len());
        let vertices = meetings.into_iter().map(VertexPlace::from).collect();
        let pieces = Pieces::of(&places, surface.num_quads());
        Ok(Self { places, pieces, lines, edges, edges_of_sides, vertices, edges_of_vertices })
    }
}

/// The lines around every point to this depth.
fn lines_of_points(surface: &Surface, rings: usize) -> Result<Vec<Lines>, ComplexError> {
    let of_point = |point: usize| {
        let rules = surface.rings(point).rules().rules();
        let cap = surface.cap(point);
        let rings = cap.map_or(rings, |cap| rings.min(cap.rings()));
        let cap_split = cap.filter(|cap| cap.rings() <= rings).map_or(0, |cap| cap.split());
        let lines = Lines::new(rules, rings, cap_split);
        let most = lines.most_rings();
        if rings > most { Err(ComplexError::TooDeep { rings, most }) } else { Ok(lines) }
    };
    (0..surface.extraordinary_points().len()).map(of_point).collect()
}

fn quad_of_face<'a>(surface: &Surface, topology: &'a Topology, quad: u32) -> QuadOfFace<'a> {
    let (face, corner) = surface.face_of(QuadId(quad));
    QuadOfFace { topology, quad, face, corner }
}

fn sides_of_patches(surface: &Surface, places: &[PatchPlace], lines: &[Lines]) -> Vec<Side> {
    let topology = surface.cage().topology();
    let mut sides = Vec::with_capacity(4 * places.len());
    let mut quad = None;
    for (place, number) in places.iter().zip(0..) {
        let here = match quad {
            Some(here @ QuadOfFace { quad, .. }) if quad == place.quad.0 => here,
            _ => quad_of_face(surface, topology, place.quad.0),
        };
        quad = Some(here);
        let rules = |point: usize| surface.rings(point).rules().rules();
        sides.extend(here.sides(number, rectangle(place, lines, rules)));
    }
    sides
}

/// The vertices in order, and those at both ends of every pair.
fn vertices(
    surface: &Surface,
    topology: &Topology,
    pairs: &[Pair],
) -> (Vec<Meeting>, Vec<[PatchVertexId; 2]>) {
    let quad = |quad: u32| quad_of_face(surface, topology, quad);
    let mut ends: Vec<(Meeting, usize)> = Vec::with_capacity(2 * pairs.len());
    for (k, pair) in pairs.iter().enumerate() {
        let at = pair.interval.map(|at| pair.carrier.meeting(topology, at, quad));
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
    surface: &Surface,
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
        kind: kind(surface, pair),
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

fn kind(surface: &Surface, pair: &Pair) -> EdgeKind {
    let has_two = pair.forward.is_some() && pair.backward.is_some();
    match pair.carrier {
        Carrier::CageEdge(h) if has_two && surface.is_infinitely_sharp(h) => EdgeKind::Sharp,
        Carrier::CageEdge(h) if !has_two && is_boundary(surface, h) => EdgeKind::Boundary,
        _ if has_two => EdgeKind::Smooth,
        _ => EdgeKind::Rim,
    }
}

/// Whether an edge of the cage has a face without a surface, or one face only.
fn is_boundary(surface: &Surface, h: HalfEdgeId) -> bool {
    let topology = surface.cage().topology();
    let is_covered = |h: HalfEdgeId| !surface.is_omitted(topology.face(h));
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
