//! Proof that a planar patch has a positive Jacobian.
//!
//! The Jacobian x_u y_v - x_v y_u of a patch of degree (d,d) is a polynomial of degree
//! (2d-1, 2d-1). In Bernstein-Bezier form it lies between its smallest and its largest
//! coefficient; where the smallest is not positive, the square is cut into four, whose
//! coefficients lie closer to the polynomial:
//!
//! ```text
//!   +-------+     +---+---+
//!   |  ?    | ->  | + | + |      positive on all parts: proved
//!   |       |     +---+---+
//!   |       |     | + | ? | -> ...
//!   +-------+     +---+---+
//! ```

use crate::pairs::pairs;
use crate::patch::Patch;
use crate::patch::basis::binomial;

/// How often a square may be halved before the proof is given up.
const MAX_DEPTH: usize = 8;

/// Rounding in a coefficient, as a part of the largest, with room to spare: a product of degree 8
/// has some hundred terms of either sign.
const ROUNDING: f64 = 1e-12;

/// Whether the Jacobian of (x,y) of `patch` is proved to be positive on the whole unit square. Not
/// so if it is of degree 0 in a parameter: then it has no area.
pub fn jacobian_is_positive(patch: &Patch) -> bool {
    if patch.degree().contains(&0) {
        return false;
    }
    let jacobian = Polynomial::jacobian(patch);
    let largest = jacobian.coefs.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    jacobian.is_above(ROUNDING * largest, MAX_DEPTH)
}

/// A bivariate polynomial in Bernstein-Bezier form, `v` index fastest.
#[derive(Clone, Debug)]
struct Polynomial {
    degree: [usize; 2],
    coefs: Vec<f64>,
}

impl Polynomial {
    fn jacobian(patch: &Patch) -> Self {
        let [x, y] = [0, 1].map(|k| Self {
            degree: patch.degree(),
            coefs: patch.coefs().iter().map(|p| p[k]).collect(),
        });
        let plus = x.derivative_u().times(&y.derivative_v());
        let minus = y.derivative_u().times(&x.derivative_v());
        let coefs = plus.coefs.iter().zip(&minus.coefs).map(|(a, b)| a - b).collect();
        Self { degree: plus.degree, coefs }
    }

    fn coef(&self, i: usize, j: usize) -> f64 {
        self.coefs[i * (self.degree[1] + 1) + j]
    }

    fn from_fn(degree: [usize; 2], f: impl Fn(usize, usize) -> f64) -> Self {
        let indices = pairs(degree[0] + 1, degree[1] + 1);
        Self { degree, coefs: indices.map(|(i, j)| f(i, j)).collect() }
    }

    fn derivative_u(&self) -> Self {
        let [du, dv] = self.degree;
        Self::from_fn([du - 1, dv], |i, j| du as f64 * (self.coef(i + 1, j) - self.coef(i, j)))
    }

    fn derivative_v(&self) -> Self {
        let [du, dv] = self.degree;
        Self::from_fn([du, dv - 1], |i, j| dv as f64 * (self.coef(i, j + 1) - self.coef(i, j)))
    }

    /// B_i^d B_k^e = C(d,i) C(e,k) / C(d+e,i+k) B_(i+k)^(d+e), in both variables.
    fn times(&self, other: &Self) -> Self {
        let degree = [0, 1].map(|k| self.degree[k] + other.degree[k]);
        let mut product = Self::from_fn(degree, |_, _| 0.0);
        for (a, x) in self.coefs.iter().enumerate() {
            let (i, j) = (a / (self.degree[1] + 1), a % (self.degree[1] + 1));
            for (b, y) in other.coefs.iter().enumerate() {
                let (k, l) = (b / (other.degree[1] + 1), b % (other.degree[1] + 1));
                let w = weight(self.degree[0], i, other.degree[0], k)
                    * weight(self.degree[1], j, other.degree[1], l);
                product.coefs[(i + k) * (degree[1] + 1) + j + l] += w * x * y;
            }
        }
        product
    }

