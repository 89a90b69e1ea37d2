//! The regulator of one Fourier block: its cost, the Riccati and the Lyapunov equation.
//!
//! With e the net beyond its quadratic and v its inner nodes after refinement,
//!
//! ```text
//!   e' = A e + B v,    J = sum over rings l of lambda^(-4l) E(e_l, v_l),
//!   E(e, v) = |D^3 ring|^2 + |D^2 ring|^2 + .001 |e|^2  =  e^T Q e + 2 e^T X v + v^T R v,
//! ```
//!
//! With the factor lambda^-2 in A and B, v = K e has the least J = e^T P e for every e at once:
//!
//! ```text
//!   P = Q + A^T P A - (A^T P B + X) (R + B^T P B)^-1 (B^T P A + X^T),
//!   K = - (R + B^T P B)^-1 (B^T P A + X^T).
//! ```
//!
//! Without the second derivatives nets that look like quadratics would have almost no energy, and
//! the slowest mode of e would decay by .97 lambda^2 instead of .8 lambda^2 in a step. The last
//! term gives every part of e a cost.

use crate::linear::Matrix;
use crate::nets::NODES_PER_SECTOR;
use crate::optimal::block::Block;
use crate::optimal::eigennets::{Monomial, eigennets};
use crate::optimal::energy::{PatchEnergy, ring_energies};
use crate::optimal::nets::{INNER, Spline, regular_nodes};
use crate::real::Real;

/// The weight of |e|^2 in the cost, a ratio.
const SIZE: (i32, i32) = (1, 1000);

/// The doublings after which a sum counts as not convergent: 2^14 rings.
const MAX_DOUBLINGS: usize = 14;

/// One Fourier block of the regulator.
#[derive(Clone, Debug)]
pub struct Regulator {
    /// The block.
    pub block: Block,
    /// The subdominant eigenvalue lambda.
    pub lambda: Real,
    /// Regular refinement, without the factor lambda^-2; the rows of the inner nodes are zero.
    pub refinement: Matrix,
    /// The monomials of this block.
    pub monomials: Vec<Monomial>,
    /// Their nets D, as columns.
    pub nets: Matrix,
    state: Matrix,
    cross: Matrix,
    control: Matrix,
}

/// The regulators of all blocks, f = 0..=n/2.
pub fn regulators(valence: usize, spline: Spline) -> Vec<Regulator> {
    let energies = ring_energies(valence, spline);
    let blocks = Block::all(valence).into_iter();
    blocks.map(|block| Regulator::new(block, spline, &energies)).collect()
}

/// The cost of a gain: its cost-to-go P and closed loop.
#[derive(Clone, Debug)]
pub struct Cost {
    /// P.
    pub to_go: Matrix,
    /// lambda^-2 (A + B K).
    pub closed_loop: Matrix,
}

impl Regulator {
    fn new(block: Block, spline: Spline, energies: &[PatchEnergy]) -> Self {
        let regular = |node: usize| {
            let rule = || spline.regular_node(node as isize % 4, node as isize / 4);
            regular_nodes().any(|k| k == node).then(|| block.node_parts(node, &rule()))
        };
        let refinement = block.matrix(regular);
        let zeros = |columns| Matrix::zeros(NODES_PER_SECTOR, columns);
        let mut regulator = Self {
            lambda: crate::characteristic::lambda(block.valence),
            monomials: Monomial::of(&block),
            nets: eigennets(&block, spline, &refinement, energies),
            state: Block::metric().scaled(Real::ratio(SIZE.0, SIZE.1)),
            cross: zeros(INNER.len()),
            control: Matrix::zeros(INNER.len(), INNER.len()),
            block,
            refinement,
        };
        energies.iter().for_each(|energy| regulator.add(energy));
        regulator
    }

    /// Adds the energy of a patch to the cost.
    fn add(&mut self, energy: &PatchEnergy) {
        let form = (&energy.third + &energy.second).scaled(energy.count);
        let [old, new] = energy.in_block(&self.block);
        for (old, new) in old.iter().zip(&new) {
            let by_state = old + &(new * &self.refinement);
            let by_control = new.select_columns(&INNER);
            let weighted = &form * &by_control;
            self.state = &self.state + &(&by_state.transposed() * &(&form * &by_state));
            self.cross = &self.cross + &(&by_state.transposed() * &weighted);
            self.control = &self.control + &(&by_control.transposed() * &weighted);
        }
    }

    /// lambda^-2 A and lambda^-2 B.
    fn scaled_system(&self) -> [Matrix; 2] {
        let scale = Real::ONE / (self.lambda * self.lambda);
        let mut inputs = Matrix::zeros(NODES_PER_SECTOR, INNER.len());
        for (k, &node) in INNER.iter().enumerate() {
            inputs[(node, k)] = scale;
        }
        [self.refinement.scaled(scale), inputs]
    }

