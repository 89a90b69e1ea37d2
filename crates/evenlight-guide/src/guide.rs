//! One sector of the guide: a bi-5 patch g that follows the border of the net and the quadratic q.
//!
//! All that follows is linear in 27 numbers, the 21 nodes of the sector's L-net and q_1..q_6, and
//! is kept as matrices with these 27 columns. The patch g lives over the unit square in sector
//! coordinates, centre at (0,0), u along line s-1 and v along line s; chi^T parametrises its border
//! ([`crate::characteristic`]). It is built in three steps [KP23-EG, sec. 4; KP23-QAS, sec. 4.1].
//!
//! **1. The lines.** Along each line g is given by a map of total degree 5: the quintic edge
//! b_00..b_50 and the first layer b_01..b_41 beside it. The points next to the centre are q; the
//! three far points of the edge and the three of the layer are such that the averaged L-net of the
//! patch agrees with the net of the sector at the twelve places of the two ends of the L.
//! In total-degree points the sectors join with C1 across the line if the layers of both sides and
//! the edge satisfy b_a1' = 2(1-c) b_a0 + 2c b_(a+1)0 - b_a1. This holds: for q by its definition,
//! for the far points since the net is C2 across the line.
//!
//! ```text
//!   b_05
//!   b_04  b_14                 the 18 points of total degree 5 in use;
//!   b_03  b_13                 * = q_1..q_6
//!    *    b_12
//!    *     *    b_21  b_31  b_41
//!    *     *     *    b_30  b_40  b_50
//! ```
//!
//! **2. The inside, in degree bi-4.** A patch w of bi-degree 4 has the degree-reduced edges and the
//! same cross derivatives; its nine inner coefficients are such that the averaged L-net of w agrees
//! with the net at the nine places of the outer corner.
//!
//! **3. The guide, in degree bi-5.** g has the lines of step 1 exactly. Its inner 4 x 4
//! coefficients are the coefficients of the degree-raised w.

use crate::border::{Border, NUM_PLACES, is_outer, net_to_bb, places};
use crate::linear::Matrix;
use crate::quadratic::Q_POINTS;
use crate::real::Real;

