//! The writer of cages: everything that PLY can hold.

use std::io::{BufWriter, Result, Write};

use super::header::{Encoding, Scalar};
use super::primvars::GROUPS;
use crate::io::digits::Digits;
use crate::mesh::{Interpolation, Mesh, Primvar, Tags};

/// [`super::write()`].
pub(super) fn write(mesh: &Mesh, encoding: Encoding, out: &mut impl Write) -> Result<()> {
    let mut out = BufWriter::new(out);
    let plan = Plan::new(mesh);
    plan.write_header(mesh, encoding, &mut out)?;
    let mut values = Values { encoding, at_start: true, out: &mut out };
    plan.write_vertices(mesh, &mut values)?;
    plan.write_faces(mesh, &mut values)?;
    out.flush()
}

/// [`super::omitted`].
pub(super) fn omitted(mesh: &Mesh) -> Vec<String> {
    let plan = Plan::new(mesh);
    let tags = (mesh.tags != Tags::default()).then(|| {
        "PLY has no place for creases, corners, holes and rules: they are left out".to_owned()
    });
    let is_kept = |p: &&Primvar| {
        plan.uvs
            .iter()
            .chain(plan.primvars.iter().map(|c| &c.primvar))
            .any(|k| std::ptr::eq(*k, *p))
    };
    let primvars = mesh.primvars.iter().filter(|p| !is_kept(p));
    let sentence =
        |p: &Primvar| format!("PLY has no place for the primvar `{}`: it is left out", p.name);
    tags.into_iter().chain(primvars.map(sentence)).collect()
}

/// What is written of a mesh.
struct Plan<'a> {
    primvars: Vec<Properties<'a>>,
    uvs: Option<&'a Primvar>,
    /// The types of the numbers of corners, and of texture coordinates of a face.
    counts: [Scalar; 2],
}

/// A primvar of vertices with the names and the type of its properties.
struct Properties<'a> {
    primvar: &'a Primvar,
    names: Vec<String>,
    scalar: Scalar,
}

impl<'a> Plan<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let mut taken: Vec<String> = ["x", "y", "z"].map(str::to_owned).into();
        let mut primvars = Vec::new();
        for primvar in mesh.primvars.iter().filter(|p| is_of_vertices(mesh, p)) {
            let names = property_names(primvar);
            if names.iter().all(|name| !taken.contains(name)) {
                taken.extend_from_slice(&names);
                primvars.push(Properties { primvar, names, scalar: scalar_of(primvar) });
            }
        }
        let uvs = || mesh.primvars.iter().filter(|p| is_of_corners(mesh, p));
        let named = |p: &&Primvar| matches!(p.name.as_str(), "st" | "uv");
        let uvs = uvs().find(named).or_else(|| uvs().next());
        Self { primvars, uvs, counts: [1, 2].map(|each| count_type(mesh, each)) }
    }

    fn write_header(&self, mesh: &Mesh, encoding: Encoding, out: &mut impl Write) -> Result<()> {
        writeln!(out, "ply\nformat {} 1.0", encoding.name())?;
        writeln!(out, "element vertex {}", mesh.positions.len())?;
        writeln!(out, "property double x\nproperty double y\nproperty double z")?;
        for primvar in &self.primvars {
            for name in &primvar.names {
                writeln!(out, "property {} {name}", primvar.scalar.name())?;
            }
        }
        writeln!(out, "element face {}", mesh.faces.len())?;
        writeln!(out, "property list {} uint vertex_indices", self.counts[0].name())?;
        if self.uvs.is_some() {
            writeln!(out, "property list {} double texcoord", self.counts[1].name())?;
        }
        writeln!(out, "end_header")
    }

    fn write_vertices(&self, mesh: &Mesh, out: &mut Values<impl Write>) -> Result<()> {
        for (v, position) in mesh.positions.iter().enumerate() {
            position.iter().try_for_each(|&x| out.write(Scalar::F64, x))?;
            for Properties { primvar, scalar, .. } in &self.primvars {
                let width = primvar.width;
                for &x in &primvar.values[width * v..width * (v + 1)] {
                    out.write(*scalar, if *scalar == Scalar::U8 { byte_of(x) } else { x })?;
                }
            }
            out.end_line()?;
        }
        Ok(())
    }

    fn write_faces(&self, mesh: &Mesh, out: &mut Values<impl Write>) -> Result<()> {
        let mut place = 0;
        for corners in mesh.faces.iter() {
            let places = place..place + corners.len();
            out.write(self.counts[0], corners.len() as f64)?;
            corners.iter().try_for_each(|v| out.write(Scalar::U32, v.0.into()))?;
            if let Some(uvs) = self.uvs {
                out.write(self.counts[1], 2.0 * corners.len() as f64)?;
                for &index in &uvs.indices[places.clone()] {
                    let at = 2 * index as usize;
                    uvs.values[at..at + 2].iter().try_for_each(|&x| out.write(Scalar::F64, x))?;
                }
            }
            place = places.end;
            out.end_line()?;
        }
        Ok(())
    }
}

