//! The homogeneous G2 guides: the eigenvectors of guided subdivision, mode by mode.
//!
//! A guide is n polynomial pieces, in sector s sum a_ij u^i v^j with i, j <= 5, u along line s-1
//! and v along line s, that join with continuous curvature \[KP18-Guided, eq. 1 and 2\]. Let a be
//! the piece ahead of a line, b the piece behind it with its arguments exchanged, and
//! c = cos(2 pi / n). Then on every line
//!
//! ```text
//!   a = b,    a_v + b_v = 2c a_u,    b_vv - a_vv + 4c a_uv - 4c^2 a_uu = 0.
//! ```
//!
//! The conditions depend on angles only, so they hold for every part of degree i + j = s by itself.
//! Shrinking by lambda multiplies that part by lambda^s: its solutions are the eigenspace.
//!
//! **Modes.** The conditions commute with turning by a sector and with the mirror in the diagonal
//! of sector 0. So the solutions are spanned by, for m = 0 .. n/2, omega = exp(2 pi i / n),
//!
//! ```text
//!   a_ij of sector s = Re(omega^(m s) x_ij)    even in the diagonal of sector 0
//!                    = Im(omega^(m s) x_ij)    odd,              x_ji = conjugate of x_ij,
//! ```
//!
//! With alpha = pi m / n, w_r = e^(i alpha) x_(s-r)r each of the three conditions is one real
//! equation. It exists for the s for which its terms have bi-degree 5:
//!
//! ```text
//!   Im w_0 = 0                 s <= 5
//!   Re w_1 = c s Re w_0        1 <= s <= 6
//!   Im w_2 = c (s-1) Im w_1    2 <= s <= 7
//! ```
//!
//! There are as many real unknowns as monomials, s + 1 or 11 - s; so from degree 4 on a mode has
//! 2, 3, 3, 3, 3, 2, 1 solutions, as the equations are independent there. In degree 3 it has one,
//! but two if 2c = -cos(2 alpha) and sin(2 alpha) = 0, which happens for n = 3, m = 0 and for
//! n = 6, m = 3 only: that is the n* of [KP18-Guided, table 5].

use std::f64::consts::PI;

use crate::angle::{cosine, sector_cosine, sine};
use crate::net::MAX_VALENCE;

/// The degree of a guide in u and in v.
pub(crate) const GUIDE_DEGREE: usize = 5;

/// The highest total degree s of a guide.
pub const MAX_TOTAL_DEGREE: usize = 2 * GUIDE_DEGREE;

/// Pivots below this part of a row are zero: in exact arithmetic the smallest others are above 1e-4
/// at any valence up to 64.
const SMALLEST_PIVOT: f64 = 1e-9;

/// How a function behaves under the mirror in the diagonal of sector 0, which exchanges a and b.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Parity {
    /// It stays as it is.
    Even,
    /// It changes its sign.
    Odd,
}

/// A homogeneous guide: one eigenvector of guided subdivision.
#[derive(Clone, Debug, PartialEq)]
pub struct HomogeneousGuide {
    valence: usize,
    degree: usize,
    mode: usize,
    parity: Parity,
    /// x_ij, by falling i.
    coefs: Vec<[f64; 2]>,
}

impl HomogeneousGuide {
    /// All homogeneous guides of total degree `degree`, 0 to [`MAX_TOTAL_DEGREE`], at valence n = 3
    /// or n >= 5: mode by mode, an even one before its odd partner. They are orthogonal in the
    /// sum over all sectors of a_ij b_ij; the largest modulus of an x_ij is 1. For higher degrees
    /// the list is empty. `None` if the valence is not from 3 to 1024.
    pub fn all(valence: usize, degree: usize) -> Option<Vec<Self>> {
        (3..=MAX_VALENCE).contains(&valence).then(|| Self::all_of(valence, degree))
    }

    /// [`HomogeneousGuide::all`] at a valence that is known to be allowed.
    pub(super) fn all_of(valence: usize, degree: usize) -> Vec<Self> {
        let of_mode = |mode| {
            let solutions = solutions(valence, degree, mode).into_iter();
            solutions.flat_map(move |x| Self::of_solution(valence, degree, mode, x))
        };
        (0..=valence / 2).flat_map(of_mode).collect()
    }

