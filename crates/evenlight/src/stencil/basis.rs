//! Basis functions with their derivatives as weights of coefficients, and the change between the
//! parameters of a sector and the parameters of its quad.

use crate::patch::basis::BasisJet;

/// The orders in u and v of the rows of a place: p, du, dv, duu, duv, dvv.
const ORDERS: [[usize; 2]; 6] = [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2]];

/// The weights, in the rows of a place, of the coefficients `i` and `j` of a tensor product; row k
/// is multiplied by `factors[k]`.
#[inline]
pub(super) fn product<const R: usize, const N: usize>(
    factors: &[f64; R],
    [bu, bv]: [&BasisJet<N>; 2],
    [i, j]: [usize; 2],
) -> [f64; R] {
    std::array::from_fn(|k| {
        let [du, dv] = ORDERS[k];
        factors[k] * (bu[du][i] * bv[dv][j])
    })
}

/// The factors of rows by those of the value, of first and of second derivatives, which also are to
/// be divided by the sizes of a patch in u and v.
#[inline]
pub(super) fn factors<const R: usize>(by_order: [f64; 3], sizes: [f64; 2]) -> [f64; R] {
    std::array::from_fn(|k| {
        let [du, dv] = ORDERS[k];
        let size = |k: usize| [1.0, sizes[k], sizes[k] * sizes[k]];
        by_order[du + dv] / (size(0)[du] * size(1)[dv])
    })
}

/// For every row in (u,v) the row in the (a,b) of a sector whose point is at this corner of the
/// square, and its sign.
const TURNED: [[(usize, f64); 6]; 4] = [
    [(0, 1.0), (1, 1.0), (2, 1.0), (3, 1.0), (4, 1.0), (5, 1.0)],
    [(0, 1.0), (2, -1.0), (1, 1.0), (5, 1.0), (4, -1.0), (3, 1.0)],
    [(0, 1.0), (1, -1.0), (2, -1.0), (3, 1.0), (4, 1.0), (5, 1.0)],
    [(0, 1.0), (2, 1.0), (1, -1.0), (5, 1.0), (4, -1.0), (3, 1.0)],
];

/// The weights in the rows by (u,v), from those in the rows by (a,b).
#[inline]
pub(super) fn turned<const R: usize>(corner: u8, rows: [f64; R]) -> [f64; R] {
    std::array::from_fn(|k| {
        let (row, sign) = TURNED[corner as usize][k];
        sign * rows[row]
    })
}

/// The number, along (a,b), of coefficient (i,j) along (u,v) of a patch of some degree.
pub(super) fn turned_coefficient(corner: u8, d: usize, [i, j]: [usize; 2]) -> usize {
    let [a, b] = match corner {
        0 => [i, j],
        1 => [j, d - i],
        2 => [d - i, d - j],
        _ => [d - j, i],
    };
    a * (d + 1) + b
}
