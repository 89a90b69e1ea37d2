//! The writer.

use std::fmt::Display;
use std::io::{BufWriter, Result, Write};

use super::cage::{BOUNDARY_RULES, CREASE_METHODS, FACE_VARYING, INTERPOLATIONS};
use crate::io::digits::Digits;
use crate::io::excerpt::excerpt;
use crate::mesh::{Interpolation, Mesh, Primvar, Tags};

/// [`super::write()`].
pub(super) fn write(mesh: &Mesh, out: &mut impl Write) -> Result<()> {
    let mut out = BufWriter::new(out);
    out.write_all(b"#usda 1.0\n(\n    defaultPrim = \"Cage\"\n)\n\ndef Mesh \"Cage\"\n{\n")?;
    write_shape(mesh, &mut out)?;
    write_tags(&mesh.tags, &mut out)?;
    for primvar in kept(mesh) {
        write_primvar(primvar, &mut out)?;
    }
    out.write_all(b"}\n")?;
    out.flush()
}

/// [`super::omitted`].
pub(super) fn omitted(mesh: &Mesh) -> Vec<String> {
    let kept: Vec<&Primvar> = kept(mesh).collect();
    let left_out = mesh.primvars.iter().filter(|p| !kept.iter().any(|k| std::ptr::eq(*k, *p)));
    let sentence = |p: &Primvar| {
        let name = excerpt(p.name.as_bytes());
        format!("the primvar `{name}` is not fit for a primvar of USD: it is left out")
    };
    left_out.map(sentence).collect()
}

/// The primvars that become primvars.
fn kept(mesh: &Mesh) -> impl Iterator<Item = &Primvar> {
    mesh.primvars.iter().enumerate().filter_map(|(k, primvar)| {
        let before = &mesh.primvars[..k];
        let is_new = before.iter().all(|p| name_of(p) != name_of(primvar));
        (is_new && is_name(name_of(primvar)) && is_sound(mesh, primvar)).then_some(primvar)
    })
}

fn name_of(primvar: &Primvar) -> &str {
    if primvar.name == "color" { "displayColor" } else { &primvar.name }
}

