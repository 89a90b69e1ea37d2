//! Guided surfaces against those of Catmull-Clark subdivision over the same nets: how fair they
//! are.

use evenlight_guide::guided::characteristic::{CharacteristicRing, SQUARES};
use evenlight_guide::guided::fairness::ring_energy;
use evenlight_guide::guided::fit::{generating_matrix, guide};
use evenlight_guide::guided::net::CNet;
use evenlight_guide::guided::rings::{Form, Rings};
use evenlight_guide::linear::Matrix;
use evenlight_guide::real::Real;
use evenlight_guide::spline::refined_cubic;

/// The rings that are compared.
const LEVELS: usize = 4;

/// The nodes of a c-net: one coordinate.
struct Net {
    numbering: CNet,
    nodes: Vec<Real>,
}

impl Net {
    /// The refined node (a, b) of a sector, -1 <= a, b <= 3.
    fn refined(&self, sector: isize, a: isize, b: isize) -> Real {
        match (a, b) {
            (0, 0) => self.refined_centre(),
            (a, b) if a < 0 => self.refined(sector + 1, b, -a),
            (a, b) if b < 0 => self.refined(sector - 1, -b, a),
            (a, 0) => self.refined(sector - 1, 0, a),
            _ => {
                let along_b = refined_cubic(b);
                let products = refined_cubic(a).into_iter().flat_map(|(x, wx)| {
                    along_b.iter().map(move |&(y, wy)| wx * wy * self.at(sector, x, y))
                });
                products.sum()
            }
        }
    }

    fn at(&self, sector: isize, a: isize, b: isize) -> Real {
        self.nodes[self.numbering.index(sector, a, b)]
    }

    /// The vertex rule: 1 - 7/(4n) of e, 3/(2n) of the mean of its direct neighbours and 1/(4n) of
    /// that of its diagonal ones.
    fn refined_centre(&self) -> Real {
        let n = self.numbering.valence as i32;
        let sum = |a, b| (0..n as isize).map(|s| self.at(s, a, b)).sum::<Real>();
        Real::ratio(4 * n - 7, 4 * n) * self.at(0, 0, 0)
            + Real::ratio(3, 2 * n * n) * sum(0, 1)
            + Real::ratio(1, 4 * n * n) * sum(1, 1)
    }

    fn refined_net(&self) -> Self {
        let mut nodes = vec![Real::ZERO; self.nodes.len()];
        for sector in 0..self.numbering.valence as isize {
            for (a, b) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 1), (2, 2)] {
                nodes[self.numbering.index(sector, a, b)] = self.refined(sector, a, b);
            }
        }
        Self { nodes, ..*self }
    }

    /// The bi-3 patch of the Catmull-Clark ring whose inner corner is the refined node (a, b).
    fn patch(&self, sector: isize, (a, b): (isize, isize)) -> Matrix {
        let to_bb =
            Matrix::from_fractions(&[[1, 4, 1, 0], [0, 4, 2, 0], [0, 2, 4, 0], [0, 1, 4, 1]], 6);
        let nodes = Matrix::from_fn(16, 1, |k, _| {
            self.refined(sector, a - 1 + k as isize / 4, b - 1 + k as isize % 4)
        });
        &to_bb.kronecker(&to_bb) * &nodes
    }
}

fn energy_of(energy: &Matrix, patch: &Matrix) -> f64 {
    (&patch.transposed() * &(energy * patch))[(0, 0)].to_f64()
}

/// The energies of the first rings, Catmull-Clark's and guided.
fn energies(chi: &CharacteristicRing, heights: &[Real]) -> [f64; 2] {
    let numbering = CNet { valence: chi.valence };
    let column = Matrix::from_fn(heights.len(), 1, |node, _| heights[node]);
    let guide = guide(&generating_matrix(chi), chi.valence, &column);
    let rings = Rings::new(chi, Form::Bi5);
    let measures = [3, 5].map(|degree| SQUARES.map(|square| ring_energy(chi, square, degree)));
    let mut net = Net { numbering, nodes: heights.to_vec() };
    let mut scale = 1.0;
    let mut sums = [0.0; 2];
    for level in 0..LEVELS {
        for (s, guided) in rings.ring(level, &guide, &column).iter().enumerate() {
            for (k, corner) in [(1, 0), (1, 1), (0, 1)].into_iter().enumerate() {
                let patch = net.patch(s as isize, corner);
                sums[0] += scale * energy_of(&measures[0][k], &patch);
                sums[1] += scale * energy_of(&measures[1][k], &guided[k]);
            }
        }
        net = net.refined_net();
        scale /= chi.lambda.to_f64().powi(4);
    }
    sums
}

/// Heights over the characteristic net: one node pulled out, and quadratic and cubic shapes.
fn shapes(chi: &CharacteristicRing) -> Vec<(&'static str, Vec<Real>)> {
    let net = CNet { valence: chi.valence };
    let plane = chi.net();
    let c = Real::cos_of_turn(chi.valence);
    let s = (Real::ONE - c * c).sqrt();
    let over = |f: &dyn Fn(Real, Real) -> Real| -> Vec<Real> {
        let at = |node: usize| {
            let (u, v) = (plane[(node, 0)], plane[(node, 1)]);
            f(u + c * v, s * v)
        };
        (0..net.num_nodes()).map(at).collect()
    };
    let spike = |a, b| -> Vec<Real> {
        let pulled = net.index(0, a, b);
        (0..net.num_nodes()).map(|k| Real::from(i32::from(k == pulled))).collect()
    };
    vec![
        ("bowl", over(&|x, y| x * x + y * y)),
        ("elliptic bowl", over(&|x, y| x * x + Real::ratio(7, 20) * y * y)),
        ("saddle", over(&|x, y| x * x - y * y)),
        ("monkey saddle", over(&|x, y| x * x * x - Real::from(3) * x * y * y)),
        ("spike beside", spike(1, 1)),
        ("spike on a line", spike(0, 1)),
        ("spike in the middle", spike(0, 0)),
    ]
}

#[test]
fn guided_surfaces_are_fairer_than_those_of_catmull_clark_subdivision() {
    for n in [3, 5, 6, 8] {
        let chi = CharacteristicRing::catmull_clark(n);
        for (name, heights) in shapes(&chi) {
            let [catmull_clark, guided] = energies(&chi, &heights);
            println!("n = {n}, {name}: {:.3}", guided / catmull_clark);
            assert!(guided < catmull_clark, "{name}, n = {n}: {guided} >= {catmull_clark}");
        }
    }
}

#[test]
fn the_catmull_clark_rings_of_the_characteristic_net_are_its_multiples() {
    for n in [3, 5, 8] {
        let chi = CharacteristicRing::catmull_clark(n);
        let nodes = (0..6 * n + 1).map(|node| chi.net()[(node, 0)]).collect();
        let net = Net { numbering: CNet { valence: n }, nodes };
        for (net, scale) in [(net.refined_net(), chi.lambda), (net, Real::ONE)] {
            for (square, corner) in SQUARES.into_iter().zip([(1, 0), (1, 1), (0, 1)]) {
                let exact = &chi.square(square)[0];
                let found = net.patch(0, corner);
                for k in 0..16 {
                    let error = found[(k, 0)] - scale * exact[(k / 4, k % 4)];
                    assert!(error.abs().to_f64() < 1e-28, "n = {n}, {square:?}");
                }
            }
        }
    }
}
