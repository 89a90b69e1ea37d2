//! Exact positions: whole numbers, so that places that are one have one number and others have not.
//!
//! A parametric quad is [`ONE`] = 3 2^120 wide. Everything that is cut in halves and thirds has
//! whole coordinates then: the squares of isolation (2^-12 and larger), the patches of a ring (1/2,
//! 1/4 or 1/6 of it), the pieces of a cap (up to 4), and a hundred rings.
//!
//! Rings that do not halve have lines at irrational places ([`Cuts`]). Their places are rounded, by
//! always the same steps, and lines that are one by construction are computed once:
//!
//! ```text
//!   +-----+-----+
//!   |     |     |       line k of ring l, 0 <= k <= split, along the hole
//!   |     |     |     = line 2k of ring l+1 along its outer border
//!   +--+--+-----+
//!   |  |  |     |
//!   +--+--+     |
//!   |..|  |     |
//!   +--+--+-----+
//!   0  1  2     4     lines of ring 0 on top and bottom, split = 2
//! ```

use crate::scheme::{Cuts, Rules};

/// A coordinate in a parametric quad.
pub(super) type Exact = i128;

/// The width of a parametric quad.
pub(super) const ONE: Exact = 3 << POWER;

const POWER: u32 = 120;

/// So many rings have whole coordinates.
pub(super) const MAX_RINGS: usize = 100;

/// Rounded places keep so many zeros at their end, more than there are levels of isolation, so that
/// they stay whole when they are scaled down to a square of any level.
const ZEROS: u32 = 24;

/// Holes smaller than this, 2^-80 of the sector, have no rounded places: lines are at least .03 of
/// a hole apart, and so far above rounding.
const SMALLEST_HOLE: f64 = 1.0 / (1_u128 << 80) as f64;

/// The largest coordinate that is not beyond `x`, 0 <= x <= 1.
pub(super) fn exact(x: f64) -> Exact {
    const MANTISSA: u32 = f64::MANTISSA_DIGITS - 1;
    const BIAS: i32 = f64::MAX_EXP - 1;
    let bits = x.to_bits();
    let exponent = (bits >> MANTISSA) as i32;
    if exponent == 0 {
        return 0;
    }
    let mantissa = 3 * Exact::from(bits & ((1 << MANTISSA) - 1) | 1 << MANTISSA);
    let shift = exponent - BIAS - MANTISSA as i32 + POWER as i32;
    if shift >= 0 { mantissa << shift } else { mantissa >> (-shift).min(127) }
}

/// The part of `whole` that `part` is.
pub(super) fn ratio(part: Exact, whole: Exact) -> f64 {
    part as f64 / whole as f64
}

/// The square of a piece in its quad, 2^-level wide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ExactSquare {
    pub(super) origin: [Exact; 2],
    pub(super) level: u32,
}

/// A rectangle in a quad: `[[u0, u1], [v0, v1]]`.
pub(super) type Rectangle = [[Exact; 2]; 2];

impl ExactSquare {
    /// The square of this origin and size, which are sums of few powers of two.
    pub(super) fn new(origin: [f64; 2], size: f64) -> Self {
        let level = (ONE / exact(size).max(1)).ilog2();
        Self { origin: origin.map(exact), level }
    }

    pub(super) fn size(self) -> Exact {
        ONE >> self.level
    }

    /// The rectangle that the part `[[a0, a1], [b0, b1]]` of a sector is, whose point is at
    /// `corner`.
    pub(super) fn of_sector(self, corner: u8, [a, b]: Rectangle) -> Rectangle {
        let size = self.size();
        let turned = |[from, to]: [Exact; 2]| [size - to, size - from];
        let [u, v] = match corner {
            0 => [a, b],
            1 => [turned(b), a],
            2 => [turned(a), turned(b)],
            _ => [b, turned(a)],
        };
        [u.map(|x| self.origin[0] + x), v.map(|x| self.origin[1] + x)]
    }
}

/// The lines between the patches around one point, along a and along b alike.
#[derive(Clone, Debug)]
pub(super) struct AxisLines {
    /// The patches along each side of a square of a ring.
    split: usize,
    /// The number of rings.
    rings: usize,
    /// The patches along each side of a sector of the cap, 0 without cap.
    cap_split: usize,
    cuts: Option<Cuts>,
}

impl AxisLines {
    pub(super) fn new(rules: &Rules, rings: usize, cap_split: usize) -> Self {
        Self { split: rules.split, rings, cap_split, cuts: rules.cuts().cloned() }
    }

