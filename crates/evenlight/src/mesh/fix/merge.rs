//! Vertices that are close to each other become one.

use std::collections::HashMap;

use super::Change;
use super::draft::Draft;
use crate::mesh::{FaceId, VertexId};
use crate::point::{Point, norm, sub};

/// Merges every vertex into the lowest-numbered vertex that stays and is not further away than
/// `distance`. Then corners that follow each other in a face at one vertex become one.
///
/// No vertex moves further than `distance`, and the vertices that stay are further apart. A grid of
/// cells of this width finds the neighbours.
pub(super) fn merge(draft: &mut Draft, distance: f64) -> Vec<Change> {
    let mut kept: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut pairs = Vec::new();
    let mut largest = 0.0f64;
    for (v, &position) in draft.mesh.positions.iter().enumerate() {
        if !position.iter().all(|x| x.is_finite()) {
            continue; // for the check to name
        }
        let v = v as u32;
        let cell = cell(position, distance);
        let apart = |w: u32| norm(sub(position, draft.mesh.positions[w as usize]));
        let near = neighbours(cell, distance).filter_map(|cell| kept.get(&cell)).flatten();
        match near.copied().filter(|&w| apart(w) <= distance).min() {
            Some(into) => {
                draft.merged[v as usize] = into;
                pairs.push([VertexId(v), VertexId(into)]);
                largest = largest.max(apart(into));
            }
            None => kept.entry(cell).or_default().push(v),
        }
    }
    let joined: Vec<FaceId> = draft.faces_with_repeats();
    if pairs.is_empty() && joined.is_empty() {
        return Vec::new();
    }
    let faces = draft.apply_merged();
    let merged = (!pairs.is_empty()).then_some(Change::Merged { pairs, distance: largest });
    let joined = (!joined.is_empty()).then_some(Change::Joined { faces: joined });
    let collapsed = (!faces.is_empty()).then_some(Change::Collapsed { faces });
    [merged, joined, collapsed].into_iter().flatten().collect()
}

/// The cell of the grid; for distance 0 the bits, of -0 as of 0.
fn cell(position: Point, distance: f64) -> [i64; 3] {
    if distance > 0.0 {
        position.map(|x| (x / distance).floor() as i64)
    } else {
        position.map(|x| (x + 0.0).to_bits() as i64)
    }
}

/// The cells in which close points can be.
fn neighbours(cell: [i64; 3], distance: f64) -> impl Iterator<Item = [i64; 3]> {
    let reach = if distance > 0.0 { 1 } else { 0 };
    let range = move || -reach..=reach;
    let steps =
        range().flat_map(move |a| range().flat_map(move |b| range().map(move |c| [a, b, c])));
    steps.map(move |step| [0, 1, 2].map(|k| cell[k].saturating_add(step[k])))
}
