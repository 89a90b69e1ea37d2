//! Watertight triangle meshes of the limit surface.
//!
//! Every edge of the cage becomes `rate` segments and every parametric quad a grid of cells,
//! each cut into two triangles. All vertices lie on the limit surface, with its exact normal
//! and curvature; only the inside of the triangles is an approximation.
//!
//! ```text
//!  d---o---o---c     rate 3: 4 x 4 vertices on a face with four corners; those on an edge
//!  | \ | / | / |     are vertices of the neighbour as well
//!  o---o---o---o
//!  | / | / | / |     a cell is cut along its shorter diagonal; where both are equal, along
//!  o---o---o---o     the one that points to the middle of the quad; from a vertex with two
//!  | / | / | \ |     faces always
//!  a---o---o---b
//! ```
//!
//! What is promised: vertices shared by quads are one vertex, computed once, from the quad
//! with the lowest number among them; so there are no cracks and no T-junctions, and a closed
//! cage gives a closed mesh of the same genus. Triangles run counter-clockwise seen from
//! outside. The result is the same bytes whatever the number of threads.
//!
//! Along infinitely sharp edges the surface has two tangent planes. The vertices stay one, but have
//! two *sides* there, and more where such edges meet ([`TriangleMesh::sides`]). So there are two
//! ways to use a mesh:
//!
//! | | vertices | triangles |
//! | --- | --- | --- |
//! | watertight, for measuring, printing and simulation | `positions` | `triangles` |
//! | shaded, hard at creases | of every side, `positions[vertex_of_side(side)]` and `normals` | [`sides()`](TriangleMesh::sides) |
//!
//! [`TriangleMesh::split`] makes vertices for graphics, also at the seams of primvars such as
//! texture coordinates ([`TriangleMesh::corner_values`], [`TriangleMesh::corner_primvars`]).
//!
//! What is not: the triangles may intersect where the surface does. Faces without a surface
//! are left out, and where two faces with a surface share nothing but a vertex, so do their
//! triangles.

mod arrays;
mod corners;
mod nodes;
mod samples;
mod sides;
mod split;

pub use arrays::TriangleArrays;
pub use corners::{CornerPrimvars, CornerValues};
pub use split::SplitVertices;

use std::collections::BTreeMap;

use crate::patch::{FirstJet, SurfacePoint};
use crate::point::{Point, Vector, add, cross, dot, norm, sub, unit};
use crate::surface::{QuadId, Surface};
use crate::task::{Cancelled, Steps};
use nodes::{Grid, Nodes};
use samples::{NodePlace, samples};
use sides::Sides;

/// Triangles on the limit surface, with what the surface says at their vertices.
///
/// There is a position for each vertex, and a normal, K, H and an origin for each *side* of a
/// vertex. Side `v` is the first side of vertex `v`; the sides from `positions.len()` on are those
/// that vertices have in addition where the surface is folded along an infinitely sharp edge.
/// Without such edges sides are vertices.
///
/// A vertex takes 88 bytes, a triangle 12; where there are folds a further side takes 68 and a
/// triangle 24.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Points of the surface, in the units of the cage; of each vertex.
    pub positions: Vec<Point>,
    /// The unit normals of the surface, outward; NaN where neither the surface nor what is around
    /// has one. Of each side.
    pub normals: Vec<Vector>,
    /// The Gauss curvature K in 1/length^2; see [`tessellate`] for extraordinary points. Of each
    /// side.
    pub gauss: Vec<f64>,
    /// The mean curvature H in 1/length, negative on convex bodies. Of each side.
    pub mean: Vec<f64>,
    /// Where each side was computed: the lowest quad of those around it.
    pub origins: Vec<VertexOrigin>,
    /// The vertices of the sides from `positions.len()` on.
    pub side_vertices: Vec<u32>,
    /// The corners of the triangles, as indices of vertices, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// The corners of the triangles, as numbers of sides; empty if sides are vertices, see
    /// [`TriangleMesh::sides`].
    pub corner_sides: Vec<[u32; 3]>,
    /// The quads with a surface, in order, and the triangles of each.
    pub quads: Vec<QuadTriangles>,
    /// The number of segments along every edge of the cage.
    pub rate: usize,
}

/// The parameters at which a side of a vertex was computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexOrigin {
    /// The parametric quad.
    pub quad: QuadId,
    /// The parameters (u, v) in it, in [0, 1].
    pub uv: [f64; 2],
}

/// The triangles of one quad: two for each of its cells, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QuadTriangles {
    /// The parametric quad.
    pub quad: QuadId,
    /// The number of cells along each side; the quad has twice its square of triangles.
    pub segments: u32,
    /// The first of its triangles.
    pub first: usize,
}

