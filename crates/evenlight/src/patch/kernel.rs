//! Evaluation of tensor products of a fixed size: the inner loops of everything that evaluates.
//!
//! The sum over the slower index runs first, over whole rows of coordinates:
//!
//! ```text
//!   r_j = sum_i B_i(u) p_ij          one row: 3 (d+1) numbers side by side
//!   p   = sum_j B_j(v) r_j
//! ```
//!
//! The sizes are constants, so that loops are unrolled and become vector instructions: K = d + 1
//! coefficients on each side, N numbers in each. The order of summation is fixed, so that results
//! have the same bits everywhere. Derivatives beyond `order` are not computed; they are zero in the
//! result.

use super::Jet;
use super::basis::{BasisJet, bernstein_basis};
use crate::point::scale;

/// The jet up to `order` (0, 1 or 2) of sum_ij bu_i bv_j p_ij.
#[inline(always)]
pub(crate) fn tensor_jet<const K: usize, const N: usize>(
    order: usize,
    bu: &BasisJet<K>,
    bv: &BasisJet<K>,
    p: &[[[f64; N]; K]; K],
) -> Jet<N> {
    Rows::new(order, bu, p).jet(order, bv)
}

/// The sums over the slower index, of all derivatives in u up to the order asked for.
struct Rows<const K: usize, const N: usize> {
    r: [[f64; N]; K],
    r_u: [[f64; N]; K],
    r_uu: [[f64; N]; K],
}

impl<const K: usize, const N: usize> Rows<K, N> {
    #[inline(always)]
    fn new(order: usize, bu: &BasisJet<K>, p: &[[[f64; N]; K]; K]) -> Self {
        let none = [[0.0; N]; K];
        Self {
            r: sum_of_rows(&bu[0], p),
            r_u: if order >= 1 { sum_of_rows(&bu[1], p) } else { none },
            r_uu: if order >= 2 { sum_of_rows(&bu[2], p) } else { none },
        }
    }

    #[inline(always)]
    fn jet(&self, order: usize, bv: &BasisJet<K>) -> Jet<N> {
        let mut jet = Jet { p: sum(&bv[0], &self.r), ..Jet::default() };
        if order >= 1 {
            jet.dv = sum(&bv[1], &self.r);
            jet.du = sum(&bv[0], &self.r_u);
        }
        if order >= 2 {
            jet.dvv = sum(&bv[2], &self.r);
            jet.duv = sum(&bv[1], &self.r_u);
            jet.duu = sum(&bv[0], &self.r_uu);
        }
        jet
    }
}

/// A line of a grid of parameters: its number, and the parameter that is constant on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) number: usize,
    pub(crate) at: f64,
}

/// [`tensor_jet`] where every line of `us` meets every line of `vs`. `put` gets the numbers of both
/// lines and the jet, with the same bits as from [`tensor_jet`]. What the places of one line share
/// is computed once.
#[inline(always)]
pub(crate) fn tensor_grid<const K: usize, const N: usize>(
    order: usize,
    basis: impl Fn(f64) -> BasisJet<K>,
    p: &[[[f64; N]; K]; K],
    [us, vs]: [&[Line]; 2],
    mut put: impl FnMut(usize, usize, &Jet<N>),
) {
    /// The number of bases that are kept.
    const KEPT: usize = 16;
    let mut bases = [[[0.0; K]; 3]; KEPT];
    for vs in vs.chunks(KEPT) {
        bases.iter_mut().zip(vs).for_each(|(bv, v)| *bv = basis(v.at));
        for u in us {
            let rows = Rows::new(order, &basis(u.at), p);
            for (v, bv) in vs.iter().zip(&bases) {
                put(u.number, v.number, &rows.jet(order, bv));
            }
        }
    }
}

/// [`patch_jet`] on a grid, as [`tensor_grid`].
#[inline(always)]
pub(crate) fn patch_grid<const N: usize>(
    order: usize,
    degree: usize,
    coefs: &[[f64; N]],
    [us, vs]: [&[Line]; 2],
    mut put: impl FnMut(usize, usize, &Jet<N>),
) {
    match degree {
        3 => tensor_grid::<4, N>(order, bernstein_of_size, square(coefs), [us, vs], put),
        4 => tensor_grid::<5, N>(order, bernstein_of_size, square(coefs), [us, vs], put),
        5 => tensor_grid::<6, N>(order, bernstein_of_size, square(coefs), [us, vs], put),
        6 => tensor_grid::<7, N>(order, bernstein_of_size, square(coefs), [us, vs], put),
        _ => {
            for (u, v) in us.iter().flat_map(|u| vs.iter().map(move |v| (u, v))) {
                put(u.number, v.number, &patch_jet(order, degree, coefs, [u.at, v.at]));
            }
        }
    }
}

/// sum_i w_i p_i of whole rows.
#[inline(always)]
pub(crate) fn sum_of_rows<const K: usize, const N: usize>(
    w: &[f64; K],
    p: &[[[f64; N]; K]; K],
) -> [[f64; N]; K] {
    let mut row = [[0.0; N]; K];
    row.as_flattened_mut().iter_mut().zip(p[0].as_flattened()).for_each(|(x, y)| *x = w[0] * y);
    for i in 1..K {
        let terms = row.as_flattened_mut().iter_mut().zip(p[i].as_flattened());
        terms.for_each(|(x, y)| *x += w[i] * y);
    }
    row
}

