//! The measures of unfairness that choose the guide: of its rings, and of itself.
//!
//! A ring is fair if its third derivatives are small, taken in the plane of the characteristic
//! ring. With X, Y the Cartesian coordinates of lambda^l chi, ring l of a coordinate f has
//!
//! ```text
//! E_l(f) = integral over the ring of  sum_i C(3,i) (d_X^(3-i) d_Y^i f)^2  dX dY,
//! ```
//!
//! which no rotation of the plane changes. The integral is *defined* as the Gauss sum with 6 x 6
//! nodes per square. At each node the derivatives in X and Y follow from the Taylor coefficients in
//! the parameters: the coefficients up to total degree 3 of the monomials (X-X0)^a (Y-Y0)^b are a
//! 10 x 10 matrix, and its inverse passes from the one to the other.
//!
//! From ring to ring lengths shrink by lambda: E_l = lambda^(-4l) E_0 of the same coefficients.
//!
//! DIFFERENCE: the paper fits its guide to a G1 surface by an algorithm that it cites and that we
//! have not seen. Fairness of the rings is our replacement.

use crate::guided::bb::{choose, number, power, taylor};
use crate::guided::characteristic::{CharacteristicRing, Square};
use crate::guided::composition::{one, product};
use crate::linear::Matrix;
use crate::real::Real;

/// The order of the derivatives that are made small.
const ORDER: usize = 3;

/// The nodes per variable of the Gauss sum.
pub(crate) const NODES: usize = 6;

/// The matrix of E_0 for one square of the ring, on its (d + 1)^2 BB coefficients.
pub fn ring_energy(chi: &CharacteristicRing, square: Square, degree: usize) -> Matrix {
    let size = (degree + 1) * (degree + 1);
    let plane = in_plane(chi, square);
    let mut energy = Matrix::zeros(size, size);
    let nodes = gauss_nodes();
    for (u, weight_u) in nodes {
        for (v, weight_v) in nodes {
            let (derivatives, area) = third_derivatives(&plane, degree, [u, v]);
            let weight = weight_u * weight_v * area;
            for i in 0..=ORDER {
                add_square(&mut energy, derivatives.row(i), weight * choose(ORDER, i));
            }
        }
    }
    energy
}

/// The matrix of the functional F_k on the BB coefficients of a patch of bi-`degree` over the unit
/// square: the integral of sum_(i+j=k) k!/(i! j!) (d_u^i d_v^j g)^2.
pub fn functional(degree: usize, k: usize) -> Matrix {
    let size = (degree + 1) * (degree + 1);
    (0..=k).fold(Matrix::zeros(size, size), |sum, i| {
        let term = derivative_products(degree, i).kronecker(&derivative_products(degree, k - i));
        &sum + &term.scaled(choose(k, i))
    })
}

/// The integrals over the unit interval of the products of the i-th derivatives of the Bernstein
/// polynomials: D^T G D with D the i-th differences times d!/(d-i)! and G of degree d - i.
fn derivative_products(degree: usize, i: usize) -> Matrix {
    let Some(m) = degree.checked_sub(i) else {
        return Matrix::zeros(degree + 1, degree + 1);
    };
    let derivative = (m..degree).rev().fold(Matrix::identity(degree + 1), |before, lower| {
        Matrix::from_fn(lower + 1, degree + 1, |row, column| {
            number(lower + 1) * (before[(row + 1, column)] - before[(row, column)])
        })
    });
    let products = Matrix::from_fn(m + 1, m + 1, |a, b| {
        choose(m, a) * choose(m, b) / (choose(2 * m, a + b) * number(2 * m + 1))
    });
    &derivative.transposed() * &(&products * &derivative)
}

/// Adds `weight` times the product of the row with itself.
pub(crate) fn add_square(matrix: &mut Matrix, row: &[Real], weight: Real) {
    for (i, &x) in row.iter().enumerate() {
        let scaled = weight * x;
        for (j, &y) in row.iter().enumerate() {
            matrix[(i, j)] += scaled * y;
        }
    }
}

