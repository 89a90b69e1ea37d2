//! The linear rules of a cap at one valence: from the last ring and the centre to the cap.
//!
//! In every Fourier mode the coefficients are the solution of a small least-squares problem under
//! the conditions of [`sector`](super::sector). Without a guide they minimise
//!
//! ```text
//!   integral over the hole of |D^3 x|^2  +  MISMATCH times the integral along its border of
//!                                           the squared jump of D^2 x,
//! ```
//!
//! both by the Cartesian coordinates of the plane ([`plane`](super::plane)), so that quadratics of
//! the plane are reproduced. With a guide g they minimise the squared distance of the BB
//! coefficients from the samples of g along the map of the plane. The solutions of all modes
//! together are weights of the data of the sectors around.

use super::guide::{SEXTIC, Samples, mirrored_datum};
use super::plane::{self, PlaneFunction};
use super::sector::{Complex, Sector, product};
use super::spline::Space;
use crate::angle::{cosine, sine};
use crate::dense::{Matrix, constrained_least_squares, triangle};
use crate::pairs::pairs;

/// How much the jump of second derivatives at the border counts against third derivatives inside.
const MISMATCH: f64 = 10.0;

/// The data at the centre, as weights of Cartesian functions of the plane:
/// x, y, x^2 + y^2, Re (x + iy)^2, Im (x + iy)^2.
pub(super) const PLANE_FUNCTIONS: usize = 5;

/// What a cap follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    /// The tangent plane of the scheme; the quadratic at the centre is unknown like the rest.
    Fair,
    /// A quadratic at the centre.
    Quadratic,
    /// A guide, whose domain is the plane scaled by this.
    Guide(f64),
}

/// The rules of a cap at one valence.
#[derive(Clone, Debug)]
pub(super) struct CapRules {
    pub(super) sector: Sector,
    /// For r = 0..n-1 the weights of the data of sector s + r in the coefficients of sector s.
    around: Vec<Matrix>,
    /// For every sector the weights of the data at the centre.
    center: Vec<Matrix>,
}

impl CapRules {
    /// The rules, where `chi` gives the border data of the plane in sector 0 for any splines, in
    /// complex coordinates.
    pub(super) fn new(
        valence: usize,
        space: Space,
        shape: Shape,
        chi: impl Fn(Space) -> Vec<Complex>,
    ) -> Self {
        let sector = Sector::new(valence, space);
        let (objective, zeta, samples) = if let Shape::Guide(scale) = shape {
            let samples = Samples::new(&sector, &chi(SEXTIC), scale);
            (samples.distance(&sector), samples.center, Some(samples))
        } else {
            let chi = chi(space);
            let map = plane::map(&sector, &chi);
            let center = sector.center().map(|at| map[at]);
            (fair_objective(&sector, &map, &chi), center, None)
        };
        let num_data = objective.num_columns() - sector.num_coefs();
        let mut rules = Self {
            around: vec![Matrix::zeros(sector.num_coefs(), num_data); valence],
            center: vec![Matrix::zeros(sector.num_coefs(), PLANE_FUNCTIONS); valence],
            sector,
        };
        for mode in 0..=valence / 2 {
            let problem = Mode::new(&rules.sector, mode, shape, zeta, samples.as_ref());
            let solution = problem.solve(&rules.sector, &objective);
            rules.add(mode, &problem, &solution);
        }
        rules
    }

    /// The data of one sector.
    pub(super) fn num_data(&self) -> usize {
        self.around[0].num_columns()
    }

    /// The spline coefficients of sector `s` from the data of all sectors, one after the other, and
    /// from the data at the centre.
    pub(super) fn coefs<const N: usize>(
        &self,
        s: usize,
        data: &[[f64; N]],
        center: &[[f64; N]],
    ) -> Vec<[f64; N]> {
        let n = self.sector.valence;
        let count = self.num_data();
        let mut coefs = vec![[0.0; N]; self.sector.num_coefs()];
        let mut add = |weights: &Matrix, data: &[[f64; N]]| {
            for (i, sum) in coefs.iter_mut().enumerate() {
                let terms = weights.row(i).iter().zip(data);
                terms.for_each(|(&w, &p)| crate::point::add_scaled(sum, w, p));
            }
        };
        for (r, weights) in self.around.iter().enumerate() {
            let from = (s + r) % n * count;
            add(weights, &data[from..from + count]);
        }
        add(&self.center[s], center);
        coefs
    }

