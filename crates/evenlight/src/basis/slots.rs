//! Where the functions of rings sit, and the BB coefficients of a ring from theirs.
//!
//! In one variable, C2 splines of degree 5 with triple knots have three B-splines for each knot,
//! called L, M, R here; those of degree 6 with fourfold knots have one more for each segment. With
//! the knot at the share t of the two segments beside it, their coefficients are, next to the knot,
//!
//! ```text
//!   p_(d-2) = L,  p_(d-1) = (1-t) L + t M,      q_1 = (1-t) M + t R,  q_2 = R,
//!   p_d = q_0 = (1-t)^2 L + 2 t (1-t) M + t^2 R:
//! ```
//!
//! The spline is C2 whatever L, M, R are, 1 if they are 1, and not negative unless one of them is.
//! Knots inside a sector are at sigma of \[0,1\]. On lines between sectors the two segments are
//! equal, so the share t is 1/2.
//!
//! Functions are tensor products of these B-splines. Every ring has two corners for each sector at
//! its hole. A corner has nine functions, which the ring before it and the ring beyond it share. In
//! degree 6 each edge has three functions and each square has one:
//!
//! ```text
//!   v
//!   1 .-------e-------.-------e-------.      o  corner functions of the level of the ring's hole,
//!     |               |               |      e  edge functions (bi-6) of that level; those of the
//!     e'      f       e'      f       |         outer edges belong to the level before
//!     |               |               |      e' edge functions of the ring itself (bi-6)
//!   s o-------e-------o-------e'------.      f  face functions of the ring itself (bi-6)
//!     |               |               |
//!     |               e       f       e
//!     |     hole      |               |
//!     +---------------o-------e'------.  u, line s-1
//! ```
//!
//! The outer border of a ring, its three outer layers, has the functions of the level before. The
//! functions of level 0 are the outer border of ring 0.

use crate::pairs::pairs;

/// Weights of functions, numbered by [`Slots::slot`].
pub(super) type Combination = Vec<(usize, f64)>;

/// The number of coefficients next to a side that the knot there determines.
pub(super) const LAYERS: usize = 3;

/// The square \[s,1\] x \[s,1\] of a ring.
const DIAGONAL: usize = 0;

/// The square \[s,1\] x \[0,s\], ahead of line s-1.
const AHEAD: usize = 1;

/// The square \[0,s\] x \[s,1\], behind line s.
const BEHIND: usize = 2;

/// A knot at the share t between two segments.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot(f64);

impl Knot {
    /// The weights of L, M, R in coefficient `k` = 0, 1, 2 behind the knot.
    fn right(self, k: usize) -> [f64; 3] {
        let (s, t) = (1.0 - self.0, self.0);
        [[s * s, 2.0 * s * t, t * t], [0.0, s, t], [0.0, 0.0, 1.0]][k]
    }

    /// The weights of L, M, R in coefficient `k` = 0, 1, 2, that is d-2, d-1, d, before the knot.
    fn left(self, k: usize) -> [f64; 3] {
        let [l, m, r] = Self(1.0 - self.0).right(LAYERS - 1 - k);
        [r, m, l]
    }

    /// The weights of coefficients 0, 1, 2 behind the knot in L, M, R (number `p`).
    fn of_right(self, p: usize) -> [f64; 3] {
        let (s, t) = (1.0 - self.0, self.0);
        let middle = [0.0, 1.0 / s, -t / s];
        match p {
            2 => [0.0, 0.0, 1.0],
            1 => middle,
            _ => {
                let rest = [1.0, -2.0 * s * t * middle[1], -2.0 * s * t * middle[2] - t * t];
                rest.map(|x| x / (s * s))
            }
        }
    }

    /// The weights of coefficients d-2, d-1, d before the knot in L, M, R (number `p`).
    fn of_left(self, p: usize) -> [f64; 3] {
        let [a, b, c] = Self(1.0 - self.0).of_right(LAYERS - 1 - p);
        [c, b, a]
    }
}

