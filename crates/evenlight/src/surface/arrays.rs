//! Evaluation from arrays into arrays, for callers from other languages.
//!
//! A row of the answers holds the N numbers of the position, or of the value of a primvar, then
//! the numbers of its derivatives up to the order asked for:
//!
//! ```text
//!   order 0: p              order 1: p u v            order 2: p u v uu uv vv
//!   |x y z|x y z|...        |x y z xu yu zu xv yv zv|...
//!    place 0     1           place 0                   1
//! ```
//!
//! Rows of places without a surface, and of parameters that are NaN, are NaN.

use super::{Layout, QuadId, Surface};
use crate::mesh::FaceId;
use crate::patch::{Answer, FirstJet, Jet};
use crate::task::{Cancelled, Steps, for_each_chunk};

/// A number of an array: `f64` or `f32`.
pub trait Number: Copy + Send + Sync + sealed::Sealed {
    /// The nearest such number.
    fn of(x: f64) -> Self;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for f32 {}
}

impl Number for f64 {
    fn of(x: f64) -> Self {
        x
    }
}

impl Number for f32 {
    fn of(x: f64) -> Self {
        x as f32
    }
}

/// Why arrays cannot be evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ArrayError {
    /// The order of derivatives is none of 0, 1 and 2.
    #[error("order {order} is none of 0, 1 and 2")]
    Order {
        /// The order.
        order: usize,
    },
    /// Two arrays do not fit together.
    #[error("{what} has {found} entries, but needs {expected}")]
    Length {
        /// The array.
        what: &'static str,
        /// The entries that it needs.
        expected: usize,
        /// The entries that it has.
        found: usize,
    },
    /// There is no such parametric quad.
    #[error("place {place} is in quad {quad}, but there are the quads 0 to {}", quads.saturating_sub(1))]
    NoSuchQuad {
        /// The number of the place.
        place: usize,
        /// The quad.
        quad: u32,
        /// The number of quads.
        quads: usize,
    },
    /// There is no such face, or no such corner of it.
    #[error("place {place}: there is no corner {corner} of face {face} (of quads it must be 0)")]
    NoSuchCorner {
        /// The number of the place.
        place: usize,
        /// The face.
        face: u32,
        /// The corner.
        corner: u32,
    },
    /// Who watches the work stopped it ([`Task::watch`](crate::task::Task::watch)).
    #[error("the work was cancelled")]
    Cancelled,
}

impl From<Cancelled> for ArrayError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// The numbers of a row: N times 1, 3 or 6.
///
/// # Errors
///
/// [`ArrayError::Order`].
pub const fn row_width<const N: usize>(order: usize) -> Result<usize, ArrayError> {
    match order {
        0 => Ok(N),
        1 => Ok(3 * N),
        2 => Ok(6 * N),
        _ => Err(ArrayError::Order { order }),
    }
}

/// Places that are evaluated between two steps.
const SLICE: usize = 1 << 18;

impl Layout {
    /// The parametric quads of faces and their corners; without corners, of faces with four.
    ///
    /// # Errors
    ///
    /// [`ArrayError::NoSuchCorner`], [`ArrayError::Length`].
    pub fn quads_of(&self, faces: &[u32], corners: Option<&[u32]>) -> Result<Vec<u32>, ArrayError> {
        if let Some(corners) = corners {
            check_length("corners", corners.len(), faces.len())?;
        }
        let mut quads = Vec::with_capacity(faces.len());
        for (place, &face) in faces.iter().enumerate() {
            let corner = corners.map_or(0, |corners| corners[place]);
            let quad = self.quad(FaceId(face), corner as usize);
            quads.push(quad.ok_or(ArrayError::NoSuchCorner { place, face, corner })?.0);
        }
        Ok(quads)
    }
}