/// A triangle in the parameters of its quad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParametricTriangle {
    /// The parametric quad.
    pub quad: QuadId,
    /// The parameters (u, v) of the three corners, counter-clockwise.
    pub uv: [[f64; 2]; 3],
}

/// Why no triangle mesh could be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TessellateError {
    /// The rate is zero.
    #[error("the rate must be 1 or more")]
    ZeroRate,
    /// The vertices cannot be numbered with 32 bits.
    #[error("rate {rate} gives more than {} vertices", u32::MAX - 1)]
    TooManyVertices {
        /// The rate, after rounding.
        rate: usize,
    },
    /// Who watches the work stopped it ([`Task::watch`](crate::task::Task::watch)).
    #[error("the work was cancelled")]
    Cancelled,
}

impl From<Cancelled> for TessellateError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// Cuts the surface into triangles, with `rate` segments along every edge of the cage.
///
/// If a face with a surface has other than four corners, `rate` is rounded up to an even
/// number, since each of the quads of such a face covers half of two edges;
/// [`TriangleMesh::rate`] is the rate used. A closed cage of quads gives 2 rate^2 triangles
/// for each face.
///
/// Normals and curvatures are those of the surface, not of the triangles. At an extraordinary
/// point the vertex is the limit point with the limit normal. Where curvature does not exist there
/// (schemes without a quadratic), or no tangent plane (valence 2, cusps), the mesh has instead the
/// mean of the values in the middle of the cells around, on the same side of folds.
///
/// # Errors
///
/// If `rate` is 0, or if there would be 2^32 - 1 vertices or more. Running out of memory is
/// not an error that is reported.
pub fn tessellate(surface: &Surface, rate: usize) -> Result<TriangleMesh, TessellateError> {
    let mut mesh = TriangleMesh::default();
    tessellate_into(surface, rate, &mut mesh)?;
    Ok(mesh)
}

/// [`tessellate`] into a mesh of the caller's, whose memory is used again: for every pose of an
/// animation the same.
///
/// # Errors
///
/// As of [`tessellate`]; the mesh is as it was, but incomplete if the work was cancelled.
pub fn tessellate_into(
    surface: &Surface,
    rate: usize,
    mesh: &mut TriangleMesh,
) -> Result<(), TessellateError> {
    let nodes =
        Nodes::number(surface.topology(), rate_used(surface, rate)?, |f| !surface.is_omitted(f))?;
    let sides = Sides::number(surface, &nodes)?;
    mesh.clear();
    mesh.rate = nodes.rate();
    mesh.side_vertices.extend_from_slice(sides.nodes());
    let places = places(surface, &nodes, &sides);
    mesh.origins.extend(places.iter().map(|place| place.origin()));
    mesh.evaluate(surface, &places)?;
    mesh.fill_what_is_missing(surface, &nodes, &sides);
    mesh.triangulate(surface, &nodes, &sides);
    Ok(())
}

/// The rate rounded up to what the n-gons need.
fn rate_used(surface: &Surface, rate: usize) -> Result<usize, TessellateError> {
    let faces = surface.topology().faces();
    let has_ngon = || faces.ids().any(|f| faces.corners(f).len() != 4 && !surface.is_omitted(f));
    match rate {
        0 => Err(TessellateError::ZeroRate),
        _ if u32::try_from(rate).is_err() => Err(TessellateError::TooManyVertices { rate }),
        _ if rate % 2 == 1 && has_ngon() => Ok(rate + 1),
        _ => Ok(rate),
    }
}

/// The quad of a grid.
fn quad_of(surface: &Surface, grid: Grid) -> QuadId {
    surface.quad(grid.face, grid.corner).expect("the grids are those of the surface's quads")
}

/// The first grid, in the order of the quads, in which each side lies, and the node there.
fn places(surface: &Surface, nodes: &Nodes, sides: &Sides) -> Vec<NodePlace> {
    const UNKNOWN: NodePlace = NodePlace { quad: QuadId(u32::MAX), segments: 1, node: [0; 2] };
    let mut places = vec![UNKNOWN; nodes.len() + sides.nodes().len()];
    for grid in nodes.grids() {
        let (quad, sides) = (quad_of(surface, grid), sides.of_face(grid.face));
        for (i, j) in grid.nodes() {
            let place = &mut places[sides.side(nodes.node(grid, i, j)) as usize];
            if place.quad == UNKNOWN.quad {
                let segments = grid.segments as u32;
                *place = NodePlace { quad, segments, node: [i as u32, j as u32] };
            }
        }
    }
    places
}

