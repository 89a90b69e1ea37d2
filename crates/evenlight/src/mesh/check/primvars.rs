//! What primvars are accepted.

use std::collections::BTreeSet;
use std::fmt;

use crate::mesh::{Interpolation, Mesh, MeshError, Primvar};

/// What is wrong with a primvar. Values and corners are counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum PrimvarFault {
    /// An earlier primvar has its name.
    RepeatedName,
    /// There are no numbers in a value, or more than four.
    Width {
        /// The numbers in a value.
        width: usize,
    },
    /// The last value is not complete.
    BrokenValue {
        /// How many numbers there are.
        numbers: usize,
        /// The numbers in a value.
        width: usize,
    },
    /// There are too few or too many values of vertices, or indices of corners.
    Count {
        /// How many there are.
        found: usize,
        /// How many there should be.
        needed: usize,
        /// Whether there should be one for every corner; else for every vertex.
        corners: bool,
    },
    /// A corner has a value that does not exist.
    IndexOutOfRange {
        /// The corner, of all corners of all faces.
        corner: usize,
        /// The number of its value.
        index: u32,
        /// How many values there are.
        count: usize,
    },
    /// A value is NaN or infinite.
    NotFinite {
        /// The value.
        value: usize,
    },
}

impl fmt::Display for PrimvarFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RepeatedName => write!(f, "there is another primvar of that name: rename one"),
            Self::Width { width } => {
                write!(f, "has {width} numbers per value: give it 1 to 4, or split it")
            }
            Self::BrokenValue { numbers, width } => {
                write!(f, "has {numbers} numbers, no multiple of {width}: complete its last value")
            }
            Self::Count { found, needed, corners } => {
                let what = if *corners { ["indices", "corners"] } else { ["values", "vertices"] };
                let [own, of] = what;
                write!(f, "has {found} {own} for {needed} {of}: give it one for each")
            }
            Self::IndexOutOfRange { corner, index, count } => write!(
                f,
                "corner {corner} has value {index}, but there are {count} values: correct the index"
            ),
            Self::NotFinite { value } => {
                write!(f, "value {value} is not finite: give it finite numbers")
            }
        }
    }
}

/// What is wrong with the primvars of `mesh`, the first fault of each.
pub(super) fn faults(mesh: &Mesh) -> Vec<MeshError> {
    let mut names = BTreeSet::new();
    let fault = |primvar: &Primvar| {
        let repeated = (!names.insert(primvar.name.clone())).then_some(PrimvarFault::RepeatedName);
        let fault = repeated.or_else(|| fault_of(primvar, mesh))?;
        Some(MeshError::Primvar { name: primvar.name.clone(), fault })
    };
    mesh.primvars.iter().filter_map(fault).collect()
}

fn fault_of(primvar: &Primvar, mesh: &Mesh) -> Option<PrimvarFault> {
    let Primvar { interpolation, width, values, indices, .. } = primvar;
    if !(1..=4).contains(width) {
        return Some(PrimvarFault::Width { width: *width });
    }
    if values.len() % width != 0 {
        return Some(PrimvarFault::BrokenValue { numbers: values.len(), width: *width });
    }
    let count = values.len() / width;
    let is_face_varying = *interpolation == Interpolation::FaceVarying;
    let (found, needed) = if is_face_varying {
        (indices.len(), mesh.faces.all_corners().len())
    } else {
        (count, mesh.positions.len())
    };
    if found != needed {
        return Some(PrimvarFault::Count { found, needed, corners: is_face_varying });
    }
    if let Some(corner) = indices.iter().position(|&i| i as usize >= count && is_face_varying) {
        return Some(PrimvarFault::IndexOutOfRange { corner, index: indices[corner], count });
    }
    let value = values.iter().position(|x| !x.is_finite())? / width;
    Some(PrimvarFault::NotFinite { value })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Cage;

    fn triangle(primvars: Vec<Primvar>) -> Mesh {
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        Mesh { primvars, ..Mesh::new(positions, [[0, 1, 2]]) }
    }

    fn face_varying(width: usize, values: &[f64], indices: &[u32]) -> Primvar {
        let (values, indices) = (values.to_vec(), indices.to_vec());
        let interpolation = Interpolation::FaceVarying;
        Primvar { name: "st".to_owned(), interpolation, width, values, indices }
    }

    #[test]
    fn what_cannot_be_evaluated_is_refused_by_name() {
        let good = || face_varying(1, &[0.0, 1.0], &[0, 1, 1]);
        assert!(Cage::new(triangle(vec![good()])).is_ok());
        let vertex = Primvar { interpolation: Interpolation::Vertex, ..good() };
        let cases = [
            (vec![good(), good()], "there is another primvar of that name"),
            (vec![face_varying(5, &[0.0; 5], &[0; 3])], "has 5 numbers per value"),
            (vec![face_varying(2, &[0.0; 3], &[0; 3])], "has 3 numbers, no multiple of 2"),
            (vec![face_varying(1, &[0.0], &[0; 2])], "2 indices for 3 corners"),
            (vec![face_varying(1, &[0.0], &[0, 1, 0])], "corner 1 has value 1, but there are 1"),
            (vec![face_varying(1, &[0.0, f64::NAN], &[0; 3])], "value 1 is not finite"),
            (vec![vertex], "2 values for 3 vertices"),
        ];
        for (primvars, message) in cases {
            let error = Cage::new(triangle(primvars)).unwrap_err().to_string();
            assert!(error.contains("primvar `st`") && error.contains(message), "{error}");
        }
    }
}
