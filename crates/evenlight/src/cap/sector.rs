//! One sector of a cap and its conditions, for every Fourier mode in real numbers.
//!
//! A cap is a tensor-product spline z_ij in each sector, the first index along u, line s-1, the
//! second along v, line s:
//!
//! ```text
//!   b b b b b b        b  two layers: position and first derivative of the last ring
//!   b b b b b b        q  the 2-jet at the centre: that of one quadratic
//!   . . . . b b        .  free, but for the lines, where for the sectors a ahead and b behind
//!   q . . . b b           (its arguments exchanged) position and tangent plane are common:
//!   q q . . b b
//!   q q q . b b           a = b,   a_v + b_v = 2c (1-u)^2 a_u   on v = 0     [KP18-Guided, eq. 6]
//! ```
//!
//! **Modes.** All is linear and commutes with turning, so it falls apart into the parts
//! z^s = Re(w^(f s) Y), w = exp(2 pi i/n), f = 0..n/2. It also commutes with the mirror that
//! exchanges u and v and sectors s and -s. If Y is its own image, Y = S + i A with S symmetric and
//! A antisymmetric in (i,j), and one real array z = S + A says it all; and every Y is a sum Y' + i
//! Y'' of two such. The sector behind a line has b = w^-f conj Y there, so with phi = pi f / n
//!
//! ```text
//!   Im(e^(i phi) Y) = 0,   Re(e^(i phi) Y_v) = c (1-u)^2 Re(e^(i phi) Y_u)   on v = 0.
//! ```

use super::spline::{Space, raising};
use crate::angle::{cosine, sector_cosine, sine};
use crate::dense::Matrix;
use crate::pairs::pairs;
use crate::quadrature::GAUSS_7;

/// A complex number.
pub(super) type Complex = [f64; 2];

/// The sector of a cap at one valence.
#[derive(Clone, Debug)]
pub(super) struct Sector {
    /// The valence n.
    pub(super) valence: usize,
    /// The splines in either parameter.
    pub(super) space: Space,
    /// [`Space::to_bb`] of these splines.
    pub(super) to_bb: Matrix,
}

/// The layers of data along the border of a hole: position, first and second derivatives across.
pub(super) const LAYERS: usize = 3;

impl Sector {
    pub(super) fn new(valence: usize, space: Space) -> Self {
        Self { valence, space, to_bb: space.to_bb() }
    }

    /// The number of coefficients z_ij.
    pub(super) fn num_coefs(&self) -> usize {
        self.space.dim() * self.space.dim()
    }

    /// The number of z_ij.
    pub(super) fn at(&self, i: usize, j: usize) -> usize {
        self.space.dim() * i + j
    }

    /// The number of z_ji from the number of z_ij.
    pub(super) fn mirrored(&self, at: usize) -> usize {
        self.at(at % self.space.dim(), at / self.space.dim())
    }

    /// The number of data along the border: on edge u = 1, then on v = 1, layer by layer the
    /// coefficients along the edge.
    pub(super) fn num_border(&self) -> usize {
        2 * LAYERS * self.space.dim()
    }

    /// The number of a datum.
    pub(super) fn border(&self, edge: usize, layer: usize, k: usize) -> usize {
        (edge * LAYERS + layer) * self.space.dim() + k
    }

    /// The border datum that changes places with another when u and v do.
    pub(super) fn mirrored_border(&self, at: usize) -> usize {
        (at + self.num_border() / 2) % self.num_border()
    }

    /// z_ij as weights of border data, if it is in the two outer layers.
    pub(super) fn on_border(&self, i: usize, j: usize) -> Option<Vec<(usize, f64)>> {
        let last = self.space.dim() - 1;
        let step = self.space.step() / self.space.degree as f64;
        let from = |edge: usize, across: usize, along: usize| {
            let layer = last - across;
            let position = (self.border(edge, 0, along), 1.0);
            match layer {
                0 => Some(vec![position]),
                1 => Some(vec![position, (self.border(edge, 1, along), -step)]),
                _ => None,
            }
        };
        match (from(0, i, j), from(1, j, i)) {
            // Both edges give a corner the same data; the mean keeps the mirror symmetry exactly.
            (Some(a), Some(b)) => {
                Some(a.into_iter().chain(b).map(|(at, w)| (at, 0.5 * w)).collect())
            }
            (a, b) => a.or(b),
        }
    }