    fn is_above(&self, bound: f64, depth: usize) -> bool {
        if self.coefs.iter().all(|&c| c > bound) {
            return true;
        }
        // A corner coefficient is a value of the polynomial: halving will not help.
        let [du, dv] = self.degree;
        let corners = [(0, 0), (du, 0), (0, dv), (du, dv)];
        if depth == 0 || corners.into_iter().any(|(i, j)| self.coef(i, j) <= bound) {
            return false;
        }
        self.quarters().iter().all(|part| part.is_above(bound, depth - 1))
    }

    fn quarters(&self) -> [Self; 4] {
        let [left, right] = self.halves_u();
        let turned = |p: &Self| Self::from_fn([p.degree[1], p.degree[0]], |i, j| p.coef(j, i));
        let [a, b] = turned(&left).halves_u();
        let [c, d] = turned(&right).halves_u();
        [a, b, c, d]
    }

    /// de Casteljau's algorithm at u = 1/2.
    fn halves_u(&self) -> [Self; 2] {
        let [du, dv] = self.degree;
        let [mut left, mut right] = [self.clone(), self.clone()];
        for j in 0..=dv {
            let mut column: Vec<f64> = (0..=du).map(|i| self.coef(i, j)).collect();
            for step in 0..=du {
                left.coefs[step * (dv + 1) + j] = column[0];
                right.coefs[(du - step) * (dv + 1) + j] = column[du - step];
                for i in 0..du - step {
                    column[i] = 0.5 * (column[i] + column[i + 1]);
                }
            }
        }
        [left, right]
    }
}

/// C(d,i) C(e,k) / C(d+e,i+k).
fn weight(d: usize, i: usize, e: usize, k: usize) -> f64 {
    binomial(d, i) * binomial(e, k) / binomial(d + e, i + k)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The map (u, v + f v^2 - 3/4 v): its Jacobian is 1/4 + 2 f v.
    fn stretched(f: f64) -> Patch {
        let y = [0.0, 0.125, 0.25 + f];
        let coef = |i: usize, j: usize| [i as f64 / 2.0, y[j], 0.0];
        Patch::of([2, 2], (0..3).flat_map(|i| (0..3).map(move |j| coef(i, j))).collect())
    }

    #[test]
    fn positive_jacobians_are_proved_and_folds_are_not() {
        assert!(jacobian_is_positive(&stretched(1.0)));
        assert!(jacobian_is_positive(&stretched(-0.1249)));
        assert!(!jacobian_is_positive(&stretched(-0.1251)));
    }

    #[test]
    fn a_dip_between_the_corners_is_found() {
        // y_v = 1 - c v (1 - v), whose middle coefficient is below its minimum 1 - c/4.
        let dip = |c: f64| {
            let y = [0.0, 1.0, 2.0 - c / 2.0, 3.0 - c / 2.0].map(|y| y / 3.0);
            let coef = |i: usize, j: usize| [i as f64 / 3.0, y[j], 0.0];
            Patch::of([3, 3], (0..4).flat_map(|i| (0..4).map(move |j| coef(i, j))).collect())
        };
        assert!(jacobian_is_positive(&dip(3.9)));
        assert!(!jacobian_is_positive(&dip(4.1)));
    }

    #[test]
    fn jacobian_coefficients_agree_with_evaluation() {
        let p = |i: usize, j: usize| [(i as f64 + 0.3 * j as f64).sin(), (j as f64).exp(), 0.0];
        let patch = Patch::of([4, 4], (0..25).map(|k| p(k / 5, k % 5)).collect());
        let (u, v) = (0.3, 0.8);
        let jacobian = Polynomial::jacobian(&patch);
        let bernstein = |d: usize, i: usize, t: f64| {
            binomial(d, i) * t.powi(i as i32) * (1.0 - t).powi((d - i) as i32)
        };
        let value: f64 = (0..64)
            .map(|k| jacobian.coefs[k] * bernstein(7, k / 8, u) * bernstein(7, k % 8, v))
            .sum();
        let jet = patch.jet(u, v);
        let exact = jet.du[0] * jet.dv[1] - jet.du[1] * jet.dv[0];
        assert!((value - exact).abs() < 1e-12 * exact.abs(), "{value} {exact}");
    }
}