/// Whether USD takes it as the name of a primvar: names joined by colons.
fn is_name(name: &str) -> bool {
    let is_part = |part: &str| {
        part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    name.split(':').all(is_part) && !name.ends_with(":indices") && name != "indices"
}

fn is_sound(mesh: &Mesh, primvar: &Primvar) -> bool {
    let width = primvar.width;
    if !(1..=4).contains(&width) || !primvar.values.len().is_multiple_of(width) {
        return false;
    }
    let num_values = primvar.values.len() / width;
    match primvar.interpolation {
        Interpolation::FaceVarying => {
            primvar.indices.len() == mesh.faces.all_corners().len()
                && primvar.indices.iter().all(|&i| (i as usize) < num_values)
        }
        Interpolation::Vertex | Interpolation::Varying => num_values == mesh.positions.len(),
    }
}

fn write_shape(mesh: &Mesh, out: &mut impl Write) -> Result<()> {
    if let Some(extent) = extent(mesh) {
        write_list("float3[] extent", extent.iter().map(|p| Tuple(p)), out)?;
    }
    write_list("int[] faceVertexCounts", mesh.faces.iter().map(<[_]>::len), out)?;
    let corners = mesh.faces.all_corners().iter();
    write_list("int[] faceVertexIndices", corners.map(|v| v.0), out)?;
    write_list("point3f[] points", mesh.positions.iter().map(|p| Tuple(p)), out)?;
    write_token("subdivisionScheme", "catmullClark", out)
}

/// The lowest and the highest coordinates, if there are finite ones.
fn extent(mesh: &Mesh) -> Option<[[f64; 3]; 2]> {
    let mut extent = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for p in &mesh.positions {
        for k in 0..3 {
            extent[0][k] = extent[0][k].min(p[k]);
            extent[1][k] = extent[1][k].max(p[k]);
        }
    }
    extent.iter().flatten().all(|x| x.is_finite()).then_some(extent)
}

fn write_tags(tags: &Tags, out: &mut impl Write) -> Result<()> {
    write_token("interpolateBoundary", name(&BOUNDARY_RULES, tags.boundary), out)?;
    let default = Tags::default();
    if tags.face_varying != default.face_varying {
        let rule = name(&FACE_VARYING, tags.face_varying);
        write_token("faceVaryingLinearInterpolation", rule, out)?;
    }
    if tags.crease_method != default.crease_method {
        let method = name(&CREASE_METHODS, tags.crease_method);
        writeln!(out, "    custom uniform token evenlight:creaseMethod = \"{method}\"")?;
    }
    let (creases, corners) = (&tags.creases, &tags.corners);
    if !creases.is_empty() {
        let vertices = creases.iter().flat_map(|crease| crease.edge).map(|v| v.0);
        write_list("int[] creaseIndices", vertices, out)?;
        write_list("int[] creaseLengths", creases.iter().map(|_| 2), out)?;
        let sharpness = creases.iter().map(|crease| Digits(crease.sharpness));
        write_list("float[] creaseSharpnesses", sharpness, out)?;
    }
    if !corners.is_empty() {
        write_list("int[] cornerIndices", corners.iter().map(|corner| corner.vertex.0), out)?;
        let sharpness = corners.iter().map(|corner| Digits(corner.sharpness));
        write_list("float[] cornerSharpnesses", sharpness, out)?;
    }
    if !tags.holes.is_empty() {
        write_list("int[] holeIndices", tags.holes.iter().map(|face| face.0), out)?;
    }
    Ok(())
}

fn name<T: PartialEq>(choices: &[(&'static str, T)], value: T) -> &'static str {
    choices.iter().find(|(_, choice)| *choice == value).map_or("", |(name, _)| name)
}

fn write_primvar(primvar: &Primvar, out: &mut impl Write) -> Result<()> {
    let name = name_of(primvar);
    let header = format!("{}[] primvars:{name}", type_of(primvar));
    let values = primvar.values.chunks_exact(primvar.width);
    start_list(&header, out)?;
    write_values(values.map(Tuple), out)?;
    let interpolation = self::name(&INTERPOLATIONS, primvar.interpolation);
    writeln!(out, " (\n        interpolation = \"{interpolation}\"\n    )")?;
    if primvar.interpolation == Interpolation::FaceVarying {
        write_list(&format!("int[] primvars:{name}:indices"), primvar.indices.iter(), out)?;
    }
    Ok(())
}

/// The type that readers expect of such values.
fn type_of(primvar: &Primvar) -> &'static str {
    match (primvar.name.as_str(), primvar.width) {
        ("color", 3) => "color3f",
        ("normals", 3) => "normal3f",
        _ if primvar.is_uv_set() && is_texture(primvar) => {
            if primvar.width == 2 {
                "texCoord2f"
            } else {
                "texCoord3f"
            }
        }
        (_, 1) => "float",
        (_, 2) => "float2",
        (_, 3) => "float3",
        _ => "float4",
    }
}

/// Whether a set of texture coordinates is said to be one: it has values of corners, or a name of
/// the usual kinds, as in `st`, `uv2`, `UVMap`.
fn is_texture(primvar: &Primvar) -> bool {
    let name = primvar.name.to_ascii_lowercase();
    let rest = name.strip_prefix("st").or_else(|| name.strip_prefix("uv"));
    let is_number = |rest: &str| rest.chars().all(|c| c.is_ascii_digit() || c == '_');
    let is_usual = rest.is_some_and(|rest| is_number(rest.strip_prefix("map").unwrap_or(rest)));
    primvar.interpolation == Interpolation::FaceVarying || is_usual
}

fn write_token(name: &str, value: &str, out: &mut impl Write) -> Result<()> {
    writeln!(out, "    uniform token {name} = \"{value}\"")
}

fn write_list(
    header: &str,
    values: impl Iterator<Item = impl Display>,
    out: &mut impl Write,
) -> Result<()> {
    start_list(header, out)?;
    write_values(values, out)?;
    out.write_all(b"\n")
}

fn start_list(header: &str, out: &mut impl Write) -> Result<()> {
    write!(out, "    {header} = ")
}

fn write_values(values: impl Iterator<Item = impl Display>, out: &mut impl Write) -> Result<()> {
    out.write_all(b"[")?;
    for (k, value) in values.enumerate() {
        write!(out, "{}{value}", if k > 0 { ", " } else { "" })?;
    }
    out.write_all(b"]")
}

/// One number, or several in parentheses.
struct Tuple<'a>(&'a [f64]);

impl Display for Tuple<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let number = |x: f64| if x.is_nan() { "nan".to_owned() } else { Digits(x).to_string() };
        match self.0 {
            [x] => f.write_str(&number(*x)),
            values => {
                let numbers: Vec<String> = values.iter().map(|&x| number(x)).collect();
                write!(f, "({})", numbers.join(", "))
            }
        }
    }
}
