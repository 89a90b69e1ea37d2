//! The explicit formulas of the guide: which coefficients are free, and the others from them.
//!
//! This is the paper's own description of the space [KP18-Guided, eq. 3, 4, App. A]. It tests the
//! kernels of [`super::space`], which describe the same space. It is one-sided, as the quadratic is
//! given in sector 0, and its condition is worse.
//!
//! Per line, with a the sector ahead and b the one behind, arguments exchanged so that the first
//! index runs along the line, and p_i0 = a_i0 = b_i0:
//!
//! ```text
//! free       p_40 p_50, a_22 b_22, a_42 b_42, a_52 b_52, a_32        and the inner g_ij, i,j >= 3
//! from q     p_00 p_10 p_20, a_01 b_01, a_11 b_11, a_02 b_02         q, the quadratic: 6 free
//! coupled    a_12 b_12, a_21 b_21                                    n + (1 if n = 3 or 6) free
//! dependent  p_30, a_31 b_31, a_41 b_41, a_51 b_51, b_32
//! ```
//!
//! DIFFERENCE: two misprints of the formulas that reached us are corrected, the sides in
//! b_52 - a_52 of a_41 and in a_52 - b_52 of a_51 and b_32; p_42 and p_52 are free on both sides.

use crate::guided::space::{COEFS, DEGREE, index};
use crate::linear::Matrix;
use crate::real::Real;

/// The free coefficients of a guide of valence n, here g_ij^s with (i, j) in sector s.
#[derive(Clone, Debug)]
pub struct FreeCoefs {
    /// In sector 0: g_00, g_10, g_01, g_20, g_11, g_02.
    pub quadratic: [Real; 6],
    /// For every sector the coefficients at [`FREE_PLACES`].
    pub sectors: Vec<[Real; FREE_PLACES.len()]>,
    /// g_12 of sector 0: used for n = 3 and 6 only, otherwise determined.
    pub extra: Real,
}

/// The places (i, j) of the free coefficients of every sector.
#[rustfmt::skip]
pub const FREE_PLACES: [(usize, usize); 18] = [
    (2, 1), (2, 2), (4, 0), (5, 0), (3, 2), (4, 2), (2, 4), (5, 2), (2, 5),
    (3, 3), (3, 4), (3, 5), (4, 3), (4, 4), (4, 5), (5, 3), (5, 4), (5, 5),
];

/// The places of the quadratic in sector 0.
const QUADRATIC_PLACES: [(usize, usize); 6] = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)];

/// The guide with the given free coefficients, one column numbered by [`index`].
///
/// # Panics
///
/// If there are fewer than three sectors, or four (for c = 0 the formulas divide by zero).
pub fn guide(free: &FreeCoefs) -> Matrix {
    let valence = free.sectors.len();
    assert!(valence >= 3 && valence != 4, "the formulas are for extraordinary points");
    let mut guide = Assembly { coefs: Matrix::zeros(COEFS * valence, 1), valence };
    guide.set_free(free);
    for line in 1..valence as isize {
        guide.turn_quadratic(line);
    }
    guide.solve_coupled(free.extra);
    for line in 0..valence as isize {
        guide.set_dependent(line);
    }
    guide.coefs
}

struct Assembly {
    coefs: Matrix,
    valence: usize,
}

/// One line and its two sides: the coefficients along it.
struct Sides<'a> {
    guide: &'a Assembly,
    line: isize,
    swapped: bool,
}

impl Sides<'_> {
    fn ahead(&self, i: usize, j: usize) -> Real {
        self.guide.at(self.line, i, j)
    }

    fn behind(&self, i: usize, j: usize) -> Real {
        self.guide.at(self.line - 1, j, i)
    }

    /// a_ij; b_ij if the sides are swapped.
    fn a(&self, i: usize, j: usize) -> Real {
        if self.swapped { self.behind(i, j) } else { self.ahead(i, j) }
    }

    /// b_ij; a_ij if the sides are swapped.
    fn b(&self, i: usize, j: usize) -> Real {
        if self.swapped { self.ahead(i, j) } else { self.behind(i, j) }
    }

    /// a_ij - b_ij.
    fn gap(&self, i: usize, j: usize) -> Real {
        self.a(i, j) - self.b(i, j)
    }
}