    /// Adds the part of one mode. `solution` has a column for every datum of a sector, then for
    /// every given function of the plane.
    fn add(&mut self, mode: usize, problem: &Mode<'_>, solution: &Matrix) {
        let n = self.sector.valence;
        let count = self.num_data();
        let factor = if mode == 0 || 2 * mode == n { 1.0 } else { 2.0 } / n as f64;
        let column =
            |k: usize| -> Vec<f64> { (0..solution.num_rows()).map(|i| solution[(i, k)]).collect() };
        let roots: Vec<Complex> = (0..n).map(|s| root(n, mode * s)).collect();
        for k in 0..count {
            // The unit datum of sector 0 is a symmetric array and i times another one.
            let image = mirrored_datum(&self.sector, k);
            let (own, other) = (column(k), column(image));
            let half = |sign: f64| -> Vec<f64> {
                own.iter().zip(&other).map(|(a, b)| 0.5 * (a + sign * b)).collect()
            };
            let first = self.sector.complex(&half(1.0));
            let second = self.sector.complex(&half(-1.0));
            for (s, w) in roots.iter().enumerate() {
                // Seen from sector s, sector 0 is n - s sectors further on.
                let weights = &mut self.around[(n - s) % n];
                for (at, (a, b)) in first.iter().zip(&second).enumerate() {
                    // first - i second
                    let y = [a[0] + b[1], a[1] - b[0]];
                    weights[(at, k)] += factor * (w[0] * y[0] - w[1] * y[1]);
                }
            }
        }
        for (k, function) in problem.given.iter().enumerate() {
            let array = self.sector.complex(&column(count + k));
            let (real, imaginary) = function.places();
            let sign = if *function == PlaneFunction::SquareConjugate { -1.0 } else { 1.0 };
            for (weights, w) in self.center.iter_mut().zip(&roots) {
                for (at, y) in array.iter().enumerate() {
                    weights[(at, real)] += w[0] * y[0] - w[1] * y[1];
                    if let Some(place) = imaginary {
                        weights[(at, place)] += sign * (w[0] * y[1] + w[1] * y[0]);
                    }
                }
            }
        }
    }
}

impl PlaneFunction {
    /// The numbers among [`PLANE_FUNCTIONS`] of its real and its imaginary part.
    fn places(self) -> (usize, Option<usize>) {
        match self {
            Self::Linear => (0, Some(1)),
            Self::Radius => (2, None),
            Self::Square | Self::SquareConjugate => (3, Some(4)),
        }
    }
}

/// exp(2 pi i k / n).
fn root(n: usize, k: usize) -> Complex {
    let angle = std::f64::consts::TAU * (k % n) as f64 / n as f64;
    [cosine(angle), sine(angle)]
}

/// The rows of bending, on z and the border data.
fn fair_objective(sector: &Sector, map: &[Complex], chi: &[Complex]) -> Matrix {
    let count = sector.num_border();
    let inside = plane::fairness(sector, map).into_iter().map(|mut row| {
        row.resize(row.len() + count, 0.0);
        row
    });
    let border = plane::mismatch(sector, map, chi).into_iter().map(|mut row| {
        row.iter_mut().for_each(|x| *x *= MISMATCH.sqrt());
        row
    });
    let rows: Vec<Vec<f64>> = inside.chain(border).collect();
    triangle(Matrix::from_rows(sector.num_coefs() + count, &rows))
}

/// The unknowns of one mode.
struct Mode<'a> {
    mode: usize,
    /// The guide, if there is one.
    samples: Option<&'a Samples>,
    /// The free z_ij.
    free: Vec<usize>,
    /// The functions of the plane in this mode whose weights are unknown, and those given.
    chosen: Vec<PlaneFunction>,
    given: Vec<PlaneFunction>,
    /// Their 2-jets at the centre, as real arrays.
    jets: Vec<[f64; 6]>,
}

impl<'a> Mode<'a> {
    /// `zeta` is the 2-jet of the plane's map at the centre.
    fn new(
        sector: &Sector,
        mode: usize,
        shape: Shape,
        zeta: [Complex; 6],
        samples: Option<&'a Samples>,
    ) -> Self {
        let quadratic: &[PlaneFunction] = match (mode, sector.valence) {
            (0, _) => &[PlaneFunction::Radius],
            (1, 3) => &[PlaneFunction::SquareConjugate],
            (2, _) => &[PlaneFunction::Square],
            _ => &[],
        };
        let (mut chosen, mut given) = (Vec::new(), Vec::new());
        if mode == 1 {
            given.push(PlaneFunction::Linear);
        }
        let target = if shape == Shape::Fair { &mut chosen } else { &mut given };
        target.extend(quadratic);
        let dim = sector.space.dim();
        let is_free = |at: &usize| {
            let (i, j) = (at / dim, at % dim);
            let kept = samples.is_some_and(|samples| samples.kept(sector, *at).is_some());
            i + j > 2 && sector.on_border(i, j).is_none() && !kept
        };
        let free = (0..sector.num_coefs()).filter(is_free).collect();
        let jet = |f: &PlaneFunction| {
            plane::center_jet(sector.space.degree, zeta, *f).map(|[x, y]| x + y)
        };
        let jets = chosen.iter().chain(&given).map(jet).collect();
        Self { mode, samples, free, chosen, given, jets }
    }

