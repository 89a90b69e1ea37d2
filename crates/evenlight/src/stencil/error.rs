//! Why there are no stencils.

use crate::cap::CapError;
use crate::surface::{ArrayError, QuadId};
use crate::task::Cancelled;

/// Why stencils could not be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StencilError {
    /// There is no such quad.
    #[error("place {place}: there is no quad {}", quad.0)]
    Quad {
        /// The number of the place.
        place: usize,
        /// The quad that it names.
        quad: QuadId,
    },
    /// A parameter is not a number.
    #[error("place {place}: a parameter is not a number")]
    Parameter {
        /// The number of the place.
        place: usize,
    },
    /// There is no surface over the quad.
    #[error("place {place}: the surface leaves out quad {}", quad.0)]
    Omitted {
        /// The number of the place.
        place: usize,
        /// The quad that it names.
        quad: QuadId,
    },
    /// The place of a patch is not one of this surface.
    #[error("patch {patch} is of another surface")]
    Patch {
        /// The number of the patch.
        patch: usize,
    },
    /// There is no such primvar.
    #[error("there is no primvar {primvar}")]
    Primvar {
        /// Its number.
        primvar: usize,
    },
    /// The primvar is bilinear: it has no patches of its own.
    #[error("the primvar is interpolated linearly and has no patches; take its limits")]
    Linear,
    /// There are no unit nets of so many faces.
    #[error(
        "{faces} faces lie between two sharp edges at an extraordinary point, and stencils are for {most} \
         at most; make an edge between them sharp, or split the vertex"
    )]
    Fan {
        /// The number of the faces.
        faces: usize,
        /// The most that there may be.
        most: usize,
    },
    /// There are no such caps.
    #[error(transparent)]
    Cap(#[from] CapError),
    /// The order of derivatives is none, or arrays do not fit together.
    #[error(transparent)]
    Array(#[from] ArrayError),
    /// Who watches the work stopped it ([`Task::watch`](crate::task::Task::watch)).
    #[error("the work was cancelled")]
    Cancelled,
    /// There are more vertices, rows or weights than 32 bits can number.
    #[error("32 bits cannot number so many weights; ask for fewer rows at a time")]
    TooLarge,
}

impl From<Cancelled> for StencilError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}
