//! The cap: one bi-6 patch per sector that closes the hole after any ring.
//!
//! The cap [KP18-Guided, App. B] has, in the unit square of the hole, u along line s-1, and for a
//! line with a the sector ahead and b the one behind (arguments exchanged),
//!
//! ```text
//! a_v + b_v = 2c (1-u)^2 a_u   on v = 0:     G1, with C1 at the far end u = 1;
//! ```
//!
//! The cap also continues the last ring with C1, and has the guide's second-order data at the
//! centre.
//!
//! **The map.** Rings sample the guide along chi; the cap samples it along a bi-6 map of the
//! sector ([`cap_map`]) that continues lambda chi with C1, satisfies the G1 condition with its
//! mirror image, and among these has the least F_5; 15 real parameters are free.
//!
//! **The patch** takes its coefficients from
//!
//! ```text
//!   r r r r r r r      r  two layers: first-order data of the last ring
//!   r r r r r r r      *  4 x 4 jets of the guide, averaged at index 3
//!   x * * * * r r      x  the curve over the line, of degree 5, from the G1 condition
//!   x a * * * r r      a  the sum over both sides from the G1 condition: each side gets
//!   x a * * * r r         half of what is missing
//!   * * a a * r r
//!   * * x x x r r
//! ```
//!
//! The inner data of a ring are the outer border of the next. So the whole cap depends on the
//! guide alone, and one table serves all rings. A cap is [`Cap::sampled`] on one piece of the
//! guide, followed by [`Cap::joined`], which couples neighbours.
//!
//! The last ring may also be a bi-5 ring; then its inner border is degree-raised.
//!
//! DIFFERENCE: the paper counts 14 free parameters of the map and does not give its last condition.

use crate::guided::bb::{End, bb_from_taylor, choose, raise, taylor_at};
use crate::guided::characteristic::CharacteristicRing;
use crate::guided::composition::sampled;
use crate::guided::fairness::functional;
use crate::guided::rings::{Form, guide_border};
use crate::guided::solutions::solutions;
use crate::linear::Matrix;
use crate::real::Real;

/// The bi-degree of the cap.
pub const DEGREE: usize = 6;

/// The coefficients along a row.
const ORDER: usize = DEGREE + 1;

/// The number of coefficients of a piece of the cap.
pub const COEFS: usize = ORDER * ORDER;

/// The functional that chooses the map.
const FUNCTIONAL: usize = 5;

/// The bi-6 map of the hole in sector coordinates, as the 7 x 7 BB coefficients of its first
/// coordinate; the second is the transpose. In the scale of chi continued to the unit square.
pub fn cap_map(chi: &CharacteristicRing) -> Matrix {
    let (conditions, right) = map_conditions(chi);
    let c = Real::cos_of_turn(chi.valence);
    // With V the transpose of U, F(U + c V) + s^2 F(V) = 2 F(U) + 2c F(U, V).
    let functional = functional(DEGREE, FUNCTIONAL);
    let transposed: Vec<usize> = (0..COEFS).map(mirrored).collect();
    let energy = &functional + &functional.select_columns(&transposed).scaled(c);
    let map = solutions(&conditions, &right).expect("the map exists").least(&energy);
    Matrix::from_fn(ORDER, ORDER, |i, j| map[(ORDER * i + j, 0)])
}

/// The number of the coefficient (j, i) for the number of (i, j).
fn mirrored(k: usize) -> usize {
    ORDER * (k % ORDER) + k / ORDER
}

