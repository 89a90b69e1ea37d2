//! The refined cage as stencils.

use super::columns::Columns;
use super::{StencilError, linear};
use crate::mesh::refine::Level;
use crate::mesh::sharpness::Sharpness;
use crate::mesh::{FaceId, Faces, Topology};
use crate::sparse::Stencils;

/// The cage after some steps of Catmull-Clark refinement, as weights of its values.
///
/// Its faces come in the order of the faces that they are parts of. A face of m corners has m
/// children, one per corner; child k of a quad stands at corner k in the quad's orientation, child
/// k of an n-gon begins with that corner. Vertices are numbered as faces first use them; vertices
/// of the cage in no face are gone. At level 0 everything is as in the cage.
#[derive(Clone, Debug)]
pub struct RefinedCage {
    /// The faces, counter-clockwise, by the rows of `stencils`.
    pub faces: Faces,
    /// The face of the cage that each face is a part of.
    pub parents: Vec<FaceId>,
    /// A row for each vertex.
    pub stencils: Stencils,
}

/// How values go to the next level.
pub(super) enum Masks<'a> {
    /// Catmull-Clark, with the sharpness of the cage.
    Smooth(&'a Sharpness),
    /// Linearly.
    Linear,
}

/// The refined cage over a topology.
pub(super) fn refined(
    topology: &Topology,
    masks: &Masks<'_>,
    mut columns: Columns,
    steps: usize,
) -> Result<RefinedCage, StencilError> {
    check_size(topology, steps)?;
    let mut sharpness = match *masks {
        Masks::Smooth(sharpness) => sharpness.clone(),
        Masks::Linear => Sharpness::default(),
    };
    let mut fine = topology.clone();
    let mut parents: Vec<FaceId> = topology.faces().ids().collect();
    for _ in 0..steps {
        let level = Level::refine(&fine, &vec![true; fine.faces().len()]);
        let rows = columns.refined(level.topology().num_vertices(), |v| match masks {
            Masks::Smooth(_) => level.mask(&fine, &sharpness, v),
            Masks::Linear => linear::mask(&fine, &level, v),
        })?;
        columns.push(rows);
        sharpness = level.sharpness(&fine, &sharpness);
        let children = parents.iter().zip(fine.faces().iter());
        parents = children.flat_map(|(&face, corners)| vec![face; corners.len()]).collect();
        fine = level.topology().clone();
    }
    let stencils = columns.into_rows(fine.num_vertices())?;
    Ok(RefinedCage { faces: fine.faces().clone(), parents, stencils })
}

/// Fails if 32 bits cannot number the corners of all faces.
fn check_size(topology: &Topology, steps: usize) -> Result<(), StencilError> {
    let mut corners = topology.faces().all_corners().len() as u64;
    for _ in 0..steps {
        // Every corner becomes a quad.
        corners = corners.saturating_mul(4);
        if corners > u64::from(u32::MAX) {
            return Err(StencilError::TooLarge);
        }
    }
    Ok(())
}
