//! Tensor-product patches in Bernstein-Bezier (BB) form.
//!
//! A patch of degree (`du`, `dv`) is the map
//!
//! ```text
//! p(u,v) = sum_ij b_ij B_i^du(u) B_j^dv(v),   B_i^d(t) = C(d,i) (1-t)^(d-i) t^i,
//! ```
//!
//! for (u,v) in the unit square. Coefficients are stored with `j`, the `v` index, fastest, as
//! BezierView and most exchange formats have them:
//!
//! ```text
//! v ^  b02 b12 b22
//!   |  b01 b11 b21      index(i, j) = i (dv + 1) + j
//!   |  b00 b10 b20
//!   +-------------> u
//! ```
//!
//! Coefficients are points in space, N = 3, or the N = 1 to 4 numbers of a primvar.

mod answer;
pub mod basis;
mod jet;
pub(crate) mod kernel;

pub use answer::Answer;
pub(crate) use answer::Parts;
pub(crate) use jet::Shape;
pub use jet::{FirstJet, Jet, SurfacePoint};

/// The highest degree of a patch in one parameter.
pub const MAX_DEGREE: usize = 6;

/// A tensor-product patch in Bernstein-Bezier form.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch<const N: usize = 3> {
    degree: [usize; 2],
    coefs: Vec<[f64; N]>,
}

impl<const N: usize> Patch<N> {
    /// Builds a patch of degree `[du, dv]` from its BB coefficients, `v` index fastest.
    ///
    /// # Errors
    ///
    /// [`PatchError`] if a degree is above [`MAX_DEGREE`], or there are not `(du + 1) (dv + 1)`
    /// coefficients.
    pub fn new(degree: [usize; 2], coefs: Vec<[f64; N]>) -> Result<Self, PatchError> {
        let [du, dv] = degree;
        if du > MAX_DEGREE || dv > MAX_DEGREE {
            return Err(PatchError::Degree { du, dv });
        }
        let (expected, found) = ((du + 1) * (dv + 1), coefs.len());
        if found != expected {
            return Err(PatchError::Count { du, dv, expected, found });
        }
        Ok(Self { degree, coefs })
    }

    /// The patch with these coefficients, whose number is known to fit.
    pub(crate) fn of(degree: [usize; 2], coefs: Vec<[f64; N]>) -> Self {
        debug_assert!(degree.into_iter().all(|d| d <= MAX_DEGREE), "{degree:?}");
        debug_assert_eq!(coefs.len(), (degree[0] + 1) * (degree[1] + 1), "{degree:?}");
        Self { degree, coefs }
    }

    /// The degree in `u` and in `v`.
    pub fn degree(&self) -> [usize; 2] {
        self.degree
    }

    /// The BB coefficient `b_ij`; `None` if an index is above the degree.
    pub fn coef(&self, i: usize, j: usize) -> Option<[f64; N]> {
        let [du, dv] = self.degree;
        (i <= du && j <= dv).then(|| self.at(i, j))
    }

    /// The BB coefficient `b_ij`, which must exist.
    pub(crate) fn at(&self, i: usize, j: usize) -> [f64; N] {
        self.coefs[i * (self.degree[1] + 1) + j]
    }

    /// All BB coefficients, `v` index fastest.
    pub fn coefs(&self) -> &[[f64; N]] {
        &self.coefs
    }

    /// Position and derivatives at (`u`, `v`). Outside the unit square the polynomial is
    /// extrapolated.
    ///
    /// ```
    /// use evenlight::patch::Patch;
    ///
    /// // The bilinear patch p(u,v) = (u, v, uv).
    /// let p = Patch::new([1, 1], vec![[0., 0., 0.], [0., 1., 0.], [1., 0., 0.], [1., 1., 1.]])?;
    /// let jet = p.jet(0.5, 0.25);
    /// assert_eq!(jet.p, [0.5, 0.25, 0.125]);
    /// assert_eq!(jet.duv, [0.0, 0.0, 1.0]);
    /// # Ok::<(), evenlight::patch::PatchError>(())
    /// ```
    pub fn jet(&self, u: f64, v: f64) -> Jet<N> {
        let bu = basis::bernstein_basis(self.degree[0], u);
        let bv = basis::bernstein_basis(self.degree[1], v);
        let counts = self.degree.map(|d| d + 1);
        Jet::tensor_product(&bu, &bv, counts, |i, j| self.at(i, j))
    }
}

/// Why coefficients do not make a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PatchError {
    /// A degree is too high.
    #[error("a patch of degree ({du}, {dv}): degrees are at most {MAX_DEGREE}")]
    Degree {
        /// The degree in u.
        du: usize,
        /// The degree in v.
        dv: usize,
    },
    /// There are too many coefficients, or too few.
    #[error("a patch of degree ({du}, {dv}) has {expected} coefficients, not {found}")]
    Count {
        /// The degree in u.
        du: usize,
        /// The degree in v.
        dv: usize,
        /// The number of coefficients of such a patch.
        expected: usize,
        /// The number of coefficients that were given.
        found: usize,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    /// p(u,v) = (u, v, u^2 - v^2): a saddle, whose bi-2 coefficients are known in closed form.
    fn saddle() -> Patch {
        let square = [0.0, 0.0, 1.0]; // t^2 in BB form of degree 2
        let coef = |i: usize, j: usize| [i as f64 / 2.0, j as f64 / 2.0, square[i] - square[j]];
        Patch::of([2, 2], (0..3).flat_map(|i| (0..3).map(move |j| coef(i, j))).collect())
    }

    #[test]
    fn reproduces_the_saddle_with_its_derivatives() {
        for (u, v) in [(0.0, 0.0), (0.25, 0.5), (1.0, 0.75), (0.3, 0.7)] {
            let jet = saddle().jet(u, v);
            let expected = Jet {
                p: [u, v, u * u - v * v],
                du: [1.0, 0.0, 2.0 * u],
                dv: [0.0, 1.0, -2.0 * v],
                duu: [0.0, 0.0, 2.0],
                duv: [0.0; 3],
                dvv: [0.0, 0.0, -2.0],
            };
            for (a, b) in jet.rows().iter().zip(expected.rows()) {
                assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-14), "{jet:?} at ({u}, {v})");
            }
        }
    }
}
