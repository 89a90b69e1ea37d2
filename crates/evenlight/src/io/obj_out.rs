//! Triangle meshes as Wavefront OBJ, with normals and, if there are, texture coordinates and
//! colours.
//!
//! ```text
//! v x y z              one line for each vertex
//! v x y z r g b        with colours, from 0 to 1: a habit of many programs
//! vt u v               one line for each texture coordinate
//! vn x y z             one line for each side of a vertex (of smooth meshes, for each vertex)
//! f a//n b//m c//o     one line for each triangle, counted from 1; with texture coordinates
//! f a/s/n b/t/m c/u/o
//! ```
//!
//! Positions, texture coordinates and normals have numbers of their own, so that the mesh stays
//! watertight, has hard edges where the surface is folded and seams where the texture has some. One
//! set of texture coordinates fits in.

use std::io::{self, Write};

use super::digits::{Digits, Triple};
use crate::tessellate::{CornerPrimvars, CornerValues, TriangleMesh};

/// Writes `mesh` as OBJ: positions in the units of the cage, unit normals.
///
/// Numbers have the fewest digits from which the same `f64` is read again. A normal that does
/// not exist is written as `0 0 0`. Writes many small pieces: give it something with a buffer.
pub fn write(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    write_textured(mesh, &CornerPrimvars::default(), out)
}

/// Writes `mesh` as [`write()`] does, with its primvars ([`TriangleMesh::corner_primvars`]) as far
/// as OBJ can hold them ([`omitted`]).
pub fn write_textured(
    mesh: &TriangleMesh,
    primvars: &CornerPrimvars,
    out: &mut impl Write,
) -> io::Result<()> {
    write_positions(mesh, primvars.color.as_ref(), out)?;
    let texture = primvars.uv_sets.first();
    for &[u, v, ..] in texture.map_or(&[][..], |texture| &texture.values) {
        writeln!(out, "vt {} {}", Digits(u), Digits(v))?;
    }
    mesh.normals.iter().try_for_each(|&n| writeln!(out, "vn {}", Triple(n)))?;
    for (t, (triangle, sides)) in mesh.triangles.iter().zip(mesh.sides()).enumerate() {
        out.write_all(b"f")?;
        for (k, (&vertex, &side)) in triangle.iter().zip(sides).enumerate() {
            let [v, n] = [vertex, side].map(|number| u64::from(number) + 1);
            match texture.and_then(|texture| texture.corners.get(t)) {
                Some(values) => write!(out, " {v}/{}/{n}", u64::from(values[k]) + 1)?,
                None => write!(out, " {v}//{n}")?,
            }
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

/// What [`write_textured`] leaves out, in sentences.
pub fn omitted(mesh: &TriangleMesh, primvars: &CornerPrimvars) -> Vec<String> {
    let sets = primvars.uv_sets.iter().skip(1).map(|set| {
        format!("OBJ has one set of texture coordinates: the primvar `{}` is left out", set.name)
    });
    let color = primvars.color.iter().filter(|color| color.of_vertices(mesh).is_none());
    let seams = color.map(|color| {
        format!("OBJ has one colour for a vertex: the primvar `{}` is left out", color.name)
    });
    let color = primvars.color.iter().filter(|color| color.width == 4);
    let opacity = color.map(|color| {
        format!("OBJ has no opacity: that of the primvar `{}` is left out", color.name)
    });
    sets.chain(seams).chain(opacity).collect()
}

fn write_positions(
    mesh: &TriangleMesh,
    color: Option<&CornerValues>,
    out: &mut impl Write,
) -> io::Result<()> {
    let colors = color.and_then(|color| Some((color, color.of_vertices(mesh)?)));
    for (k, &p) in mesh.positions.iter().enumerate() {
        match &colors {
            Some((color, numbers)) => {
                let [r, g, b, _] = color.values[numbers[k] as usize];
                writeln!(out, "v {} {}", Triple(p), Triple([r, g, b]))?;
            }
            None => writeln!(out, "v {}", Triple(p))?,
        }
    }
    Ok(())
}
