//! Small dense linear algebra: Householder QR with column pivoting, least squares under linear
//! conditions (with this QR), and LU.
//!
//! Plain loops in a fixed order, so that the results have the same bits everywhere.

use crate::pairs::pairs;

use std::ops::{Index, IndexMut};

/// A matrix, stored by rows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Matrix {
    rows: usize,
    columns: usize,
    entries: Vec<f64>,
}

impl Matrix {
    pub(crate) fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, entries: vec![0.0; rows * columns] }
    }

    pub(crate) fn from_rows(columns: usize, rows: &[Vec<f64>]) -> Self {
        debug_assert!(rows.iter().all(|row| row.len() == columns));
        Self { rows: rows.len(), columns, entries: rows.concat() }
    }

    pub(crate) fn num_rows(&self) -> usize {
        self.rows
    }

    pub(crate) fn num_columns(&self) -> usize {
        self.columns
    }

    pub(crate) fn row(&self, i: usize) -> &[f64] {
        &self.entries[self.columns * i..self.columns * (i + 1)]
    }

    fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.entries[self.columns * i..self.columns * (i + 1)]
    }

    pub(crate) fn transposed(&self) -> Self {
        let mut result = Self::zeros(self.columns, self.rows);
        for (i, j) in pairs(self.rows, self.columns) {
            result[(j, i)] = self[(i, j)];
        }
        result
    }

    pub(crate) fn identity(size: usize) -> Self {
        let mut result = Self::zeros(size, size);
        (0..size).for_each(|k| result[(k, k)] = 1.0);
        result
    }

    /// The rows `range`.
    pub(crate) fn select_rows(&self, range: std::ops::Range<usize>) -> Self {
        let entries = self.entries[self.columns * range.start..self.columns * range.end].to_vec();
        Self { rows: range.len(), columns: self.columns, entries }
    }

    /// The columns `range`.
    pub(crate) fn select_columns(&self, range: std::ops::Range<usize>) -> Self {
        let rows: Vec<Vec<f64>> =
            (0..self.rows).map(|i| self.row(i)[range.clone()].to_vec()).collect();
        Self::from_rows(range.len(), &rows)
    }

    /// `self * other`.
    pub(crate) fn times(&self, other: &Self) -> Self {
        debug_assert_eq!(self.columns, other.rows);
        let mut result = Self::zeros(self.rows, other.columns);
        for i in 0..self.rows {
            for (k, &w) in self.row(i).iter().enumerate().filter(|&(_, &w)| w != 0.0) {
                add_to(result.row_mut(i), w, other.row(k));
            }
        }
        result
    }

    /// `w * self`.
    pub(crate) fn scaled(&self, w: f64) -> Self {
        let entries = self.entries.iter().map(|x| w * x).collect();
        Self { rows: self.rows, columns: self.columns, entries }
    }

    /// The largest absolute value of an entry.
    pub(crate) fn largest(&self) -> f64 {
        self.entries.iter().fold(0.0, |most, x| most.max(x.abs()))
    }

    /// `self += w * other`.
    pub(crate) fn add(&mut self, w: f64, other: &Self) {
        debug_assert_eq!((self.rows, self.columns), (other.rows, other.columns));
        add_to(&mut self.entries, w, &other.entries);
    }
}

impl Matrix {
    /// A^-1 b by elimination with the largest pivot of each column; entries are not finite if A is
    /// singular.
    pub(crate) fn solve(mut self, mut b: Self) -> Self {
        debug_assert_eq!((self.rows, self.rows), (self.columns, b.rows));
        let n = self.rows;
        for k in 0..n {
            let size = |i: usize| self[(i, k)].abs();
            let pivot = (k..n).fold(k, |best, i| if size(i) > size(best) { i } else { best });
            self.swap_rows(k, pivot);
            b.swap_rows(k, pivot);
            for i in k + 1..n {
                let w = -self[(i, k)] / self[(k, k)];
                self.add_row(i, w, k);
                b.add_row(i, w, k);
            }
        }
        for k in (0..n).rev() {
            let pivot = self[(k, k)];
            b.row_mut(k).iter_mut().for_each(|x| *x /= pivot);
            (0..k).for_each(|i| b.add_row(i, -self[(i, k)], k));
        }
        b
    }

    fn swap_rows(&mut self, i: usize, k: usize) {
        (0..self.columns)
            .for_each(|j| self.entries.swap(self.columns * i + j, self.columns * k + j));
    }

    /// row i += w row k, i not k.
    fn add_row(&mut self, i: usize, w: f64, k: usize) {
        if w == 0.0 {
            return;
        }
        let (low, high) = self.entries.split_at_mut(self.columns * i.max(k));
        let (first, last) =
            (&mut low[self.columns * i.min(k)..][..self.columns], &mut high[..self.columns]);
        if i < k { add_to(first, w, last) } else { add_to(last, w, first) }
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = f64;

    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.entries[self.columns * i + j]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.entries[self.columns * i + j]
    }
}

