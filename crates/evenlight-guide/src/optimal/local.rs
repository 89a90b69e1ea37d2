//! The best local gain: it uses the nodes of Quadratic-Attraction rules only.
//!
//! The rule of the inner node (h, k), h < 3, may use the 21 nodes of its sector's L-net; the rule
//! of a node on line s may use the L-nets on both sides. By the mirrors there are 81 weights. A
//! gain of this form cannot be optimal for every e, so we must choose the initial nets: all nets
//! that come from a c-net, weighted such that each costs the same with the optimal gain,
//!
//! ```text
//!   least  sum over blocks of  trace(P(K) S),    S = E (E^T P* E)^-1 E^T,
//! ```
//!
//! where the columns of E span the c-nets beyond their quadratics. The gradient vanishes if
//!
//! ```text
//!   the projection to local weights of  ((R + B^T P B) K + B^T P A + X^T) C  =  0,
//!   C = sum over l of (A + B K)^l S ((A + B K)^T)^l,
//! ```
//!
//! This is a linear system for K if P and C are taken from the last K. Iterating it converges, by
//! some digits in five steps.

use crate::linear::Matrix;
use crate::nets::Mirror;
use crate::optimal::block::{Block, applied};
use crate::optimal::nets::{Combination, Spline, point_weights};
use crate::optimal::regulator::{Regulator, series};
use crate::real::Real;
use crate::rules::{RULES, number_of};

/// The iteration ends with a step that changes no weight by more than this.
const TOLERANCE: f64 = 1e-20;

/// The number of steps from which the iteration extrapolates.
const MEMORY: usize = 6;

/// By how much, relatively, a step may cost more than the last one.
const SLACK: f64 = 1e-9;

/// The weight of general nets, for bi-3 splines. Nets from c-nets never move some of their nodes
/// alone, and would leave weights undetermined.
const ALL_NETS: f64 = 1e-3;

/// The steps after which the iteration stops without success.
const MAX_STEPS: usize = 200;

/// The footprint: one weight for each orbit of nodes under the mirror that keeps the rule.
#[derive(Clone, Debug)]
pub struct Footprint {
    /// The rule, a number in [`RULES`], and the nodes (turn, number) that share the weight.
    pub weights: Vec<(usize, Vec<(isize, usize)>)>,
}

/// The rules with weights of their own; (1, 2) is the mirror image of (2, 1).
const OWN: [(usize, usize); 5] = [(1, 1), (2, 1), (2, 2), (3, 1), (3, 2)];

impl Footprint {
    /// The footprint of Quadratic-Attraction rules.
    pub fn of_l_nets() -> Self {
        let weights = OWN.into_iter().flat_map(|(h, k)| {
            let mut nodes: Vec<_> = l_net(0).collect();
            if h == 3 {
                nodes.extend(l_net(1).filter(|node| !l_net(0).any(|other| other == *node)));
            }
            orbits(&nodes, (h, k)).into_iter().map(move |orbit| (number_of(h, k), orbit))
        });
        Self { weights: weights.collect() }
    }

    /// The matrices of the weights' rules in a block: (row, column, entry).
    fn entries(&self, block: &Block) -> Vec<Vec<(usize, usize, Real)>> {
        let entries = |(rule, orbit): &(usize, Vec<(isize, usize)>)| {
            let (h, k) = RULES[*rule];
            let sum: Combination = orbit.iter().map(|&node| (node, Real::ONE)).collect();
            let [re, im] = block.node_parts(h + 4 * k, &sum);
            let rows = match (h, k) {
                (2, 1) => vec![(*rule, re), (number_of(1, 2), im)],
                _ => vec![(*rule, re)],
            };
            let nonzero = rows.into_iter().flat_map(|(i, row)| {
                row.into_iter()
                    .enumerate()
                    .map(move |(j, x)| (i, j, x))
                    .filter(|entry| entry.2 != Real::ZERO)
            });
            nonzero.collect()
        };
        self.weights.iter().map(entries).collect()
    }
}

/// The 21 nodes of the L-net of sector s + turn.
fn l_net(turn: isize) -> impl Iterator<Item = (isize, usize)> {
    let places = (0..5).flat_map(|j| (0..5).map(move |i| (i, j)));
    places.filter(|&(i, j)| i < 3 || j < 3).map(move |(i, j)| {
        let (r, i, j) = crate::nets::home(i, j);
        (turn + r, i + 4 * j)
    })
}

