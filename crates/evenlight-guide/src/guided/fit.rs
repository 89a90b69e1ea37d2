//! The guide of a c-net: the fairest one.
//!
//! Of all G2 guides whose centre is c_0 ([`CNet::central_point`]) the one is taken that minimises,
//! for each coordinate,
//!
//! ```text
//! sum over rings l = 0..3 of E_l   +   10^-4 sum over sectors of F_5(g^s).
//! ```
//!
//! E_l is the unfairness of ring l ([`super::fairness`]) in degree bi-5. The first ring has the net
//! as its border, and that is where the net enters. F_5, the integral of the squared fifth
//! derivatives ([`functional`]), settles what the rings hardly see and changes their energy by one
//! percent; it lowers the condition of the problem from 10^5 to some hundreds.
//!
//! All is linear: the guide is the *generating matrix* times the net. Its rows for sector 0 are the
//! table of the valence; those of the others are turned.
//!
//! # How it is solved
//!
//! Guides with centre 0 have an orthonormal basis N of 18n + 5 columns (18n + 6 for n = 3, 6). For
//! the net relative to c_0 the normal equations are N^T Q N y = -N^T W net, with Q and W made of 36
//! rows per sector. With numbers of 31 digits their condition, 10^6 at valence 20, does no harm:
//! the matrix has its mirror symmetry, which nothing enforces, to 4e-27 and better at all valences
//! up to 20. By the symmetry under turns only the seven columns of sector 0 and of e are solved
//! for. That takes a second for valence 9 and grows with the third power.
//!
//! DIFFERENCE: the paper's fit is not available to us, see [`super::fairness`]; all surfaces may
//! differ from its figures.

use std::ops::Range;

use crate::guided::bb::power;
use crate::guided::characteristic::{CharacteristicRing, SQUARES};
use crate::guided::fairness::{functional, ring_energy};
use crate::guided::net::{CNet, NODES_PER_SECTOR};
use crate::guided::rings::{Form, Rings, shrinking};
use crate::guided::space::{COEFS, DEGREE, MAX_TOTAL, basis, orthonormal};
use crate::linear::Matrix;
use crate::real::Real;

/// The rings whose energy is minimised.
const LEVELS: Range<usize> = 0..4;

/// The weight of F_5, 1 / 10^4.
const WEIGHT_OF_F5: (i32, i32) = (1, 10_000);

/// The order of the functional of the guide.
const FUNCTIONAL: usize = 5;

/// The generating matrix of a characteristic ring: the 36 coefficients of the guide's piece in
/// sector 0 on the 6n + 1 nodes. Its rows sum to 1.
pub fn generating_matrix(chi: &CharacteristicRing) -> Matrix {
    let net = CNet { valence: chi.valence };
    let relative = relative_matrix(chi);
    let centre = net.central_point();
    Matrix::from_fn(COEFS, net.num_nodes(), |row, node| {
        let sum: Real = relative.row(row).iter().copied().sum();
        relative[(row, node)] + centre[node] * (Real::ONE - sum)
    })
}

/// All pieces of the guide: 36n rows, each piece seeing the net turned to its sector.
pub fn guide(generating: &Matrix, valence: usize, net: &Matrix) -> Matrix {
    let numbering = CNet { valence };
    let piece = |s: usize| {
        let seen = |node| numbering.turned(node, s as isize);
        let nodes: Vec<usize> = (0..numbering.num_nodes()).map(seen).collect();
        generating * &net.select_rows(&nodes)
    };
    (1..valence).fold(piece(0), |all, s| all.above(&piece(s)))
}

/// The matrix averaged with its mirror image in the diagonal of the sector, which it equals up to
/// rounding.
pub fn symmetrised(generating: &Matrix, valence: usize) -> Matrix {
    let net = CNet { valence };
    let order = DEGREE + 1;
    Matrix::from_fn(COEFS, net.num_nodes(), |row, node| {
        let image = generating[(order * (row % order) + row / order, net.mirrored(node))];
        (generating[(row, node)] + image) * Real::ratio(1, 2)
    })
}

