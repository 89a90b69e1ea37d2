//! Univariate Bernstein-Bezier data at the ends of [0,1], and the splines of bi-4 and bi-3 rings.
//!
//! All functions are linear in the numbers they get; [`matrix`] makes tables of them.

/// A matrix by rows.
pub(super) type Matrix = Vec<Vec<f64>>;

/// The matrix of a linear map of `columns` numbers.
pub(super) fn matrix(columns: usize, map: impl Fn(&[f64]) -> Vec<f64>) -> Matrix {
    let unit = |k: usize| (0..columns).map(|i| f64::from(u8::from(i == k))).collect::<Vec<_>>();
    let images: Vec<Vec<f64>> = (0..columns).map(|k| map(&unit(k))).collect();
    (0..images[0].len()).map(|row| images.iter().map(|image| image[row]).collect()).collect()
}

/// The binomial coefficient C(n,k), exactly.
pub(super) fn choose(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

/// The Taylor coefficients of orders 0 to 3 or fewer, `count` of them, at t = 0 of the polynomial
/// with the BB coefficients `b`: C(d,r) times the r-th differences.
pub(super) fn taylor_at_start(b: &[f64], count: usize) -> Vec<f64> {
    let degree = b.len() - 1;
    let mut differences = b.to_vec();
    (0..count)
        .map(|r| {
            let order = choose_or_zero(degree, r) * differences.first().copied().unwrap_or(0.0);
            differences = differences.windows(2).map(|pair| pair[1] - pair[0]).collect();
            order
        })
        .collect()
}

fn choose_or_zero(n: usize, k: usize) -> f64 {
    if k > n { 0.0 } else { choose(n, k) }
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
    let coef = |i: usize| (0..=i).map(|r| choose(i, r) / choose(degree, r) * taylor[r]).sum();
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

/// The two halves of the polynomial `b`, by de Casteljau's algorithm.
fn bisected(b: &[f64]) -> [Vec<f64>; 2] {
    let (mut low, mut high, mut row) = (Vec::new(), Vec::new(), b.to_vec());
    while let (Some(&first), Some(&last)) = (row.first(), row.last()) {
        low.push(first);
        high.push(last);
        row = row.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    }
    high.reverse();
    [low, high]
}

/// The pieces of degree 4 or 3 that replace a quintic: the spline with the same position and
/// first two derivatives at both ends,
///
/// ```text
///   degree 4:   0 ---------- 1/2 ---------- 1        2 pieces, C3 at the joint
///   degree 3:   0 ------ 1/3 ------ 2/3 ---- 1       3 pieces, C2 at the joints
/// ```
///
/// The quintic itself is its only piece in degree 5, and so is any polynomial of degree 6.
pub(super) fn pieces(degree: usize, quintic: &[f64]) -> Vec<Vec<f64>> {
    let ends = |h: f64| {
        let start = bb_at_start(degree, &in_units(h, &taylor_at_start(quintic, 3)));
        let end = bb_at_end(degree, &in_units(h, &taylor_at_end(quintic, 3)));
        ([start[0], start[1], start[2]], [end[0], end[1], end[2]])
    };
    match degree {
        4 => {
            let ([c0, c1, c2], [d2, d3, d4]) = ends(0.5);
            let sum = 0.5 * (3.0 * (c2 + d2) - c1 - d3); // of c3 and d1, by C3
            let difference = 0.5 * (d2 - c2); // d1 - c3, by C2
            let (c3, d1) = (0.5 * (sum - difference), 0.5 * (sum + difference));
            let joint = 0.5 * (c3 + d1);
            vec![vec![c0, c1, c2, c3, joint], vec![joint, d1, d2, d3, d4]]
        }
        3 => {
            let ([c0, c1, c2], [e1, e2, e3]) = ends(1.0 / 3.0);
            // C2 at the joints: d2 - 2 d1 = c1 - 2 c2 and d1 - 2 d2 = e2 - 2 e1.
            let d1 = (4.0 * c2 - 2.0 * c1 + 2.0 * e1 - e2) / 3.0;
            let d2 = (4.0 * e1 - 2.0 * e2 + 2.0 * c2 - c1) / 3.0;
            let (d0, d3) = (0.5 * (c2 + d1), 0.5 * (d2 + e1));
            vec![vec![c0, c1, c2, d0], vec![d0, d1, d2, d3], vec![d3, e1, e2, e3]]
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

/// What stands for the two halves of a segment whose [`pieces`] have degree `degree`: for a spline
/// the quintics that have its data at 0, 1/2 and 1. The knots of a spline are among those of its
/// halves, so the pieces of the halves are the spline again.
pub(super) fn halves(degree: usize, b: &[f64]) -> [Vec<f64>; 2] {
    let pieces = pieces(degree, b);
    let middle = match pieces.as_slice() {
        [first, _] => in_units(2.0, &taylor_at_end(first, 3)),
        [_, middle, _] => in_units(3.0, &in_units(2.0, &taylor_at_end(&bisected(middle)[0], 3))),
        _ => return bisected(b),
    };
    let quintic = |start: &[f64], end: &[f64]| {
        let mut coefs = bb_at_start(5, &in_units(0.5, start));
        coefs.extend(bb_at_end(5, &in_units(0.5, end)));
        coefs
    };
    [quintic(&taylor_at_start(b, 3), &middle), quintic(&middle, &taylor_at_end(b, 3))]
}

#[cfg(test)]
mod tests {
    use super::*;

    const B: [f64; 6] = [0.3, -0.7, 0.2, 0.9, -0.4, 0.5];

    fn assert_equal(a: &[f64], b: &[f64]) {
        assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() < 1e-13, "{a} {b}");
        }
    }

    #[test]
    fn taylor_data_and_coefficients_at_an_end_are_inverse() {
        assert_equal(&bb_at_start(5, &taylor_at_start(&B, 3)), &B[..3]);
        assert_equal(&bb_at_end(5, &taylor_at_end(&B, 4)), &B[2..]);
        assert_equal(&taylor_at_start(&raised(&B, 6), 4), &taylor_at_start(&B, 4));
    }

    #[test]
    fn splines_are_as_smooth_as_their_degree_allows_and_keep_the_data_at_the_ends() {
        for degree in [3, 4] {
            let pieces = pieces(degree, &B);
            let h = num_pieces(degree) as f64;
            for joint in pieces.windows(2) {
                let [before, after] = [&joint[0], &joint[1]];
                assert_equal(&taylor_at_end(before, degree), &taylor_at_start(after, degree));
            }
            let start = in_units(h, &taylor_at_start(&pieces[0], 3));
            assert_equal(&start, &taylor_at_start(&B, 3));
            let end = in_units(h, &taylor_at_end(pieces.last().unwrap(), 3));
            assert_equal(&end, &taylor_at_end(&B, 3));
        }
    }

    #[test]
    fn the_pieces_of_the_halves_are_the_spline() {
        for degree in 3..=5 {
            let value = |pieces: &[Vec<f64>], t: f64| {
                let at = t * pieces.len() as f64;
                let k = (at as usize).min(pieces.len() - 1);
                let (t, d) = (at - k as f64, degree);
                let basis =
                    |i: usize| choose(d, i) * t.powi(i as i32) * (1.0 - t).powi((d - i) as i32);
                (0..=d).map(|i| basis(i) * pieces[k][i]).sum::<f64>()
            };
            let [low, high] = halves(degree, &B).map(|half| pieces(degree, &half));
            let whole = pieces(degree, &B);
            for k in 0..20 {
                let t = (f64::from(k) + 0.5) / 20.0;
                let found =
                    if t < 0.5 { value(&low, 2.0 * t) } else { value(&high, 2.0 * t - 1.0) };
                assert!((found - value(&whole, t)).abs() < 1e-13);
            }
        }
    }
}
