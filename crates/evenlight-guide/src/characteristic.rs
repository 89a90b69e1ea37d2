//! The characteristic map of Catmull-Clark subdivision, along the border of its first ring.
//!
//! Around a vertex of valence n the two subdominant eigenvectors of Catmull-Clark subdivision form
//! one net in the plane that is symmetric under the n rotations and the mirrors in lines and
//! diagonals, and that refinement shrinks by
//!
//! ```text
//! lambda = (c + 5 + sqrt((c + 1)(c + 9))) / 16,   c = cos(2 pi / n).
//! ```
//!
//! We never leave *sector coordinates*: a point u e_(s-1) + v e_s of sector s, with e_s the unit
//! vector of line s, is written (u, v). As e_(s+1) = 2c e_s - e_(s-1), the cosine c is the only
//! irrational number needed, and (u, v) is at once the map chi^T = L^-1 chi of [KP23-EG, sec. 4],
//! L being the shear of the unit square to the sector's parallelogram. Up to symmetry six numbers
//! x_0..x_5 are the whole net:
//!
//! ```text
//!   line s                         c-net node (a, b): a steps along line s-1, b along line s
//!   (0,2) = (0,x1)   (1,2) = (x4,x5)   (2,2) = (x3,x3)
//!   (0,1) = (0,x0)   (1,1) = (x2,x2)   (2,1) = (x5,x4)
//!   (0,0) = (0, 0)   (1,0) = (x0, 0)   (2,0) = (x1, 0)      line s-1
//! ```

use crate::border::{Border, NUM_PLACES, net_to_bb, place_index, places};
use crate::linear::Matrix;
use crate::real::Real;
use crate::spline::{raised_cubic, refined_cubic};

/// The subdominant eigenvalue of Catmull-Clark subdivision at valence n >= 3.
pub fn lambda(valence: usize) -> Real {
    let c = Real::cos_of_turn(valence);
    let root = ((c + Real::ONE) * (c + Real::from(9))).sqrt();
    (c + Real::from(5) + root) / Real::from(16)
}

/// The characteristic net of one sector and what is made of it.
#[derive(Clone, Debug)]
pub struct CharacteristicMap {
    /// Its eigenvalue.
    pub lambda: Real,
    /// First coordinates of the nodes of the degree-raised net at the 21 places of the L-net; the
    /// second coordinate at (i, j) is the first at (j, i).
    pub net: [Real; NUM_PLACES],
    /// The same in BB form, as a parametrisation of the border.
    pub border: Border,
}

/// The characteristic map of valence n >= 3, scaled so that the two ends of the border, b_04 on
/// line s-1 and b_40 on line s, are (1, 0) and (0, 1).
pub fn characteristic_map(valence: usize) -> CharacteristicMap {
    let lambda = lambda(valence);
    let c = Real::cos_of_turn(valence);
    let raised = Matrix::from_fn(NUM_PLACES, 1, {
        let net = eigennet(c, lambda);
        let places: Vec<_> = places().collect();
        move |row, _| net.raised(places[row])
    });
    let border = &net_to_bb() * &raised;
    let scale = Real::ONE / border[(place_index(0, 4), 0)];
    let scaled = |column: &Matrix| std::array::from_fn(|row| scale * column[(row, 0)]);
    CharacteristicMap { lambda, net: scaled(&raised), border: Border { u: scaled(&border) } }
}

/// The net shrunk by `lambda`, scaled so that node (0,1) is (0,1).
///
/// With x_0 = 1 the other five are the solution of five of the six equations of (B - lambda) x = 0;
/// the sixth holds because `lambda` is an eigenvalue (a test checks it).
fn eigennet(c: Real, lambda: Real) -> PlaneNet {
    let shifted = &refinement_matrix(c) - &Matrix::identity(6).scaled(lambda);
    let equations = shifted.select_rows(&[1, 2, 3, 4, 5]);
    let right = equations.columns(0..1).scaled(-Real::ONE);
    let rest = equations.columns(1..6).solve(&right).expect("lambda is a simple eigenvalue of B");
    let x = std::array::from_fn(|k| if k == 0 { Real::ONE } else { rest[(k - 1, 0)] });
    PlaneNet { c, x }
}

