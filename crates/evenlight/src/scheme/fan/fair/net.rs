//! The net of a fair fan: bi-3 on the half-step grid, with the spline of the crease beside it.
//!
//! ```text
//!   line s+1
//!   (0,3)  (1,3)  (2,3)  (3,3)      a net has the nodes up to 3 but for the centre; a ring of
//!   (0,2)  (1,2)  (2,2)  (3,2)      2 x 2 patches per square is made of the refined nodes up to 5.
//!   (0,1)  (1,1)  (2,1)  (3,1)      They follow from 3 on by knot insertion; the rest is free.
//!     .    (1,0)  (2,0)  (3,0)  line s
//! ```
//!
//! On the crease (a,0) is free, too. The curve itself is the cubic spline of the nodes P_a, which
//! have rules of their own. The node beyond the crease is such that the patches end in this curve:
//!
//! ```text
//!   (a,-1) + 4 (a,0) + (a,1) = 6 P_a.
//! ```
//!
//! All is relative to the limit point, so the spline's node at the centre is -(P_1 + P_1') / 4,
//! where P' is the other half of the crease.

use crate::dense::Matrix;
use crate::patch::basis::CUBIC_B_SPLINE_TO_BB;
use crate::scheme::fan::{Weights, add, knot_insertion};
use crate::scheme::rules::{PatchRule, Row};

/// The nodes of the crease's spline: P_1, P_2, P_3 at both ends.
pub(super) const SPLINE_NODES: usize = 6;

/// The origins of the patches of a ring, in the order of [`Rules`](crate::scheme::Rules), in steps
/// of the refined net.
pub(super) const PATCHES: [[isize; 2]; 12] = [
    [2, 2],
    [2, 3],
    [3, 2],
    [3, 3],
    [2, 0],
    [2, 1],
    [3, 0],
    [3, 1],
    [0, 2],
    [0, 3],
    [1, 2],
    [1, 3],
];

/// The nodes of a fan with this number of faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Net {
    pub(super) faces: usize,
}

impl Net {
    pub(super) fn num_nodes(self) -> usize {
        self.first_spline_node() + SPLINE_NODES
    }

    pub(super) fn first_spline_node(self) -> usize {
        3 * (self.faces + 1) + 9 * self.faces
    }

    fn last(self) -> isize {
        self.faces as isize - 1
    }

    /// The number of node (a,0) of a line, a from 1 to 3.
    fn on_line(self, line: isize, a: isize) -> usize {
        3 * line as usize + a as usize - 1
    }

    /// The number of node (a,b), a and b from 0 to 3, of sector `s`.
    fn number(self, s: isize, a: isize, b: isize) -> usize {
        match (a, b) {
            (a, 0) => self.on_line(s, a),
            (0, b) => self.on_line(s + 1, b),
            (a, b) => 3 * (self.faces + 1) + 9 * s as usize + 3 * (a as usize - 1) + b as usize - 1,
        }
    }

    /// P_a at the end of the crease on line 0 or on the last line.
    fn on_spline(self, end: usize, a: isize) -> usize {
        self.first_spline_node() + 3 * end + a as usize - 1
    }

    /// All nodes but those of the spline, in order, as (s, a, b).
    pub(super) fn places(self) -> impl Iterator<Item = (isize, isize, isize)> {
        let last = self.last();
        let line =
            move |k: isize| (1..4).map(move |a| if k > last { (last, 0, a) } else { (k, a, 0) });
        let inside = |s: isize| (1..4).flat_map(move |a| (1..4).map(move |b| (s, a, b)));
        (0..=last + 1).flat_map(line).chain((0..=last).flat_map(inside))
    }

    /// The free nodes.
    pub(super) fn free(self) -> Vec<usize> {
        let free = self.places().filter(|&(_, a, b)| a.max(b) <= 2);
        free.map(|(s, a, b)| self.number(s, a, b)).collect()
    }

    /// The node at the mirror image of every node.
    pub(super) fn mirror_images(self) -> Vec<usize> {
        let last = self.last();
        let image = |(s, a, b)| self.number(last - s, b, a);
        let spline = [1, 0].into_iter().flat_map(|end| (1..4).map(move |a| self.on_spline(end, a)));
        self.places().map(image).chain(spline).collect()
    }

    /// The node (a,b) of a net, a and b from -1 to 3; for the centre stands that of the spline.
    fn old(self, s: isize, a: isize, b: isize) -> Weights {
        if (a, b) == (0, 0) {
            return self.center();
        }
        let at = |s, a, b| self.old(s, a, b);
        let spline = |end, a| match a {
            0 => self.center(),
            a => [(self.on_spline(end, a), 1.0)].into(),
        };
        self.beyond([s, a, b], &at, &spline).unwrap_or_else(|| [(self.number(s, a, b), 1.0)].into())
    }

