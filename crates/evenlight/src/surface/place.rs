//! Where patches lie in parametric quads, and the change between the parameters of a sector and
//! the parameters of its quad.
//!
//! A sector's a runs from the extraordinary point to the next corner of its square, b to the one
//! before:
//!
//! ```text
//!   corner 0     corner 1     corner 2     corner 3
//!   b -- +       + -- a       a -- e       e -- b
//!   |    |       |    |       |    |       |    |       e: the extraordinary point
//!   e -- a       b -- e       + -- b       a -- +       (u to the right, v upwards)
//! ```

use std::fmt;

use super::QuadId;
use crate::mesh::isolation::CORNERS;
use crate::patch::{Jet, Patch};
use crate::point::scale;

/// What a patch is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Role {
    /// A bi-3 patch whose four corners are regular.
    Regular,
    /// A patch of ring `k` around an extraordinary point, counted from 0 as in
    /// [`Rings`](crate::rings::Rings); files count from 1.
    Ring(usize),
    /// A patch of the cap behind the rings around an extraordinary point.
    Cap,
}

/// The word used in files, which count rings from 1: `regular`, `ring-1`, `ring-2` and so on,
/// `cap`.
impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Regular => f.write_str("regular"),
            Self::Ring(k) => write!(f, "ring-{}", k + 1),
            Self::Cap => f.write_str("cap"),
        }
    }
}

/// Where a polynomial patch lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchPlace {
    /// What it is part of.
    pub role: Role,
    /// The parametric quad that it lies in.
    pub quad: QuadId,
    /// The part of that quad: [[u0, u1], [v0, v1]]; the patch's own (u,v) runs over it in the
    /// same directions.
    pub domain: [[f64; 2]; 2],
    /// The extraordinary point it belongs to, as an index into
    /// [`Surface::extraordinary_points`](super::Surface::extraordinary_points); `None` for regular
    /// patches.
    pub point: Option<usize>,
    /// The sector of that point, from 0.
    pub sector: Option<usize>,
    pub(crate) source: Source,
}

/// What a patch is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Source {
    /// The number of its control net.
    Net(u32),
    /// A patch of a ring around an extraordinary point.
    Ring(RingPatch),
    /// A patch of a cap; `ring` is the number of rings in front of it.
    Cap(RingPatch),
}

/// Patch `which` of a sector of a ring (from 0), the sector's square in its quad and the corner of
/// the square at which the extraordinary point is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RingPatch {
    pub(crate) point: usize,
    pub(crate) sector: usize,
    pub(crate) ring: usize,
    pub(crate) which: usize,
    pub(crate) square: Square,
    pub(crate) corner: u8,
}

/// One polynomial patch of the surface and where it lies.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedPatch<const N: usize = 3> {
    /// What it is part of, and where it lies.
    pub place: PatchPlace,
    /// The polynomial.
    pub patch: Patch<N>,
}

/// A square of a parametric quad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Square {
    pub(crate) quad: QuadId,
    pub(crate) origin: [f64; 2],
    pub(crate) size: f64,
}

impl Square {
    pub(super) fn child(self, k: usize) -> Self {
        let size = 0.5 * self.size;
        let origin = [0, 1].map(|d| self.origin[d] + CORNERS[k][d] * size);
        Self { origin, size, ..self }
    }

    /// The square's own parameters of a point of the quad.
    pub(super) fn parameters(self, at: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|d| (at[d] - self.origin[d]) / self.size)
    }

    /// The part of the quad that is `part` of this square.
    pub(super) fn part(self, part: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
        [0, 1].map(|d| part[d].map(|x| self.origin[d] + self.size * x))
    }
}

/// The corner of the quarter of a square in which a point lies.
pub(crate) fn quadrant([u, v]: [f64; 2]) -> usize {
    match (u > 0.5, v > 0.5) {
        (false, false) => 0,
        (true, false) => 1,
        (true, true) => 2,
        (false, true) => 3,
    }
}

/// The sector parameters (a,b) of a point (u,v) of a square, the extraordinary point being at
/// the square's corner `corner`: a runs to the next corner, b to the one before.
pub(crate) fn to_sector(corner: u8, [u, v]: [f64; 2]) -> [f64; 2] {
    match corner {
        0 => [u, v],
        1 => [v, 1.0 - u],
        2 => [1.0 - u, 1.0 - v],
        _ => [1.0 - v, u],
    }
}

/// The inverse of [`to_sector`].
pub(super) fn from_sector_parameters(corner: u8, [a, b]: [f64; 2]) -> [f64; 2] {
    match corner {
        0 => [a, b],
        1 => [1.0 - b, a],
        2 => [1.0 - a, 1.0 - b],
        _ => [b, 1.0 - a],
    }
}

/// The jet in (u,v) of a map given in (a,b).
pub(super) fn from_sector<const N: usize>(corner: u8, jet: &Jet<N>) -> Jet<N> {
    let minus = |r| scale(-1.0, r);
    let Jet { p, du: da, dv: db, duu: daa, duv: dab, dvv: dbb } = *jet;
    match corner {
        0 => *jet,
        1 => Jet { p, du: minus(db), dv: da, duu: dbb, duv: minus(dab), dvv: daa },
        2 => Jet { p, du: minus(da), dv: minus(db), duu: daa, duv: dab, dvv: dbb },
        _ => Jet { p, du: db, dv: minus(da), duu: dbb, duv: minus(dab), dvv: daa },
    }
}

/// A patch given in (a,b) with its parameters along (u,v).
pub(super) fn turned_patch<const N: usize>(corner: u8, patch: Patch<N>) -> Patch<N> {
    let [d, _] = patch.degree();
    // Coefficient (i, j) of the result is number first + i * by_i + j * by_j of the patch.
    let order = d as isize + 1;
    let (first, by_i, by_j) = match corner {
        0 => return patch,
        1 => (order - 1, -1, order),
        2 => (order * order - 1, -order, -1),
        _ => (order * (order - 1), 1, -order),
    };
    let coefs = patch.coefs();
    let mut turned = Vec::with_capacity(coefs.len());
    for i in 0..order {
        turned.extend((0..order).map(|j| coefs[(first + i * by_i + j * by_j) as usize]));
    }
    Patch::of([d, d], turned)
}

/// The (u,v) rectangle, in the square of its sector, of a patch of ring `ring` (from 0) that
/// covers `domain` in ring 0; rings shrink by `sigma`.
pub(super) fn ring_domain(
    corner: u8,
    sigma: f64,
    ring: usize,
    [[a0, a1], [b0, b1]]: [[f64; 2]; 2],
) -> [[f64; 2]; 2] {
    let scale = (0..ring).fold(1.0, |scale, _| sigma * scale);
    let ends =
        [[a0, b0], [a1, b1]].map(|end| from_sector_parameters(corner, end.map(|x| scale * x)));
    [0, 1].map(|d| [ends[0][d].min(ends[1][d]), ends[0][d].max(ends[1][d])])
}
