//! Triangle meshes as binary PLY, with normals, curvatures, texture coordinates and a colour.
//!
//! Each vertex has these properties, in this order, little endian:
//!
//! | property | type | |
//! | --- | --- | --- |
//! | `x`, `y`, `z` | `double` | position, in the units of the cage |
//! | `nx`, `ny`, `nz` | `float` | unit normal |
//! | `gauss_curvature` | `float` | K, in 1/length^2 |
//! | `mean_curvature` | `float` | H, in 1/length; negative on convex bodies |
//! | `red`, `green`, `blue`, `alpha` | `uchar` | 0 to 255, if there is a colour without seams |
//!
//! and each face the list `vertex_indices` of three `int` with a `uchar` count, and if there are
//! texture coordinates the list `texcoord` of six `float`: u and v of its three corners. These are
//! the names and types that MeshLab and ParaView look for; both read `double` positions beside
//! `float` normals (Blender leaves `texcoord` out). PLY has no standard name for curvature: general
//! readers hand it on under the names above, Blender takes it as attributes, MeshLab and ParaView
//! leave it out.
//!
//! A vertex has one normal. Along infinitely sharp edges, where the surface has several, vertices
//! are not split, so that the mesh stays watertight: they have the normal and the curvature of one
//! side ([`TriangleMesh::sides`]). Files of glTF and OBJ have all.

use std::io::{self, Write};

use crate::tessellate::{CornerPrimvars, CornerValues, TriangleMesh};

/// Writes `mesh` as binary PLY, without texture coordinates and colours. Writes many small pieces:
/// give it something with a buffer.
///
/// # Errors
///
/// What `out` reports; and `InvalidInput`, before anything is written, for more than 2^31
/// vertices, since the indices of this format are signed.
pub fn write(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    write_textured(mesh, &CornerPrimvars::default(), out)
}

/// Writes `mesh` as [`write()`] does, with its primvars ([`TriangleMesh::corner_primvars`]) as far
/// as PLY can hold them ([`omitted`]).
///
/// # Errors
///
/// Those of [`write()`].
pub fn write_textured(
    mesh: &TriangleMesh,
    primvars: &CornerPrimvars,
    out: &mut impl Write,
) -> io::Result<()> {
    check_size(mesh.positions.len())?;
    let texture = primvars.uv_sets.first();
    let colors = primvars.color.as_ref().and_then(|color| bytes(mesh, color));
    write_header(mesh, texture.is_some(), colors.as_ref().map_or(0, |c| c.width), out)?;
    for (v, p) in mesh.positions.iter().enumerate() {
        p.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        let shape = mesh.normals[v].iter().chain([&mesh.gauss[v], &mesh.mean[v]]);
        shape.copied().try_for_each(|x| out.write_all(&(x as f32).to_le_bytes()))?;
        if let Some(Colors { width, bytes }) = &colors {
            out.write_all(&bytes[v][..*width])?;
        }
    }
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        out.write_all(&[3])?;
        triangle.iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))?;
        if let Some(texture) = texture {
            out.write_all(&[6])?;
            let corners = texture.corners.get(t).copied().unwrap_or_default();
            let uvs = corners.map(|k| texture.values.get(k as usize).copied().unwrap_or_default());
            let mut numbers = uvs.iter().flat_map(|uv| &uv[..2]);
            numbers.try_for_each(|&x| out.write_all(&(x as f32).to_le_bytes()))?;
        }
    }
    Ok(())
}

/// What [`write_textured`] leaves out, in sentences.
pub fn omitted(mesh: &TriangleMesh, primvars: &CornerPrimvars) -> Vec<String> {
    let folded = mesh.is_folded().then(|| {
        "PLY has one normal for a vertex: on sharp edges it is that of one side (.glb and .obj have all)"
            .to_owned()
    });
    let sets = primvars.uv_sets.iter().skip(1).map(|set| {
        format!("PLY has one set of texture coordinates: the primvar `{}` is left out", set.name)
    });
    let color = primvars.color.iter().filter(|color| color.of_vertices(mesh).is_none());
    let seams = color.map(|color| {
        format!("PLY has one colour for a vertex: the primvar `{}` is left out", color.name)
    });
    folded.into_iter().chain(sets).chain(seams).collect()
}

/// The colours of vertices.
struct Colors {
    /// 3, or 4 with opacity.
    width: usize,
    bytes: Vec<[u8; 4]>,
}

/// Colours as bytes; `None` if a vertex has several.
fn bytes(mesh: &TriangleMesh, color: &CornerValues) -> Option<Colors> {
    let numbers = color.of_vertices(mesh)?;
    let byte = |x: f64| (255.0 * x.clamp(0.0, 1.0)).round() as u8;
    let bytes = numbers.into_iter().map(|number| color.values[number as usize].map(byte)).collect();
    Some(Colors { width: color.width.clamp(3, 4), bytes })
}

fn write_header(
    mesh: &TriangleMesh,
    has_texture: bool,
    color_width: usize,
    out: &mut impl Write,
) -> io::Result<()> {
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
         property float mean_curvature\n"
    )?;
    for name in ["red", "green", "blue", "alpha"].iter().take(color_width) {
        writeln!(out, "property uchar {name}")?;
    }
    writeln!(out, "element face {faces}\nproperty list uchar int vertex_indices")?;
    if has_texture {
        writeln!(out, "property list uchar float texcoord")?;
    }
    writeln!(out, "end_header")
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
