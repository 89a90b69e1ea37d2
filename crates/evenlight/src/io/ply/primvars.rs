//! Properties of vertices and corners on their way to primvars.

use std::collections::HashMap;

use super::header::{Property, word};
use crate::mesh::{Interpolation, Primvar, VertexId};

/// Properties that are one primvar, and its name.
pub(super) const GROUPS: [(&str, &[&str]); 6] = [
    ("color", &["red", "green", "blue", "alpha"]),
    ("color", &["red", "green", "blue"]),
    ("normals", &["nx", "ny", "nz"]),
    ("st", &["s", "t"]),
    ("st", &["u", "v"]),
    ("st", &["texture_u", "texture_v"]),
];

/// Puts `columns` of values of vertices into primvars and adds them to `primvars`.
pub(super) fn group(
    columns: Vec<(&Property, Vec<f64>)>,
    primvars: &mut Vec<Primvar>,
    remarks: &mut Vec<String>,
) {
    let mut columns: Vec<Option<(&Property, Vec<f64>)>> = columns.into_iter().map(Some).collect();
    while let Some(first) = columns.iter().flatten().next() {
        let (name, members) = group_of(&first.0.name, &columns);
        let name = free_name(name, primvars);
        let taken = members.iter().filter_map(|member| {
            let of_name = |c: &&mut Option<(&Property, Vec<f64>)>| {
                c.as_ref().is_some_and(|(property, _)| property.name == *member)
            };
            columns.iter_mut().find(of_name).and_then(Option::take)
        });
        let taken: Vec<Vec<f64>> =
            taken.map(|(property, values)| in_units(property, &name, values)).collect();
        if taken.iter().flatten().all(|x| x.is_finite()) {
            primvars.push(interleave(name, &taken));
        } else {
            remarks.push(format!(
                "the primvar `{}` has values that are not finite: it is left out",
                word(&name)
            ));
        }
    }
}

/// The primvar that a property belongs to, and all its properties.
fn group_of(name: &str, columns: &[Option<(&Property, Vec<f64>)>]) -> (String, Vec<String>) {
    let is_there = |name: &str| columns.iter().flatten().any(|(p, _)| p.name == name);
    for (group, members) in GROUPS {
        if members.contains(&name) && members.iter().all(|m| is_there(m)) {
            return (group.to_owned(), members.iter().map(|m| (*m).to_owned()).collect());
        }
    }
    if let Some((stem, _)) = name.rsplit_once('_').filter(|(stem, _)| !stem.is_empty()) {
        let numbered = (0..4).map(|k| format!("{stem}_{k}"));
        let members: Vec<String> = numbered.take_while(|name| is_there(name)).collect();
        if members.len() > 1 && members.iter().any(|m| m == name) {
            return (stem.to_owned(), members);
        }
    }
    (name.to_owned(), vec![name.to_owned()])
}

/// `name`, or a longer one that no primvar has.
fn free_name(mut name: String, primvars: &[Primvar]) -> String {
    while primvars.iter().any(|p| p.name == name) {
        name.push('_');
    }
    name
}

/// Colours as fractions of full light, anything else as it is.
fn in_units(property: &Property, primvar: &str, mut values: Vec<f64>) -> Vec<f64> {
    let is_color = primvar.trim_end_matches('_') == "color";
    if let Some((_, largest)) = property.scalar.range().filter(|_| is_color) {
        values.iter_mut().for_each(|x| *x /= largest);
    }
    values
}

fn interleave(name: String, columns: &[Vec<f64>]) -> Primvar {
    let num_values = columns.first().map_or(0, Vec::len);
    let values =
        (0..num_values).flat_map(|k| columns.iter().map(move |column| column[k])).collect();
    let (interpolation, indices) = (Interpolation::Vertex, Vec::new());
    Primvar { name, interpolation, width: columns.len(), values, indices }
}

/// Texture coordinates of corners; equal ones of a vertex are one.
#[derive(Debug, Default)]
pub(super) struct CornerValues {
    values: Vec<f64>,
    indices: Vec<u32>,
    /// The number of the value with these bits at a vertex.
    known: HashMap<(VertexId, [u64; 2]), u32>,
    num_missing: usize,
}

impl CornerValues {
    /// Adds the corners of a face with two numbers each, or none at all.
    pub fn add_face(
        &mut self,
        corners: impl ExactSizeIterator<Item = VertexId>,
        numbers: &[f64],
    ) -> Result<(), String> {
        let num_corners = corners.len();
        if !numbers.is_empty() && numbers.len() != 2 * num_corners {
            return Err(format!(
                "`texcoord` has {} numbers for {num_corners} corners: give each two",
                numbers.len()
            ));
        }
        self.num_missing += if numbers.is_empty() { num_corners } else { 0 };
        let pairs = numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        for (vertex, value) in corners.zip(pairs.chain(std::iter::repeat([0.0; 2]))) {
            let next = (self.values.len() / 2) as u32;
            let index = *self.known.entry((vertex, value.map(f64::to_bits))).or_insert(next);
            if index == next {
                self.values.extend(value);
            }
            self.indices.push(index);
        }
        Ok(())
    }

    /// The primvar, if there are corners and they have finite values.
    pub fn finish(self, remarks: &mut Vec<String>) -> Option<Primvar> {
        let num_corners = self.indices.len();
        if self.num_missing == num_corners {
            return None;
        }
        if self.num_missing > 0 {
            remarks.push(format!(
                "{} of {num_corners} corners of faces have no texture coordinate and get (0, 0)",
                self.num_missing
            ));
        }
        if !self.values.iter().all(|x| x.is_finite()) {
            remarks.push("`texcoord` has values that are not finite: it is left out".to_owned());
            return None;
        }
        let (interpolation, width) = (Interpolation::FaceVarying, 2);
        let (values, indices) = (self.values, self.indices);
        Some(Primvar { name: "st".to_owned(), interpolation, width, values, indices })
    }
}
