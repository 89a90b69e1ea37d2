//! Integrals of squared derivatives over a ring, by coordinates x and y of the plane.
//!
//! Coordinates are given over each patch as a [`Chart`]; then f = f(x(u,v), y(u,v)) gives the
//! derivatives of f by x and y up to the third by a small linear system, and
//!
//! ```text
//!   |D^k f|^2 = integral of sum_i (k over i) (d^k f / dx^(k-i) dy^i)^2 dx dy
//! ```
//!
//! by 4 x 4 Gauss points per patch.

use super::net::{Net, PATCHES};
use crate::angle::{cosine, sine};
use crate::dense::Matrix;
use crate::quadrature::GAUSS_4;
use std::f64::consts::{FRAC_PI_4, PI};

/// Power series in (u,v) up to the third order, in the order of [`EXPONENTS`].
type Series = [f64; 10];

const EXPONENTS: [[usize; 2]; 10] =
    [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2], [3, 0], [2, 1], [1, 2], [0, 3]];

/// The series of x and y over a patch of a sector at (u,v).
pub(super) trait Chart {
    fn series(&self, s: usize, which: usize, at: [f64; 2]) -> [Series; 2];
}

/// The map that scales angles so that the fan fills a half-plane: a + i b = r e^(i phi) in sector s
/// becomes r e^(i (2 phi + pi s) / f). It keeps radii, so that rings shrink by 1/2, and scales all
/// areas by one factor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polar {
    pub(super) faces: usize,
}

impl Chart for Polar {
    /// With z = z_0 (1 + w): e^(rho + i k psi), rho + i psi = log (1 + w), times the value at z_0.
    fn series(&self, s: usize, which: usize, at: [f64; 2]) -> [Series; 2] {
        let [a, b] = [0, 1].map(|k| 0.5 * (PATCHES[which][k] as f64 + at[k]));
        let square = a * a + b * b;
        // w = (1/2) (u + i v) / z_0
        let mut w = [[0.0; 10]; 2];
        (w[0][1], w[0][2], w[1][1], w[1][2]) =
            (0.5 * a / square, 0.5 * b / square, -0.5 * b / square, 0.5 * a / square);
        let (w2, f) = (complex_product(&w, &w), self.faces as f64);
        let w3 = complex_product(&w2, &w);
        let log = |part: usize| -> Series {
            std::array::from_fn(|k| w[part][k] - w2[part][k] / 2.0 + w3[part][k] / 3.0)
        };
        let exponent = [log(0), log(1).map(|x| 2.0 / f * x)];
        let second = complex_product(&exponent, &exponent);
        let third = complex_product(&second, &exponent);
        let turn = (2.0 * angle_of(a, b) + PI * s as f64) / f;
        let mut value = [[0.0; 10]; 2];
        (value[0][0], value[1][0]) = (square.sqrt() * cosine(turn), square.sqrt() * sine(turn));
        let exponential: [Series; 2] = std::array::from_fn(|p| {
            let one = |k: usize| if p == 0 && k == 0 { 1.0 } else { 0.0 };
            std::array::from_fn(|k| {
                one(k) + exponent[p][k] + second[p][k] / 2.0 + third[p][k] / 6.0
            })
        });
        complex_product(&value, &exponential)
    }
}

/// The angle of (a,b), both positive, by Newton's iteration with our own sine.
fn angle_of(a: f64, b: f64) -> f64 {
    let r = (a * a + b * b).sqrt();
    // Cubic convergence from at most pi/4 away.
    (0..6).fold(FRAC_PI_4, |x, _| x + (b * cosine(x) - a * sine(x)) / r)
}

/// The coordinates given by a ring of bi-3 patches, 12 per sector.
pub(super) struct RingChart {
    /// The BB coefficients of x and y of every patch.
    pub(super) patches: Vec<[[f64; 16]; 2]>,
}

impl Chart for RingChart {
    fn series(&self, s: usize, which: usize, at: [f64; 2]) -> [Series; 2] {
        let rows = patch_series(at);
        self.patches[12 * s + which].map(|coefs| rows.map(|row| dot(&row, &coefs)))
    }
}

