//! Triangle meshes as flat arrays of the caller's.

use super::TriangleMesh;
use crate::surface::{ArrayError, Number};

/// Arrays to be filled by [`TriangleMesh::write_arrays`]; those that are `None` are left out.
///
/// Entries are in the order of the mesh: a row per vertex, or per side ([`TriangleMesh`]), or per
/// triangle.
#[derive(Debug)]
pub struct TriangleArrays<'a, T> {
    /// x, y, z of every vertex.
    pub positions: Option<&'a mut [T]>,
    /// The unit normal of every side.
    pub normals: Option<&'a mut [T]>,
    /// K and H of every side.
    pub curvature: Option<&'a mut [T]>,
    /// The corners of every triangle, as numbers of vertices.
    pub triangles: Option<&'a mut [u32]>,
    /// The corners of every triangle, as numbers of sides.
    pub corner_sides: Option<&'a mut [u32]>,
}

impl<T> Default for TriangleArrays<'_, T> {
    fn default() -> Self {
        Self {
            positions: None,
            normals: None,
            curvature: None,
            triangles: None,
            corner_sides: None,
        }
    }
}

impl TriangleMesh {
    /// Fills arrays of the caller's with numbers of `f64` or `f32`.
    ///
    /// ```
    /// use evenlight::tessellate::{TriangleArrays, tessellate};
    /// use evenlight::{Cage, Mesh, Surface, SurfaceOptions};
    ///
    /// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    /// let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]]))?;
    /// let mesh = tessellate(&Surface::build(cage, SurfaceOptions::default())?, 1)?;
    /// let (mut positions, mut triangles) = ([0.0_f32; 4 * 3], [0; 2 * 3]);
    /// mesh.write_arrays(TriangleArrays {
    ///     positions: Some(&mut positions),
    ///     triangles: Some(&mut triangles),
    ///     ..TriangleArrays::default()
    /// })?;
    /// assert_eq!((positions[3], triangles[1]), (1.0, 1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ArrayError::Length`] if an array has not as many entries as the mesh has; no array is
    /// changed.
    pub fn write_arrays<T: Number>(&self, arrays: TriangleArrays<'_, T>) -> Result<(), ArrayError> {
        let TriangleArrays { positions, normals, curvature, triangles, corner_sides } = arrays;
        let (vertices, sides) = (self.positions.len(), self.normals.len());
        check("positions", positions.as_deref(), 3 * vertices)?;
        check("normals", normals.as_deref(), 3 * sides)?;
        check("curvature", curvature.as_deref(), 2 * sides)?;
        check("triangles", triangles.as_deref(), 3 * self.triangles.len())?;
        check("corner_sides", corner_sides.as_deref(), 3 * self.triangles.len())?;
        copy(positions, self.positions.as_flattened());
        copy(normals, self.normals.as_flattened());
        for (row, (&k, &h)) in
            curvature.unwrap_or_default().chunks_exact_mut(2).zip(self.gauss.iter().zip(&self.mean))
        {
            (row[0], row[1]) = (T::of(k), T::of(h));
        }
        if let Some(array) = triangles {
            array.copy_from_slice(self.triangles.as_flattened());
        }
        if let Some(array) = corner_sides {
            array.copy_from_slice(self.sides().as_flattened());
        }
        Ok(())
    }
}

fn check<T>(what: &'static str, array: Option<&[T]>, expected: usize) -> Result<(), ArrayError> {
    match array {
        Some(array) if array.len() != expected => {
            Err(ArrayError::Length { what, expected, found: array.len() })
        }
        _ => Ok(()),
    }
}

fn copy<T: Number>(array: Option<&mut [T]>, numbers: &[f64]) {
    for (to, &x) in array.unwrap_or_default().iter_mut().zip(numbers) {
        *to = T::of(x);
    }
}
