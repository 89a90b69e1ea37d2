//! From the attributes of a mesh to a [`Mesh`].

use std::collections::HashMap;

use super::attributes::Attributes;
use super::parse::{Attribute, Value};
use super::scene::Found;
use super::transform::{self, Affine};
use super::{Usd, UsdError};
use crate::io::excerpt::excerpt;
use crate::io::lines::Lines;
use crate::mesh::{
    BoundaryRule, Corner, Crease, CreaseMethod, FaceId, FaceVaryingRule, Faces, Interpolation,
    Mesh, Primvar, VertexId,
};

/// `interpolateBoundary`.
pub(super) const BOUNDARY_RULES: [(&str, BoundaryRule); 3] = [
    ("none", BoundaryRule::None),
    ("edgeOnly", BoundaryRule::EdgeOnly),
    ("edgeAndCorner", BoundaryRule::EdgeAndCorner),
];

/// `faceVaryingLinearInterpolation`.
pub(super) const FACE_VARYING: [(&str, FaceVaryingRule); 6] = [
    ("none", FaceVaryingRule::None),
    ("cornersOnly", FaceVaryingRule::CornersOnly),
    ("cornersPlus1", FaceVaryingRule::CornersPlus1),
    ("cornersPlus2", FaceVaryingRule::CornersPlus2),
    ("boundaries", FaceVaryingRule::Boundaries),
    ("all", FaceVaryingRule::All),
];

/// `evenlight:creaseMethod`.
pub(super) const CREASE_METHODS: [(&str, CreaseMethod); 2] =
    [("uniform", CreaseMethod::Uniform), ("chaikin", CreaseMethod::Chaikin)];

/// `primvars:NAME` (`interpolation`).
pub(super) const INTERPOLATIONS: [(&str, Interpolation); 3] = [
    ("vertex", Interpolation::Vertex),
    ("varying", Interpolation::Varying),
    ("faceVarying", Interpolation::FaceVarying),
];

/// [`super::read`], once the mesh is found.
pub(super) fn read(found: &Found) -> Result<Usd, UsdError> {
    let mut reader = UsdReader {
        attributes: Attributes::new(found.prim()),
        line: found.prim().line,
        mesh: Mesh::default(),
        lines: Lines::default(),
        remarks: found.remarks().collect(),
    };
    let to_stage = transform::to_stage(&found.chain)?;
    reader.points(to_stage)?;
    let is_left_handed = reader.is_left_handed()?;
    let is_mirrored = to_stage.is_some_and(|map| map.determinant() < 0.0);
    reader.faces(is_left_handed != is_mirrored)?;
    reader.rules()?;
    reader.creases()?;
    reader.corners_and_holes()?;
    reader.primvars(found.prim().attributes.as_slice(), is_left_handed != is_mirrored)?;
    let UsdReader { attributes, mesh, lines, mut remarks, .. } = reader;
    let animated = |name: &String| {
        format!("`{}` changes over time: its first value is taken", excerpt(name.as_bytes()))
    };
    remarks.extend(attributes.animated.iter().map(animated));
    Ok(Usd { path: found.path.clone(), mesh, lines, remarks })
}

struct UsdReader<'a> {
    attributes: Attributes<'a>,
    /// The line of the prim.
    line: usize,
    mesh: Mesh,
    lines: Lines,
    remarks: Vec<String>,
}

