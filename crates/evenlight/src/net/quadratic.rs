//! The quadratic q at an extraordinary point: what a Quadratic-Attraction surface looks like
//! there, and a handle for design.
//!
//! In the coordinates of sector s, u along line s-1 and v along line s, both with unit length,
//!
//! ```text
//! q(u,v) = p + alpha u + beta v + gamma u^2 + delta u v + epsilon v^2.
//! ```
//!
//! Its six coefficients q_1..q_6 are the Bernstein-Bezier points of total degree 5 nearest to the
//! centre [KP23-QAS, Fig. 9b]:
//!
//! ```text
//!        line s
//!     q_6
//!     q_4  q_5           q_1 = p                    q_3 = p + 2/5 alpha + gamma/10
//!     q_1  q_2  q_3      q_2 = p + alpha/5          q_5 = p + (alpha + beta)/5 + delta/20
//!          line s-1      q_4 = p + beta/5           q_6 = p + 2/5 beta + epsilon/10
//! ```

use super::MAX_VALENCE;
use crate::angle::sector_cosine;
use crate::point::{Point, Vector, add, add_scaled, scale, sub};

/// A quadratic expansion at an extraordinary point, by its coefficients in sector 0.
///
/// Any six points are a quadratic; the coefficients in the other sectors follow from them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadratic<const N: usize = 3> {
    /// q_1 to q_6 of sector 0.
    pub coefs: [[f64; N]; 6],
}

/// alpha, beta, gamma, delta, epsilon of a quadratic.
pub(crate) type Expansion<const N: usize = 3> = [[f64; N]; 5];

impl<const N: usize> Quadratic<N> {
    /// The quadratic with centre `p` and the expansion alpha, beta, gamma, delta, epsilon.
    pub(crate) fn from_expansion(p: [f64; N], [a, b, uu, uv, vv]: Expansion<N>) -> Self {
        let at = |terms: &[(f64, [f64; N])]| {
            let mut sum = p;
            terms.iter().for_each(|&(w, x)| add_scaled(&mut sum, w, x));
            sum
        };
        Self {
            coefs: [
                p,
                at(&[(0.2, a)]),
                at(&[(0.4, a), (0.1, uu)]),
                at(&[(0.2, b)]),
                at(&[(0.2, a), (0.2, b), (0.05, uv)]),
                at(&[(0.4, b), (0.1, vv)]),
            ],
        }
    }

    /// alpha, beta, gamma, delta, epsilon in sector 0.
    pub(crate) fn expansion(&self) -> Expansion<N> {
        let [p, ..] = self.coefs;
        let [q2, q3, q4, q5, q6] = [1, 2, 3, 4, 5].map(|k| sub(self.coefs[k], p));
        [
            scale(5.0, q2),
            scale(5.0, q4),
            scale(10.0, sub(q3, scale(2.0, q2))),
            scale(20.0, sub(q5, add(q2, q4))),
            scale(10.0, sub(q6, scale(2.0, q4))),
        ]
    }

    /// The position of the centre, p = q_1.
    pub fn center(&self) -> [f64; N] {
        self.coefs[0]
    }

    /// q(u,v) in the coordinates of sector 0.
    ///
    /// ```
    /// use evenlight::net::Quadratic;
    ///
    /// // All coefficients in one point: q is constant.
    /// let q = Quadratic { coefs: [[1.0, 2.0, 3.0]; 6] };
    /// assert_eq!(q.at(0.3, 0.4), [1.0, 2.0, 3.0]);
    /// ```
    pub fn at(&self, u: f64, v: f64) -> [f64; N] {
        let mut sum = self.center();
        for (w, x) in [u, v, u * u, u * v, v * v].into_iter().zip(self.expansion()) {
            add_scaled(&mut sum, w, x);
        }
        sum
    }

    /// The same quadratic by its coefficients in the coordinates of sector `s`, modulo n, around a
    /// point of valence `n` [KP23-QAS, eq. 1]; `None` if n is not from 3 to 1024.
    pub fn in_sector(&self, n: usize, s: usize) -> Option<Self> {
        if !(3..=MAX_VALENCE).contains(&n) {
            return None;
        }
        let c = sector_cosine(n);
        let expansion = (0..s % n).fold(self.expansion(), |e, _| turned(c, e));
        Some(Self::from_expansion(self.center(), expansion))
    }

