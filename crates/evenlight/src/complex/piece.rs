//! Where patches lie, exactly, and which of them has a place.
//!
//! The patches of a quad follow each other piece by piece: a regular patch, or the rings and the cap of
//! one sector. The pieces are the leaves of a tree of squares, in its order, so that a place is found by
//! going down the tree.

use super::exact::{Exact, ExactSquare, InSector, Lines, Rectangle, exact};
use crate::scheme::Rules;
use crate::surface::{PatchPlace, RingPatch, Source};

/// A piece of a quad with at least one patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    square: ExactSquare,
    /// The first of its patches.
    first: u32,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Regular,
    /// The sector of a point, which is at this corner of the square.
    Sector {
        point: u32,
        corner: u8,
    },
}

/// The pieces of all quads.
#[derive(Clone, Debug, Default)]
pub(super) struct Pieces {
    pieces: Vec<Piece>,
    /// The first piece of every quad, and the number of all.
    first: Vec<u32>,
}

impl Pieces {
    /// The pieces of patches that stand in the order of their quads.
    pub(super) fn of(places: &[PatchPlace], num_quads: usize) -> Self {
        let (mut pieces, mut first): (Vec<Piece>, _) = (Vec::new(), vec![0]);
        for (place, number) in places.iter().zip(0..) {
            let quad = place.quad.0 as usize;
            let is_new_quad = first.len() <= quad;
            first.resize(quad + 1, pieces.len() as u32);
            let (square, kind) = square_of(place);
            let last = pieces.last().filter(|_| !is_new_quad);
            if last.is_none_or(|piece| (piece.square, piece.kind) != (square, kind)) {
                pieces.push(Piece { square, first: number, kind });
            }
        }
        first.resize(num_quads + 1, pieces.len() as u32);
        Self { pieces, first }
    }

    /// The patch at (u,v) of a quad, which are clamped to 0..1; on a border one of them.
    pub(super) fn patch_at(&self, lines: &[Lines], quad: usize, uv: [f64; 2]) -> Option<u32> {
        let end = *self.first.get(quad + 1)? as usize;
        let mut pieces = &self.pieces[self.first[quad] as usize..end];
        if uv.iter().any(|x| x.is_nan()) {
            return None;
        }
        let at = uv.map(|x| exact(x.clamp(0.0, 1.0)));
        let mut square = ExactSquare::WHOLE;
        loop {
            let piece = pieces.first()?;
            if piece.square == square {
                return piece.patch_at(lines, at);
            }
            let quarter = square.quarter_of(at);
            let number = |piece: &Piece| square.quarter_of_square(piece.square);
            let start = pieces.partition_point(|piece| number(piece) < quarter);
            let end = pieces.partition_point(|piece| number(piece) <= quarter);
            pieces = &pieces[start..end];
            square = square.quarter(quarter);
        }
    }
}

impl Piece {
    fn patch_at(&self, lines: &[Lines], at: [Exact; 2]) -> Option<u32> {
        let Kind::Sector { point, corner } = self.kind else { return Some(self.first) };
        let lines = &lines[point as usize];
        let at = self.square.to_sector(corner, at);
        let number = match lines.patch_at(self.square.level, at)? {
            InSector::Ring(ring, which) => ring * lines.patches_per_sector() + which,
            InSector::Cap(which) => lines.rings() * lines.patches_per_sector() + which,
        };
        Some(self.first + number as u32)
    }
}

/// The square of the piece that a patch is of.
fn square_of(place: &PatchPlace) -> (ExactSquare, Kind) {
    match place.source {
        Source::Net(_) => {
            let [[u0, u1], [v0, _]] = place.domain;
            (ExactSquare::new([u0, v0], u1 - u0), Kind::Regular)
        }
        Source::Ring(RingPatch { point, square, corner, .. })
        | Source::Cap(RingPatch { point, square, corner, .. }) => {
            let kind = Kind::Sector { point: point as u32, corner };
            (ExactSquare::new(square.origin, square.size), kind)
        }
    }
}

/// The rectangle that a patch covers; `rules` are those of its point.
pub(super) fn rectangle<'a>(
    place: &PatchPlace,
    lines: &[Lines],
    rules: impl Fn(usize) -> &'a Rules,
) -> Rectangle {
    let (square, _) = square_of(place);
    match place.source {
        Source::Net(_) => square.origin.map(|x| [x, x + square.size()]),
        Source::Ring(RingPatch { point, ring, which, corner, .. }) => {
            let first = rules(point).patch_lines(which);
            square.of_sector(corner, lines[point].ring_patch(square.level, ring, first))
        }
        Source::Cap(RingPatch { point, which, corner, .. }) => {
            square.of_sector(corner, lines[point].cap_patch(square.level, which))
        }
    }
}