impl Assembly {
    fn at(&self, sector: isize, i: usize, j: usize) -> Real {
        self.coefs[(index(self.valence, sector, i, j), 0)]
    }

    fn set(&mut self, sector: isize, (i, j): (usize, usize), value: Real) {
        self.coefs[(index(self.valence, sector, i, j), 0)] = value;
    }

    fn cos(&self) -> Real {
        Real::cos_of_turn(self.valence)
    }

    fn sides(&self, line: isize, swapped: bool) -> Sides<'_> {
        Sides { guide: self, line, swapped }
    }

    /// The free coefficients; those on a line belong to both sides.
    fn set_free(&mut self, free: &FreeCoefs) {
        for (place, value) in QUADRATIC_PLACES.into_iter().zip(free.quadratic) {
            self.set(0, place, value);
        }
        for (sector, values) in free.sectors.iter().enumerate() {
            for (place, &value) in FREE_PLACES.into_iter().zip(values) {
                self.set(sector as isize, place, value);
                if place.1 == 0 {
                    self.set(sector as isize - 1, (0, place.0), value);
                }
            }
        }
    }

    /// Equation 3: the quadratic of the sector ahead of `line` from the one behind.
    fn turn_quadratic(&mut self, line: isize) {
        let c = self.cos();
        let k = |x: i32| Real::from(x);
        let old = |i: usize, j: usize| self.at(line - 1, j, i);
        let (p0, p1, p2) = (old(0, 0), old(1, 0), old(2, 0));
        let a01 = -old(0, 1) + k(2) * c * p1 + k(2) * (k(1) - c) * p0;
        let fifth_c = c / k(5);
        let a11 =
            -old(1, 1) + k(8) * fifth_c * p2 + (k(2) - k(6) * fifth_c) * p1 - k(2) * fifth_c * p0;
        let a02 = old(0, 2) - k(5) * c * old(1, 1)
            + k(4) * c * c * p2
            + (k(5) * c - k(4)) * old(0, 1)
            + c * (k(9) - k(8) * c) * p1
            + (k(4) - k(9) * c + k(4) * c * c) * p0;
        let values = [((0, 0), p0), ((1, 0), p1), ((2, 0), p2)];
        for (place, value) in
            values.into_iter().chain([((0, 1), a01), ((1, 1), a11), ((0, 2), a02)])
        {
            self.set(line, place, value);
        }
    }

    /// Equation 4 on all lines: a_12 = b_21' + 2c a_21 - 2c b_12' - r, where b_21 and b_12 of the
    /// line are g_12 and g_21 of the sector behind; x_s = g_12^s is a cyclic recursion
    /// x_s = y_s - 2c x_(s-1). After n steps x_0 comes back, unless (-2c)^n = 1: for n = 3 and 6
    /// the equations agree whatever x_0 is.
    fn solve_coupled(&mut self, extra: Real) {
        let two_c = self.cos() + self.cos();
        let n = self.valence as isize;
        let is_free = self.valence == 3 || self.valence == 6;
        let from = |first: Real| {
            let mut x = vec![first];
            for line in 1..=n {
                x.push(self.coupling(line) - two_c * x[line as usize - 1]);
            }
            x
        };
        let first = if is_free {
            extra
        } else {
            let growth = (0..n).fold(Real::ONE, |power, _| -(two_c * power));
            from(Real::ZERO)[self.valence] / (Real::ONE - growth)
        };
        for (sector, value) in from(first).into_iter().take(self.valence).enumerate() {
            self.set(sector as isize, (1, 2), value);
        }
    }

    /// y = b_12 + 2c a_21 - r of a line, where now b_12 = g_21 of the sector behind.
    fn coupling(&self, line: isize) -> Real {
        let c = self.cos();
        let k = |x: i32| Real::from(x);
        let a = |i: usize, j: usize| self.at(line, i, j);
        let r = c * a(0, 1)
            + (k(3) * c - k(4)) * a(1, 1)
            + k(4) * c * (k(4) - k(3) * c) / k(5) * a(2, 0)
            + (k(4) - k(27) * c / k(5) + k(4) * c * c / k(5)) * a(1, 0)
            + c * (k(8) * c - k(9)) / k(5) * a(0, 0);
        self.at(line - 1, 2, 1) + (c + c) * a(2, 1) - r
    }

    /// Appendix A: the dependent coefficients of a line.
    fn set_dependent(&mut self, line: isize) {
        let c = self.cos();
        let p30 = edge_3(c, &self.sides(line, false));
        self.set(line, (3, 0), p30);
        self.set(line - 1, (0, 3), p30);
        let factors = Factors::new(c);
        let b32 = factors.second_layer(&self.sides(line, false));
        let ahead = factors.first_layer(&self.sides(line, false));
        let behind = factors.first_layer(&self.sides(line, true));
        self.set(line - 1, (2, 3), b32);
        for i in 3..=DEGREE {
            self.set(line, (i, 1), ahead[i - 3]);
            self.set(line - 1, (1, i), behind[i - 3]);
        }
    }
}

