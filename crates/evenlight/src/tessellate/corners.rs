//! Values of primvars at the corners of triangles.

use super::{QuadTriangles, TriangleMesh};
use crate::mesh::{FaceId, HalfEdgeId, Interpolation, Primvar, Topology};
use crate::surface::Surface;
use crate::task::map_indexed;

/// Values and which of them each corner of each triangle has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CornerValues {
    /// The name of the primvar.
    pub name: String,
    /// The numbers in a value, 1 to 4.
    pub width: usize,
    /// The values; numbers beyond the width are 0.
    pub values: Vec<[f64; 4]>,
    /// Per triangle the numbers of its corners' values.
    pub corners: Vec<[u32; 3]>,
}

/// What the files of triangles hold beside normals: texture coordinates and a colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CornerPrimvars {
    /// The texture coordinates, the first two numbers of each value; `st` or `uv` first, the others
    /// in the order of the surface's primvars. See [`Primvar::is_uv_set`].
    pub uv_sets: Vec<CornerValues>,
    /// Red, green, blue, and opacity if the width is 4, from 0 to 1. See [`Primvar::is_color`].
    pub color: Option<CornerValues>,
}

/// No value yet.
const NONE: u32 = u32::MAX;

impl TriangleMesh {
    /// The values of a primvar of `surface`, by its index, at the corners of this tessellation of
    /// it. A vertex has one value where the primvar is continuous, and several at seams.
    ///
    /// `None` if there is no such primvar or the mesh is not of this surface.
    pub fn corner_values(&self, surface: &Surface, primvar: usize) -> Option<CornerValues> {
        /// Quads whose values are held at a time, all those of their grids.
        const SLICE: usize = 256;
        let of_cage = surface.primvars().get(primvar)?;
        let seams = Seams { topology: surface.topology(), primvar: of_cage };
        let mut found = Collector::new(seams, self.positions.len());
        found.corners.reserve_exact(self.triangles.len());
        for slice in self.quads.chunks(SLICE) {
            let grids = map_indexed(slice.len(), |k| grid_values(surface, primvar, slice[k]));
            for (&quad, grid) in slice.iter().zip(grids) {
                found.add(self, surface.face_of(quad.quad)?, quad, &grid?)?;
            }
        }
        let Collector { values, corners, .. } = found;
        let (name, width) = (of_cage.name.clone(), of_cage.width);
        Some(CornerValues { name, width, values, corners })
    }

    /// The texture coordinates and the colour of `surface` at the corners of this tessellation of
    /// it.
    pub fn corner_primvars(&self, surface: &Surface) -> CornerPrimvars {
        let primvars = || surface.primvars().iter().enumerate();
        let mut uv_sets: Vec<_> = primvars().filter(|(_, p)| p.is_uv_set()).collect();
        uv_sets.sort_by_key(|(_, p)| !p.has_uv_name());
        let color = primvars().find(|(_, p)| p.is_color());
        let values = |(k, _): (usize, &Primvar)| self.corner_values(surface, k);
        CornerPrimvars {
            uv_sets: uv_sets.into_iter().filter_map(values).collect(),
            color: color.and_then(values),
        }
    }
}

impl CornerValues {
    /// The number of the value of each vertex of `mesh`, at whose corners these are; `None` if a
    /// vertex has several values or none.
    pub fn of_vertices(&self, mesh: &TriangleMesh) -> Option<Vec<u32>> {
        let mut numbers = vec![NONE; mesh.positions.len()];
        let corners = mesh.triangles.as_flattened().iter().zip(self.corners.as_flattened());
        for (&vertex, &number) in corners {
            let own = numbers.get_mut(vertex as usize)?;
            if *own != NONE && *own != number {
                return None;
            }
            *own = number;
        }
        let has_values = numbers.iter().all(|&number| (number as usize) < self.values.len());
        has_values.then_some(numbers)
    }
}

/// The values of a primvar at the nodes (i, j) of a quad's grid, j fastest.
fn grid_values(surface: &Surface, primvar: usize, quad: QuadTriangles) -> Option<Vec<[f64; 4]>> {
    let m = quad.segments;
    let lines: Vec<f64> = (0..=m).map(|k| f64::from(k) / f64::from(m)).collect();
    surface.primvar_grid(primvar, quad.quad, &lines, &lines)
}

/// Where a primvar is not continuous: topology knows, however near values are to each other.
struct Seams<'a> {
    topology: &'a Topology,
    primvar: &'a Primvar,
}