    /// The even and the odd guide of a solution. Modes 0 and n/2 are real; there a solution has
    /// only one guide.
    fn of_solution(valence: usize, degree: usize, mode: usize, x: Vec<[f64; 2]>) -> Vec<Self> {
        let vanishes = |part: usize| x.iter().all(|x| x[part] == 0.0);
        let is_real = mode == 0 || 2 * mode == valence;
        let parities = match (is_real, vanishes(0)) {
            (false, _) => &[Parity::Even, Parity::Odd][..],
            (true, false) => &[Parity::Even],
            (true, true) => &[Parity::Odd],
        };
        let guide = |&parity| Self { valence, degree, mode, parity, coefs: x.clone() };
        parities.iter().map(guide).collect()
    }

    /// The total degree s: the eigenvalue is lambda^s.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The number of waves around the centre, 0 to n/2.
    pub fn mode(&self) -> usize {
        self.mode
    }

    /// How it behaves under the mirror in the diagonal of sector 0.
    pub fn parity(&self) -> Parity {
        self.parity
    }

    /// The coefficient a_ij of u^i v^j in sector `sector` (modulo n); zero unless i + j = s and
    /// i, j <= 5.
    pub fn coefficient(&self, sector: usize, i: usize, j: usize) -> f64 {
        let found = exponents(self.degree).position(|exponent| exponent == (i, j));
        found.map_or(0.0, |at| {
            let [cos, sin] = turn(self.valence, self.mode * (sector % self.valence));
            let [x, y] = self.coefs[at];
            match self.parity {
                Parity::Even => cos * x - sin * y,
                Parity::Odd => sin * x + cos * y,
            }
        })
    }
}

/// The number of homogeneous guides of total degree `degree`: the multiplicity of the eigenvalue
/// lambda^degree, found by solving the conditions. `None` if the valence is not from 3 to 1024.
pub fn multiplicity(valence: usize, degree: usize) -> Option<usize> {
    HomogeneousGuide::all(valence, degree).map(|guides| guides.len())
}

/// (i,j) with i + j = `degree` and i, j <= 5, by falling i.
fn exponents(degree: usize) -> impl Iterator<Item = (usize, usize)> {
    let least = degree.saturating_sub(GUIDE_DEGREE);
    (least..=degree.min(GUIDE_DEGREE)).rev().map(move |i| (i, degree - i))
}

/// omega^k.
fn turn(valence: usize, k: usize) -> [f64; 2] {
    half_turn(valence, 2 * k)
}

/// exp(pi i k / n), exact where it is real or imaginary.
fn half_turn(valence: usize, k: usize) -> [f64; 2] {
    let k = k % (2 * valence);
    if 2 * k == valence {
        return [0.0, 1.0];
    }
    match (k, k > valence) {
        (0, _) => [1.0, 0.0],
        (k, _) if k == valence => [-1.0, 0.0],
        (k, false) => {
            let angle = PI * k as f64 / valence as f64;
            [cosine(angle), sine(angle)]
        }
        (k, true) => {
            let [cos, sin] = half_turn(valence, k - valence);
            [-cos, -sin]
        }
    }
}

/// A basis of the x_ij, by falling i, of one mode.
fn solutions(valence: usize, degree: usize, mode: usize) -> Vec<Vec<[f64; 2]>> {
    let unknowns = Unknowns::new(degree);
    let kernel = kernel(equations(valence, degree, mode, &unknowns), unknowns.count);
    let mut done: Vec<Vec<[f64; 2]>> = Vec::new();
    for unknown in kernel {
        let mut x = unknowns.complex(&unknown);
        for other in &done {
            let share = product(&x, other) / product(other, other);
            x.iter_mut()
                .zip(other)
                .for_each(|(x, y)| *x = [x[0] - share * y[0], x[1] - share * y[1]]);
        }
        done.push(x);
    }
    done.iter_mut().for_each(|x| normalise(x));
    done
}

/// Re sum x conj(y).
fn product(x: &[[f64; 2]], y: &[[f64; 2]]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x[0] * y[0] + x[1] * y[1]).sum()
}

/// Largest modulus 1, and the first number that is not zero positive.
fn normalise(x: &mut [[f64; 2]]) {
    let largest = x.iter().map(|x| (x[0] * x[0] + x[1] * x[1]).sqrt()).fold(0.0, f64::max);
    let first = x.iter().flatten().find(|x| x.abs() > SMALLEST_PIVOT * largest);
    let sign = first.map_or(1.0, |x| x.signum());
    for x in x.iter_mut().flatten() {
        // Not -0, and no rounding in place of zero.
        *x = if x.abs() < 1e-15 * largest { 0.0 } else { sign * *x / largest };
    }
}

