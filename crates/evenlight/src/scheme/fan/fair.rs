//! Fair rings beside an infinitely sharp crease or the boundary. Ours, in no paper.
//!
//! The crease is, as always, the cubic spline of its own vertices, so that both sides meet. Inside
//! the fan the rules have least energy, as in fairness-optimal subdivision (chapter 8): refinement
//! is d' = A d + B u, where the control u is the nodes that knot insertion does not give. The nodes
//! on the crease are part of u, since its curve has nodes of its own (module `net`).
//!
//! 1. **Characteristic map.** The crease runs along x, its nodes shrinking by 1/2, so the map
//!    shrinks by 1/2 in y too. Of all nets that may do so, it is the nearest to the map that scales
//!    angles (module `energy`), by |D^2|^2.
//! 2. **Eigen-nets** D of x^2 and x y, with eigenvalue 1/4, likewise by |D^2 (ring - m)|^2. There
//!    is no eigen-net of y^2: the normal curvature across the crease is 0 at a regular point of the
//!    crease, and tends to 0 here.
//! 3. **Regulator.** Let e = d - D q, where q has the coefficients of x, y, x^2, x y. The sum over
//!    rings l of 16^l (|D^3 ring(e)|^2 + |D^2 ring(e)|^2 + .001 |e|^2) is least with v = K e
//!    (module `regulator`). The coefficients of x and x^2 follow from the crease; those of y and
//!    x y are chosen such that e costs least.
//!
//! So the eigenvalues are 1/2 twice, 1/4 twice, and then the eigenvalues of e, which are at most
//! 1/8 up to rounding: the surface has a tangent plane and bounded curvature for any number of
//! faces.

mod energy;
mod net;
mod regulator;

use std::sync::OnceLock;

use super::{FanLimit, Net as CoarseNet, Tangents};
use crate::dense::Matrix;
use crate::net::{Fan, VertexRule};
use crate::scheme::rules::{Row, Rules, Symmetry};
use crate::scheme::subdominant::Subdominant;
use energy::{Polar, RingChart, RingForms};
use net::{Net, SPLINE_NODES};
use regulator::Regulator;

/// The most faces between two sharp edges for which there are fair rules (`CreaseRings::Fair`):
/// with more faces sectors are slivers. From eight faces on the outer rings have more energy than
/// Catmull-Clark's, the inner rings far less (chapter 11).
pub const MAX_FAIR_FACES: usize = 12;

/// The rules that make the rings of a fair fan.
#[derive(Clone, Debug)]
pub(crate) struct FairFan {
    pub(crate) rules: Rules,
    pub(crate) limit: FanLimit,
    pub(crate) subdominant: Subdominant,
}

/// Whether there are fair rules for a fan: on one side of a crease or at a boundary, if it is not
/// regular.
pub(crate) fn is_fair(shape: Fan) -> bool {
    shape.rule == VertexRule::Crease
        && !shape.is_closed
        && !shape.is_regular()
        && shape.faces <= MAX_FAIR_FACES
}

/// The fair rules of a fan, derived once; `None` if there are none.
pub(crate) fn fair_rules(shape: Fan) -> Option<&'static FairFan> {
    static DERIVED: [OnceLock<FairFan>; MAX_FAIR_FACES + 1] =
        [const { OnceLock::new() }; MAX_FAIR_FACES + 1];
    is_fair(shape).then(|| DERIVED[shape.faces].get_or_init(|| FairFan::derive(shape)))
}

/// The spline nodes of x and of x^2: a and a^2 - 1/3 at both ends.
const LINE: [f64; SPLINE_NODES] = [1.0, 2.0, 3.0, -1.0, -2.0, -3.0];
const PARABOLA: [f64; SPLINE_NODES] =
    [2.0 / 3.0, 11.0 / 3.0, 26.0 / 3.0, 2.0 / 3.0, 11.0 / 3.0, 26.0 / 3.0];

impl FairFan {
    fn derive(shape: Fan) -> Self {
        let net = Net { faces: shape.faces };
        let regulator = Regulator::new(net);
        let nets = eigen_nets(&regulator);
        let step = refinement(&regulator, &nets);
        let left = tangent_rows(net, &step, &nets);
        let n = net.num_nodes();
        let column = |j: usize| (0..n).map(|k| nets.columns[(k, j)]).collect::<Vec<_>>();
        let patches = (0..shape.faces as isize).flat_map(|s| (0..12).map(move |k| net.patch(s, k)));
        let rules = Rules {
            valence: shape.faces,
            symmetry: Symmetry::None,
            nodes_per_sector: n,
            refine: (0..n).map(|k| sparse(step.row(k))).collect(),
            degree: 3,
            split: 2,
            patches: patches.collect(),
            quadratic: None,
            guide: None,
        };
        let subdominant = Subdominant::with_plane(0.5, [column(0), column(1)], left);
        let coarse = CoarseNet::new(shape);
        let limit = FanLimit {
            shape,
            lambda: 0.5,
            point: coarse.limit.clone().into_iter().collect(),
            tangents: Tangents::OfRules,
            first_net: Some(first_net(&coarse, net)),
            cells: (0..shape.faces as isize).map(|s| net.cells(s)).collect(),
        };
        Self { rules, limit, subdominant }
    }
}