/// The 6 x 6 matrix B of Catmull-Clark refinement on x_0..x_5.
fn refinement_matrix(c: Real) -> Matrix {
    let columns: Vec<[Real; 6]> = (0..6)
        .map(|k| {
            let x = std::array::from_fn(|m| if m == k { Real::ONE } else { Real::ZERO });
            PlaneNet { c, x }.refined()
        })
        .collect();
    Matrix::from_fn(6, 6, |row, column| columns[column][row])
}

/// A net in the plane with all the symmetries, given by x_0..x_5; `c` is the cosine of its turn.
struct PlaneNet {
    c: Real,
    x: [Real; 6],
}

impl PlaneNet {
    /// The first coordinate of the c-net node (a, b), -1 <= a, b <= 2, not both negative.
    fn u(&self, a: isize, b: isize) -> Real {
        let [x0, x1, x2, x3, x4, x5] = self.x;
        match (a, b) {
            (0, 0..) => Real::ZERO,
            (1, 0) => x0,
            (2, 0) => x1,
            (1, 1) => x2,
            (2, 2) => x3,
            (1, 2) => x4,
            (2, 1) => x5,
            // (-1, b) is (b, 1) of sector s+1, u' e_s + v' e_(s+1) = -v' e_(s-1) + ... e_s.
            (-1, _) => -self.u(1, b),
            // (a, -1) is (1, a) of sector s-1, u' e_(s-2) + v' e_(s-1), e_(s-2) = 2c e_(s-1) - e_s.
            (_, -1) => Real::from(2) * self.c * self.u(1, a) + self.u(a, 1),
            _ => unreachable!("the net has two layers: no node ({a}, {b})"),
        }
    }

    /// x_0..x_5 of the refined net.
    ///
    /// All its nodes except the centre follow the rules of tensor-product cubic splines; the centre
    /// is 0 by symmetry.
    fn refined(&self) -> [Real; 6] {
        [(1, 0), (2, 0), (1, 1), (2, 2), (1, 2), (2, 1)]
            .map(|(a, b)| self.combined(&refined_cubic(a), &refined_cubic(b)))
    }

    /// The first coordinate of the node at the place (i, j) of the degree-raised net.
    fn raised(&self, (i, j): (usize, usize)) -> Real {
        self.combined(&raised_cubic(3 - i as isize), &raised_cubic(3 - j as isize))
    }

    /// The tensor product of two univariate rules.
    fn combined(&self, along_a: &[(isize, Real)], along_b: &[(isize, Real)]) -> Real {
        let products = along_a
            .iter()
            .flat_map(|&(a, wa)| along_b.iter().map(move |&(b, wb)| wa * wb * self.u(a, b)));
        products.sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lambda_has_its_closed_forms() {
        let error = |n: usize, exact: Real| (lambda(n) - exact).abs().to_f64();
        let root = |x: i32| Real::from(x).sqrt();
        assert!(error(3, (Real::from(9) + root(17)) / Real::from(32)) < 1e-30);
        assert!(error(4, Real::ratio(1, 2)) < 1e-30);
        assert!(error(6, (Real::from(11) + root(57)) / Real::from(32)) < 1e-30);
    }

    #[test]
    fn refinement_shrinks_the_characteristic_net_by_lambda() {
        for n in 3..=16 {
            let net = eigennet(Real::cos_of_turn(n), lambda(n));
            for (new, old) in net.refined().into_iter().zip(net.x) {
                assert!((new - lambda(n) * old).abs().to_f64() < 1e-28, "valence {n}");
            }
        }
    }

    #[test]
    fn the_regular_characteristic_map_is_the_identity() {
        let chi = characteristic_map(4);
        for (k, l) in places() {
            let (u, v) = chi.border.at(k, l);
            assert!((u - Real::ratio(4 - k as i32, 4)).abs().to_f64() < 1e-30);
            assert!((v - Real::ratio(4 - l as i32, 4)).abs().to_f64() < 1e-30);
        }
    }

    #[test]
    fn the_outer_corner_moves_out_for_three_sectors_and_in_for_many() {
        for (n, t) in [(3, 1.5636), (5, 0.8330), (6, 0.7579)] {
            let (u, v) = characteristic_map(n).border.at(0, 0);
            assert!((u.to_f64() - t).abs() < 5e-5 && u == v, "valence {n}");
        }
    }
}
