//! What a file says about a cage besides positions and faces: rules, sharpness, holes, primvars.
//!
//! Names and meanings are the same as in OpenSubdiv, so that tags mean here what they mean in the
//! programs that make the cages.

use super::{FaceId, VertexId};
use crate::names::names;

/// What happens at the boundary of an open cage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BoundaryRule {
    /// Faces that touch the boundary have no surface.
    None,
    /// The boundary is a smooth curve, also at vertices of a single face.
    EdgeOnly,
    /// The boundary is a smooth curve that passes through the vertices of a single face.
    #[default]
    EdgeAndCorner,
}

names! { BoundaryRule, "boundary rule":
    None => "none",
    EdgeOnly => "edge-only",
    EdgeAndCorner => "edge-and-corner",
}

/// How the sharpness of a crease falls from one refinement to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CreaseMethod {
    /// By one.
    #[default]
    Uniform,
    /// Averaged along the crease as in Chaikin's corner cutting, then by one.
    Chaikin,
}

names! { CreaseMethod, "crease method": Uniform => "uniform", Chaikin => "chaikin" }

/// Which parts of a face-varying primvar are interpolated linearly instead of smoothly.
///
/// At a vertex of the cage the corners with one value are one vertex of the primvar. Seams are
/// where values differ; seams and the cage's boundary are boundaries of the primvar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FaceVaryingRule {
    /// None: seams are smooth curves, also where a single face has a value.
    None,
    /// A value that only one face has at a vertex is sharp.
    CornersOnly,
    /// Sharp are the values of `CornersOnly`, all values where three or more meet, and both of two
    /// values if a seam or an infinitely sharp crease breaks one of them. If creases make one of
    /// two values sharp for some refinements, the other is sharp for as long.
    #[default]
    CornersPlus1,
    /// Sharp are the values of `CornersPlus1`, the ends of seams inside the cage (darts), and both
    /// of two values if one belongs to a single face: then its neighbour has a concave corner.
    CornersPlus2,
    /// All seams and boundaries are linear.
    Boundaries,
    /// Everything is linear: bilinear over every quad.
    All,
}

names! { FaceVaryingRule, "face-varying rule":
    None => "none",
    CornersOnly => "corners-only",
    CornersPlus1 => "corners-plus1",
    CornersPlus2 => "corners-plus2",
    Boundaries => "boundaries",
    All => "all",
}

/// From this sharpness on an edge or vertex is sharp for ever.
pub const INFINITELY_SHARP: f64 = 10.0;

/// The sharpness of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crease {
    /// The ends of the edge.
    pub edge: [VertexId; 2],
    /// From 0 (smooth) to [`INFINITELY_SHARP`] or more; surfaces take it in single precision.
    pub sharpness: f64,
}

/// The sharpness of a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// The vertex.
    pub vertex: VertexId,
    /// From 0 (smooth) to [`INFINITELY_SHARP`] or more; surfaces take it in single precision.
    pub sharpness: f64,
}

/// Rules, sharpness and holes; by default none, with the boundary rule edge-and-corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tags {
    /// The rule at the boundary.
    pub boundary: BoundaryRule,
    /// The rule for semi-sharp creases.
    pub crease_method: CreaseMethod,
    /// The rule for face-varying primvars.
    pub face_varying: FaceVaryingRule,
    /// Sharp edges; if an edge is named twice, the last entry counts.
    pub creases: Vec<Crease>,
    /// Sharp vertices; if a vertex is named twice, the last entry counts.
    pub corners: Vec<Corner>,
    /// Faces that take part in refinement but have no surface.
    pub holes: Vec<FaceId>,
}

/// How the values of a primvar are interpolated over a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// One value per vertex, by the basis of the positions.
    Vertex,
    /// One value per vertex, bilinear over every face.
    Varying,
    /// One value per corner of a face, smooth except where the corners of a vertex differ.
    FaceVarying,
}

/// Values beside positions: texture coordinates, colours.
#[derive(Clone, Debug, PartialEq)]
pub struct Primvar {
    /// The name, unique among the cage's primvars.
    pub name: String,
    /// How its values are interpolated.
    pub interpolation: Interpolation,
    /// The numbers in a value, 1 to 4.
    pub width: usize,
    /// The values, `width` numbers each.
    pub values: Vec<f64>,
    /// Of a face-varying primvar, the value of every corner in the order of
    /// [`Faces::all_corners`](super::Faces::all_corners); corners of a vertex with one number are
    /// joined, those with several are apart. Empty for the others, whose values are in the order
    /// of the vertices.
    pub indices: Vec<u32>,
}

impl Primvar {
    /// Whether files of triangles take this for texture coordinates: it has two numbers, or three
    /// and a name of texture coordinates.
    pub fn is_uv_set(&self) -> bool {
        self.width == 2 || (self.width == 3 && self.has_uv_name())
    }

    /// Whether it is named as texture coordinates are: `st` or `uv`.
    pub fn has_uv_name(&self) -> bool {
        matches!(self.name.as_str(), "st" | "uv")
    }

    /// Whether files take this for a colour: three numbers, or four with the opacity, under the
    /// name `color` (of OBJ and PLY) or `displayColor` (of USD).
    pub fn is_color(&self) -> bool {
        matches!(self.width, 3 | 4) && matches!(self.name.as_str(), "color" | "displayColor")
    }
}
