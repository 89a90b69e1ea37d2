//! Functions on a guided surface around one extraordinary point.
//!
//! Guides determine a guided scheme: n polynomial pieces g that join with curvature
//! continuity. This module has the functions that follow from them, for interpolation, analysis
//! and pictures:
//!
//! - [`HomogeneousGuide`]: guides of one degree s, the eigenvectors, with their number
//!   ([`multiplicity`]), found by solving the conditions of curvature continuity;
//! - [`Eigenfunctions`]: the functions that follow them, f(a/2, b/2) = lambda^s f(a,b);
//! - [`RefinableSpace`]: nested spaces V_m of C2 functions, splines on m rings and a guide inside,
//!   element by element with Bezier extraction ([`Element`]), and the sparse matrices from each to
//!   the next.

mod eigen;
mod guide;
mod slots;
mod space;

pub use crate::sparse::Stencils;
pub use eigen::Eigenfunctions;
pub use guide::{HomogeneousGuide, MAX_TOTAL_DEGREE, Parity, multiplicity};
pub use space::{Element, FunctionKind, RefinableSpace, Support};

use crate::patch::Jet;
use crate::patch::basis::bernstein_basis;

/// The jet at (u,v) of the polynomial of bi-`degree` with these BB coefficients, index along v
/// fastest. There must be (degree + 1)^2 of them.
fn jet_of_patch(degree: usize, coefs: &[f64], [u, v]: [f64; 2]) -> Jet<1> {
    let order = degree + 1;
    let (bu, bv) = (bernstein_basis(degree, u), bernstein_basis(degree, v));
    Jet::tensor_product(&bu, &bv, [order; 2], |i, j| [coefs[i * order + j]])
}

/// The answer at the centre, where there are no derivatives.
fn value_alone(value: f64) -> Jet<1> {
    let nan = [f64::NAN];
    Jet { p: [value], du: nan, dv: nan, duu: nan, duv: nan, dvv: nan }
}

/// The examples of the chapter are tested.
#[cfg(doctest)]
#[doc = include_str!("../../docs/10-basis.md")]
struct Chapter;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_of_quadratics_has_its_derivatives() {
        // (1 + u)^2 v^2: BB coefficients 1, 2, 4 and 0, 0, 1.
        let coefs: Vec<f64> =
            [1.0, 2.0, 4.0].iter().flat_map(|a| [0.0, 0.0, 1.0].map(|b| a * b)).collect();
        let jet = jet_of_patch(2, &coefs, [0.5, 0.25]);
        let exact = [2.25 / 16.0, 2.0 / 16.0 * 1.5, 2.25 / 2.0, 2.0 / 16.0, 1.5, 4.5];
        assert!(jet.rows().iter().zip(exact).all(|([a], b)| (a - b).abs() < 1e-15), "{jet:?}");
        assert_eq!(jet.scaled(2.0, [0.5, 1.0]).duv, jet.duv);
    }
}
