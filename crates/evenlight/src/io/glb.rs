//! Triangle meshes as binary glTF 2.0, with normals, curvatures, texture coordinates and a colour.
//!
//! ```text
//! "glTF" 2 LENGTH                       12 bytes, like all of it little endian
//! LENGTH "JSON" { what is where }       padded with blanks to 4 bytes
//! LENGTH "BIN\0"                        each attribute of all vertices, then triangles
//! ```
//!
//! | attribute | type | |
//! | --- | --- | --- |
//! | `POSITION` | 3 floats | in the units of the cage (readers take metres, y up) |
//! | `NORMAL` | 3 floats | unit normal of the surface |
//! | `_GAUSS_CURVATURE` | float | K in 1/length^2 |
//! | `_MEAN_CURVATURE` | float | H in 1/length; negative on convex bodies |
//! | `TEXCOORD_0`, `TEXCOORD_1`, ... | 2 floats | (u, 1 - v): the origin of images is their upper left corner, ours is the lower left one |
//! | `COLOR_0` | 3 or 4 floats | cut to 0..1, as the format demands; it takes them as linear light |
//!
//! A vertex of the format has one value of each attribute. Vertices are therefore split along
//! infinitely sharp edges and the seams of primvars ([`TriangleMesh::split`]), and welding them by
//! position gives the watertight mesh: positions are rounded alike in all triangles of a vertex.
//!
//! The format knows no values that do not exist: in their place stand the normal (0, 0, 1) and 0.
//! All numbers are rounded to 32 bits. The material is plain and no metal, which the format's own
//! default is.

use std::io::{self, Write};

use crate::point::Vector;
use crate::tessellate::{CornerPrimvars, CornerValues, SplitVertices, TriangleMesh};

/// Writes `mesh` as a binary glTF file, without texture coordinates and colours. Writes many small
/// pieces: give it something with a buffer.
///
/// # Errors
///
/// What `out` reports; and `InvalidInput`, before anything is written, for a mesh without
/// triangles, for one that takes 2^32 bytes or more, and for a position that does not fit into 32
/// bits.
pub fn write(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    write_textured(mesh, &CornerPrimvars::default(), out)
}

/// Writes `mesh` as [`write()`] does, with its primvars ([`TriangleMesh::corner_primvars`]).
///
/// # Errors
///
/// Those of [`write()`]; and `InvalidInput` for primvars that are not of this mesh.
pub fn write_textured(
    mesh: &TriangleMesh,
    primvars: &CornerPrimvars,
    out: &mut impl Write,
) -> io::Result<()> {
    let all: Vec<&CornerValues> = primvars.uv_sets.iter().chain(&primvars.color).collect();
    check_primvars(mesh, &all)?;
    let bounds = bounds(mesh)?;
    let vertices = Vertices::of(mesh, &all);
    let sections = sections(primvars, &vertices);
    let bin_len = sections.iter().map(Section::len).sum::<usize>();
    let json = json(&sections, bounds);
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
    write_shape(mesh, &vertices, out)?;
    write_primvars(primvars, &vertices, out)?;
    vertices.triangles().iter().flatten().try_for_each(|v| out.write_all(&v.to_le_bytes()))
}

/// The vertices of the file.
enum Vertices<'a> {
    /// The sides of a mesh without primvars: nothing needs to be copied.
    Sides(&'a TriangleMesh),
    Split(SplitVertices),
}

impl<'a> Vertices<'a> {
    fn of(mesh: &'a TriangleMesh, primvars: &[&CornerValues]) -> Self {
        if primvars.is_empty() { Self::Sides(mesh) } else { Self::Split(mesh.split_by(primvars)) }
    }

    fn len(&self) -> usize {
        match self {
            Self::Sides(mesh) => mesh.normals.len(),
            Self::Split(split) => split.sides.len(),
        }
    }

    fn triangles(&self) -> &[[u32; 3]] {
        match self {
            Self::Sides(mesh) => mesh.sides(),
            Self::Split(split) => &split.triangles,
        }
    }

    /// The side of each vertex.
    fn sides(&self) -> impl Iterator<Item = u32> {
        (0..self.len()).map(|v| match self {
            Self::Sides(_) => v as u32,
            Self::Split(split) => split.sides[v],
        })
    }

    /// For each primvar the number of the value of each vertex.
    fn values(&self) -> &[Vec<u32>] {
        match self {
            Self::Sides(_) => &[],
            Self::Split(split) => &split.values,
        }
    }
}

/// A run of bytes with values of one kind, of 4 bytes each.
struct Section {
    /// The attribute; empty for the corners of triangles.
    name: String,
    /// The numbers in a value.
    width: usize,
    /// How many values there are.
    count: usize,
}

impl Section {
    /// The number of bytes.
    fn len(&self) -> usize {
        4 * self.width * self.count
    }
}

