//! Triangle meshes as Wavefront OBJ, with normals and, if there are, texture coordinates.
//!
//! ```text
//! v x y z              one line for each vertex
//! vt u v               one line for each texture coordinate
//! vn x y z             one line for each vertex, in the same order
//! f a//a b//b c//c     one line for each triangle, counted from 1; with texture coordinates
//! f a/s/a b/t/b c/u/c
//! ```

use std::io::{self, Write};

use super::digits::{Digits, Triple};
use crate::tessellate::{CornerValues, TriangleMesh};

/// Writes `mesh` as OBJ: positions in the units of the cage, unit normals.
///
/// Numbers have the fewest digits from which the same `f64` is read again. A normal that does
/// not exist is written as `0 0 0`. Writes many small pieces: give it something with a buffer.
pub fn write(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    write_positions(mesh, out)?;
    write_normals(mesh, out)?;
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| u64::from(v) + 1);
        writeln!(out, "f {a}//{a} {b}//{b} {c}//{c}")?;
    }
    Ok(())
}

/// Writes `mesh` as [`write()`] does, with the first two numbers of `texture` at its corners
/// ([`TriangleMesh::corner_values`] of the same mesh).
pub fn write_textured(
    mesh: &TriangleMesh,
    texture: &CornerValues,
    out: &mut impl Write,
) -> io::Result<()> {
    write_positions(mesh, out)?;
    for &[u, v, ..] in &texture.values {
        writeln!(out, "vt {} {}", Digits(u), Digits(v))?;
    }
    write_normals(mesh, out)?;
    for (triangle, values) in mesh.triangles.iter().zip(&texture.corners) {
        out.write_all(b"f")?;
        for (&vertex, &value) in triangle.iter().zip(values) {
            let [v, t] = [vertex, value].map(|number| u64::from(number) + 1);
            write!(out, " {v}/{t}/{v}")?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

fn write_positions(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    mesh.positions.iter().try_for_each(|&p| writeln!(out, "v {}", Triple(p)))
}

fn write_normals(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    mesh.normals.iter().try_for_each(|&n| writeln!(out, "vn {}", Triple(n)))
}
