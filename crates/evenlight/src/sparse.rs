//! Sparse matrices, row by row: each row is a stencil, the weights of some of the values.
//!
//! ```text
//!   offsets   0     3   5 ...                 row k has the entries offsets[k] .. offsets[k+1],
//!   indices   4 7 9 0 1 ...                   each a column and its weight
//!   weights   a b c d e ...
//! ```

use crate::task::for_each_chunk;

/// Weights of values, row by row: a sparse matrix in compressed rows.
///
/// ```
/// use evenlight::stencil::Stencils;
///
/// let halves = Stencils::from_rows(3, [vec![(0, 0.5), (1, 0.5)], vec![(1, 0.5), (2, 0.5)]])
///     .expect("all columns are below 3");
/// assert_eq!(halves.apply(&[[0.0, 1.0], [2.0, 1.0], [4.0, 1.0]])?, [[1.0, 1.0], [3.0, 1.0]]);
/// assert_eq!(halves.offsets(), [0, 2, 4]);
/// assert_eq!(halves.row(1), Some((&[1, 2][..], &[0.5, 0.5][..])));
/// # Ok::<(), evenlight::stencil::LengthError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stencils {
    num_columns: usize,
    /// Where each row begins among the entries; one more than there are rows.
    offsets: Vec<u32>,
    indices: Vec<u32>,
    weights: Vec<f64>,
}

/// A slice does not have the length that it must have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there must be {expected} {what}, not {found}")]
pub struct LengthError {
    /// What the slice holds.
    pub what: &'static str,
    /// How many it must hold.
    pub expected: usize,
    /// How many it holds.
    pub found: usize,
}

impl LengthError {
    fn check(what: &'static str, expected: usize, found: usize) -> Result<(), Self> {
        if expected == found { Ok(()) } else { Err(Self { what, expected, found }) }
    }
}

impl Stencils {
    /// The stencils with these rows, each a list of columns and weights. Columns of a row should
    /// rise; weights of one column add up. `None` if a column is not below `num_columns`, or there
    /// are 2^32 columns or weights.
    pub fn from_rows(
        num_columns: usize,
        rows: impl IntoIterator<Item = Vec<(usize, f64)>>,
    ) -> Option<Self> {
        let mut stencils = Self::empty(num_columns);
        for row in rows {
            for (column, weight) in row {
                let column = Some(column).filter(|&column| column < num_columns)?;
                stencils.push(u32::try_from(column).ok()?, weight);
            }
            stencils.end_row().then_some(())?;
        }
        Some(stencils)
    }

    /// No rows.
    pub(crate) fn empty(num_columns: usize) -> Self {
        Self { num_columns, offsets: vec![0], indices: Vec::new(), weights: Vec::new() }
    }

    /// Adds an entry to the row that is not ended yet.
    #[inline]
    pub(crate) fn push(&mut self, column: u32, weight: f64) {
        self.indices.push(column);
        self.weights.push(weight);
    }

    /// Ends a row; `false` if there are too many entries to number them.
    #[inline]
    pub(crate) fn end_row(&mut self) -> bool {
        let end = u32::try_from(self.weights.len());
        self.offsets.extend(end);
        end.is_ok()
    }

    /// All rows of some stencils over the same columns, one after the other; `None` if there are
    /// too many entries to number them.
    pub(crate) fn joined(num_columns: usize, parts: Vec<Self>) -> Option<Self> {
        let entries = parts.iter().map(|part| part.weights.len()).sum();
        u32::try_from(entries).ok()?;
        let mut all = Self::empty(num_columns);
        all.offsets.reserve_exact(parts.iter().map(Self::num_rows).sum());
        all.indices.reserve_exact(entries);
        all.weights.reserve_exact(entries);
        for part in parts {
            let first = all.weights.len() as u32;
            all.offsets.extend(part.offsets[1..].iter().map(|&end| first + end));
            all.indices.extend(part.indices);
            all.weights.extend(part.weights);
        }
        Some(all)
    }

