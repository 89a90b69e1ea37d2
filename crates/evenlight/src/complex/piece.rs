//! The numbers of patches: which patch a source is.

use super::exact::{AxisLines, ExactSquare, Rectangle};
use crate::scheme::Rules;
use crate::surface::{PatchPlace, RingPatch, Role, Source};

/// The patches of a complex by what they are made of. Those of one sector follow each other, ring
/// by ring.
#[derive(Clone, Debug, Default)]
pub(super) struct Numbers {
    /// The rings around each point, in front of a cap or not.
    rings: usize,
    /// The patch of every net.
    of_nets: Vec<u32>,
    /// The first of the sectors of every point.
    first_sectors: Vec<usize>,
    /// The first patch of every sector.
    of_sectors: Vec<u32>,
    /// The patches in one sector of a ring around every point.
    per_sector: Vec<usize>,
}

/// No patch: a net or sector in a face without a surface has none.
const NONE: u32 = u32::MAX;

impl Numbers {
    /// The numbers of patches with `rings` rings around points with these rules.
    pub(super) fn of<'a>(
        places: &[PatchPlace],
        rings: usize,
        rules: impl Iterator<Item = &'a Rules>,
    ) -> Self {
        let (mut first_sectors, mut per_sector, mut count) = (Vec::new(), Vec::new(), 0);
        for rules in rules {
            first_sectors.push(count);
            per_sector.push(rules.patches_per_sector());
            count += rules.valence;
        }
        let mut numbers = Self {
            rings,
            of_nets: Vec::new(),
            first_sectors,
            of_sectors: vec![NONE; count],
            per_sector,
        };
        for (place, number) in places.iter().zip(0..) {
            match place.source {
                Source::Net(net) => {
                    let net = net as usize;
                    let len = numbers.of_nets.len().max(net + 1);
                    numbers.of_nets.resize(len, NONE);
                    numbers.of_nets[net] = number;
                }
                Source::Ring(patch) | Source::Cap(patch) => {
                    let sector = numbers.first_sectors[patch.point] + patch.sector;
                    let first = &mut numbers.of_sectors[sector];
                    *first = number.min(*first);
                }
            }
        }
        numbers
    }

    /// The number of the patch at a place of the layout; `None` if it is in a deeper ring.
    pub(super) fn number(&self, place: &PatchPlace) -> Option<u32> {
        let (first, further) = match place.source {
            Source::Net(net) => (*self.of_nets.get(net as usize)?, 0),
            Source::Ring(patch) | Source::Cap(patch) => {
                let RingPatch { point, sector, ring, which, .. } = patch;
                if place.role != Role::Cap && ring >= self.rings {
                    return None;
                }
                let first = self.of_sectors[self.first_sectors[point] + sector];
                (first, ring * self.per_sector[point] + which)
            }
        };
        (first != NONE).then(|| first + further as u32)
    }
}

/// The rectangle that a patch covers; `rules` are those of its point.
pub(super) fn rectangle<'a>(
    place: &PatchPlace,
    lines: &[AxisLines],
    rules: impl Fn(usize) -> &'a Rules,
) -> Rectangle {
    match place.source {
        Source::Net(_) => {
            let [[u0, u1], [v0, _]] = place.domain;
            let square = ExactSquare::new([u0, v0], u1 - u0);
            square.origin.map(|x| [x, x + square.size()])
        }
        Source::Ring(RingPatch { point, ring, which, square, corner, .. }) => {
            let square = ExactSquare::new(square.origin, square.size);
            let first = rules(point).patch_lines(which);
            square.of_sector(corner, lines[point].ring_patch(square.level, ring, first))
        }
        Source::Cap(RingPatch { point, which, square, corner, .. }) => {
            let square = ExactSquare::new(square.origin, square.size);
            square.of_sector(corner, lines[point].cap_patch(square.level, which))
        }
    }
}