/// Which of the values at a vertex is meant: those seen from two faces are one if their sides are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    /// There is one value only.
    All,
    /// At a vertex of the cage the value with this number.
    Value(u32),
    /// Inside a seam: the value of a face.
    Face(FaceId),
}

impl Seams<'_> {
    /// The side of node (i, j) of a grid of m segments on the quad at `corner` of `face`.
    fn side(&self, (face, corner): (FaceId, usize), m: usize, (i, j): (usize, usize)) -> Side {
        if self.primvar.interpolation != Interpolation::FaceVarying {
            return Side::All;
        }
        let size = self.topology.faces().corners(face).len();
        let at = |k: usize| self.topology.half_edge(face, k % size);
        let (first, last) = if size == 4 { (0, 3) } else { (corner, corner + size - 1) };
        let whole = size == 4;
        match (i, j) {
            (0, 0) => self.at_corner(at(first)),
            (i, 0) if whole && i == m => self.at_corner(at(1)),
            (0, j) if whole && j == m => self.at_corner(at(3)),
            (i, j) if whole && i == m && j == m => self.at_corner(at(2)),
            (_, 0) => self.on_edge(at(first)),
            (0, _) => self.on_edge(at(last)),
            (i, _) if whole && i == m => self.on_edge(at(1)),
            (_, j) if whole && j == m => self.on_edge(at(2)),
            _ => Side::All,
        }
    }

    fn at_corner(&self, h: HalfEdgeId) -> Side {
        Side::Value(self.value(h))
    }

    fn on_edge(&self, h: HalfEdgeId) -> Side {
        let Some(twin) = self.topology.twin(h) else { return Side::All };
        let next = |h| self.topology.next(h);
        let is_seam =
            self.value(h) != self.value(next(twin)) || self.value(next(h)) != self.value(twin);
        if is_seam { Side::Face(self.topology.face(h)) } else { Side::All }
    }

    /// The number of the value at the corner that `h` leaves.
    fn value(&self, h: HalfEdgeId) -> u32 {
        self.primvar.indices[h.index()]
    }
}

/// Gathers values, quad by quad.
struct Collector<'a> {
    seams: Seams<'a>,
    values: Vec<[f64; 4]>,
    /// The side of every value.
    sides: Vec<Side>,
    corners: Vec<[u32; 3]>,
    /// The first value of every vertex.
    first: Vec<u32>,
    /// For every value the next one of the same vertex.
    next: Vec<u32>,
}

impl<'a> Collector<'a> {
    fn new(seams: Seams<'a>, num_vertices: usize) -> Self {
        Self {
            seams,
            values: Vec::new(),
            sides: Vec::new(),
            corners: Vec::new(),
            first: vec![NONE; num_vertices],
            next: Vec::new(),
        }
    }

    /// Adds the triangles of `quad`, at a corner of a face, on whose grid the primvar has the
    /// values `grid`.
    fn add(
        &mut self,
        mesh: &TriangleMesh,
        place: (FaceId, usize),
        quad: QuadTriangles,
        grid: &[[f64; 4]],
    ) -> Option<()> {
        let m = quad.segments as usize;
        let mut numbers = vec![NONE; grid.len()];
        for triangle in quad.first..quad.first + 2 * m * m {
            let vertices = mesh.triangles.get(triangle)?;
            let nodes = mesh.grid_nodes(quad, triangle);
            let mut corners = [NONE; 3];
            for ((corner, &vertex), (i, j)) in corners.iter_mut().zip(vertices).zip(nodes) {
                let node = i * (m + 1) + j;
                if numbers[node] == NONE {
                    let side = self.seams.side(place, m, (i, j));
                    numbers[node] = self.number(vertex, side, grid[node]);
                }
                *corner = numbers[node];
            }
            self.corners.push(corners);
        }
        Some(())
    }

    /// The number of the value on a side of `vertex`, which is added unless it is there.
    fn number(&mut self, vertex: u32, side: Side, value: [f64; 4]) -> u32 {
        let first = self.first[vertex as usize];
        let mut seen = first;
        while seen != NONE {
            if self.sides[seen as usize] == side {
                return seen;
            }
            seen = self.next[seen as usize];
        }
        let number = self.values.len() as u32;
        self.values.push(value);
        self.sides.push(side);
        self.next.push(first);
        self.first[vertex as usize] = number;
        number
    }
}