    /// The number of rows, which is the number of results.
    pub fn num_rows(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The number of columns, which is the number of values.
    pub fn num_columns(&self) -> usize {
        self.num_columns
    }

    /// The number of stored weights.
    pub fn num_entries(&self) -> usize {
        self.weights.len()
    }

    /// Where each row begins in [`Stencils::indices`] and [`Stencils::weights`]; the last entry is
    /// their length.
    pub fn offsets(&self) -> &[u32] {
        &self.offsets
    }

    /// The column of every weight; they rise along a row.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// The weights, row after row.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The columns and weights of a row; `None` if there is no such row.
    pub fn row(&self, row: usize) -> Option<(&[u32], &[f64])> {
        let end = *self.offsets.get(row.checked_add(1)?)? as usize;
        let entries = self.offsets[row] as usize..end;
        Some((&self.indices[entries.clone()], &self.weights[entries]))
    }

    /// The columns and weights of all rows, in order.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = (&[u32], &[f64])> + '_ {
        self.offsets.windows(2).map(|ends| {
            let entries = ends[0] as usize..ends[1] as usize;
            (&self.indices[entries.clone()], &self.weights[entries])
        })
    }

    /// The columns and weights of a row; the row must exist.
    #[inline]
    pub(crate) fn entries(&self, row: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let entries = self.offsets[row] as usize..self.offsets[row + 1] as usize;
        let weights = self.weights[entries.clone()].iter().copied();
        self.indices[entries].iter().copied().zip(weights)
    }

    /// All entries as (row, column, weight), row by row.
    pub fn triplets(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let of_row =
            |row: usize| self.entries(row).map(move |(column, x)| (row, column as usize, x));
        (0..self.num_rows()).flat_map(of_row)
    }

    /// The results for values of N numbers each, on the threads of the
    /// [task](crate::task::Task): the same bits with any number of them.
    ///
    /// # Errors
    ///
    /// If there is not one value for each column.
    pub fn apply<const N: usize>(&self, values: &[[f64; N]]) -> Result<Vec<[f64; N]>, LengthError> {
        let mut results = vec![[0.0; N]; self.num_rows()];
        self.apply_to(values, &mut results)?;
        Ok(results)
    }

    /// [`Stencils::apply`] into a caller's buffer. Nothing is written if there is an error.
    ///
    /// # Errors
    ///
    /// If there is not one value for each column and one result for each row.
    pub fn apply_to<const N: usize>(
        &self,
        values: &[[f64; N]],
        results: &mut [[f64; N]],
    ) -> Result<(), LengthError> {
        LengthError::check("values", self.num_columns, values.len())?;
        LengthError::check("results", self.num_rows(), results.len())?;
        for_each_chunk(results, ROWS_OF_A_TASK, |first, results| {
            for (k, result) in results.iter_mut().enumerate() {
                let mut sum = [0.0; N];
                for (column, w) in self.entries(first + k) {
                    let value = &values[column as usize];
                    (0..N).for_each(|i| sum[i] += w * value[i]);
                }
                *result = sum;
            }
        });
        Ok(())
    }

    /// [`Stencils::apply_to`] for flat buffers of values and results of `width` numbers each, one
    /// after the other.
    ///
    /// # Errors
    ///
    /// If there are not `width` numbers for each column and for each row.
    pub fn apply_flat(
        &self,
        width: usize,
        values: &[f64],
        results: &mut [f64],
    ) -> Result<(), LengthError> {
        let numbers = |count: usize| count.saturating_mul(width);
        LengthError::check("numbers in values", numbers(self.num_columns), values.len())?;
        LengthError::check("numbers in results", numbers(self.num_rows()), results.len())?;
        if width == 0 {
            return Ok(());
        }
        for_each_chunk(results, ROWS_OF_A_TASK * width, |first, results| {
            for (k, result) in results.chunks_mut(width).enumerate() {
                result.fill(0.0);
                for (column, w) in self.entries(first / width + k) {
                    let value = &values[column as usize * width..][..width];
                    result.iter_mut().zip(value).for_each(|(sum, x)| *sum += w * x);
                }
            }
        });
        Ok(())
    }

