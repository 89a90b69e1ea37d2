//! The plane over which a cap lies: the map of a sector, and derivatives in its Cartesian
//! coordinates.
//!
//! Rings lie over the characteristic ring chi, scaled by lambda^l; the hole is covered by the map
//! zeta, a cap of the plane: it continues chi with first derivatives, joins its images in the other
//! sectors as every cap does, and among these bends least. Complex coordinates have the origin at
//! the centre, the bisectrix of sector 0 along the real axis, and the ends of the outer edges at
//! distance 1.
//!
//! A surface x(u,v) that is a polynomial of zeta must bend as that polynomial does. So fairness is
//! measured by the derivatives of x by zeta.

use super::sector::{Complex, LAYERS, Sector};
use super::spline::inverted;
use crate::dense::{Matrix, constrained_least_squares};
use crate::pairs::pairs;
use crate::quadrature::GAUSS_7;

/// The weight of tangency against bending, where tangency cannot be exact.
pub(super) const TANGENCY: f64 = 1e3;

/// Whether the tangency of a sector's splines can be exact: for bi-3 it cannot. With C1 at the
/// joints and a quadratic 2c(1-u)^2, a line would be one parabola, which has three coefficients
/// where five data are given.
pub(super) fn is_exact(sector: &Sector) -> bool {
    sector.space.degree > 3
}

/// The conditions of a mode, and the rows whose least squares keep tangency where it is not exact.
pub(super) fn conditions(sector: &Sector, mode: usize) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
    let mut exact = sector.continuity(mode);
    let mut tangency = sector.tangency(mode);
    if is_exact(sector) {
        exact.append(&mut tangency);
    }
    for row in &mut tangency {
        row.iter_mut().for_each(|x| *x *= TANGENCY);
    }
    (exact, tangency)
}

/// The coefficients of the map zeta in sector 0 for the border data of chi.
pub(super) fn map(sector: &Sector, border: &[Complex]) -> Vec<Complex> {
    // The map is a function of mode 1 and its own mirror image.
    let real: Vec<f64> = border.iter().map(|[x, y]| x + y).collect();
    let mut unknowns = Vec::new();
    let mut known = vec![0.0; sector.num_coefs()];
    for (at, known) in known.iter_mut().enumerate() {
        let (i, j) = (at / sector.space.dim(), at % sector.space.dim());
        match sector.on_border(i, j) {
            Some(weights) => *known = weights.iter().map(|&(k, w)| w * real[k]).sum(),
            None if at == 0 => {}
            None => unknowns.push(at),
        }
    }
    let (exact, soft) = conditions(sector, 1);
    let select = |rows: &[Vec<f64>]| {
        let row = |row: &Vec<f64>| {
            let rest: f64 = row.iter().zip(&known).map(|(a, b)| a * b).sum();
            unknowns.iter().map(|&at| row[at]).chain([rest]).collect()
        };
        Matrix::from_rows(unknowns.len() + 1, &rows.iter().map(row).collect::<Vec<_>>())
    };
    let objective: Vec<Vec<f64>> = bending(sector).into_iter().chain(soft).collect();
    let x = constrained_least_squares(unknowns.len(), &select(&exact), &select(&objective));
    let mut z = known;
    unknowns.iter().enumerate().for_each(|(k, &at)| z[at] = x[(k, 0)]);
    sector.complex(&z)
}

/// The rows of F_k, the integral of sum_(i+j=k) k!/(i!j!) (d_u^i d_v^j z)^2 over the square: k = 5
/// for bi-6 [KP18-Guided, App. B], 3 for lower degrees.
fn bending(sector: &Sector) -> Vec<Vec<f64>> {
    let k = if sector.space.degree == 6 { 5 } else { 3 };
    let mut rows = Vec::new();
    for (at, weight) in sector.nodes() {
        let taylor = sector.taylor(at, k + 1);
        for p in 0..=k {
            let factor = (weight * factorial(k) * factorial(p) * factorial(k - p)).sqrt();
            rows.push(scaled(factor, &taylor[(k + 1) * p + k - p]));
        }
    }
    rows
}

/// The rows of the integral of |D^3 x|^2 over the hole, with derivatives and area of the plane.
pub(super) fn fairness(sector: &Sector, map: &[Complex]) -> Vec<Vec<f64>> {
    let mut rows = Vec::new();
    for (at, weight) in sector.nodes() {
        let taylor = sector.taylor(at, 4);
        let zeta: Vec<Complex> = taylor.iter().map(|row| complex_sum(row, map)).collect();
        let [[ux, uy], [vx, vy]] = [zeta[4], zeta[1]];
        let area = weight * (ux * vy - uy * vx).abs();
        rows.extend(
            derivatives(&zeta, 3, &taylor).into_iter().map(|row| scaled(area.sqrt(), &row)),
        );
    }
    rows
}

