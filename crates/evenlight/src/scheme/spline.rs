//! The regular part of the schemes on d-nets: knot insertion and conversion to BB form, for bi-4
//! C2 splines [KP23-EG, eq. 1, 6] and for uniform bi-3 splines on the half-step grid.
//!
//! A refinement halves the d-net. In one variable the new indices -2 to 4 lie on the half-step
//! grid of the new net. New nodes with an index below 1 follow from old nodes by knot insertion:
//!
//! ```text
//!   old index  0       1       2       3       4
//!              o-------*-------o-------*-------o      * grid line of the old net
//!   new index    -2  -1   0    1   2   3   4          3 is the line itself
//! ```

use super::rules::{PatchRule, Row, RowBuilder};
use crate::net::{Spline, dnet_node};
use crate::patch::basis::{CUBIC_B_SPLINE_TO_BB, QUARTIC_B_SPLINE_TO_BB};

/// The least new indices of the three squares of a ring, in the order of [`Rules`].
///
/// [`Rules`]: super::rules::Rules
const WINDOWS: [[isize; 2]; 3] = [[-2, -2], [-2, 0], [0, -2]];

impl Spline {
    pub(crate) fn degree(self) -> usize {
        match self {
            Self::BiCubic => 3,
            Self::BiQuartic => 4,
        }
    }

    /// Patches along each side of a square.
    pub(crate) fn split(self) -> usize {
        match self {
            Self::BiCubic => 2,
            Self::BiQuartic => 1,
        }
    }

    /// The new node (i,j), at least one index <= 0, from the old net, as weights on the nodes of
    /// an empty row.
    pub(crate) fn regular_node(self, mut row: RowBuilder, i: isize, j: isize) -> Row {
        for (a, wa) in self.knot_insertion(i) {
            for (b, wb) in self.knot_insertion(j) {
                row.add(dnet_node(a, b), wa * wb);
            }
        }
        row.finish()
    }

    /// Univariate knot insertion: new index -2 to 4 from old indices.
    fn knot_insertion(self, i: isize) -> Vec<(usize, f64)> {
        let (first, weights): (usize, &[f64]) = match (self, i) {
            (Self::BiQuartic, -2) => (0, &[9.0, 6.0, 1.0]),
            (Self::BiQuartic, -1) => (0, &[3.0, 10.0, 3.0]),
            (Self::BiQuartic, 0) => (0, &[1.0, 6.0, 9.0]),
            (Self::BiQuartic, 1) => (1, &[2.0, 12.0, 2.0]),
            (Self::BiQuartic, 2) => (2, &[9.0, 6.0, 1.0]),
            (Self::BiQuartic, 3) => (2, &[3.0, 10.0, 3.0]),
            (Self::BiQuartic, 4) => (2, &[1.0, 6.0, 9.0]),
            (Self::BiCubic, -2) => (0, &[8.0, 8.0]),
            (Self::BiCubic, -1) => (0, &[2.0, 12.0, 2.0]),
            (Self::BiCubic, 0) => (1, &[8.0, 8.0]),
            (Self::BiCubic, 1) => (1, &[2.0, 12.0, 2.0]),
            (Self::BiCubic, 2) => (2, &[8.0, 8.0]),
            (Self::BiCubic, 3) => (2, &[2.0, 12.0, 2.0]),
            (Self::BiCubic, 4) => (3, &[8.0, 8.0]),
            _ => unreachable!("a ring has the new indices -2 to 4, not {i}"),
        };
        weights.iter().enumerate().map(|(k, w)| (first + k, w / 16.0)).collect()
    }

    /// The patches of sector 0 of a ring; `empty` is a row without weights.
    pub(crate) fn patches(self, empty: &RowBuilder) -> Vec<PatchRule> {
        let split = self.split() as isize;
        let mut rules = Vec::new();
        for [i, j] in WINDOWS {
            for part in 0..split * split {
                // Indices grow towards the centre, the parts of a square away from it.
                let (a, b) = (split - 1 - part / split, split - 1 - part % split);
                rules.push(self.patch(empty, i + a, j + b));
            }
        }
        rules
    }

    /// The patch over the window of new indices that begins at (i,j).
    ///
    /// Indices grow towards the centre, patch parameters away from it, so coefficient (k,l) is the
    /// (d-k,d-l)th of the window.
    fn patch(self, empty: &RowBuilder, i: isize, j: isize) -> PatchRule {
        let to_bb = self.to_bb();
        let mut rule = PatchRule::default();
        for bb_u in to_bb.iter().rev() {
            for bb_v in to_bb.iter().rev() {
                let (mut old, mut new) = (empty.clone(), empty.clone());
                for (a, wa) in (i..).zip(bb_u.iter()) {
                    for (b, wb) in (j..).zip(bb_v.iter()) {
                        if a <= 0 || b <= 0 {
                            old.add_row(&self.regular_node(empty.clone(), a, b), wa * wb);
                        } else {
                            new.add(dnet_node(a as usize, b as usize), wa * wb);
                        }
                    }
                }
                rule.old.push(old.finish());
                rule.new.push(new.finish());
            }
        }
        rule
    }

    /// The rows of the univariate conversion of a window to BB form.
    fn to_bb(self) -> Vec<&'static [f64]> {
        match self {
            Self::BiCubic => CUBIC_B_SPLINE_TO_BB.iter().map(<[f64; 4]>::as_slice).collect(),
            Self::BiQuartic => QUARTIC_B_SPLINE_TO_BB.iter().map(<[f64; 5]>::as_slice).collect(),
        }
    }
}
