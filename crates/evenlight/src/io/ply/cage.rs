//! From elements to a mesh.

use super::body::Body;
use super::header::{Element, Header, word};
use super::primvars::{self, CornerValues};
use super::{Ply, PlyError, PlyPlace};
use crate::io::lines::Lines;
use crate::mesh::{Faces, Mesh, VertexId};
use crate::point::Point;

/// [`super::read`].
pub(super) fn read(bytes: &[u8]) -> Result<Ply, PlyError> {
    let header = Header::read(bytes)?;
    let mut reader = PlyReader::new(&header)?;
    let mut body = Body::new(bytes, &header);
    for element in &header.elements {
        reader.element(element, &mut body)?;
    }
    if body.num_left() > 0 {
        reader
            .remarks
            .push(format!("{} bytes after the last element are ignored", body.num_left()));
    }
    Ok(reader.finish())
}

/// What was read so far.
struct PlyReader<'a> {
    vertices: &'a Element,
    /// The places of x, y, z among the properties of vertices.
    xyz: [usize; 3],
    positions: Vec<Point>,
    /// The values of the other properties of vertices, each for itself.
    columns: Vec<Vec<f64>>,
    faces: Faces,
    lines: Lines,
    texcoords: CornerValues,
    remarks: Vec<String>,
}

/// One item: the values of every property. A number is a list of one.
type Item = Vec<Vec<f64>>;

impl<'a> PlyReader<'a> {
    fn new(header: &'a Header) -> Result<Self, PlyError> {
        let fault = |line: usize, message: &str| PlyError {
            place: PlyPlace::Line(line),
            item: None,
            message: message.to_owned(),
        };
        let vertices = header.elements.iter().find(|e| e.name == "vertex");
        let vertices = vertices
            .ok_or_else(|| fault(header.num_lines, "there is no element `vertex`: add it"))?;
        if vertices.count > u32::MAX as usize {
            return Err(fault(
                vertices.line,
                "there are more than 4294967295 vertices: split the file",
            ));
        }
        let place = |name| {
            let found = vertices.find(name).filter(|&k| vertices.properties[k].count.is_none());
            let message = format!("the element `vertex` has no number `{name}`: add it");
            found.ok_or_else(|| fault(vertices.line, &message))
        };
        Ok(Self {
            vertices,
            xyz: [place("x")?, place("y")?, place("z")?],
            positions: Vec::new(),
            columns: vec![Vec::new(); vertices.properties.len()],
            faces: Faces::default(),
            lines: Lines::default(),
            texcoords: CornerValues::default(),
            remarks: Vec::new(),
        })
    }

    fn element(&mut self, element: &Element, body: &mut Body) -> Result<(), PlyError> {
        let faces = FaceProperties::of(element)?;
        self.remark(element, faces.as_ref());
        let mut item: Item = vec![Vec::new(); element.properties.len()];
        for k in 0..element.count {
            self.item(element, faces.as_ref(), &mut item, body).map_err(|message| PlyError {
                place: body.place(),
                item: Some((word(&element.name), k)),
                message,
            })?;
        }
        Ok(())
    }

    fn item(
        &mut self,
        element: &Element,
        faces: Option<&FaceProperties>,
        item: &mut Item,
        body: &mut Body,
    ) -> Result<(), String> {
        let line = body.next_line();
        for (property, values) in element.properties.iter().zip(&mut *item) {
            values.clear();
            let count = property.count.map_or(Ok(1.0), |scalar| body.next(scalar))?;
            if count < 0.0 {
                return Err(format!("the list `{}` has {count} values", word(&property.name)));
            }
            for _ in 0..count as usize {
                values.push(body.next(property.scalar)?);
            }
        }
        match faces {
            Some(faces) => {
                self.lines.faces.extend(line);
                self.face(faces, item)
            }
            None if element.name == "vertex" => {
                self.lines.vertices.extend(line);
                self.vertex(item);
                Ok(())
            }
            None => Ok(()),
        }
    }

    fn vertex(&mut self, item: &Item) {
        self.positions.push(self.xyz.map(|k| item[k][0]));
        for (k, (column, values)) in self.columns.iter_mut().zip(item).enumerate() {
            if !self.xyz.contains(&k) && self.vertices.properties[k].count.is_none() {
                column.extend(values);
            }
        }
    }

    fn face(&mut self, properties: &FaceProperties, item: &Item) -> Result<(), String> {
        let corners = &item[properties.indices];
        let count = self.vertices.count;
        let is_of_vertex = |&&i: &&f64| (0.0..count as f64).contains(&i);
        if let Some(i) = corners.iter().find(|i| !is_of_vertex(i)) {
            return Err(format!(
                "a corner asks for vertex {i}, but the file has {count} (from 0): correct it"
            ));
        }
        if self.faces.all_corners().len() + corners.len() >= u32::MAX as usize {
            return Err("there are more than 4294967295 corners: split the file".to_owned());
        }
        let vertices = || corners.iter().map(|&i| VertexId(i as u32));
        if let Some(texcoord) = properties.texcoord {
            self.texcoords.add_face(vertices(), &item[texcoord])?;
        }
        self.faces.push(vertices());
        Ok(())
    }

    /// Says what of an element is skipped.
    fn remark(&mut self, element: &Element, faces: Option<&FaceProperties>) {
        let Element { name, count, properties, .. } = element;
        let is_kept = |k: usize| match faces {
            Some(faces) => faces.indices == k || faces.texcoord == Some(k),
            None => properties[k].count.is_none(),
        };
        if faces.is_none() && name != "vertex" {
            self.remarks.push(format!("the element `{}` ({count}) is skipped", word(name)));
            return;
        }
        for (_, property) in properties.iter().enumerate().filter(|&(k, _)| !is_kept(k)) {
            self.remarks
                .push(format!("the property `{}` of `{name}` is skipped", word(&property.name)));
        }
    }

    fn finish(mut self) -> Ply {
        let columns = self.vertices.properties.iter().zip(self.columns).enumerate();
        let columns: Vec<_> = columns
            .filter(|(k, (property, _))| !self.xyz.contains(k) && property.count.is_none())
            .map(|(_, column)| column)
            .collect();
        let mut primvars: Vec<_> = self.texcoords.finish(&mut self.remarks).into_iter().collect();
        primvars::group(columns, &mut primvars, &mut self.remarks);
        let mesh =
            Mesh { positions: self.positions, faces: self.faces, primvars, ..Mesh::default() };
        Ply { mesh, lines: self.lines, remarks: self.remarks }
    }
}

/// The properties of faces that are understood.
struct FaceProperties {
    indices: usize,
    texcoord: Option<usize>,
}

impl FaceProperties {
    /// Those of `element`, if it is of faces.
    fn of(element: &Element) -> Result<Option<Self>, PlyError> {
        if element.name != "face" {
            return Ok(None);
        }
        let list = |name| element.find(name).filter(|&k| element.properties[k].count.is_some());
        let indices = list("vertex_indices").or_else(|| list("vertex_index"));
        let indices = indices.filter(|&k| element.properties[k].scalar.range().is_some());
        match indices {
            Some(indices) => Ok(Some(Self { indices, texcoord: list("texcoord") })),
            None if element.count == 0 => Ok(None),
            None => Err(PlyError {
                place: PlyPlace::Line(element.line),
                item: None,
                message: "the element `face` has no list `vertex_indices` of whole numbers: add it"
                    .to_owned(),
            }),
        }
    }
}
