//! The numbers of the grid nodes: which nodes of neighbouring quads are one vertex.
//!
//! Every parametric quad carries a grid of nodes (i, j). With `r` segments along an edge of
//! the cage, the quad of a four-sided face has r segments a side, and each of the n quads of
//! an n-gon has h = r/2, since it covers half of two edges:
//!
//! ```text
//!  d --- o --- c   r = 2                  d ------- o ------- c
//!  |     |     |                          |  quad 3 |  quad 2 |    an n-gon (here drawn with
//!  o --- o --- o   o: one per edge        o ------- * ------- o    n = 4 corners), h = 1;
//!  |     |     |      and one inside      |  quad 0 |  quad 1 |    *: its centre
//!  a --- o --- b                          a ------- o ------- b
//! ```
//!
//! A node at a vertex of the cage has one number whatever the quad that asks, and so has a
//! node on an edge, counted from the start of the half-edge with the lower number. The numbers
//! of the nodes follow the faces: what a face meets first is numbered there.

use std::ops::Range;

use super::TessellateError;
use crate::mesh::{FaceId, HalfEdgeId, Topology, VertexId};

/// No number yet, or a face without surface. The last `u32` is never given to a node.
const NONE: u32 = u32::MAX;

/// The grid of one parametric quad.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// The face it lies in.
    pub face: FaceId,
    /// The corner of that face, 0 if it has four.
    pub corner: usize,
    /// The number of corners of that face.
    num_corners: usize,
    /// The number of segments a side: nodes (i, j) with i and j from 0 to this.
    pub segments: usize,
}

impl Grid {
    /// All nodes, row by row.
    pub fn nodes(self) -> impl Iterator<Item = (usize, usize)> {
        (0..=self.segments).flat_map(move |j| (0..=self.segments).map(move |i| (i, j)))
    }

    /// The lower left nodes of all cells, row by row.
    pub fn cells(self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.segments).flat_map(move |j| (0..self.segments).map(move |i| (i, j)))
    }

    /// The nodes at the corners.
    pub fn corners(self) -> [(usize, usize); 4] {
        let m = self.segments;
        [(0, 0), (m, 0), (m, m), (0, m)]
    }

    /// The corner of the face at node (`i`, `j`).
    pub fn corner_of_face(self, i: usize, j: usize) -> Option<usize> {
        match self.corners().iter().position(|&at| at == (i, j)) {
            Some(k) if self.num_corners == 4 => Some(k),
            Some(0) => Some(self.corner),
            _ => None,
        }
    }

    /// The parameters (u, v) of a node, or between nodes.
    pub fn parameters(self, i: f64, j: f64) -> [f64; 2] {
        [i / self.segments as f64, j / self.segments as f64]
    }
}

/// The numbers of all nodes on the faces that have a surface.
#[derive(Debug)]
pub(super) struct Nodes<'a> {
    topology: &'a Topology,
    rate: usize,
    /// The node at each vertex.
    vertex: Vec<u32>,
    /// The first of the nodes inside each edge, under the lower of its half-edges.
    edge: Vec<u32>,
    /// The first of the nodes inside each face.
    face: Vec<u32>,
    len: u64,
}

impl<'a> Nodes<'a> {
    /// Numbers the nodes of the `covered` faces, with `rate` segments along every edge.
    ///
    /// `rate` must be 1 or more, and even if a covered face has other than four corners.
    pub fn number(
        topology: &'a Topology,
        rate: usize,
        covered: impl Fn(FaceId) -> bool,
    ) -> Result<Self, TessellateError> {
        let num_corners = topology.faces().all_corners().len();
        let (vertex, edge) = (vec![NONE; topology.num_vertices()], vec![NONE; num_corners]);
        let face = vec![NONE; topology.faces().len()];
        let mut nodes = Self { topology, rate, vertex, edge, face, len: 0 };
        for f in topology.faces().ids().filter(|&f| covered(f)) {
            nodes.number_face(f);
        }
        let too_many = nodes.len >= u64::from(NONE);
        if too_many { Err(TessellateError::TooManyVertices { rate }) } else { Ok(nodes) }
    }

