//! Sparse matrices, row by row.

/// A sparse matrix in compressed rows: what takes the coefficients of one space to those of
/// another.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseMatrix {
    num_columns: usize,
    /// Where each row ends among the entries.
    ends: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

impl SparseMatrix {
    /// The matrix with these rows, each a list of columns and entries. Columns of a row should
    /// rise; entries of one column add up.
    ///
    /// # Panics
    ///
    /// If a column is not below `num_columns`.
    pub fn from_rows(
        num_columns: usize,
        rows: impl IntoIterator<Item = Vec<(usize, f64)>>,
    ) -> Self {
        let (mut ends, mut entries) = (Vec::new(), Vec::new());
        for row in rows {
            assert!(row.iter().all(|&(column, _)| column < num_columns), "{num_columns} columns");
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

    /// The columns and entries of a row.
    ///
    /// # Panics
    ///
    /// If there is no such row.
    pub fn row(&self, row: usize) -> &[(usize, f64)] {
        let start = if row == 0 { 0 } else { self.ends[row - 1] };
        &self.entries[start..self.ends[row]]
    }

    /// All entries as (row, column, entry), row by row.
    pub fn triplets(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let of_row = |row: usize| self.row(row).iter().map(move |&(column, x)| (row, column, x));
        (0..self.num_rows()).flat_map(of_row)
    }

    /// The matrix times a vector.
    ///
    /// # Panics
    ///
    /// If the vector does not have one number for each column.
    pub fn apply(&self, vector: &[f64]) -> Vec<f64> {
        assert_eq!(vector.len(), self.num_columns, "one number for each column");
        let dot = |row: usize| self.row(row).iter().map(|&(column, x)| x * vector[column]).sum();
        (0..self.num_rows()).map(dot).collect()
    }

    /// The matrix times points: each coordinate by itself.
    ///
    /// # Panics
    ///
    /// As [`SparseMatrix::apply`].
    pub fn apply_to_points(&self, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let coordinate = |k: usize| self.apply(&points.iter().map(|p| p[k]).collect::<Vec<_>>());
        let [x, y, z] = [0, 1, 2].map(coordinate);
        x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect()
    }

    /// The product `self` `right`.
    ///
    /// # Panics
    ///
    /// If `right` does not have as many rows as `self` has columns.
    pub fn times(&self, right: &Self) -> Self {
        assert_eq!(self.num_columns, right.num_rows(), "the inner sizes agree");
        let row = |row: usize| {
            let mut sum = std::collections::BTreeMap::new();
            for &(k, w) in self.row(row) {
                for &(column, x) in right.row(k) {
                    *sum.entry(column).or_insert(0.0) += w * x;
                }
            }
            sum.into_iter().collect()
        };
        Self::from_rows(right.num_columns, (0..self.num_rows()).map(row))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_applies_both() {
        let a = SparseMatrix::from_rows(2, [vec![(0, 2.0)], vec![], vec![(0, -1.0), (1, 3.0)]]);
        let b = SparseMatrix::from_rows(3, [vec![(2, 1.0)], vec![(0, 4.0), (2, 5.0)]]);
        let vector = [1.0, 10.0, 100.0];
        assert_eq!(a.times(&b).apply(&vector), a.apply(&b.apply(&vector)));
        assert_eq!(a.triplets().collect::<Vec<_>>(), [(0, 0, 2.0), (2, 0, -1.0), (2, 1, 3.0)]);
        assert_eq!((a.num_rows(), a.num_columns(), a.num_entries()), (3, 2, 3));
    }
}
