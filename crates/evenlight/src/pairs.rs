//! Pairs of indices, as one iterator for all: a nested `flat_map` is hundreds of lines of code for
//! every closure.

/// All pairs (i, j) with i below `rows` and j below `columns`, j fastest.
pub(crate) fn pairs(
    rows: usize,
    columns: usize,
) -> impl ExactSizeIterator<Item = (usize, usize)> + Clone {
    (0..rows * columns).map(move |k| (k / columns, k % columns))
}
