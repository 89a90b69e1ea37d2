//! The subdominant eigenvalue of a scheme and what belongs to it: tangent plane and the
//! splitting of a net into tangential part and rest.
//!
//! A map that commutes with turning by one sector falls apart into Fourier blocks
//! B_m = sum_r omega^(m r) A_r, omega = exp(2 pi i / n), A_r the weights on the sector r sectors
//! further on. The subdominant eigenvalue lambda is the largest of B_1: with B_1 x = lambda x,
//! y^T B_1 = lambda y^T and y^T x = 1, every coordinate z of a net contains the part
//!
//! ```text
//!   2 Re(alpha omega^s x),     alpha = 1/n sum_s omega^(-s) y^T z_s,
//! ```
//!
//! which shrinks by lambda in every step. In space alpha is a pair of vectors a + i b: the
//! surface approaches the plane that they span, with normal b x a. Taken with respect to that
//! plane, the height of a net has no part that shrinks by lambda; it shrinks by about lambda^2.

use super::Rules;
use crate::angle::{cosine, sector_cosine, sine};
use crate::point::{Vector, add_scaled};

/// The subdominant eigenvalue, and the vectors that find the tangential part of a net.
#[derive(Clone, Debug)]
pub(crate) struct Subdominant {
    /// The eigenvalue, between 0 and 1.
    pub(crate) lambda: f64,
    part: Part,
}

#[derive(Clone, Debug)]
enum Part {
    /// Eigenvectors of the Fourier block.
    Fourier {
        /// omega^s x for every node: the net of the characteristic map.
        right: Vec<[f64; 2]>,
        /// omega^(-s) y / n for every node.
        left: Vec<[f64; 2]>,
    },
    /// The scheme has a quadratic or a guide: its linear terms are the tangents, and the other
    /// nodes have no part of their own that shrinks by lambda.
    Linear {
        /// The number of all nodes, and of those before the linear terms, of a sector.
        nodes: [usize; 2],
        /// The net of the characteristic map.
        characteristic: Vec<Vector>,
    },
}

impl Subdominant {
    /// Finds the eigenvalue and the tangential part.
    ///
    /// Valence 2 (Catmull-Clark only) has no second direction: its Fourier block is real and the
    /// eigenvalue 1/4 not simple. Then nothing is tangential, and there is no tangent plane.
    pub(crate) fn new(rules: &Rules) -> Self {
        if let Some(lambda) = rules.lambda_of_linear_terms() {
            return Self::of_linear_terms(rules, lambda);
        }
        if rules.valence < 3 {
            return Self::without_plane(rules, 0.25);
        }
        Self::of_fourier_block(rules)
    }

    /// Nothing is tangential.
    pub(crate) fn without_plane(rules: &Rules, lambda: f64) -> Self {
        let none = vec![[0.0; 2]; rules.num_nodes()];
        Self { lambda, part: Part::Fourier { right: none.clone(), left: none } }
    }

    /// For rules that do not commute with turning: the nets x and y of the characteristic map, and
    /// the rows that find their coefficients.
    pub(crate) fn with_plane(lambda: f64, right: [Vec<f64>; 2], left: [Vec<f64>; 2]) -> Self {
        // 2 (a x - b y) with a = left x / 2, b = -left y / 2.
        let pairs = |[x, y]: [Vec<f64>; 2], w: [f64; 2]| {
            x.into_iter().zip(y).map(|(x, y)| [w[0] * x, w[1] * y]).collect()
        };
        let (right, left) = (pairs(right, [1.0, 1.0]), pairs(left, [0.5, -0.5]));
        Self { lambda, part: Part::Fourier { right, left } }
    }

    fn of_linear_terms(rules: &Rules, lambda: f64) -> Self {
        let nodes = [rules.nodes_per_sector, rules.control_nodes_per_sector()];
        let characteristic = attracted_net(rules, lambda);
        Self { lambda, part: Part::Linear { nodes, characteristic } }
    }