/// The guide of a net whose c_0 is zero.
fn relative_matrix(chi: &CharacteristicRing) -> Matrix {
    let valence = chi.valence;
    let net = CNet { valence };
    let problem = Problem::new(chi);
    let guides = orthonormal(&basis(valence, 1..=MAX_TOTAL));
    let piece = |s: usize| guides.select_rows(&(COEFS * s..COEFS * (s + 1)).collect::<Vec<_>>());
    let pieces: Vec<Matrix> = (0..valence).map(piece).collect();
    let kinds: Vec<usize> = (0..NODES_PER_SECTOR).chain([net.centre()]).collect();
    let size = guides.num_columns();
    let mut normal = Matrix::zeros(size, size);
    let mut right = Matrix::zeros(size, kinds.len());
    for (s, piece) in pieces.iter().enumerate() {
        let transposed = piece.transposed();
        normal = &normal + &(&transposed * &(&problem.on_guide * piece));
        // Sector s sees the nodes of sector 0 turned back by s.
        let seen: Vec<usize> = kinds.iter().map(|&node| net.turned(node, -(s as isize))).collect();
        right = &right - &(&transposed * &problem.on_net.select_columns(&seen));
    }
    let solution = normal.solve(&right).expect("only the zero guide has no energy");
    let responses: Vec<Matrix> = pieces.iter().map(|piece| piece * &solution).collect();
    // How sector 0 responds to a node of sector r is how sector -r responds to it in sector 0.
    Matrix::from_fn(COEFS, net.num_nodes(), |row, node| {
        let sector = node / NODES_PER_SECTOR;
        let kind = if node == net.centre() { NODES_PER_SECTOR } else { node % NODES_PER_SECTOR };
        responses[(2 * valence - sector) % valence][(row, kind)]
    })
}

/// The energy of one sector, g^T Q g + 2 g^T W net + ..
struct Problem {
    /// Q, 36 x 36.
    on_guide: Matrix,
    /// W, 36 rows on the nodes as the sector sees them.
    on_net: Matrix,
}

impl Problem {
    fn new(chi: &CharacteristicRing) -> Self {
        let rings = Rings::new(chi, Form::Bi5);
        let shrinking = shrinking(chi.lambda);
        let (numerator, denominator) = WEIGHT_OF_F5;
        let mut on_guide =
            functional(DEGREE, FUNCTIONAL).scaled(Real::ratio(numerator, denominator));
        let mut on_net = Matrix::zeros(COEFS, CNet { valence: chi.valence }.num_nodes());
        for square in SQUARES {
            let energy = ring_energy(chi, square, DEGREE);
            let k = square as usize;
            let first = rings.first_on_guide[k].transposed();
            on_guide = &on_guide + &(&first * &(&energy * &rings.first_on_guide[k]));
            on_net = &on_net + &(&first * &(&energy * &rings.first_on_net[k]));
            let mut later = rings.later[k].clone();
            for level in LEVELS.skip(1) {
                later = &later * &shrinking;
                let scale = Real::ONE / power(chi.lambda, 4 * level);
                let energy = &later.transposed() * &(&energy * &later);
                on_guide = &on_guide + &energy.scaled(scale);
            }
        }
        Self { on_guide, on_net }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guided::characteristic::sigma_of;
    use crate::guided::space::bb_conditions;
    use crate::linear::largest;

    /// Those of Catmull-Clark subdivision, and some of other speeds.
    fn characteristic_rings() -> Vec<CharacteristicRing> {
        let of_speed = |(n, percent)| {
            let sigma = sigma_of(n, Real::ratio(percent, 100));
            CharacteristicRing::new(n, sigma)
        };
        let others = [(3, 50), (5, 50), (5, 35), (6, 65)].map(of_speed);
        [3, 5, 6].map(CharacteristicRing::catmull_clark).into_iter().chain(others).collect()
    }

    #[test]
    fn fitted_guides_are_g2_and_as_symmetric_as_the_net() {
        for chi in characteristic_rings() {
            let n = chi.valence;
            let generating = generating_matrix(&chi);
            let net = CNet { valence: n };
            let guides = guide(&generating, n, &Matrix::identity(net.num_nodes()));
            let residual = largest(&(&bb_conditions(n) * &guides));
            assert!(residual < 1e-26, "n = {n}: {residual:e}");
            let error = largest(&(&generating - &symmetrised(&generating, n)));
            assert!(error < 1e-24, "n = {n}: {error:e}");
        }
    }

    #[test]
    fn constants_and_the_characteristic_net_have_the_linear_guide() {
        for chi in characteristic_rings() {
            let n = chi.valence;
            let generating = generating_matrix(&chi);
            let ones = Matrix::from_fn(6 * n + 1, 1, |_, _| Real::ONE);
            let ones_again = &generating * &ones;
            let exact = Matrix::from_fn(COEFS, 1, |_, _| Real::ONE);
            assert!(largest(&(&ones_again - &exact)) < 1e-28, "n = {n}");
            let plane = &generating * &chi.net();
            let scale = Real::ONE / chi.domain_scale();
            let exact = Matrix::from_fn(COEFS, 2, |row, coordinate| {
                scale * Real::ratio([row / 6, row % 6][coordinate] as i32, 5)
            });
            let error = largest(&(&plane - &exact));
            assert!(error < 1e-24, "n = {n}: {error:e}");
        }
    }
}
