//! Sparse matrices, row by row.

use crate::point::add_scaled;

/// A sparse matrix in compressed rows: what takes the coefficients of one space to those of another.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseMatrix {
    num_columns: usize,
    /// Where each row ends among the entries.
    ends: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

impl SparseMatrix {
    /// The matrix with these rows, each a list of columns and entries. Columns of a row should rise;
    /// entries of one column add up. `None` if a column is not below `num_columns`.
    pub fn from_rows(
        num_columns: usize,
        rows: impl IntoIterator<Item = Vec<(usize, f64)>>,
    ) -> Option<Self> {
        let matrix = Self::of_rows(num_columns, rows);
        let is_sound = matrix.entries.iter().all(|&(column, _)| column < num_columns);
        is_sound.then_some(matrix)
    }

    /// [`SparseMatrix::from_rows`] with columns that are known to be low enough.
    pub(super) fn of_rows(
        num_columns: usize,
        rows: impl IntoIterator<Item = Vec<(usize, f64)>>,
    ) -> Self {
        let (mut ends, mut entries) = (Vec::new(), Vec::new());
        for row in rows {
            entries.extend(row);
            ends.push(entries.len());
        }
        Self { num_columns, ends, entries }
    }

    /// The number of rows.
    pub fn num_rows(&self) -> usize {
        self.ends.len()
    }

    /// The number of columns.
    pub fn num_columns(&self) -> usize {
        self.num_columns
    }

    /// The number of entries that are kept.
    pub fn num_entries(&self) -> usize {
        self.entries.len()
    }

    /// The columns and entries of a row; `None` if there is no such row.
    pub fn row(&self, row: usize) -> Option<&[(usize, f64)]> {
        (row < self.num_rows()).then(|| self.entries_of(row))
    }

    /// The columns and entries of a row that there is.
    fn entries_of(&self, row: usize) -> &[(usize, f64)] {
        let start = if row == 0 { 0 } else { self.ends[row - 1] };
        &self.entries[start..self.ends[row]]
    }

    /// All entries as (row, column, entry), row by row.
    pub fn triplets(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let of_row =
            |row: usize| self.entries_of(row).iter().map(move |&(column, x)| (row, column, x));
        (0..self.num_rows()).flat_map(of_row)
    }

    /// The matrix times a vector; `None` if that has not one number for each column.
    pub fn apply(&self, vector: &[f64]) -> Option<Vec<f64>> {
        if vector.len() != self.num_columns {
            return None;
        }
        let dot =
            |row: usize| self.entries_of(row).iter().map(|&(column, x)| x * vector[column]).sum();
        Some((0..self.num_rows()).map(dot).collect())
    }

    /// The matrix times points, each coordinate by itself; `None` if there is not one point for each
    /// column.
    pub fn apply_to_points<const N: usize>(&self, points: &[[f64; N]]) -> Option<Vec<[f64; N]>> {
        if points.len() != self.num_columns {
            return None;
        }
        let of_row = |row: usize| {
            let mut sum = [0.0; N];
            for &(column, x) in self.entries_of(row) {
                add_scaled(&mut sum, x, points[column]);
            }
            sum
        };
        Some((0..self.num_rows()).map(of_row).collect())
    }

    /// The product `self` `right`; `None` if `right` has not as many rows as `self` has columns.
    pub fn times(&self, right: &Self) -> Option<Self> {
        (self.num_columns == right.num_rows()).then(|| self.product(right))
    }

    /// [`SparseMatrix::times`] of sizes that are known to agree.
    pub(super) fn product(&self, right: &Self) -> Self {
        let row = |row: usize| {
            let mut sum = std::collections::BTreeMap::new();
            for &(k, w) in self.entries_of(row) {
                for &(column, x) in right.entries_of(k) {
                    *sum.entry(column).or_insert(0.0) += w * x;
                }
            }
            sum.into_iter().collect()
        };
        Self::of_rows(right.num_columns, (0..self.num_rows()).map(row))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_applies_both() {
        let a = SparseMatrix::of_rows(2, [vec![(0, 2.0)], vec![], vec![(0, -1.0), (1, 3.0)]]);
        let b = SparseMatrix::of_rows(3, [vec![(2, 1.0)], vec![(0, 4.0), (2, 5.0)]]);
        let vector = [1.0, 10.0, 100.0];
        let product = a.times(&b).expect("the sizes agree");
        let in_two_steps = b.apply(&vector).and_then(|half| a.apply(&half));
        assert_eq!(product.apply(&vector), in_two_steps);
        assert!(a.apply(&vector).is_none() && b.times(&b).is_none() && a.row(3).is_none());
        assert!(SparseMatrix::from_rows(2, [vec![(2, 1.0)]]).is_none());
        assert_eq!(a.triplets().collect::<Vec<_>>(), [(0, 0, 2.0), (2, 0, -1.0), (2, 1, 3.0)]);
        assert_eq!((a.num_rows(), a.num_columns(), a.num_entries()), (3, 2, 3));
    }
}