/// p_30 = 2/3 p_10 + (c-5)/(3c) p_20 + 5/(6c) (a_21 + b_21).
fn edge_3(c: Real, sides: &Sides) -> Real {
    let k = |x: i32| Real::from(x);
    Real::ratio(2, 3) * sides.a(1, 0)
        + (c - k(5)) / (k(3) * c) * sides.a(2, 0)
        + k(5) / (k(6) * c) * (sides.a(2, 1) + sides.b(2, 1))
}

/// The polynomials d_1..d_7 in c of Appendix A.
struct Factors {
    c: Real,
    d: [Real; 7],
}

impl Factors {
    fn new(c: Real) -> Self {
        const COEFS: [[i32; 5]; 7] = [
            [4, 8, 5, 0, 0],
            [4, 5, 0, 0, 0],
            [36, 45, 5, 0, 0],
            [20, 36, 9, -15, 0],
            [32, 48, 15, 0, 0],
            [16, 36, 36, 15, 0],
            [32, 64, 72, 48, 15],
        ];
        let value = |coefs: [i32; 5]| {
            coefs.into_iter().rev().fold(Real::ZERO, |sum, k| sum * c + Real::from(k))
        };
        Self { c, d: COEFS.map(value) }
    }

    /// a_31, a_41, a_51 of one side.
    fn first_layer(&self, s: &Sides) -> [Real; 3] {
        let (c, [d1, d2, d3, d4, d5, ..]) = (self.c, self.d);
        let k = |x: i32| Real::from(x);
        let on_line = |i: usize| s.a(i, 0);
        let (p0, p1, p2, p4, p5) = (on_line(0), on_line(1), on_line(2), on_line(4), on_line(5));
        let a31 = k(2) * c / k(15) * p0 + k(8) * c / k(15) * p1 + Real::ratio(2, 3) * s.a(1, 1)
            - (k(25) + k(16) * c * c) / (k(15) * c) * p2
            + (k(1) + k(2) * c) / (k(6) * c) * s.a(2, 1)
            + k(3) / (k(2) * c) * s.b(2, 1)
            + s.gap(2, 2) / (k(3) * c)
            + k(2) * c / k(5) * p4;
        let a41 = k(2) * c / (k(15) * d1) * (c * d2 * p0 - d3 * p1 + k(5) * d2 * s.a(1, 1))
            + k(4) * d4 / (k(15) * d1) * p2
            - d5 / (k(6) * d1) * s.a(2, 1)
            - c * (k(16) + k(25) * c) / (k(6) * d1) * s.b(2, 1)
            + d2 / (k(3) * d1) * s.gap(2, 2)
            + (k(1) + k(3) * c / k(5)) * p4
            + d2 / (k(4) * d1) * s.gap(4, 2)
            + c / k(5) * p5
            - c / (k(4) * d1) * s.gap(5, 2);
        let from_centre = c * p0 + (k(3) * c - k(5)) * p1 + k(5) * s.a(1, 1);
        let a51 = k(2) * c * c / (k(3) * d1) * from_centre
            + c / (k(6) * d1)
                * (k(5) * (c - k(4)) * s.gap(2, 1) + k(10) * s.gap(2, 2) - k(16) * c * c * p2)
            - c * p4
            + k(5) * c / (k(4) * d1) * s.gap(4, 2)
            + (k(1) + c) * p5
            + (k(4) + k(3) * c) / (k(4) * d1) * s.gap(5, 2);
        [a31, a41, a51]
    }

