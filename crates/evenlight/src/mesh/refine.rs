//! One step of Catmull-Clark refinement of a part of a mesh [CC78].
//!
//! Every chosen face with m corners becomes m quads, one per corner; their vertices come from
//! the faces, edges and vertices of the coarser mesh:
//!
//! ```text
//!   v3 --- E2 --- v2       child k of a quad stands at corner k and keeps the parent's
//!    |  3   |   2  |       orientation: its vertex k is v_k, so its (u,v) run like the
//!   E3 ---- F --- E1       parent's. Child k of an n-gon starts with v_k:
//!    |  0   |   1  |       v_k, E_k, F, E_(k-1).
//!   v0 --- E0 --- v1
//! ```
//!
//! The rules are those for smooth surfaces, creases and corners ([`VertexRule`]); sharpness is
//! refined along with the positions.
//!
//! Only the chosen faces have children, so the finer mesh has a border where the coarse one
//! goes on. Where the chosen part touches itself in a single vertex, the finer mesh has one
//! vertex per fan there.

use super::sharpness::{Sharpness, Spoke, fraction};
use super::{FaceId, Faces, HalfEdgeId, Topology, VertexId};
use crate::net::VertexRule;

/// Where a refined vertex comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// A vertex.
    Vertex(VertexId),
    /// An edge, named by the lower of its half-edges.
    Edge(HalfEdgeId),
    /// A face.
    Face(FaceId),
}

/// A refined part of a coarser mesh.
#[derive(Clone, Debug)]
pub(crate) struct Level {
    topology: Topology,
    /// The first child of every coarse face; `NONE` for faces without children.
    first_child: Vec<u32>,
    origins: Vec<Origin>,
}

const NONE: u32 = u32::MAX;

impl Level {
    /// Refines the faces of `coarse` for which `chosen` is true.
    pub(crate) fn refine(coarse: &Topology, chosen: &[bool]) -> Self {
        let mut builder = Builder {
            coarse,
            chosen,
            origins: Vec::new(),
            of_corner: vec![NONE; coarse.half_edges().len()],
            of_edge: vec![NONE; coarse.half_edges().len()],
        };
        let mut faces = Faces::default();
        let mut first_child = vec![NONE; chosen.len()];
        for face in coarse.faces().ids().filter(|f| chosen[f.index()]) {
            first_child[face.index()] = faces.len() as u32;
            builder.add_children(face, &mut faces);
        }
        let origins = builder.origins;
        let topology = Topology::of_checked(faces, origins.len())
            .expect("a refined part of a surface is a surface, since its fans were separated");
        Self { topology, first_child, origins }
    }

    /// The connectivity of the refined part.
    pub(crate) fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Child `k` of a coarse face; `None` if it was not chosen.
    pub(crate) fn child(&self, face: FaceId, k: usize) -> Option<FaceId> {
        let first = self.first_child[face.index()];
        (first != NONE).then(|| FaceId(first + k as u32))
    }

    /// Where a refined vertex comes from.
    pub(crate) fn origin(&self, v: VertexId) -> Origin {
        self.origins[v.index()]
    }

    /// The sharpness of the refined part, from the sharpness of the coarse mesh.
    pub(crate) fn sharpness(&self, coarse: &Topology, sharpness: &Sharpness) -> Sharpness {
        if sharpness.is_empty() {
            return Sharpness::default();
        }
        let mut edges = Vec::with_capacity(self.topology.half_edges().len());
        for face in coarse.faces().ids().filter(|&f| self.child(f, 0).is_some()) {
            let size = coarse.faces().corners(face).len();
            for k in 0..size {
                let h = coarse.half_edge(face, k);
                let (v, before) = (coarse.origin(h), coarse.previous(h));
                let half = |h: HalfEdgeId| sharpness.child_edge(coarse, h, v);
                let mut child = [half(h), 0.0, 0.0, half(before)];
                if size == 4 {
                    child.rotate_right(k);
                }
                edges.extend(child);
            }
        }
        self.mark_cuts(coarse, &mut edges);
        let vertices = self.origins.iter().map(|&origin| match origin {
            Origin::Vertex(v) => sharpness.child_vertex(coarse, v),
            _ => 0.0,
        });
        let beyond = self.origins.iter().enumerate().filter_map(|(child, &origin)| match origin {
            Origin::Vertex(v) => Some((VertexId(child as u32), sharpness.child_beyond(coarse, v)?)),
            _ => None,
        });
        sharpness.refined(edges, vertices.collect(), beyond.collect())
    }