/// The linear conditions on the 49 coefficients of the first coordinate U, V being the transpose:
/// U = 0 on line s; two layers on u = 1 and on v = 1; and on line s-1 the G1 condition with the
/// mirror image, U_v + c V_v = c (1-u)^2 U_u.
fn map_conditions(chi: &CharacteristicRing) -> (Matrix, Matrix) {
    let mut rows: Vec<(Vec<(usize, Real)>, Real)> = Vec::new();
    for j in 0..ORDER {
        rows.push((vec![(j, Real::ONE)], Real::ZERO));
    }
    let [first, second] = chi.border();
    for (border, transpose) in [(first, false), (second, true)] {
        let to_bb = &bb_from_taylor(DEGREE, 2, End::Finish) * &taylor_at(3, 2, End::Finish);
        let layers = &(&to_bb * &border) * &raise(3, DEGREE).transposed();
        for (layer, j) in (0..2).flat_map(|layer| (0..ORDER).map(move |j| (layer, j))) {
            let place = ORDER * (DEGREE - 1 + layer) + j;
            let place = if transpose { mirrored(place) } else { place };
            rows.push((vec![(place, Real::ONE)], layers[(layer, j)]));
        }
    }
    rows.extend(g1_conditions(Real::cos_of_turn(chi.valence)).map(|row| (row, Real::ZERO)));
    let mut conditions = Matrix::zeros(rows.len(), COEFS);
    for (row, (terms, _)) in rows.iter().enumerate() {
        terms.iter().for_each(|&(place, weight)| conditions[(row, place)] += weight);
    }
    let right = Matrix::from_fn(rows.len(), 1, |row, _| rows[row].1);
    (conditions, right)
}

/// The G1 condition of the map in BB form of degree 7, over 6.
fn g1_conditions(c: Real) -> impl Iterator<Item = Vec<(usize, Real)>> {
    let raised = raise(DEGREE, DEGREE + 1);
    (0..=DEGREE + 1).map(move |e| {
        let mut row = Vec::new();
        for i in 0..ORDER {
            let weight = raised[(e, i)];
            for (place, factor) in [((i, 1), Real::ONE), ((1, i), c)] {
                row.push((ORDER * place.0 + place.1, factor * weight));
            }
            for (place, factor) in [((i, 0), -Real::ONE), ((0, i), -c)] {
                row.push((ORDER * place.0 + place.1, factor * weight));
            }
        }
        // (1-u)^2 B_q^5 = C(5,q) / C(7,q) B_q^7
        if e < DEGREE {
            let weight = -(c * choose(DEGREE - 1, e) / choose(DEGREE + 1, e));
            row.push((ORDER * (e + 1), weight));
            row.push((ORDER * e, -weight));
        }
        row
    })
}

/// The cap of a characteristic ring.
#[derive(Clone, Debug)]
pub struct Cap {
    /// The valence n.
    pub valence: usize,
    /// The coefficients sampled from the guide and the last ring, 49 rows on the 36 coefficients of
    /// the sector's piece of the guide at the level of the hole (one more than the last ring's).
    pub sampled: Matrix,
}

impl Cap {
    /// The cap after any ring of the given form.
    ///
    /// # Panics
    ///
    /// If the rings are of bi-4 or bi-3 patches: their inner border is no polynomial.
    pub fn new(chi: &CharacteristicRing, form: Form) -> Self {
        assert!(form.degree() >= 5, "one patch cannot follow the pieces of a border");
        let first = cap_map(chi).scaled(chi.domain_scale());
        let map = [first.clone(), first.transposed()];
        let mut table = sampled(&map, DEGREE, 4);
        let raised = raise(form.degree(), DEGREE);
        let border = guide_border(chi, form);
        for (data, transpose) in border.iter().zip([false, true]) {
            let of_first_order: Vec<usize> = (0..2 * (form.degree() + 1)).collect();
            let to_bb = bb_from_taylor(DEGREE, 2, End::Finish);
            let layers = &to_bb.kronecker(&raised) * &data.select_rows(&of_first_order);
            for (k, place) in (COEFS - 2 * ORDER..COEFS).enumerate() {
                let place = if transpose { mirrored(place) } else { place };
                table.set_row(place, layers.row(k));
            }
        }
        Self { valence: chi.valence, sampled: table }
    }

