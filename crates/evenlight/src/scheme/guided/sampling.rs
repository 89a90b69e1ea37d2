//! Monomials of the guide composed with the characteristic ring, sampled at the corners of patches.
//!
//! The Taylor coefficients t_rs of x^r y^s, 0 <= r, s < m, form an algebraic ring: products are
//! cut off by x^m = y^m = 0, and no coefficient that is kept depends on one that was dropped. So
//! the jets of U^i V^j follow exactly from the jets of U and V, though its degree is up to 30.

use super::segment::{bb_at_end, bb_at_start, taylor_at_end, taylor_at_start};
use crate::pairs::pairs;

/// A jet, or the coefficients of a patch: the index along v runs fastest.
type Square = Vec<f64>;

/// For each (i,j) of `monomials` the patch of bi-`degree` that agrees with U^i V^j in the m x m
/// jets, m = `count`, at its four corners; U and V are bi-3 patches. Each corner gives the m x m
/// coefficients next to it; those given by several corners are averaged.
pub(super) fn sampled(
    map: &[Square; 2],
    degree: usize,
    count: usize,
    monomials: &[(usize, usize)],
) -> Vec<Square> {
    let order = degree + 1;
    let mut sums = vec![vec![0.0; order * order]; monomials.len()];
    for corner in [[false, false], [false, true], [true, false], [true, true]] {
        let powers = map.each_ref().map(|patch| powers(&jet_at(patch, count, corner), count));
        let first = corner.map(|end| if end { order - count } else { 0 });
        for (sum, &(i, j)) in sums.iter_mut().zip(monomials) {
            let jet = product(&powers[0][i], &powers[1][j], count);
            for (k, b) in coefs_at(&jet, count, degree, corner).into_iter().enumerate() {
                sum[(first[0] + k / count) * order + first[1] + k % count] += b;
            }
        }
    }
    let hits = |i: usize| usize::from(i < count) + usize::from(i + count >= order);
    for sum in &mut sums {
        for (k, b) in sum.iter_mut().enumerate() {
            *b /= (hits(k / order) * hits(k % order)) as f64;
        }
    }
    sums
}

/// The jet of a patch at a corner, `end` saying whether u, v are 1 there.
fn jet_at(patch: &Square, count: usize, end: [bool; 2]) -> Square {
    let taylor = |end: bool, b: &[f64]| match end {
        false => taylor_at_start(b, count),
        true => taylor_at_end(b, count),
    };
    let order = (1..).find(|k| k * k >= patch.len()).expect("numbers have no end");
    in_both(patch, order, |b| taylor(end[0], b), |b| taylor(end[1], b))
}

/// The BB coefficients next to a corner from the jet there.
fn coefs_at(jet: &Square, count: usize, degree: usize, end: [bool; 2]) -> Square {
    let coefs = |end: bool, t: &[f64]| match end {
        false => bb_at_start(degree, t),
        true => bb_at_end(degree, t),
    };
    in_both(jet, count, |t| coefs(end[0], t), |t| coefs(end[1], t))
}

/// Maps the columns of a square by `along_u`, then the rows by `along_v`; `order` is its width.
fn in_both(
    square: &Square,
    order: usize,
    along_u: impl Fn(&[f64]) -> Vec<f64>,
    along_v: impl Fn(&[f64]) -> Vec<f64>,
) -> Square {
    let column = |j: usize| square.iter().skip(j).step_by(order).copied().collect::<Vec<_>>();
    let columns: Vec<Vec<f64>> = (0..order).map(|j| along_u(&column(j))).collect();
    let row = |i: usize| columns.iter().map(|column| column[i]).collect::<Vec<_>>();
    (0..columns[0].len()).flat_map(|i| along_v(&row(i))).collect()
}

/// The powers 0 to 5 of a jet.
fn powers(jet: &Square, count: usize) -> Vec<Square> {
    let mut one = vec![0.0; count * count];
    one[0] = 1.0;
    let mut powers = vec![one];
    for k in 0..5 {
        powers.push(product(&powers[k], jet, count));
    }
    powers
}

/// The product of two jets.
fn product(a: &Square, b: &Square, count: usize) -> Square {
    let entry = |i: usize, j: usize| {
        let splits = pairs(i + 1, j + 1);
        splits.map(|(k, l)| a[k * count + l] * b[(i - k) * count + j - l]).sum()
    };
    (0..count * count).map(|at| entry(at / count, at % count)).collect()
}