    /// Where this part ends and the surface goes on, sharpness is unknown.
    fn mark_cuts(&self, coarse: &Topology, edges: &mut [f64]) {
        let t = &self.topology;
        for h in t.half_edges().filter(|&h| t.twin(h).is_none()) {
            let edge = [t.origin(h), t.target(h)].into_iter().find_map(|v| match self.origin(v) {
                Origin::Edge(edge) => Some(edge),
                _ => None,
            });
            if edge.is_some_and(|edge| coarse.twin(edge).is_some()) {
                edges[h.index()] = f64::NAN;
            }
        }
    }

    /// The values of the refined vertices, from those of the coarse mesh: positions, or whatever
    /// goes by the same rules.
    ///
    /// The coarse mesh may be a refined part itself. Then values that depend on the faces beyond
    /// its end are NaN, so that nobody uses them unnoticed.
    pub(crate) fn values<const N: usize>(
        &self,
        coarse: &Topology,
        sharpness: &Sharpness,
        values: &[[f64; N]],
    ) -> Vec<[f64; N]> {
        let masks = Masks { coarse, sharpness, at: |v: VertexId| values[v.index()] };
        self.origins.iter().map(|&origin| masks.of(origin)).collect()
    }

    /// The weights of coarse vertices in a refined vertex. If the vertex depends on faces beyond
    /// the end of a refined part, its weights are NaN.
    pub(crate) fn mask(&self, coarse: &Topology, sharpness: &Sharpness, v: VertexId) -> Mask {
        let unit = |v: VertexId| Mask { terms: vec![(v, 1.0)] };
        Masks { coarse, sharpness, at: unit }.of(self.origin(v))
    }
}

/// The numbers that refinement averages: values, or weights of values.
pub(crate) trait Blended: Sized {
    /// Nothing.
    fn zero() -> Self;
    /// An unknown number, for a vertex that itself is `at`.
    fn unknown(at: Self) -> Self;
    /// Everything multiplied or divided by a number.
    fn map(self, f: impl Fn(f64) -> f64) -> Self;
    /// Adds `w` `other`.
    fn add_scaled(&mut self, w: f64, other: Self);
}

impl<const N: usize> Blended for [f64; N] {
    fn zero() -> Self {
        [0.0; N]
    }

    fn unknown(_: Self) -> Self {
        [f64::NAN; N]
    }

    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        self.map(f)
    }

    fn add_scaled(&mut self, w: f64, other: Self) {
        for (s, x) in self.iter_mut().zip(other) {
            *s += w * x;
        }
    }
}

/// The weights of coarse vertices in a refined one; the weights of one vertex add up.
#[derive(Clone, Debug)]
pub(crate) struct Mask {
    pub(crate) terms: Vec<(VertexId, f64)>,
}

impl Blended for Mask {
    fn zero() -> Self {
        Self { terms: Vec::new() }
    }

    fn unknown(at: Self) -> Self {
        at.map(|_| f64::NAN)
    }

    fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        self.terms.iter_mut().for_each(|(_, w)| *w = f(*w));
        self
    }

    fn add_scaled(&mut self, w: f64, other: Self) {
        self.terms.extend(other.map(|x| w * x).terms);
    }
}

struct Builder<'a> {
    coarse: &'a Topology,
    chosen: &'a [bool],
    origins: Vec<Origin>,
    /// The refined vertex at each coarse corner, kept at the first half-edge of its fan.
    of_corner: Vec<u32>,
    /// The refined vertex on each coarse edge, kept at the lower half-edge.
    of_edge: Vec<u32>,
}

impl Builder<'_> {
    fn add_children(&mut self, face: FaceId, faces: &mut Faces) {
        let size = self.coarse.faces().corners(face).len();
        let center = self.add(Origin::Face(face));
        for k in 0..size {
            let h = self.coarse.half_edge(face, k);
            let before = self.coarse.previous(h);
            let mut child =
                [self.corner_vertex(h), self.edge_vertex(h), center, self.edge_vertex(before)];
            if size == 4 {
                child.rotate_right(k);
            }
            faces.push(child);
        }
    }

    fn add(&mut self, origin: Origin) -> VertexId {
        self.origins.push(origin);
        VertexId(self.origins.len() as u32 - 1)
    }

    fn edge_vertex(&mut self, h: HalfEdgeId) -> VertexId {
        let lower = self.coarse.twin(h).map_or(h, |twin| h.min(twin));
        if self.of_edge[lower.index()] == NONE {
            self.of_edge[lower.index()] = self.add(Origin::Edge(lower)).0;
        }
        VertexId(self.of_edge[lower.index()])
    }

    fn corner_vertex(&mut self, h: HalfEdgeId) -> VertexId {
        let first = self.first_of_fan(h);
        if self.of_corner[first.index()] == NONE {
            self.of_corner[first.index()] = self.add(Origin::Vertex(self.coarse.origin(h))).0;
        }
        VertexId(self.of_corner[first.index()])
    }

    /// The first half-edge of the fan of chosen faces that contains the sector of `h`: the
    /// clockwise-most, or the lowest if the fan is closed.
    fn first_of_fan(&self, h: HalfEdgeId) -> HalfEdgeId {
        let (mut at, mut lowest) = (h, h);
        loop {
            let Some(twin) = self.coarse.twin(at) else { return at };
            if !self.chosen[self.coarse.face(twin).index()] {
                return at;
            }
            at = self.coarse.next(twin);
            lowest = lowest.min(at);
            if at == h {
                return lowest;
            }
        }
    }
}