/// The rows of the integral along the outer edges of the squared jump of the second derivatives
/// D^2 in the plane, between the cap over `map` and the last ring over chi, whose border data are
/// `chi`: on z, then on the border data.
pub(super) fn mismatch(sector: &Sector, map: &[Complex], chi: &[Complex]) -> Vec<Vec<f64>> {
    let (dim, pieces) = (sector.space.dim(), sector.space.pieces);
    let mut rows = Vec::new();
    for (edge, piece) in pairs(2, pieces) {
        for (t, weight) in GAUSS_7 {
            let end = (pieces - 1, 1.0);
            let at = if edge == 0 { [end, (piece, t)] } else { [(piece, t), end] };
            let own = sector.taylor(at, 3);
            let along = sector.space.taylor(&sector.to_bb, piece, t, 3);
            let of_ring: Vec<Vec<f64>> = (0..9)
                .map(|k| {
                    let (p, q) = if edge == 0 { (k / 3, k % 3) } else { (k % 3, k / 3) };
                    let mut row = vec![0.0; sector.num_border()];
                    let first = (edge * LAYERS + p) * dim;
                    row[first..first + dim].copy_from_slice(&scaled(1.0 / factorial(p), &along[q]));
                    row
                })
                .collect();
            let over_map: Vec<Complex> = own.iter().map(|row| complex_sum(row, map)).collect();
            let over_chi: Vec<Complex> = of_ring.iter().map(|row| complex_sum(row, chi)).collect();
            let speed = if edge == 0 { over_chi[1] } else { over_chi[3] };
            let length = (speed[0] * speed[0] + speed[1] * speed[1]).sqrt();
            let factor = (weight * sector.space.step() * length).sqrt();
            let (cap, ring) =
                (derivatives(&over_map, 2, &own), derivatives(&over_chi, 2, &of_ring));
            rows.extend(cap.iter().zip(&ring).map(|(cap, ring)| {
                scaled(factor, cap).into_iter().chain(scaled(-factor, ring)).collect::<Vec<f64>>()
            }));
        }
    }
    rows
}

/// The 2-jet at the centre of a function of zeta, as BB coefficients in the order of
/// [`Sector::center`].
///
/// `zeta` is the 2-jet of zeta itself.
pub(super) fn center_jet(
    degree: usize,
    zeta: [Complex; 6],
    function: PlaneFunction,
) -> [Complex; 6] {
    let d = degree as f64;
    // With first derivatives D m u and D m v: what u^2, u v and v^2 become as BB coefficients.
    let (u, v) = (zeta[1], zeta[2]);
    let with_squares = |product: fn(Complex, Complex) -> Complex| {
        let times = |w: f64, [x, y]: Complex| [w * x, w * y];
        let double = 2.0 * d / (d - 1.0);
        let squares =
            [times(double, product(u, u)), times(2.0, product(u, v)), times(double, product(v, v))];
        [[0.0; 2], [0.0; 2], [0.0; 2], squares[0], squares[1], squares[2]]
    };
    match function {
        PlaneFunction::Linear => zeta,
        PlaneFunction::Radius => with_squares(|a, b| [a[0] * b[0] + a[1] * b[1], 0.0]),
        PlaneFunction::Square => {
            with_squares(|a, b| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]])
        }
        PlaneFunction::SquareConjugate => {
            with_squares(|a, b| [a[0] * b[0] - a[1] * b[1], -(a[0] * b[1] + a[1] * b[0])])
        }
    }
}

/// The functions of zeta that make up a quadratic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlaneFunction {
    /// zeta.
    Linear,
    /// |zeta|^2.
    Radius,
    /// zeta^2.
    Square,
    /// The conjugate of zeta^2, which at valence 3 turns like zeta.
    SquareConjugate,
}

/// Rows of all derivatives of order `k` by Cartesian coordinates; their squares sum to |D^k|^2.
/// They follow from the Taylor coefficients u^p v^q of zeta and from the rows of the coefficients
/// of a function, number (k+1) p + q.
fn derivatives(zeta: &[Complex], k: usize, taylor: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let monomials: Vec<(usize, usize)> =
        (0..=k).flat_map(|s| (0..=s).map(move |a| (a, s - a))).collect();
    let order = k + 1;
    let shifted = |part: usize| -> Vec<f64> {
        (0..order * order).map(|i| if i == 0 { 0.0 } else { zeta[i][part] }).collect()
    };
    let (x, y) = (shifted(0), shifted(1));
    let mut one = vec![0.0; order * order];
    one[0] = 1.0;
    let powers = |x: &[f64]| -> Vec<Vec<f64>> {
        let mut powers = vec![one.clone()];
        (0..k).for_each(|i| powers.push(truncated_product(&powers[i], x, order)));
        powers
    };
    let (x, y) = (powers(&x), powers(&y));
    let mut table = Matrix::zeros(monomials.len(), monomials.len());
    for (column, &(a, b)) in monomials.iter().enumerate() {
        let composed = truncated_product(&x[a], &y[b], order);
        for (row, &(p, q)) in monomials.iter().enumerate() {
            table[(row, column)] = composed[order * p + q];
        }
    }
    let inverse = inverted(&table);
    let last = monomials.len() - order..monomials.len();
    last.map(|which| {
        let (a, b) = monomials[which];
        let factor = (factorial(k) * factorial(a) * factorial(b)).sqrt();
        let mut sum = vec![0.0; taylor[0].len()];
        for (column, &(p, q)) in monomials.iter().enumerate() {
            let w = factor * inverse[(which, column)];
            sum.iter_mut().zip(&taylor[order * p + q]).for_each(|(sum, x)| *sum += w * x);
        }
        sum
    })
    .collect()
}

/// The product of two Taylor polynomials, powers from `order` on cut off.
fn truncated_product(a: &[f64], b: &[f64], order: usize) -> Vec<f64> {
    let entry = |i: usize, j: usize| {
        let splits = pairs(i + 1, j + 1);
        splits.map(|(k, l)| a[k * order + l] * b[(i - k) * order + j - l]).sum()
    };
    (0..order * order).map(|at| entry(at / order, at % order)).collect()
}

fn factorial(k: usize) -> f64 {
    (1..=k).map(|i| i as f64).product()
}

fn scaled(w: f64, row: &[f64]) -> Vec<f64> {
    row.iter().map(|x| w * x).collect()
}

/// A row applied to complex numbers.
pub(super) fn complex_sum(row: &[f64], values: &[Complex]) -> Complex {
    row.iter().zip(values).fold([0.0; 2], |sum, (w, z)| [sum[0] + w * z[0], sum[1] + w * z[1]])
}
