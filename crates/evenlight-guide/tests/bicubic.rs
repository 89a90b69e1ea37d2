//! The bi-3 family at valence 4: a step of QAS3 is T (QAS4) T^-1 with T from bi-4 to bi-3 d-nets,
//! and on the d-net of a uniform bi-3 spline, with the spline's own q, it is knot insertion.
//!
//! Here a d-net of valence 4 covers the plane: node (x, y) lies x half steps along line 0 and y
//! along line 1, |x|, |y| <= 3; the sectors are quarter turns of sector 0, and a node of sector s
//! is named by its distances (a, b) from the centre along lines s-1 and s.

use evenlight_guide::linear::Matrix;
use evenlight_guide::nets::{DNet, own_nodes};
use evenlight_guide::quadratic::{Q_POINTS, turn};
use evenlight_guide::quadratic_attraction::{QAS_ORDER, quadratic_attraction};
use evenlight_guide::real::Real;
use evenlight_guide::rules::{RULES, StepRule, TURNS};
use evenlight_guide::spline::{raised_cubic, refined, refined_cubic};

/// Weights of univariate nodes.
type Mask = Vec<(isize, Real)>;

/// A reproducible number in [-1, 1) for every index.
fn scattered(index: usize) -> Real {
    let mixed = (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    Real::from((mixed >> 33) as i32 as f64 / (1u64 << 30) as f64 - 1.0)
}

fn error(a: Real, b: Real) -> f64 {
    (a - b).abs().to_f64()
}

/// The place (x, y) of the node of sector `s` at the distances (a, b) along its lines.
fn place(s: usize, a: isize, b: isize) -> (isize, isize) {
    (0..s).fold((b, -a), |(x, y), _| (-y, x))
}

/// A tensor product of masks on the nodes of the plane.
fn tensor(node: &dyn Fn(isize, isize) -> Real, along_x: &Mask, along_y: &Mask) -> Real {
    let terms = along_x
        .iter()
        .flat_map(|&(x, wx)| along_y.iter().map(move |&(y, wy)| wx * wy * node(x, y)));
    terms.sum()
}

/// The change from bi-4 to bi-3 d-nets in one variable; even positions are grid lines.
fn to_cubic(position: isize) -> Mask {
    on_grid_lines(
        position,
        [(-1, Real::ratio(1, 8)), (0, Real::ratio(6, 8)), (1, Real::ratio(1, 8))],
    )
}

/// Its inverse.
fn to_quartic(position: isize) -> Mask {
    on_grid_lines(
        position,
        [(-1, Real::ratio(-1, 6)), (0, Real::ratio(8, 6)), (1, Real::ratio(-1, 6))],
    )
}

fn on_grid_lines(position: isize, mask: [(isize, Real); 3]) -> Mask {
    match position.rem_euclid(2) {
        0 => mask.map(|(k, weight)| (position + k, weight)).to_vec(),
        _ => vec![(position, Real::ONE)],
    }
}

/// The 48 nodes of a d-net of valence 4 in flat order.
fn flat(node: &dyn Fn(isize, isize) -> Real) -> Vec<Real> {
    let names = (0..4).flat_map(|s| own_nodes().map(move |(i, j)| (s, i, j)));
    names
        .map(|(s, i, j)| place(s, 3 - i as isize, 3 - j as isize))
        .map(|(x, y)| node(x, y))
        .collect()
}

/// q_1..q_6 of sector 0 from value and derivatives f, f_u, f_v, f_uu, f_uv, f_vv at the centre.
fn quadratic([f, fu, fv, fuu, fuv, fvv]: [Real; 6]) -> Matrix {
    let point = |(a, b): (usize, usize)| {
        let square = |m: usize| Real::ratio((m * m) as i32 - m as i32, 40);
        let mixed = Real::ratio((a * b) as i32, 20);
        let linear = fu * Real::ratio(a as i32, 5) + fv * Real::ratio(b as i32, 5);
        f + linear + fuu * square(a) + fuv * mixed + fvv * square(b)
    };
    let points = Q_POINTS.map(point);
    Matrix::from_fn(6, 1, |row, _| points[row])
}

/// The derivatives at the centre of a uniform bi-3 spline, in sector 0 and in units of its own
/// knot distance.
fn centre_of_spline(node: &dyn Fn(isize, isize) -> Real) -> [Real; 6] {
    let masks: [Mask; 3] = [
        vec![(-1, Real::ratio(1, 6)), (0, Real::ratio(4, 6)), (1, Real::ratio(1, 6))],
        vec![(-1, Real::ratio(-1, 2)), (1, Real::ratio(1, 2))],
        vec![(-1, Real::ONE), (0, Real::from(-2)), (1, Real::ONE)],
    ];
    let in_sector = |a: isize, b: isize| {
        let (x, y) = place(0, a, b);
        node(x, y)
    };
    [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
        .map(|(u, v)| tensor(&in_sector, &masks[u], &masks[v]))
}

/// One step of QAS4 at valence 4: the refined d-net.
fn quartic_step(net: &[Real], q: &Matrix) -> Vec<Real> {
    let rules = quadratic_attraction(4, QAS_ORDER).nodes;
    let mut refined_net = Vec::new();
    let mut q = q.clone();
    for s in 0..4 {
        let own: Vec<Real> = [&net[12 * s..], &net[..12 * s]].concat();
        for node in own_nodes() {
            refined_net.push(match RULES.iter().position(|&rule| rule == node) {
                Some(number) => special(&rules[number], &own, &q),
                None => regular(node, &own),
            });
        }
        q = &turn(4) * &q;
    }
    refined_net
}

/// A new node by its rule, on net and q as seen from its sector.
fn special(rule: &StepRule, net: &[Real], q: &Matrix) -> Real {
    let next = &turn(4) * q;
    let [on_own, on_next] = rule.on_quadratics();
    let by_net = TURNS.into_iter().zip(&rule.kappa).flat_map(|(r, row)| {
        own_nodes().zip(row).map(move |((i, j), &w)| (DNet { valence: 4 }.index(r, i, j), w))
    });
    let by_net: Real = by_net.map(|(node, w)| w * net[node]).sum();
    let by_q: Real =
        (0..5).map(|m| on_own[m] * q[(m + 1, 0)] + on_next[m] * next[(m + 1, 0)]).sum();
    by_net + by_q + rule.on_centre * q[(0, 0)]
}

/// A new node with index 0 by knot insertion.
fn regular((h, k): (usize, usize), net: &[Real]) -> Real {
    let node =
        |a: isize, b: isize| net[DNet { valence: 4 }.index(0, (3 - a) as usize, (3 - b) as usize)];
    tensor(&node, &refined(3 - h as isize), &refined(3 - k as isize))
}

/// The six special nodes of sector 0 after one step of QAS3.
fn cubic_step(node: &dyn Fn(isize, isize) -> Real, q: &Matrix) -> Vec<Real> {
    let quartic = |x: isize, y: isize| tensor(node, &to_quartic(x), &to_quartic(y));
    let refined_net = quartic_step(&flat(&quartic), q);
    let in_sector = |a: isize, b: isize| {
        refined_net[DNet { valence: 4 }.index(0, (3 - a) as usize, (3 - b) as usize)]
    };
    let new = |(h, k): (usize, usize)| {
        tensor(&in_sector, &to_cubic(3 - h as isize), &to_cubic(3 - k as isize))
    };
    RULES.map(new).to_vec()
}

/// The same nodes by uniform knot insertion.
fn knot_insertion(node: &dyn Fn(isize, isize) -> Real) -> Vec<Real> {
    let in_sector = |a: isize, b: isize| {
        let (x, y) = place(0, a, b);
        node(x, y)
    };
    let new = |(h, k): (usize, usize)| {
        tensor(&in_sector, &refined_cubic(3 - h as isize), &refined_cubic(3 - k as isize))
    };
    RULES.map(new).to_vec()
}

/// A uniform bi-3 spline with knots on grid lines only.
fn coarse(x: isize, y: isize) -> Real {
    scattered((x + 8 + 17 * (y + 8)) as usize)
}

/// The same with a knot at every half step: its d-net.
fn halved(x: isize, y: isize) -> Real {
    tensor(&coarse, &refined_cubic(x), &refined_cubic(y))
}

#[test]
fn the_change_of_basis_takes_knot_insertion_to_degree_raising() {
    for (x, y) in (-3..=3).flat_map(|x| (-3..=3).map(move |y| (x, y))) {
        let raised = tensor(&coarse, &raised_cubic(x), &raised_cubic(y));
        assert!(error(tensor(&halved, &to_quartic(x), &to_quartic(y)), raised) < 1e-29);
    }
}

#[test]
fn at_valence_4_qas3_with_the_splines_own_quadratic_is_knot_insertion() {
    let q = quadratic(centre_of_spline(&coarse));
    for ((new, regular), (h, k)) in
        cubic_step(&halved, &q).into_iter().zip(knot_insertion(&halved)).zip(RULES)
    {
        assert!(error(new, regular) < 1e-28, "node {h}{k}: {:e}", error(new, regular));
    }
}

/// A general d-net has knots at half steps inside its sectors. QAS3 does not keep these: it goes
/// by way of bi-4 splines, which have none there.
#[test]
fn splines_with_knots_inside_the_sectors_are_approximated_only() {
    let in_half_steps = centre_of_spline(&coarse);
    let [two, four] = [2, 4].map(Real::from);
    let [f, fu, fv, fuu, fuv, fvv] = in_half_steps;
    let q = quadratic([f, two * fu, two * fv, four * fuu, four * fuv, four * fvv]);
    let errors = cubic_step(&coarse, &q).into_iter().zip(knot_insertion(&coarse));
    let largest = errors.map(|(new, regular)| error(new, regular)).fold(0.0, f64::max);
    assert!(0.05 < largest && largest < 0.2, "{largest} for nodes of size 1");
}