    /// Numbers what `f` meets first: its vertices, its edges, its inside.
    fn number_face(&mut self, f: FaceId) {
        let corners = self.topology.faces().corners(f);
        for v in corners {
            if self.vertex[v.index()] == NONE {
                self.vertex[v.index()] = self.take(1);
            }
        }
        for k in 0..corners.len() {
            let (h, _) = self.lower_half_edge(self.topology.half_edge(f, k));
            if self.edge[h.index()] == NONE {
                self.edge[h.index()] = self.take(self.rate as u64 - 1);
            }
        }
        self.face[f.index()] = self.take(self.num_inside(corners.len()));
    }

    /// The first of `count` new numbers. Meaningless past 2^32, but the total is right (or
    /// stands at the largest `u64`), and [`Nodes::number`] looks at it in the end.
    fn take(&mut self, count: u64) -> u32 {
        let first = self.len as u32;
        self.len = self.len.saturating_add(count);
        first
    }

    /// The number of nodes inside a face.
    fn num_inside(&self, num_corners: usize) -> u64 {
        let (rate, half) = (self.rate as u64, self.rate as u64 / 2);
        match num_corners {
            4 => (rate - 1).saturating_mul(rate - 1),
            n => half.saturating_mul(half - 1).saturating_mul(n as u64).saturating_add(1),
        }
    }