/// What is behind each other in the binary part.
fn sections(primvars: &CornerPrimvars, vertices: &Vertices) -> Vec<Section> {
    let shape = [("POSITION", 3), ("NORMAL", 3), ("_GAUSS_CURVATURE", 1), ("_MEAN_CURVATURE", 1)];
    let shape = shape.into_iter().map(|(name, width)| (name.to_owned(), width));
    let uvs = (0..primvars.uv_sets.len()).map(|k| (format!("TEXCOORD_{k}"), 2));
    let color = primvars.color.iter().map(|color| ("COLOR_0".to_owned(), color_width(color)));
    let attributes = shape.chain(uvs).chain(color);
    let section = |(name, width)| Section { name, width, count: vertices.len() };
    let corners = Section { name: String::new(), width: 1, count: 3 * vertices.triangles().len() };
    attributes.map(section).chain([corners]).collect()
}

/// The format has colours of three or four numbers.
fn color_width(color: &CornerValues) -> usize {
    color.width.clamp(3, 4)
}

/// The description of the binary part, padded.
fn json(sections: &[Section], [low, high]: [[f32; 3]; 2]) -> String {
    const FLOAT: u32 = 5126;
    const UNSIGNED_INT: u32 = 5125;
    const ARRAY_BUFFER: u32 = 34962;
    const ELEMENT_ARRAY_BUFFER: u32 = 34963;
    const KINDS: [&str; 4] = ["SCALAR", "VEC2", "VEC3", "VEC4"];
    let (mut views, mut accessors, mut attributes) = (vec![], vec![], vec![]);
    let mut offset = 0;
    for (k, section) in sections.iter().enumerate() {
        let (name, len, count) = (&section.name, section.len(), section.count);
        let kind = KINDS[section.width - 1];
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
        r#"{{"asset":{{"version":"2.0","generator":"Evenlight"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{{}}},"indices":{},"mode":4,"material":0}}]}}],"materials":[{{"pbrMetallicRoughness":{{"metallicFactor":0,"roughnessFactor":0.5}}}}],"buffers":[{{"byteLength":{offset}}}],"bufferViews":[{}],"accessors":[{}]}}"#,
        attributes.join(","),
        attributes.len(),
        views.join(","),
        accessors.join(",")
    );
    json.push_str(&"   "[..(4 - json.len() % 4) % 4]);
    json
}

/// Whether every corner of every triangle has a value.
fn check_primvars(mesh: &TriangleMesh, primvars: &[&CornerValues]) -> io::Result<()> {
    let fits = |primvar: &&CornerValues| {
        let corners = primvar.corners.as_flattened();
        primvar.corners.len() == mesh.triangles.len()
            && corners.iter().all(|&value| (value as usize) < primvar.values.len())
    };
    match primvars.iter().find(|primvar| !fits(primvar)) {
        Some(primvar) => {
            Err(invalid(&format!("the primvar `{}` is not of this mesh", primvar.name)))
        }
        None => Ok(()),
    }
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

fn write_shape(mesh: &TriangleMesh, vertices: &Vertices, out: &mut impl Write) -> io::Result<()> {
    let mut float = |x: f64| out.write_all(&(x as f32).to_le_bytes());
    for side in vertices.sides() {
        let vertex = mesh.vertex_of_side(side).and_then(|v| mesh.positions.get(v as usize));
        let position = vertex.ok_or_else(|| invalid("a side of the mesh has no vertex"))?;
        position.iter().try_for_each(|&x| float(x))?;
    }
    for side in vertices.sides() {
        let normal = existing_normal(mesh.normals[side as usize]);
        normal.iter().try_for_each(|&x| float(x))?;
    }
    for curvature in [&mesh.gauss, &mesh.mean] {
        vertices.sides().try_for_each(|side| float(existing(curvature[side as usize])))?;
    }
    Ok(())
}

/// Writes texture coordinates and the colour: the primvars in the order in which the mesh was
/// split.
fn write_primvars(
    primvars: &CornerPrimvars,
    vertices: &Vertices,
    out: &mut impl Write,
) -> io::Result<()> {
    let mut float = |x: f64| out.write_all(&(existing(x) as f32).to_le_bytes());
    let mut numbers = vertices.values().iter();
    for (uvs, numbers) in primvars.uv_sets.iter().zip(&mut numbers) {
        for &number in numbers {
            let [u, v, ..] = uvs.values[number as usize];
            [u, 1.0 - v].into_iter().try_for_each(&mut float)?;
        }
    }
    for (color, numbers) in primvars.color.iter().zip(&mut numbers) {
        for &number in numbers {
            let light = color.values[number as usize].map(|x| x.clamp(0.0, 1.0));
            light.into_iter().take(color_width(color)).try_for_each(&mut float)?;
        }
    }
    Ok(())
}

/// `x`, or 0 if it does not exist in 32 bits.
fn existing(x: f64) -> f64 {
    if (x as f32).is_finite() { x } else { 0.0 }
}

fn existing_normal(normal: Vector) -> Vector {
    if normal.iter().all(|x| x.is_finite()) { normal } else { [0.0, 0.0, 1.0] }
}

fn invalid(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message)
}
