//! Which primvars are accepted.

use std::collections::BTreeSet;

use crate::mesh::{Interpolation, Mesh, MeshError, Primvar, PrimvarFault};

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