    /// The number of segments along every edge.
    pub fn rate(&self) -> usize {
        self.rate
    }

    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.len as usize
    }

    /// The node at `v`, which must be one of a covered face.
    pub fn at_vertex(&self, v: VertexId) -> u32 {
        self.vertex[v.index()]
    }

    /// The nodes inside the edge of `h`, which must be one of a covered face.
    pub fn inside(&self, h: HalfEdgeId) -> Range<u32> {
        let first = self.edge[self.lower_half_edge(h).0.index()];
        first..first + (self.rate - 1) as u32
    }

    /// The grids of all quads with a surface, in the order of the quads.
    pub fn grids(&self) -> impl Iterator<Item = Grid> {
        self.topology.faces().ids().filter(|f| self.face[f.index()] != NONE).flat_map(|face| {
            let num_corners = self.topology.faces().corners(face).len();
            let (quads, segments) =
                if num_corners == 4 { (1, self.rate) } else { (num_corners, self.rate / 2) };
            (0..quads).map(move |corner| Grid { face, corner, num_corners, segments })
        })
    }

    /// Whether node (`i`, `j`) of `grid` is a vertex around which there are just two faces, which
    /// then share two edges in a row.
    pub fn has_two_faces(&self, grid: Grid, i: usize, j: usize) -> bool {
        let Some(corner) = grid.corner_of_face(i, j) else { return false };
        let v = self.topology.origin(self.topology.half_edge(grid.face, corner));
        self.topology.num_sectors(v) == 2 && !self.topology.is_boundary(v)
    }

    /// The number of node (`i`, `j`) of `grid`: the only place where numbers are worked out.
    pub fn node(&self, grid: Grid, i: usize, j: usize) -> u32 {
        if grid.num_corners == 4 {
            self.node_of_face(grid.face, i, j)
        } else {
            self.node_of_sector(grid, i, j)
        }
    }

    /// Node (i, j) of a face with four corners.
    fn node_of_face(&self, face: FaceId, i: usize, j: usize) -> u32 {
        let r = self.rate;
        match (i, j) {
            (i, 0) => self.node_on_rim(face, 0, i),
            (i, j) if i == r => self.node_on_rim(face, 1, j),
            (i, j) if j == r => self.node_on_rim(face, 2, r - i),
            (0, j) => self.node_on_rim(face, 3, r - j),
            (i, j) => self.face[face.index()] + ((i - 1) + (j - 1) * (r - 1)) as u32,
        }
    }

    /// Node (i, j) of a quad of an n-gon.
    ///
    /// Inside an n-gon stand its centre and then, quad by quad, the nodes with 1 <= i <= h and
    /// 1 <= j < h; the row j = h belongs to the quad before, as its column i = h.
    fn node_of_sector(&self, grid: Grid, i: usize, j: usize) -> u32 {
        let (n, k, h) = (grid.num_corners, grid.corner, grid.segments);
        let before = if k == 0 { n - 1 } else { k - 1 };
        let inside = |k: usize, i: usize, j: usize| {
            self.face[grid.face.index()] + (1 + k * h * (h - 1) + (i - 1) + (j - 1) * h) as u32
        };
        match (i, j) {
            (i, 0) => self.node_on_rim(grid.face, k, i),
            (0, j) => self.node_on_rim(grid.face, before, self.rate - j),
            (i, j) if i == h && j == h => self.face[grid.face.index()],
            (i, j) if j == h => inside(before, h, i),
            (i, j) => inside(k, i, j),
        }
    }

    /// The node `step` segments along edge `k` of `face`, from corner `k`.
    fn node_on_rim(&self, face: FaceId, k: usize, step: usize) -> u32 {
        let h = self.topology.half_edge(face, k);
        let (lower, turned) = self.lower_half_edge(h);
        let inside = |step: usize| self.edge[lower.index()] + (step - 1) as u32;
        match step {
            0 => self.vertex[self.topology.origin(h).index()],
            s if s == self.rate => self.vertex[self.topology.target(h).index()],
            s if turned => inside(self.rate - s),
            s => inside(s),
        }
    }

    /// The half-edge with the lower number of the two of an edge, and whether it is the other.
    fn lower_half_edge(&self, h: HalfEdgeId) -> (HalfEdgeId, bool) {
        match self.topology.twin(h) {
            Some(twin) if twin < h => (twin, true),
            _ => (h, false),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;

    /// A cube with one face cut into two triangles.
    fn cut_cube() -> Topology {
        let faces: [&[u32]; 7] = [
            &[0, 3, 2, 1],
            &[4, 5, 6],
            &[4, 6, 7],
            &[0, 1, 5, 4],
            &[1, 2, 6, 5],
            &[2, 3, 7, 6],
            &[3, 0, 4, 7],
        ];
        Topology::build(Mesh::new(vec![[0.0; 3]; 8], faces).faces, 8).unwrap()
    }

    #[test]
    fn every_number_is_used_and_euler_characteristic_is_kept() {
        let topology = cut_cube();
        for rate in [2, 4, 6, 10] {
            let nodes = Nodes::number(&topology, rate, |_| true).unwrap();
            let mut seen = vec![false; nodes.len()];
            let mut cells = 0;
            for grid in nodes.grids() {
                grid.nodes().for_each(|(i, j)| seen[nodes.node(grid, i, j) as usize] = true);
                cells += grid.cells().count();
            }
            assert!(seen.iter().all(|&s| s));
            // V - E + F = 2 and E = 2 F for quads.
            assert_eq!(nodes.len(), cells + 2, "rate {rate}");
        }
    }

    #[test]
    fn every_side_of_a_cell_has_a_cell_on_its_other_side() {
        let topology = cut_cube();
        for rate in [2, 4, 6] {
            let nodes = Nodes::number(&topology, rate, |_| true).unwrap();
            let mut sides = std::collections::HashSet::new();
            for grid in nodes.grids() {
                for (i, j) in grid.cells() {
                    let cell = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                        .map(|(i, j)| nodes.node(grid, i, j));
                    for k in 0..4 {
                        assert!(sides.insert((cell[k], cell[(k + 1) % 4])), "side met twice");
                    }
                }
            }
            assert!(sides.iter().all(|&(a, b)| sides.contains(&(b, a))));
        }
    }

    #[test]
    fn faces_without_surface_get_no_nodes() {
        let topology = cut_cube();
        let nodes = Nodes::number(&topology, 4, |f| f == FaceId(0)).unwrap();
        assert_eq!(nodes.len(), 25);
        assert_eq!(nodes.grids().count(), 1);
    }

    #[test]
    fn too_many_nodes_are_an_error() {
        let topology = cut_cube();
        for rate in [100_000, u32::MAX as usize - 1, usize::MAX - 1] {
            let err = Nodes::number(&topology, rate, |_| true).unwrap_err();
            assert_eq!(err, TessellateError::TooManyVertices { rate });
        }
    }
}