/// The net of the rules as weights of the net of the fan: its refinement without the vertex.
fn first_net(coarse: &CoarseNet, net: Net) -> Vec<Row> {
    let row = |(s, a, b)| coarse.refined(s, a, b).into_iter().collect();
    let last = coarse.faces() - 1;
    let spline = (1..4).map(|a| (0, a, 0)).chain((1..4).map(|a| (last, 0, a)));
    net.places().chain(spline).map(row).collect()
}

fn sparse(row: &[f64]) -> Row {
    row.iter().copied().enumerate().filter(|&(_, w)| w != 0.0).collect()
}

/// The nets D of x, y, x^2, x y, as columns, and the energies by the characteristic map.
struct EigenNets {
    columns: Matrix,
    forms: RingForms,
}

/// The eigenvalues of the nets D.
const FACTORS: [f64; 4] = [0.5, 0.5, 0.25, 0.25];

fn eigen_nets(regulator: &Regulator) -> EigenNets {
    let net = regulator.net;
    let polar = RingForms::new(net, &Polar { faces: net.faces });
    let none = [0.0; SPLINE_NODES];
    // The conditions leave errors of 1e-10; they must not make the rules asymmetric.
    let symmetric = |x: Vec<f64>, sign: f64| mirrored_mean(net, &x, sign);
    let x = symmetric(regulator.eigen_net(0.5, LINE, &polar.second, None), -1.0);
    let y = regulator.eigen_net(0.5, none, &polar.second, Some(&polar.with_y));
    let mut y = symmetric(y, 1.0);
    // As long as y, for which it stands.
    let length = (0..y.len()).map(|k| (polar.with_y[k] + 0.5 * polar.with_y[y.len() + k]) * y[k]);
    let scale = polar.area / length.sum::<f64>();
    y.iter_mut().for_each(|y| *y *= scale);
    let forms = RingForms::new(net, &ring_chart(net, [&x, &y]));
    let [with_xx, with_xy] = &forms.with_quadratics;
    let xx = symmetric(regulator.eigen_net(0.25, PARABOLA, &forms.second, Some(with_xx)), 1.0);
    let xy = symmetric(regulator.eigen_net(0.25, none, &forms.second, Some(with_xy)), -1.0);
    let rows: Vec<Vec<f64>> = (0..x.len()).map(|k| vec![x[k], y[k], xx[k], xy[k]]).collect();
    EigenNets { columns: Matrix::from_rows(4, &rows), forms }
}

/// The mean of a net and `sign` times its mirror image.
fn mirrored_mean(net: Net, x: &[f64], sign: f64) -> Vec<f64> {
    let image = net.mirror_images();
    x.iter().zip(image).map(|(&own, k)| 0.5 * (own + sign * x[k])).collect()
}

/// The ring of the characteristic net, which refines to half of itself.
fn ring_chart(net: Net, coordinates: [&[f64]; 2]) -> RingChart {
    let of_patch = |s: usize, which: usize| {
        let rule = net.patch(s as isize, which);
        coordinates.map(|x| {
            let sum = |row: &Row, w: f64| row.iter().map(|&(k, y)| w * y * x[k]).sum::<f64>();
            std::array::from_fn(|k| sum(&rule.old[k], 1.0) + sum(&rule.new[k], 0.5))
        })
    };
    let patches = (0..net.faces).flat_map(|s| (0..12).map(move |which| of_patch(s, which)));
    RingChart { patches: patches.collect() }
}

/// The tangent of the crease, by its nodes: (P_1 - P_1') / 2.
fn crease_tangent(net: Net) -> Vec<f64> {
    let (first, mut row) = (net.first_spline_node(), vec![0.0; net.num_nodes()]);
    (row[first], row[first + 3]) = (0.5, -0.5);
    row
}

/// Half its second derivative: 3/4 (P_1 + P_1').
fn crease_bend(net: Net) -> Vec<f64> {
    let (first, mut row) = (net.first_spline_node(), vec![0.0; net.num_nodes()]);
    (row[first], row[first + 3]) = (0.75, 0.75);
    row
}

