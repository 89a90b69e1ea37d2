//! Triangle meshes as binary PLY, with normals and curvatures.
//!
//! Each vertex has these properties, in this order, little endian:
//!
//! | property | type | |
//! | --- | --- | --- |
//! | `x`, `y`, `z` | `double` | position, in the units of the cage |
//! | `nx`, `ny`, `nz` | `float` | unit normal |
//! | `gauss_curvature` | `float` | K, in 1/length^2 |
//! | `mean_curvature` | `float` | H, in 1/length; negative on convex bodies |
//!
//! and each face the list `vertex_indices` of three `int` with a `uchar` count. These are the
//! names and types that MeshLab and ParaView look for; both read `double` positions beside
//! `float` normals. PLY has no standard name for curvature: general readers hand it on under
//! the names above, Blender takes it as attributes, MeshLab and ParaView leave it out.

use std::io::{self, Write};

use crate::tessellate::TriangleMesh;

/// Writes `mesh` as binary PLY. Writes many small pieces: give it something with a buffer.
///
/// # Errors
///
/// What `out` reports; and `InvalidInput`, before anything is written, for more than 2^31
/// vertices, since the indices of this format are signed.
pub fn write(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    check_size(mesh.positions.len())?;
    write_header(mesh, out)?;
    let curvatures = mesh.gauss.iter().zip(&mesh.mean);
    for ((p, n), (&gauss, &mean)) in mesh.positions.iter().zip(&mesh.normals).zip(curvatures) {
        p.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        n.iter()
            .chain([&gauss, &mean])
            .try_for_each(|&x| out.write_all(&(x as f32).to_le_bytes()))?;
    }
    for triangle in &mesh.triangles {
        out.write_all(&[3])?;
        triangle.iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))?;
    }
    Ok(())
}

fn write_header(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    let (vertices, faces) = (mesh.positions.len(), mesh.triangles.len());
    write!(
        out,
        "ply\n\
         format binary_little_endian 1.0\n\
         comment Evenlight: points of the limit surface with its normals and curvatures\n\
         comment x y z in units of the cage; gauss_curvature K in 1/unit^2;\n\
         comment mean_curvature H in 1/unit, negative on convex bodies\n\
         element vertex {vertices}\n\
         property double x\n\
         property double y\n\
         property double z\n\
         property float nx\n\
         property float ny\n\
         property float nz\n\
         property float gauss_curvature\n\
         property float mean_curvature\n\
         element face {faces}\n\
         property list uchar int vertex_indices\n\
         end_header\n"
    )
}

/// Whether the last index fits into a signed 32-bit number.
fn check_size(num_vertices: usize) -> io::Result<()> {
    if num_vertices <= 1 << 31 {
        return Ok(());
    }
    let message = format!("{num_vertices} vertices are too many for PLY (at most 2^31)");
    Err(io::Error::new(io::ErrorKind::InvalidInput, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_must_fit_into_signed_numbers() {
        assert!(check_size(1 << 31).is_ok());
        let err = check_size((1 << 31) + 1).unwrap_err();
        assert_eq!(err.kind(), io::ErrorKind::InvalidInput);
    }
}
