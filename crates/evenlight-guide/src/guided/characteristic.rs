//! The characteristic ring of Catmull-Clark subdivision at any contraction.
//!
//! Catmull-Clark subdivision around an extraordinary point inserts a knot half way between the
//! point and the first knot line. Inserting it at sigma instead, 0 < sigma < 1, gives a family of
//! subdivisions whose subdominant eigenvalue, the larger root of
//!
//! ```text
//! lambda^2 - sigma (1 + sigma^2 + c (1 - sigma)^2) lambda + sigma^4 = 0,   c = cos(2 pi / n),
//! ```
//!
//! is the contraction of the rings [KP18-Guided, sec. 6.3]. sigma = 1/2 is Catmull-Clark
//! subdivision itself; at every valence some sigma has lambda = 1/2.
//!
//! The eigenvectors of lambda are a planar c-net. The net defines a ring chi of three bi-3 patches
//! per sector, and lambda chi continues chi with continuous second derivatives:
//!
//! ```text
//!   v=1     +------+-----+          A = [sigma,1] x [0,sigma]
//!           |  C   |  B  |          B = [sigma,1] x [sigma,1]
//!   v=sigma +------+-----+          C = [0,sigma] x [sigma,1]
//!           | next |  A  |
//!           | ring |     |          chi(sigma u, sigma v) continues as lambda chi(u, v)
//!           +------+-----+ u=1
//! ```
//!
//! As in [`crate::characteristic`] the plane has sector coordinates, so that all numbers are real
//! and the second coordinate is the first with arguments exchanged; this is chi in the coordinates
//! of the guide. It is scaled such that the ends of the outer border, chi(1,0) and chi(0,1), are
//! (1,0) and (0,1).
//!
//! DIFFERENCE: the paper takes other contractions from earlier work we have not seen; the family
//! by knot insertion at sigma is our reading.

use crate::guided::bb::power;
use crate::guided::net::CNet;
use crate::linear::Matrix;
use crate::real::Real;

/// A square of a ring, in the drawing of the module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Square {
    /// Along the first line of the sector, `[sigma,1] x [0,sigma]`.
    A,
    /// At the outer corner, `[sigma,1] x [sigma,1]`.
    B,
    /// Along the second line, `[0,sigma] x [sigma,1]`.
    C,
}

/// The squares of a ring in a sector.
pub const SQUARES: [Square; 3] = [Square::A, Square::B, Square::C];

impl Square {
    /// The image in the diagonal of the sector.
    pub fn mirrored(self) -> Self {
        match self {
            Self::A => Self::C,
            Self::B => Self::B,
            Self::C => Self::A,
        }
    }
}

/// The characteristic ring in one sector.
#[derive(Clone, Debug)]
pub struct CharacteristicRing {
    /// The valence n.
    pub valence: usize,
    /// The place of the inserted knot.
    pub sigma: Real,
    /// The subdominant eigenvalue.
    pub lambda: Real,
    net: [Real; 6],
    border: Matrix,
    squares: [Matrix; 3],
}

/// lambda at the knot `sigma` in (0,1).
pub fn lambda(valence: usize, sigma: Real) -> Real {
    let c = Real::cos_of_turn(valence);
    let rest = Real::ONE - sigma;
    let trace = sigma * (Real::ONE + sigma * sigma + c * rest * rest);
    let root = (trace * trace - Real::from(4) * power(sigma, 4)).sqrt();
    (trace + root) * Real::ratio(1, 2)
}

/// The sigma in (0,1) with the given `lambda`, which must lie in [0.3, 0.7].
///
/// By bisection: lambda increases with sigma; 110 halvings leave less than 1e-32.
pub fn sigma_of(valence: usize, wanted: Real) -> Real {
    let (mut low, mut high) = (Real::ZERO, Real::ONE);
    for _ in 0..110 {
        let middle = (low + high) * Real::ratio(1, 2);
        if lambda(valence, middle) < wanted { low = middle } else { high = middle }
    }
    low
}

impl CharacteristicRing {
    /// The ring of valence n >= 3 with the knot at `sigma`.
    pub fn new(valence: usize, sigma: Real) -> Self {
        let knots = Knots { sigma };
        let lambda = lambda(valence, sigma);
        let net = PlaneNet { c: Real::cos_of_turn(valence), x: eigennet(valence, lambda, &knots) };
        let border = &CNet { valence }.border() * &net.first_coordinates(valence);
        let scale = Real::ONE / border[(12, 0)];
        let squares = net.ring(&knots);
        Self {
            valence,
            sigma,
            lambda,
            net: net.x.map(|x| scale * x),
            border: Matrix::from_fn(4, 4, |i, j| scale * border[(4 * i + j, 0)]),
            squares: squares.map(|square| square.scaled(scale)),
        }
    }

