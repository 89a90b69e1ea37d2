//! The nets of quadratics, which refinement shrinks like the quadratics themselves.
//!
//! Let z be the complex coordinate of the characteristic map. The real and imaginary parts of
//! m = z, z^2, |z|^2 span all quadratics. For each m we want a net d whose surface is as near to m
//! as splines allow. For z this is the characteristic net. For z^2 and |z|^2 refinement must
//! multiply d by lambda^2, exactly:
//!
//! ```text
//!   (A d)_k = lambda^2 d_k   at the regular nodes k;   the inner nodes get lambda^2 d_k by decree
//! ```
//!
//! This leaves the six inner nodes of the block free, d = N d_inner. Among these nets we take the
//! net with the least
//!
//! ```text
//!   |D^3 ring|^2 + .03 |D^2 ring|^2    under    <D^2 ring, D^2 m> = |D^2 m|^2
//! ```
//!
//! where the ring is made of d and lambda^2 d. By the condition ring and m have equal amplitude, so
//! the second term is .03 |D^2 (ring - m)|^2 up to a constant: the ring is smooth first, and near
//! m second. At n = 4 the net is the net of the monomial itself, and the ring equals m.

use crate::guided::characteristic::CharacteristicRing;
use crate::guided::net::CNet;
use crate::linear::Matrix;
use crate::optimal::block::{Block, Complex};
use crate::optimal::energy::PatchEnergy;
use crate::optimal::nets::{INNER, Spline, regular_nodes};
use crate::real::Real;

/// The weight of the second derivatives against the third, a ratio.
const CLOSENESS: (i32, i32) = (3, 100);

/// A monomial in the coordinate z of the characteristic map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Monomial {
    /// z.
    Linear,
    /// z^2.
    Square,
    /// conj(z)^2; at n = 3 it has frequency 1.
    ConjugateSquare,
    /// |z|^2.
    Norm,
}

impl Monomial {
    /// The monomials whose net is a wave of frequency `block.frequency`.
    pub fn of(block: &Block) -> Vec<Self> {
        match (block.frequency, block.valence) {
            (0, _) => vec![Self::Norm],
            (1, 3) => vec![Self::Linear, Self::ConjugateSquare],
            (1, _) => vec![Self::Linear],
            (2, _) => vec![Self::Square],
            _ => vec![],
        }
    }

    /// The eigenvalue, lambda or lambda^2.
    pub fn eigenvalue(self, lambda: Real) -> Real {
        if self == Self::Linear { lambda } else { lambda * lambda }
    }

    /// Real and imaginary part as multiples of X^2 - Y^2, 2XY, X^2 + Y^2.
    fn parts(self) -> [[i32; 3]; 2] {
        match self {
            Self::Linear => [[0; 3]; 2],
            Self::Square => [[1, 0, 0], [0, 1, 0]],
            Self::ConjugateSquare => [[1, 0, 0], [0, -1, 0]],
            Self::Norm => [[0, 0, 1], [0; 3]],
        }
    }

    /// The squared norm of the second derivatives, by area.
    fn amplitude(self) -> Real {
        Real::from(if self == Self::Norm { 8 } else { 16 })
    }
}

/// The coordinates of the nets of [`Monomial::of`] a block, as columns.
pub fn eigennets(
    block: &Block,
    spline: Spline,
    refinement: &Matrix,
    energies: &[PatchEnergy],
) -> Matrix {
    let lambda = crate::characteristic::lambda(block.valence);
    let columns = Monomial::of(block).into_iter().map(|monomial| match monomial {
        Monomial::Linear => characteristic(block, spline),
        _ => quadratic(block, monomial, refinement, energies, lambda * lambda),
    });
    let columns: Vec<Vec<Real>> = columns.collect();
    Matrix::from_fn(refinement.num_rows(), columns.len(), |i, j| columns[j][i])
}

/// The characteristic net.
fn characteristic(block: &Block, spline: Spline) -> Vec<Real> {
    let chi = CharacteristicRing::catmull_clark(block.valence).net();
    let numbering = CNet { valence: block.valence };
    let half_turn = block.half_turns.power(1);
    let value = |node: usize| {
        let mut sum = Complex::ZERO;
        for ((turn, own), weight) in spline.node_of_cnet(node) {
            let at = numbering.turned(own, turn);
            let (u, v) = (chi[(at, 0)], chi[(at, 1)]);
            let z = Complex { re: (u + v) * half_turn.re, im: (v - u) * half_turn.im };
            sum = sum.plus(z.scaled(weight));
        }
        sum
    };
    block.coordinates(value)
}

/// The net of a quadratic monomial.
fn quadratic(
    block: &Block,
    monomial: Monomial,
    refinement: &Matrix,
    energies: &[PatchEnergy],
    eigenvalue: Real,
) -> Vec<Real> {
    let nets = shrinking_nets(refinement, eigenvalue);
    let mut hessian = Matrix::zeros(nets.num_columns(), nets.num_columns());
    let mut product = Matrix::zeros(1, nets.num_columns());
    let mut amplitude = Real::ZERO;
    for energy in energies {
        let [old, new] = energy.in_block(block);
        let closeness = Real::ratio(CLOSENESS.0, CLOSENESS.1);
        let form = (&energy.third + &energy.second.scaled(closeness)).scaled(energy.count);
        for (part, multiples) in monomial.parts().into_iter().enumerate() {
            let ring = &(&old[part] + &new[part].scaled(eigenvalue)) * &nets;
            hessian = &hessian + &(&ring.transposed() * &(&form * &ring));
            for (row, multiple) in energy.quadratics.iter().zip(multiples) {
                let row = Matrix::from_fn(1, row.len(), |_, k| row[k]);
                let factor = energy.count * Real::from(multiple);
                product = &product + &(&row * &ring).scaled(factor);
            }
        }
        amplitude += energy.count * energy.area * monomial.amplitude();
    }
    let direction = hessian.solve(&product.transposed()).expect("no shrinking net is linear");
    let scale = amplitude / (&product * &direction)[(0, 0)];
    let net = &nets * &direction.scaled(scale);
    (0..net.num_rows()).map(|k| net[(k, 0)]).collect()
}

/// N: the nets with (A d)_k = `eigenvalue` d_k at the regular nodes, on their inner nodes.
fn shrinking_nets(refinement: &Matrix, eigenvalue: Real) -> Matrix {
    let regular: Vec<usize> = regular_nodes().collect();
    let equations = refinement - &Matrix::identity(refinement.num_rows()).scaled(eigenvalue);
    let equations = equations.select_rows(&regular);
    let by_inner = equations
        .select_columns(&regular)
        .solve(&equations.select_columns(&INNER).scaled(-Real::ONE))
        .expect("the regular nodes alone shrink faster than by lambda^2");
    let mut nets = Matrix::zeros(refinement.num_rows(), INNER.len());
    for (k, &node) in INNER.iter().enumerate() {
        nets[(node, k)] = Real::ONE;
    }
    for (k, &node) in regular.iter().enumerate() {
        nets.set_row(node, by_inner.row(k));
    }
    nets
}