/// A coefficient b_ij of the patch in a square.
pub(super) type Coefficient = (usize, [usize; 2]);

/// The numbering of the functions of one ring, for one sector.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slots {
    /// The bi-degree, 5 or 6.
    pub(super) degree: usize,
    at_sigma: Knot,
    on_line: Knot,
}

/// A place of functions in a sector. Index p along u and q along v are 0, 1, 2 for L, M, R; m is
/// the number inside an edge, 0 .. d-5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SlotPlace {
    /// At the corner on line s-1; q along the sector.
    OnLine { p: usize, q: usize },
    /// At the corner on the diagonal.
    OnDiagonal { p: usize, q: usize },
    /// At the edge u = sigma.
    EdgeU { p: usize, m: usize },
    /// At the edge v = sigma.
    EdgeV { m: usize, q: usize },
    /// At the edge on line s-1.
    Line { m: usize, q: usize },
    /// At the edge between the squares ahead and on the diagonal.
    DiagonalAhead { m: usize, q: usize },
    /// At the edge between the squares behind and on the diagonal.
    DiagonalBehind { p: usize, m: usize },
    /// In a square.
    Face { square: usize, m: usize, k: usize },
}

impl Slots {
    /// The layout of rings of bi-`degree` 5 or 6, with a hole of width sigma.
    pub(super) fn new(degree: usize, sigma: f64) -> Self {
        Self { degree, at_sigma: Knot(sigma), on_line: Knot(0.5) }
    }

    /// The number of inner coefficients of a segment that no knot determines, 0 or 1.
    fn inner(self) -> usize {
        self.degree - 5
    }

    /// The number of functions of a level in one sector: 18 or 24.
    pub(super) fn of_level(self) -> usize {
        18 + 6 * self.inner()
    }

    /// The number of functions of the ring itself in one sector: 0 or 12.
    pub(super) fn of_ring(self) -> usize {
        9 * self.inner() + 3 * self.inner() * self.inner()
    }

    /// The number of slots of one sector. The slots of the level come first, then the slots of the
    /// ring itself; the slots of the next sector follow.
    pub(super) fn slots(self) -> usize {
        self.of_level() + self.of_ring()
    }

    /// The number of a function of a sector.
    fn slot(self, place: SlotPlace) -> usize {
        let h = self.inner();
        let local = self.of_level();
        match place {
            SlotPlace::OnLine { p, q } => 3 * p + q,
            SlotPlace::OnDiagonal { p, q } => 9 + 3 * p + q,
            SlotPlace::EdgeU { p, m } => 18 + 3 * m + p,
            SlotPlace::EdgeV { m, q } => 18 + 3 * (h + m) + q,
            SlotPlace::Line { m, q } => local + 3 * m + q,
            SlotPlace::DiagonalAhead { m, q } => local + 3 * (h + m) + q,
            SlotPlace::DiagonalBehind { p, m } => local + 3 * (2 * h + m) + p,
            SlotPlace::Face { square, m, k } => local + 9 * h + (square * h + m) * h + k,
        }
    }

    /// Whether the sector before also uses slot `slot` of a sector.
    pub(super) fn is_on_line(self, slot: usize) -> bool {
        let local = self.of_level();
        slot < 9 || (local..local + 3 * self.inner()).contains(&slot)
    }

    /// Products of weights along u and v at a corner. The corner on the next line has its own
    /// names: its first direction is v and its second one -u.
    fn product(self, corner: SlotCorner, u: [f64; 3], v: [f64; 3]) -> Combination {
        let pairs = pairs(3, 3);
        let slot = |p, q| match corner {
            SlotCorner::Line => self.slot(SlotPlace::OnLine { p, q }),
            SlotCorner::Diagonal => self.slot(SlotPlace::OnDiagonal { p, q }),
            SlotCorner::NextLine => self.slots() + self.slot(SlotPlace::OnLine { p: q, q: 2 - p }),
        };
        sparse(pairs.map(|(p, q)| (slot(p, q), u[p] * v[q])))
    }