fn dot(a: &[f64; 16], b: &[f64; 16]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn product(a: &Series, b: &Series) -> Series {
    let mut sum = [0.0; 10];
    for (x, [i, j]) in a.iter().zip(EXPONENTS) {
        for (y, [k, l]) in b.iter().zip(EXPONENTS) {
            if i + j + k + l <= 3 {
                sum[index(i + k, j + l)] += x * y;
            }
        }
    }
    sum
}

/// The place of u^i v^j in [`EXPONENTS`].
fn index(i: usize, j: usize) -> usize {
    (i + j) * (i + j + 1) / 2 + j
}

fn complex_product(a: &[Series; 2], b: &[Series; 2]) -> [Series; 2] {
    let [rr, ii] = [product(&a[0], &b[0]), product(&a[1], &b[1])];
    let [ri, ir] = [product(&a[0], &b[1]), product(&a[1], &b[0])];
    [std::array::from_fn(|k| rr[k] - ii[k]), std::array::from_fn(|k| ri[k] + ir[k])]
}

/// The series of a bi-3 patch at (u,v), as weights of its BB coefficients.
fn patch_series([u, v]: [f64; 2]) -> [[f64; 16]; 10] {
    let (u, v) = (bernstein_series(u), bernstein_series(v));
    EXPONENTS.map(|[i, j]| std::array::from_fn(|k| u[i][k / 4] * v[j][k % 4]))
}

/// The series of the four Bernstein polynomials of degree 3: entry `[r][k]` is of e^r in B_k(t +
/// e).
fn bernstein_series(t: f64) -> [[f64; 4]; 4] {
    const POWERS: [[f64; 4]; 4] = [
        [1.0, -3.0, 3.0, -1.0],
        [0.0, 3.0, -6.0, 3.0],
        [0.0, 0.0, 3.0, -3.0],
        [0.0, 0.0, 0.0, 1.0],
    ];
    std::array::from_fn(|r| {
        std::array::from_fn(|k| {
            let [a, b, c, d] = POWERS[k];
            match r {
                0 => a + t * (b + t * (c + t * d)),
                1 => b + t * (2.0 * c + 3.0 * t * d),
                2 => c + 3.0 * t * d,
                _ => d,
            }
        })
    })
}

/// Integrals over a ring, as forms of (net, refined net).
pub(super) struct RingForms {
    /// |D^2 f|^2.
    pub(super) second: Matrix,
    /// |D^3 f|^2.
    pub(super) third: Matrix,
    /// The integral of D f . D y.
    pub(super) with_y: Vec<f64>,
    /// The integrals of D^2 f . D^2 m, m = x^2 and x y.
    pub(super) with_quadratics: [Vec<f64>; 2],
    pub(super) area: f64,
}

impl RingForms {
    pub(super) fn new(net: Net, chart: &impl Chart) -> Self {
        let size = 2 * net.num_nodes();
        let zeros = || Matrix::zeros(size, size);
        let mut forms = Self {
            second: zeros(),
            third: zeros(),
            with_y: vec![0.0; size],
            with_quadratics: [vec![0.0; size], vec![0.0; size]],
            area: 0.0,
        };
        for s in 0..net.faces {
            for which in 0..PATCHES.len() {
                forms.add(net, s, which, &PatchForms::new(|at| chart.series(s, which, at)));
            }
        }
        forms
    }

    /// Adds the integrals over a patch.
    fn add(&mut self, net: Net, s: usize, which: usize, patch: &PatchForms) {
        let (nodes, rows) = compressed(net, s, which);
        let back = rows.transposed();
        for (sum, form) in [(&mut self.second, &patch.second), (&mut self.third, &patch.third)] {
            let own = back.times(&form.times(&rows));
            for (i, &row) in nodes.iter().enumerate() {
                for (j, &column) in nodes.iter().enumerate() {
                    sum[(row, column)] += own[(i, j)];
                }
            }
        }
        let [xx, xy] = &mut self.with_quadratics;
        let sums = [(&mut self.with_y, &patch.with_y), (xx, &patch.with_xx), (xy, &patch.with_xy)];
        for (sum, linear) in sums {
            for (i, &node) in nodes.iter().enumerate() {
                sum[node] += (0..16).map(|k| linear[k] * rows[(k, i)]).sum::<f64>();
            }
        }
        self.area += patch.area;
    }
}

/// The nodes of (net, refined net) that a patch has, and its BB coefficients by them.
fn compressed(net: Net, s: usize, which: usize) -> (Vec<usize>, Matrix) {
    let rule = net.patch(s as isize, which);
    let shifted = |row: &[(usize, f64)]| -> Vec<(usize, f64)> {
        row.iter().map(|&(k, w)| (k + net.num_nodes(), w)).collect()
    };
    let rows: Vec<Vec<(usize, f64)>> = rule
        .old
        .iter()
        .zip(&rule.new)
        .map(|(old, new)| [old.clone(), shifted(new)].concat())
        .collect();
    let mut nodes: Vec<usize> = rows.iter().flatten().map(|&(k, _)| k).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let mut matrix = Matrix::zeros(16, nodes.len());
    for (i, row) in rows.iter().enumerate() {
        for &(k, w) in row {
            let j = nodes.partition_point(|&node| node < k);
            matrix[(i, j)] += w;
        }
    }
    (nodes, matrix)
}

/// Integrals over a patch, as forms of its BB coefficients.
struct PatchForms {
    second: Matrix,
    third: Matrix,
    with_y: [f64; 16],
    with_xx: [f64; 16],
    with_xy: [f64; 16],
    area: f64,
}

impl PatchForms {
    fn new(chart: impl Fn([f64; 2]) -> [Series; 2]) -> Self {
        let zeros = || Matrix::zeros(16, 16);
        let none = [0.0; 16];
        let mut forms = Self {
            second: zeros(),
            third: zeros(),
            with_y: none,
            with_xx: none,
            with_xy: none,
            area: 0.0,
        };
        for (u, wu) in GAUSS_4 {
            for (v, wv) in GAUSS_4 {
                forms.add_point([u, v], wu * wv, chart([u, v]));
            }
        }
        forms
    }

    fn add_point(&mut self, at: [f64; 2], weight: f64, [x, y]: [Series; 2]) {
        let weight = weight * (x[1] * y[2] - x[2] * y[1]).abs();
        let rows = derivatives(at, x, y);
        for (row, exponents) in rows.iter().zip(&EXPONENTS[1..]) {
            let form = match exponents[0] + exponents[1] {
                2 => &mut self.second,
                3 => &mut self.third,
                _ => continue,
            };
            let factor = weight * count(*exponents);
            for (i, a) in row.iter().enumerate() {
                for (j, b) in row.iter().enumerate() {
                    form[(i, j)] += factor * a * b;
                }
            }
        }
        let linear =
            [(&mut self.with_y, 2, 1.0), (&mut self.with_xx, 3, 2.0), (&mut self.with_xy, 4, 2.0)];
        for (sum, which, factor) in linear {
            sum.iter_mut().zip(&rows[which - 1]).for_each(|(sum, x)| *sum += weight * factor * x);
        }
        self.area += weight;
    }
}

/// How often a derivative is counted in |D^k f|^2.
fn count([a, b]: [usize; 2]) -> f64 {
    match (a, b) {
        (1, 1) => 2.0,
        (2, 1) | (1, 2) => 3.0,
        _ => 1.0,
    }
}

/// The derivatives by x and y in the order of [`EXPONENTS`], without the value, as weights of BB
/// coefficients.
fn derivatives(at: [f64; 2], mut x: Series, mut y: Series) -> Vec<[f64; 16]> {
    (x[0], y[0]) = (0.0, 0.0);
    let one: Series = std::array::from_fn(|k| if k == 0 { 1.0 } else { 0.0 });
    let power = |of: &Series, k: usize| (0..k).fold(one, |power, _| product(&power, of));
    let monomials: Vec<Series> =
        EXPONENTS.iter().map(|&[a, b]| product(&power(&x, a), &power(&y, b))).collect();
    let mut system = Matrix::zeros(9, 9);
    let mut right = Matrix::zeros(9, 16);
    let rows = patch_series(at);
    for i in 0..9 {
        (0..9).for_each(|j| system[(i, j)] = monomials[j + 1][i + 1]);
        (0..16).for_each(|k| right[(i, k)] = rows[i + 1][k]);
    }
    let solved = system.solve(right);
    let factorial = |k: usize| [1.0, 1.0, 2.0, 6.0][k];
    (0..9)
        .map(|i| {
            let [a, b] = EXPONENTS[i + 1];
            std::array::from_fn(|k| factorial(a) * factorial(b) * solved[(i, k)])
        })
        .collect()
}