/// The refinement masks of Catmull-Clark with creases and corners.
struct Masks<'a, F> {
    coarse: &'a Topology,
    sharpness: &'a Sharpness,
    /// The value of a coarse vertex.
    at: F,
}

impl<V: Blended, F: Fn(VertexId) -> V> Masks<'_, F> {
    fn of(&self, origin: Origin) -> V {
        match origin {
            Origin::Face(f) => self.face(f),
            Origin::Edge(h) => self.edge(h),
            Origin::Vertex(v) => self.vertex(v),
        }
    }

    fn at(&self, v: VertexId) -> V {
        (self.at)(v)
    }

    fn face(&self, f: FaceId) -> V {
        mean(self.coarse.faces().corners(f).iter().map(|&v| self.at(v)))
    }

    fn edge(&self, h: HalfEdgeId) -> V {
        let sharpness = self.sharpness.edge(self.coarse, h);
        if sharpness == 0.0 {
            return self.smooth_edge(h);
        }
        if sharpness.is_nan() {
            return V::unknown(self.at(self.coarse.origin(h)));
        }
        let ends = [self.coarse.origin(h), self.coarse.target(h)];
        let middle = mean(ends.map(|v| self.at(v)));
        // Averaging may keep both halves sharp, though the edge has sharpness below 1, or make one
        // half smooth, though it is above 1: then OpenSubdiv goes beyond the middle, and so do we.
        let stays = || ends.iter().all(|&v| self.sharpness.child_edge(self.coarse, h, v) > 0.0);
        if stays() {
            return middle;
        }
        blend(sharpness, middle, self.smooth_edge(h))
    }

    fn smooth_edge(&self, h: HalfEdgeId) -> V {
        let ends = [self.at(self.coarse.origin(h)), self.at(self.coarse.target(h))];
        let Some(twin) = self.coarse.twin(h) else { return mean(ends) };
        mean(ends.into_iter().chain([h, twin].map(|h| self.face(self.coarse.face(h)))))
    }

    fn vertex(&self, v: VertexId) -> V {
        if self.sharpness.is_empty() {
            let is_cut = self.coarse.is_boundary(v);
            return if is_cut { V::unknown(self.at(v)) } else { self.smooth_vertex(v) };
        }
        if !self.is_touched(v) {
            return self.smooth_vertex(v);
        }
        let spokes = self.sharpness.spokes(self.coarse, v);
        let vertex = self.sharpness.vertex(v);
        let rule = rule_of(vertex, spokes.iter().map(|spoke| spoke.sharpness));
        if spokes.iter().any(|spoke| spoke.sharpness.is_nan()) {
            return V::unknown(self.at(v));
        }
        let now = self.by_rule(v, rule, &spokes);
        if rule == VertexRule::Smooth {
            return now;
        }
        let child_vertex = self.sharpness.child_vertex(self.coarse, v);
        let child = self.sharpness.child_spokes(&spokes, v);
        let next_rule = rule_of(child_vertex, child.iter().copied());
        if next_rule == rule {
            return now;
        }
        let after: Vec<Spoke> = spokes
            .iter()
            .zip(&child)
            .map(|(spoke, &sharpness)| Spoke { sharpness, ..*spoke })
            .collect();
        let changes = spokes.iter().zip(&after).map(|(a, b)| [a.sharpness, b.sharpness]);
        let weight = fraction(changes.chain(self.sharpness.vertex_changes(self.coarse, v)));
        blend(weight, now, self.by_rule(v, next_rule, &after))
    }

    /// Whether `v` or an edge at it is sharp, or its edges are not all known.
    fn is_touched(&self, v: VertexId) -> bool {
        let edge = |h| self.sharpness.edge(self.coarse, h);
        self.sharpness.vertex(v) != 0.0
            || self.coarse.is_boundary(v)
            || self.coarse.ring(v).any(|h| edge(h) != 0.0)
    }

    fn by_rule(&self, v: VertexId, rule: VertexRule, spokes: &[Spoke]) -> V {
        match rule {
            VertexRule::Smooth => self.smooth_vertex(v),
            VertexRule::Corner => self.at(v),
            VertexRule::Crease => {
                let mut sum = self.at(v).map(|x| 0.75 * x);
                for spoke in spokes.iter().filter(|spoke| spoke.sharpness > 0.0) {
                    sum.add_scaled(0.125, self.at(spoke.end));
                }
                sum
            }
        }
    }

    /// (Q + 2 R + (n-3) S) / n with the means Q of the face points, R of the edge midpoints.
    fn smooth_vertex(&self, v: VertexId) -> V {
        let n = self.coarse.num_sectors(v) as f64;
        let mut sum = self.at(v).map(|x| (n - 2.0) / n * x);
        for h in self.coarse.ring(v) {
            sum.add_scaled(1.0 / (n * n), self.face(self.coarse.face(h)));
            sum.add_scaled(1.0 / (n * n), self.at(self.coarse.target(h)));
        }
        sum
    }
}