    /// The results for single numbers.
    ///
    /// # Errors
    ///
    /// If there is not one number for each column.
    pub fn apply_to_numbers(&self, numbers: &[f64]) -> Result<Vec<f64>, LengthError> {
        let mut results = vec![0.0; self.num_rows()];
        self.apply_flat(1, numbers, &mut results)?;
        Ok(results)
    }

    /// The product `self` `right`: the stencils that have the effect of `right` and then of `self`.
    /// `None` if `right` does not have as many rows as `self` has columns, or there are 2^32
    /// weights.
    pub fn times(&self, right: &Self) -> Option<Self> {
        (self.num_columns == right.num_rows()).then_some(())?;
        let row = |row: usize| {
            let mut sum = std::collections::BTreeMap::new();
            for (k, w) in self.entries(row) {
                for (column, x) in right.entries(k as usize) {
                    *sum.entry(column as usize).or_insert(0.0) += w * x;
                }
            }
            sum.into_iter().collect()
        };
        Self::from_rows(right.num_columns, (0..self.num_rows()).map(row))
    }
}

/// The number of rows that is worth a thread.
const ROWS_OF_A_TASK: usize = 1 << 12;

#[cfg(test)]
mod tests {
    use super::*;

    fn small() -> Stencils {
        let rows = [vec![(0, 2.0)], vec![], vec![(0, -1.0), (1, 3.0)]];
        Stencils::from_rows(2, rows).unwrap()
    }

    #[test]
    fn a_product_applies_both() {
        let a = small();
        let b = Stencils::from_rows(3, [vec![(2, 1.0)], vec![(0, 4.0), (2, 5.0)]]).unwrap();
        let vector = [[1.0], [10.0], [100.0]];
        let both = a.times(&b).unwrap();
        assert_eq!(both.apply(&vector), a.apply(&b.apply(&vector).unwrap()));
        assert_eq!(a.triplets().collect::<Vec<_>>(), [(0, 0, 2.0), (2, 0, -1.0), (2, 1, 3.0)]);
        assert_eq!((a.num_rows(), a.num_columns(), a.num_entries()), (3, 2, 3));
        assert!(b.times(&b).is_none() && Stencils::from_rows(2, [vec![(2, 1.0)]]).is_none());
    }

    #[test]
    fn all_ways_to_apply_agree() {
        let a = small();
        let expected = [[2.0, 4.0], [0.0, 0.0], [8.0, 10.0]];
        assert_eq!(a.apply(&[[1.0, 2.0], [3.0, 4.0]]).unwrap(), expected);
        let mut flat = [f64::NAN; 6];
        a.apply_flat(2, &[1.0, 2.0, 3.0, 4.0], &mut flat).unwrap();
        assert_eq!(flat, *expected.as_flattened());
        assert_eq!(a.apply_to_numbers(&[1.0, 3.0]).unwrap(), [2.0, 0.0, 8.0]);
        a.apply_flat(0, &[], &mut []).unwrap();
    }

    #[test]
    fn wrong_lengths_are_errors() {
        let a = Stencils::from_rows(2, [vec![(1, 2.0)]]).unwrap();
        let few = LengthError { what: "values", expected: 2, found: 1 };
        assert_eq!(a.apply(&[[1.0]]), Err(few));
        assert_eq!(few.to_string(), "there must be 2 values, not 1");
        assert!(a.apply_to(&[[1.0], [1.0]], &mut [[0.0]; 2]).is_err());
        assert!(a.apply_flat(3, &[1.0; 6], &mut [0.0; 4]).is_err());
        assert_eq!((a.row(1), a.row(usize::MAX)), (None, None));
    }

    #[test]
    fn parts_are_joined_in_order() {
        let rows = |w: f64| [vec![(0, w)], vec![(0, w), (1, w)]];
        let part = |w: f64| Stencils::from_rows(2, rows(w)).unwrap();
        let all = Stencils::joined(2, vec![part(1.0), part(2.0)]).unwrap();
        assert_eq!(all.offsets(), [0, 1, 3, 4, 6]);
        assert_eq!(all.rows().map(|(_, w)| w[0]).collect::<Vec<_>>(), [1.0, 1.0, 2.0, 2.0]);
    }
}