fn eval(surface: &Surface, quad: QuadId, [u, v]: [f64; 2]) -> SurfacePoint {
    surface.eval(quad, u, v).expect("quads of omitted faces have no grid")
}

/// Whether the surface has two infinitely sharp edges or boundaries in one line at a corner of a
/// quad: the edges of a plane face, say, one of whose vertices lies between two others. Its normal
/// is noise there, whatever the digits of the cage.
fn has_straight_angle(surface: &Surface, grid: Grid, (i, j): (usize, usize)) -> bool {
    /// Sines of angles that files with seven digits leave of a straight one, and more.
    const STRAIGHT: f64 = 1e-4;
    let Some(corner) = grid.corner_of_face(i, j) else { return false };
    let topology = surface.topology();
    let h = topology.half_edge(grid.face, corner);
    if ![h, topology.previous(h)].into_iter().all(|h| surface.is_infinitely_sharp(h)) {
        return false;
    }
    let [u, v] = grid.parameters(i as f64, j as f64);
    let jet = surface.eval_first(quad_of(surface, grid), u, v);
    jet.is_some_and(|FirstJet { du, dv, .. }| norm(cross(du, dv)) <= STRAIGHT * norm(du) * norm(dv))
}

impl TriangleMesh {
    /// Empties everything, but keeps the memory.
    fn clear(&mut self) {
        let Self { positions, normals, gauss, mean, origins, .. } = self;
        positions.clear();
        normals.clear();
        gauss.clear();
        mean.clear();
        origins.clear();
        self.side_vertices.clear();
        self.triangles.clear();
        self.corner_sides.clear();
        self.quads.clear();
    }

    /// Computes all sides, and vertices on their first, a slice at a time.
    fn evaluate(&mut self, surface: &Surface, places: &[NodePlace]) -> Result<(), Cancelled> {
        const SLICE: usize = 1 << 16;
        let num_vertices = places.len() - self.side_vertices.len();
        self.positions.reserve_exact(num_vertices);
        self.normals.reserve_exact(places.len());
        self.gauss.reserve_exact(places.len());
        self.mean.reserve_exact(places.len());
        let mut steps = Steps::new("Evaluating vertices", places.len().div_ceil(SLICE))?;
        for slice in places.chunks(SLICE) {
            for points in samples(surface, slice) {
                let missing = num_vertices - self.positions.len();
                self.positions.extend(points.iter().map(|p| p.position).take(missing));
                self.normals.extend(points.iter().map(|p| p.normal));
                self.gauss.extend(points.iter().map(|p| p.gauss));
                self.mean.extend(points.iter().map(|p| p.mean));
            }
            steps.step()?;
        }
        Ok(())
    }

    /// Gives extraordinary points and other corners of quads the curvature and the normal that they
    /// lack: the mean over the middles of the cells around, which do not depend on how cells are
    /// cut.
    fn fill_what_is_missing(&mut self, surface: &Surface, nodes: &Nodes, sides: &Sides) {
        let mut around: BTreeMap<u32, Vec<SurfacePoint>> = BTreeMap::new();
        for grid in nodes.grids() {
            let sides = sides.of_face(grid.face);
            for (i, j) in grid.corners() {
                let side = sides.side(nodes.node(grid, i, j));
                let is_known = !self.gauss[side as usize].is_nan();
                if is_known && has_straight_angle(surface, grid, (i, j)) {
                    self.normals[side as usize] = [f64::NAN; 3];
                    self.gauss[side as usize] = f64::NAN;
                }
                if self.gauss[side as usize].is_nan() {
                    let middle = |i: usize| if i == 0 { 0.5 } else { i as f64 - 0.5 };
                    let uv = grid.parameters(middle(i), middle(j));
                    around.entry(side).or_default().push(eval(surface, quad_of(surface, grid), uv));
                }
            }
        }
        for (side, points) in around {
            let n = points.len() as f64;
            self.gauss[side as usize] = points.iter().map(|p| p.gauss).sum::<f64>() / n;
            self.mean[side as usize] = points.iter().map(|p| p.mean).sum::<f64>() / n;
            let normal = &mut self.normals[side as usize];
            if normal[0].is_nan() {
                *normal = unit(points.iter().fold([0.0; 3], |sum, p| add(sum, p.normal)));
            }
        }
    }

