//! The sharpness of the edges and vertices of a mesh, and how it falls under refinement.
//!
//! The rules are the same as in OpenSubdiv: the rules of [DKT98], with Chaikin's averaging and
//! with the boundary as an infinitely sharp crease:
//!
//! | edges that are sharp at a vertex | its rule |
//! | --- | --- |
//! | 0 | smooth |
//! | 1 | dart: the smooth rule |
//! | 2 | crease: a cubic spline along the two edges |
//! | 3 or more, or the vertex is sharp itself | corner: it stays |
//!
//! Refinement lowers sharpness by one ([`CreaseMethod::Uniform`]), or first takes 3/4 of it and
//! 1/4 of the mean of the other semi-sharp edges at the vertex ([`CreaseMethod::Chaikin`]); from
//! [`INFINITELY_SHARP`] on it stays. Where a rule ends between two levels, the old and the new rule
//! are blended by what was left of the sharpness.
//!
//! All this is in single precision, as in OpenSubdiv; else surfaces would differ by up to 1e-8.

use std::collections::BTreeMap;

use super::{BoundaryRule, CreaseMethod, HalfEdgeId, INFINITELY_SHARP, Tags, Topology, VertexId};

/// The sharpness of all edges and vertices of one level of refinement.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sharpness {
    method: CreaseMethod,
    /// Of every half-edge, infinite at the boundary, NaN where a refined part of the surface ends;
    /// empty if the surface is closed and nothing of it sharp.
    edges: Vec<f64>,
    /// Of every vertex; empty with `edges`.
    vertices: Vec<f64>,
    /// Of vertices of a face-varying primvar at its seams.
    beyond: BTreeMap<VertexId, Beyond>,
}

/// Semi-sharp edges of the cage at a vertex of a face-varying primvar that are no edges of the
/// primvar there: edges between faces beyond a seam, and the seams themselves.
///
/// ```text
///         :          v, below the seam ======, has one edge of the primvar, w;
///       a :          it is held by a, if it depends on the fan above;
///   ======v===b==    b is apart: it only counts in Chaikin's averages
///         |
///         w
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Beyond {
    /// The sharpness of the edges that keep the vertex a corner while any of them is sharp.
    pub(crate) holding: Vec<f64>,
    /// The sharpness of the other edges.
    pub(crate) apart: Vec<f64>,
    /// Whether the vertex lingers: since the last refinement no edge holds it any more, but a seam
    /// was still semi-sharp. Then OpenSubdiv keeps it a corner once more, and we do the same.
    pub(crate) lingers: bool,
}

/// The sharpness of a vertex that lingers: it ends in the next refinement, and its weight is 0.
const LINGERING: f64 = 1e-30;

impl Beyond {
    /// How sharp the vertex is: it is a corner for as long as an edge holds it.
    pub(crate) fn vertex(&self) -> f64 {
        let lingering = if self.lingers { LINGERING } else { 0.0 };
        self.holding.iter().copied().fold(lingering, f64::max)
    }

    fn is_held(&self) -> bool {
        self.holding.iter().any(|&s| s > 0.0)
    }

    fn all(&self) -> impl Iterator<Item = f64> + '_ {
        self.holding.iter().chain(&self.apart).copied().filter(|&s| is_semi_sharp(s))
    }
}

/// An edge at a vertex, seen from there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spoke {
    /// The vertex at its other end.
    pub(crate) end: VertexId,
    /// NaN where a refined part of the surface ends.
    pub(crate) sharpness: f64,
}

impl Sharpness {
    /// The sharpness of a cage. Tags must name edges and vertices of the cage, as `Cage` checks.
    pub(crate) fn new(topology: &Topology, tags: &Tags, boundary: BoundaryRule) -> Self {
        let is_closed = topology.half_edges().all(|h| topology.twin(h).is_some());
        let is_smooth = tags.creases.iter().all(|c| single(c.sharpness) <= 0.0)
            && tags.corners.iter().all(|c| single(c.sharpness) <= 0.0);
        if is_closed && is_smooth {
            return Self::default();
        }
        let mut edges: Vec<f64> = vec![0.0; topology.half_edges().len()];
        for crease in &tags.creases {
            for h in half_edges_of(topology, crease.edge) {
                edges[h.index()] = single(crease.sharpness);
            }
        }
        for h in topology.half_edges().filter(|&h| topology.twin(h).is_none()) {
            edges[h.index()] = f64::INFINITY;
        }
        let mut vertices = vec![0.0; topology.num_vertices()];
        for corner in &tags.corners {
            vertices[corner.vertex.index()] = single(corner.sharpness);
        }
        if boundary == BoundaryRule::EdgeAndCorner {
            let tips = (0..topology.num_vertices() as u32).map(VertexId);
            for v in tips.filter(|&v| topology.is_boundary(v) && topology.num_sectors(v) == 1) {
                vertices[v.index()] = f64::INFINITY;
            }
        }
        Self { method: tags.crease_method, edges, vertices, beyond: BTreeMap::new() }
    }