    /// The coefficients of all pieces of the cap, 49 rows each, from the guide at the level of the
    /// hole, 36n rows.
    pub fn pieces(&self, guide: &Matrix) -> Vec<Matrix> {
        let size = guide.num_rows() / self.valence;
        let piece = |s: usize| guide.select_rows(&(size * s..size * (s + 1)).collect::<Vec<_>>());
        let before: Vec<Matrix> = (0..self.valence).map(|s| &self.sampled * &piece(s)).collect();
        self.joined(&before)
    }

    /// The sampled pieces changed along all lines such that they join with G1.
    pub fn joined(&self, before: &[Matrix]) -> Vec<Matrix> {
        let n = self.valence;
        let mut pieces = before.to_vec();
        for line in 0..n {
            let (ahead, behind) = (line, (line + n - 1) % n);
            for column in 0..before[0].num_columns() {
                let a = |i: usize, j: usize| before[ahead][(ORDER * i + j, column)];
                let b = |i: usize, j: usize| before[behind][(ORDER * j + i, column)];
                let join = LineJoin::new(Real::cos_of_turn(n), a, b);
                for (k, i) in [2, 3, 4].into_iter().enumerate() {
                    pieces[ahead][(ORDER * i, column)] = join.curve[k];
                    pieces[behind][(i, column)] = join.curve[k];
                }
                for (k, i) in [2, 3].into_iter().enumerate() {
                    pieces[ahead][(ORDER * i + 1, column)] += join.missing[k];
                    pieces[behind][(ORDER + i, column)] += join.missing[k];
                }
            }
        }
        pieces
    }
}

/// The solution of the G1 condition along a line, [KP18-Guided, eq. 7 and 8].
struct LineJoin {
    /// p_20, p_30, p_40.
    curve: [Real; 3],
    /// What is added on both sides to a_21, b_21 and to a_31, b_31.
    missing: [Real; 2],
}

