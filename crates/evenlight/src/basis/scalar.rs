//! A function on a patch: its value and derivatives at a point.

use crate::patch::basis::bernstein;

/// The value of a function and its derivatives up to order two, in two parameters u and v.
///
/// [`Element`] derives by the parameters of the patch; everything that takes the place (a,b) in a
/// sector derives by a and b.
///
/// [`Element`]: super::Element
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScalarJet {
    /// The value.
    pub value: f64,
    /// The derivative in u.
    pub du: f64,
    /// The derivative in v.
    pub dv: f64,
    /// The second derivative in u.
    pub duu: f64,
    /// The mixed second derivative.
    pub duv: f64,
    /// The second derivative in v.
    pub dvv: f64,
}

impl ScalarJet {
    /// The jet at (`u`,`v`) of the polynomial of bi-`degree` with these BB coefficients, that of
    /// index (i,j) at place i (degree + 1) + j.
    ///
    /// # Panics
    ///
    /// If there are not (degree + 1)^2 coefficients or the degree is above
    /// [`MAX_DEGREE`](crate::patch::MAX_DEGREE).
    pub fn of_patch(degree: usize, coefs: &[f64], u: f64, v: f64) -> Self {
        let order = degree + 1;
        assert_eq!(coefs.len(), order * order, "a patch of degree bi-{degree}");
        let (bu, bv) = (bernstein(degree, u), bernstein(degree, v));
        let sum = |du: usize, dv: usize| -> f64 {
            let row = |i: usize| coefs[i * order..(i + 1) * order].iter().zip(&bv[dv]);
            (0..order).map(|i| bu[du][i] * row(i).map(|(c, b)| c * b).sum::<f64>()).sum()
        };
        Self {
            value: sum(0, 0),
            du: sum(1, 0),
            dv: sum(0, 1),
            duu: sum(2, 0),
            duv: sum(1, 1),
            dvv: sum(0, 2),
        }
    }

    /// The jet of `factor` f(x u, y v).
    pub fn scaled(&self, factor: f64, [x, y]: [f64; 2]) -> Self {
        Self {
            value: factor * self.value,
            du: factor * x * self.du,
            dv: factor * y * self.dv,
            duu: factor * x * x * self.duu,
            duv: factor * x * y * self.duv,
            dvv: factor * y * y * self.dvv,
        }
    }

    /// Value and derivatives in the order value, du, dv, duu, duv, dvv.
    pub fn rows(&self) -> [f64; 6] {
        [self.value, self.du, self.dv, self.duu, self.duv, self.dvv]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_of_quadratics_has_its_derivatives() {
        // (1 + u)^2 v^2: BB coefficients 1, 2, 4 and 0, 0, 1.
        let coefs: Vec<f64> =
            [1.0, 2.0, 4.0].iter().flat_map(|a| [0.0, 0.0, 1.0].map(|b| a * b)).collect();
        let jet = ScalarJet::of_patch(2, &coefs, 0.5, 0.25);
        let exact = [2.25 / 16.0, 3.0 / 16.0, 2.25 / 2.0, 2.0 / 16.0, 1.5, 4.5];
        assert!(jet.rows().iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-15), "{jet:?}");
        assert_eq!(jet.scaled(2.0, [0.5, 1.0]).duv, jet.duv);
    }
}