impl UsdReader<'_> {
    fn missing(&self, name: &str) -> UsdError {
        UsdError { line: self.line, message: format!("the mesh has no `{name}`: add it") }
    }

    fn points(&mut self, to_stage: Option<Affine>) -> Result<(), UsdError> {
        let points = self.attributes.numbers("points", 3)?;
        let points = points.ok_or_else(|| self.missing("points"))?;
        self.lines.vertices = points.lines().to_vec();
        let positions = points.value.chunks_exact(3).map(|p| [p[0], p[1], p[2]]);
        self.mesh.positions = match to_stage {
            Some(map) => positions.map(|p| map.apply(p)).collect(),
            None => positions.collect(),
        };
        Ok(())
    }

    fn is_left_handed(&mut self) -> Result<bool, UsdError> {
        let choices = [("rightHanded", false), ("leftHanded", true)];
        Ok(self.attributes.choice("orientation", &choices)?.unwrap_or(false))
    }

    fn faces(&mut self, is_reversed: bool) -> Result<(), UsdError> {
        let counts = self.attributes.ids("faceVertexCounts")?;
        let (counts, of_counts) = counts.ok_or_else(|| self.missing("faceVertexCounts"))?;
        let indices = self.attributes.ids("faceVertexIndices")?;
        let (mut indices, of_indices) = indices.ok_or_else(|| self.missing("faceVertexIndices"))?;
        let num_vertices = self.mesh.positions.len();
        if let Some(i) = indices.iter().find(|&&i| i as usize >= num_vertices) {
            let what = format!("asks for vertex {i}, but there are {num_vertices} points (from 0)");
            return Err(of_indices.fault(&what));
        }
        let total: u64 = counts.iter().map(|&count| u64::from(count)).sum();
        if total != indices.len() as u64 || total > u64::from(u32::MAX) {
            let what = format!(
                "adds up to {total}, but `faceVertexIndices` has {} numbers",
                indices.len()
            );
            return Err(of_counts.fault(&what));
        }
        if is_reversed {
            reverse(&mut indices, counts.iter().map(|&n| n as usize));
        }
        let mut rest = &indices[..];
        for count in counts {
            let (corners, others) = rest.split_at(count as usize);
            self.mesh.faces.push(corners.iter().map(|&v| VertexId(v)));
            rest = others;
        }
        Ok(())
    }

    fn rules(&mut self) -> Result<(), UsdError> {
        let tags = &mut self.mesh.tags;
        if let Some(rule) = self.attributes.choice("interpolateBoundary", &BOUNDARY_RULES)? {
            tags.boundary = rule;
        }
        let rule = self.attributes.choice("faceVaryingLinearInterpolation", &FACE_VARYING)?;
        if let Some(rule) = rule {
            tags.face_varying = rule;
        }
        if let Some(method) = self.attributes.choice("evenlight:creaseMethod", &CREASE_METHODS)? {
            tags.crease_method = method;
        }
        for name in ["subdivisionScheme", "triangleSubdivisionRule"] {
            let value = self.attributes.text(name)?.map_or("catmullClark", |found| found.value);
            if value != "catmullClark" {
                let value = excerpt(value.as_bytes());
                self.remarks.push(format!("`{name}` is `{value}`, but is taken as `catmullClark`"));
            }
        }
        Ok(())
    }

    fn creases(&mut self) -> Result<(), UsdError> {
        let Some((vertices, found)) = self.attributes.ids("creaseIndices")? else { return Ok(()) };
        if vertices.is_empty() {
            return Ok(());
        }
        let lengths = self.attributes.ids("creaseLengths")?;
        let (lengths, of_lengths) = lengths.ok_or_else(|| self.missing("creaseLengths"))?;
        let sharpness = self.attributes.numbers("creaseSharpnesses", 1)?;
        let sharpness = sharpness.ok_or_else(|| self.missing("creaseSharpnesses"))?;
        self.check_vertices(&vertices, &found)?;
        let total: u64 = lengths.iter().map(|&n| u64::from(n)).sum();
        if total != vertices.len() as u64 || lengths.iter().any(|&n| n < 2) {
            return Err(of_lengths.fault("must be numbers from 2 that add up to the creaseIndices"));
        }
        let num_edges = vertices.len() - lengths.len();
        let is_per_edge = sharpness.value.len() == num_edges;
        if !is_per_edge && sharpness.value.len() != lengths.len() {
            return Err(sharpness.fault("must have a number for each crease or for each edge"));
        }
        check_sharpness(&sharpness)?;
        let (mut rest, mut edge) = (&vertices[..], 0);
        for (k, &length) in lengths.iter().enumerate() {
            let (chain, others) = rest.split_at(length as usize);
            for ends in chain.windows(2) {
                let sharpness = sharpness.value[if is_per_edge { edge } else { k }].max(0.0);
                let edge_ends = [VertexId(ends[0]), VertexId(ends[1])];
                self.mesh.tags.creases.push(Crease { edge: edge_ends, sharpness });
                edge += 1;
            }
            rest = others;
        }
        Ok(())
    }

    fn corners_and_holes(&mut self) -> Result<(), UsdError> {
        let corners = self.attributes.ids("cornerIndices")?;
        if let Some((vertices, found)) = corners.filter(|(vertices, _)| !vertices.is_empty()) {
            let sharpness = self.attributes.numbers("cornerSharpnesses", 1)?;
            let sharpness = sharpness.ok_or_else(|| self.missing("cornerSharpnesses"))?;
            self.check_vertices(&vertices, &found)?;
            if sharpness.value.len() != vertices.len() {
                return Err(sharpness.fault("must have a number for each of the cornerIndices"));
            }
            check_sharpness(&sharpness)?;
            let corners = vertices.iter().zip(sharpness.value);
            self.mesh.tags.corners = corners
                .map(|(&v, &s)| Corner { vertex: VertexId(v), sharpness: s.max(0.0) })
                .collect();
        }
        if let Some((holes, found)) = self.attributes.ids("holeIndices")? {
            let count = self.mesh.faces.len();
            if let Some(hole) = holes.iter().find(|&&hole| hole as usize >= count) {
                let what = format!("asks for face {hole}, but there are {count} (from 0)");
                return Err(found.fault(&what));
            }
            self.mesh.tags.holes = holes.into_iter().map(FaceId).collect();
        }
        Ok(())
    }

    fn check_vertices(
        &self,
        vertices: &[u32],
        found: &super::attributes::Found<[f64]>,
    ) -> Result<(), UsdError> {
        let count = self.mesh.positions.len();
        match vertices.iter().find(|&&v| v as usize >= count) {
            Some(v) => {
                Err(found.fault(&format!("asks for vertex {v}, but there are {count} (from 0)")))
            }
            None => Ok(()),
        }
    }

    fn primvars(&mut self, attributes: &[Attribute], is_reversed: bool) -> Result<(), UsdError> {
        for attribute in attributes {
            let name = attribute.name.strip_prefix("primvars:");
            let name = name.map(|name| name.strip_suffix(".timeSamples").unwrap_or(name));
            let is_part = |name: &&str| {
                !name.ends_with(":indices") && !name.contains('.') && !name.is_empty()
            };
            if let Some(name) = name.filter(is_part)
                && attribute.value != Value::None
            {
                self.primvar(name, attribute, is_reversed)?;
            }
        }
        Ok(())
    }

    fn primvar(
        &mut self,
        name: &str,
        attribute: &Attribute,
        is_reversed: bool,
    ) -> Result<(), UsdError> {
        let own_name = if name == "displayColor" { "color" } else { name };
        let mut skip = |why: &str| {
            let shown = excerpt(name.as_bytes());
            self.remarks.push(format!("the primvar `{shown}` is skipped: {why}"));
            Ok(())
        };
        if self.mesh.primvars.iter().any(|p| p.name == own_name) {
            return skip("there is another of this name");
        }
        let interpolation = attribute.interpolation.as_deref().unwrap_or("constant");
        let known = INTERPOLATIONS.iter().find(|(name, _)| *name == interpolation);
        let Some(&(_, interpolation)) = known else {
            return skip("only vertex, varying and faceVarying ones are kept");
        };
        let Value::Numbers { values, width, .. } = &attribute.value else {
            return skip("it has no numbers");
        };
        if *width > 4 {
            return skip("it has more than four numbers in a value");
        }
        if !values.iter().all(|x| x.is_finite()) {
            return skip("it has numbers that are not finite");
        }
        let indices = self.attributes.ids(&format!("primvars:{name}:indices"))?;
        let primvar = Primvar {
            name: own_name.to_owned(),
            interpolation,
            width: *width,
            values: values.clone(),
            indices: Vec::new(),
        };
        let indices = indices.map(|(indices, _)| indices);
        let primvar = match interpolation {
            Interpolation::FaceVarying => self.of_corners(primvar, indices, is_reversed),
            _ => self.of_vertices(primvar, indices),
        };
        self.mesh
            .primvars
            .push(primvar.map_err(|what| super::attributes::fault(attribute, &what))?);
        Ok(())
    }

    /// A value for each vertex, taken apart by `indices` if there are any.
    fn of_vertices(
        &self,
        mut primvar: Primvar,
        indices: Option<Vec<u32>>,
    ) -> Result<Primvar, String> {
        let width = primvar.width;
        let num_values = primvar.values.len() / width;
        if let Some(indices) = indices {
            check_indices(&indices, num_values)?;
            let value = |&i: &u32| &primvar.values[width * i as usize..][..width];
            primvar.values = indices.iter().flat_map(value).copied().collect();
        }
        let (found, count) = (primvar.values.len() / width, self.mesh.positions.len());
        if found == count {
            return Ok(primvar);
        }
        Err(format!("has {found} values for {count} vertices"))
    }

    /// A value for each corner.
    fn of_corners(
        &self,
        mut primvar: Primvar,
        indices: Option<Vec<u32>>,
        is_reversed: bool,
    ) -> Result<Primvar, String> {
        let faces = &self.mesh.faces;
        let (num_values, count) = (primvar.values.len() / primvar.width, faces.all_corners().len());
        let is_joined = indices.is_none();
        let mut indices = indices.unwrap_or_else(|| (0..num_values as u32).collect());
        check_indices(&indices, num_values)?;
        if indices.len() != count {
            return Err(format!("has {} values for {count} corners of faces", indices.len()));
        }
        if is_reversed {
            reverse(&mut indices, faces.iter().map(<[VertexId]>::len));
        }
        primvar.indices = indices;
        if is_joined {
            join_equal(&mut primvar, faces);
        }
        Ok(primvar)
    }
}