    fn triangulate(&mut self, surface: &Surface, nodes: &Nodes, sides: &Sides) {
        let num_cells: usize = nodes.grids().map(|grid| grid.segments * grid.segments).sum();
        self.triangles.reserve_exact(2 * num_cells);
        self.corner_sides.reserve_exact(if self.is_folded() { 2 * num_cells } else { 0 });
        for grid in nodes.grids() {
            let (quad, first) = (quad_of(surface, grid), self.triangles.len());
            let sides = sides.of_face(grid.face);
            self.quads.push(QuadTriangles { quad, segments: grid.segments as u32, first });
            let numbers: Vec<u32> = grid.nodes().map(|(i, j)| nodes.node(grid, i, j)).collect();
            let has_two_faces = |(i, j)| nodes.has_two_faces(grid, i, j);
            let is_pinned = grid.corners().into_iter().any(has_two_faces);
            for (i, j) in grid.cells() {
                let corners = cell_corners(i, j).map(|(i, j)| numbers[i + j * (grid.segments + 1)]);
                let points = corners.map(|v| self.positions[v as usize]);
                let pinned = is_pinned.then(|| cell_corners(i, j).map(has_two_faces));
                let diagonal = pinned
                    .and_then(Diagonal::from_pinned)
                    .unwrap_or_else(|| Diagonal::choose(points, i, j, grid.segments));
                self.triangles.extend(diagonal.cut(corners));
                if self.is_folded() {
                    self.corner_sides.extend(diagonal.cut(corners.map(|v| sides.side(v))));
                }
            }
        }
    }

    /// Whether some vertex has several sides.
    pub fn is_folded(&self) -> bool {
        !self.side_vertices.is_empty()
    }

    /// The corners of the triangles, as numbers of sides: with `sides()` in the place of
    /// `triangles` every triangle has the normals and curvatures of its own side of folds.
    ///
    /// ```
    /// use evenlight::io::load::Format;
    /// use evenlight::tessellate::tessellate;
    /// use evenlight::{Surface, SurfaceOptions};
    ///
    /// let roof = "v 0 0 0\nv 1 0 1\nv 2 0 0\nv 0 1 0\nv 1 1 1\nv 2 1 0\n\
    ///             f 1 2 5 4\nf 2 3 6 5\nt crease 2/1/0 1 4 10\n";
    /// let (cage, _) = Format::Obj.read_cage(roof.as_bytes())?;
    /// let mesh = tessellate(&Surface::build(cage, SurfaceOptions::default())?, 4)?;
    /// // Five vertices on the ridge have two sides.
    /// assert_eq!((mesh.positions.len(), mesh.normals.len()), (5 * 9, 5 * 10));
    /// for (t, sides) in mesh.sides().iter().enumerate() {
    ///     for (&vertex, &side) in mesh.triangles[t].iter().zip(sides) {
    ///         assert_eq!(mesh.vertex_of_side(side), Some(vertex));
    ///         let on_the_left = mesh.parametric_triangle(t).map(|place| place.quad.0 == 0);
    ///         assert_eq!(Some(mesh.normals[side as usize][0] < 0.0), on_the_left);
    ///     }
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sides(&self) -> &[[u32; 3]] {
        if self.is_folded() { &self.corner_sides } else { &self.triangles }
    }

    /// The vertex that has side `side`; `None` if there is no such side.
    pub fn vertex_of_side(&self, side: u32) -> Option<u32> {
        match (side as usize).checked_sub(self.positions.len()) {
            None => Some(side),
            Some(further) => self.side_vertices.get(further).copied(),
        }
    }

    /// Triangle `triangle` in the parameters of its quad, by a binary search over the quads.
    ///
    /// Vertices on an edge may have their [`origins`](Self::origins) in another quad; this
    /// tells all three corners in one. `None` if there is no such triangle.
    pub fn parametric_triangle(&self, triangle: usize) -> Option<ParametricTriangle> {
        if triangle >= self.triangles.len() {
            return None;
        }
        let after = self.quads.partition_point(|q| q.first <= triangle);
        let quad = self.quads.get(after.checked_sub(1)?)?;
        Some(self.parametric_triangle_of(*quad, triangle))
    }

    /// All triangles in the parameters of their quads, in the order of
    /// [`triangles`](Self::triangles).
    pub fn parametric_triangles(&self) -> impl Iterator<Item = ParametricTriangle> {
        self.quads.iter().flat_map(move |&q| {
            let m = q.segments as usize;
            let range = q.first..q.first + 2 * m * m;
            range.map(move |triangle| self.parametric_triangle_of(q, triangle))
        })
    }

