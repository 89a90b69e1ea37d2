//! The rules of least energy: eigen-nets, and the regulator of the rest of a net.

use super::energy::RingForms;
use super::net::{Net, SPLINE_NODES};
use crate::dense::Matrix;

/// The weight of |e|^2 in the cost: so small that it matters only where rings do not depend on e.
const SIZE: f64 = 1e-3;
/// The doublings after which the search for the sum over rings stops; 2^7 rings are enough.
const MAX_DOUBLINGS: usize = 14;
/// Below this a change is rounding: after the factor 4 the slowest nets shrink by 1/2 in a step.
const CONVERGED: f64 = 1e-17;

/// The control problem of a fan.
pub(super) struct Regulator {
    pub(super) net: Net,
    /// The nodes that the rules may choose in every refinement.
    pub(super) free: Vec<usize>,
    /// Refinement by knot insertion, the free nodes zero.
    pub(super) step: Matrix,
}

impl Regulator {
    pub(super) fn new(net: Net) -> Self {
        Self { net, free: net.free(), step: net.regular_step() }
    }

    /// Among all nets whose refinement can be `factor` times themselves, with the crease's nodes
    /// given, the net of least |D^2 f|^2 - 2 `linear`(f) on its ring.
    pub(super) fn eigen_net(
        &self,
        factor: f64,
        spline: [f64; SPLINE_NODES],
        form: &Matrix,
        linear: Option<&[f64]>,
    ) -> Vec<f64> {
        let (nodes, free) = (self.eigen_nodes(factor), self.free.len());
        let both = stacked(&nodes, factor);
        let form = both.transposed().times(&form.times(&both));
        let mut right = Matrix::zeros(free, 1);
        for i in 0..free {
            let given = (0..SPLINE_NODES).map(|k| form[(i, free + k)] * spline[k]).sum::<f64>();
            let wanted = linear
                .map_or(0.0, |linear| (0..linear.len()).map(|k| linear[k] * both[(k, i)]).sum());
            right[(i, 0)] = wanted - given;
        }
        let own = form.select_rows(0..free).select_columns(0..free);
        let solved = own.solve(right);
        let chosen = (0..free).map(|k| solved[(k, 0)]).chain(spline).collect::<Vec<_>>();
        (0..self.net.num_nodes())
            .map(|k| nodes.row(k).iter().zip(&chosen).map(|(w, x)| w * x).sum())
            .collect()
    }

    /// All nodes of a net that refines to `factor` times itself, from its free nodes and the nodes
    /// of the spline: the nodes with an index 3 follow from them.
    fn eigen_nodes(&self, factor: f64) -> Matrix {
        let spline = self.net.first_spline_node()..self.net.num_nodes();
        let known: Vec<usize> = self.free.iter().copied().chain(spline).collect();
        let mut nodes = Matrix::zeros(self.net.num_nodes(), known.len());
        for k in 0..self.net.num_nodes() {
            for (j, &at) in known.iter().enumerate() {
                nodes[(k, j)] = self.step[(k, at)] / factor;
            }
        }
        for (j, &at) in known.iter().enumerate() {
            (0..known.len()).for_each(|i| nodes[(at, i)] = 0.0);
            nodes[(at, j)] = 1.0;
        }
        nodes
    }

    /// The cost-to-go P and the gain K of the nets in the range of `allowed`, a projection whose
    /// range refinement maps to itself.
    pub(super) fn optimum(&self, forms: &RingForms, allowed: &Matrix) -> [Matrix; 2] {
        let (n, m) = (self.net.num_nodes(), self.free.len());
        let mut energy = forms.second.clone();
        energy.add(1.0, &forms.third);
        let mut both = Matrix::zeros(2 * n, n + m);
        for i in 0..n {
            both[(i, i)] = 1.0;
            (0..n).for_each(|j| both[(n + i, j)] = self.step[(i, j)]);
        }
        self.free.iter().enumerate().for_each(|(k, &at)| both[(n + at, n + k)] = 1.0);
        let stage = both.transposed().times(&energy.times(&both));
        let (by_state, by_control) = (stage.select_rows(0..n), stage.select_rows(n..n + m));
        let mut state = by_state.select_columns(0..n);
        state.add(SIZE, &Matrix::identity(n));
        let (cross, control) =
            (by_control.select_columns(0..n), by_control.select_columns(n..n + m));
        let mut inputs = Matrix::zeros(n, m);
        self.free.iter().enumerate().for_each(|(k, &at)| inputs[(at, k)] = 4.0);
        let step = self.step.times(allowed).scaled(4.0);
        let to_go = riccati(&step, &inputs, &state, &cross, &control);
        let weighted = inputs.transposed().times(&to_go);
        let (mut slope, mut right) = (weighted.times(&inputs), weighted.times(&step));
        slope.add(1.0, &control);
        right.add(1.0, &cross);
        let gain = slope.solve(right.scaled(-1.0));
        [to_go, gain]
    }
}

/// (x, factor x).
fn stacked(nodes: &Matrix, factor: f64) -> Matrix {
    let rows =
        |w: f64| (0..nodes.num_rows()).map(move |k| nodes.row(k).iter().map(|x| w * x).collect());
    let all: Vec<Vec<f64>> = rows(1.0).chain(rows(factor)).collect();
    Matrix::from_rows(nodes.num_columns(), &all)
}

/// The least e^T P e = sum of e^T Q e + 2 v^T X e + v^T R v with e' = A e + B v, by doubling: after
/// step k it is the cost of 2^k rings.
///
/// First v := v - R^-1 X e removes the cross term. Then with G = B R^-1 B^T and P_0 = Q,
///
/// ```text
///   A := A W A,   G := G + A W G A^T,   P := P + A^T P W A,   W = (I + G P)^-1.
/// ```
fn riccati(a: &Matrix, b: &Matrix, q: &Matrix, x: &Matrix, r: &Matrix) -> Matrix {
    let n = q.num_rows();
    let by_cross = r.clone().solve(x.clone());
    let mut step = a.clone();
    step.add(-1.0, &b.times(&by_cross));
    let mut to_go = q.clone();
    to_go.add(-1.0, &x.transposed().times(&by_cross));
    let mut inputs = b.times(&r.clone().solve(b.transposed()));
    for _ in 0..MAX_DOUBLINGS {
        let mut system = inputs.times(&to_go);
        system.add(1.0, &Matrix::identity(n));
        let back = inputs.times(&step.transposed());
        let rows: Vec<Vec<f64>> = (0..n).map(|k| [step.row(k), back.row(k)].concat()).collect();
        let weighted = system.solve(Matrix::from_rows(2 * n, &rows));
        let next = weighted.select_columns(0..n);
        let more = step.transposed().times(&to_go.times(&next));
        inputs.add(1.0, &step.times(&weighted.select_columns(n..2 * n)));
        to_go.add(1.0, &more);
        to_go = symmetric(&to_go);
        step = step.times(&next);
        if more.largest() < CONVERGED * to_go.largest() {
            break;
        }
    }
    to_go
}

fn symmetric(a: &Matrix) -> Matrix {
    let mut sum = a.scaled(0.5);
    sum.add(0.5, &a.transposed());
    sum
}
