//! Rings of lower degree: a segment of degree 5 replaced by a spline of degree 4 or 3.
//!
//! A quintic on `[0,1]` is given by position, first and second derivative at both ends, six
//! numbers. So are the splines
//!
//! ```text
//!   bi-4:   0 ---------- 1/2 ---------- 1        2 pieces, C3 at the joint
//!   bi-3:   0 ------ 1/3 ------ 2/3 ---- 1        3 pieces, C2 at the joints
//! ```
//!
//! Replacing the one by the other in both variables of a bi-5 patch keeps its jets at the corners,
//! and makes 2 x 2 patches of bi-degree 4, or 3 x 3 of bi-degree 3 [KP18-Guided, sec. 6.2]. When
//! the interval of a spline is halved, its knots are among those of the two halves; so the rings
//! still join with continuous second derivatives, if sigma is 1/2.
//!
//! DIFFERENCE: the paper gives no formulas; these splines are the only ones with as many degrees of
//! freedom as there are data.

use crate::guided::bb::{ENDS, End, bb_from_taylor, number, restrict, taylor, taylor_at, units};
use crate::linear::Matrix;
use crate::real::Real;

/// The BB coefficients of the pieces, (`degree` + 1) rows each, on those of the quintic with the
/// same data at both ends; `degree` is 4 or 3, with 6 - `degree` pieces.
pub fn spline(degree: usize) -> Matrix {
    let (count, order) = (num_pieces(degree), degree + 1);
    let size = count * order;
    let mut system = Matrix::zeros(size, size);
    let mut right = Matrix::zeros(size, 6);
    let mut row = 0;
    for joint in 1..count {
        for k in 0..degree {
            for (piece, end, sign) in
                [(joint - 1, End::Finish, Real::ONE), (joint, End::Start, -Real::ONE)]
            {
                let taylor = taylor_at(degree, degree, end);
                (0..order).for_each(|i| system[(row, piece * order + i)] = sign * taylor[(k, i)]);
            }
            row += 1;
        }
    }
    for (piece, end) in [0, count - 1].into_iter().zip(ENDS) {
        let local = taylor_at(degree, 3, end);
        let given = &units(3, Real::ONE / number(count)) * &taylor_at(5, 3, end);
        for k in 0..3 {
            (0..order).for_each(|i| system[(row, piece * order + i)] = local[(k, i)]);
            right.set_row(row, given.row(k));
            row += 1;
        }
    }
    system.solve(&right).expect("a spline is determined by its data at the ends")
}

/// The number of pieces per variable.
pub fn num_pieces(degree: usize) -> usize {
    6 - degree
}

/// The quintics over [0,1/2] and [1/2,1] with the end data of the spline: what de Casteljau's
/// algorithm is for the quintic itself.
pub fn halves(degree: usize) -> [Matrix; 2] {
    let half = Real::ratio(1, 2);
    let (count, order) = (num_pieces(degree), degree + 1);
    // The middle is the end of piece 0 of 2, or the middle of piece 1 of 3.
    let (piece, local) = if count == 2 { (0, Real::ONE) } else { (1, half) };
    let rows: Vec<usize> = (piece * order..(piece + 1) * order).collect();
    let middle = &taylor(degree, 3, local) * &spline(degree).select_rows(&rows);
    let middle = &units(3, number(count)) * &middle;
    let ends = ENDS.map(|end| taylor_at(5, 3, end));
    let quintic = |start: &Matrix, finish: &Matrix| {
        let to_bb = |end, data: &Matrix| &(&bb_from_taylor(5, 3, end) * &units(3, half)) * data;
        to_bb(End::Start, start).above(&to_bb(End::Finish, finish))
    };
    [quintic(&ends[0], &middle), quintic(&middle, &ends[1])]
}

/// The halves of the quintic itself when split at `sigma`.
pub fn quintic_parts(degree: usize, sigma: Real) -> [Matrix; 2] {
    [restrict(degree, Real::ZERO, sigma), restrict(degree, sigma, Real::ONE)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guided::bb::raise;
    use crate::linear::largest;

    #[test]
    fn splines_of_low_degree_are_reproduced() {
        // A cubic is both a quintic and a spline of one knot-free piece.
        for degree in [3, 4] {
            let pieces = num_pieces(degree);
            let quintic = raise(3, 5);
            let spline = &spline(degree) * &quintic;
            let cubic = (0..pieces).map(|k| {
                let at = |k| number(k) / number(pieces);
                &raise(3, degree) * &restrict(3, at(k), at(k + 1))
            });
            let exact = cubic.reduce(|all, piece| all.above(&piece)).unwrap();
            assert!(largest(&(&spline - &exact)) < 1e-28, "degree {degree}");
        }
    }

    #[test]
    fn the_halves_of_a_spline_are_splines_of_their_end_data() {
        for degree in [3, 4] {
            let whole = spline(degree);
            let order = degree + 1;
            let point = |table: &Matrix, t: Real| {
                let count = num_pieces(degree);
                let scaled = t * number(count);
                let piece = (scaled.to_f64() as usize).min(count - 1);
                let rows: Vec<usize> = (piece * order..(piece + 1) * order).collect();
                &taylor(degree, 1, scaled - number(piece)) * &table.select_rows(&rows)
            };
            for k in 0..20 {
                let t = Real::ratio(2 * k + 1, 40);
                let [low, high] = halves(degree);
                let twice = t + t;
                let exact = point(&whole, t);
                let found = if twice < Real::ONE {
                    point(&(&whole * &low), twice)
                } else {
                    point(&(&whole * &high), twice - Real::ONE)
                };
                assert!(largest(&(&found - &exact)) < 1e-28, "degree {degree}");
            }
        }
    }
}