impl LineJoin {
    fn new(c: Real, a: impl Fn(usize, usize) -> Real, b: impl Fn(usize, usize) -> Real) -> Self {
        let k = |x: i32| Real::from(x);
        let both = |i: usize, j: usize| a(i, j) + b(i, j);
        let (p0, p1, p5, p6) = (a(0, 0), both(1, 0) / k(2), a(5, 0), a(6, 0));
        let p2 = k(3) / (k(5) * c) * both(1, 1) + (k(6) - k(6) / c) / k(5) * p1 - p0 / k(5);
        let p4 = both(4, 1) / k(2) + c / k(15) * (p5 - p6);
        let p3 = (p0 + p6) / k(20) - (p1 + p5) * Real::ratio(3, 10) + (p2 + p4) * Real::ratio(3, 4);
        let sum_2 = -(c / k(15) * p0) + k(2) * c / k(5) * p1 + (k(2) - c) * p2 + c * p4
            - k(2) * c / k(5) * p5
            + c / k(15) * p6;
        let sum_3 = p0 / k(10) - k(3) / k(5) * p1
            + k(3) / k(2) * p2
            + (k(3) - c) / k(2) * p4
            + (k(1) - c) / k(10) * (p6 - k(6) * p5);
        let missing = [sum_2 - both(2, 1), sum_3 - both(3, 1)].map(|sum| sum / k(2));
        Self { curve: [p2, p3, p4], missing }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guided::characteristic::sigma_of;
    use crate::guided::space::{MAX_TOTAL, basis};
    use crate::linear::largest;

    fn characteristic_rings() -> Vec<CharacteristicRing> {
        let half = |n| CharacteristicRing::new(n, sigma_of(n, Real::ratio(1, 2)));
        let rings = [3, 5, 6, 8, 10].map(CharacteristicRing::catmull_clark);
        rings.into_iter().chain([half(3), half(7)]).collect()
    }

    const FORMS: [Form; 2] = [Form::Bi6, Form::Bi5];

    fn some_guide(n: usize) -> Matrix {
        let guides = basis(n, 0..=MAX_TOTAL);
        let mix = |k: usize| Real::ratio((7 * k as i32 + 3) % 11 - 5, 50);
        &guides * &Matrix::from_fn(guides.num_columns(), 1, |k, _| mix(k))
    }

    #[test]
    fn the_map_has_15_free_parameters_and_is_regular() {
        for chi in characteristic_rings() {
            let (conditions, right) = map_conditions(&chi);
            let free = solutions(&conditions, &right).unwrap().kernel.num_columns();
            assert_eq!(free, 15, "valence {}", chi.valence);
            let map = cap_map(&chi);
            for (u, v) in (0..=10).flat_map(|u| (0..=10).map(move |v| (u, v))) {
                let at = [u, v].map(|t| crate::guided::bb::taylor(6, 2, Real::ratio(t, 10)));
                let first = &(&at[0] * &map) * &at[1].transposed();
                let second = &(&at[0] * &map.transposed()) * &at[1].transposed();
                let area = first[(1, 0)] * second[(0, 1)] - first[(0, 1)] * second[(1, 0)];
                assert!(area.to_f64() > 0.2, "valence {}", chi.valence);
            }
        }
    }

    #[test]
    fn pieces_join_with_g1() {
        let rings = characteristic_rings();
        for (chi, form) in rings.iter().flat_map(|chi| FORMS.map(|form| (chi, form))) {
            let n = chi.valence;
            let guide = some_guide(n);
            let pieces = Cap::new(chi, form).pieces(&guide);
            let c = Real::cos_of_turn(n);
            let raised = raise(6, 7);
            for line in 0..n {
                let a = |i: usize, j: usize| pieces[line][(ORDER * i + j, 0)];
                let b = |i: usize, j: usize| pieces[(line + n - 1) % n][(ORDER * j + i, 0)];
                for e in 0..8 {
                    let across: Real = (0..ORDER)
                        .map(|i| raised[(e, i)] * (a(i, 1) + b(i, 1) - a(i, 0) - b(i, 0)))
                        .sum();
                    let along = match e {
                        0..6 => choose(5, e) / choose(7, e) * (a(e + 1, 0) - a(e, 0)),
                        _ => Real::ZERO,
                    };
                    let error = (across - (c + c) * along).abs().to_f64();
                    assert!(error < 1e-24 * largest(&guide), "n = {n}: {error:e}");
                }
                for i in 0..ORDER {
                    assert!((a(i, 0) - b(i, 0)).abs().to_f64() < 1e-24 * largest(&guide));
                }
            }
        }
    }

    #[test]
    fn second_order_data_at_the_centre_and_the_outer_layers_are_kept() {
        let rings = characteristic_rings();
        for (chi, form) in rings.iter().flat_map(|chi| FORMS.map(|form| (chi, form))) {
            let guide = some_guide(chi.valence);
            let cap = Cap::new(chi, form);
            for (s, piece) in cap.pieces(&guide).iter().enumerate() {
                let own = guide.select_rows(&(36 * s..36 * (s + 1)).collect::<Vec<_>>());
                let before = &cap.sampled * &own;
                for k in 0..COEFS {
                    let (i, j) = (k / ORDER, k % ORDER);
                    if i + j <= 2 || i >= 5 || j >= 5 {
                        let error = (piece[(k, 0)] - before[(k, 0)]).abs().to_f64();
                        assert!(error < 1e-24 * largest(&guide), "({i}, {j}): {error:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_cap_of_the_plane_is_the_map() {
        let rings = characteristic_rings();
        for (chi, form) in rings.iter().flat_map(|chi| FORMS.map(|form| (chi, form))) {
            let scale = chi.domain_scale();
            let map = cap_map(chi).scaled(scale);
            let cap = Cap::new(chi, form);
            let plane = Matrix::from_fn(36, 1, |k, _| Real::ratio(k as i32 / 6, 5));
            let piece = &cap.sampled * &plane;
            let exact = Matrix::from_fn(COEFS, 1, |k, _| map[(k / ORDER, k % ORDER)]);
            assert!(largest(&(&piece - &exact)) < 1e-26, "valence {}", chi.valence);
        }
    }
}