/// A square of the ring in Cartesian coordinates, line s-1 along X: X = u + c v, Y = s v.
fn in_plane(chi: &CharacteristicRing, square: Square) -> [Matrix; 2] {
    let c = Real::cos_of_turn(chi.valence);
    let s = (Real::ONE - c * c).sqrt();
    let [u, v] = chi.square(square);
    [&u + &v.scaled(c), v.scaled(s)]
}

/// The rows of d_X^(3-i) d_Y^i, i = 0..3, on the BB coefficients of a patch of the given degree, at
/// a point; and the area of the map there, |d(X,Y)/d(u,v)|.
fn third_derivatives(plane: &[Matrix; 2], degree: usize, at: [Real; 2]) -> (Matrix, Real) {
    derivatives_in_plane(plane, degree, ORDER, at)
}

/// The rows of d_X^(k-i) d_Y^i, i = 0..k, k at most 3, on the BB coefficients of a patch of the
/// given degree, at a point; and the area of the map `plane` there, |d(X,Y)/d(u,v)|.
pub(crate) fn derivatives_in_plane(
    plane: &[Matrix; 2],
    degree: usize,
    order: usize,
    at: [Real; 2],
) -> (Matrix, Real) {
    let count = ORDER + 1;
    let jets = plane.each_ref().map(|patch| {
        let [along_u, along_v] = at.map(|t| taylor(patch.num_rows() - 1, count, t));
        &(&along_u * patch) * &along_v.transposed()
    });
    let area = jets[0][(1, 0)] * jets[1][(0, 1)] - jets[0][(0, 1)] * jets[1][(1, 0)];
    let monomials = monomial_coefs(&jets);
    let [along_u, along_v] = at.map(|t| taylor(degree, count, t));
    let parameters = along_u.kronecker(&along_v);
    let parameters = parameters
        .select_rows(&exponents().iter().map(|&(a, b)| count * a + b).collect::<Vec<_>>());
    let in_plane = monomials.solve(&parameters).expect("the characteristic ring is regular");
    let rows = (0..=order).map(|i| {
        let (a, b) = (order - i, i);
        let row = exponents().iter().position(|&e| e == (a, b)).expect("3 is the highest degree");
        (row, factorial(a) * factorial(b))
    });
    let rows: Vec<_> = rows.collect();
    let derivatives = Matrix::from_fn(order + 1, in_plane.num_columns(), |i, column| {
        rows[i].1 * in_plane[(rows[i].0, column)]
    });
    (derivatives, area.abs())
}

/// The exponents (a, b) with a + b <= 3.
fn exponents() -> Vec<(usize, usize)> {
    (0..=ORDER).flat_map(|total| (0..=total).map(move |b| (total - b, b))).collect()
}

/// The Taylor coefficients (rows) in the parameters of the monomials (columns) in X - X0, Y - Y0.
fn monomial_coefs(jets: &[Matrix; 2]) -> Matrix {
    let powers = jets.each_ref().map(|jet| {
        let mut centred = jet.clone();
        centred[(0, 0)] = Real::ZERO;
        let mut powers = vec![one(ORDER + 1)];
        for k in 0..ORDER {
            powers.push(product(&powers[k], &centred));
        }
        powers
    });
    let exponents = exponents();
    let monomials: Vec<Matrix> =
        exponents.iter().map(|&(a, b)| product(&powers[0][a], &powers[1][b])).collect();
    Matrix::from_fn(exponents.len(), exponents.len(), |row, column| {
        monomials[column][exponents[row]]
    })
}

fn factorial(n: usize) -> Real {
    (1..=n).fold(Real::ONE, |product, k| product * number(k))
}

/// The nodes and weights of the Gauss sum on [0,1]: the roots of the Legendre polynomial of
/// degree 6, by Newton's method from their known approximations.
pub(crate) fn gauss_nodes() -> [(Real, Real); NODES] {
    const ROOTS: [f64; NODES / 2] = [0.238_619_186, 0.661_209_386, 0.932_469_514];
    std::array::from_fn(|k| {
        let guess = if k < 3 { -ROOTS[2 - k] } else { ROOTS[k - 3] };
        let newton = |x, _| {
            let (value, slope) = legendre(x);
            x - value / slope
        };
        let root = (0..3).fold(Real::from(guess), newton);
        let slope = legendre(root).1;
        let weight = Real::ONE / ((Real::ONE - root * root) * slope * slope);
        ((root + Real::ONE) * Real::ratio(1, 2), weight)
    })
}