    /// The node (a,b), a and b from -1 to 5, of the refined net, by the nodes of the net and from
    /// `num_nodes` on those of the refined one.
    fn refined(self, s: isize, a: isize, b: isize) -> Weights {
        let at = |s, a, b| self.refined(s, a, b);
        let spline = |end, a| self.refined_spline(end, a);
        self.beyond([s, a, b], &at, &spline).unwrap_or_else(|| {
            if a.max(b) <= 3 {
                return [(self.num_nodes() + self.number(s, a, b), 1.0)].into();
            }
            self.inserted(s, a, b)
        })
    }

    /// The node beyond a line from the other nodes; `None` if it is not beyond a line.
    fn beyond(
        self,
        [s, a, b]: [isize; 3],
        at: &dyn Fn(isize, isize, isize) -> Weights,
        spline: &dyn Fn(usize, isize) -> Weights,
    ) -> Option<Weights> {
        let (end, k) = match (a, b) {
            (a, b) if b < 0 && s > 0 => return Some(at(s - 1, 1, a)),
            (a, b) if a < 0 && s < self.last() => return Some(at(s + 1, b, 1)),
            (a, b) if b < 0 => (0, a),
            (a, b) if a < 0 => (1, b),
            _ => return None,
        };
        let node = |across: isize| if end == 0 { at(s, k, across) } else { at(s, across, k) };
        let mut row = Weights::new();
        add(&mut row, 6.0, &spline(end, k));
        add(&mut row, -4.0, &node(0));
        add(&mut row, -1.0, &node(1));
        Some(row)
    }

    /// The node (a,b) of the refined net by knot insertion, a or b at least 3.
    fn inserted(self, s: isize, a: isize, b: isize) -> Weights {
        let mut row = Weights::new();
        for (x, wx) in knot_insertion(a) {
            for (y, wy) in knot_insertion(b) {
                add(&mut row, wx * wy, &self.old(s, x, y));
            }
        }
        row
    }

    /// P_a of the refined net.
    fn refined_spline(self, end: usize, a: isize) -> Weights {
        if a <= 3 {
            return [(self.num_nodes() + self.on_spline(end, a), 1.0)].into();
        }
        self.inserted_spline(end, a)
    }

    /// P_0.
    fn center(self) -> Weights {
        [0, 1].map(|end| (self.on_spline(end, 1), -0.25)).into()
    }

    fn inserted_spline(self, end: usize, a: isize) -> Weights {
        let mut row = Weights::new();
        for (x, w) in knot_insertion(a) {
            if x > 0 {
                add(&mut row, w, &[(self.on_spline(end, x), 1.0)].into());
            } else {
                add(&mut row, w, &self.center());
            }
        }
        row
    }

    /// Refinement with rows of zeros for the free nodes.
    pub(super) fn regular_step(self) -> Matrix {
        let mut rows: Vec<Weights> = self
            .places()
            .map(|(s, a, b)| if a.max(b) < 3 { Weights::new() } else { self.inserted(s, a, b) })
            .collect();
        rows.extend(
            [0, 1].into_iter().flat_map(|end| (1..4).map(move |a| self.inserted_spline(end, a))),
        );
        let n = self.num_nodes();
        let dense = |row: &Weights| (0..n).map(|k| row.get(&k).copied().unwrap_or(0.0)).collect();
        Matrix::from_rows(n, &rows.iter().map(dense).collect::<Vec<_>>())
    }

    /// The patch of a ring at [`PATCHES`]`[which]` of sector `s`.
    pub(super) fn patch(self, s: isize, which: usize) -> PatchRule {
        let [a, b] = PATCHES[which];
        let mut rule = PatchRule::default();
        for row in to_bb(|i, j| self.refined(s, a - 1 + i, b - 1 + j)) {
            let (old, new): (Row, Row) = row.into_iter().partition(|&(k, _)| k < self.num_nodes());
            rule.old.push(old);
            rule.new.push(new.into_iter().map(|(k, w)| (k - self.num_nodes(), w)).collect());
        }
        rule
    }
    /// The BB coefficients of the patches of the net itself between 1 and 2 in sector `s`, in the
    /// order [0,1] x [1,2], [1,2] x [0,1], [1,2] x [1,2]: the patches where the rings end.
    pub(super) fn cells(self, s: isize) -> [Vec<Row>; 3] {
        [[0, 1], [1, 0], [1, 1]].map(|[a, b]: [isize; 2]| {
            let rows = to_bb(|i, j| self.old(s, a - 1 + i, b - 1 + j));
            rows.into_iter().map(|row| row.into_iter().collect()).collect()
        })
    }
}

/// The BB coefficients of the bi-3 patch with these 4 x 4 nodes.
fn to_bb(node: impl Fn(isize, isize) -> Weights) -> Vec<Weights> {
    let nodes: Vec<Weights> = (0..16).map(|k| node(k / 4, k % 4)).collect();
    let coef = |k: usize| {
        let mut row = Weights::new();
        for (m, node) in nodes.iter().enumerate() {
            let w = CUBIC_B_SPLINE_TO_BB[k / 4][m / 4] * CUBIC_B_SPLINE_TO_BB[k % 4][m % 4];
            add(&mut row, w, node);
        }
        row
    };
    (0..16).map(coef).collect()
}
