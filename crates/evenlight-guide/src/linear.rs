//! Small dense matrices of [`Real`]s and the solution of linear systems.

use std::ops::{Add, Index, IndexMut, Mul, Range, Sub};

use crate::real::Real;

/// A dense matrix, stored by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    num_rows: usize,
    num_columns: usize,
    entries: Vec<Real>,
}

impl Matrix {
    /// The matrix of zeros.
    pub fn zeros(num_rows: usize, num_columns: usize) -> Self {
        Self { num_rows, num_columns, entries: vec![Real::ZERO; num_rows * num_columns] }
    }

    /// The matrix with the entries `entry(row, column)`.
    pub fn from_fn(
        num_rows: usize,
        num_columns: usize,
        mut entry: impl FnMut(usize, usize) -> Real,
    ) -> Self {
        let places = (0..num_rows).flat_map(|i| (0..num_columns).map(move |j| (i, j)));
        let entries = places.map(|(i, j)| entry(i, j)).collect();
        Self { num_rows, num_columns, entries }
    }

    /// The matrix of the integers `numerators`, all over one `denominator`.
    pub fn from_fractions<const N: usize>(numerators: &[[i32; N]], denominator: i32) -> Self {
        Self::from_fn(numerators.len(), N, |i, j| Real::ratio(numerators[i][j], denominator))
    }

    /// The square matrix with ones on the diagonal.
    pub fn identity(order: usize) -> Self {
        Self::from_fn(order, order, |i, j| if i == j { Real::ONE } else { Real::ZERO })
    }

    /// The number of rows.
    pub fn num_rows(&self) -> usize {
        self.num_rows
    }

    /// The number of columns.
    pub fn num_columns(&self) -> usize {
        self.num_columns
    }

    /// Row `i`.
    pub fn row(&self, i: usize) -> &[Real] {
        &self.entries[i * self.num_columns..][..self.num_columns]
    }

    /// Replaces row `i`, which must have as many entries.
    pub fn set_row(&mut self, i: usize, row: &[Real]) {
        self.entries[i * self.num_columns..][..self.num_columns].copy_from_slice(row);
    }

    /// The rows with the numbers `rows`, in this order.
    pub fn select_rows(&self, rows: &[usize]) -> Self {
        Self::from_fn(rows.len(), self.num_columns, |i, j| self[(rows[i], j)])
    }

    /// The columns with the numbers `columns`, in this order.
    pub fn select_columns(&self, columns: &[usize]) -> Self {
        Self::from_fn(self.num_rows, columns.len(), |i, j| self[(i, columns[j])])
    }

    /// The consecutive columns `columns`.
    pub fn columns(&self, columns: Range<usize>) -> Self {
        self.select_columns(&columns.collect::<Vec<_>>())
    }

    /// The matrix `[self | right]`.
    pub fn beside(&self, right: &Self) -> Self {
        let split = self.num_columns;
        Self::from_fn(self.num_rows, split + right.num_columns, |i, j| {
            if j < split { self[(i, j)] } else { right[(i, j - split)] }
        })
    }

    /// The matrix with the rows of `self`, then those of `below`.
    pub fn above(&self, below: &Self) -> Self {
        assert_eq!(self.num_columns, below.num_columns, "stacked rows are equally long");
        let entries = [self.entries.as_slice(), &below.entries].concat();
        Self { num_rows: self.num_rows + below.num_rows, entries, ..*self }
    }

    /// The matrix with rows and columns exchanged.
    pub fn transposed(&self) -> Self {
        Self::from_fn(self.num_columns, self.num_rows, |i, j| self[(j, i)])
    }

    /// The matrix with every entry multiplied by `factor`.
    pub fn scaled(&self, factor: Real) -> Self {
        Self::from_fn(self.num_rows, self.num_columns, |i, j| factor * self[(i, j)])
    }

    /// The Kronecker product: rows `(i, k)` and columns `(j, l)`, the second index faster.
    pub fn kronecker(&self, inner: &Self) -> Self {
        let (rows, columns) = (inner.num_rows, inner.num_columns);
        Self::from_fn(self.num_rows * rows, self.num_columns * columns, |i, j| {
            self[(i / rows, j / columns)] * inner[(i % rows, j % columns)]
        })
    }

    /// The solution `X` of `self * X = right`, by elimination with partial pivoting; `None` if
    /// a pivot is zero.
    ///
    /// # Panics
    ///
    /// If `self` is not square, or has not as many rows as `right`.
    pub fn solve(&self, right: &Self) -> Option<Self> {
        assert_eq!(self.num_rows, self.num_columns, "a linear system needs a square matrix");
        assert_eq!(self.num_rows, right.num_rows, "one right-hand side per equation");
        let order = self.num_rows;
        let mut system = self.beside(right);
        for k in 0..order {
            system.bring_up_pivot(k)?;
            for i in k + 1..order {
                system.eliminate(i, k);
            }
        }
        system.substitute_back();
        Some(system.columns(order..system.num_columns))
    }

