//! Univariate Bernstein-Bezier data at the ends of [0,1], and the splines of bi-4 and bi-3 rings.
//!
//! All functions are linear in their arguments; [`matrix`] makes tables of them.

use crate::patch::basis::binomial;

/// A matrix by rows.
pub(super) type Matrix = Vec<Vec<f64>>;

/// The matrix of a linear map of `columns` numbers.
pub(super) fn matrix(columns: usize, map: impl Fn(&[f64]) -> Vec<f64>) -> Matrix {
    let unit = |k: usize| (0..columns).map(|i| f64::from(u8::from(i == k))).collect::<Vec<_>>();
    let images: Vec<Vec<f64>> = (0..columns).map(|k| map(&unit(k))).collect();
    (0..images[0].len()).map(|row| images.iter().map(|image| image[row]).collect()).collect()
}

/// The Taylor coefficients of orders 0 to 3 or fewer, `count` of them, at t = 0 of the polynomial
/// with the BB coefficients `b`: C(d,r) times the r-th differences.
pub(super) fn taylor_at_start(b: &[f64], count: usize) -> Vec<f64> {
    let degree = b.len() - 1;
    let mut differences = b.to_vec();
    (0..count)
        .map(|r| {
            let order = binomial_or_zero(degree, r) * differences.first().copied().unwrap_or(0.0);
            differences = differences.windows(2).map(|pair| pair[1] - pair[0]).collect();
            order
        })
        .collect()
}

fn binomial_or_zero(n: usize, k: usize) -> f64 {
    if k > n { 0.0 } else { binomial(n, k) }
}

/// The same at t = 1.
pub(super) fn taylor_at_end(b: &[f64], count: usize) -> Vec<f64> {
    let reversed: Vec<f64> = b.iter().rev().copied().collect();
    turned_round(taylor_at_start(&reversed, count))
}

/// Taylor coefficients in -t.
fn turned_round(mut taylor: Vec<f64>) -> Vec<f64> {
    taylor.iter_mut().skip(1).step_by(2).for_each(|t| *t = -*t);
    taylor
}

/// The first BB coefficients of degree `degree` from as many Taylor coefficients at t = 0:
/// b_i = sum over r <= i of C(i,r) / C(d,r) t_r.
pub(super) fn bb_at_start(degree: usize, taylor: &[f64]) -> Vec<f64> {
    let coef = |i: usize| (0..=i).map(|r| binomial(i, r) / binomial(degree, r) * taylor[r]).sum();
    (0..taylor.len()).map(coef).collect()
}

/// The last BB coefficients, in increasing index, from the Taylor coefficients at t = 1.
pub(super) fn bb_at_end(degree: usize, taylor: &[f64]) -> Vec<f64> {
    let mut coefs = bb_at_start(degree, &turned_round(taylor.to_vec()));
    coefs.reverse();
    coefs
}

/// Taylor coefficients in units `h` times as long.
pub(super) fn in_units(h: f64, taylor: &[f64]) -> Vec<f64> {
    let mut power = 1.0;
    let scaled = |t: &f64| {
        let result = power * t;
        power *= h;
        result
    };
    taylor.iter().map(scaled).collect()
}

/// The polynomial `b` in degree `degree`.
pub(super) fn raised(b: &[f64], degree: usize) -> Vec<f64> {
    (b.len()..=degree).fold(b.to_vec(), |b, d| {
        let at = |i: usize| b.get(i).copied().unwrap_or(0.0);
        let coef = |i: usize| {
            let before = if i == 0 { 0.0 } else { b[i - 1] };
            (i as f64 * before + (d - i) as f64 * at(i)) / d as f64
        };
        (0..=d).map(coef).collect()
    })
}

/// The polynomial `b` cut at `t` in two, by de Casteljau's algorithm.
fn cut(b: &[f64], t: f64) -> [Vec<f64>; 2] {
    let (mut low, mut high, mut row) = (Vec::new(), Vec::new(), b.to_vec());
    while let (Some(&first), Some(&last)) = (row.first(), row.last()) {
        low.push(first);
        high.push(last);
        row = row.windows(2).map(|pair| mix(pair[0], pair[1], t)).collect();
    }
    high.reverse();
    [low, high]
}

/// (1 - t) a + t b.
fn mix(a: f64, b: f64, t: f64) -> f64 {
    (1.0 - t) * a + t * b
}

