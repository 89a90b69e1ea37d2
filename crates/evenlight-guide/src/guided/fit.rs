//! The guide of a c-net: the fairest one.
//!
//! Among all G2 guides whose centre is c_0 ([`CNet::central_point`]) we take the guide that
//! minimises, for each coordinate,
//!
//! ```text
//! sum over rings l = 0..3 of E_l   +   10^-4 sum over sectors of F_5(g^s).
//! ```
//!
//! E_l is the unfairness of ring l ([`super::fairness`]) in degree bi-5. The net enters as the
//! border of the first ring. F_5, the integral of the squared fifth derivatives ([`functional`]),
//! determines what the rings hardly depend on, and changes their energy by one percent. It lowers
//! the condition of the problem from 10^5 to some hundreds.
//!
//! All is linear: the guide is the *generating matrix* times the net. Its rows for sector 0 are the
//! table of the valence; the rows for the other sectors are the same rows, turned.
//!
//! # How it is solved
//!
//! All is invariant under turns, so guides and nets fall apart into waves ([`super::waves`]), and
//! the problem into n/2 + 1 small problems. The waves of one frequency with centre 0 have an
//! orthonormal basis N of some 36 columns. For the net relative to c_0 the normal equations are
//! N^T Q N y = -N^T W net, with Q and W of one sector. With numbers of 31 digits their condition,
//! 10^6 at valence 20, does no harm: nothing enforces the mirror symmetry of the matrix, and it
//! holds to 1e-23 at all valences up to 32 and all contractions. A valence takes some tenths of a
//! second.
//!
//! DIFFERENCE: the paper's fit is not available to us, see [`super::fairness`]; all surfaces may
//! differ from its figures.

use std::ops::Range;

use crate::guided::bb::power;
use crate::guided::characteristic::{CharacteristicRing, SQUARES};
use crate::guided::fairness::{functional, ring_energy};
use crate::guided::net::{CNet, NODES_PER_SECTOR};
use crate::guided::rings::{Form, Rings, shrinking};
use crate::guided::space::{COEFS, DEGREE, orthonormal};
use crate::guided::waves::Waves;
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
    generating_matrix_of_degree(DEGREE, chi)
}

/// The same with guides of bi-`degree` 3, 4 or 5 [KP18-Guided, sec. 6.1], whose coefficients are
/// given in bi-degree 5 all the same.
pub fn generating_matrix_of_degree(degree: usize, chi: &CharacteristicRing) -> Matrix {
    let net = CNet { valence: chi.valence };
    let relative = relative_matrix(chi, degree);
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

/// The guide of a net whose c_0 is zero.
fn relative_matrix(chi: &CharacteristicRing, degree: usize) -> Matrix {
    let net = CNet { valence: chi.valence };
    let waves = Waves::new(chi.valence);
    let problem = Problem::new(chi);
    let mut matrix = Matrix::zeros(COEFS, net.num_nodes());
    for frequency in waves.frequencies() {
        let response = problem.response(&waves, frequency, degree);
        for row in 0..COEFS {
            for node in 0..net.centre() {
                let (sector, kind) = (node / NODES_PER_SECTOR, node % NODES_PER_SECTOR);
                // Sector 0 responds to sector r as sector -r to sector 0.
                let [re, im] = waves.factor(frequency, -(sector as isize));
                let wave = re * response[(row, kind)] - im * response[(COEFS + row, kind)];
                matrix[(row, node)] += waves.share(frequency) * wave;
            }
            if frequency == 0 {
                matrix[(row, net.centre())] = response[(row, NODES_PER_SECTOR)];
            }
        }
    }
    matrix
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

    /// The wave of least energy, 36 + 36 rows, that answers each of the six kinds of nodes, 1 in
    /// sector 0 and going around with the same frequency; in column 6 what answers e, by a wave of
    /// frequency 0.
    fn response(&self, waves: &Waves, frequency: usize, degree: usize) -> Matrix {
        let basis = orthonormal(&waves.basis(frequency, degree, 1..=2 * degree));
        let half = |k: usize| basis.select_rows(&(COEFS * k..COEFS * (k + 1)).collect::<Vec<_>>());
        let [real, imaginary] = [0, 1].map(half);
        let gradients = [&real, &imaginary].map(|half| &half.transposed() * &self.on_guide);
        let normal = &(&gradients[0] * &real) + &(&gradients[1] * &imaginary);
        let [on_re, on_im] = self.on_wave(waves, frequency);
        let right = &(&real.transposed() * &on_re) + &(&imaginary.transposed() * &on_im);
        let solution = normal.solve(&right).expect("only the zero guide has no energy");
        (&basis * &solution).scaled(-Real::ONE)
    }

    /// W on waves of nodes: sum over r of omega^(m r) W_r, real and imaginary part; column 6 is
    /// that of e.
    fn on_wave(&self, waves: &Waves, frequency: usize) -> [Matrix; 2] {
        let mut parts = [(); 2].map(|()| Matrix::zeros(COEFS, NODES_PER_SECTOR + 1));
        let centre = CNet { valence: waves.valence }.centre();
        for row in 0..COEFS {
            for node in 0..centre {
                let (sector, kind) = (node / NODES_PER_SECTOR, node % NODES_PER_SECTOR);
                let factor = waves.factor(frequency, sector as isize);
                for (part, x) in parts.iter_mut().zip(factor) {
                    part[(row, kind)] += x * self.on_net[(row, node)];
                }
            }
            parts[0][(row, NODES_PER_SECTOR)] = self.on_net[(row, centre)];
        }
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guided::characteristic::sigma_of;
    use crate::guided::space::bb_conditions;
    use crate::guided::symmetry::symmetrised;
    use crate::linear::largest;

    /// The rings of Catmull-Clark subdivision, and some of other contractions.
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