    /// R + B^T P B and B^T P A + X^T: with them dJ = 2 dv^T ((R + B^T P B) v + (B^T P A + X^T) e).
    pub fn slopes(&self, to_go: &Matrix) -> [Matrix; 2] {
        let [a, b] = self.scaled_system();
        let weighted = &b.transposed() * to_go;
        [&self.control + &(&weighted * &b), &(&weighted * &a) + &self.cross.transposed()]
    }

    /// The optimal P, by doubling: after step k it is the P of 2^k rings.
    ///
    /// First v := v - R^-1 X^T e removes the cross term. Then with G = B R^-1 B^T and P_0 = Q,
    ///
    /// ```text
    ///   A := A W A,   G := G + A W G A^T,   P := P + A^T P W A,   W = (I + G P)^-1.
    /// ```
    pub fn optimum(&self) -> Matrix {
        let solvable = "the energy of the inner nodes is positive definite";
        let [a, b] = self.scaled_system();
        let by_cross = self.control.solve(&self.cross.transposed()).expect(solvable);
        let mut step = &a - &(&b * &by_cross);
        let mut to_go = &self.state - &(&self.cross * &by_cross);
        let mut inputs = &b * &self.control.solve(&b.transposed()).expect(solvable);
        let identity = Matrix::identity(NODES_PER_SECTOR);
        for _ in 0..MAX_DOUBLINGS {
            let both = step.beside(&(&inputs * &step.transposed()));
            let weighted = (&identity + &(&inputs * &to_go)).solve(&both);
            let weighted = weighted.expect("a product of positive semidefinite matrices");
            let next_step = weighted.columns(0..NODES_PER_SECTOR);
            let more = &step.transposed() * &(&to_go * &next_step);
            inputs = &inputs + &(&step * &weighted.columns(NODES_PER_SECTOR..both.num_columns()));
            to_go = symmetric(&(&to_go + &more));
            step = &step * &next_step;
            if size(&more) < 1e-33 * size(&to_go) {
                break;
            }
        }
        to_go
    }

    /// The gain K that is optimal if `to_go` is the cost of all later rings.
    pub fn gain(&self, to_go: &Matrix) -> Matrix {
        let [control, cross] = self.slopes(to_go);
        control.solve(&cross.scaled(-Real::ONE)).expect("positive definite")
    }

    /// P of a gain, P = Q + X K + K^T X^T + K^T R K + C^T P C with the closed loop C; `None` if the
    /// energy is infinite.
    pub fn cost(&self, gain: &Matrix) -> Option<Cost> {
        let [a, b] = self.scaled_system();
        let closed_loop = &a + &(&b * gain);
        let cross = &self.cross * gain;
        let own = &gain.transposed() * &(&self.control * gain);
        let stage = &(&self.state + &own) + &(&cross + &cross.transposed());
        let to_go = series(&closed_loop.transposed(), &stage)?;
        Some(Cost { to_go, closed_loop })
    }

    /// The rule of q, (D^T P D)^-1 D^T P: the coefficients that leave the cheapest rest.
    pub fn quadratic(&self, to_go: &Matrix) -> Matrix {
        let weighted = &self.nets.transposed() * to_go;
        if self.monomials.is_empty() {
            return weighted;
        }
        (&weighted * &self.nets).solve(&weighted).expect("positive definite")
    }

    /// The inner nodes on q and their own net: D S - K D.
    pub fn on_quadratic(&self, gain: &Matrix) -> Matrix {
        let shrunk = Matrix::from_fn(INNER.len(), self.monomials.len(), |i, j| {
            self.monomials[j].eigenvalue(self.lambda) * self.nets[(INNER[i], j)]
        });
        &shrunk - &(gain * &self.nets)
    }
}

/// The sum over l of C^l M (C^l)^T, by doubling; `None` if it does not converge.
pub fn series(step: &Matrix, first: &Matrix) -> Option<Matrix> {
    let (mut step, mut sum) = (step.clone(), symmetric(first));
    for _ in 0..MAX_DOUBLINGS {
        let more = &(&step * &sum) * &step.transposed();
        sum = symmetric(&(&sum + &more));
        if size(&more) < 1e-33 * size(&sum) {
            return Some(sum);
        }
        step = &step * &step;
    }
    None
}

/// The largest absolute value of an entry.
pub fn size(matrix: &Matrix) -> f64 {
    let rows = (0..matrix.num_rows()).flat_map(|i| matrix.row(i));
    rows.map(|x| x.abs().to_f64()).fold(0.0, f64::max)
}

/// The mean of a matrix and its transpose.
fn symmetric(matrix: &Matrix) -> Matrix {
    (matrix + &matrix.transposed()).scaled(Real::ratio(1, 2))
}