impl<const N: usize> Surface<N> {
    /// Evaluates at places (u, v) of parametric quads with derivatives up to `order` 0, 1 or 2,
    /// into rows of the caller's array as the module says. The bits are those of
    /// [`Surface::eval_as`], rounded if the array is of `f32`.
    ///
    /// ```
    /// use evenlight::{Cage, Mesh, Surface, SurfaceOptions};
    ///
    /// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    /// let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]]))?;
    /// let surface = Surface::build(cage, SurfaceOptions::default())?;
    /// let mut rows = [0.0_f32; 2 * 9];
    /// surface.eval_arrays(&[0, 0], &[[0.0, 0.0], [0.5, 0.5]], 1, &mut rows)?;
    /// assert_eq!(rows[9..12], [0.5, 0.5, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ArrayError`]; the array is untouched but if the work was cancelled.
    pub fn eval_arrays<T: Number>(
        &self,
        quads: &[u32],
        uv: &[[f64; 2]],
        order: usize,
        rows: &mut [T],
    ) -> Result<(), ArrayError> {
        let width = row_width::<N>(order)?;
        check_length("uv", uv.len(), quads.len())?;
        check_length("the array of answers", rows.len(), width.saturating_mul(quads.len()))?;
        let count = self.num_quads();
        if let Some(place) = quads.iter().position(|&quad| quad as usize >= count) {
            return Err(ArrayError::NoSuchQuad { place, quad: quads[place], quads: count });
        }
        match order {
            0 => self.eval_rows(quads, uv, rows, |&p: &[f64; N]| [p]),
            1 => self.eval_rows(quads, uv, rows, |j: &FirstJet<N>| [j.p, j.du, j.dv]),
            _ => self.eval_rows(quads, uv, rows, Jet::rows),
        }
    }

    /// [`Surface::eval_arrays`] at places of faces; `corners` are corners of n-gons, 0 for quads.
    ///
    /// # Errors
    ///
    /// [`ArrayError`]; the array is untouched but if the work was cancelled.
    pub fn eval_faces<T: Number>(
        &self,
        faces: &[u32],
        corners: Option<&[u32]>,
        uv: &[[f64; 2]],
        order: usize,
        rows: &mut [T],
    ) -> Result<(), ArrayError> {
        let quads = self.layout().quads_of(faces, corners)?;
        self.eval_arrays(&quads, uv, order, rows)
    }

    /// Evaluates answers of K rows of N numbers.
    fn eval_rows<T: Number, A: Answer<N>, const K: usize>(
        &self,
        quads: &[u32],
        uv: &[[f64; 2]],
        rows: &mut [T],
        of: impl Fn(&A) -> [[f64; N]; K] + Sync,
    ) -> Result<(), ArrayError> {
        /// Places for a thread at a time.
        const CHUNK: usize = 1 << 10;
        let width = K * N;
        let mut steps = Steps::new("Evaluating", quads.len().div_ceil(SLICE))?;
        for (slice, rows) in rows.chunks_mut(SLICE * width).enumerate() {
            for_each_chunk(rows, CHUNK * width, |first, rows| {
                let first = slice * SLICE + first / width;
                for (k, row) in rows.chunks_exact_mut(width).enumerate() {
                    let (quad, [u, v]) = (QuadId(quads[first + k]), uv[first + k]);
                    let answer: A = self.eval_as(quad, u, v).unwrap_or(A::NAN);
                    let numbers = of(&answer);
                    for (x, &y) in row.iter_mut().zip(numbers.as_flattened()) {
                        *x = T::of(y);
                    }
                }
            });
            steps.step()?;
        }
        Ok(())
    }
}

pub(super) fn check_length(
    what: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), ArrayError> {
    if found == expected { Ok(()) } else { Err(ArrayError::Length { what, expected, found }) }
}

/// The BB coefficients of all patches of one bi-degree, one patch after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchBlock {
    /// The degree in both parameters.
    pub degree: usize,
    /// The numbers of the patches among those of [`Surface::patch_places`].
    pub patches: Vec<u32>,
    /// The coefficients: (degree + 1)^2 of N numbers each per patch, the v index fastest.
    pub coefs: Vec<f64>,
}

impl<const N: usize> Surface<N> {
    /// The patches of [`Surface::patches`] as flat blocks, a block for every bi-degree, in rising
    /// order.
    ///
    /// ```
    /// use evenlight::{Cage, Mesh, Surface, SurfaceOptions};
    ///
    /// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    /// let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]]))?;
    /// let surface = Surface::build(cage, SurfaceOptions::default())?;
    /// let blocks = surface.patch_blocks(0);
    /// assert_eq!((blocks[0].degree, blocks[0].coefs.len()), (3, 16 * 3));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn patch_blocks(&self, rings: usize) -> Vec<PatchBlock> {
        let mut blocks: Vec<PatchBlock> = Vec::new();
        for (number, placed) in self.patches(rings).enumerate() {
            let [degree, _] = placed.patch.degree();
            let at = blocks.partition_point(|block| block.degree < degree);
            if blocks.get(at).is_none_or(|block| block.degree != degree) {
                blocks.insert(at, PatchBlock { degree, ..PatchBlock::default() });
            }
            blocks[at].patches.push(number as u32);
            blocks[at].coefs.extend_from_slice(placed.patch.coefs().as_flattened());
        }
        blocks
    }
}
