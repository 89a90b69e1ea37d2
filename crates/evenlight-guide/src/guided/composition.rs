//! Jets of the guide composed with a map: exact, as tables on the coefficients of one piece.
//!
//! The Taylor coefficients t_rs of x^r y^s, 0 <= r, s < m, at a corner form a ring: products are
//! cut off, x^m = y^m = 0, and no coefficient that is kept depends on one that was dropped. A guide
//! sum g_ij B_i(U) B_j(V) is composed with a map (U, V) by calculating in this ring, so the jet of
//! the composition is found without ever expanding it (its degree would be 30).

use crate::guided::bb::{ENDS, End, bb_from_taylor, choose, taylor_at};
use crate::guided::space::{COEFS, DEGREE};
use crate::linear::Matrix;
use crate::real::Real;

/// The Taylor coefficients of order below `count` in each variable, at the corner (`u`, `v`), of
/// the patch with the given (d + 1) x (d + 1) BB coefficients.
pub fn jet_at(patch: &Matrix, count: usize, [u, v]: [End; 2]) -> Matrix {
    let along_u = taylor_at(patch.num_rows() - 1, count, u);
    let along_v = taylor_at(patch.num_columns() - 1, count, v);
    &(&along_u * patch) * &along_v.transposed()
}

/// The jet of g(U, V) as rows m r + s on the 36 coefficients of g, from the m x m jets of U and V.
pub fn composed(map: &[Matrix; 2]) -> Matrix {
    let polynomials = map.each_ref().map(bernstein);
    let count = map[0].num_rows();
    let mut table = Matrix::zeros(count * count, COEFS);
    for (i, of_u) in polynomials[0].iter().enumerate() {
        for (j, of_v) in polynomials[1].iter().enumerate() {
            let product = product(of_u, of_v);
            for row in 0..count * count {
                table[(row, (DEGREE + 1) * i + j)] = product[(row / count, row % count)];
            }
        }
    }
    table
}

/// The product of two jets of equal size.
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    Matrix::from_fn(a.num_rows(), a.num_columns(), |i, j| {
        let splits = (0..=i).flat_map(|k| (0..=j).map(move |l| (k, l)));
        splits.map(|(k, l)| a[(k, l)] * b[(i - k, j - l)]).sum()
    })
}

/// The jet of the constant 1.
pub fn one(count: usize) -> Matrix {
    let mut jet = Matrix::zeros(count, count);
    jet[(0, 0)] = Real::ONE;
    jet
}

/// The quintic Bernstein polynomials C(5,i) f^i (1-f)^(5-i) of a jet f.
fn bernstein(f: &Matrix) -> Vec<Matrix> {
    let powers = |base: &Matrix| {
        let mut powers = vec![one(base.num_rows())];
        for k in 0..DEGREE {
            powers.push(product(&powers[k], base));
        }
        powers
    };
    let (of_f, of_rest) = (powers(f), powers(&(&one(f.num_rows()) - f)));
    let polynomial = |i: usize| product(&of_f[i], &of_rest[DEGREE - i]).scaled(choose(DEGREE, i));
    (0..=DEGREE).map(polynomial).collect()
}

/// A patch of bi-`degree` that agrees with g(U, V) in the m x m jets of its four corners, as
/// (`degree` + 1)^2 rows on the 36 coefficients of g. Each corner gives the m x m coefficients next
/// to it; those given by several corners, for 2m > `degree` + 1, are averaged.
pub fn sampled(map: &[Matrix; 2], degree: usize, count: usize) -> Matrix {
    let order = degree + 1;
    let mut sums = Matrix::zeros(order * order, COEFS);
    let mut hits = vec![0; order * order];
    for corner in ENDS.into_iter().flat_map(|u| ENDS.map(|v| [u, v])) {
        let jets = map.each_ref().map(|patch| jet_at(patch, count, corner));
        let to_bb = corner.map(|end| bb_from_taylor(degree, count, end));
        let block = &to_bb[0].kronecker(&to_bb[1]) * &composed(&jets);
        let first = corner.map(|end| end.first(degree, count));
        for row in 0..count * count {
            let number = order * (first[0] + row / count) + first[1] + row % count;
            hits[number] += 1;
            for column in 0..COEFS {
                sums[(number, column)] += block[(row, column)];
            }
        }
    }
    Matrix::from_fn(order * order, COEFS, |row, column| sums[(row, column)] / Real::from(hits[row]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guided::bb::{monomials, raise, restrict};
    use crate::linear::largest;

    fn ramp(order: usize, seed: i32) -> Matrix {
        Matrix::from_fn(order, order, |i, j| {
            Real::ratio((seed + 7 * i as i32 + 3 * j as i32 + (i * j) as i32) % 11, 10)
        })
    }

    fn column(patch: &Matrix) -> Matrix {
        let order = patch.num_columns();
        Matrix::from_fn(order * order, 1, |k, _| patch[(k / order, k % order)])
    }

    #[test]
    fn a_guide_composed_with_a_part_of_the_square_is_its_restriction() {
        // U = u / 3, V = 1/4 + v / 2 as bilinear maps, raised to bi-3.
        let (a, b, c) = (Real::ratio(1, 3), Real::ratio(1, 4), Real::ratio(3, 4));
        let up = raise(1, 3);
        let along = |p: Real, q: Real| &up * &Matrix::from_fn(2, 1, |k, _| [p, q][k]);
        let ones = Matrix::from_fn(4, 1, |_, _| Real::ONE);
        let u = &along(Real::ZERO, a) * &ones.transposed();
        let v = &ones * &along(b, c).transposed();
        let guide = column(&ramp(6, 2));
        let part = restrict(5, Real::ZERO, a).kronecker(&restrict(5, b, c));
        let exact = &part * &guide;
        let error = &(&sampled(&[u, v], 5, 3) * &guide) - &exact;
        assert!(largest(&error) < 1e-27);
    }

    #[test]
    fn a_product_of_the_coordinates_is_the_product_of_the_maps() {
        // g = u v composed with bi-3 maps has bi-degree 6: bi-6 patches of 4 x 4 jets have it.
        let guide = monomials(5);
        let guide = column(&(&guide.columns(1..2) * &guide.columns(1..2).transposed()));
        let map = [ramp(4, 1), ramp(4, 5)];
        let patch = &sampled(&map, 6, 4) * &guide;
        for corner in [[End::Start, End::Start], [End::Finish, End::Start]] {
            let jet = map.each_ref().map(|patch| jet_at(patch, 7, corner));
            let exact = product(&jet[0], &jet[1]);
            let order = 7;
            let found = Matrix::from_fn(order, order, |i, j| patch[(order * i + j, 0)]);
            assert!(largest(&(&jet_at(&found, 7, corner) - &exact)) < 1e-24);
        }
    }
}