fn is_of_vertices(mesh: &Mesh, primvar: &Primvar) -> bool {
    primvar.interpolation == Interpolation::Vertex
        && (1..=4).contains(&primvar.width)
        && primvar.values.len() == primvar.width * mesh.positions.len()
}

fn is_of_corners(mesh: &Mesh, primvar: &Primvar) -> bool {
    let num_values = primvar.values.len() / 2;
    primvar.interpolation == Interpolation::FaceVarying
        && primvar.width == 2
        && primvar.indices.len() == mesh.faces.all_corners().len()
        && primvar.indices.iter().all(|&i| (i as usize) < num_values)
}

/// The names that the reader takes as this primvar.
fn property_names(primvar: &Primvar) -> Vec<String> {
    let of_primvar = |(name, members): &&(&str, &[&str])| {
        *name == primvar.name && members.len() == primvar.width
    };
    if let Some((_, members)) = GROUPS.iter().find(of_primvar) {
        return members.iter().map(|m| (*m).to_owned()).collect();
    }
    let is_fit = |c: char| c.is_ascii_graphic();
    let name: String = primvar.name.chars().map(|c| if is_fit(c) { c } else { '_' }).collect();
    let name = if name.is_empty() { "_".to_owned() } else { name };
    match primvar.width {
        1 => vec![name],
        width => (0..width).map(|k| format!("{name}_{k}")).collect(),
    }
}

/// Bytes for colours that came from bytes, else all 64 bits.
fn scalar_of(primvar: &Primvar) -> Scalar {
    let is_of_byte = |&x: &f64| (0.0..=1.0).contains(&x) && byte_of(x) / 255.0 == x;
    let is_bytes = primvar.name == "color" && primvar.values.iter().all(is_of_byte);
    if is_bytes { Scalar::U8 } else { Scalar::F64 }
}

fn byte_of(x: f64) -> f64 {
    (255.0 * x).round()
}

/// The smallest usual type for the number of values in a list, with `each` for every corner.
fn count_type(mesh: &Mesh, each: usize) -> Scalar {
    let most = mesh.faces.iter().map(<[_]>::len).max().unwrap_or(0);
    if most * each <= 255 { Scalar::U8 } else { Scalar::U32 }
}

/// Writes values in an encoding.
struct Values<'a, W> {
    encoding: Encoding,
    at_start: bool,
    out: &'a mut W,
}

impl<W: Write> Values<'_, W> {
    fn write(&mut self, scalar: Scalar, x: f64) -> Result<()> {
        match scalar {
            _ if self.encoding == Encoding::Ascii => self.write_word(x),
            Scalar::U8 => self.write_bytes([x as u8]),
            Scalar::U32 => self.write_bytes((x as u32).to_le_bytes()),
            _ => self.write_bytes(x.to_le_bytes()),
        }
    }

    fn write_bytes<const N: usize>(&mut self, mut bytes: [u8; N]) -> Result<()> {
        if self.encoding == Encoding::BigEndian {
            bytes.reverse();
        }
        self.out.write_all(&bytes)
    }

    fn write_word(&mut self, x: f64) -> Result<()> {
        let blank = if std::mem::take(&mut self.at_start) { "" } else { " " };
        if x.is_nan() {
            write!(self.out, "{blank}nan")
        } else {
            write!(self.out, "{blank}{}", Digits(x))
        }
    }

    fn end_line(&mut self) -> Result<()> {
        self.at_start = true;
        if self.encoding == Encoding::Ascii { self.out.write_all(b"\n") } else { Ok(()) }
    }
}
