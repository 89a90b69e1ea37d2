//! Repairs of meshes: what becomes of them, and that tags and primvars go with their parts.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use evenlight::mesh::fix::{Change, Obstacle, Repaired, Repairs, fix};
use evenlight::mesh::{Corner, Crease, Interpolation, LibraryNumbers, Primvar};
use evenlight::{Cage, FaceId, Mesh, VertexId};
use proptest::prelude::*;

const CUBE: [[u32; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

fn cube() -> Mesh {
    let square = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]];
    let positions = (0..8).map(|k| [square[k % 4][0], square[k % 4][1], (k / 4) as f64]);
    Mesh::new(positions.collect(), CUBE)
}

/// Points that do not matter, all different.
fn points(n: usize) -> Vec<[f64; 3]> {
    (0..n).map(|k| [k as f64, 0.0, 0.0]).collect()
}

const FLIP: Repairs = Repairs { merge: None, flip: true, split: false, drop_unused: false };
const SPLIT: Repairs = Repairs { flip: false, split: true, ..FLIP };
const DROP: Repairs = Repairs { flip: false, drop_unused: true, ..FLIP };

fn merge(distance: f64) -> Repairs {
    Repairs { merge: Some(distance), ..Repairs::default() }
}

fn repaired(mesh: &Mesh, repairs: Repairs) -> Repaired {
    fix(mesh, &repairs).unwrap()
}

fn shown(repaired: &Repaired) -> Vec<String> {
    repaired.changes.iter().map(|change| change.describe(&LibraryNumbers)).collect()
}

/// Whether two meshes have the same faces, each from the same first corner.
fn faces(mesh: &Mesh) -> Vec<Vec<u32>> {
    mesh.faces.iter().map(|f| f.iter().map(|v| v.0).collect()).collect()
}

#[test]
fn nothing_is_changed_where_nothing_is_wrong() {
    let mesh = cube();
    let all = Repairs { merge: Some(0.5), flip: true, split: true, drop_unused: true };
    let Repaired { mesh: after, changes, obstacles } = repaired(&mesh, all);
    assert_eq!((after, changes, obstacles), (mesh, vec![], vec![]));
}

#[test]
fn the_fewer_faces_are_flipped_whichever_they_are() {
    for mask in 0u32..64 {
        let turned: Vec<u32> = (0..6).filter(|k| mask >> k & 1 == 1).collect();
        let mut cube = CUBE;
        turned.iter().for_each(|&k| cube[k as usize][1..].reverse());
        let mesh = Mesh::new(points(8), cube);
        let after = repaired(&mesh, FLIP);
        assert!(Cage::new(after.mesh.clone()).is_ok(), "{mask:b}");
        // Of three and three, those that disagree with face 0.
        let are_fewer = turned.len() < 3 || (turned.len() == 3 && turned[0] != 0);
        let expected: Vec<FaceId> =
            (0..6).filter(|k| turned.contains(k) == are_fewer).map(FaceId).collect();
        let flipped = Change::Flipped { faces: expected.clone() };
        let changes = if expected.is_empty() { vec![] } else { vec![flipped] };
        assert_eq!(after.changes, changes, "{mask:b}");
    }
}

#[test]
fn pieces_are_oriented_each_for_itself() {
    let mesh = Mesh::new(points(8), [[0, 1, 2], [0, 3, 2], [4, 5, 6], [5, 6, 7]]);
    let after = repaired(&mesh, FLIP);
    assert_eq!(shown(&after), ["2 faces flipped: 1, 3"]);
    assert_eq!(faces(&after.mesh), [[0, 1, 2], [0, 2, 3], [4, 5, 6], [5, 7, 6]]);
}