    /// The most rings that have places.
    pub(super) fn most_rings(&self) -> usize {
        let Some(Cuts { sigma, .. }) = &self.cuts else { return MAX_RINGS };
        let (mut hole, mut rings) = (*sigma, 0);
        while hole > SMALLEST_HOLE && rings < MAX_RINGS {
            hole *= sigma;
            rings += 1;
        }
        rings
    }

    /// The place of a line of ring `ring` in a sector of level `level`.
    fn line(&self, level: u32, ring: usize, line: usize) -> Exact {
        let (mut ring, mut line) = (ring, line);
        while ring > 0 && line.is_multiple_of(2) {
            (ring, line) = (ring - 1, line / 2);
        }
        match &self.cuts {
            None => (ONE >> level >> ring) * line as Exact / (2 * self.split) as Exact,
            Some(Cuts { sigma, lines }) => rounded(level, ring, *sigma, lines[line]),
        }
    }

    /// The place of line `line` of the cap.
    fn cap_line(&self, level: u32, line: usize) -> Exact {
        if line == self.cap_split {
            return self.hole(level, self.rings);
        }
        match &self.cuts {
            None => (ONE >> level >> self.rings) * line as Exact / self.cap_split as Exact,
            Some(cuts) => {
                rounded(level, self.rings, cuts.sigma, line as f64 / self.cap_split as f64)
            }
        }
    }

    /// The width of the hole in front of ring `ring`.
    fn hole(&self, level: u32, ring: usize) -> Exact {
        self.line(level, ring, 2 * self.split)
    }

    /// What a patch of ring `ring` covers that begins at these lines in a and b.
    pub(super) fn ring_patch(&self, level: u32, ring: usize, first: [usize; 2]) -> Rectangle {
        first.map(|k| [k, k + 1].map(|k| self.line(level, ring, k)))
    }

    /// What a patch of the cap covers.
    pub(super) fn cap_patch(&self, level: u32, which: usize) -> Rectangle {
        [which / self.cap_split, which % self.cap_split]
            .map(|k| [k, k + 1].map(|k| self.cap_line(level, k)))
    }
}

/// sigma^ring x in a sector of level `level`, always by the same steps.
fn rounded(level: u32, ring: usize, sigma: f64, x: f64) -> Exact {
    let x = (0..ring).fold(x, |x, _| sigma * x);
    exact(x) >> ZEROS << ZEROS >> level
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scheme::{Contraction, SchemeKind, Variant};

    #[test]
    fn numbers_that_are_sums_of_powers_of_two_are_exact() {
        assert_eq!(exact(0.0), 0);
        assert_eq!(exact(1.0), ONE);
        assert_eq!(exact(0.75), ONE / 4 * 3);
        assert_eq!(exact(f64::from_bits(0x3fe5_5555_5555_5555)), ONE / 3 * 2 - (1 << 67));
        assert_eq!(exact(f64::MIN_POSITIVE), 0);
        for k in 0..=12 {
            let square = ExactSquare::new([0.5, 0.25], 1.0 / f64::from(1 << k));
            assert_eq!((square.level, square.size()), (k, ONE >> k));
        }
    }

    /// AxisLines with all splits, and with cuts where they can be derived.
    fn all_lines() -> Vec<AxisLines> {
        let variants = [Contraction::CatmullClark, Contraction::Half, Contraction::Lambda(0.31)];
        let mut all = Vec::new();
        for scheme in SchemeKind::ALL {
            for contraction in variants.into_iter().filter(|&c| scheme.check_contraction(c).is_ok())
            {
                let rules = scheme.rules(Variant::from(contraction), 5);
                all.push(AxisLines::new(&rules.expect("all have valence 5"), 20, 0));
            }
        }
        all
    }

    #[test]
    fn lines_of_a_ring_follow_each_other_and_every_second_is_of_the_ring_before() {
        for lines in all_lines() {
            assert!(lines.most_rings() >= 20, "{lines:?}");
            for ring in 0..20 {
                let at = |k: usize| lines.line(3, ring, k);
                assert_eq!(at(0), 0);
                assert!((0..2 * lines.split).all(|k| at(k) < at(k + 1)), "{lines:?}");
                // The construction of the lines says so; here up to the rounding of f64.
                if let Some(Cuts { sigma, lines: all }) = &lines.cuts {
                    for k in 0..=lines.split {
                        assert!((all[k] - sigma * all[2 * k]).abs() < 1e-15, "{all:?}");
                    }
                }
            }
        }
    }
}
