//! Texture coordinates and colours on their way to primvars.

use crate::mesh::{Interpolation, Primvar};

/// What was read so far beside positions and faces.
#[derive(Debug, Default)]
pub(super) struct Primvars {
    /// `vt`; what is missing is 0.
    textures: Vec<[f64; 3]>,
    /// The texture coordinate of every corner so far; empty as long as none has one.
    corners: Vec<Option<u32>>,
    /// The colours of the vertices that have one, three numbers each.
    colors: Vec<f64>,
}

impl Primvars {
    /// The number of texture coordinates so far.
    pub fn num_textures(&self) -> usize {
        self.textures.len()
    }

    /// Adds a texture coordinate.
    pub fn add_texture(&mut self, texture: [f64; 3]) {
        self.textures.push(texture);
    }

    /// Adds the colour on a vertex' line, which has six numbers.
    pub fn add_color(&mut self, [_, _, _, r, g, b]: [f64; 6]) {
        self.colors.extend([r, g, b]);
    }

    /// Adds the corners of a face, before which there were `num_before` corners.
    pub fn add_corners(&mut self, num_before: usize, textures: &[Option<u32>]) {
        if !self.corners.is_empty() || textures.iter().any(Option::is_some) {
            self.corners.resize(num_before, None);
            self.corners.extend(textures);
        }
    }

    /// The primvars, and what was completed or left out, in sentences.
    pub fn finish(self, num_vertices: usize, num_corners: usize) -> (Vec<Primvar>, Vec<String>) {
        let mut remarks = Vec::new();
        let uvs = uvs(self.textures, self.corners, num_corners, &mut remarks);
        let colors = colors(self.colors, num_vertices, &mut remarks);
        (uvs.into_iter().chain(colors).collect(), remarks)
    }
}

fn uvs(
    mut textures: Vec<[f64; 3]>,
    corners: Vec<Option<u32>>,
    num_corners: usize,
    remarks: &mut Vec<String>,
) -> Option<Primvar> {
    if corners.is_empty() {
        return None;
    }
    let missing = num_corners - corners.iter().flatten().count();
    let stand_in = textures.len() as u32;
    if missing > 0 {
        textures.push([0.0; 3]);
        remarks.push(format!(
            "{missing} of {num_corners} corners of faces have no texture coordinate and get (0, 0)"
        ));
    }
    let width = if textures.iter().any(|t| t[2] != 0.0) { 3 } else { 2 };
    let values = textures.iter().flat_map(|t| &t[..width]).copied().collect();
    let mut indices: Vec<u32> = corners.into_iter().map(|c| c.unwrap_or(stand_in)).collect();
    indices.resize(num_corners, stand_in);
    let interpolation = Interpolation::FaceVarying;
    Some(Primvar { name: "st".to_owned(), interpolation, width, values, indices })
}

fn colors(values: Vec<f64>, num_vertices: usize, remarks: &mut Vec<String>) -> Option<Primvar> {
    let found = values.len() / 3;
    if found == 0 {
        return None;
    }
    if found < num_vertices {
        remarks.push(format!(
            "only {found} of {num_vertices} vertices have a colour: colours are ignored"
        ));
        return None;
    }
    let (interpolation, indices) = (Interpolation::Vertex, Vec::new());
    Some(Primvar { name: "color".to_owned(), interpolation, width: 3, values, indices })
}
