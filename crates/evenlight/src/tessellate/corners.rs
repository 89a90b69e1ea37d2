//! Values of a primvar at the corners of triangles.

use super::TriangleMesh;
use crate::surface::{QuadId, Surface};

/// Values and which of them each corner of each triangle has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CornerValues {
    /// The values; numbers beyond the primvar's width are 0.
    pub values: Vec<[f64; 4]>,
    /// Per triangle the numbers of its corners' values.
    pub corners: Vec<[u32; 3]>,
}

/// Values at a vertex from two quads are one value if they differ by less than this part of the
/// largest number of the channel: over a seam they differ visibly, else by rounding.
const SAME: f64 = 1e-9;

impl TriangleMesh {
    /// The values of a primvar of `surface`, by its index, at the corners of this tessellation of
    /// it. A vertex has one value where the channel is continuous, and several at seams.
    ///
    /// `None` if there is no such primvar or the mesh is not of this surface.
    pub fn corner_values(&self, surface: &Surface, primvar: usize) -> Option<CornerValues> {
        let channel = surface.primvars().get(primvar)?;
        let largest = channel.values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let mut found = CornerValues::default();
        // The values at every vertex with the quad from which each was first seen.
        let mut at_vertex: Vec<Vec<(QuadId, u32)>> = vec![Vec::new(); self.positions.len()];
        for (triangle, place) in self.triangles.iter().zip(self.parametric_triangles()) {
            let mut corners = [0; 3];
            for k in 0..3 {
                let seen = &mut at_vertex[triangle[k] as usize];
                if let Some(&(_, number)) = seen.iter().find(|&&(quad, _)| quad == place.quad) {
                    corners[k] = number;
                    continue;
                }
                let [u, v] = place.uv[k];
                let value = surface.eval_primvar(primvar, place.quad, u, v)?.value;
                let is_same = |&&(_, number): &&(QuadId, u32)| {
                    let other = found.values[number as usize];
                    value.iter().zip(other).all(|(a, b)| (a - b).abs() <= SAME * largest)
                };
                let number = seen.iter().find(is_same).map(|&(_, number)| number);
                corners[k] = number.unwrap_or_else(|| {
                    found.values.push(value);
                    found.values.len() as u32 - 1
                });
                seen.push((place.quad, corners[k]));
            }
            found.corners.push(corners);
        }
        Some(found)
    }
}
