//! Rings of lower degree: a segment of degree 5 replaced by a spline of degree 4 or 3.
//!
//! Position, first and second derivative at both ends, six numbers, determine a quintic on `[0,1]`.
//! They also determine the splines
//!
//! ```text
//!   bi-4:   0 ------------ x ----------- 1        2 pieces, C3 at the joint
//!   bi-3:   0 ------- x ------- y ------ 1        3 pieces, C2 at the joints
//! ```
//!
//! Replacing the one by the other in both variables of a bi-5 patch keeps its jets at the corners,
//! and makes 2 x 2 patches of bi-degree 4, or 3 x 3 of bi-degree 3 [KP18-Guided, sec. 6.2].
//!
//! The rings join with continuous second derivatives if the spline along the edge of a hole, with
//! the knots H, survives when it is cut at sigma: its inner part is the edge of the next hole, the
//! outer one has knots Z of its own,
//!
//! ```text
//!   H is contained in   sigma H  +  {sigma}  +  sigma + (1 - sigma) Z.
//! ```
//!
//! So a single knot is sigma; of two, the smaller is sigma times the larger, which comes from Z.
//! For sigma = 1/2 they are 1/2, and 1/3 and 2/3 ([`knots`]).
//!
//! DIFFERENCE: the paper gives no formulas; these splines are the only ones with as many degrees of
//! freedom as there are data.

use crate::guided::bb::{ENDS, End, bb_from_taylor, power, restrict, taylor, taylor_at, units};
use crate::linear::Matrix;
use crate::real::Real;

/// The knots of splines of `degree` 4 or 3 over the whole edge of a hole and over its outer part
/// `[sigma,1]`, each in `[0,1]`; none in higher degrees.
pub fn knots(degree: usize, sigma: Real) -> [Vec<Real>; 2] {
    let (one, half) = (Real::ONE, Real::ratio(1, 2));
    match degree {
        4 => [vec![sigma], vec![half]],
        3 => {
            let larger = one / (Real::from(2) - sigma);
            [vec![sigma * larger, larger], vec![one - larger, one - half * larger]]
        }
        _ => [vec![], vec![]],
    }
}

/// The ends of the interval and the knots between them.
pub fn lines(knots: &[Real]) -> Vec<Real> {
    [&[Real::ZERO], knots, &[Real::ONE]].concat()
}

/// The BB coefficients of the pieces between one or two knots, (degree + 1) rows each, on those of
/// the quintic with the same data at both ends; the degree is 5 less the number of knots.
pub fn spline(knots: &[Real]) -> Matrix {
    let (count, degree, lines) = (knots.len() + 1, 5 - knots.len(), lines(knots));
    let order = degree + 1;
    let width = |piece: usize| lines[piece + 1] - lines[piece];
    let mut system = Matrix::zeros(count * order, count * order);
    let mut right = Matrix::zeros(count * order, 6);
    let mut row = 0;
    for joint in 1..count {
        for k in 0..degree {
            for (piece, end, sign) in
                [(joint - 1, End::Finish, Real::ONE), (joint, End::Start, -Real::ONE)]
            {
                let taylor = taylor_at(degree, degree, end);
                let unit = sign / power(width(piece), k);
                (0..order).for_each(|i| system[(row, piece * order + i)] = unit * taylor[(k, i)]);
            }
            row += 1;
        }
    }
    for (piece, end) in [0, count - 1].into_iter().zip(ENDS) {
        let local = taylor_at(degree, 3, end);
        let given = &units(3, width(piece)) * &taylor_at(5, 3, end);
        for k in 0..3 {
            (0..order).for_each(|i| system[(row, piece * order + i)] = local[(k, i)]);
            right.set_row(row, given.row(k));
            row += 1;
        }
    }
    system.solve(&right).expect("a spline is determined by its data at the ends")
}