/// Nodes grouped with their images in the mirror of a rule; each by itself if the rule has none.
fn orbits(nodes: &[(isize, usize)], (h, k): (usize, usize)) -> Vec<Vec<(isize, usize)>> {
    let mirror = if h == 3 { Mirror::Line } else { Mirror::Diagonal };
    let image = |(r, node): (isize, usize)| {
        let (r, i, j) = mirror.image((r, node % 4, node / 4));
        (r, i + 4 * j)
    };
    let mut orbits: Vec<Vec<(isize, usize)>> = Vec::new();
    for &node in nodes {
        if h != 3 && h != k {
            orbits.push(vec![node]);
        } else if !orbits.iter().flatten().any(|&other| other == node) {
            let mut orbit = vec![node, image(node)];
            orbit.dedup();
            orbits.push(orbit);
        }
    }
    orbits
}

/// The best local weights, in the order of the footprint.
///
/// # Panics
///
/// If the iteration does not converge, which tests exclude for the valences with tables.
pub fn local_weights(regulators: &[Regulator], spline: Spline, footprint: &Footprint) -> Vec<Real> {
    let optima: Vec<Matrix> = regulators.iter().map(Regulator::optimum).collect();
    let gains: Vec<Matrix> = regulators.iter().zip(&optima).map(|(r, p)| r.gain(p)).collect();
    let start = footprint.weights.iter().map(|(rule, orbit)| cut(regulators, &gains, *rule, orbit));
    let problem = Problem::new(regulators, spline, footprint, &optima);
    problem.solve(start.collect())
}

/// The weight of a node in the optimal rule; at n = 3 some nodes have two names, and one weight.
fn cut(regulators: &[Regulator], gains: &[Matrix], rule: usize, orbit: &[(isize, usize)]) -> Real {
    let n = regulators[0].block.valence as isize;
    let same = |other: &&(isize, usize)| {
        (other.0 - orbit[0].0).rem_euclid(n) == 0 && other.1 == orbit[0].1
    };
    let names = orbit.iter().filter(same).count();
    let turn = orbit[0].0.rem_euclid(n) as usize;
    weight(regulators, gains, rule, (turn, orbit[0].1)) * Real::ratio(1, names as i32)
}

/// The weight of a node of sector s + turn in a rule, from the gains of all blocks.
pub fn weight(
    regulators: &[Regulator],
    gains: &[Matrix],
    rule: usize,
    (turn, node): (usize, usize),
) -> Real {
    let terms = regulators.iter().zip(gains).map(|(regulator, gain)| {
        let block = &regulator.block;
        let wave = applied(gain, &block.unit(turn, node));
        block.multiplicity() * block.value(rule, &wave).re
    });
    terms.sum()
}

/// Local weights as gains of all blocks.
pub fn gains(regulators: &[Regulator], footprint: &Footprint, weights: &[Real]) -> Vec<Matrix> {
    let gain = |regulator: &Regulator| {
        let mut gain = Matrix::zeros(RULES.len(), regulator.refinement.num_rows());
        for (entries, &weight) in footprint.entries(&regulator.block).iter().zip(weights) {
            entries.iter().for_each(|&(i, j, x)| gain[(i, j)] += weight * x);
        }
        gain
    };
    regulators.iter().map(gain).collect()
}

/// The problem of all blocks.
struct Problem<'a> {
    footprint: &'a Footprint,
    parts: Vec<Part<'a>>,
}

/// One block of it.
struct Part<'a> {
    regulator: &'a Regulator,
    multiplicity: Real,
    /// S without the projection along D.
    nets: Matrix,
    entries: Vec<Vec<(usize, usize, Real)>>,
}

/// The numbers that belong to a gain.
struct Evaluation {
    /// The value of the functional.
    value: Real,
    /// For each block R + B^T P B, B^T P A + X^T, C.
    slopes: Vec<[Matrix; 3]>,
}

impl<'a> Problem<'a> {
    fn new(
        regulators: &'a [Regulator],
        spline: Spline,
        footprint: &'a Footprint,
        optima: &[Matrix],
    ) -> Self {
        let part = |(regulator, optimum): (&'a Regulator, &Matrix)| Part {
            regulator,
            multiplicity: regulator.block.multiplicity(),
            nets: initial_nets(regulator, spline, optimum),
            entries: footprint.entries(&regulator.block),
        };
        Self { footprint, parts: regulators.iter().zip(optima).map(part).collect() }
    }