#[test]
fn a_moebius_strip_is_said_to_be_one() {
    let strip = [[1, 3, 2, 0], [3, 5, 4, 2], [5, 7, 6, 4], [7, 9, 8, 6], [9, 0, 1, 8]];
    let mesh = Mesh::new(points(10), strip);
    let after = repaired(&mesh, FLIP);
    assert_eq!((&after.mesh, &after.changes[..]), (&mesh, &[][..]));
    let [obstacle] = after.obstacles[..] else { panic!() };
    assert_eq!(obstacle, Obstacle::OneSided { face: FaceId(0), num_faces: 5 });
    let text = obstacle.describe(&LibraryNumbers);
    assert!(text.starts_with("the piece of face 0 (5 faces) is one-sided, and no flipping"));
    // A piece beside it is repaired all the same.
    let mut both = strip.map(|face| face.to_vec()).to_vec();
    both.extend([vec![10, 11, 12], vec![10, 11, 13]]);
    let after = repaired(&Mesh::new(points(14), both), FLIP);
    assert_eq!((shown(&after), after.obstacles.len()), (vec!["1 face flipped: 6".to_owned()], 1));
}

/// Every face of a cube with vertices of its own, some of them a little off.
fn soup(off: f64) -> Mesh {
    let cube = cube();
    let corners = cube.faces.all_corners().iter().enumerate();
    let at = |(k, v): (usize, &VertexId)| {
        let [x, y, z] = cube.positions[v.index()];
        if k < 8 { [x, y, z] } else { [x + off, y, z] }
    };
    let faces = (0..6).map(|f| [4 * f, 4 * f + 1, 4 * f + 2, 4 * f + 3]);
    Mesh::new(corners.map(at).collect(), faces)
}

/// A pole of quads whose last corner is repeated, as some programs write triangles.
#[test]
fn repeated_corners_that_follow_each_other_are_joined() {
    let pole = Mesh::new(points(6), (0..5).map(|k| [1 + k, 1 + (k + 1) % 5, 0, 0]));
    assert!(Cage::new(pole.clone()).is_err());
    let after = repaired(&pole, merge(0.0));
    assert_eq!(shown(&after), ["repeated corners of 5 faces joined: 0, 1, 2, 3, 4"]);
    let triangles: Vec<Vec<u32>> = (0..5).map(|k| vec![1 + k, 1 + (k + 1) % 5, 0]).collect();
    assert_eq!(faces(&after.mesh), triangles);
    assert!(Cage::new(after.mesh).is_ok());
    // A face of two vertices goes, one that comes back to a vertex later is not changed.
    let mesh = Mesh::new(points(5), [vec![0, 0, 1, 1], vec![0, 1, 2, 0, 3, 4]]);
    let after = repaired(&mesh, merge(0.0));
    let text =
        ["repeated corners of 1 face joined: 0", "1 face deleted, without 3 corners left: 0"];
    assert_eq!(shown(&after), text);
    assert_eq!(faces(&after.mesh), [[0, 1, 2, 0, 3, 4]]);
}

#[test]
fn vertices_are_merged_within_the_distance_and_no_further() {
    let closed = |mesh: Mesh| Cage::new(mesh).is_ok_and(|cage| cage.num_boundary_edges() == 0);
    for (off, distance, is_closed) in
        [(0.0, 0.0, true), (1e-6, 1e-6, true), (1e-6, 0.9e-6, false), (0.125, 0.125, true)]
    {
        let after = repaired(&soup(off), merge(distance));
        assert_eq!(closed(after.mesh.clone()), is_closed, "{off} {distance}");
        let Change::Merged { distance: largest, .. } = after.changes[0] else { panic!() };
        assert!(largest <= distance);
        if is_closed {
            // The first face's vertices are the lowest: they stay, the others are gone.
            assert_eq!(after.mesh.positions, soup(0.0).positions[..8]);
        }
    }
    let text = shown(&repaired(&soup(0.0), merge(0.0)));
    let start = "16 vertices merged, from a distance of 0 or less: 8 into 0, 9 into 3, 10 into 5,";
    assert!(text[0].starts_with(start), "{text:?}");
}