    /// The common quadratic nearest to one proposal per sector, each by its coefficients in that
    /// sector: every proposal is carried to sector 0, and the mean is taken [KP23-QAS, eq. 4, 5].
    ///
    /// Proposals that agree are reproduced. The centre is the mean of the centres. `None` if there
    /// are fewer than three sectors, or more than 1024.
    pub fn from_proposals(proposals: &[[[f64; N]; 6]]) -> Option<Self> {
        let n = proposals.len();
        if !(3..=MAX_VALENCE).contains(&n) {
            return None;
        }
        let c = sector_cosine(n);
        let (mut p, mut mean) = ([0.0; N], [[0.0; N]; 5]);
        for (s, &coefs) in proposals.iter().enumerate() {
            let proposal = Self { coefs };
            let carried = (s..n).fold(proposal.expansion(), |e, _| turned(c, e));
            let own = if s == 0 { proposal.expansion() } else { carried };
            add_scaled(&mut p, 1.0 / n as f64, proposal.center());
            for (sum, x) in mean.iter_mut().zip(own) {
                add_scaled(sum, 1.0 / n as f64, x);
            }
        }
        Some(Self::from_expansion(p, mean))
    }
}

impl Quadratic {
    /// The image under an affine map, linear part `matrix` (rows) and `translation`.
    pub fn transformed(&self, matrix: [Vector; 3], translation: Vector) -> Self {
        let map = |p: Point| add(matrix.map(|row| crate::point::dot(row, p)), translation);
        Self { coefs: self.coefs.map(map) }
    }
}

/// The expansion in the coordinates of the next sector, `c` the cosine of the angle between two
/// lines: the new line is 2 c times line s minus line s-1.
pub(crate) fn turned<const N: usize>(c: f64, [a, b, uu, uv, vv]: Expansion<N>) -> Expansion<N> {
    let sum = |terms: [(f64, [f64; N]); 3]| {
        let mut sum = [0.0; N];
        terms.into_iter().for_each(|(w, x)| add_scaled(&mut sum, w, x));
        sum
    };
    [
        b,
        sum([(2.0 * c, b), (-1.0, a), (0.0, a)]),
        vv,
        sum([(4.0 * c, vv), (-1.0, uv), (0.0, uv)]),
        sum([(4.0 * c * c, vv), (-2.0 * c, uv), (1.0, uu)]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::point::norm;

    fn in_sector(q: &Quadratic, n: usize, s: usize) -> Quadratic {
        q.in_sector(n, s).expect("there is such a valence")
    }

    fn common(proposals: &[[Point; 6]]) -> Quadratic {
        Quadratic::from_proposals(proposals).expect("there are sectors enough")
    }

    fn some() -> Quadratic {
        let coef = |k: usize| [0, 1, 2].map(|d| ((7 * k + 3 * d) as f64 * 0.731).sin());
        Quadratic { coefs: std::array::from_fn(coef) }
    }

    #[test]
    fn all_sectors_see_one_quadratic() {
        for n in [3, 5, 6, 8, 16] {
            let q = some();
            let angle = std::f64::consts::TAU / n as f64;
            // A point of the plane in the coordinates of sector s: r sin(..)/sin(angle) each.
            let seen = |s: usize| {
                let (r, direction) = (0.7, 0.9);
                let from_line = direction - angle * (s as f64 - 1.0);
                let v = r * from_line.sin() / angle.sin();
                let u = r * from_line.cos() - v * angle.cos();
                in_sector(&q, n, s).at(u, v)
            };
            for s in 1..=n {
                // Sectors of 22 degrees have coordinates some ten times as large as points.
                assert!(norm(sub(seen(s), seen(0))) < 1e-12, "n = {n}, s = {s}");
            }
        }
    }

    #[test]
    fn equal_proposals_are_reproduced_and_others_projected() {
        for n in [3, 5, 8, 16] {
            let mut proposals: Vec<[Point; 6]> =
                (0..n).map(|s| in_sector(&some(), n, s).coefs).collect();
            let q = common(&proposals);
            for (a, b) in q.coefs.iter().zip(some().coefs) {
                assert!(norm(sub(*a, b)) < 1e-13);
            }
            proposals[1][4][2] += 0.5;
            let moved = common(&proposals);
            let again: Vec<[Point; 6]> = (0..n).map(|s| in_sector(&moved, n, s).coefs).collect();
            let projected = common(&again);
            for (a, b) in moved.coefs.iter().zip(projected.coefs) {
                assert!(norm(sub(*a, b)) < 1e-13, "the projection is idempotent");
            }
        }
    }

    #[test]
    fn affine_maps_commute_with_the_quadratic() {
        let (matrix, translation) = ([[1., 2., 0.], [0., 1., 3.], [1., 0., -1.]], [4., 5., 6.]);
        let map = |p: Point| add(matrix.map(|row| crate::point::dot(row, p)), translation);
        let image = some().transformed(matrix, translation);
        assert!(norm(sub(image.at(0.3, -0.4), map(some().at(0.3, -0.4)))) < 1e-13);
    }
}
