//! The surface as an object: position, derivatives and curvature at any (face, u, v).
//!
//! Every quad of the cage is one parametric quad (u,v) in the unit square; an n-gon is n of
//! them, one per corner:
//!
//! ```text
//!  d (0,1) --- c (1,1)            quad k of an n-gon: (0,0) is corner k, u runs towards
//!     |           |               corner k+1 (half of that edge), v towards corner k-1,
//!     |  (u,v)    |               (1,1) is the face's centre.
//!     |           |
//!  a (0,0) --- b (1,0)
//! ```

use std::sync::Arc;

use crate::mesh::{Cage, FaceId, VertexId};
use crate::patch::{Patch, SurfacePoint};
use crate::point::Point;
use crate::scheme::{RuleSet, SchemeKind};

/// The number of a parametric quad: all quads of face 0, then of face 1, and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct QuadId(pub u32);

/// How a surface is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceOptions {
    /// The scheme at extraordinary vertices.
    pub scheme: SchemeKind,
    /// The tables of that scheme.
    pub rules: RuleSet,
}

/// A subdivision surface over a cage.
#[derive(Debug)]
pub struct Surface {
    cage: Arc<Cage>,
    options: SurfaceOptions,
}

/// An extraordinary point: an interior vertex of valence other than 4, or the centre of an
/// n-gon.
#[derive(Clone, Debug)]
pub struct ExtraordinaryPoint {
    /// The vertex of the cage; `None` for the centre of an n-gon.
    pub vertex: Option<VertexId>,
    /// The n-gon whose centre this is; `None` for a vertex.
    pub face: Option<FaceId>,
    /// The number of edges that meet here.
    pub valence: usize,
    /// The level of Catmull-Clark refinement (0, 1 or 2) at which it is isolated.
    pub level: usize,
    /// The limit point.
    pub position: Point,
    /// The limit normal.
    pub normal: Point,
    /// The sectors counter-clockwise: the parametric quad of each, its corner (0 to 3) at this
    /// point, and the part of the quad that it covers: (u,v) runs from that corner over
    /// 2^-level' of the quad, where level' counts from the quad (0 to 2).
    pub sectors: Vec<Sector>,
}

/// The piece of a parametric quad that belongs to an extraordinary point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sector {
    /// The parametric quad.
    pub quad: QuadId,
    /// The parameters of the extraordinary point in that quad.
    pub center: [f64; 2],
    /// The parameter steps from the centre to the ends of the sector's two lines:
    /// `center + a * along[0] + b * along[1]` with a and b in [0,1] covers the sector.
    pub along: [[f64; 2]; 2],
}

/// What a patch is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// A bi-3 patch whose four corners are regular.
    Regular,
    /// A patch of ring `k` around an extraordinary point, counted from 1.
    Ring(usize),
}

/// One polynomial patch of the surface and where it lies.
#[derive(Clone, Debug)]
pub struct PlacedPatch {
    /// What it is part of.
    pub role: Role,
    /// The parametric quad that it lies in.
    pub quad: QuadId,
    /// The part of that quad: [[u0, u1], [v0, v1]]; the patch's own (u,v) runs over it in the
    /// same directions.
    pub domain: [[f64; 2]; 2],
    /// The extraordinary point it belongs to, as an index into
    /// [`Surface::extraordinary_points`]; `None` for regular patches.
    pub point: Option<usize>,
    /// The sector of that point, from 0.
    pub sector: Option<usize>,
    /// The polynomial.
    pub patch: Patch,
}

/// Why no surface could be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// There are no rules for these valences.
    #[error("no rules for valence above {max}")]
    ValenceTooHigh {
        /// The vertices and their valences.
        vertices: Vec<(Option<VertexId>, Option<FaceId>, usize)>,
        /// The highest valence with rules.
        max: usize,
    },
}

impl Surface {
    /// Builds the surface over `cage`.
    pub fn build(_cage: impl Into<Arc<Cage>>, _options: SurfaceOptions) -> Result<Self, SurfaceError> {
        todo!()
    }

    /// The cage.
    pub fn cage(&self) -> &Cage {
        &self.cage
    }

    /// How it was built.
    pub fn options(&self) -> SurfaceOptions {
        self.options
    }

    /// The number of parametric quads, omitted ones included.
    pub fn num_quads(&self) -> usize {
        todo!()
    }

    /// The parametric quad at `corner` of `face`; for a face with four corners the corner
    /// must be 0. `None` if there is no such face or corner.
    pub fn quad(&self, _face: FaceId, _corner: usize) -> Option<QuadId> {
        todo!()
    }

    /// The face of `quad`, and the corner if the face is an n-gon (else 0).
    pub fn face_of(&self, _quad: QuadId) -> (FaceId, usize) {
        todo!()
    }

    /// Whether there is a surface over `face` (not so where it touches a boundary).
    pub fn is_omitted(&self, _face: FaceId) -> bool {
        todo!()
    }

    /// The faces without a surface, in order.
    pub fn omitted_faces(&self) -> &[FaceId] {
        todo!()
    }

    /// Position, derivatives, normal and curvature at (u,v) of `quad`, clamped to [0,1];
    /// `None` if the face is omitted.
    ///
    /// At an extraordinary point itself the position is the limit point and the normal the
    /// limit normal; derivatives and curvature do not exist there and are NaN.
    pub fn eval(&self, _quad: QuadId, _u: f64, _v: f64) -> Option<SurfacePoint> {
        todo!()
    }

    /// The extraordinary points that have a surface around them.
    pub fn extraordinary_points(&self) -> &[ExtraordinaryPoint] {
        todo!()
    }

    /// All regular patches and the rings 1 to `rings` of every extraordinary point.
    pub fn patches(&self, _rings: usize) -> impl Iterator<Item = PlacedPatch> {
        std::iter::empty()
    }
}
