//! Laws of the checks: which meshes are cages does not depend on how they are numbered.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::collections::{BTreeMap, BTreeSet};
use std::mem::discriminant;

use evenlight::mesh::{CheckError, MeshError};
use evenlight::{Cage, Mesh};
use proptest::prelude::*;

/// Faces as lists of vertex numbers.
type FaceList = Vec<Vec<u32>>;

fn cage(num_vertices: u32, faces: &FaceList) -> Result<Cage, CheckError> {
    Cage::new(Mesh::new(vec![[0.0; 3]; num_vertices as usize], faces))
}

/// A torus of `m` x `n` quads, some of them cut into two triangles.
fn torus(m: u32, n: u32, cut: impl Fn(u32) -> bool) -> FaceList {
    let vertex = |i: u32, j: u32| i % m * n + j % n;
    let mut faces = Vec::new();
    for (i, j) in (0..m).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
        if cut(i * n + j) {
            faces.extend([vec![a, b, c], vec![a, c, d]]);
        } else {
            faces.push(vec![a, b, c, d]);
        }
    }
    faces
}

/// A torus with some faces cut, removed, flipped or given twice: often a cage, often not.
fn damaged_torus() -> impl Strategy<Value = (u32, FaceList)> {
    let damage = prop::collection::vec((0u8..4, any::<prop::sample::Index>()), 0..5);
    (3u32..6, 3u32..6, any::<u64>(), damage).prop_map(|(m, n, cuts, damage)| {
        let mut faces = torus(m, n, |k| cuts >> (k % 64) & 1 == 1);
        for (kind, place) in damage {
            let place = place.index(faces.len());
            match kind {
                0 | 1 => drop(faces.remove(place)),
                2 => faces[place].reverse(),
                _ => faces.push(faces[place].clone()),
            }
        }
        (m * n, faces)
    })
}

/// A few faces between a few vertices: hardly ever a surface, and if so an odd one.
fn soup() -> impl Strategy<Value = (u32, FaceList)> {
    let corners = prop::sample::subsequence((0u32..6).collect::<Vec<_>>(), 3..=4).prop_shuffle();
    prop::collection::vec(corners, 1..7).prop_map(|faces| (6, faces))
}

fn any_faces() -> impl Strategy<Value = (u32, FaceList)> {
    prop_oneof![damaged_torus(), soup()]
}