/// The points of total degree 5 along the two lines: q_1..q_6, then the far points along line s-1
/// and those along line s.
#[rustfmt::skip]
const LINE_POINTS: [(usize, usize); 18] = [
    (0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (0, 2),
    (3, 0), (4, 0), (5, 0), (2, 1), (3, 1), (4, 1),
    (0, 3), (0, 4), (0, 5), (1, 2), (1, 3), (1, 4),
];

const NUM_Q: usize = Q_POINTS.len();

/// The sector of the guide: its 36 bi-5 BB coefficients, first index faster.
#[derive(Clone, Debug)]
pub struct Guide {
    /// The part that depends on the net: 36 rows on the 21 places of the L-net.
    pub on_net: Matrix,
    /// The part that depends on q: 36 rows on q_1..q_6.
    pub on_q: Matrix,
}

/// Builds the guide over the border of the characteristic map.
pub fn guide(border: &Border) -> Guide {
    let target = Target::of_net();
    let lines = line_points(border, &target);
    let inside = bi4_patch(border, &target, &lines);
    let mut g = &bi5_lines() * &lines;
    let raised = &raise_4_to_5() * &inside;
    for row in inner_rows(5) {
        g.set_row(row, raised.row(row));
    }
    let split = NUM_PLACES;
    Guide { on_net: g.columns(0..split), on_q: g.columns(split..split + NUM_Q) }
}

/// The required averaged L-net: the net itself in BB form, as rows on the 27 numbers. The rows of
/// the two ends come first, then the rows of the outer corner, with the numbers of their places.
struct Target {
    end_places: Vec<usize>,
    ends: Matrix,
    outer_places: Vec<usize>,
    outer: Matrix,
}

impl Target {
    fn of_net() -> Self {
        let rows = net_to_bb().beside(&Matrix::zeros(NUM_PLACES, NUM_Q));
        let numbered = || places().enumerate();
        let outer_places: Vec<_> =
            numbered().filter(|&(_, place)| is_outer(place)).map(|(row, _)| row).collect();
        let end_places: Vec<_> =
            numbered().filter(|&(_, place)| !is_outer(place)).map(|(row, _)| row).collect();
        let (ends, outer) = (rows.select_rows(&end_places), rows.select_rows(&outer_places));
        Self { end_places, ends, outer_places, outer }
    }
}

/// Step 1: the 18 line points. The six points of q are given; the twelve far points solve the
/// twelve equations of the two ends of the L.
fn line_points(border: &Border, target: &Target) -> Matrix {
    let equations = &border.sample(Real::ONE, 5).select_rows(&target.end_places) * &bi5_lines();
    let near = Matrix::zeros(NUM_Q, NUM_PLACES).beside(&Matrix::identity(NUM_Q));
    let by_q = &equations.columns(0..NUM_Q) * &near;
    let far = equations
        .columns(NUM_Q..LINE_POINTS.len())
        .solve(&(&target.ends - &by_q))
        .expect("the line ends determine value and derivatives there");
    near.above(&far)
}

/// Step 2: the 25 BB coefficients of w, its nine inner ones solving the equations of the corner.
fn bi4_patch(border: &Border, target: &Target, lines: &Matrix) -> Matrix {
    let mut w = &bi4_lines() * lines;
    let sampled = border.sample(Real::ONE, 4).select_rows(&target.outer_places);
    let missing = &target.outer - &(&sampled * &w);
    let inner = sampled
        .select_columns(&inner_rows(4))
        .solve(&missing)
        .expect("the jets at the outer corner and the ends determine the inner coefficients");
    for (k, row) in inner_rows(4).into_iter().enumerate() {
        w.set_row(row, inner.row(k));
    }
    w
}

/// The numbers of the coefficients of a bi-`degree` patch that are in neither of the two rows along
/// the lines.
fn inner_rows(degree: usize) -> Vec<usize> {
    let numbers = (2..=degree).flat_map(|b| (2..=degree).map(move |a| a + (degree + 1) * b));
    numbers.collect()
}

/// The rows along the lines of a bi-5 patch, on the 18 line points.
///
/// The edge is b_a0; the cross derivative 5 (b_a1 - b_a0), a quartic, is degree-raised to the
/// first layer b_a0 + a/5 (b_(a-1)1 - b_(a-1)0) + (1 - a/5) (b_a1 - b_a0).
fn bi5_lines() -> Matrix {
    on_both_lines(5, |line, a, layer| {
        let mut row = line.point(a, 0);
        if layer == 1 {
            row = sum(row, line.cross(a - 1), Real::ratio(a as i32, 5));
            if a < 5 {
                row = sum(row, line.cross(a), Real::ratio(5 - a as i32, 5));
            }
        }
        row
    })
}

/// The rows along the lines of a bi-4 patch, on the 18 line points.
///
/// The edge is the quintic, degree-reduced with ends and end derivatives kept; the cross derivative
/// is the same as for bi-5: first layer = edge + 5/4 (b_a1 - b_a0).
fn bi4_lines() -> Matrix {
    const REDUCED: [[i32; 6]; 5] = [
        [12, 0, 0, 0, 0, 0],
        [-3, 15, 0, 0, 0, 0],
        [1, -5, 10, 10, -5, 1],
        [0, 0, 0, 0, 15, -3],
        [0, 0, 0, 0, 0, 12],
    ];
    on_both_lines(4, |line, a, layer| {
        let edge = (0..6).fold([Real::ZERO; 18], |row, m| {
            sum(row, line.point(m, 0), Real::ratio(REDUCED[a][m], 12))
        });
        if layer == 0 { edge } else { sum(edge, line.cross(a), Real::ratio(5, 4)) }
    })
}

/// The matrix with the rows `row(line, a, layer)` along both lines of a patch, layers 0 and 1, and
/// zero rows inside.
fn on_both_lines(degree: usize, row: impl Fn(Line, usize, usize) -> [Real; 18]) -> Matrix {
    let order = degree + 1;
    let mut rows = Matrix::zeros(order * order, LINE_POINTS.len());
    for a in 0..order {
        for layer in 0..2.min(a + 1) {
            rows.set_row(a + order * layer, &row(Line::First, a, layer));
            rows.set_row(layer + order * a, &row(Line::Second, a, layer));
        }
    }
    rows
}

/// The two lines of the sector: line s-1, along u, and line s, along v.
#[derive(Clone, Copy)]
enum Line {
    First,
    Second,
}

impl Line {
    /// The line point number a along this line and b away from it, as a row.
    fn point(self, a: usize, b: usize) -> [Real; 18] {
        let wanted = match self {
            Self::First => (a, b),
            Self::Second => (b, a),
        };
        LINE_POINTS.map(|point| if point == wanted { Real::ONE } else { Real::ZERO })
    }

    /// b_a1 - b_a0.
    fn cross(self, a: usize) -> [Real; 18] {
        sum(self.point(a, 1), self.point(a, 0), -Real::ONE)
    }
}

/// `a + factor * b`.
fn sum(a: [Real; 18], b: [Real; 18], factor: Real) -> [Real; 18] {
    std::array::from_fn(|k| a[k] + factor * b[k])
}

/// Degree raising of a bi-4 patch: 36 rows on its 25 coefficients.
fn raise_4_to_5() -> Matrix {
    let one = Matrix::from_fn(6, 5, |a, b| match a.checked_sub(b) {
        Some(0) => Real::ratio(5 - a as i32, 5),
        Some(1) => Real::ratio(a as i32, 5),
        _ => Real::ZERO,
    });
    one.kronecker(&one)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::characteristic::characteristic_map;
    use crate::linear::largest;

    /// The net and q of f = u^i v^j, i + j <= 2, along the border; and its bi-5 coefficients.
    fn monomial(i: usize, j: usize, border: &Border) -> (Matrix, Matrix, Matrix) {
        let falling = |a: usize, m: usize| (0..m).map(|k| a as i32 - k as i32).product::<i32>();
        let q = Matrix::from_fn(6, 1, |row, _| {
            let (a, b) = Q_POINTS[row];
            let total = falling(5, i + j);
            Real::ratio(falling(a, i) * falling(b, j), total)
        });
        let g = Matrix::from_fn(36, 1, |row, _| {
            Real::ratio(falling(row % 6, i) * falling(row / 6, j), falling(5, i) * falling(5, j))
        });
        let bb = &border.sample(Real::ONE, 5) * &g;
        let net = net_to_bb().solve(&bb).unwrap();
        (net, q, g)
    }

    #[test]
    fn quadratic_functions_are_their_own_guides_at_every_valence() {
        for n in 3..=16 {
            let border = characteristic_map(n).border;
            let guide = guide(&border);
            for (i, j) in Q_POINTS {
                let (net, q, exact) = monomial(i, j, &border);
                let g = &(&guide.on_net * &net) + &(&guide.on_q * &q);
                assert!(largest(&(&g - &exact)) < 1e-28, "u^{i} v^{j}, valence {n}");
            }
        }
    }

    #[test]
    fn the_averaged_net_of_the_guide_is_the_given_one_at_the_ends() {
        for n in [3, 5, 8] {
            let border = characteristic_map(n).border;
            let guide = guide(&border);
            let sampled = border.sample(Real::ONE, 5);
            let target = Target::of_net();
            let by_net = &sampled * &guide.on_net;
            let error = &by_net.select_rows(&target.end_places) - &target.ends.columns(0..21);
            assert!(largest(&error) < 1e-28, "valence {n}");
            let by_q = (&sampled * &guide.on_q).select_rows(&target.end_places);
            assert!(largest(&by_q) < 1e-28, "valence {n}");
        }
    }
}