    /// Exchanges row `k` with the one below that is largest in column `k`.
    fn bring_up_pivot(&mut self, k: usize) -> Option<()> {
        let mut pivot = k;
        for i in k + 1..self.num_rows {
            if self[(i, k)].abs() > self[(pivot, k)].abs() {
                pivot = i;
            }
        }
        for j in 0..self.num_columns {
            self.entries.swap(k * self.num_columns + j, pivot * self.num_columns + j);
        }
        (self[(k, k)] != Real::ZERO).then_some(())
    }

    /// Subtracts from row `i` the multiple of row `k` that makes its entry in column `k` zero.
    fn eliminate(&mut self, i: usize, k: usize) {
        let factor = self[(i, k)] / self[(k, k)];
        for j in k..self.num_columns {
            let product = factor * self[(k, j)];
            self[(i, j)] = self[(i, j)] - product;
        }
    }

    /// Solves the triangular system `[U | right]` in place of its right-hand sides.
    fn substitute_back(&mut self) {
        let order = self.num_rows;
        for k in (0..order).rev() {
            for i in 0..k {
                self.eliminate(i, k);
            }
            let pivot = self[(k, k)];
            for j in order..self.num_columns {
                self[(k, j)] = self[(k, j)] / pivot;
            }
        }
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = Real;
    fn index(&self, (i, j): (usize, usize)) -> &Real {
        &self.entries[i * self.num_columns + j]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut Real {
        &mut self.entries[i * self.num_columns + j]
    }
}

impl Mul for &Matrix {
    type Output = Matrix;
    fn mul(self, right: Self) -> Matrix {
        assert_eq!(self.num_columns, right.num_rows, "the inner sizes of a product agree");
        Matrix::from_fn(self.num_rows, right.num_columns, |i, j| {
            (0..right.num_rows).map(|k| self[(i, k)] * right[(k, j)]).sum()
        })
    }
}

impl Add for &Matrix {
    type Output = Matrix;
    fn add(self, right: Self) -> Matrix {
        Matrix::from_fn(self.num_rows, self.num_columns, |i, j| self[(i, j)] + right[(i, j)])
    }
}

impl Sub for &Matrix {
    type Output = Matrix;
    fn sub(self, right: Self) -> Matrix {
        Matrix::from_fn(self.num_rows, self.num_columns, |i, j| self[(i, j)] - right[(i, j)])
    }
}

/// The largest absolute value of an entry; zero for no entries.
#[cfg(test)]
pub(crate) fn largest(matrix: &Matrix) -> f64 {
    matrix.entries.iter().map(|x| x.abs().to_f64()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Hilbert matrix 1/(i+j+1), whose inverse has integer entries.
    fn hilbert(order: usize) -> Matrix {
        Matrix::from_fn(order, order, |i, j| Real::ratio(1, (i + j + 1) as i32))
    }

    #[test]
    fn solves_the_hilbert_system_exactly_enough() {
        let inverse = hilbert(3).solve(&Matrix::identity(3)).unwrap();
        let exact = Matrix::from_fractions(&[[9, -36, 30], [-36, 192, -180], [30, -180, 180]], 1);
        assert!(largest(&(&inverse - &exact)) < 1e-27);
        let identity = &hilbert(8) * &hilbert(8).solve(&Matrix::identity(8)).unwrap();
        assert!(largest(&(&identity - &Matrix::identity(8))) < 1e-20); // condition 1.5e10
    }

    #[test]
    fn pivots_where_the_diagonal_is_zero_and_refuses_singular_systems() {
        let exchange = Matrix::from_fractions(&[[0, 1], [1, 0]], 1);
        assert_eq!(exchange.solve(&exchange), Some(Matrix::identity(2)));
        let singular = Matrix::from_fractions(&[[1, 2], [2, 4]], 1);
        assert_eq!(singular.solve(&exchange), None);
    }

    #[test]
    fn kronecker_products_multiply_factor_by_factor() {
        let a = Matrix::from_fractions(&[[1, 2, 3], [4, 5, 6]], 1);
        let b = Matrix::from_fractions(&[[2, -1], [0, 1]], 1);
        let left = &a.kronecker(&b) * &a.transposed().kronecker(&b);
        let right = (&a * &a.transposed()).kronecker(&(&b * &b));
        assert_eq!(left, right);
    }
}
