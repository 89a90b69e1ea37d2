//! The quadratic q at the extraordinary point: its form in each sector and the functional F_k.
//!
//! In sector s, with u along line s-1 and v along line s, a quadratic is given by six of the
//! coefficients of its BB form of total degree 5, the points numbered (a, b) next to the centre:
//!
//! ```text
//!   line s
//!   q_6 (0,2)
//!   q_4 (0,1)   q_5 (1,1)
//!   q_1 (0,0)   q_2 (1,0)   q_3 (2,0)   line s-1
//! ```
//!
//! q_1 = p is the extraordinary point, q_2 and q_4 span the tangent plane.

use crate::jet::binomial;
use crate::linear::Matrix;
use crate::real::Real;

/// The indices (a, b) of q_1..q_6.
pub const Q_POINTS: [(usize, usize); 6] = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (0, 2)];

/// The mirror image of each of q_1..q_6 in the diagonal of the sector, as a number from 0: q_2 and
/// q_4 change places, and q_3 and q_6.
pub const Q_MIRRORED: [usize; 6] = [0, 3, 5, 1, 4, 2];

/// The matrix A of the passage to the next sector: q^(s+1) = A q^s, [KP23-QAS, eq. 1].
///
/// Along line s only the names change, (q_2, q_3) := (q_4, q_6). The other rows express that the
/// direction of line s+1 is 2c times the direction of line s minus the direction of line s-1,
/// c = cos(2 pi / n).
pub fn turn(valence: usize) -> Matrix {
    let c = Real::cos_of_turn(valence);
    let two_c = c + c;
    let d = Real::from(2) - two_c; // 2 (1 - c)
    let (zero, one) = (Real::ZERO, Real::ONE);
    let rows = [
        [one, zero, zero, zero, zero, zero],
        [zero, zero, zero, one, zero, zero],
        [zero, zero, zero, zero, zero, one],
        [d, -one, zero, two_c, zero, zero],
        [zero, zero, zero, d, -one, two_c],
        [d * d, -(d + d), one, (two_c + two_c) * d, -(two_c + two_c), two_c * two_c],
    ];
    Matrix::from_fn(6, 6, |i, j| rows[i][j])
}

/// The matrix of the functional F_k on the 36 BB coefficients, first index faster, of a bi-5
/// patch g over the unit square, [KP23-QAS, eq. 3]:
///
/// ```text
/// F_k(g) = integral of  sum_(i+j=k) k!/(i! j!) (d_u^i d_v^j g)^2.
/// ```
pub fn functional(k: usize) -> Matrix {
    (0..=k).fold(Matrix::zeros(36, 36), |sum, i| {
        let term = derivative_products(k - i).kronecker(&derivative_products(i));
        &sum + &term.scaled(Real::from(binomial(k, i) as i32))
    })
}

/// The integrals over [0,1] of the products of the i-th derivatives of the quintic Bernstein
/// polynomials: D^T G D with D the i-th differences times 5!/(5-i)! and G of degree 5-i.
fn derivative_products(i: usize) -> Matrix {
    if i > 5 {
        return Matrix::zeros(6, 6);
    }
    let m = 5 - i;
    let factor = Real::from(((m + 1)..=5).product::<usize>() as i32);
    let differences = Matrix::from_fn(m + 1, 6, |row, column| {
        match column.checked_sub(row).filter(|&step| step <= i) {
            Some(step) if (i - step).is_multiple_of(2) => {
                factor * Real::from(binomial(i, step) as i32)
            }
            Some(step) => -(factor * Real::from(binomial(i, step) as i32)),
            None => Real::ZERO,
        }
    });
    &differences.transposed() * &(&bernstein_products(m) * &differences)
}