    /// The fixed point of [`Self::next`], from stable weights.
    ///
    /// By itself the iteration is slow (n = 12) or circles around the fixed point (n = 16), hence
    /// the extrapolation from the last few steps. Steps that cost more are halved.
    fn solve(&self, mut weights: Vec<Real>) -> Vec<Real> {
        let mut found = self.evaluated(&weights).expect("cutting the optimal gain keeps it stable");
        let mut history = History::default();
        for _ in 0..MAX_STEPS {
            let step = difference(&self.next(&found), &weights);
            if largest(&step) < TOLERANCE {
                return weights;
            }
            let mut move_by = history.extrapolated(&weights, &step);
            loop {
                let trial = sum(&weights, &move_by);
                let limit = found.value * Real::from(1.0 + SLACK);
                match self.evaluated(&trial).filter(|new| new.value <= limit) {
                    Some(new) => {
                        (weights, found) = (trial, new);
                        break;
                    }
                    None => move_by.iter_mut().for_each(|x| *x = *x * Real::ratio(1, 2)),
                }
            }
        }
        panic!("no convergence in {MAX_STEPS} steps");
    }

    fn evaluated(&self, weights: &[Real]) -> Option<Evaluation> {
        let mut found = Evaluation { value: Real::ZERO, slopes: Vec::new() };
        for part in &self.parts {
            let regulator = part.regulator;
            let mut gain = Matrix::zeros(RULES.len(), regulator.refinement.num_rows());
            for (entries, &weight) in part.entries.iter().zip(weights) {
                entries.iter().for_each(|&(i, j, x)| gain[(i, j)] += weight * x);
            }
            let cost = regulator.cost(&gain)?;
            let rest = &(&Matrix::identity(gain.num_columns())
                - &(&regulator.nets * &regulator.quadratic(&cost.to_go)))
                * &part.nets;
            let initial = &rest * &rest.transposed();
            let spent = &cost.to_go * &rest;
            found.value += part.multiplicity * trace_of_product(&rest, &spent);
            let [control, cross] = regulator.slopes(&cost.to_go);
            found.slopes.push([control, cross, series(&cost.closed_loop, &initial)?]);
        }
        Some(found)
    }

    /// The solution of the linear system.
    fn next(&self, found: &Evaluation) -> Vec<Real> {
        let count = self.footprint.weights.len();
        let mut system = Matrix::zeros(count, count);
        let mut right = Matrix::zeros(count, 1);
        for (part, [control, cross, covariance]) in self.parts.iter().zip(&found.slopes) {
            let fixed = cross * covariance;
            for (a, entries) in part.entries.iter().enumerate() {
                right[(a, 0)] += -(part.multiplicity * product(entries, &fixed));
                let image = spread(entries, control, covariance);
                for (b, entries) in part.entries.iter().enumerate().skip(a) {
                    system[(a, b)] += part.multiplicity * product(entries, &image);
                }
            }
        }
        let system = Matrix::from_fn(count, count, |a, b| system[(a.min(b), a.max(b))]);
        let solution = system.solve(&right).expect("all nodes are moved by some c-net");
        (0..count).map(|a| solution[(a, 0)]).collect()
    }
}

/// The last weights and the steps that the iteration made from them (Anderson's mixing: D. G.
/// Anderson, Iterative procedures for nonlinear integral equations, J. ACM 12, 1965).
#[derive(Default)]
struct History {
    weights: Vec<Vec<Real>>,
    steps: Vec<Vec<Real>>,
}

impl History {
    /// The move from the combination of the last weights whose step is least.
    ///
    /// With changes dx of the weights and df of the steps: f - sum g (dx + df), g minimising
    /// |f - sum g df|.
    fn extrapolated(&mut self, weights: &[Real], step: &[Real]) -> Vec<Real> {
        let changes = |old: &[Vec<Real>], new: &[Real]| -> Vec<Vec<Real>> {
            old.iter().map(|old| difference(new, old)).collect()
        };
        let (dx, df) = (changes(&self.weights, weights), changes(&self.steps, step));
        self.weights.push(weights.to_vec());
        self.steps.push(step.to_vec());
        if self.weights.len() > MEMORY {
            self.weights.remove(0);
            self.steps.remove(0);
        }
        let dot = |a: &[Real], b: &[Real]| a.iter().zip(b).map(|(&x, &y)| x * y).sum::<Real>();
        let normal = Matrix::from_fn(df.len(), df.len(), |i, j| dot(&df[i], &df[j]));
        let right = Matrix::from_fn(df.len(), 1, |i, _| dot(&df[i], step));
        let mut found = step.to_vec();
        let Some(factors) = normal.solve(&right) else { return found };
        for (k, (dx, df)) in dx.iter().zip(&df).enumerate() {
            let both = sum(dx, df);
            found.iter_mut().zip(both).for_each(|(x, y)| *x = *x - factors[(k, 0)] * y);
        }
        found
    }
}

