//! The writer of cages: everything that OBJ can hold.

use std::io::{BufWriter, Result, Write};

use super::tag::{BOUNDARY_RULES, FACE_VARYING};
use crate::io::digits::Digits;
use crate::mesh::{CreaseMethod, Interpolation, Mesh, Primvar, Tags};

/// Writes `mesh`: vertices (with colours), texture coordinates, faces, tags.
pub(super) fn write(mesh: &Mesh, out: &mut impl Write) -> Result<()> {
    let mut out = BufWriter::new(out);
    let (colors, uvs) = (colors(mesh), uvs(mesh));
    write_vertices(mesh, colors, &mut out)?;
    if let Some(uvs) = uvs {
        for value in uvs.values.chunks_exact(uvs.width) {
            write_line("vt", value, &mut out)?;
        }
    }
    write_faces(mesh, uvs, &mut out)?;
    write_tags(&mesh.tags, &mut out)?;
    out.flush()
}

/// What [`write`] leaves out, in sentences.
pub(super) fn omitted(mesh: &Mesh) -> Vec<String> {
    let kept = [colors(mesh), uvs(mesh)];
    let is_kept = |p: &Primvar| kept.iter().flatten().any(|k| std::ptr::eq(*k, p));
    let left_out = mesh.primvars.iter().filter(|p| !is_kept(p));
    left_out
        .map(|p| format!("OBJ has no place for the primvar `{}`: it is left out", p.name))
        .collect()
}

/// The primvar for the colours on the lines of vertices.
fn colors(mesh: &Mesh) -> Option<&Primvar> {
    let fits = |p: &&Primvar| {
        p.interpolation == Interpolation::Vertex
            && p.width == 3
            && p.values.len() == 3 * mesh.positions.len()
            && p.is_color()
    };
    mesh.primvars.iter().find(fits)
}

/// The primvar for texture coordinates: `st` or `uv`, or else the first with two numbers.
fn uvs(mesh: &Mesh) -> Option<&Primvar> {
    let fits = |p: &&Primvar| {
        (1..=3).contains(&p.width) && p.values.len().is_multiple_of(p.width) && has_corners(mesh, p)
    };
    let named = |p: &&Primvar| p.has_uv_name();
    let candidates = || mesh.primvars.iter().filter(fits);
    let unnamed = |p: &&Primvar| p.width == 2 && p.interpolation == Interpolation::FaceVarying;
    candidates().find(named).or_else(|| candidates().find(unnamed))
}

/// Whether the primvar has a value for every corner of a face.
fn has_corners(mesh: &Mesh, primvar: &Primvar) -> bool {
    let num_values = primvar.values.len() / primvar.width;
    match primvar.interpolation {
        Interpolation::FaceVarying => {
            primvar.indices.len() == mesh.faces.all_corners().len()
                && primvar.indices.iter().all(|&i| (i as usize) < num_values)
        }
        Interpolation::Vertex => num_values == mesh.positions.len(),
        Interpolation::Varying => false,
    }
}

fn write_vertices(mesh: &Mesh, colors: Option<&Primvar>, out: &mut impl Write) -> Result<()> {
    for (v, position) in mesh.positions.iter().enumerate() {
        let color = colors.map_or(&[][..], |colors| &colors.values[3 * v..3 * v + 3]);
        write_line("v", position.iter().chain(color), out)?;
    }
    Ok(())
}

fn write_line<'a>(
    tag: &str,
    numbers: impl IntoIterator<Item = &'a f64>,
    out: &mut impl Write,
) -> Result<()> {
    out.write_all(tag.as_bytes())?;
    for &x in numbers {
        // `Digits` stands for results that do not exist; a coordinate must not turn into 0.
        if x.is_nan() { out.write_all(b" NaN")? } else { write!(out, " {}", Digits(x))? }
    }
    out.write_all(b"\n")
}

fn write_faces(mesh: &Mesh, uvs: Option<&Primvar>, out: &mut impl Write) -> Result<()> {
    let mut place = 0;
    for corners in mesh.faces.iter() {
        out.write_all(b"f")?;
        for corner in corners {
            write!(out, " {}", u64::from(corner.0) + 1)?;
            if let Some(uvs) = uvs {
                let index = uvs.indices.get(place).unwrap_or(&corner.0);
                write!(out, "/{}", u64::from(*index) + 1)?;
            }
            place += 1;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

fn write_tags(tags: &Tags, out: &mut impl Write) -> Result<()> {
    let default = Tags::default();
    if tags.boundary != default.boundary {
        let rule = BOUNDARY_RULES.iter().position(|&r| r == tags.boundary).unwrap_or_default();
        writeln!(out, "t interpolateboundary 1/0/0 {rule}")?;
    }
    if tags.face_varying != default.face_varying {
        let rule = FACE_VARYING.iter().position(|&r| r == tags.face_varying).unwrap_or_default();
        writeln!(out, "t facevaryinginterpolateboundary 1/0/0 {rule}")?;
    }
    if tags.crease_method == CreaseMethod::Chaikin {
        writeln!(out, "t creasemethod 0/0/1 chaikin")?;
    }
    for crease in &tags.creases {
        let [a, b] = crease.edge;
        writeln!(out, "t crease 2/1/0 {} {} {}", a.0, b.0, Digits(crease.sharpness))?;
    }
    for corner in &tags.corners {
        writeln!(out, "t corner 1/1/0 {} {}", corner.vertex.0, Digits(corner.sharpness))?;
    }
    if !tags.holes.is_empty() {
        write!(out, "t hole {}/0/0", tags.holes.len())?;
        tags.holes.iter().try_for_each(|hole| write!(out, " {}", hole.0))?;
        writeln!(out)?;
    }
    Ok(())
}
