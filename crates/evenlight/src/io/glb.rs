//! Triangle meshes as binary glTF 2.0, with normals and curvatures.
//!
//! ```text
//! "glTF" 2 LENGTH                       12 bytes, like all of it little endian
//! LENGTH "JSON" { what is where }       padded with blanks to 4 bytes
//! LENGTH "BIN\0"                        positions, normals, K, H of all vertices, then triangles
//! ```
//!
//! | attribute | type | |
//! | --- | --- | --- |
//! | `POSITION` | 3 floats | in the units of the cage (readers take metres, y up) |
//! | `NORMAL` | 3 floats | unit normal of the surface |
//! | `_GAUSS_CURVATURE` | float | K in 1/length^2 |
//! | `_MEAN_CURVATURE` | float | H in 1/length; negative on convex bodies |
//!
//! The format knows no values that do not exist: in their place stand the normal (0, 0, 1) and
//! the curvature 0. All numbers are rounded to 32 bits, the positions of a vertex alike in all its
//! triangles.

use std::io::{self, Write};

use crate::point::Vector;
use crate::tessellate::TriangleMesh;

/// Writes `mesh` as a binary glTF file. Writes many small pieces: give it something with a buffer.
///
/// # Errors
///
/// What `out` reports; and `InvalidInput`, before anything is written, for a mesh without
/// triangles, for one that takes 2^32 bytes or more, and for a position that does not fit into 32
/// bits.
pub fn write(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    let bin_len = sections(mesh).iter().map(|section| section.len).sum::<usize>();
    let json = json(mesh)?;
    let total = 12 + 8 + json.len() + 8 + bin_len;
    let [total, json_len, bin_len] =
        [total, json.len(), bin_len].map(|len| u32::try_from(len).unwrap_or(u32::MAX));
    if total == u32::MAX {
        return Err(invalid(
            "the mesh takes 2^32 bytes or more, too many for glTF: lower the rate",
        ));
    }
    out.write_all(b"glTF")?;
    [2, total, json_len].iter().try_for_each(|word| out.write_all(&word.to_le_bytes()))?;
    out.write_all(b"JSON")?;
    out.write_all(json.as_bytes())?;
    out.write_all(&bin_len.to_le_bytes())?;
    out.write_all(b"BIN\0")?;
    write_values(mesh, out)
}

/// A run of bytes with values of one kind.
struct Section {
    /// The attribute; empty for the corners of triangles.
    name: &'static str,
    /// As in `VEC3`.
    kind: &'static str,
    /// How many values there are.
    count: usize,
    /// The number of bytes, a multiple of 4.
    len: usize,
}

/// What is behind each other in the binary part.
fn sections(mesh: &TriangleMesh) -> [Section; 5] {
    let n = mesh.positions.len();
    let section = |name, kind, count: usize, width: usize| Section {
        name,
        kind,
        count,
        len: 4 * width * count,
    };
    [
        section("POSITION", "VEC3", n, 3),
        section("NORMAL", "VEC3", n, 3),
        section("_GAUSS_CURVATURE", "SCALAR", n, 1),
        section("_MEAN_CURVATURE", "SCALAR", n, 1),
        section("", "SCALAR", 3 * mesh.triangles.len(), 1),
    ]
}

/// The description of the binary part, padded.
fn json(mesh: &TriangleMesh) -> io::Result<String> {
    const FLOAT: u32 = 5126;
    const UNSIGNED_INT: u32 = 5125;
    const ARRAY_BUFFER: u32 = 34962;
    const ELEMENT_ARRAY_BUFFER: u32 = 34963;
    let [low, high] = bounds(mesh)?;
    let (mut views, mut accessors, mut attributes) = (vec![], vec![], vec![]);
    let mut offset = 0;
    for (k, Section { name, kind, count, len }) in sections(mesh).into_iter().enumerate() {
        let is_index = name.is_empty();
        let (target, scalar) =
            if is_index { (ELEMENT_ARRAY_BUFFER, UNSIGNED_INT) } else { (ARRAY_BUFFER, FLOAT) };
        views.push(format!(
            r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{len},"target":{target}}}"#
        ));
        let range =
            if k == 0 { format!(r#","min":{low:?},"max":{high:?}"#) } else { String::new() };
        accessors.push(format!(
            r#"{{"bufferView":{k},"componentType":{scalar},"count":{count},"type":"{kind}"{range}}}"#
        ));
        if !is_index {
            attributes.push(format!(r#""{name}":{k}"#));
        }
        offset += len;
    }
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0","generator":"Evenlight"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{{}}},"indices":{},"mode":4}}]}}],"buffers":[{{"byteLength":{offset}}}],"bufferViews":[{}],"accessors":[{}]}}"#,
        attributes.join(","),
        attributes.len(),
        views.join(","),
        accessors.join(",")
    );
    json.push_str(&"   "[..(4 - json.len() % 4) % 4]);
    Ok(json)
}

/// The lowest and the highest coordinates as they are written, which the format demands.
fn bounds(mesh: &TriangleMesh) -> io::Result<[[f32; 3]; 2]> {
    if mesh.triangles.is_empty() {
        return Err(invalid("a glTF file needs a triangle"));
    }
    let mut bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    for p in mesh.positions.iter().map(|p| p.map(|x| x as f32)) {
        if !p.iter().all(|x| x.is_finite()) {
            return Err(invalid(
                "a coordinate is too large for the 32 bits of glTF: scale the cage",
            ));
        }
        for k in 0..3 {
            bounds[0][k] = bounds[0][k].min(p[k]);
            bounds[1][k] = bounds[1][k].max(p[k]);
        }
    }
    Ok(bounds)
}

fn write_values(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    let mut float = |x: f64| out.write_all(&(x as f32).to_le_bytes());
    mesh.positions.iter().flatten().try_for_each(|&x| float(x))?;
    for &normal in &mesh.normals {
        existing_normal(normal).iter().try_for_each(|&x| float(x))?;
    }
    for &curvature in mesh.gauss.iter().chain(&mesh.mean) {
        float(if (curvature as f32).is_finite() { curvature } else { 0.0 })?;
    }
    mesh.triangles.iter().flatten().try_for_each(|v| out.write_all(&v.to_le_bytes()))
}

fn existing_normal(normal: Vector) -> Vector {
    if normal.iter().all(|x| x.is_finite()) { normal } else { [0.0, 0.0, 1.0] }
}

fn invalid(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message)
}