    /// Adds the edges beyond the seams of a primvar.
    pub(crate) fn with_beyond(self, beyond: BTreeMap<VertexId, Beyond>) -> Self {
        Self { beyond, ..self }
    }

    /// Whether the surface is closed and has no sharp edge or vertex.
    pub(crate) fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// Whether the sharpness of an edge depends on its neighbours.
    pub(crate) fn is_averaged(&self) -> bool {
        self.method == CreaseMethod::Chaikin && self.edges.iter().any(|&s| is_semi_sharp(s))
    }

    /// The sharpness of the edge of `h`: infinite at the boundary, NaN where a refined part of the
    /// surface ends.
    pub(crate) fn edge(&self, topology: &Topology, h: HalfEdgeId) -> f64 {
        match self.edges.get(h.index()) {
            Some(&sharpness) => sharpness,
            None if topology.twin(h).is_none() => f64::NAN,
            None => 0.0,
        }
    }

    /// The sharpness of `v`.
    pub(crate) fn vertex(&self, v: VertexId) -> f64 {
        self.vertices.get(v.index()).copied().unwrap_or(0.0)
    }

    /// All edges at `v`, counter-clockwise; at a boundary from one end to the other.
    pub(crate) fn spokes(&self, topology: &Topology, v: VertexId) -> Vec<Spoke> {
        let mut last = None;
        let mut spokes: Vec<Spoke> = topology
            .ring(v)
            .map(|h| {
                last = Some(topology.previous(h));
                Spoke { end: topology.target(h), sharpness: self.edge(topology, h) }
            })
            .collect();
        let behind = last.filter(|&h| topology.twin(h).is_none());
        spokes.extend(
            behind.map(|h| Spoke { end: topology.origin(h), sharpness: self.edge(topology, h) }),
        );
        spokes
    }

    /// Whether the rule at `v` changes in a refinement.
    pub(crate) fn is_semi_sharp_at(&self, topology: &Topology, v: VertexId) -> bool {
        !self.is_empty()
            && (is_semi_sharp(self.vertex(v))
                || self.spokes(topology, v).iter().any(|spoke| is_semi_sharp(spoke.sharpness)))
    }

    /// Calls `mark` with every vertex that is sharp, at the end of an edge that is sharp, or where
    /// a refined part of a surface ends; with none, if the surface is closed and smooth.
    pub(crate) fn for_each_touched(&self, topology: &Topology, mut mark: impl FnMut(VertexId)) {
        for (h, _) in topology.half_edges().zip(&self.edges).filter(|&(_, &s)| s != 0.0) {
            mark(topology.origin(h));
            mark(topology.target(h));
        }
        let vertices = (0..self.vertices.len() as u32).map(VertexId);
        vertices.filter(|&v| self.vertex(v) != 0.0).for_each(mark);
    }

    /// The sharpness of the half at `v` of the edge of `h`, of which `v` is an end.
    pub(crate) fn child_edge(&self, topology: &Topology, h: HalfEdgeId, v: VertexId) -> f64 {
        let sharpness = self.edge(topology, h);
        if self.method == CreaseMethod::Uniform || !is_semi_sharp(sharpness) {
            return lowered(sharpness);
        }
        chaikin(sharpness, &self.averaged(&self.spokes(topology, v), v))
    }

    /// The sharpness of the halves at `v` of all its edges.
    pub(crate) fn child_spokes(&self, spokes: &[Spoke], v: VertexId) -> Vec<f64> {
        self.children(spokes.iter().map(|spoke| spoke.sharpness), spokes, v)
    }

    /// What edges at `v` become; `spokes` are the edges of the primvar.
    fn children(&self, of: impl Iterator<Item = f64>, spokes: &[Spoke], v: VertexId) -> Vec<f64> {
        if self.method == CreaseMethod::Uniform {
            return of.map(lowered).collect();
        }
        let all = self.averaged(spokes, v);
        of.map(|s| if is_semi_sharp(s) { chaikin(s, &all) } else { lowered(s) }).collect()
    }

    /// The semi-sharp edges at `v`, over which Chaikin's rule averages, and unknown ones.
    fn averaged(&self, spokes: &[Spoke], v: VertexId) -> Vec<f64> {
        let own = spokes.iter().map(|spoke| spoke.sharpness);
        let own = own.filter(|&s| is_semi_sharp(s) || s.is_nan());
        own.chain(self.beyond.get(&v).into_iter().flat_map(Beyond::all)).collect()
    }

    /// How the sharpness changes that makes `v` itself a corner: its own, or the sharpness of the
    /// edges that hold it.
    pub(crate) fn vertex_changes(&self, topology: &Topology, v: VertexId) -> Vec<[f64; 2]> {
        match (self.beyond.get(&v), self.child_beyond(topology, v)) {
            (Some(_), Some(then)) if then.lingers => vec![[self.vertex(v), LINGERING]],
            (Some(now), Some(then)) if now.is_held() => {
                now.holding.iter().zip(&then.holding).map(|(&a, &b)| [a, b]).collect()
            }
            _ => vec![[self.vertex(v), lowered(self.vertex(v))]],
        }
    }