    /// The ring of Catmull-Clark subdivision.
    pub fn catmull_clark(valence: usize) -> Self {
        Self::new(valence, Real::ratio(1, 2))
    }

    /// The BB coefficients, 4 x 4, of the two coordinates of a square.
    pub fn square(&self, square: Square) -> [Matrix; 2] {
        let of = |square: Square| &self.squares[square as usize];
        [of(square).clone(), of(square.mirrored()).transposed()]
    }

    /// The tensor border of the ring's c-net over the unit square, 4 x 4: the continuation of
    /// chi / lambda inwards. b_00 is no part of it and zero.
    pub fn border(&self) -> [Matrix; 2] {
        [self.border.clone(), self.border.transposed()]
    }

    /// The factor that brings the ring into the unit square, where the guide lives: 1 but for
    /// n = 3, whose corner chi(1,1) lies outside. The guide is sampled at this multiple of chi.
    pub fn domain_scale(&self) -> Real {
        let corner = self.border[(3, 3)];
        if corner > Real::ONE { Real::ONE / corner } else { Real::ONE }
    }

    /// The c-net of the ring, numbered by [`CNet::index`], in the sector coordinates of sector 0:
    /// 6n + 1 rows, two columns.
    pub fn net(&self) -> Matrix {
        let net = PlaneNet { c: Real::cos_of_turn(self.valence), x: self.net };
        let first = net.first_coordinates(self.valence);
        let numbering = CNet { valence: self.valence };
        Matrix::from_fn(numbering.num_nodes(), 2, |node, coordinate| match coordinate {
            0 => first[(node, 0)],
            _ => first[(numbering.mirrored(node), 0)],
        })
    }
}

/// The nodes x_0..x_5 = (1,0), (2,0), (1,1), (2,2), (1,2), (2,1) with x_0 = 1: the solution of five
/// of the six equations of (B - lambda) x = 0.
fn eigennet(valence: usize, lambda: Real, knots: &Knots) -> [Real; 6] {
    let c = Real::cos_of_turn(valence);
    let columns: Vec<[Real; 6]> = (0..6)
        .map(|k| {
            let x = std::array::from_fn(|m| if m == k { Real::ONE } else { Real::ZERO });
            PlaneNet { c, x }.refined(knots)
        })
        .collect();
    let refinement = Matrix::from_fn(6, 6, |row, column| columns[column][row]);
    let shifted = &refinement - &Matrix::identity(6).scaled(lambda);
    let equations = shifted.select_rows(&[1, 2, 3, 4, 5]);
    let right = equations.columns(0..1).scaled(-Real::ONE);
    let rest = equations.columns(1..6).solve(&right).expect("lambda is a simple eigenvalue of B");
    std::array::from_fn(|k| if k == 0 { Real::ONE } else { rest[(k - 1, 0)] })
}

/// The places of x_0..x_5.
const PLACES: [(usize, usize); 6] = [(1, 0), (2, 0), (1, 1), (2, 2), (1, 2), (2, 1)];

/// A net in the plane with all the symmetries, in sector coordinates.
struct PlaneNet {
    c: Real,
    x: [Real; 6],
}

impl PlaneNet {
    /// The first coordinates of the nodes (a, b), -1 <= a, b <= 2, at (a + 1, b + 1).
    fn grid(&self) -> Matrix {
        let inner = Matrix::from_fn(3, 3, |a, b| {
            PLACES.iter().position(|&place| place == (a, b)).map_or(Real::ZERO, |k| self.x[k])
        });
        extended(&inner, self.c)
    }

    /// The first coordinates of the nodes (a, b), -1 <= a, b <= 3, after knot insertion.
    fn refined_grid(&self, knots: &Knots) -> Matrix {
        let insertion = knots.insertion();
        let mut inner = &(&insertion * &self.grid()) * &insertion.transposed();
        inner[(0, 0)] = Real::ZERO; // by symmetry, whatever its rule
        extended(&inner, self.c)
    }

    /// x_0..x_5 of the net on uniform knots of spacing sigma.
    fn refined(&self, knots: &Knots) -> [Real; 6] {
        let near = self.refined_grid(knots);
        let near = Matrix::from_fn(3, 3, |a, b| near[(a + 1, b + 1)]);
        let uniform = knots.uniform();
        let nodes = &(&uniform * &near) * &uniform.transposed();
        PLACES.map(|place| nodes[place])
    }