/// The Legendre polynomial of degree 6 and its derivative.
fn legendre(x: Real) -> (Real, Real) {
    const COEFS: [i32; 4] = [-5, 105, -315, 231]; // of x^0, x^2, x^4, x^6, over 16
    let terms = || COEFS.into_iter().enumerate();
    let value: Real = terms().map(|(k, c)| Real::ratio(c, 16) * power(x, 2 * k)).sum();
    let slope =
        terms().skip(1).map(|(k, c)| Real::ratio(c * 2 * k as i32, 16) * power(x, 2 * k - 1)).sum();
    (value, slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guided::bb::{End, bb_from_taylor};
    use crate::guided::characteristic::SQUARES;
    use crate::guided::composition::jet_at;
    use crate::linear::largest;

    #[test]
    fn gauss_sums_integrate_polynomials_of_degree_11() {
        for k in 0..12 {
            let sum: Real = gauss_nodes().into_iter().map(|(t, w)| w * power(t, k)).sum();
            let error = sum - Real::ratio(1, k as i32 + 1);
            assert!(error.abs().to_f64() < 1e-30, "t^{k}: {:e}", error.abs().to_f64());
        }
    }

    /// The bi-9 BB coefficients of X^a Y^b of a square, a + b <= 3.
    fn monomial(plane: &[Matrix; 2], a: usize, b: usize) -> Matrix {
        let start = [End::Start, End::Start];
        let [x, y] = plane.each_ref().map(|patch| jet_at(patch, 10, start));
        let factors = [vec![&x; a], vec![&y; b]].concat();
        let jet = factors.into_iter().fold(one(10), |all, factor| product(&all, factor));
        let to_bb = bb_from_taylor(9, 10, End::Start);
        let bb = &(&to_bb * &jet) * &to_bb.transposed();
        Matrix::from_fn(100, 1, |k, _| bb[(k / 10, k % 10)])
    }

    #[test]
    fn the_energy_of_a_cubic_is_its_third_derivatives_times_the_area() {
        for n in [3, 5, 8] {
            let chi = CharacteristicRing::catmull_clark(n);
            for square in SQUARES {
                let plane = in_plane(&chi, square);
                let energy = ring_energy(&chi, square, 9);
                let area: Real = gauss_nodes()
                    .into_iter()
                    .flat_map(|u| gauss_nodes().map(|v| (u, v)))
                    .map(|((u, wu), (v, wv))| wu * wv * third_derivatives(&plane, 3, [u, v]).1)
                    .sum();
                for (a, b) in exponents() {
                    let f = monomial(&plane, a, b);
                    let value = (&f.transposed() * &(&energy * &f))[(0, 0)];
                    let exact = match (a, b) {
                        (3, 0) | (0, 3) => Real::from(36) * area,
                        (2, 1) | (1, 2) => Real::from(12) * area,
                        _ => Real::ZERO,
                    };
                    let error = (value - exact).abs().to_f64();
                    assert!(error < 1e-20, "n = {n}, {square:?}, X^{a} Y^{b}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn the_functional_is_that_of_the_other_schemes() {
        for k in 0..=6 {
            let (here, there) = (functional(5, k), crate::quadratic::functional(k));
            assert!(largest(&(&here - &there)) <= 1e-28 * largest(&there), "F_{k}");
        }
    }

    #[test]
    fn mirrored_squares_have_mirrored_energies() {
        let chi = CharacteristicRing::catmull_clark(7);
        let mirrored: Vec<usize> = (0..36).map(|k| 6 * (k % 6) + k / 6).collect();
        let (a, c) = (ring_energy(&chi, Square::A, 5), ring_energy(&chi, Square::C, 5));
        let image = c.select_rows(&mirrored).select_columns(&mirrored);
        assert!(largest(&(&a - &image)) < 1e-25 * largest(&a));
    }
}