    /// Repeated squaring of the Fourier block leaves lambda^(2^k) x y^T; in that block the
    /// eigenvalue is well separated (by a factor below 0.7 for all schemes and valences).
    fn of_fourier_block(rules: &Rules) -> Self {
        let m = rules.nodes_per_sector;
        let roots = roots_of_unity(rules.valence);
        let block = fourier_block(rules, &roots);
        let mut power = block.clone();
        for _ in 0..SQUARINGS {
            power = normalised(product(m, &power, &power));
        }
        let (row, column) = largest(m, &power);
        let x: Vec<Complex> = (0..m).map(|i| power[i * m + column]).collect();
        let mut y: Vec<Complex> = (0..m).map(|j| power[row * m + j]).collect();
        let xy = x.iter().zip(&y).fold([0.0; 2], |sum, (&a, &b)| plus(sum, times(a, b)));
        y.iter_mut().for_each(|v| *v = divided(*v, xy));
        let bx =
            |i: usize| (0..m).fold([0.0; 2], |sum, j| plus(sum, times(block[i * m + j], x[j])));
        let lambda = (0..m).fold([0.0; 2], |sum, i| plus(sum, times(y[i], bx(i))))[0];
        let n = rules.valence as f64;
        let right = roots.iter().flat_map(|&w| x.iter().map(move |&v| times(w, v))).collect();
        let left = roots
            .iter()
            .flat_map(|&w| y.iter().map(move |&v| times([w[0] / n, -w[1] / n], v)))
            .collect();
        Self { lambda, part: Part::Fourier { right, left } }
    }

    /// The vectors [a, b] that span the tangent plane of a net's limit, with normal b x a.
    pub(crate) fn tangents<const N: usize>(&self, net: &[[f64; N]]) -> [[f64; N]; 2] {
        match &self.part {
            Part::Fourier { left, .. } => {
                let mut alpha = [[0.0; N]; 2];
                for (w, &p) in left.iter().zip(net) {
                    add_scaled(&mut alpha[0], w[0], p);
                    add_scaled(&mut alpha[1], w[1], p);
                }
                alpha
            }
            Part::Linear { nodes: [_, control], .. } => [net[control + 1], net[*control]],
        }
    }

    /// The vectors [a, b] such that the part of a net that shrinks by lambda is a x + b y, where x
    /// and y are the coordinates of the characteristic net.
    pub(crate) fn tangential<const N: usize>(&self, net: &[[f64; N]]) -> [[f64; N]; 2] {
        let [first, second] = self.tangents(net);
        match &self.part {
            Part::Fourier { .. } => [first.map(|x| 2.0 * x), second.map(|x| -2.0 * x)],
            Part::Linear { characteristic, nodes: [_, control] } => {
                // first = beta is along line 0, the x-axis; second = alpha along line -1.
                let [x, y, _] = characteristic[*control];
                let across = |k: usize| (second[k] - x * first[k]) / y;
                [first, std::array::from_fn(across)]
            }
        }
    }

    /// Removes the part of coordinate `k` of `net` that shrinks by lambda.
    pub(crate) fn remove_from_coordinate<const N: usize>(&self, k: usize, net: &mut [[f64; N]]) {
        match &self.part {
            Part::Fourier { right, left } => {
                let mut alpha = [0.0; 2];
                for (w, p) in left.iter().zip(net.iter()) {
                    alpha[0] += w[0] * p[k];
                    alpha[1] += w[1] * p[k];
                }
                for (x, p) in right.iter().zip(net.iter_mut()) {
                    p[k] -= 2.0 * (alpha[0] * x[0] - alpha[1] * x[1]);
                }
            }
            Part::Linear { nodes: [all, control], .. } => {
                for sector in net.chunks_mut(*all) {
                    sector[*control][k] = 0.0;
                    sector[*control + 1][k] = 0.0;
                }
            }
        }
    }

    /// The net of the characteristic map, in the plane z = 0.
    pub(crate) fn characteristic_net(&self) -> Vec<Vector> {
        match &self.part {
            Part::Fourier { right, .. } => right.iter().map(|x| [x[0], x[1], 0.0]).collect(),
            Part::Linear { characteristic, .. } => characteristic.clone(),
        }
    }
}

/// The net that shrinks by lambda under the attraction of the linear terms of the plane: the fixed
/// point of x -> A x / lambda. The eigenvalues of the other nodes are below lambda^2, so every step
/// takes away at least half of the error.
fn attracted_net(rules: &Rules, lambda: f64) -> Vec<Vector> {
    let angle = std::f64::consts::TAU / rules.valence as f64;
    // Line 0 along x: line -1 of sector 0 is turned back by one sector.
    let mut lines = [[cosine(angle), -sine(angle), 0.0], [1.0, 0.0, 0.0]];
    let mut net = vec![[0.0; 3]; rules.num_nodes()];
    for sector in net.chunks_mut(rules.nodes_per_sector) {
        sector[rules.control_nodes_per_sector()..][..2].copy_from_slice(&lines);
        lines = next_lines(rules.valence, lines);
    }
    for _ in 0..ATTRACTION_STEPS {
        net = rules.refine(&net).iter().map(|p| [p[0] / lambda, p[1] / lambda, 0.0]).collect();
    }
    net
}

