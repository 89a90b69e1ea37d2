//! The coefficients of patches as stencils.

use super::StencilError;
use super::columns::{Sums, in_parts};
use super::smooth::SmoothNet;
use crate::patch::MAX_DEGREE;
use crate::sparse::Stencils;
use crate::surface::PatchPlace;

/// Rows of the Bernstein-Bezier coefficients of patches.
#[derive(Clone, Debug)]
pub struct PatchStencils {
    /// The first row of every patch, and the number of rows.
    firsts: Vec<usize>,
    stencils: Stencils,
}

impl PatchStencils {
    pub(super) fn new(net: &SmoothNet, places: &[PatchPlace]) -> Result<Self, StencilError> {
        let mut firsts = vec![0];
        for (patch, place) in places.iter().enumerate() {
            let rows = net.patch(place)?.ok_or(StencilError::Patch { patch })?;
            firsts.push(firsts[patch] + (rows.degree() + 1) * (rows.degree() + 1));
        }
        let num_columns = net.columns().count();
        let stencils = in_parts(num_columns, places.len(), |range| {
            let (mut rows, mut sums) = (Stencils::empty(num_columns), Sums::<1>::new(num_columns));
            for patch in range {
                let of = net.patch(&places[patch])?.ok_or(StencilError::Patch { patch })?;
                let order = of.degree() + 1;
                for k in 0..order * order {
                    net.coefficient(&of, [k / order, k % order], &mut sums);
                    sums.move_to(&mut rows)?;
                }
            }
            Ok(rows)
        })?;
        Ok(Self { firsts, stencils })
    }

    /// The rows of all patches, one after the other. In the rows of a patch the index along v is
    /// fastest.
    pub fn stencils(&self) -> &Stencils {
        &self.stencils
    }

    /// The rows of a patch, by its number among the places; `None` if there is no such patch.
    pub fn rows(&self, patch: usize) -> Option<std::ops::Range<usize>> {
        let end = *self.firsts.get(patch.checked_add(1)?)?;
        Some(self.firsts[patch]..end)
    }

    /// The degree of a patch in both parameters; `None` if there is no such patch.
    pub fn degree(&self, patch: usize) -> Option<usize> {
        let count = self.rows(patch)?.len();
        (0..=MAX_DEGREE).find(|d| (d + 1) * (d + 1) == count)
    }
}