/// What must not change when the mesh is only numbered otherwise.
#[derive(Debug, PartialEq)]
enum Verdict {
    Accepted {
        vertices_edges_faces: [usize; 3],
        boundary_edges: usize,
        components: usize,
        valences: BTreeMap<usize, usize>,
        face_sizes: BTreeMap<usize, usize>,
    },
    /// How many faults there are of each kind and number of faces.
    Refused(BTreeMap<(&'static str, usize), usize>),
}

fn verdict(num_vertices: u32, faces: &FaceList) -> Verdict {
    match cage(num_vertices, faces) {
        Ok(cage) => Verdict::Accepted {
            vertices_edges_faces: [cage.num_used_vertices(), cage.num_edges(), cage.num_faces()],
            boundary_edges: cage.num_boundary_edges(),
            components: cage.num_components(),
            valences: cage.interior_valences(),
            face_sizes: cage.face_sizes(),
        },
        Err(error) => Verdict::Refused(kinds(&error)),
    }
}

fn kinds(error: &CheckError) -> BTreeMap<(&'static str, usize), usize> {
    let mut counts = BTreeMap::new();
    for fault in &error.errors {
        let kind = match fault {
            MeshError::DuplicateFace { .. } => ("duplicate", 2),
            MeshError::InconsistentOrientation { .. } => ("orientation", 2),
            MeshError::EdgeWithManyFaces { faces, .. } => ("crowded", faces.len()),
            MeshError::VertexNotAFan { .. } => ("fan", 0),
            other => panic!("{other}"),
        };
        *counts.entry(kind).or_insert(0) += 1;
    }
    counts
}

/// Whether the faces are an orientable surface, straight from the definition: no edge is run
/// through twice in one direction, and around each vertex all faces hang together by edges.
fn is_surface(faces: &FaceList) -> bool {
    let edges =
        |f: &Vec<u32>| (0..f.len()).map(|i| (f[i], f[(i + 1) % f.len()])).collect::<Vec<_>>();
    let directed: Vec<(u32, u32)> = faces.iter().flat_map(edges).collect();
    let distinct: BTreeSet<_> = directed.iter().collect();
    let vertices: BTreeSet<u32> = faces.iter().flatten().copied().collect();
    distinct.len() == directed.len() && vertices.iter().all(|&v| hang_together(v, faces))
}

fn hang_together(v: u32, faces: &FaceList) -> bool {
    // The two neighbours of `v` in each face.
    let mut around: Vec<BTreeSet<u32>> = faces.iter().filter_map(|f| neighbours(v, f)).collect();
    let mut reached = around.pop().unwrap();
    while let Some(next) = around.iter().position(|n| !n.is_disjoint(&reached)) {
        reached.extend(around.swap_remove(next));
    }
    around.is_empty()
}

fn neighbours(v: u32, face: &[u32]) -> Option<BTreeSet<u32>> {
    let i = face.iter().position(|&w| w == v)?;
    let n = face.len();
    Some(BTreeSet::from([face[(i + 1) % n], face[(i + n - 1) % n]]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn accepted_is_what_the_definition_says((num_vertices, faces) in any_faces()) {
        let found = cage(num_vertices, &faces);
        prop_assert_eq!(found.is_ok(), is_surface(&faces), "{:?}", found.err());
    }

    #[test]
    fn the_mirror_image_has_the_same_verdict((num_vertices, faces) in any_faces()) {
        let mirrored = faces.iter().map(|f| f.iter().rev().copied().collect()).collect();
        prop_assert_eq!(verdict(num_vertices, &mirrored), verdict(num_vertices, &faces));
    }

    #[test]
    fn numbering_does_not_matter(
        ((num_vertices, faces), new_numbers, new_order) in any_faces().prop_flat_map(|mesh| {
            let vertices: Vec<u32> = (0..mesh.0).collect();
            let order: Vec<usize> = (0..mesh.1.len()).collect();
            (Just(mesh), Just(vertices).prop_shuffle(), Just(order).prop_shuffle())
        }),
        turn in 0usize..4,
    ) {
        let renumbered = new_order.iter().map(|&f| {
            let mut face: Vec<u32> = faces[f].iter().map(|&v| new_numbers[v as usize]).collect();
            let corners = face.len();
            face.rotate_left((turn + f) % corners);
            face
        });
        let renumbered: FaceList = renumbered.collect();
        prop_assert_eq!(verdict(num_vertices, &renumbered), verdict(num_vertices, &faces));
    }

    /// V - E + F = 0 on a torus; V, E, F and all else add up for disjoint pieces.
    #[test]
    fn counts_of_tori(m in 3u32..8, n in 3u32..8, cuts: u64, pieces in 1u32..4) {
        let piece = torus(m, n, |k| cuts >> (k % 64) & 1 == 1);
        let shift = |by: u32| piece.iter().map(move |f| f.iter().map(|v| v + by * m * n).collect());
        let all: FaceList = (0..pieces).flat_map(shift).collect();
        let cage = cage(m * n * pieces, &all).unwrap();
        prop_assert_eq!(cage.num_used_vertices() + cage.num_faces(), cage.num_edges());
        prop_assert_eq!(cage.num_components(), pieces as usize);
        prop_assert_eq!(cage.num_boundary_edges(), 0);
        // Every corner of a face is one sector of a vertex.
        let sum = |h: BTreeMap<usize, usize>| h.iter().map(|(n, k)| n * k).sum::<usize>();
        prop_assert_eq!(sum(cage.interior_valences()), sum(cage.face_sizes()));
    }

    /// Of a closed surface, one face can be missing; it leaves its edges as the boundary.
    #[test]
    fn a_hole_has_the_edges_of_its_face(m in 3u32..6, n in 3u32..6, cuts: u64, hole: prop::sample::Index) {
        let mut faces = torus(m, n, |k| cuts >> (k % 64) & 1 == 1);
        let removed = faces.remove(hole.index(faces.len()));
        prop_assert_eq!(cage(m * n, &faces).unwrap().num_boundary_edges(), removed.len());
    }
}

#[test]
fn the_generators_reach_every_verdict() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;

    let mut runner = TestRunner::deterministic();
    let (mut accepted, mut kinds) = (0, Vec::new());
    for _ in 0..1000 {
        let (num_vertices, faces) = any_faces().new_tree(&mut runner).unwrap().current();
        match cage(num_vertices, &faces) {
            Ok(_) => accepted += 1,
            Err(error) => kinds.extend(error.errors.iter().map(discriminant)),
        }
    }
    assert!((100..900).contains(&accepted), "{accepted}");
    assert_eq!(kinds.into_iter().collect::<std::collections::HashSet<_>>().len(), 4);
}