/// `sum += w * row`.
fn add_to(sum: &mut [f64], w: f64, row: &[f64]) {
    sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += w * x);
}

/// A P = Q R; each step brings the largest remaining column to the front.
pub(crate) struct Qr {
    /// The rows of R, `rank` of them, in pivoted order of columns.
    r: Matrix,
    /// The vectors of the reflections, each from its own row on.
    reflections: Vec<Vec<f64>>,
    /// The column of A at each place.
    order: Vec<usize>,
    rank: usize,
}

/// A column shorter than this part of the longest is rounding. For each condition here either is
/// independent, with a pivot above 1e-4, or repeats another one.
const DEPENDENT: f64 = 1e-10;

impl Qr {
    pub(crate) fn new(mut a: Matrix) -> Self {
        let (m, n) = (a.rows, a.columns);
        let mut order: Vec<usize> = (0..n).collect();
        let mut reflections = Vec::new();
        let mut first = 0.0;
        for k in 0..m.min(n) {
            let sizes = squared_sizes(&a, k);
            let pivot = (k..n).fold(k, |best, j| if sizes[j] > sizes[best] { j } else { best });
            first = if k == 0 { sizes[pivot] } else { first };
            if sizes[pivot] <= DEPENDENT * DEPENDENT * first {
                break;
            }
            swap_columns(&mut a, k, pivot);
            order.swap(k, pivot);
            let v = reflection(&(k..m).map(|i| a[(i, k)]).collect::<Vec<_>>());
            reflect(&v, k, &mut a);
            reflections.push(v);
        }
        let rank = reflections.len();
        Self { r: a.select_rows(0..rank), reflections, order, rank }
    }

    /// Q^T b.
    fn turned(&self, mut b: Matrix) -> Matrix {
        self.reflections.iter().enumerate().for_each(|(k, v)| reflect(v, k, &mut b));
        b
    }

    /// Q b.
    fn turned_back(&self, mut b: Matrix) -> Matrix {
        self.reflections.iter().enumerate().rev().for_each(|(k, v)| reflect(v, k, &mut b));
        b
    }

    /// The x of least |A x - b|, column by column; entries that do not matter are zero.
    pub(crate) fn least_squares(&self, b: Matrix) -> Matrix {
        let turned = self.turned(b);
        let mut x = Matrix::zeros(self.order.len(), turned.columns);
        for k in (0..self.rank).rev() {
            let mut row = turned.row(k).to_vec();
            for j in k + 1..self.rank {
                add_to(&mut row, -self.r[(k, j)], x.row(self.order[j]));
            }
            let pivot = self.r[(k, k)];
            row.iter_mut().for_each(|x| *x /= pivot);
            x.row_mut(self.order[k]).copy_from_slice(&row);
        }
        x
    }

    /// Solves the conditions A^T x = b, where A has as many rows as x. Gives the shortest x, if the
    /// conditions do not contradict each other, and a basis of all x with A^T x = 0, as columns.
    pub(crate) fn solutions(&self, rows: usize, b: &Matrix) -> (Matrix, Matrix) {
        // R^T y = P^T b from the top down; later rows of b repeat earlier ones.
        let mut y = Matrix::zeros(rows, b.columns);
        for k in 0..self.rank {
            let mut row = b.row(self.order[k]).to_vec();
            for j in 0..k {
                add_to(&mut row, -self.r[(j, k)], y.row(j));
            }
            let pivot = self.r[(k, k)];
            row.iter_mut().for_each(|x| *x /= pivot);
            y.row_mut(k).copy_from_slice(&row);
        }
        let mut rest = Matrix::zeros(rows, rows - self.rank);
        (0..rows - self.rank).for_each(|k| rest[(self.rank + k, k)] = 1.0);
        (self.turned_back(y), self.turned_back(rest))
    }
}

/// R of A = Q R without pivoting, with no more rows than columns: |R x| = |A x| for all x.
pub(crate) fn triangle(mut a: Matrix) -> Matrix {
    let steps = a.rows.min(a.columns);
    for k in 0..steps {
        let v = reflection(&(k..a.rows).map(|i| a[(i, k)]).collect::<Vec<_>>());
        reflect(&v, k, &mut a);
    }
    a.select_rows(0..steps)
}

/// The squared lengths of all columns from row `k` on.
fn squared_sizes(a: &Matrix, k: usize) -> Vec<f64> {
    let mut sizes = vec![0.0; a.columns];
    for i in k..a.rows {
        sizes.iter_mut().zip(a.row(i)).for_each(|(sum, x)| *sum += x * x);
    }
    sizes
}

fn swap_columns(a: &mut Matrix, j: usize, k: usize) {
    for i in 0..a.rows {
        a.row_mut(i).swap(j, k);
    }
}

