//! How a surface is built.

use crate::mesh::BoundaryRule;
use crate::names::names;
use crate::scheme::{Contraction, RuleSet, SchemeKind, Variant};

/// How a surface is built; by default with `qas4` at full precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceOptions {
    /// The scheme at extraordinary points.
    pub scheme: SchemeKind,
    /// The tables of that scheme.
    pub rules: RuleSet,
    /// How fast its rings contract.
    pub contraction: Contraction,
    /// The rule at the boundary; `None` takes the rule of the cage's tags.
    pub boundary: Option<BoundaryRule>,
    /// The rings beside infinitely sharp creases and the boundary.
    pub creases: CreaseRings,
}

/// The rings of a vertex on an infinitely sharp crease or the boundary where one side has not two
/// faces.
///
/// The curve of the crease is the same with both, the cubic spline of its vertices, and so is all
/// of the surface but for these points. Darts, corners and semi-sharp features keep Catmull-Clark's
/// rules.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CreaseRings {
    /// Catmull-Clark's \[CC78\], \[DKT98\], as in OpenSubdiv: without a tangent plane from four
    /// faces on, and with curvature that grows without bounds.
    #[default]
    CatmullClark,
    /// Fairness-optimal rings, ours: tangent plane and bounded curvature for 1 to
    /// [`MAX_FAIR_FACES`](crate::scheme::MAX_FAIR_FACES) faces; Catmull-Clark's for more.
    Fair,
}

names! { CreaseRings, "kind of rings beside creases": CatmullClark => "cc", Fair => "fair" }

impl SurfaceOptions {
    /// Which rules of the scheme are taken.
    pub fn variant(&self) -> Variant {
        Variant { rules: self.rules, contraction: self.contraction }
    }
}
