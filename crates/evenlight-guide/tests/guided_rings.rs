//! Laws of guided rings, whatever the guide and the net are.

use evenlight_guide::guided::bb::{End, monomials, raise, restrict};
use evenlight_guide::guided::cap::Cap;
use evenlight_guide::guided::characteristic::{CharacteristicRing, SQUARES, Square, sigma_of};
use evenlight_guide::guided::composition::{jet_at, product};
use evenlight_guide::guided::net::CNet;
use evenlight_guide::guided::rings::{Form, Rings, Squares, shrinking, side_data};
use evenlight_guide::guided::space::{MAX_TOTAL, basis, homogeneous};
use evenlight_guide::linear::Matrix;
use evenlight_guide::real::Real;

const FORMS: [Form; 4] = [Form::Bi6, Form::Bi5, Form::Bi4, Form::Bi3];

/// A reproducible number in [-1, 1) for every index.
fn scattered(index: usize) -> Real {
    let mixed = (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    Real::from((mixed >> 33) as i32 as f64 / (1u64 << 30) as f64 - 1.0)
}

fn largest(matrix: &Matrix) -> f64 {
    let entries = (0..matrix.num_rows()).flat_map(|i| matrix.row(i));
    entries.map(|x| x.abs().to_f64()).fold(0.0, f64::max)
}

/// Some guide with coefficients up to about 1, and some net.
fn guide_and_net(valence: usize) -> (Matrix, Matrix) {
    let guides = basis(valence, 0..=MAX_TOTAL);
    let mix = Matrix::from_fn(guides.num_columns(), 1, |k, _| scattered(k));
    let guide = &guides * &mix;
    let guide = guide.scaled(Real::ONE / Real::from(largest(&guide)));
    let net = Matrix::from_fn(CNet { valence }.num_nodes(), 1, |k, _| scattered(1000 + k));
    (guide, net)
}

/// The characteristic rings of Catmull-Clark and of two other speeds.
fn characteristic_rings(valence: usize) -> [CharacteristicRing; 3] {
    let of_speed = |p, q| CharacteristicRing::new(valence, sigma_of(valence, Real::ratio(p, q)));
    [CharacteristicRing::catmull_clark(valence), of_speed(1, 2), of_speed(7, 20)]
}

/// A piece of an edge: its ends in the unit interval, and the data across it in BB form along it.
struct Piece {
    from: Real,
    to: Real,
    data: Matrix,
}

/// How the patches of a ring lie.
struct Layout {
    form: Form,
    /// Patches per square and variable.
    count: usize,
    sigma: Real,
    /// The lines between the patches in an inner and an outer side.
    lines: [Vec<Real>; 2],
}

impl Layout {
    fn new(chi: &CharacteristicRing, form: Form) -> Self {
        let lines = form.lines(chi.sigma);
        Self { form, count: lines[0].len() - 1, sigma: chi.sigma, lines }
    }

    /// The widths of the patches of a square along u (or v).
    fn widths(&self, square: Square, along_u: bool) -> Vec<Real> {
        let is_inner = square == if along_u { Square::C } else { Square::A };
        let (side, lines) = match is_inner {
            true => (self.sigma, &self.lines[0]),
            false => (Real::ONE - self.sigma, &self.lines[1]),
        };
        lines.windows(2).map(|ends| side * (ends[1] - ends[0])).collect()
    }

    /// The patches of a square.
    fn patches(&self, ring: &Squares, square: Square) -> Vec<Matrix> {
        self.form.patches(square, self.sigma, &ring[square as usize])
    }

    /// The data across the side of patch `number`, in units of the ring.
    fn side(
        &self,
        square: Square,
        (number, patch): (usize, &Matrix),
        across_u: bool,
        end: End,
    ) -> Matrix {
        let place = if across_u { number / self.count } else { number % self.count };
        let width = self.widths(square, across_u)[place];
        &side_data(self.form.degree(), across_u, end, width) * patch
    }

    /// The patches along a side of a square, with the data across the side.
    fn along(&self, ring: &Squares, square: Square, across_u: bool, end: End) -> Vec<Matrix> {
        let patches = self.patches(ring, square);
        let last = if end == End::Start { 0 } else { self.count - 1 };
        let number =
            |k: usize| if across_u { self.count * last + k } else { self.count * k + last };
        let side = |k: usize| self.side(square, (k, &patches[k]), across_u, end);
        (0..self.count).map(|k| side(number(k))).collect()
    }

    /// The outer edge u = 1 (or v = 1) of a ring.
    fn outer_edge(&self, ring: &Squares, across_u: bool) -> Vec<Piece> {
        let first = if across_u { Square::A } else { Square::C };
        let mut from = Real::ZERO;
        let mut pieces = Vec::new();
        for square in [first, Square::B] {
            let widths = self.widths(square, !across_u);
            for (data, width) in
                self.along(ring, square, across_u, End::Finish).into_iter().zip(widths)
            {
                let to = from + width;
                pieces.push(Piece { from, to, data });
                from = to;
            }
        }
        pieces
    }

    /// The inner edge u = sigma (or v = sigma) in units of the next ring, of which it is u = 1.
    fn inner_edge(&self, ring: &Squares, across_u: bool) -> Vec<Piece> {
        let square = if across_u { Square::A } else { Square::C };
        let order = self.form.degree() + 1;
        let unit = |k: usize| (0..k).fold(Real::ONE, |power, _| power * self.sigma);
        let pieces = self.along(ring, square, across_u, End::Start).into_iter().enumerate();
        let piece = |(k, data): (usize, Matrix)| Piece {
            from: self.lines[0][k],
            to: self.lines[0][k + 1],
            data: Matrix::from_fn(3 * order, 1, |row, _| unit(row / order) * data[(row, 0)]),
        };
        pieces.map(piece).collect()
    }

    /// The largest difference between data along an edge; each new piece lies in one of `old`.
    fn jump(&self, old: &[Piece], new: &[Piece]) -> f64 {
        let jump = |new: &Piece| {
            let middle = (new.from + new.to) * Real::ratio(1, 2);
            let old = old.iter().find(|old| middle < old.to).expect("the edges are equally long");
            let local = |t: Real| (t - old.from) / (old.to - old.from);
            let part = restrict(self.form.degree(), local(new.from), local(new.to));
            largest(&(&(&Matrix::identity(3).kronecker(&part) * &old.data) - &new.data))
        };
        new.iter().map(jump).fold(0.0, f64::max)
    }

    /// The largest jump inside the ring of one sector.
    fn inner_jump(&self, ring: &Squares) -> f64 {
        let mut worst = 0.0f64;
        for square in SQUARES {
            let patches = self.patches(ring, square);
            for (k, patch) in patches.iter().enumerate() {
                for (across_u, step) in [(true, self.count), (false, 1)] {
                    let place = if across_u { k / self.count } else { k % self.count };
                    if place + 1 < self.count {
                        let before = self.side(square, (k, patch), across_u, End::Finish);
                        let next = (k + step, &patches[k + step]);
                        let after = self.side(square, next, across_u, End::Start);
                        worst = worst.max(largest(&(&before - &after)));
                    }
                }
            }
        }
        for (square, across_u) in [(Square::A, false), (Square::C, true)] {
            let before = self.along(ring, square, across_u, End::Finish);
            let after = self.along(ring, Square::B, across_u, End::Start);
            for (before, after) in before.iter().zip(&after) {
                worst = worst.max(largest(&(before - after)));
            }
        }
        worst
    }

    /// The jump across the line between the sectors of the two rings: there v = -u.
    fn jump_across_line(&self, behind: &Squares, ahead: &Squares) -> f64 {
        let order = self.form.degree() + 1;
        let ahead = self.along(ahead, Square::A, false, End::Start);
        let behind = self.along(behind, Square::C, true, End::Start);
        let mut worst = 0.0f64;
        for (ahead, behind) in ahead.iter().zip(&behind) {
            for row in 0..3 * order {
                let sign = if row / order == 1 { -Real::ONE } else { Real::ONE };
                worst = worst.max((ahead[(row, 0)] - sign * behind[(row, 0)]).abs().to_f64());
            }
        }
        worst
    }
}

#[test]
fn rings_join_each_other_and_the_surrounding_surface_with_second_derivatives() {
    for n in [3, 5, 8] {
        let (guide, net) = guide_and_net(n);
        for form in FORMS {
            for chi in characteristic_rings(n) {
                let (rings, layout) = (Rings::new(&chi, form), Layout::new(&chi, form));
                let surround = CNet { valence: n }.outer_data(form.degree());
                let mut before: Option<Vec<Squares>> = None;
                for level in 0..4 {
                    let ring = rings.ring(level, &guide, &net);
                    for s in 0..n {
                        let what = format!("{form:?}, n = {n}, level {level}, sector {s}");
                        assert!(layout.inner_jump(&ring[s]) < 1e-24, "{what}");
                        let across = layout.jump_across_line(&ring[(s + n - 1) % n], &ring[s]);
                        assert!(across < 1e-24, "{what}: {across:e}");
                        for (across_u, surround) in [true, false].into_iter().zip(&surround) {
                            let outside = match &before {
                                Some(before) => layout.inner_edge(&before[s], across_u),
                                None => vec![Piece {
                                    from: Real::ZERO,
                                    to: Real::ONE,
                                    data: surround * &turned(n, &net, s),
                                }],
                            };
                            let edge = layout.outer_edge(&ring[s], across_u);
                            let jump = layout.jump(&outside, &edge);
                            assert!(jump < 1e-24, "{what}: {jump:e}");
                        }
                    }
                    before = Some(ring);
                }
            }
        }
    }
}

/// The net as sector `s` sees it.
fn turned(valence: usize, net: &Matrix, s: usize) -> Matrix {
    let numbering = CNet { valence };
    let seen = |node| numbering.turned(node, s as isize);
    net.select_rows(&(0..numbering.num_nodes()).map(seen).collect::<Vec<_>>())
}

/// A polynomial sum a_ij u^i v^j of the sector coordinates of sector 0, i + j <= 2, as a guide over
/// the scaled domain: BB coefficients of the piece of sector 0.
fn piece(exponents: (usize, usize), scale: Real) -> Matrix {
    let one = monomials(5);
    let degree = exponents.0 + exponents.1;
    let factor = (0..degree).fold(Real::ONE, |power, _| power / scale);
    Matrix::from_fn(36, 1, |row, _| {
        factor * one[(row / 6, exponents.0)] * one[(row % 6, exponents.1)]
    })
}

#[test]
fn the_rings_of_the_characteristic_net_are_multiples_of_the_characteristic_ring() {
    for n in [3, 5, 6, 8, 10] {
        for form in [Form::Bi6, Form::Bi5] {
            for chi in characteristic_rings(n) {
                let rings = Rings::new(&chi, form);
                let up = raise(3, form.degree());
                let up = up.kronecker(&up);
                for (coordinate, exponents) in [(1, 0), (0, 1)].into_iter().enumerate() {
                    let guide = piece(exponents, chi.domain_scale());
                    let net = chi.net().columns(coordinate..coordinate + 1);
                    for square in SQUARES {
                        let k = square as usize;
                        let exact = &chi.square(square)[coordinate];
                        let exact = &up * &Matrix::from_fn(16, 1, |r, _| exact[(r / 4, r % 4)]);
                        let first =
                            &(&rings.first_on_guide[k] * &guide) + &(&rings.first_on_net[k] * &net);
                        assert!(largest(&(&first - &exact)) < 1e-27, "ring 0, n = {n}");
                        let later = &rings.later[k] * &(&shrinking(chi.lambda) * &guide);
                        let exact = exact.scaled(chi.lambda);
                        assert!(largest(&(&later - &exact)) < 1e-27, "ring 1, n = {n}");
                    }
                }
            }
        }
    }
}

#[test]
fn bi6_rings_of_a_quadratic_are_the_quadratic_of_the_characteristic_ring() {
    for n in [3, 5, 6, 8, 10] {
        for chi in characteristic_rings(n) {
            let rings = Rings::new(&chi, Form::Bi6);
            for exponents in [(2, 0), (1, 1), (0, 2)] {
                let guide = piece(exponents, chi.domain_scale());
                for square in SQUARES {
                    let found = &rings.later[square as usize] * &guide;
                    let found = Matrix::from_fn(7, 7, |i, j| found[(7 * i + j, 0)]);
                    let corner = [End::Start, End::Finish];
                    let [u, v] = chi.square(square).map(|patch| jet_at(&patch, 7, corner));
                    let exact = match exponents {
                        (2, 0) => product(&u, &u),
                        (1, 1) => product(&u, &v),
                        _ => product(&v, &v),
                    };
                    let error = largest(&(&jet_at(&found, 7, corner) - &exact));
                    assert!(error < 1e-24, "n = {n}, {square:?}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn the_cap_joins_the_last_ring_with_first_derivatives() {
    for (n, form) in [3, 5, 8].into_iter().flat_map(|n| [(n, Form::Bi6), (n, Form::Bi5)]) {
        let (guide, net) = guide_and_net(n);
        for chi in characteristic_rings(n) {
            let (rings, cap) = (Rings::new(&chi, form), Cap::new(&chi, form));
            let layout = Layout::new(&chi, form);
            let raised = Matrix::identity(2).kronecker(&raise(form.degree(), 6));
            let all_shrinking = Matrix::identity(n).kronecker(&shrinking(chi.lambda));
            let mut hole = guide.clone();
            for level in 0..3 {
                hole = &all_shrinking * &hole;
                let ring = rings.ring(level, &guide, &net);
                for (ring, piece) in ring.iter().zip(cap.pieces(&hole)) {
                    for across_u in [true, false] {
                        let outside = &layout.inner_edge(ring, across_u)[0].data;
                        let inside = &side_data(6, across_u, End::Finish, Real::ONE) * &piece;
                        let of_first_order: Vec<usize> = (0..2 * (form.degree() + 1)).collect();
                        let outside = &raised * &outside.select_rows(&of_first_order);
                        let inside = inside.select_rows(&(0..14).collect::<Vec<_>>());
                        let jump = largest(&(&outside - &inside));
                        assert!(jump < 1e-24, "{form:?}, n = {n}, level {level}: {jump:e}");
                    }
                }
            }
        }
    }
}

#[test]
fn constants_are_reproduced() {
    for n in [3, 5, 8] {
        let guide = Matrix::from_fn(36 * n, 1, |_, _| Real::ONE);
        let net = Matrix::from_fn(6 * n + 1, 1, |_, _| Real::ONE);
        for form in FORMS {
            let chi = CharacteristicRing::catmull_clark(n);
            let rings = Rings::new(&chi, form);
            for ring in (0..2).flat_map(|level| rings.ring(level, &guide, &net)) {
                for square in SQUARES {
                    for patch in form.patches(square, chi.sigma, &ring[square as usize]) {
                        let ones = Matrix::from_fn(patch.num_rows(), 1, |_, _| Real::ONE);
                        assert!(largest(&(&patch - &ones)) < 1e-27, "{form:?}, n = {n}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_parts_of_the_guide_are_eigenspaces() {
    // Shrinking multiplies the part of degree s by lambda^s: with the dimensions of the parts this
    // is the whole spectrum, and there are no Jordan blocks.
    for n in [3, 5, 6, 8] {
        for lambda in [CharacteristicRing::catmull_clark(n).lambda, Real::ratio(1, 2)] {
            let shrinking = Matrix::identity(n).kronecker(&shrinking(lambda));
            let mut eigenvalue = Real::ONE;
            for total in 0..=MAX_TOTAL {
                let part = homogeneous(n, total);
                let error = &(&shrinking * &part) - &part.scaled(eigenvalue);
                assert!(largest(&error) < 1e-28 * largest(&part).max(1.0), "n = {n}, {total}");
                eigenvalue = eigenvalue * lambda;
            }
        }
    }
}