fn difference(a: &[Real], b: &[Real]) -> Vec<Real> {
    a.iter().zip(b).map(|(&x, &y)| x - y).collect()
}

fn sum(a: &[Real], b: &[Real]) -> Vec<Real> {
    a.iter().zip(b).map(|(&x, &y)| x + y).collect()
}

fn largest(vector: &[Real]) -> f64 {
    vector.iter().map(|x| x.abs().to_f64()).fold(0.0, f64::max)
}

/// A root of S: nets from c-nets, beyond their quadratics and normalised by what they must cost.
fn initial_nets(regulator: &Regulator, spline: Spline, optimum: &Matrix) -> Matrix {
    let block = &regulator.block;
    let all = block.matrix(|node| Some(block.node_parts_on_cnet(node, &spline.node_of_cnet(node))));
    // The characteristic net is linear. Without its first node the rest is independent.
    let first = usize::from(block.frequency == 1);
    let mut nets = all.columns(first..all.num_columns());
    if block.frequency == 0 {
        let point: Vec<Real> = point_weights(block.valence)
            .into_iter()
            .map(|weight| weight * Real::from(block.valence as i32))
            .collect();
        for i in (0..nets.num_rows()).filter(|&i| !is_imaginary(i)) {
            (0..nets.num_columns()).for_each(|j| nets[(i, j)] = nets[(i, j)] - point[j]);
        }
    }
    let quadratic = &regulator.nets * &regulator.quadratic(optimum);
    let rest = &(&Matrix::identity(nets.num_rows()) - &quadratic) * &nets;
    let from_cnets = normalised(&rest, optimum);
    if spline == Spline::BiQuartic {
        return from_cnets;
    }
    let all = normalised(&Matrix::identity(nets.num_rows()), optimum);
    let rest = &(&Matrix::identity(nets.num_rows()) - &quadratic) * &all;
    from_cnets.beside(&rest.scaled(Real::from(ALL_NETS).sqrt()))
}

/// Nets E combined such that each costs the same: E L^-T with E^T P E = L L^T.
fn normalised(nets: &Matrix, to_go: &Matrix) -> Matrix {
    let factor = cholesky(&(&nets.transposed() * &(to_go * nets)));
    factor.solve(&nets.transposed()).expect("independent nets").transposed()
}

/// Whether the coordinate is the imaginary part of a pair, which constants do not have.
fn is_imaginary(coordinate: usize) -> bool {
    coordinate % 4 < coordinate / 4
}

/// The lower triangular L with L L^T = `matrix`, positive definite.
fn cholesky(matrix: &Matrix) -> Matrix {
    let order = matrix.num_rows();
    let mut factor = Matrix::zeros(order, order);
    for i in 0..order {
        for j in 0..=i {
            let known: Real = (0..j).map(|k| factor[(i, k)] * factor[(j, k)]).sum();
            let rest = matrix[(i, j)] - known;
            factor[(i, j)] = if i == j { rest.sqrt() } else { rest / factor[(j, j)] };
        }
    }
    factor
}

/// control * E * covariance, E being the matrix with the entries.
fn spread(entries: &[(usize, usize, Real)], control: &Matrix, covariance: &Matrix) -> Matrix {
    let mut image = Matrix::zeros(control.num_rows(), covariance.num_columns());
    for &(i, j, x) in entries {
        for row in 0..control.num_rows() {
            let factor = control[(row, i)] * x;
            for column in 0..covariance.num_columns() {
                image[(row, column)] += factor * covariance[(j, column)];
            }
        }
    }
    image
}

/// The sum of the products of entries.
fn product(entries: &[(usize, usize, Real)], matrix: &Matrix) -> Real {
    entries.iter().map(|&(i, j, x)| x * matrix[(i, j)]).sum()
}

/// The trace of a^T b.
fn trace_of_product(a: &Matrix, b: &Matrix) -> Real {
    let products = (0..a.num_rows()).flat_map(|i| a.row(i).iter().zip(b.row(i)));
    products.map(|(&x, &y)| x * y).sum()
}