/// Reverses the corners of every face but the first, as the faces have so many each.
fn reverse(corners: &mut [u32], counts: impl Iterator<Item = usize>) {
    let mut rest = corners;
    for count in counts {
        let (face, others) = rest.split_at_mut(count);
        if let [_, after_first @ ..] = face {
            after_first.reverse();
        }
        rest = others;
    }
}

fn check_indices(indices: &[u32], num_values: usize) -> Result<(), String> {
    match indices.iter().find(|&&i| i as usize >= num_values) {
        Some(i) => Err(format!("has {num_values} values, but its indices ask for {i} (from 0)")),
        None => Ok(()),
    }
}

fn check_sharpness(found: &super::attributes::Found<[f64]>) -> Result<(), UsdError> {
    match found.value.iter().find(|x| x.is_nan() || **x < 0.0) {
        Some(x) if x.is_nan() => Err(found.fault("has NaN")),
        Some(x) => Err(found.fault(&format!("has {x}, but sharpness is 0 (smooth) or more"))),
        None => Ok(()),
    }
}

/// Makes equal values of a vertex one.
fn join_equal(primvar: &mut Primvar, faces: &Faces) {
    let (width, values) = (primvar.width, std::mem::take(&mut primvar.values));
    let mut known: HashMap<(VertexId, Vec<u64>), u32> = HashMap::new();
    for (index, &vertex) in primvar.indices.iter_mut().zip(faces.all_corners()) {
        let value = &values[width * *index as usize..][..width];
        let next = (primvar.values.len() / width) as u32;
        let bits = value.iter().map(|x| x.to_bits()).collect();
        *index = *known.entry((vertex, bits)).or_insert(next);
        if *index == next {
            primvar.values.extend(value);
        }
    }
}