/// The real unknowns: for i > j the real and the imaginary part of x_ij, for i = j the real x_ii.
struct Unknowns {
    exponents: Vec<(usize, usize)>,
    count: usize,
}

impl Unknowns {
    fn new(degree: usize) -> Self {
        let exponents: Vec<_> = exponents(degree).collect();
        // One for each monomial: x_ij and x_ji share two.
        Self { count: exponents.len(), exponents }
    }

    /// The numbers of the real and the imaginary part of x_ij and the sign of the latter; `None` if
    /// there is no such coefficient.
    fn of(&self, (i, j): (usize, usize)) -> Option<(usize, Option<(usize, f64)>)> {
        let at = self.exponents.iter().position(|&e| e == (i.max(j), i.min(j)))?;
        let imaginary = (i != j).then_some((2 * at + 1, if i > j { 1.0 } else { -1.0 }));
        Some((2 * at, imaginary))
    }

    fn complex(&self, unknown: &[f64]) -> Vec<[f64; 2]> {
        let value = |&exponent: &(usize, usize)| {
            let (re, im) = self.of(exponent)?;
            Some([unknown[re], im.map_or(0.0, |(at, sign)| sign * unknown[at])])
        };
        self.exponents.iter().filter_map(value).collect()
    }
}

/// The equations of the module's head that exist.
fn equations(valence: usize, s: usize, mode: usize, unknowns: &Unknowns) -> Vec<Vec<f64>> {
    let c = sector_cosine(valence);
    let [cos, sin] = half_turn(valence, mode);
    // weight times Re w_r or Im w_r, added to a row.
    let add = |row: &mut Vec<f64>, r: usize, imaginary: bool, weight: f64| {
        let Some((re, im)) = unknowns.of((s - r, r)) else { return };
        let [of_re, of_im] = if imaginary { [sin, cos] } else { [cos, -sin] };
        row[re] += weight * of_re;
        if let Some((im, sign)) = im {
            row[im] += weight * sign * of_im;
        }
    };
    let mut rows = Vec::new();
    let mut push = |terms: &[(usize, bool, f64)]| {
        let mut row = vec![0.0; unknowns.count];
        terms.iter().for_each(|&(r, imaginary, weight)| add(&mut row, r, imaginary, weight));
        rows.push(row);
    };
    if s <= GUIDE_DEGREE {
        push(&[(0, true, 1.0)]);
    }
    if (1..=GUIDE_DEGREE + 1).contains(&s) {
        push(&[(1, false, 1.0), (0, false, -c * s as f64)]);
    }
    if (2..=GUIDE_DEGREE + 2).contains(&s) {
        push(&[(2, true, 1.0), (1, true, -c * (s - 1) as f64)]);
    }
    rows
}

/// A basis of the solutions of equations = 0, by Gauss-Jordan elimination with the largest pivot.
fn kernel(mut rows: Vec<Vec<f64>>, count: usize) -> Vec<Vec<f64>> {
    let mut pivots: Vec<(usize, usize)> = Vec::new();
    loop {
        let used = |row: usize| pivots.iter().any(|&(r, _)| r == row);
        let entries = (0..rows.len()).filter(|&r| !used(r));
        let entries = entries.flat_map(|r| (0..count).map(move |k| (r, k)));
        let largest = entries.fold(None, |best: Option<(usize, usize)>, (r, k)| match best {
            Some((p, q)) if rows[p][q].abs() >= rows[r][k].abs() => best,
            _ => Some((r, k)),
        });
        let Some((r, k)) = largest.filter(|&(r, k)| rows[r][k].abs() > SMALLEST_PIVOT) else {
            break;
        };
        let pivot = rows[r].clone();
        for (other, row) in rows.iter_mut().enumerate() {
            let factor = if other == r { 1.0 - 1.0 / pivot[k] } else { row[k] / pivot[k] };
            row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= factor * p);
            row[k] = if other == r { 1.0 } else { 0.0 };
        }
        pivots.push((r, k));
    }
    let is_free = |k: &usize| pivots.iter().all(|&(_, pivot)| pivot != *k);
    let solution = |free: usize| {
        let mut x = vec![0.0; count];
        x[free] = 1.0;
        pivots.iter().for_each(|&(r, k)| x[k] = -rows[r][free]);
        x
    };
    (0..count).filter(is_free).map(solution).collect()
}