    /// The sharpness of `v` after a refinement.
    pub(crate) fn child_vertex(&self, topology: &Topology, v: VertexId) -> f64 {
        self.vertex_changes(topology, v).iter().fold(0.0, |most, &[_, then]| f64::max(most, then))
    }

    /// The edges beyond the seams at `v` after a refinement.
    pub(crate) fn child_beyond(&self, topology: &Topology, v: VertexId) -> Option<Beyond> {
        let now = self.beyond.get(&v)?;
        let spokes = self.spokes(topology, v);
        let children = |edges: &[f64]| self.children(edges.iter().copied(), &spokes, v);
        let (holding, apart) = (children(&now.holding), children(&now.apart));
        let then = Beyond { holding, apart, lingers: false };
        let lingers = now.is_held() && !then.is_held() && then.apart.iter().any(|&s| s > 0.0);
        Some(Beyond { lingers, ..then })
    }

    /// The sharpness of a refined level, edge by edge in the order of its half-edges.
    pub(crate) fn refined(
        &self,
        edges: Vec<f64>,
        vertices: Vec<f64>,
        beyond: BTreeMap<VertexId, Beyond>,
    ) -> Self {
        Self { method: self.method, edges, vertices, beyond }
    }
}

/// Sharpness as OpenSubdiv keeps it.
pub(crate) fn single(sharpness: f64) -> f64 {
    f64::from(sharpness as f32)
}

/// Whether the rule of a vertex changes in this refinement or later.
pub(crate) fn is_semi_sharp(sharpness: f64) -> bool {
    0.0 < sharpness && sharpness < INFINITELY_SHARP
}

/// Sharpness after a refinement.
fn lowered(sharpness: f64) -> f64 {
    if sharpness >= INFINITELY_SHARP || sharpness.is_nan() {
        return sharpness;
    }
    if sharpness > 1.0 { sharpness - 1.0 } else { 0.0 }
}

/// Sharpness after a refinement of a semi-sharp edge at a vertex, of which `all` are the
/// semi-sharp edges.
fn chaikin(sharpness: f64, all: &[f64]) -> f64 {
    if all.len() < 2 {
        return lowered(sharpness);
    }
    let (own, sum) = (sharpness as f32, all.iter().fold(0.0, |sum, &s| sum + s as f32));
    let others = (sum - own) / (all.len() - 1) as f32;
    lowered(f64::from(0.75 * own + 0.25 * others))
}

/// The weight of the rule that ends, for a vertex and edges whose sharpness goes from the first
/// number to the second: the mean of the sharpness that ends, at most 1.
pub(crate) fn fraction(changes: impl IntoIterator<Item = [f64; 2]>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for [before, after] in changes {
        if before > 0.0 && after <= 0.0 {
            sum += before as f32;
            count += 1.0;
        }
    }
    if count == 0.0 { 0.0 } else { f64::from(f32::min(sum / count, 1.0)) }
}

/// The one or two half-edges of the edge between two vertices; none if there is no such edge.
pub(crate) fn half_edges_of(
    topology: &Topology,
    [a, b]: [VertexId; 2],
) -> impl Iterator<Item = HalfEdgeId> + use<> {
    // Around the end with fewer edges: there may be a crease to every neighbour of a pole.
    let few = |v: VertexId| topology.num_sectors(v);
    let (a, b) = if few(a) <= few(b) { (a, b) } else { (b, a) };
    let sides = topology.ring(a).flat_map(|h| [h, topology.previous(h)]);
    let found = sides.into_iter().find(|&h| topology.target(h) == b || topology.origin(h) == b);
    found.into_iter().chain(found.and_then(|h| topology.twin(h)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sharpness_falls_by_one_and_stays_from_ten_on() {
        let values = [0.0, 0.4, 1.0, 1.5, 9.75, 10.0, 12.0, f64::INFINITY];
        let expected = [0.0, 0.0, 0.0, 0.5, 8.75, 10.0, 12.0, f64::INFINITY];
        assert_eq!(values.map(lowered), expected);
    }

    #[test]
    fn chaikin_averages_with_the_other_semi_sharp_edges() {
        assert_eq!(chaikin(3.0, &[3.0]), 2.0);
        assert_eq!(chaikin(3.0, &[3.0, 1.0]), 1.5);
        assert_eq!(chaikin(1.0, &[3.0, 1.0]), 0.5);
        assert_eq!(chaikin(2.0, &[2.0, 4.0, 1.0]), 1.125);
    }

    #[test]
    fn what_ends_is_blended_by_its_mean() {
        assert_eq!(fraction([[2.0, 1.0], [0.0, 0.0]]), 0.0);
        assert_eq!(fraction([[0.25, 0.0], [0.75, 0.0], [5.0, 4.0]]), 0.5);
    }
}