    fn parametric_triangle_of(&self, q: QuadTriangles, triangle: usize) -> ParametricTriangle {
        let parameter = |i: usize| i as f64 / f64::from(q.segments);
        let uv = self.grid_nodes(q, triangle).map(|(i, j)| [parameter(i), parameter(j)]);
        ParametricTriangle { quad: q.quad, uv }
    }

    /// The nodes (i, j) of the grid of `q` at the corners of one of its triangles.
    fn grid_nodes(&self, q: QuadTriangles, triangle: usize) -> [(usize, usize); 3] {
        let (cell, half) = ((triangle - q.first) / 2, (triangle - q.first) % 2);
        let m = q.segments as usize;
        let [a, b] = [0, 1].map(|k| self.triangles[q.first + 2 * cell + k]);
        Diagonal::of(a, b).cut(cell_corners(cell % m, cell / m))[half]
    }
}

/// The corners of cell (i, j), counter-clockwise.
fn cell_corners(i: usize, j: usize) -> [(usize, usize); 4] {
    [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
}

/// The diagonal along which a cell with the corners a b c d is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Diagonal {
    /// From a to c, corners (i, j) and (i+1, j+1).
    Rising,
    /// From b to d, corners (i+1, j) and (i, j+1).
    Falling,
}

impl Diagonal {
    /// The shorter diagonal; if they are equal, the one that points to the middle of the quad.
    ///
    /// The mesh of a symmetric cage is hence symmetric up to numbering, but for cells in the
    /// middle row or column of an odd number: they have no such diagonal, and with equal
    /// diagonals are cut along the rising one.
    fn choose([a, b, c, d]: [Point; 4], i: usize, j: usize, segments: usize) -> Self {
        /// Squared lengths closer than this, relatively, count as equal: far above rounding,
        /// so that it does not choose, and far below what changes the shape of a triangle.
        const TIE: f64 = 1e-6;
        let length_sq = |a, b| dot(sub(a, b), sub(a, b));
        let (rising, falling) = (length_sq(a, c), length_sq(b, d));
        let from_middle = |i: usize| 2 * i as i64 + 1 - segments as i64;
        if (rising - falling).abs() > TIE * (rising + falling) {
            if rising < falling { Self::Rising } else { Self::Falling }
        } else if from_middle(i).signum() * from_middle(j).signum() < 0 {
            Self::Falling
        } else {
            Self::Rising
        }
    }

    /// The diagonal from a corner around which there are just two faces. The other diagonal would
    /// join the edges that the two have in common, on both sides, and be an edge of four triangles.
    fn from_pinned([a, b, c, d]: [bool; 4]) -> Option<Self> {
        match (a || c, b || d) {
            (true, false) => Some(Self::Rising),
            (false, true) => Some(Self::Falling),
            _ => None,
        }
    }

    /// The two triangles of the cell, counter-clockwise.
    fn cut<T: Copy>(self, [a, b, c, d]: [T; 4]) -> [[T; 3]; 2] {
        match self {
            Self::Rising => [[a, b, c], [a, c, d]],
            Self::Falling => [[a, b, d], [b, c, d]],
        }
    }

    /// The diagonal along which [`Diagonal::cut`] made these triangles: only with the rising one
    /// do both begin at the same corner.
    fn of(first: [u32; 3], second: [u32; 3]) -> Self {
        if first[0] == second[0] { Self::Rising } else { Self::Falling }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shorter_diagonal_is_cut() {
        let long_rising = [[0., 0., 0.], [1., 0., 0.], [2., 1., 0.], [1., 1., 0.]];
        assert_eq!(Diagonal::choose(long_rising, 0, 0, 1), Diagonal::Falling);
        let long_falling = [[1., 0., 0.], [2., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        assert_eq!(Diagonal::choose(long_falling, 0, 1, 2), Diagonal::Rising);
    }

    #[test]
    fn the_cut_of_a_square_grid_has_its_symmetries() {
        let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        for m in [2, 4, 8] {
            for (i, j) in (0..m).flat_map(|i| (0..m).map(move |j| (i, j))) {
                let cut = Diagonal::choose(square, i, j, m);
                assert_eq!(cut, Diagonal::choose(square, j, i, m), "mirrored in the diagonal");
                assert_ne!(cut, Diagonal::choose(square, m - 1 - i, j, m), "mirrored in u");
            }
        }
    }

    #[test]
    fn the_diagonal_is_known_from_its_triangles() {
        for diagonal in [Diagonal::Rising, Diagonal::Falling] {
            let [a, b] = diagonal.cut([7, 3, 9, 1]);
            assert_eq!(Diagonal::of(a, b), diagonal);
        }
    }
}
