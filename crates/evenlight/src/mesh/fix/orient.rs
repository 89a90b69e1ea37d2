//! Faces of a piece get one orientation.

use std::collections::HashMap;

use super::draft::Draft;
use super::{Change, Obstacle};
use crate::mesh::FaceId;

/// In every piece whose faces disagree, flips the smaller group of faces; if both are equal, the
/// group without the lowest face. Edges of two faces join the faces of a piece.
pub(super) fn orient(draft: &mut Draft, obstacles: &mut Vec<Obstacle>) -> Option<Change> {
    let neighbours = neighbours(draft);
    // Whether each face that was reached is to be flipped if its piece's lowest is not.
    let mut is_turned: Vec<Option<bool>> = vec![None; draft.faces.len()];
    let mut flipped = Vec::new();
    for lowest in 0..draft.faces.len() {
        if is_turned[lowest].is_some() {
            continue;
        }
        let (piece, is_orientable) = walk(lowest, &neighbours, &mut is_turned);
        let turned = || piece.iter().filter(|&&f| is_turned[f] == Some(true));
        if !is_orientable {
            let face = draft.faces[lowest].source;
            obstacles.push(Obstacle::OneSided { face, num_faces: piece.len() });
        } else {
            let flips_turned = 2 * turned().count() <= piece.len();
            flipped.extend(piece.iter().filter(|&&f| is_turned[f] == Some(flips_turned)));
        }
    }
    flipped.sort_unstable();
    let faces: Vec<FaceId> = flipped.iter().map(|&f: &usize| draft.faces[f].source).collect();
    flipped.iter().for_each(|&f| draft.faces[f].flip());
    (!faces.is_empty()).then_some(Change::Flipped { faces })
}

/// The faces joined to `lowest`, and whether they can all agree.
fn walk(
    lowest: usize,
    neighbours: &[Vec<(usize, bool)>],
    is_turned: &mut [Option<bool>],
) -> (Vec<usize>, bool) {
    is_turned[lowest] = Some(false);
    let (mut piece, mut is_orientable) = (vec![lowest], true);
    let mut next = 0;
    while let Some(&face) = piece.get(next) {
        next += 1;
        for &(other, agrees) in &neighbours[face] {
            let turned = (is_turned[face] == Some(true)) == agrees;
            match is_turned[other] {
                None => {
                    is_turned[other] = Some(turned);
                    piece.push(other);
                }
                Some(found) => is_orientable &= found == turned,
            }
        }
    }
    (piece, is_orientable)
}

/// For every face its neighbours across edges of two faces, and whether the two faces run through
/// the edge in opposite directions, as they should.
fn neighbours(draft: &Draft) -> Vec<Vec<(usize, bool)>> {
    let mut edges: HashMap<[u32; 2], Vec<(usize, bool)>> = HashMap::new();
    for (f, face) in draft.faces.iter().enumerate() {
        for [i, j] in face.edges() {
            let [a, b] = [i, j].map(|k| face.corners[k].vertex);
            if a == b {
                continue; // this edge has no direction
            }
            edges.entry([a.min(b), a.max(b)]).or_default().push((f, a < b));
        }
    }
    let mut neighbours = vec![Vec::new(); draft.faces.len()];
    for sides in edges.values() {
        if let [(f, forward), (g, other_forward)] = sides[..]
            && f != g
        {
            neighbours[f].push((g, forward != other_forward));
            neighbours[g].push((f, forward != other_forward));
        }
    }
    // Sorted, as the map has no fixed order.
    neighbours.iter_mut().for_each(|list| list.sort_unstable());
    neighbours
}
