//! Values of primvars at the corners of triangles.

use super::{QuadTriangles, TriangleMesh};
use crate::mesh::Primvar;
use crate::parallel::map_indexed;
use crate::surface::Surface;

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
pub struct CornerChannels {
    /// The texture coordinates, the first two numbers of each value; `st` or `uv` first, the others
    /// in the order of the surface's primvars. See [`Primvar::is_uv_set`].
    pub uv_sets: Vec<CornerValues>,
    /// Red, green, blue, and opacity if the width is 4, from 0 to 1. See [`Primvar::is_color`].
    pub color: Option<CornerValues>,
}

/// Values at a vertex from two quads are one value if they differ by less than this part of the
/// largest number of the channel: over a seam they differ visibly, else by rounding.
const SAME: f64 = 1e-9;

/// No value yet.
const NONE: u32 = u32::MAX;

impl TriangleMesh {
    /// The values of a primvar of `surface`, by its index, at the corners of this tessellation of
    /// it. A vertex has one value where the channel is continuous, and several at seams.
    ///
    /// `None` if there is no such primvar or the mesh is not of this surface.
    pub fn corner_values(&self, surface: &Surface, primvar: usize) -> Option<CornerValues> {
        /// Quads whose values are held at a time, all those of their grids.
        const SLICE: usize = 256;
        let channel = surface.primvars().get(primvar)?;
        let mut found = Collector::new(channel, self.positions.len());
        found.corners.reserve_exact(self.triangles.len());
        for slice in self.quads.chunks(SLICE) {
            let grids = map_indexed(slice.len(), |k| grid_values(surface, primvar, slice[k]));
            for (&quad, grid) in slice.iter().zip(grids) {
                found.add(self, quad, &grid?)?;
            }
        }
        let Collector { values, corners, .. } = found;
        Some(CornerValues { name: channel.name.clone(), width: channel.width, values, corners })
    }

    /// The texture coordinates and the colour of `surface` at the corners of this tessellation of
    /// it.
    pub fn corner_channels(&self, surface: &Surface) -> CornerChannels {
        let primvars = || surface.primvars().iter().enumerate();
        let mut uv_sets: Vec<_> = primvars().filter(|(_, p)| p.is_uv_set()).collect();
        uv_sets.sort_by_key(|(_, p)| !p.has_uv_name());
        let color = primvars().find(|(_, p)| p.is_color());
        let values = |(k, _): (usize, &Primvar)| self.corner_values(surface, k);
        CornerChannels {
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

/// The values of a primvar at the nodes of a quad's grid, row by row.
fn grid_values(surface: &Surface, primvar: usize, quad: QuadTriangles) -> Option<Vec<[f64; 4]>> {
    let m = quad.segments;
    let parameter = |k: u32| f64::from(k) / f64::from(m);
    let nodes = (0..=m).flat_map(|j| (0..=m).map(move |i| (i, j)));
    let value = |(i, j)| surface.eval_primvar(primvar, quad.quad, parameter(i), parameter(j));
    nodes.map(|node| value(node).map(|jet| jet.value)).collect()
}

/// Gathers values, quad by quad.
struct Collector {
    values: Vec<[f64; 4]>,
    corners: Vec<[u32; 3]>,
    /// How far values may differ to be one.
    tolerance: f64,
    /// The first value of every vertex.
    first: Vec<u32>,
    /// For every value the next one of the same vertex.
    next: Vec<u32>,
}

impl Collector {
    fn new(channel: &Primvar, num_vertices: usize) -> Self {
        let largest = channel.values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        Self {
            values: Vec::new(),
            corners: Vec::new(),
            tolerance: SAME * largest,
            first: vec![NONE; num_vertices],
            next: Vec::new(),
        }
    }

    /// Adds the triangles of `quad`, on whose grid the channel has the values `grid`.
    fn add(&mut self, mesh: &TriangleMesh, quad: QuadTriangles, grid: &[[f64; 4]]) -> Option<()> {
        let m = quad.segments as usize;
        let mut numbers = vec![NONE; grid.len()];
        for triangle in quad.first..quad.first + 2 * m * m {
            let vertices = mesh.triangles.get(triangle)?;
            let nodes = mesh.grid_nodes(quad, triangle);
            let mut corners = [NONE; 3];
            for ((corner, &vertex), (i, j)) in corners.iter_mut().zip(vertices).zip(nodes) {
                let node = i + j * (m + 1);
                if numbers[node] == NONE {
                    numbers[node] = self.number(vertex, grid[node]);
                }
                *corner = numbers[node];
            }
            self.corners.push(corners);
        }
        Some(())
    }

    /// The number of `value` at `vertex`, which is added unless it is there.
    fn number(&mut self, vertex: u32, value: [f64; 4]) -> u32 {
        let first = self.first[vertex as usize];
        let mut seen = first;
        while seen != NONE {
            let other = self.values[seen as usize];
            if value.iter().zip(other).all(|(a, b)| (a - b).abs() <= self.tolerance) {
                return seen;
            }
            seen = self.next[seen as usize];
        }
        let number = self.values.len() as u32;
        self.values.push(value);
        self.next.push(first);
        self.first[vertex as usize] = number;
        number
    }
}