/// The knots inside [0,1] of the splines of degree `degree` that replace quintics over the whole
/// edge of a hole, and over the outer part [sigma,1] of it.
///
/// Rings join C2 if splines keep their knots when the edge is cut at sigma. The inner part of the
/// edge is the edge of the next hole. So, with H and Z the knots in the two cases, the condition is
///
/// ```text
///   H is contained in   sigma H  +  {sigma}  +  sigma + (1 - sigma) Z.
///
///   degree 4, C3:   H = {sigma},         Z = {1/2}
///   degree 3, C2:   H = {sigma t, t},    Z = {1 - t, 1 - t/2},    t = 1 / (2 - sigma)
/// ```
///
/// A single knot must be sigma or, in the last part, come from Z. For two knots (sigma, t) is a
/// solution, too; ours are equally spaced for sigma = 1/2. There t - sigma is (1 - sigma)^2 t.
pub(super) fn knots(degree: usize, sigma: f64) -> [Vec<f64>; 2] {
    match degree {
        4 => [vec![sigma], vec![0.5]],
        3 => {
            let t = 1.0 / (2.0 - sigma);
            [vec![sigma * t, t], vec![(1.0 - sigma) * t, 0.5 + 0.5 * (1.0 - sigma) * t]]
        }
        _ => [vec![], vec![]],
    }
}

/// The pieces of degree 4 or 3 that replace a quintic: the spline with the same position and
/// first two derivatives at both ends,
///
/// ```text
///   degree 4:   0 ------------ x ---------- 1        2 pieces, C3 at the joint
///   degree 3:   0 ------ x ------ y ------- 1        3 pieces, C2 at the joints
/// ```
///
/// The quintic itself is its only piece in degree 5, and so is any polynomial of degree 6.
///
/// In terms of blossoms f: the data at an end are coefficients of the piece there. Coefficients
/// that two ends share are extrapolated, f(0,0,x,1) from f(0,0,x,0) and f(0,0,x,x), and the rest
/// follows inwards.
pub(super) fn pieces(knots: &[f64], quintic: &[f64]) -> Vec<Vec<f64>> {
    let degree = 5 - knots.len();
    let start = |h: f64| bb_at_start(degree, &in_units(h, &taylor_at_start(quintic, 3)));
    let end = |h: f64| bb_at_end(degree, &in_units(h, &taylor_at_end(quintic, 3)));
    match *knots {
        [x] => {
            let (c, d) = (start(x), end(1.0 - x));
            let f_00x1 = mix(c[1], c[2], 1.0 / x);
            let f_0x11 = mix(d[1], d[0], 1.0 / (1.0 - x));
            let f_0xx1 = mix(f_00x1, f_0x11, x);
            let (f_0xxx, f_xxx1) = (mix(c[2], f_0xx1, x), mix(f_0xx1, d[0], x));
            let joint = mix(f_0xxx, f_xxx1, x);
            vec![vec![c[0], c[1], c[2], f_0xxx, joint], vec![joint, f_xxx1, d[0], d[1], d[2]]]
        }
        [x, y] => {
            let (c, d) = (start(x), end(1.0 - y));
            let f_0xy = mix(c[1], c[2], y / x);
            let f_xy1 = mix(d[1], d[0], (1.0 - x) / (1.0 - y));
            let (f_xxy, f_xyy) = (mix(f_0xy, f_xy1, x), mix(f_0xy, f_xy1, y));
            let f_xxx = mix(c[2], f_xxy, x / y);
            let f_yyy = mix(f_xyy, d[0], (y - x) / (1.0 - x));
            vec![
                vec![c[0], c[1], c[2], f_xxx],
                vec![f_xxx, f_xxy, f_xyy, f_yyy],
                vec![f_yyy, d[0], d[1], d[2]],
            ]
        }
        _ => vec![quintic.to_vec()],
    }
}

/// The number of [`pieces`].
pub(super) fn num_pieces(degree: usize) -> usize {
    match degree {
        3 => 3,
        4 => 2,
        _ => 1,
    }
}