    /// The first coordinates of the squares A, B, C of the ring, 4 x 4.
    fn ring(&self, knots: &Knots) -> [Matrix; 3] {
        let grid = self.refined_grid(knots);
        let (outer, inner) = (knots.outer_segment(), knots.inner_segment());
        let patch = |along_u: (&Matrix, usize), along_v: (&Matrix, usize)| {
            let nodes = Matrix::from_fn(4, 4, |a, b| grid[(a + along_u.1, b + along_v.1)]);
            &(along_u.0 * &nodes) * &along_v.0.transposed()
        };
        let (outer, inner) = ((&outer, 1), (&inner, 0));
        [patch(outer, inner), patch(outer, outer), patch(inner, outer)]
    }

    /// The first coordinates, in sector 0, of all nodes.
    fn first_coordinates(&self, valence: usize) -> Matrix {
        let net = CNet { valence };
        let mut column = Matrix::zeros(net.num_nodes(), 1);
        for sector in 0..valence as isize {
            for (a, b) in [(0, 1), (0, 2), (1, 1), (1, 2), (2, 1), (2, 2)] {
                let x = |place| {
                    PLACES.iter().position(|&p| p == place).map_or(Real::ZERO, |k| self.x[k])
                };
                let own = (x((a, b)), x((b, a)));
                let two_c = self.c + self.c;
                // u e_(s-1) + v e_s = -v e_(s-2) + (u + 2c v) e_(s-1)
                let (u, _) = (0..sector).fold(own, |(u, v), _| (-v, u + two_c * v));
                column[(net.index(sector, a as isize, b as isize), 0)] = u;
            }
        }
        column
    }
}

/// The grid with the nodes of the neighbours at index -1 put before: (-1, b) is (b, 1) of the next
/// sector, where u' e_s + v' e_(s+1) = -v' e_(s-1) + ..; (a, -1) is (1, a) of the one before, where
/// e_(s-2) = 2c e_(s-1) - e_s.
fn extended(inner: &Matrix, c: Real) -> Matrix {
    let order = inner.num_rows() + 1;
    Matrix::from_fn(order, order, |a, b| match (a.checked_sub(1), b.checked_sub(1)) {
        (Some(a), Some(b)) => inner[(a, b)],
        (None, Some(b)) => -inner[(1, b)],
        (Some(a), None) => Real::from(2) * c * inner[(1, a)] + inner[(a, 1)],
        (None, None) => Real::ZERO, // in no rule
    })
}

/// Cubic splines on the knots .., -2, -1, 0, 1, 2, 3, .. with sigma and -sigma inserted. The new
/// nodes are the blossoms d'_0 = (-sigma, 0, sigma), d'_1 = (0, sigma, 1), d'_2 = (sigma, 1, 2),
/// d'_3 = d_2.
struct Knots {
    sigma: Real,
}

impl Knots {
    /// d'_0..d'_3 from d_-1..d_2.
    fn insertion(&self) -> Matrix {
        let (s, one, third) = (self.sigma, Real::ONE, Real::ratio(1, 3));
        let outer = (one - s * s) * Real::ratio(1, 6);
        let mut rows = Matrix::zeros(4, 4);
        rows.set_row(0, &[outer, one - outer - outer, outer, Real::ZERO]);
        rows.set_row(1, &[Real::ZERO, one - (one + s) * third, (one + s) * third, Real::ZERO]);
        rows.set_row(2, &[Real::ZERO, Real::ZERO, one - s * third, s * third]);
        rows[(3, 3)] = one;
        rows
    }

    /// The nodes 0, 1, 2 on uniform knots of spacing sigma, from d'_0, d'_1, d'_2.
    fn uniform(&self) -> Matrix {
        let (s, one) = (self.sigma, Real::ONE);
        let d = unit_rows::<3>();
        // q(x, y), the blossom at (sigma, x, y): from q(0, -sigma), q(0, 1), q(1, 2).
        let y = Real::from(3) * s;
        let q0 = mix(d[0], d[1], (y + s) / (one + s));
        let q1 = mix(d[1], d[2], y * Real::ratio(1, 2));
        let first = mix(d[0], d[1], Real::from(3) * s / (one + s));
        matrix(&[d[0], first, mix(q0, q1, s + s)])
    }

    /// The BB coefficients over [sigma, 1] from d'_0..d'_3.
    fn outer_segment(&self) -> Matrix {
        let (s, one, two) = (self.sigma, Real::ONE, Real::from(2));
        let d = unit_rows::<4>();
        let b1 = mix(d[1], d[2], s * Real::ratio(1, 2));
        let b2 = mix(d[1], d[2], Real::ratio(1, 2));
        let near = mix(d[0], d[1], two * s / (one + s));
        let far = mix(d[2], d[3], (one - s) / (Real::from(3) - s));
        matrix(&[mix(near, b1, s), b1, b2, mix(b2, far, (one - s) / (two - s))])
    }