/// The whole refinement: D S q + (A + B K) e.
fn refinement(regulator: &Regulator, nets: &EigenNets) -> Matrix {
    let (net, n, free) = (regulator.net, regulator.net.num_nodes(), &regulator.free);
    let [to_go, gain] = regulator.optimum(&nets.forms, &bounded_creases(net));
    let q = quadratic(net, nets, &to_go);
    let mut rest = nets.columns.times(&q).scaled(-1.0);
    rest.add(1.0, &Matrix::identity(n));
    let mut control = gain.times(&rest);
    let shrunk: Vec<Vec<f64>> =
        free.iter().map(|&k| (0..4).map(|j| FACTORS[j] * nets.columns[(k, j)]).collect()).collect();
    control.add(1.0, &Matrix::from_rows(4, &shrunk).times(&q));
    let control = mirrored_rules(net, &control, free);
    let mut step = regulator.step.clone();
    for (k, &at) in free.iter().enumerate() {
        (0..n).for_each(|j| step[(at, j)] = control[(k, j)]);
    }
    step
}

/// Takes the tangent and the bend out of the crease's nodes.
fn bounded_creases(net: Net) -> Matrix {
    let (tangent, bend) = (crease_tangent(net), crease_bend(net));
    let mut allowed = Matrix::identity(net.num_nodes());
    for k in 0..SPLINE_NODES {
        for j in 0..net.num_nodes() {
            let at = (net.first_spline_node() + k, j);
            allowed[at] -= LINE[k] * tangent[j] + PARABOLA[k] * bend[j];
        }
    }
    allowed
}

/// q of a net: x and x^2 follow from the crease, y and x y make the rest cost least.
fn quadratic(net: Net, nets: &EigenNets, to_go: &Matrix) -> Matrix {
    let n = net.num_nodes();
    let rows = [crease_tangent(net), crease_bend(net)];
    let pair = |i: usize, j: usize| {
        let rows: Vec<Vec<f64>> =
            (0..n).map(|k| vec![nets.columns[(k, i)], nets.columns[(k, j)]]).collect();
        Matrix::from_rows(2, &rows)
    };
    let (by_crease, others) = (pair(0, 2), pair(1, 3));
    let mut rest = by_crease.times(&Matrix::from_rows(n, &rows)).scaled(-1.0);
    rest.add(1.0, &Matrix::identity(n));
    let weighted = others.transposed().times(to_go);
    let solved = weighted.times(&others).solve(weighted.times(&rest));
    let [x, xx] = rows;
    Matrix::from_rows(n, &[x, solved.row(0).to_vec(), xx, solved.row(1).to_vec()])
}

/// The mean of the rules and their mirror image, which differ by rounding.
fn mirrored_rules(net: Net, control: &Matrix, free: &[usize]) -> Matrix {
    let image = net.mirror_images();
    let place = |node: usize| free.partition_point(|&k| k < node);
    let mut mean = control.clone();
    for (i, &node) in free.iter().enumerate() {
        for j in 0..net.num_nodes() {
            mean[(i, j)] = 0.5 * (control[(i, j)] + control[(place(image[node]), image[j])]);
        }
    }
    mean
}

/// The left eigenvectors of x and y. All other eigenvalues are 1/4 at most, so every step of the
/// iteration halves the error.
fn tangent_rows(net: Net, step: &Matrix, nets: &EigenNets) -> [Vec<f64>; 2] {
    let n = net.num_nodes();
    // Any row that is 1 on y and 0 on x will do.
    let column = |j: usize| (0..n).map(|k| nets.columns[(k, j)]).collect::<Vec<_>>();
    let (x, y, tangent) = (column(0), column(1), crease_tangent(net));
    let along = |row: &[f64], of: &[f64]| row.iter().zip(of).map(|(a, b)| a * b).sum::<f64>();
    let length = along(&y, &y);
    let skew = along(&y, &x) / length;
    let start: Vec<f64> = (0..n).map(|k| y[k] / length - skew * tangent[k]).collect();
    let mut row = Matrix::from_rows(n, &[start]);
    for _ in 0..LEFT_STEPS {
        row = row.times(step).scaled(2.0);
    }
    [tangent, row.row(0).to_vec()]
}