    /// A coefficient of the layers behind a hole's edge, of the level of the hole: layer `layer` of
    /// edge u = sigma (0) or v = sigma (1), number `k` along it.
    ///
    /// These are the inner layers of the squares ahead and behind, and the border of the next ring.
    pub(super) fn border(self, edge: usize, layer: usize, k: usize) -> Combination {
        let across = self.at_sigma.right(layer);
        let last = self.degree + 1 - LAYERS;
        let inside = |place: &dyn Fn(usize) -> SlotPlace| {
            sparse((0..3).map(|p| (self.slot(place(p)), across[p])))
        };
        match (edge, k) {
            (0, 0..LAYERS) => self.product(SlotCorner::Line, across, self.on_line.right(k)),
            (0, k) if k < last => inside(&|p| SlotPlace::EdgeU { p, m: k - LAYERS }),
            (0, k) => self.product(SlotCorner::Diagonal, across, self.at_sigma.left(k - last)),
            (_, 0..LAYERS) => self.product(SlotCorner::NextLine, self.on_line.right(k), across),
            (_, k) if k < last => inside(&|q| SlotPlace::EdgeV { m: k - LAYERS, q }),
            (_, k) => self.product(SlotCorner::Diagonal, self.at_sigma.left(k - last), across),
        }
    }

    /// A coefficient of a ring as weights of the functions of its own slots; `None` for
    /// coefficients of the outer border.
    pub(super) fn coefficient(self, (square, [i, j]): Coefficient) -> Option<Combination> {
        let outer = self.degree + 1 - LAYERS;
        let (is_outer_u, is_outer_v) =
            (square != BEHIND && i >= outer, square != AHEAD && j >= outer);
        if is_outer_u || is_outer_v {
            return None;
        }
        Some(match square {
            AHEAD if i < LAYERS => self.border(0, i, j),
            BEHIND if j < LAYERS => self.border(1, j, i),
            DIAGONAL if i < LAYERS && j < LAYERS => {
                let [u, v] = [i, j].map(|k| self.at_sigma.right(k));
                self.product(SlotCorner::Diagonal, u, v)
            }
            _ => self.of_own_ring(square, [i, j]),
        })
    }

    /// A coefficient that does not depend on the functions of a level.
    fn of_own_ring(self, square: usize, [i, j]: [usize; 2]) -> Combination {
        let last = self.degree + 1 - LAYERS;
        let is_inner = |k: usize| (LAYERS..last).contains(&k);
        if is_inner(i) && is_inner(j) {
            return vec![(
                self.slot(SlotPlace::Face { square, m: i - LAYERS, k: j - LAYERS }),
                1.0,
            )];
        }
        // The number inside the edge, and across it.
        let [m, k] = if is_inner(i) { [i - LAYERS, j] } else { [j - LAYERS, i] };
        let (weights, slot): ([f64; 3], &dyn Fn(usize) -> usize) = match square {
            AHEAD if k < LAYERS => {
                (self.on_line.right(k), &|q| self.slot(SlotPlace::Line { m, q }))
            }
            AHEAD => {
                (self.at_sigma.left(k - last), &|q| self.slot(SlotPlace::DiagonalAhead { m, q }))
            }
            BEHIND if k < LAYERS => (self.on_line.right(k), &|p| {
                self.slots() + self.slot(SlotPlace::Line { m, q: 2 - p })
            }),
            BEHIND => {
                (self.at_sigma.left(k - last), &|p| self.slot(SlotPlace::DiagonalBehind { p, m }))
            }
            _ if is_inner(i) => {
                (self.at_sigma.right(k), &|q| self.slot(SlotPlace::DiagonalAhead { m, q }))
            }
            _ => (self.at_sigma.right(k), &|p| self.slot(SlotPlace::DiagonalBehind { p, m })),
        };
        sparse((0..3).map(|p| (slot(p), weights[p])))
    }