#[test]
fn negative_zero_is_zero_and_nan_is_left_alone() {
    let mut mesh = Mesh::new(points(5), [[0, 1, 2], [2, 1, 3]]);
    mesh.positions[3] = [-0.0, -0.0, 0.0];
    mesh.positions[4] = [f64::NAN; 3];
    let after = repaired(&mesh, merge(0.0));
    let pairs = vec![[VertexId(3), VertexId(0)]];
    assert_eq!(after.changes, [Change::Merged { pairs, distance: 0.0 }]);
    assert_eq!(faces(&after.mesh), [[0, 1, 2], [2, 1, 0]]);
    assert!(after.mesh.positions[3][0].is_nan());
}

#[test]
fn faces_that_collapse_are_deleted_and_said() {
    let mut mesh = Mesh::new(points(6), [&[0, 1, 2][..], &[2, 1, 3, 4], &[4, 3, 5]]);
    mesh.positions[4] = [2.9, 0.0, 0.0];
    mesh.tags.holes = vec![FaceId(1), FaceId(2)];
    let after = repaired(&mesh, merge(0.2));
    let expected = [
        "1 vertex merged, from a distance of 0.10000000000000009 or less: 4 into 3",
        "1 face deleted, without 3 corners left: 2",
    ];
    assert_eq!(shown(&after), expected);
    assert_eq!(faces(&after.mesh), [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(after.mesh.tags.holes, [FaceId(1)]);
    assert_eq!(after.mesh.positions.len(), 5);
}

#[test]
fn two_fans_at_a_vertex_are_split() {
    let mesh = Mesh::new(points(5), [[0, 1, 2], [2, 3, 4]]);
    let after = repaired(&mesh, SPLIT);
    assert_eq!(shown(&after), ["1 vertex split: 2 into 2"]);
    assert_eq!(faces(&after.mesh), [[0, 1, 2], [5, 3, 4]]);
    assert_eq!(after.mesh.positions[5], mesh.positions[2]);
    assert!(Cage::new(after.mesh).is_ok());
}

#[test]
fn three_faces_at_an_edge_are_taken_apart() {
    let mesh = Mesh::new(points(5), [[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
    let after = repaired(&mesh, SPLIT);
    assert_eq!(shown(&after), ["2 vertices split: 0 into 3, 1 into 3"]);
    let cage = Cage::new(after.mesh).unwrap();
    assert_eq!((cage.num_components(), cage.positions().len()), (3, 9));
}

#[test]
fn two_cubes_that_share_an_edge_become_two_cubes() {
    // Vertices 1 and 5 of the first are 0 and 4 of the second.
    let other = |v: u32| match v {
        0 => 1,
        4 => 5,
        v => v + 8,
    };
    let faces = CUBE.iter().copied().chain(CUBE.map(|f| f.map(other)));
    let after = repaired(&Mesh::new(points(16), faces), Repairs { drop_unused: true, ..SPLIT });
    assert_eq!(shown(&after).len(), 2);
    let cage = Cage::new(after.mesh).unwrap();
    // Two of the four faces at the edge are joined round its ends, and so there.
    assert_eq!((cage.num_components(), cage.num_boundary_edges()), (2, 0));
    assert_eq!(cage.warnings(), []);
}

#[test]
fn tags_and_primvars_go_with_their_parts() {
    let mut mesh = Mesh::new(points(7), [[0, 1, 2], [3, 2, 4], [6, 2, 4]]);
    let crease = |a, b| Crease { edge: [VertexId(a), VertexId(b)], sharpness: 2.0 };
    mesh.tags.creases = vec![crease(2, 1), crease(4, 2)];
    mesh.tags.corners = vec![Corner { vertex: VertexId(2), sharpness: 3.0 }];
    mesh.tags.holes = vec![FaceId(2)];
    let heat = Primvar {
        name: "heat".to_owned(),
        interpolation: Interpolation::Vertex,
        width: 1,
        values: (0..7).map(f64::from).collect(),
        indices: vec![],
    };
    let st = Primvar {
        name: "st".to_owned(),
        interpolation: Interpolation::FaceVarying,
        indices: vec![0, 1, 2, 3, 4, 5, 6, 4, 3],
        ..heat.clone()
    };
    mesh.primvars = vec![heat, st];
    let all = Repairs { merge: None, flip: true, split: true, drop_unused: true };
    let after = repaired(&mesh, all);
    let expected =
        ["1 face flipped: 2", "1 vertex split: 2 into 2", "1 vertex in no face deleted: 5"];
    assert_eq!(shown(&after), expected);
    // Vertex 6 is now 5, and the copy of 2 is 6; it has its sharpness and its crease.
    let mesh = after.mesh;
    assert_eq!(faces(&mesh), [[0, 1, 2], [3, 6, 4], [5, 4, 6]]);
    assert_eq!(mesh.tags.creases, [crease(2, 1), crease(4, 6)]);
    let corners: Vec<u32> = mesh.tags.corners.iter().map(|c| c.vertex.0).collect();
    assert_eq!((corners, &mesh.tags.holes[..]), (vec![2, 6], &[FaceId(2)][..]));
    assert_eq!(mesh.primvars[0].values, [0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 2.0]);
    assert_eq!(mesh.primvars[1].indices, [0, 1, 2, 3, 4, 5, 6, 3, 4]);
    assert!(Cage::new(mesh).is_ok());
}

#[test]
fn unused_vertices_are_deleted_only_on_request() {
    let mesh = Mesh::new(points(5), [[1, 2, 4]]);
    let after = repaired(&mesh, DROP);
    assert_eq!(shown(&after), ["2 vertices in no face deleted: 0, 3"]);
    assert_eq!(faces(&after.mesh), [[0, 1, 2]]);
    assert!(repaired(&mesh, FLIP).changes.is_empty());
}

#[test]
fn corners_at_no_vertex_are_refused() {
    let error = fix(&Mesh::new(points(2), [[0, 1, 2]]), &FLIP).unwrap_err().to_string();
    assert!(error.starts_with("face 0 has a corner at vertex 2, but there are 2 vertices"));
}

/// Triangles at random: all that can be wrong with connectivity.
fn any_mesh() -> impl Strategy<Value = Mesh> {
    let face = prop::collection::vec(0..12u32, 0..6);
    prop::collection::vec(face, 0..12).prop_map(|faces| Mesh::new(points(14), faces))
}

proptest! {
    /// Whatever the mesh: no panic; repairs are final, keep the faces' places, and are the same
    /// if made again.
    #[test]
    fn repairs_are_sound(mesh in any_mesh(), distance in 0.0..3.0f64, bits in 0u8..16) {
        let repairs = Repairs {
            merge: (bits & 1 > 0).then_some(distance),
            flip: bits & 2 > 0,
            split: bits & 4 > 0,
            drop_unused: bits & 8 > 0,
        };
        let once = repaired(&mesh, repairs);
        prop_assert_eq!(&once, &repaired(&mesh, repairs));
        prop_assert!(once.changes.is_empty() == (once.mesh == mesh));
        if repairs.drop_unused {
            let again = repaired(&once.mesh, DROP);
            prop_assert!(again.changes.is_empty());
        }
        if repairs.merge.is_some() {
            let again = repaired(&once.mesh, merge(distance));
            let is_merge = |c: &Change| matches!(c, Change::Merged { .. });
            prop_assert!(repairs.split || !again.changes.iter().any(is_merge));
        }
        if !repairs.split && repairs.flip {
            prop_assert!(repaired(&once.mesh, FLIP).changes.is_empty());
        }
        prop_assert!(once.mesh.faces.len() <= mesh.faces.len());
    }
}