/// The lines of the next sector.
fn next_lines(n: usize, [a, b]: [Vector; 2]) -> [Vector; 2] {
    let mut next = [-a[0], -a[1], -a[2]];
    add_scaled(&mut next, 2.0 * sector_cosine(n), b);
    [b, next]
}

/// 0.6^100 is far below rounding.
const ATTRACTION_STEPS: usize = 100;

/// 2^10 steps: 0.7^1024 is far below rounding.
const SQUARINGS: usize = 10;

type Complex = [f64; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn plus(a: Complex, b: Complex) -> Complex {
    [a[0] + b[0], a[1] + b[1]]
}

fn divided(a: Complex, b: Complex) -> Complex {
    let r = b[0] * b[0] + b[1] * b[1];
    times(a, [b[0] / r, -b[1] / r])
}

fn size(a: Complex) -> f64 {
    a[0].abs().max(a[1].abs())
}

/// omega^s for s = 0..n-1.
fn roots_of_unity(n: usize) -> Vec<Complex> {
    let angle = |s: usize| std::f64::consts::TAU * s as f64 / n as f64;
    (0..n).map(|s| [cosine(angle(s)), sine(angle(s))]).collect()
}

/// B_1, row by row.
fn fourier_block(rules: &Rules, roots: &[Complex]) -> Vec<Complex> {
    let m = rules.nodes_per_sector;
    let mut block = vec![[0.0; 2]; m * m];
    for (i, row) in rules.refine.iter().enumerate() {
        for &(node, w) in row {
            let root = roots[node / m];
            let entry = &mut block[i * m + node % m];
            *entry = plus(*entry, [w * root[0], w * root[1]]);
        }
    }
    block
}

fn product(m: usize, a: &[Complex], b: &[Complex]) -> Vec<Complex> {
    let entry = |i: usize, j: usize| {
        (0..m).fold([0.0; 2], |sum, k| plus(sum, times(a[i * m + k], b[k * m + j])))
    };
    (0..m * m).map(|at| entry(at / m, at % m)).collect()
}

fn normalised(mut a: Vec<Complex>) -> Vec<Complex> {
    let largest = a.iter().map(|&v| size(v)).fold(0.0, f64::max);
    a.iter_mut().for_each(|v| *v = [v[0] / largest, v[1] / largest]);
    a
}

/// Row and column of the largest entry.
fn largest(m: usize, a: &[Complex]) -> (usize, usize) {
    let at = (0..m * m).fold(0, |best, at| if size(a[at]) > size(a[best]) { at } else { best });
    (at / m, at % m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scheme::{RuleSet, SchemeKind};

    #[test]
    fn lambda_of_catmull_clark_is_the_closed_form() {
        for n in (3..=16).chain([40, 300]) {
            let rules = SchemeKind::CatmullClark.rules(RuleSet::Generated, n).unwrap();
            let c = (std::f64::consts::TAU / n as f64).cos();
            let lambda = (c + 5.0 + ((c + 1.0) * (c + 9.0)).sqrt()) / 16.0;
            assert!((Subdominant::new(&rules).lambda - lambda).abs() < 1e-14, "n = {n}");
        }
    }

    #[test]
    fn the_characteristic_net_shrinks_by_lambda_and_is_all_tangential() {
        for kind in SchemeKind::ALL {
            for n in [3, 5, 6, 8, 10] {
                let rules = kind.rules(RuleSet::Generated, n).unwrap();
                let sub = Subdominant::new(&rules);
                let net = sub.characteristic_net();
                let size = net.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
                for (a, b) in rules.refine(&net).iter().zip(&net) {
                    for k in 0..2 {
                        let gap = (a[k] - sub.lambda * b[k]).abs() / size;
                        assert!(gap < 2e-14, "{}, n = {n}: {gap}", kind.name());
                    }
                }
                let mut rest = net.clone();
                sub.remove_from_coordinate(0, &mut rest);
                // If there are linear terms, only they are removed; the rest dies by itself.
                for _ in 0..if rules.lambda_of_linear_terms().is_some() { 80 } else { 0 } {
                    rest = rules.refine(&rest);
                }
                assert!(rest.iter().all(|p| p[0].abs() < 2e-14 * size), "{}", kind.name());
            }
        }
    }
}