/// The quintics over `[0,sigma]` and `[sigma,1]` with the end data of the spline: what de
/// Casteljau's algorithm is for the quintic itself.
pub fn parts(knots: &[Real], sigma: Real) -> [Matrix; 2] {
    let (order, lines) = (6 - knots.len(), lines(knots));
    let piece = knots.iter().filter(|&&knot| knot < sigma).count();
    let width = lines[piece + 1] - lines[piece];
    let rows: Vec<usize> = (piece * order..(piece + 1) * order).collect();
    let local = (sigma - lines[piece]) / width;
    let middle = &taylor(order - 1, 3, local) * &spline(knots).select_rows(&rows);
    let middle = &units(3, Real::ONE / width) * &middle;
    let ends = ENDS.map(|end| taylor_at(5, 3, end));
    let quintic = |start: &Matrix, finish: &Matrix, width: Real| {
        let to_bb = |end, data: &Matrix| &(&bb_from_taylor(5, 3, end) * &units(3, width)) * data;
        to_bb(End::Start, start).above(&to_bb(End::Finish, finish))
    };
    [quintic(&ends[0], &middle, sigma), quintic(&middle, &ends[1], Real::ONE - sigma)]
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

    const SIGMAS: [(i32, i32); 4] = [(1, 5), (1, 2), (3, 5), (3, 4)];

    /// The value at `t` on the coefficients that `table` is on.
    fn value(knots: &[Real], table: &Matrix, t: Real) -> Matrix {
        let (order, lines) = (6 - knots.len(), lines(knots));
        let piece = knots.iter().filter(|&&knot| knot < t).count();
        let rows: Vec<usize> = (piece * order..(piece + 1) * order).collect();
        let local = (t - lines[piece]) / (lines[piece + 1] - lines[piece]);
        &taylor(order - 1, 1, local) * &table.select_rows(&rows)
    }

    #[test]
    fn splines_of_low_degree_are_reproduced() {
        // A cubic is both a quintic and a spline without knots.
        for (degree, (p, q)) in [3, 4].into_iter().flat_map(|d| SIGMAS.map(|sigma| (d, sigma))) {
            for knots in knots(degree, Real::ratio(p, q)) {
                let spline = &spline(&knots) * &raise(3, 5);
                let lines = lines(&knots);
                let cubic = lines.windows(2).map(|ends| {
                    let part = restrict(3, ends[0], ends[1]);
                    &raise(3, degree) * &part
                });
                let exact = cubic.reduce(|all, piece| all.above(&piece)).unwrap();
                assert!(largest(&(&spline - &exact)) < 1e-26, "degree {degree}");
            }
        }
    }

    #[test]
    fn the_parts_of_a_spline_are_splines_of_their_end_data() {
        for (degree, (p, q)) in [3, 4].into_iter().flat_map(|d| SIGMAS.map(|sigma| (d, sigma))) {
            let sigma = Real::ratio(p, q);
            let [whole, outer] = knots(degree, sigma);
            let [low, high] = parts(&whole, sigma);
            let (low, high) = (&spline(&whole) * &low, &spline(&outer) * &high);
            for k in 0..20 {
                let t = Real::ratio(2 * k + 1, 40);
                let exact = value(&whole, &spline(&whole), t);
                let found = if t < sigma {
                    value(&whole, &low, t / sigma)
                } else {
                    value(&outer, &high, (t - sigma) / (Real::ONE - sigma))
                };
                assert!(largest(&(&found - &exact)) < 1e-25, "degree {degree}, sigma {p}/{q}");
            }
        }
    }

    #[test]
    fn knots_are_equally_spaced_if_sigma_is_one_half() {
        for (degree, count) in [(4, 2), (3, 3)] {
            for knots in knots(degree, Real::ratio(1, 2)) {
                for (k, knot) in knots.into_iter().enumerate() {
                    let error = knot - Real::ratio(k as i32 + 1, count);
                    assert!(error.abs().to_f64() < 1e-31);
                }
            }
        }
    }
}
