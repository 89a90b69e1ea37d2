//! Cutting the sides of patches where others end, and pairing what is left.
//!
//! ```text
//!   patches on one side    |--------A--------|----B----|
//!   of a carrier, and on   |---C---|----D----|                a hole beyond D
//!   the other
//!   edges                  |--A C--|---A D---|----B----|
//! ```

use super::carrier::{Carrier, Side};
use super::exact::Exact;

/// An interval of a carrier, no end of a side being inside it, and the sides that have it: the one
/// that runs along the carrier and the one that runs against it, as numbers of sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) carrier: Carrier,
    pub(super) interval: [Exact; 2],
    pub(super) forward: Option<u32>,
    pub(super) backward: Option<u32>,
}

/// All pairs, carrier by carrier. Takes time n log n.
pub(super) fn pairs(sides: &[Side]) -> Vec<Pair> {
    let mut order: Vec<u32> = (0..sides.len() as u32).collect();
    let key = |k: u32| {
        let side = &sides[k as usize];
        (side.carrier, side.is_forward, side.interval[0])
    };
    order.sort_unstable_by_key(|&k| key(k));
    let mut pairs = Vec::with_capacity(sides.len() / 2 + sides.len() / 8);
    let mut ends = Vec::new();
    for run in order.chunk_by(|&a, &b| sides[a as usize].carrier == sides[b as usize].carrier) {
        let backward = run.partition_point(|&k| !sides[k as usize].is_forward);
        pair_on_carrier(sides, run.split_at(backward), &mut ends, &mut pairs);
    }
    pairs
}

/// The pairs of one carrier; sides that run the same way are in order and do not overlap.
fn pair_on_carrier(
    sides: &[Side],
    (backward, forward): (&[u32], &[u32]),
    ends: &mut Vec<Exact>,
    pairs: &mut Vec<Pair>,
) {
    let all = || backward.iter().chain(forward).map(|&k| &sides[k as usize]);
    let Some(carrier) = all().next().map(|side| side.carrier) else { return };
    ends.clear();
    ends.extend(all().flat_map(|side| side.interval));
    ends.sort_unstable();
    ends.dedup();
    let mut rest = [forward, backward];
    for interval in ends.windows(2).map(|pair| [pair[0], pair[1]]) {
        let [forward, backward] = rest.each_mut().map(|rest| side_over(sides, rest, interval));
        if forward.is_some() || backward.is_some() {
            pairs.push(Pair { carrier, interval, forward, backward });
        }
    }
}

/// The side that has the interval; sides before it are dropped.
fn side_over(sides: &[Side], rest: &mut &[u32], [from, to]: [Exact; 2]) -> Option<u32> {
    while let [first, others @ ..] = *rest
        && sides[*first as usize].interval[1] <= from
    {
        *rest = others;
    }
    let &first = rest.first()?;
    let [start, end] = sides[first as usize].interval;
    (start <= from && to <= end).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::FaceId;

    #[test]
    fn sides_are_cut_where_others_end() {
        let carrier = Carrier::FaceLine(FaceId(3), 1);
        let other = Carrier::Inside(0, 1, 5);
        let side = |carrier, interval, is_forward, patch| Side {
            carrier,
            interval,
            is_forward,
            patch,
            side: 0,
        };
        let sides = [
            side(other, [0, 2], true, 9),
            side(carrier, [6, 9], true, 0),
            side(carrier, [0, 6], true, 1),
            side(carrier, [4, 6], false, 2),
            side(carrier, [0, 4], false, 3),
        ];
        let found: Vec<_> =
            pairs(&sides).iter().map(|p| (p.interval, p.forward, p.backward)).collect();
        let expected = [
            ([0, 4], Some(2), Some(4)),
            ([4, 6], Some(2), Some(3)),
            ([6, 9], Some(1), None),
            ([0, 2], Some(0), None),
        ];
        assert_eq!(found, expected);
    }
}