/// sum_j w_j r_j.
#[inline(always)]
pub(crate) fn sum<const K: usize, const N: usize>(w: &[f64; K], r: &[[f64; N]; K]) -> [f64; N] {
    let mut sum = scale(w[0], r[0]);
    for j in 1..K {
        for k in 0..N {
            sum[k] += w[j] * r[j][k];
        }
    }
    sum
}

/// The jet up to `order` of the patch of degree bi-`degree` with these BB coefficients, `v` index
/// fastest.
///
/// There must be (degree + 1)^2 coefficients, and the degree be at most
/// [`MAX_DEGREE`](super::MAX_DEGREE).
#[inline]
pub(crate) fn patch_jet<const N: usize>(
    order: usize,
    degree: usize,
    coefs: &[[f64; N]],
    [u, v]: [f64; 2],
) -> Jet<N> {
    match degree {
        3 => square_jet::<4, N>(order, coefs, u, v),
        4 => square_jet::<5, N>(order, coefs, u, v),
        5 => square_jet::<6, N>(order, coefs, u, v),
        6 => square_jet::<7, N>(order, coefs, u, v),
        _ => {
            let (bu, bv) = (bernstein_basis(degree, u), bernstein_basis(degree, v));
            Jet::tensor_product(&bu, &bv, [degree + 1; 2], |i, j| coefs[i * (degree + 1) + j])
        }
    }
}

#[inline(always)]
fn square_jet<const K: usize, const N: usize>(
    order: usize,
    coefs: &[[f64; N]],
    u: f64,
    v: f64,
) -> Jet<N> {
    let (bu, bv) = (bernstein_of_size::<K>(u), bernstein_of_size::<K>(v));
    tensor_jet(order, &bu, &bv, square(coefs))
}

/// The first K x K coefficients as rows.
#[inline(always)]
pub(crate) fn square<const K: usize, const N: usize>(coefs: &[[f64; N]]) -> &[[[f64; N]; K]; K] {
    let (rows, _) = coefs.as_chunks::<K>();
    rows.first_chunk::<K>().expect("a patch has (d+1)^2 coefficients")
}

/// [`bernstein_basis`] of degree K - 1, which must be 2 or more.
#[inline(always)]
pub(crate) fn bernstein_of_size<const K: usize>(t: f64) -> BasisJet<K> {
    let d = K - 1;
    let mut values = [0.0; K];
    values[0] = 1.0;
    let (mut first, mut second) = ([0.0; K], [0.0; K]);
    for degree in 1..K {
        if degree + 1 == d {
            second = differences(&differences(&values, d as f64), (d - 1) as f64);
        }
        if degree == d {
            first = differences(&values, d as f64);
        }
        for i in (1..=degree).rev() {
            values[i] = (1.0 - t) * values[i] + t * values[i - 1];
        }
        values[0] *= 1.0 - t;
    }
    [values, first, second]
}

/// factor (b_(i-1) - b_i).
#[inline(always)]
fn differences<const K: usize>(b: &[f64; K], factor: f64) -> [f64; K] {
    let mut result = [0.0; K];
    result[0] = -factor * b[0];
    for i in 1..K {
        result[i] = factor * (b[i - 1] - b[i]);
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Patch;
    use crate::point::{Point, norm, sub};

    /// Numbers without a pattern in -1..1.
    fn coefs(count: usize) -> Vec<Point> {
        let number = |k: usize| ((k * k + 7 * k) % 101) as f64 / 50.0 - 1.0;
        (0..count).map(|k| [number(3 * k), number(3 * k + 1), number(3 * k + 2)]).collect()
    }

    /// The patch evaluated by the plain sums of `Patch::jet`.
    #[test]
    fn kernels_agree_with_the_plain_sums() {
        for degree in 1..=crate::patch::MAX_DEGREE {
            let coefs = coefs((degree + 1) * (degree + 1));
            let patch = Patch::of([degree; 2], coefs.clone());
            for at in [[0.0, 0.0], [1.0, 1.0], [0.3, 0.7], [0.99, 0.01], [1.0, 0.5], [1.2, -0.1]] {
                let plain = patch.jet(at[0], at[1]).rows();
                for (order, rows) in [(0, 1), (1, 3), (2, 6)] {
                    let fast = patch_jet(order, degree, &coefs, at).rows();
                    for k in 0..rows {
                        let difference = norm(sub(fast[k], plain[k]));
                        assert!(difference < 1e-14 * (degree * degree) as f64, "{degree} {order}");
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_not_asked_for_is_zero() {
        let coefs = coefs(25);
        assert_eq!(patch_jet(0, 4, &coefs, [0.4, 0.2]).rows()[1..], [[0.0; 3]; 5]);
        assert_eq!(patch_jet(1, 4, &coefs, [0.4, 0.2]).rows()[3..], [[0.0; 3]; 3]);
    }

    #[test]
    fn bases_of_fixed_size_agree_with_the_recursion() {
        for t in [0.0, 0.25, 0.6, 1.0, 1.5] {
            let (plain, fast) = (bernstein_basis(5, t), bernstein_of_size::<6>(t));
            for (a, b) in plain.iter().zip(&fast) {
                assert!(a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-13), "{plain:?} {fast:?}");
            }
        }
    }
}