/// The two polynomials that stand for the parts, cut at `sigma`, of an edge with [`pieces`] between
/// `knots`: for a spline the quintics that have its data at 0, sigma and 1. All knots of the spline
/// are kept, see [`knots`], so the pieces of the parts are the spline again.
pub(super) fn parts(knots: &[f64], sigma: f64, b: &[f64]) -> [Vec<f64>; 2] {
    if knots.is_empty() {
        return cut(b, sigma);
    }
    let lines: Vec<f64> = [0.0].iter().chain(knots).chain(&[1.0]).copied().collect();
    let piece = knots.iter().filter(|&&knot| knot < sigma).count();
    let [from, to] = [lines[piece], lines[piece + 1]];
    let inner = &cut(&pieces(knots, b)[piece], (sigma - from) / (to - from))[0];
    let middle = in_units(1.0 / (sigma - from), &taylor_at_end(inner, 3));
    let quintic = |start: &[f64], end: &[f64], width: f64| {
        let mut coefs = bb_at_start(5, &in_units(width, start));
        coefs.extend(bb_at_end(5, &in_units(width, end)));
        coefs
    };
    let [start, end] = [taylor_at_start(b, 3), taylor_at_end(b, 3)];
    [quintic(&start, &middle, sigma), quintic(&middle, &end, 1.0 - sigma)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const B: [f64; 6] = [0.3, -0.7, 0.2, 0.9, -0.4, 0.5];

    const SIGMAS: [f64; 6] = [0.18, 0.35, 0.5, 0.584, 0.7, 0.76];

    fn assert_equal(a: &[f64], b: &[f64]) {
        assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() < 1e-12 * (1.0 + a.abs()), "{a} {b}");
        }
    }

    fn lines(knots: &[f64]) -> Vec<f64> {
        [0.0].iter().chain(knots).chain(&[1.0]).copied().collect()
    }

    #[test]
    fn taylor_data_and_coefficients_at_an_end_are_inverse() {
        assert_equal(&bb_at_start(5, &taylor_at_start(&B, 3)), &B[..3]);
        assert_equal(&bb_at_end(5, &taylor_at_end(&B, 4)), &B[2..]);
        assert_equal(&taylor_at_start(&raised(&B, 6), 4), &taylor_at_start(&B, 4));
    }

    #[test]
    fn knots_are_equally_spaced_if_sigma_is_one_half() {
        assert_eq!(knots(4, 0.5), [[0.5], [0.5]]);
        for knots in knots(3, 0.5) {
            assert_equal(&knots, &[1.0 / 3.0, 2.0 / 3.0]);
        }
    }

    #[test]
    fn knots_are_kept_when_the_edge_is_cut() {
        for (degree, sigma) in [3, 4].into_iter().flat_map(|d| SIGMAS.map(move |s| (d, s))) {
            let [whole, outer] = knots(degree, sigma);
            let inside = whole.iter().map(|x| sigma * x);
            let beyond = outer.iter().map(|x| sigma + (1.0 - sigma) * x);
            let kept: Vec<f64> = inside.chain([sigma]).chain(beyond).collect();
            for knots in [&whole, &outer] {
                assert!(lines(knots).windows(2).all(|pair| pair[1] - pair[0] > 0.03));
            }
            for x in whole {
                assert!(kept.iter().any(|y| (x - y).abs() < 1e-15), "{degree} {sigma}: {x}");
            }
        }
    }

    #[test]
    fn splines_are_as_smooth_as_their_degree_allows_and_keep_the_data_at_the_ends() {
        for (degree, sigma) in [3, 4].into_iter().flat_map(|d| SIGMAS.map(move |s| (d, s))) {
            for knots in knots(degree, sigma) {
                let (pieces, lines) = (pieces(&knots, &B), lines(&knots));
                let width = |k: usize| lines[k + 1] - lines[k];
                let data = |k: usize, taylor: &[f64]| in_units(1.0 / width(k), taylor);
                for k in 0..knots.len() {
                    let before = data(k, &taylor_at_end(&pieces[k], degree));
                    assert_equal(&before, &data(k + 1, &taylor_at_start(&pieces[k + 1], degree)));
                }
                let last = knots.len();
                assert_equal(&data(0, &taylor_at_start(&pieces[0], 3)), &taylor_at_start(&B, 3));
                assert_equal(&data(last, &taylor_at_end(&pieces[last], 3)), &taylor_at_end(&B, 3));
            }
        }
    }

    #[test]
    fn the_pieces_of_the_parts_are_the_spline() {
        let value = |knots: &[f64], pieces: &[Vec<f64>], t: f64| {
            let k = knots.iter().filter(|&&knot| knot < t).count();
            let lines = lines(knots);
            let (t, d) = ((t - lines[k]) / (lines[k + 1] - lines[k]), pieces[k].len() - 1);
            let basis =
                |i: usize| binomial(d, i) * t.powi(i as i32) * (1.0 - t).powi((d - i) as i32);
            (0..=d).map(|i| basis(i) * pieces[k][i]).sum::<f64>()
        };
        for (degree, sigma) in [3, 4, 5].into_iter().flat_map(|d| SIGMAS.map(move |s| (d, s))) {
            let [whole, outer] = knots(degree, sigma);
            let [low, high] = parts(&whole, sigma, &B);
            let (low, high) = (pieces(&whole, &low), pieces(&outer, &high));
            let spline = pieces(&whole, &B);
            for k in 0..20 {
                let t = (f64::from(k) + 0.5) / 20.0;
                let found = if t < sigma {
                    value(&whole, &low, t / sigma)
                } else {
                    value(&outer, &high, (t - sigma) / (1.0 - sigma))
                };
                let exact = value(&whole, &spline, t);
                assert!((found - exact).abs() < 1e-11, "{degree} {sigma} {t}: {found} {exact}");
            }
        }
    }
}