fn rule_of(vertex: f64, edges: impl Iterator<Item = f64>) -> VertexRule {
    VertexRule::of(vertex, edges.filter(|&s| s > 0.0).count())
}

/// w a + (1 - w) b.
fn blend<V: Blended>(w: f64, a: V, b: V) -> V {
    let mut sum = a.map(|x| w * x);
    sum.add_scaled(1.0 - w, b);
    sum
}

fn mean<V: Blended>(points: impl IntoIterator<Item = V>) -> V {
    let (mut sum, mut count) = (V::zero(), 0.0);
    for p in points {
        sum.add_scaled(1.0, p);
        count += 1.0;
    }
    sum.map(|x| x / count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::point::Point;

    const CUBE: [&[u32]; 6] =
        [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

    fn cube() -> (Topology, Vec<Point>) {
        let corner = |k: usize| {
            let [x, y] = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]][k % 4];
            [x, y, (k / 4) as f64]
        };
        let topology = Topology::build(Mesh::new(vec![], CUBE).faces, 8).unwrap();
        (topology, (0..8).map(corner).collect())
    }

    #[test]
    fn a_refined_cube_is_the_known_one() {
        let (cube, positions) = cube();
        let level = Level::refine(&cube, &[true; 6]);
        let refined = level.values(&cube, &Sharpness::default(), &positions);
        assert_eq!((refined.len(), level.topology().faces().len()), (26, 24));
        // A corner moves by (1,1,1) * 2/9: n = 3, Q + 2 R + 0 S = (1/6 + 2/6...) by hand 2/9.
        let child = level.child(FaceId(0), 0).unwrap();
        let corner = level.topology().faces().corners(child)[0];
        for x in refined[corner.index()] {
            assert!((x - 2.0 / 9.0).abs() < 1e-15);
        }
    }

    #[test]
    fn parts_that_touch_in_a_vertex_are_separated() {
        let (cube, _) = cube();
        // Two triangles of quads at opposite sides touch nowhere; faces 0 and 1 neither.
        let level = Level::refine(&cube, &[true, true, false, false, false, false]);
        assert_eq!(level.topology().faces().len(), 8);
        // A 3 x 3 grid with two opposite corner quads of the inner vertex chosen.
        let grid: [&[u32]; 4] = [&[0, 1, 4, 3], &[1, 2, 5, 4], &[3, 4, 7, 6], &[4, 5, 8, 7]];
        let grid = Topology::build(Mesh::new(vec![], grid).faces, 9).unwrap();
        let level = Level::refine(&grid, &[true, false, false, true]);
        assert_eq!(level.topology().num_vertices(), 18);
    }

    #[test]
    fn children_keep_the_orientation_of_their_parent() {
        let (cube, positions) = cube();
        let level = Level::refine(&cube, &[true; 6]);
        let refined = level.values(&cube, &Sharpness::default(), &positions);
        let centroid = |f: FaceId| {
            mean(level.topology().faces().corners(f).iter().map(|v| refined[v.index()]))
        };
        for k in 0..4 {
            let child = level.child(FaceId(1), k).unwrap();
            let corners = level.topology().faces().corners(child);
            // Vertex k of child k is the refined corner k, the farthest from the face's centre.
            let c = centroid(child);
            assert!(c[2] > 0.5);
            assert!(matches!(level.origins[corners[k].index()], Origin::Vertex(v)
                if v == cube.faces().corners(FaceId(1))[k]));
        }
    }
}