    fn num_unknowns(&self) -> usize {
        self.free.len() + self.chosen.len()
    }

    /// All z_ij on the unknowns, the data of a sector and the given functions.
    fn coefs(&self, sector: &Sector, num_data: usize) -> Matrix {
        let unknowns = self.num_unknowns();
        let mut rows = Matrix::zeros(sector.num_coefs(), unknowns + num_data + self.given.len());
        self.free.iter().enumerate().for_each(|(k, &at)| rows[(at, k)] = 1.0);
        let dim = sector.space.dim();
        for at in 0..sector.num_coefs() {
            let (i, j) = (at / dim, at % dim);
            let on_border = sector.on_border(i, j);
            let kept = self.samples.and_then(|samples| samples.kept(sector, at));
            if let Some(kept) = kept.filter(|_| on_border.is_none() && i + j > 2) {
                let first = unknowns + sector.num_border();
                kept.iter().enumerate().for_each(|(k, &w)| rows[(at, first + k)] = w);
            }
            for (k, w) in on_border.into_iter().flatten() {
                rows[(at, unknowns + k)] = w;
            }
        }
        let columns = (self.free.len()..unknowns)
            .chain(unknowns + num_data..unknowns + num_data + self.given.len());
        for (column, jet) in columns.zip(&self.jets) {
            for (at, w) in sector.center().into_iter().zip(jet) {
                rows[(at, column)] = *w;
            }
        }
        rows
    }

    /// All z_ij on the data of a sector and the given functions.
    fn solve(&self, sector: &Sector, objective: &Matrix) -> Matrix {
        let num_coefs = sector.num_coefs();
        let num_data = objective.num_columns() - num_coefs;
        let unknowns = self.num_unknowns();
        let coefs = self.coefs(sector, num_data);
        let (exact, soft) = plane::conditions(sector, self.mode);
        let on_unknowns = |rows: &[Vec<f64>]| Matrix::from_rows(num_coefs, rows).times(&coefs);
        let mut least = objective.select_columns(0..num_coefs).times(&coefs);
        for (i, k) in pairs(least.num_rows(), num_data) {
            least[(i, unknowns + k)] += objective[(i, num_coefs + k)];
        }
        let soft = on_unknowns(&soft);
        let rows: Vec<Vec<f64>> = (0..least.num_rows())
            .map(|i| least.row(i).to_vec())
            .chain((0..soft.num_rows()).map(|i| soft.row(i).to_vec()))
            .collect();
        let least = Matrix::from_rows(coefs.num_columns(), &rows);
        let x = constrained_least_squares(unknowns, &on_unknowns(&exact), &least);
        // z = coefs (x d, d)
        let mut z = coefs.select_columns(0..unknowns).times(&x);
        z.add(1.0, &coefs.select_columns(unknowns..coefs.num_columns()));
        z
    }
}

/// The BB coefficients of the pieces of a sector, m x m patches, the index along v fastest.
pub(super) fn pieces<const N: usize>(sector: &Sector, coefs: &[[f64; N]]) -> Vec<Vec<[f64; N]>> {
    let (order, m, dim) = (sector.space.degree + 1, sector.space.pieces, sector.space.dim());
    let piece = |a: usize, b: usize| {
        let bb = |i: usize, j: usize| {
            let weights = product(sector.to_bb.row(a * order + i), sector.to_bb.row(b * order + j));
            let mut sum = [0.0; N];
            for (at, &w) in weights.iter().enumerate().filter(|&(_, &w)| w != 0.0) {
                crate::point::add_scaled(&mut sum, w, coefs[at]);
            }
            sum
        };
        debug_assert_eq!(coefs.len(), dim * dim);
        (0..order * order).map(|k| bb(k / order, k % order)).collect()
    };
    (0..m * m).map(|which| piece(which / m, which % m)).collect()
}