/// The integrals over [0,1] of B_a B_b of degree m: C(m,a) C(m,b) / (C(2m,a+b) (2m+1)).
fn bernstein_products(m: usize) -> Matrix {
    Matrix::from_fn(m + 1, m + 1, |a, b| {
        let numerator = binomial(m, a) * binomial(m, b);
        Real::ratio(numerator as i32, (binomial(2 * m, a + b) * (2 * m + 1)) as i32)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::largest;

    #[test]
    fn the_mirror_exchanges_the_two_indices() {
        for (number, image) in Q_MIRRORED.into_iter().enumerate() {
            let (a, b) = Q_POINTS[number];
            assert_eq!(Q_POINTS[image], (b, a));
        }
    }

    #[test]
    fn a_turn_and_a_mirror_are_undone_by_themselves() {
        // The mirror in line s maps sector s+1 to sector s: first turn, then exchange.
        for n in 3..=16 {
            let mirror_in_line = turn(n).select_rows(&Q_MIRRORED);
            let twice = &mirror_in_line * &mirror_in_line;
            assert!(largest(&(&twice - &Matrix::identity(6))) < 1e-28, "valence {n}");
        }
    }

    #[test]
    fn n_turns_are_the_identity() {
        for n in 3..=16 {
            let turns = (0..n).fold(Matrix::identity(6), |power, _| &turn(n) * &power);
            assert!(largest(&(&turns - &Matrix::identity(6))) < 1e-27, "valence {n}");
        }
    }

    /// q of f = 1 + 3u - 2v + 5u^2 + 7uv - 4v^2: the BB points of total degree 5 of u, u^2 and uv
    /// are a/5, a(a-1)/20 and ab/20.
    fn quadratic_of(f: impl Fn(usize, usize) -> Real) -> Matrix {
        Matrix::from_fn(6, 1, |row, _| f(Q_POINTS[row].0, Q_POINTS[row].1))
    }

    #[test]
    fn a_turn_renames_the_same_quadratic() {
        // In the next sector's (x, y): the point x e_s + y e_(s+1) has u = -y, v = x + 2c y.
        for n in [3, 4, 5, 9] {
            let c2 = Real::cos_of_turn(n) + Real::cos_of_turn(n);
            let poly = |co: [Real; 6]| {
                quadratic_of(move |a, b| {
                    let (x, y) = (Real::ratio(a as i32, 5), Real::ratio(b as i32, 5));
                    let square = |k: usize| Real::ratio((k * k) as i32 - k as i32, 20);
                    let mixed = Real::ratio((a * b) as i32, 20);
                    co[0]
                        + co[1] * x
                        + co[2] * y
                        + co[3] * square(a)
                        + co[4] * mixed
                        + co[5] * square(b)
                })
            };
            let [f, fu, fv, fuu, fuv, fvv] = [1, 3, -2, 5, 7, -4].map(Real::from);
            let next = [
                f,
                fv,
                c2 * fv - fu,
                fvv,
                Real::from(2) * c2 * fvv - fuv,
                fuu - c2 * fuv + c2 * c2 * fvv,
            ];
            let own = poly([f, fu, fv, fuu, fuv, fvv]);
            assert!(largest(&(&(&turn(n) * &own) - &poly(next))) < 1e-29, "valence {n}");
        }
    }

    #[test]
    fn the_functional_vanishes_below_its_order_and_is_known_for_monomials() {
        // g = u^4 v has BB coefficients [a = 4: 1/5, a = 5: 1] (b / 5).
        let g = Matrix::from_fn(36, 1, |index, _| {
            let (a, b) = (index % 6, index / 6);
            Real::ratio([0, 0, 0, 0, 1, 5][a] * b as i32, 25)
        });
        let value = |k: usize| (&g.transposed() * &(&functional(k) * &g))[(0, 0)].to_f64();
        assert!((value(5) - 5.0 * 24.0 * 24.0).abs() < 1e-25); // only d_u^4 d_v: 5!/4! (24)^2
        let by_hand = 24.0 * 24.0 / 3.0 + 4.0 * 24.0 * 24.0 / 3.0; // (24 v)^2 and 4 (24 u)^2
        assert!((value(4) - by_hand).abs() < 1e-25);
        assert!(value(6).abs() < 1e-22); // entries up to 5!^2 cancel
    }
}
