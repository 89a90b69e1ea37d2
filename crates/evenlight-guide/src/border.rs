//! The tensor-border of one sector: its L-net, its corner jets, and the sampling of a guide.
//!
//! Inside its last ring the surface has a hole of n sectors, each the size of one bi-4 patch. The
//! nodes of the d-net that determine position, first and second derivatives along the two outer
//! sides of a sector form an L: the 21 nodes (i, j), 0 <= i, j <= 4, that are not both above 2. In
//! Bernstein-Bezier (BB) form they give the coefficients b_kl at the same 21 places:
//!
//! ```text
//!   l=4  L L L                 O, R, L: the 3 x 3 coefficients of the 2-jets at the three corners;
//!   l=3  L L L                 on the rows and columns 2 they overlap.
//!   l=2  * * * R R             R ends on line s (k = 4), L on line s-1 (l = 4),
//!   l=1  O O * R R             O is the outer corner (k = l = 0).
//!   l=0  O O * R R
//!        k=0     k=4
//! ```
//!
//! Sampling a map f of the plane with the border of a parametrisation chi means: take the 2-jets
//! of f(chi) at the three corners, write them as bi-4 BB coefficients, and average where they
//! overlap ([KP23-EG, fig. 7]). The result is called *the averaged L-net* of f.

use crate::jet::Jet;
use crate::linear::Matrix;
use crate::real::Real;
use crate::spline::{bb_to_spline, spline_to_bb};

/// The number of places in an L-net.
pub const NUM_PLACES: usize = 21;

/// The places (i, j) of an L-net in the order of storage, i faster.
pub fn places() -> impl Iterator<Item = (usize, usize)> + Clone {
    (0..5).flat_map(|j| (0..5).map(move |i| (i, j))).filter(|&(i, j)| i < 3 || j < 3)
}

/// The number of the place (i, j) in the order of storage.
pub fn place_index(i: usize, j: usize) -> usize {
    if j < 3 { i + 5 * j } else { 15 + i + 3 * (j - 3) }
}

/// Whether the place belongs to the 3 x 3 block of the outer corner; the other twelve lie in the
/// two ends of the L.
pub fn is_outer(place: (usize, usize)) -> bool {
    place.0 < 3 && place.1 < 3
}

/// The 21 BB coefficients on the 21 nodes, the tensor product of [`spline_to_bb`]:
/// [KP23-EG, eq. 6].
pub fn net_to_bb() -> Matrix {
    along_the_l(&spline_to_bb())
}

/// The inverse of [`net_to_bb`].
pub fn bb_to_net() -> Matrix {
    along_the_l(&bb_to_spline())
}

/// The tensor product of a 5 x 5 matrix with itself, restricted to the L-net.
///
/// In one variable the rows 0..=2 of both conversions use the columns 0..=2 only, and the rows
/// 3 and 4 the columns 2..=4, so that no row of the L asks for one of the four missing places.
fn along_the_l(one: &Matrix) -> Matrix {
    let places: Vec<_> = places().collect();
    Matrix::from_fn(NUM_PLACES, NUM_PLACES, |row, column| {
        let ((k, l), (i, j)) = (places[row], places[column]);
        one[(k, i)] * one[(l, j)]
    })
}

/// The BB coefficients of a parametrisation (u, v) along the L, symmetric under exchange:
/// v at (k, l) is u at (l, k).
#[derive(Clone, Debug)]
pub struct Border {
    /// The first coordinate at each place.
    pub u: [Real; NUM_PLACES],
}

impl Border {
    /// The parameters (u, v) at the place (k, l).
    pub fn at(&self, k: usize, l: usize) -> (Real, Real) {
        (self.u[place_index(k, l)], self.u[place_index(l, k)])
    }

    /// The averaged L-net of a patch f of bi-degree `degree` over the unit square, sampled at
    /// `scale * (u, v)`: 21 rows on the BB coefficients of f, whose first index is the faster.
    pub fn sample(&self, scale: Real, degree: usize) -> Matrix {
        let corners = Corner::ALL.map(|corner| (corner, self.corner_rows(corner, scale, degree)));
        let mut rows = Matrix::zeros(NUM_PLACES, (degree + 1) * (degree + 1));
        for (row, place) in places().enumerate() {
            let jets: Vec<_> = corners
                .iter()
                .filter_map(|(corner, jets)| corner.own_place(place).map(|at| (at, jets)))
                .collect();
            let share = Real::ratio(1, jets.len() as i32);
            for ((k, l), jets) in jets {
                for (column, jet) in jets.iter().enumerate() {
                    rows[(row, column)] += share * jet[k][l];
                }
            }
        }
        rows
    }

    /// For each BB coefficient of f, the 3 x 3 bi-4 BB coefficients at `corner` of f(scale (u,v)).
    fn corner_rows(&self, corner: Corner, scale: Real, degree: usize) -> Vec<[[Real; 3]; 3]> {
        let coefs = |coordinate: fn((Real, Real)) -> Real| {
            Jet::from_bb(std::array::from_fn(|k| {
                std::array::from_fn(|l| {
                    let (k, l) = corner.turned((k, l));
                    scale * coordinate(self.at(k, l))
                })
            }))
        };
        let u = coefs(|(u, _)| u).bernstein(degree);
        let v = coefs(|(_, v)| v).bernstein(degree);
        v.iter().flat_map(|v| u.iter().map(|u| (*u * *v).to_bb())).collect()
    }
}

/// The three corners of the L at which jets are taken.
#[derive(Clone, Copy, Debug)]
enum Corner {
    Outer,
    Right,
    Left,
}

impl Corner {
    const ALL: [Self; 3] = [Self::Outer, Self::Right, Self::Left];

    /// Turns the corner to (0, 0) by changing indices; its own inverse.
    fn turned(self, (k, l): (usize, usize)) -> (usize, usize) {
        match self {
            Self::Outer => (k, l),
            Self::Right => (4 - k, l),
            Self::Left => (k, 4 - l),
        }
    }

    /// Where the place sits in the 3 x 3 block of this corner, if it is in the block.
    fn own_place(self, place: (usize, usize)) -> Option<(usize, usize)> {
        Some(self.turned(place)).filter(|&place| is_outer(place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::largest;

    #[test]
    fn places_are_numbered_in_their_order() {
        assert_eq!(places().count(), NUM_PLACES);
        assert!(places().enumerate().all(|(index, (i, j))| place_index(i, j) == index));
    }

    #[test]
    fn conversion_to_bb_form_is_invertible_along_the_l() {
        let identity = &net_to_bb() * &bb_to_net();
        assert_eq!(largest(&(&identity - &Matrix::identity(NUM_PLACES))), 0.0);
    }

    /// The regular parametrisation: the patch's parameters x, y run from the outer corner inwards,
    /// u = 1 - x and v = 1 - y.
    fn regular() -> Border {
        let mut u = [Real::ZERO; NUM_PLACES];
        for (k, l) in places() {
            u[place_index(k, l)] = Real::ONE - Real::ratio(k as i32, 4);
        }
        Border { u }
    }

    #[test]
    fn sampling_a_bi4_patch_regularly_returns_its_own_coefficients() {
        let rows = regular().sample(Real::ONE, 4);
        for (row, (k, l)) in places().enumerate() {
            for column in 0..25 {
                let own = column == (4 - k) + 5 * (4 - l);
                let expected = if own { Real::ONE } else { Real::ZERO };
                assert!((rows[(row, column)] - expected).abs().to_f64() < 1e-29);
            }
        }
    }
}