/// v of length sqrt 2 such that x - v (v x) has zeros behind its first entry; v = 0 if x has them.
fn reflection(x: &[f64]) -> Vec<f64> {
    let size = x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut v = x.to_vec();
    let Some(first) = v.first_mut() else { return v };
    *first += if *first < 0.0 { -size } else { size };
    let half = v.iter().map(|x| x * x).sum::<f64>() / 2.0;
    if half > 0.0 {
        let factor = 1.0 / half.sqrt();
        v.iter_mut().for_each(|x| *x *= factor);
    }
    v
}

/// b - v (v^T b) in the rows from `k` on.
fn reflect(v: &[f64], k: usize, b: &mut Matrix) {
    let mut sums = vec![0.0; b.columns];
    for (i, &w) in v.iter().enumerate() {
        add_to(&mut sums, w, b.row(k + i));
    }
    for (i, &w) in v.iter().enumerate() {
        add_to(b.row_mut(k + i), -w, &sums);
    }
}

/// The solution x of least |O (x, d)| with C (x, d) = 0, as a matrix on d: `objective` and
/// `conditions` have the columns of x first, then those of the data d.
pub(crate) fn constrained_least_squares(
    unknowns: usize,
    conditions: &Matrix,
    objective: &Matrix,
) -> Matrix {
    let split =
        |a: &Matrix| (a.select_columns(0..unknowns), a.select_columns(unknowns..a.num_columns()));
    let (c_x, mut c_d) = split(conditions);
    let (o_x, o_d) = split(objective);
    c_d.entries.iter_mut().for_each(|x| *x = -*x);
    let (mut x, free) = Qr::new(c_x.transposed()).solutions(unknowns, &c_d);
    // o_x (x + free y) + o_d = least
    let mut right = o_x.times(&x);
    right.add(1.0, &o_d);
    let y = Qr::new(o_x.times(&free)).least_squares(right);
    x.add(-1.0, &free.times(&y));
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some(rows: usize, columns: usize, seed: f64) -> Matrix {
        let mut x = seed;
        let mut result = Matrix::zeros(rows, columns);
        for entry in &mut result.entries {
            x = (x * 997.0 + 0.123).rem_euclid(1.0);
            *entry = x - 0.5;
        }
        result
    }

    #[test]
    fn least_squares_leave_an_orthogonal_rest() {
        let (a, b) = (some(9, 4, 0.3), some(9, 2, 0.7));
        let x = Qr::new(a.clone()).least_squares(b.clone());
        let mut rest = a.times(&x);
        rest.add(-1.0, &b);
        assert!(a.transposed().times(&rest).largest() < 1e-14);
        assert!(rest.largest() > 1e-2);
    }

    #[test]
    fn solving_is_the_inverse_of_multiplying() {
        let (a, x) = (some(9, 9, 0.3), some(9, 3, 0.7));
        let mut error = a.clone().solve(a.times(&x));
        error.add(-1.0, &x);
        assert!(error.largest() < 1e-13);
    }

    #[test]
    fn solutions_are_found_though_conditions_repeat_others() {
        let base = some(3, 7, 0.2);
        let repeated = some(5, 3, 0.9).times(&base);
        let exact = some(7, 2, 0.5);
        let qr = Qr::new(repeated.transposed());
        assert_eq!(qr.rank, 3);
        let (x, free) = qr.solutions(7, &repeated.times(&exact));
        let mut error = repeated.times(&x);
        error.add(-1.0, &repeated.times(&exact));
        assert!(error.largest() < 1e-14);
        assert_eq!(free.num_columns(), 4);
        assert!(repeated.times(&free).largest() < 1e-14);
    }

    #[test]
    fn the_triangle_has_the_lengths_of_the_matrix() {
        let (a, x) = (some(20, 6, 0.4), some(6, 1, 0.1));
        let size = |m: &Matrix| m.entries.iter().map(|x| x * x).sum::<f64>();
        let (long, short) = (a.times(&x), triangle(a).times(&x));
        assert!((size(&long) - size(&short)).abs() < 1e-14);
    }

    #[test]
    fn conditions_hold_exactly_and_the_rest_is_least() {
        let (conditions, objective) = (some(3, 8, 0.6), some(12, 8, 0.8));
        let x = constrained_least_squares(6, &conditions, &objective);
        let with_data = |x: &Matrix| {
            let mut all: Vec<Vec<f64>> = (0..6).map(|i| x.row(i).to_vec()).collect();
            all.extend([vec![1.0, 0.0], vec![0.0, 1.0]]);
            Matrix::from_rows(2, &all)
        };
        assert!(conditions.times(&with_data(&x)).largest() < 1e-14);
        let energy =
            |x: &Matrix| objective.times(&with_data(x)).entries.iter().map(|x| x * x).sum::<f64>();
        let (_, free) = Qr::new(conditions.select_columns(0..6).transposed())
            .solutions(6, &Matrix::zeros(3, 2));
        for k in 0..3 {
            let mut moved = x.clone();
            moved.add(1e-3, &free.select_columns(k..k + 1).times(&some(1, 2, 0.3)));
            assert!(energy(&moved) > energy(&x));
        }
    }
}
