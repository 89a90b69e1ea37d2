//! Columns: what the weights of stencils are weights of, and the sums of rows over them.
//!
//! A net around a point or a patch is made of vertices of some refined level, and a vertex of a
//! level is a row of weights of the cage:
//!
//! ```text
//!   sample = sum of weights * vertices of level 2           gathered, column by column:
//!   vertex of level 2 = sum of mask * vertices of level 1   each is entered once, and rises
//!   vertex of level 1 = sum of mask * columns               in a row
//! ```

use std::ops::Range;

use super::StencilError;
use crate::mesh::VertexId;
use crate::mesh::refine::Mask;
use crate::sparse::Stencils;
use crate::task::{Steps, map_indexed};

/// The columns of the stencils over a net, and its refined vertices as rows of them.
#[derive(Debug)]
pub(super) struct Columns {
    count: usize,
    /// The column of every vertex; `None` if that is its number.
    of_vertex: Option<Vec<u32>>,
    /// The vertices of levels 1, 2, ...
    levels: Vec<Stencils>,
}

impl Columns {
    /// One column for each of `count` vertices.
    pub(super) fn of_vertices(count: usize) -> Self {
        Self { count, of_vertex: None, levels: Vec::new() }
    }

    /// The columns of vertices that have one of `count` values.
    pub(super) fn of_values(count: usize, of_vertex: Vec<u32>) -> Self {
        Self { count, of_vertex: Some(of_vertex), levels: Vec::new() }
    }

    /// The same columns under a net that is not refined.
    pub(super) fn without_levels(&self) -> Self {
        Self { count: self.count, of_vertex: self.of_vertex.clone(), levels: Vec::new() }
    }

    /// The number of columns.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Enters `weights` of a vertex of a level.
    #[inline]
    pub(super) fn enter<const R: usize>(
        &self,
        (level, v): (usize, VertexId),
        weights: [f64; R],
        sums: &mut Sums<R>,
    ) {
        if level == 0 {
            let column = self.of_vertex.as_ref().map_or(v.0, |columns| columns[v.index()]);
            return sums.add(column, weights);
        }
        for (column, x) in self.levels[level - 1].entries(v.index()) {
            sums.add(column, weights.map(|w| w * x));
        }
    }

    /// The rows of the `count` vertices of the next level, which have these masks.
    pub(super) fn refined(
        &self,
        count: usize,
        mask: impl Fn(VertexId) -> Mask + Sync,
    ) -> Result<Stencils, StencilError> {
        let coarse = self.levels.len();
        in_parts(self.count, count, |range| {
            let (mut rows, mut sums) = (Stencils::empty(self.count), Sums::new(self.count));
            for v in range {
                for (from, w) in mask(VertexId(v as u32)).terms {
                    self.enter((coarse, from), [w], &mut sums);
                }
                sums.move_to(&mut rows)?;
            }
            Ok(rows)
        })
    }

    /// Goes on with the next level.
    pub(super) fn push(&mut self, level: Stencils) {
        self.levels.push(level);
    }

    /// The rows of the last level, `count` vertices.
    pub(super) fn into_rows(mut self, count: usize) -> Result<Stencils, StencilError> {
        match self.levels.pop() {
            Some(rows) => Ok(rows),
            None => self.refined(count, |v| Mask { terms: vec![(v, 1.0)] }),
        }
    }
}

/// So many places or vertices are a part, and so many parts are made between two steps.
const PART: usize = 1 << 12;
const PARTS_OF_A_STEP: usize = 1 << 6;

/// The rows of `count` places, made by `rows` for a range at a time.
pub(super) fn in_parts(
    num_columns: usize,
    count: usize,
    rows: impl Fn(Range<usize>) -> Result<Stencils, StencilError> + Sync,
) -> Result<Stencils, StencilError> {
    let num_parts = count.div_ceil(PART);
    let part = |k: usize| rows(PART * k..usize::min(PART * (k + 1), count));
    let mut steps = Steps::new("stencils", num_parts.div_ceil(PARTS_OF_A_STEP))?;
    let mut parts = Vec::with_capacity(num_parts);
    for first in (0..num_parts).step_by(PARTS_OF_A_STEP) {
        let made = map_indexed(PARTS_OF_A_STEP.min(num_parts - first), |k| part(first + k));
        for rows in made {
            parts.push(rows?);
        }
        steps.step()?;
    }
    Stencils::joined(num_columns, parts).ok_or(StencilError::TooLarge)
}

/// R rows in the making, which share their columns.
pub(super) struct Sums<const R: usize> {
    /// For every column one more than its number among the entries, or 0.
    slots: Vec<u32>,
    entries: Vec<(u32, [f64; R])>,
}

impl<const R: usize> Sums<R> {
    pub(super) fn new(num_columns: usize) -> Self {
        Self { slots: vec![0; num_columns], entries: Vec::new() }
    }

    /// Adds weights of a column.
    #[inline]
    pub(super) fn add(&mut self, column: u32, weights: [f64; R]) {
        let slot = &mut self.slots[column as usize];
        if *slot == 0 {
            self.entries.push((column, weights));
            *slot = self.entries.len() as u32;
        } else {
            let (_, sums) = &mut self.entries[*slot as usize - 1];
            sums.iter_mut().zip(weights).for_each(|(sum, w)| *sum += w);
        }
    }

    /// Ends the rows, without weights that are zero, and is empty again.
    pub(super) fn move_to(&mut self, rows: &mut Stencils) -> Result<(), StencilError> {
        self.entries.sort_unstable_by_key(|&(column, _)| column);
        for r in 0..R {
            for (column, weights) in self.entries.iter().filter(|(_, w)| w[r] != 0.0) {
                rows.push(*column, weights[r]);
            }
            if !rows.end_row() {
                return Err(StencilError::TooLarge);
            }
        }
        self.entries.drain(..).for_each(|(column, _)| self.slots[column as usize] = 0);
        Ok(())
    }
}