/// 2^-60 is below rounding.
const LEFT_STEPS: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(faces: usize) -> Fan {
        Fan { faces, is_closed: false, has_dart: false, rule: VertexRule::Crease }
    }

    const FACES: [usize; 8] = [1, 3, 4, 5, 6, 8, 10, 12];

    fn largest_difference(a: &Matrix, b: &Matrix) -> f64 {
        let mut difference = a.clone();
        difference.add(-1.0, b);
        difference.largest()
    }

    struct Derived {
        net: Net,
        nets: EigenNets,
        step: Matrix,
    }

    fn derived(faces: usize) -> Derived {
        let net = Net { faces };
        let regulator = Regulator::new(net);
        let nets = eigen_nets(&regulator);
        let step = refinement(&regulator, &nets);
        Derived { net, nets, step }
    }

    /// The eigenvalues are 1/2 twice and 1/4 twice; what is left dies by 1/8 in a step.
    #[test]
    fn tangents_shrink_by_a_half_quadratics_by_a_quarter_and_the_rest_by_an_eighth() {
        for faces in FACES {
            let Derived { net, nets, step } = derived(faces);
            let factors = Matrix::from_rows(
                4,
                &(0..4)
                    .map(|j| (0..4).map(|k| if j == k { FACTORS[k] } else { 0.0 }).collect())
                    .collect::<Vec<_>>(),
            );
            let gap = largest_difference(&step.times(&nets.columns), &nets.columns.times(&factors));
            assert!(gap < 1e-14, "{faces}: {gap:e}");
            let mut power = Matrix::identity(net.num_nodes());
            for l in 0..24 {
                power = step.times(&power);
                let own = [0.5_f64, 0.25].map(|x| x.powi(l + 1));
                // (M - 1/2) (M - 1/4) M^l: zero on D.
                let mut rest = step.times(&step.times(&power));
                rest.add(-0.75, &step.times(&power));
                rest.add(0.125, &power);
                let bound = 2e3 * 0.126_f64.powi(l + 1) + 1e-13 * own[0];
                assert!(rest.largest() < bound, "{faces}, {l}: {:e} {bound:e}", rest.largest());
            }
        }
    }

    /// The rules equal the rules of the fan seen from behind with the lines in reverse.
    #[test]
    fn the_rules_are_symmetric() {
        for faces in FACES {
            let Derived { net, step, .. } = derived(faces);
            let image = net.mirror_images();
            for i in 0..net.num_nodes() {
                for j in 0..net.num_nodes() {
                    assert!((step[(i, j)] - step[(image[i], image[j])]).abs() < 1e-15);
                }
            }
        }
    }

    /// The characteristic map is regular, and nearly of constant area.
    #[test]
    fn the_characteristic_map_is_regular() {
        for faces in FACES {
            let Derived { net, nets, .. } = derived(faces);
            let column = |j: usize| (0..net.num_nodes()).map(|k| nets.columns[(k, j)]).collect();
            let [x, y]: [Vec<f64>; 2] = [column(0), column(1)];
            let chart = ring_chart(net, [&x, &y]);
            for (s, which) in (0..faces).flat_map(|s| (0..12).map(move |which| (s, which))) {
                for k in 0..25 {
                    let at = [f64::from(k / 5) / 4.0, f64::from(k % 5) / 4.0];
                    let [x, y] = energy::Chart::series(&chart, s, which, at);
                    // Steps of a patch are half a step of the net; angles are scaled by 2/f.
                    let jacobian = 2.0 * faces as f64 * (x[1] * y[2] - x[2] * y[1]);
                    assert!((0.9..1.1).contains(&jacobian), "{faces} {s} {which}: {jacobian}");
                }
            }
        }
    }

    /// The rows of the tangent plane find x and y.
    #[test]
    fn tangents_are_found() {
        for faces in FACES {
            let fair = fair_rules(shape(faces)).unwrap();
            let net = fair.subdominant.characteristic_net();
            let [x, y] = fair.subdominant.tangential(&net);
            assert!((x[0] - 1.0).abs() + x[1].abs() < 1e-13, "{faces}: {x:?}");
            assert!((y[1] - 1.0).abs() + y[0].abs() < 1e-13, "{faces}: {y:?}");
            // A row that is no eigenvector would not find them in the refined net.
            let unit = |k: usize| -> Vec<[f64; 3]> {
                (0..net.len()).map(|i| [f64::from(u8::from(i == k)), 0.0, 0.0]).collect()
            };
            for k in 0..net.len() {
                let before = fair.subdominant.tangential(&unit(k));
                let after = fair.subdominant.tangential(&fair.rules.refine(&unit(k)));
                for (a, b) in before.iter().zip(&after) {
                    assert!((0.5 * a[0] - b[0]).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn fans_that_are_not_on_a_crease_have_no_fair_rules() {
        let closed = Fan { is_closed: true, has_dart: true, rule: VertexRule::Smooth, ..shape(5) };
        let others = [closed, Fan { rule: VertexRule::Corner, ..shape(3) }, shape(2), shape(13)];
        assert!(others.into_iter().all(|shape| fair_rules(shape).is_none()));
        assert!(FACES.into_iter().all(|faces| fair_rules(shape(faces)).is_some()));
    }
}