    /// The functions of one sector from the coefficients of a C2 ring: for each slot of the sector
    /// weights of coefficients of the same sector.
    pub(super) fn functions_from_ring(self) -> Vec<Vec<(Coefficient, f64)>> {
        let h = self.inner();
        let (line, sigma) = (self.on_line, self.at_sigma);
        let both = |square: usize, u: [f64; 3], v: [f64; 3]| {
            let pairs = pairs(3, 3).map(|(i, j)| [i, j]);
            sparse(pairs.map(|[i, j]| ((square, [i, j]), u[i] * v[j])))
        };
        let along_u = |square: usize, u: [f64; 3], m: usize| {
            sparse((0..3).map(|i| ((square, [i, LAYERS + m]), u[i])))
        };
        let along_v = |square: usize, m: usize, v: [f64; 3]| {
            sparse((0..3).map(|j| ((square, [LAYERS + m, j]), v[j])))
        };
        let mut all = vec![Vec::new(); self.slots()];
        for (p, q) in pairs(3, 3) {
            all[self.slot(SlotPlace::OnLine { p, q })] =
                both(AHEAD, sigma.of_right(p), line.of_right(q));
            all[self.slot(SlotPlace::OnDiagonal { p, q })] =
                both(DIAGONAL, sigma.of_right(p), sigma.of_right(q));
        }
        for (p, m) in pairs(3, h) {
            all[self.slot(SlotPlace::EdgeU { p, m })] = along_u(AHEAD, sigma.of_right(p), m);
            all[self.slot(SlotPlace::EdgeV { m, q: p })] = along_v(BEHIND, m, sigma.of_right(p));
            all[self.slot(SlotPlace::Line { m, q: p })] = along_v(AHEAD, m, line.of_right(p));
            all[self.slot(SlotPlace::DiagonalAhead { m, q: p })] =
                along_v(DIAGONAL, m, sigma.of_right(p));
            all[self.slot(SlotPlace::DiagonalBehind { p, m })] =
                along_u(DIAGONAL, sigma.of_right(p), m);
        }
        for (square, m, k) in
            (0..3).flat_map(|square| (0..h).flat_map(move |m| (0..h).map(move |k| (square, m, k))))
        {
            all[self.slot(SlotPlace::Face { square, m, k })] =
                vec![((square, [LAYERS + m, LAYERS + k]), 1.0)];
        }
        all
    }

    /// The functions of a level of one sector from the layers beyond the border: weights of (edge,
    /// layer, number along the edge), as in [`Slots::border`].
    pub(super) fn functions_from_border(self) -> Vec<Vec<([usize; 3], f64)>> {
        let last = self.degree + 1 - LAYERS;
        let corner = |first: usize, across: [f64; 3], along: [f64; 3]| {
            let pairs = pairs(3, 3);
            sparse(pairs.map(|(layer, k)| ([0, layer, first + k], across[layer] * along[k])))
        };
        let edge = |edge: usize, m: usize, across: [f64; 3]| {
            sparse((0..3).map(|layer| ([edge, layer, LAYERS + m], across[layer])))
        };
        let sigma = self.at_sigma;
        let mut all = vec![Vec::new(); self.of_level()];
        for (p, q) in pairs(3, 3) {
            all[self.slot(SlotPlace::OnLine { p, q })] =
                corner(0, sigma.of_right(p), self.on_line.of_right(q));
            all[self.slot(SlotPlace::OnDiagonal { p, q })] =
                corner(last, sigma.of_right(p), sigma.of_left(q));
        }
        for (p, m) in pairs(3, self.inner()) {
            all[self.slot(SlotPlace::EdgeU { p, m })] = edge(0, m, sigma.of_right(p));
            all[self.slot(SlotPlace::EdgeV { m, q: p })] = edge(1, m, sigma.of_right(p));
        }
        all
    }
}

/// A corner of the hole that a sector uses.
#[derive(Clone, Copy, Debug)]
enum SlotCorner {
    Line,
    Diagonal,
    NextLine,
}

/// Without weights of zero.
fn sparse<T>(weights: impl Iterator<Item = (T, f64)>) -> Vec<(T, f64)> {
    weights.filter(|(_, w)| *w != 0.0).collect()
}