    /// b_32 from a_32.
    fn second_layer(&self, s: &Sides) -> Real {
        let (c, [d1, d2, _, _, _, d6, d7]) = (self.c, self.d);
        let k = |x: i32| Real::from(x);
        s.a(3, 2) - d6 / (k(3) * d1) * s.gap(1, 1) + d7 / (k(3) * c * d1) * s.gap(2, 1)
            - d6 / (k(3) * c * d1) * s.gap(2, 2)
            - c * d2 / (k(2) * d1) * s.gap(4, 2)
            + c * c / (k(2) * d1) * s.gap(5, 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guided::space::{MAX_TOTAL, basis, bb_conditions};
    use crate::linear::largest;

    fn scattered(n: usize) -> FreeCoefs {
        let value = |q: usize| Real::ratio((7 * q as i32 + 3) % 11 - 5, 10);
        FreeCoefs {
            quadratic: std::array::from_fn(value),
            sectors: (0..n).map(|s| std::array::from_fn(|k| value(6 + 18 * s + k * k))).collect(),
            extra: Real::ratio(3, 10),
        }
    }

    #[test]
    fn the_formulas_satisfy_the_conditions() {
        for n in [3, 5, 6, 7, 8, 9, 10, 16] {
            let guide = guide(&scattered(n));
            let residual = largest(&(&bb_conditions(n) * &guide)) / largest(&guide);
            assert!(residual < 1e-28, "valence {n}: {residual:e}");
        }
    }

    #[test]
    fn the_free_coefficients_determine_every_guide() {
        // A guide of the kernel is rebuilt from its own free coefficients.
        for n in [3, 5, 6, 8] {
            let all = basis(n, 0..=MAX_TOTAL);
            let mix = Matrix::from_fn(all.num_columns(), 1, |k, _| {
                Real::ratio((5 * k as i32 + 2) % 7 - 3, 7)
            });
            let exact = &all * &mix;
            let at = |s: usize, (i, j)| exact[(index(n, s as isize, i, j), 0)];
            let free = FreeCoefs {
                quadratic: QUADRATIC_PLACES.map(|place| at(0, place)),
                sectors: (0..n).map(|s| FREE_PLACES.map(|place| at(s, place))).collect(),
                extra: at(0, (1, 2)),
            };
            let error = largest(&(&guide(&free) - &exact)) / largest(&exact);
            assert!(error < 1e-26, "valence {n}: {error:e}");
        }
    }

    #[test]
    fn all_pieces_share_one_quadratic() {
        // n turns bring the quadratic of sector 0 back.
        for n in [3, 5, 6, 9] {
            let free = scattered(n);
            let mut guide = Assembly { coefs: guide(&free), valence: n };
            guide.turn_quadratic(0);
            for (place, value) in QUADRATIC_PLACES.into_iter().zip(free.quadratic) {
                let error = (guide.at(0, place.0, place.1) - value).abs().to_f64();
                assert!(error < 1e-27, "valence {n}, {place:?}: {error:e}");
            }
        }
    }
}
