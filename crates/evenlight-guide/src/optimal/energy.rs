//! The energy of a ring: integrals of squared derivatives with respect to the characteristic map.
//!
//! For a function f on the ring, with X, Y the Cartesian coordinates of the characteristic map chi
//! of Catmull-Clark subdivision, scaled such that lines end at distance 1,
//!
//! ```text
//!   |D^k f|^2 = integral over the ring of  sum_(i=0..k) C(k,i) (d_X^(k-i) d_Y^i f)^2  dX dY,
//! ```
//!
//! by 6 x 6 Gauss points per patch. It is invariant under rotations and mirrors of the plane.
//! Square C of a sector is the mirror image of square A, and so nothing is computed for it.

use crate::guided::bb::{choose, restrict};
use crate::guided::characteristic::{CharacteristicRing, Square};
use crate::guided::fairness::{add_square, derivatives_in_plane, gauss_nodes};
use crate::linear::Matrix;
use crate::optimal::block::{Block, HalfTurns};
use crate::optimal::nets::{RingPatch, Spline};
use crate::real::Real;

/// The energies of one patch of a ring, and the products that compare it with quadratics.
#[derive(Clone, Debug)]
pub struct PatchEnergy {
    /// The patch.
    pub patch: RingPatch,
    /// How often it counts in a sector: square A twice, for itself and for square C.
    pub count: Real,
    /// |D^2 f|^2 as a matrix on the BB coefficients.
    pub second: Matrix,
    /// |D^3 f|^2 as a matrix on the BB coefficients.
    pub third: Matrix,
    /// The products <D^2 f, D^2 m> with m = X^2 - Y^2, 2XY, X^2 + Y^2, as rows on the BB
    /// coefficients. The X-axis is the diagonal of the sector.
    pub quadratics: [Vec<Real>; 3],
    /// The area.
    pub area: Real,
}

/// The second derivatives d_XX, d_XY, d_YY of X^2 - Y^2, 2XY, X^2 + Y^2.
const HESSIANS: [[i32; 3]; 3] = [[2, 0, -2], [0, 2, 0], [2, 0, 2]];

/// The patches of a sector with their energies.
pub fn ring_energies(valence: usize, spline: Spline) -> Vec<PatchEnergy> {
    let chi = CharacteristicRing::catmull_clark(valence);
    let half_turn = HalfTurns::new(valence).power(1);
    let squares = [Square::A, Square::B].into_iter().zip(spline.ring());
    let patches = squares.flat_map(|(square, patches)| {
        let [u, v] = chi.square(square);
        let plane = [(&u + &v).scaled(half_turn.re), (&v - &u).scaled(half_turn.im)];
        let count = Real::from(if square == Square::A { 2 } else { 1 });
        patches.into_iter().map(move |patch| energy(patch, &plane, spline, count))
    });
    patches.collect()
}

fn energy(patch: RingPatch, square: &[Matrix; 2], spline: Spline, count: Real) -> PatchEnergy {
    let plane = part_of(square, patch.part, spline.split());
    let size = patch.old.len();
    let zeros = || vec![Real::ZERO; size];
    let mut found = PatchEnergy {
        patch,
        count,
        second: Matrix::zeros(size, size),
        third: Matrix::zeros(size, size),
        quadratics: [zeros(), zeros(), zeros()],
        area: Real::ZERO,
    };
    let nodes = gauss_nodes();
    for (u, weight_u) in nodes {
        for (v, weight_v) in nodes {
            found.add_point(&plane, spline.degree(), [u, v], weight_u * weight_v);
        }
    }
    found
}

/// The cubic patches over one part of a square.
fn part_of(square: &[Matrix; 2], part: [usize; 2], split: usize) -> [Matrix; 2] {
    let restriction = part.map(|k| {
        restrict(3, Real::ratio(k as i32, split as i32), Real::ratio(k as i32 + 1, split as i32))
    });
    square.each_ref().map(|patch| &(&restriction[0] * patch) * &restriction[1].transposed())
}

impl PatchEnergy {
    fn add_point(&mut self, plane: &[Matrix; 2], degree: usize, at: [Real; 2], weight: Real) {
        for order in [2, 3] {
            let (derivatives, area) = derivatives_in_plane(plane, degree, order, at);
            let weight = weight * area;
            for i in 0..=order {
                let (row, weight) = (derivatives.row(i), weight * choose(order, i));
                let sum = if order == 2 { &mut self.second } else { &mut self.third };
                add_square(sum, row, weight);
                if order == 2 {
                    self.add_products(row, weight, i);
                }
            }
            if order == 2 {
                self.area += weight;
            }
        }
    }

    /// Adds the products of the second derivative number `i` with those of the quadratics.
    fn add_products(&mut self, row: &[Real], weight: Real, i: usize) {
        for (sum, hessian) in self.quadratics.iter_mut().zip(HESSIANS) {
            let factor = weight * Real::from(hessian[i]);
            sum.iter_mut().zip(row).for_each(|(sum, &x)| *sum += factor * x);
        }
    }

    /// The real and imaginary parts of the BB coefficients of a wave as matrices on the coordinates
    /// of the old and of the new net: [real, imaginary] of each.
    pub fn in_block(&self, block: &Block) -> [[Matrix; 2]; 2] {
        [&self.patch.old, &self.patch.new].map(|coefs| {
            let parts: Vec<_> = coefs.iter().map(|row| block.parts(row)).collect();
            [0, 1].map(|part| {
                Matrix::from_fn(coefs.len(), parts[0][part].len(), |i, j| parts[i][part][j])
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guided::fairness::ring_energy;
    use crate::linear::largest;

    #[test]
    fn unsplit_squares_have_the_energy_of_guided_rings() {
        for n in [3, 6] {
            let chi = CharacteristicRing::catmull_clark(n);
            for (energy, square) in
                ring_energies(n, Spline::BiQuartic).iter().zip([Square::A, Square::B])
            {
                let other = ring_energy(&chi, square, 4);
                let error = largest(&(&energy.third - &other));
                assert!(error < 1e-26 * largest(&other), "n = {n}: {error:e}");
            }
        }
    }

    #[test]
    fn parts_of_squares_fill_them() {
        let area = |spline| -> Real {
            ring_energies(5, spline).iter().map(|energy| energy.count * energy.area).sum()
        };
        let error = area(Spline::BiQuartic) - area(Spline::BiCubic);
        assert!(error.abs().to_f64() < 1e-29);
    }
}
