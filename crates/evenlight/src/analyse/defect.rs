//! How far two patches are from being one surface where they meet.

use crate::patch::SurfacePoint;
use crate::point::{cross, dot, norm, sub};

/// The largest jumps of position (G0), tangent plane (G1) and curvature (G2) over some points of
/// borders.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Defect {
    /// Of position, in the units of the cage.
    pub position: f64,
    /// Of the tangent plane: the angle between the normals, in radians.
    pub tangent_plane: f64,
    /// Of curvature: the larger difference of the principal curvatures, in 1/unit or as whoever
    /// measures it says.
    pub curvature: f64,
}

impl Defect {
    /// The jumps between what two patches say at one point; the jump of curvature is in 1/unit.
    pub fn between(a: &SurfacePoint, b: &SurfacePoint) -> Self {
        let ([a1, a2], [b1, b2]) = (a.principal_curvatures(), b.principal_curvatures());
        Self {
            position: norm(sub(a.jet.p, b.jet.p)),
            tangent_plane: norm(cross(a.normal, b.normal)).atan2(dot(a.normal, b.normal)),
            curvature: (a1 - b1).abs().max((a2 - b2).abs()),
        }
    }

    /// The larger of each.
    pub fn max(self, other: Self) -> Self {
        Self {
            position: self.position.max(other.position),
            tangent_plane: self.tangent_plane.max(other.tangent_plane),
            curvature: self.curvature.max(other.curvature),
        }
    }
}
