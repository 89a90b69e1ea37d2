//! Every fan of faces gets a vertex of its own.

use std::collections::{BTreeMap, HashMap};

use super::Change;
use super::draft::Draft;
use crate::mesh::VertexId;

/// Splits every vertex whose corners are not all joined through edges of two faces; the corners
/// of the lowest face keep it.
pub(super) fn split(draft: &mut Draft) -> Option<Change> {
    let fans = fans(draft);
    // By vertex, the fans at it in the order of their lowest faces.
    let mut of_vertex: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    let corners = draft.faces.iter().flat_map(|face| &face.corners);
    let mut is_known = vec![false; fans.len()];
    for (corner, &fan) in corners.zip(&fans) {
        if !std::mem::replace(&mut is_known[fan], true) {
            of_vertex.entry(corner.vertex).or_default().push(fan);
        }
    }
    let mut vertex_of: HashMap<usize, u32> = HashMap::new();
    let mut vertices = Vec::new();
    for (vertex, fans) in of_vertex.into_iter().filter(|(_, fans)| fans.len() > 1) {
        vertices.push((VertexId(draft.sources[vertex as usize]), fans.len()));
        for fan in &fans[1..] {
            vertex_of.insert(*fan, draft.copy_vertex(vertex));
        }
    }
    let corners = draft.faces.iter_mut().flat_map(|face| &mut face.corners);
    for (corner, fan) in corners.zip(fans) {
        corner.vertex = vertex_of.get(&fan).copied().unwrap_or(corner.vertex);
    }
    (!vertices.is_empty()).then_some(Change::Split { vertices })
}

/// For every corner in order the lowest corner of its fan.
fn fans(draft: &Draft) -> Vec<usize> {
    let mut edges: HashMap<[u32; 2], Vec<[usize; 2]>> = HashMap::new();
    let mut first = 0;
    for face in &draft.faces {
        for [i, j] in face.edges() {
            let mut ends =
                [(face.corners[i].vertex, first + i), (face.corners[j].vertex, first + j)];
            ends.sort_unstable();
            edges.entry(ends.map(|(v, _)| v)).or_default().push(ends.map(|(_, corner)| corner));
        }
        first += face.corners.len();
    }
    let mut fans: Vec<usize> = (0..first).collect();
    for sides in edges.values() {
        if let [a, b] = sides[..] {
            (0..2).for_each(|end| join(&mut fans, a[end], b[end]));
        }
    }
    for corner in 0..first {
        fans[corner] = root(&mut fans, corner);
    }
    fans
}

/// The lowest corner that `corner` is joined to so far.
fn root(fans: &mut [usize], mut corner: usize) -> usize {
    while fans[corner] != corner {
        fans[corner] = fans[fans[corner]];
        corner = fans[corner];
    }
    corner
}

fn join(fans: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(fans, a), root(fans, b));
    fans[a.max(b)] = a.min(b);
}
