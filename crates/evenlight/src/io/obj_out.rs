//! Triangle meshes as Wavefront OBJ, with normals.
//!
//! ```text
//! v x y z              one line for each vertex
//! vn x y z             one line for each vertex, in the same order
//! f a//a b//b c//c     one line for each triangle, counted from 1
//! ```

use std::io::{self, Write};

use super::digits::Triple;
use crate::tessellate::TriangleMesh;

/// Writes `mesh` as OBJ: positions in the units of the cage, unit normals.
///
/// Numbers have the fewest digits from which the same `f64` is read again. A normal that does
/// not exist is written as `0 0 0`. Writes many small pieces: give it something with a buffer.
pub fn write(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    for &p in &mesh.positions {
        writeln!(out, "v {}", Triple(p))?;
    }
    for &n in &mesh.normals {
        writeln!(out, "vn {}", Triple(n))?;
    }
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| u64::from(v) + 1);
        writeln!(out, "f {a}//{a} {b}//{b} {c}//{c}")?;
    }
    Ok(())
}