    /// The six z_ij with i + j <= 2, which are the 2-jet at the centre.
    pub(super) fn center(&self) -> [usize; 6] {
        [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)].map(|(i, j)| self.at(i, j))
    }

    /// The conditions of common position on line s-1, as rows on z.
    pub(super) fn continuity(&self, mode: usize) -> Vec<Vec<f64>> {
        let [_, imaginary] = self.parts(mode);
        let row = |i: usize| {
            let mut row = vec![0.0; self.num_coefs()];
            row[self.at(i, 0)] += imaginary[0];
            row[self.at(0, i)] += imaginary[1];
            row
        };
        (0..self.space.dim()).map(row).collect()
    }

    /// The conditions of a common tangent plane on line s-1: the BB coefficients of degree D + 1 of
    /// Re(e^(i phi) Y_v) - c (1-u)^2 Re(e^(i phi) Y_u) over D m, piece by piece.
    pub(super) fn tangency(&self, mode: usize) -> Vec<Vec<f64>> {
        let Space { degree, pieces, .. } = self.space;
        let [real, _] = self.parts(mode);
        let raise = raising(degree, degree + 1);
        let c = sector_cosine(self.valence);
        let mut rows = vec![vec![0.0; self.num_coefs()]; pieces * (degree + 2)];
        for piece in 0..pieces {
            let bb = self.to_bb.select_rows(piece * (degree + 1)..(piece + 1) * (degree + 1));
            let across = raise.times(&bb);
            let along = times_square(piece, self.space).times(&bb);
            for (e, k) in pairs(degree + 2, self.space.dim()) {
                let row = &mut rows[piece * (degree + 2) + e];
                let mut put = |i: usize, j: usize, w: f64| {
                    row[self.at(i, j)] += w * real[0];
                    row[self.at(j, i)] += w * real[1];
                };
                put(k, 1, across[(e, k)]);
                put(k, 0, -across[(e, k)] - c * along[(e, k)]);
            }
        }
        rows
    }

    /// The weights of z_ij and z_ji in the real and in the imaginary part of e^(i phi) Y_ij.
    fn parts(&self, mode: usize) -> [[f64; 2]; 2] {
        let phi = std::f64::consts::PI * mode as f64 / self.valence as f64;
        let (cos, sin) = (cosine(phi), sine(phi));
        [[0.5 * (cos - sin), 0.5 * (cos + sin)], [0.5 * (sin + cos), 0.5 * (sin - cos)]]
    }

    /// The complex array Y of a real one.
    pub(super) fn complex(&self, z: &[f64]) -> Vec<Complex> {
        let entry = |at: usize| {
            let (own, other) = (z[at], z[self.mirrored(at)]);
            [0.5 * (own + other), 0.5 * (own - other)]
        };
        (0..z.len()).map(entry).collect()
    }

    /// The nodes of quadrature on the square: the pieces, the parameters in them, the weights.
    pub(super) fn nodes(&self) -> Vec<([(usize, f64); 2], f64)> {
        let step = self.space.step();
        let on_line: Vec<((usize, f64), f64)> = (0..self.space.pieces)
            .flat_map(|piece| GAUSS_7.map(|(t, w)| ((piece, t), w * step)))
            .collect();
        let pairs =
            on_line.iter().flat_map(|&(u, a)| on_line.iter().map(move |&(v, b)| ([u, v], a * b)));
        pairs.collect()
    }

    /// The rows on z of the Taylor coefficients u^p v^q at a node, p and q below `orders`: number
    /// `orders` p + q.
    pub(super) fn taylor(&self, [u, v]: [(usize, f64); 2], orders: usize) -> Vec<Vec<f64>> {
        let along = |(piece, t): (usize, f64)| self.space.taylor(&self.to_bb, piece, t, orders);
        let (u, v) = (along(u), along(v));
        u.iter().flat_map(|p| v.iter().map(move |q| product(p, q))).collect()
    }
}

/// The array p_i q_j.
pub(super) fn product(p: &[f64], q: &[f64]) -> Vec<f64> {
    p.iter().flat_map(|p| q.iter().map(move |q| p * q)).collect()
}

/// The BB coefficients, of degree D + 1, of (1-u)^2 times the derivative over D m of a piece, on
/// its BB coefficients.
fn times_square(piece: usize, space: Space) -> Matrix {
    use crate::patch::basis::binomial;
    let d = space.degree;
    let [w0, w1] = [piece, piece + 1].map(|k| 1.0 - k as f64 * space.step());
    let square = [w0 * w0, w0 * w1, w1 * w1];
    let mut result = Matrix::zeros(d + 2, d + 1);
    for (q, (k, w)) in (0..d).flat_map(|q| square.into_iter().enumerate().map(move |w| (q, w))) {
        let weight = w * binomial(2, k) * binomial(d - 1, q) / binomial(d + 1, q + k);
        result[(q + k, q + 1)] += weight;
        result[(q + k, q)] -= weight;
    }
    result
}