    /// The BB coefficients over [0, sigma] from d'_-1..d'_2.
    fn inner_segment(&self) -> Matrix {
        let (s, one) = (self.sigma, Real::ONE);
        let d = unit_rows::<4>();
        let b1 = mix(d[1], d[2], s / (one + s));
        let before = mix(d[1], d[0], s / (one + s));
        let b2 = mix(d[1], d[2], Real::from(2) * s / (one + s));
        let far = mix(d[2], d[3], s * Real::ratio(1, 2));
        matrix(&[mix(before, b1, Real::ratio(1, 2)), b1, b2, mix(b2, far, s)])
    }
}

fn unit_rows<const N: usize>() -> [[Real; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { Real::ONE } else { Real::ZERO }))
}

/// (1 - t) a + t b.
fn mix<const N: usize>(a: [Real; N], b: [Real; N], t: Real) -> [Real; N] {
    std::array::from_fn(|k| (Real::ONE - t) * a[k] + t * b[k])
}

fn matrix<const N: usize>(rows: &[[Real; N]]) -> Matrix {
    Matrix::from_fn(rows.len(), N, |i, j| rows[i][j])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::characteristic::{characteristic_map, lambda as catmull_clark_lambda};
    use crate::guided::bb::{End, taylor_at, units};
    use crate::linear::largest;

    const SIGMAS: [(i32, i32); 3] = [(3, 10), (1, 2), (7, 10)];

    #[test]
    fn at_one_half_it_is_catmull_clark_subdivision() {
        for n in 3..=16 {
            let ring = CharacteristicRing::catmull_clark(n);
            assert!((ring.lambda - catmull_clark_lambda(n)).abs().to_f64() < 1e-30);
            let corner = characteristic_map(n).border.at(0, 0).0; // there by way of bi-4 patches
            assert!((ring.border[(3, 3)] - corner).abs().to_f64() < 1e-28, "valence {n}");
        }
    }

    #[test]
    fn refinement_shrinks_the_net_by_lambda() {
        for n in [3, 5, 6, 8, 16] {
            for sigma in SIGMAS.map(|(p, q)| Real::ratio(p, q)) {
                let ring = CharacteristicRing::new(n, sigma);
                let net = PlaneNet { c: Real::cos_of_turn(n), x: ring.net };
                for (new, old) in net.refined(&Knots { sigma }).into_iter().zip(ring.net) {
                    assert!((new - ring.lambda * old).abs().to_f64() < 1e-28, "valence {n}");
                }
            }
        }
    }

    #[test]
    fn the_speed_is_adjustable() {
        for n in [3, 5, 6, 7, 8, 9, 10, 16] {
            for wanted in [3, 4, 5, 6, 7].map(|k| Real::ratio(k, 10)) {
                let error = lambda(n, sigma_of(n, wanted)) - wanted;
                assert!(error.abs().to_f64() < 1e-30, "valence {n}");
            }
        }
        let half = |n| sigma_of(n, Real::ratio(1, 2)).to_f64();
        for (n, sigma) in [(3, 0.58398982975079), (5, 0.44856558088336), (8, 0.38381603854457)] {
            assert!((half(n) - sigma).abs() < 1e-14);
        }
    }

    #[test]
    fn the_next_ring_joins_with_continuous_second_derivatives() {
        for n in [3, 5, 6, 8, 16] {
            for sigma in SIGMAS.map(|(p, q)| Real::ratio(p, q)) {
                let ring = CharacteristicRing::new(n, sigma);
                // Along u = sigma: A from outside, lambda times the border, shrunk, from inside.
                let [outside, _] = ring.square(Square::A);
                let [inside, _] = ring.border();
                let across = |end, h| &units(3, Real::ONE / h) * &taylor_at(3, 3, end);
                let outside = &across(End::Start, Real::ONE - sigma) * &outside;
                let inside = &across(End::Finish, sigma) * &inside.scaled(ring.lambda);
                assert!(largest(&(&outside - &inside)) < 1e-26, "valence {n}");
            }
        }
    }

    #[test]
    fn the_ends_of_the_border_are_the_units_and_only_valence_3_leaves_the_square() {
        for n in [3, 5, 6, 7, 10, 16] {
            let ring = CharacteristicRing::catmull_clark(n);
            assert_eq!(ring.border[(3, 0)].to_f64(), 1.0);
            assert!(ring.border[(0, 3)].abs().to_f64() < 1e-30);
            let corner = ring.border[(3, 3)].to_f64();
            assert_eq!(corner > 1.0, n == 3);
            assert!((ring.domain_scale().to_f64() - 1.0f64.min(1.0 / corner)).abs() < 1e-15);
        }
    }
}
