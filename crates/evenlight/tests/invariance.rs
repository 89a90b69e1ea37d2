//! What must not matter: affine maps, the order of vertices, faces and corners, and everything
//! that a scheme does not see.

mod common;

use std::sync::Arc;

use common::Random;
use evenlight::point::{norm, sub};
use evenlight::surface::QuadId;
use evenlight::{Cage, Mesh, Point, SchemeKind, Surface};

const CAGES: [&str; 4] = [
    "own_blob_quadriflow_300.obj",
    "obstacle/pillow_n5.obj",
    "obstacle/frame_pyramid5.obj",
    "obstacle/ridges_n7.obj",
];

fn build(mesh: Mesh, scheme: SchemeKind) -> Surface {
    common::surface(&Arc::new(Cage::new(mesh).expect("the mesh is a cage")), scheme)
}

fn distance(a: Point, b: Point) -> f64 {
    norm(sub(a, b))
}

/// The answers of `a` and another surface at one place of both; none only where the face is left
/// out.
fn both<P>(a: &Surface, quad: QuadId, answers: (Option<P>, Option<P>)) -> Option<(P, P)> {
    let (face, _) = a.face_of(quad).expect("the quad is there");
    assert_eq!([&answers.0, &answers.1].map(Option::is_none), [a.is_omitted(face); 2]);
    answers.0.zip(answers.1)
}

/// Parameters all over the surface, some of them deep in the rings.
fn samples(surface: &Surface, count: usize) -> Vec<(QuadId, f64, f64)> {
    let mut random = Random::new(11);
    (0..count)
        .map(|k| {
            let quad = QuadId(random.below(surface.num_quads()) as u32);
            let depth = if k % 3 == 0 { 0.5_f64.powi(k as i32 % 12) } else { 1.0 };
            (quad, depth * random.unit(), depth * random.unit())
        })
        .collect()
}

#[test]
fn affine_maps_commute_with_the_surface() {
    let map = |p: Point| {
        [
            2.0 * p[0] - 0.5 * p[1] + 0.25 * p[2] + 3.0,
            0.75 * p[1] + p[2] - 1.0,
            -0.3 * p[0] + 1.5 * p[2] + 0.1 * p[1],
        ]
    };
    for name in CAGES {
        for scheme in SchemeKind::ALL {
            let mesh = common::mesh(name);
            let mut moved = mesh.clone();
            moved.positions.iter_mut().for_each(|p| *p = map(*p));
            let (a, b) = (build(mesh, scheme), build(moved, scheme));
            for (quad, u, v) in samples(&a, 500) {
                let answers = (a.eval(quad, u, v), b.eval(quad, u, v));
                let Some((p, q)) = both(&a, quad, answers) else { continue };
                assert!(distance(map(p.jet.p), q.jet.p) < 1e-13 * 40.0, "{name}");
            }
        }
    }
}

#[test]
fn planar_cages_give_planes_and_keep_them_exactly() {
    for n in [3, 5, 6, 7, 8, 9, 10] {
        let mut mesh = common::mesh(&format!("obstacle/flat_n{n}.obj"));
        // A plane in which every number below is exact in binary.
        mesh.positions.iter_mut().for_each(|p| p[2] = 0.25 * p[0] - 0.5 * p[1] + 2.0);
        let normal = [-0.25, 0.5, 1.0].map(|x| x / 1.3125_f64.sqrt());
        for scheme in SchemeKind::ALL {
            let surface = build(mesh.clone(), scheme);
            for (quad, u, v) in samples(&surface, 300) {
                let answer = surface.eval(quad, u, v);
                let Some((p, _)) = both(&surface, quad, (answer, answer)) else { continue };
                let [x, y, z] = p.jet.p;
                assert!((z - (0.25 * x - 0.5 * y + 2.0)).abs() < 1e-14, "n = {n}");
                assert!(distance(p.normal, normal) < 1e-12, "n = {n}: {:?}", p.normal);
                assert!(p.gauss.abs() < 1e-18 && p.mean.abs() < 1e-9, "n = {n}: {p:?}");
            }
        }
    }
}

#[test]
fn a_torus_without_extraordinary_vertices_has_the_same_bits_in_all_schemes() {
    let cc = build(common::torus(12, 8), SchemeKind::CatmullClark);
    assert!(cc.extraordinary_points().is_empty() && cc.omitted_faces().is_empty());
    for scheme in SchemeKind::ALL {
        let other = build(common::torus(12, 8), scheme);
        assert!(cc.patches(6).eq(other.patches(6)));
        for (quad, u, v) in samples(&cc, 500) {
            assert_eq!(cc.eval(quad, u, v), other.eval(quad, u, v));
        }
    }
}

#[test]
fn schemes_differ_only_in_the_faces_at_extraordinary_points() {
    for (name, cage) in common::all_cages() {
        let regular = |scheme: SchemeKind| {
            let surface = common::surface(&cage, scheme);
            common::assert_rules(&name, &surface);
            surface.patches(0).collect::<Vec<_>>()
        };
        let cc = regular(SchemeKind::CatmullClark);
        for scheme in SchemeKind::ALL {
            assert!(regular(scheme) == cc, "{name}, {}", scheme.name());
        }
    }
}

#[test]
fn the_order_of_vertices_and_faces_does_not_matter() {
    let mut random = Random::new(5);
    for name in CAGES {
        let mesh = common::mesh(name);
        let mut new_vertex: Vec<u32> = (0..mesh.positions.len() as u32).collect();
        let mut old_face: Vec<usize> = (0..mesh.faces.len()).collect();
        for k in (1..new_vertex.len()).rev() {
            new_vertex.swap(k, random.below(k + 1));
        }
        for k in (1..old_face.len()).rev() {
            old_face.swap(k, random.below(k + 1));
        }
        let mut positions = mesh.positions.clone();
        for (old, &new) in new_vertex.iter().enumerate() {
            positions[new as usize] = mesh.positions[old];
        }
        let faces: Vec<&[_]> = mesh.faces.iter().collect();
        let shuffled = old_face
            .iter()
            .map(|&f| faces[f].iter().map(|v| new_vertex[v.index()]).collect::<Vec<u32>>());
        let shuffled = Mesh::new(positions, shuffled);
        for scheme in SchemeKind::ALL {
            let (a, b) = (build(mesh.clone(), scheme), build(shuffled.clone(), scheme));
            for (quad, u, v) in samples(&a, 500) {
                let new = old_face.iter().position(|&f| f == quad.0 as usize).unwrap();
                let answers = (a.eval(quad, u, v), b.eval(QuadId(new as u32), u, v));
                let Some((p, q)) = both(&a, quad, answers) else { continue };
                assert!(distance(p.jet.p, q.jet.p) < 1e-13, "{name}");
                assert!(distance(p.jet.du, q.jet.du) < 1e-11, "{name}");
            }
        }
    }
}

#[test]
fn the_first_corner_of_a_face_does_not_matter() {
    for name in CAGES {
        let mesh = common::mesh(name);
        let turned = mesh.faces.iter().enumerate().map(|(f, corners)| {
            let mut corners: Vec<u32> = corners.iter().map(|v| v.0).collect();
            corners.rotate_left(f % 4);
            corners
        });
        let turned = Mesh::new(mesh.positions.clone(), turned);
        for scheme in SchemeKind::ALL {
            let (a, b) = (build(mesh.clone(), scheme), build(turned.clone(), scheme));
            for (quad, u, v) in samples(&a, 500) {
                // The new (0,0) is the old corner k.
                let [s, t] =
                    [[u, v], [v, 1.0 - u], [1.0 - u, 1.0 - v], [1.0 - v, u]][quad.0 as usize % 4];
                let answers = (a.eval(quad, u, v), b.eval(quad, s, t));
                let Some((p, q)) = both(&a, quad, answers) else { continue };
                assert!(distance(p.jet.p, q.jet.p) < 1e-13, "{name}");
                if !p.mean.is_nan() {
                    assert!(distance(p.normal, q.normal) < 1e-9, "{name}");
                }
            }
        }
    }
}

/// The same with n-gons, whose quads are numbered by corner.
#[test]
fn the_order_of_n_gons_and_their_corners_does_not_matter() {
    let mesh = common::mesh("own_polygons.obj");
    let count = mesh.faces.len();
    let faces: Vec<Vec<u32>> = mesh.faces.iter().map(|f| f.iter().map(|v| v.0).collect()).collect();
    // Faces in reverse order, each beginning one corner later.
    let turned = faces.iter().rev().map(|face| {
        let mut face = face.clone();
        face.rotate_left(1);
        face
    });
    let turned = Mesh::new(mesh.positions.clone(), turned);
    for scheme in SchemeKind::ALL {
        let (a, b) = (build(mesh.clone(), scheme), build(turned.clone(), scheme));
        for (quad, u, v) in samples(&a, 500) {
            let (face, k) = a.face_of(quad).unwrap();
            let corners = faces[face.index()].len();
            let other = evenlight::FaceId((count - 1 - face.index()) as u32);
            let (corner, s, t) =
                if corners == 4 { (0, v, 1.0 - u) } else { ((k + corners - 1) % corners, u, v) };
            let other = b.quad(other, corner).expect("the face is there");
            let (Some(p), Some(q)) = (a.eval(quad, u, v), b.eval(other, s, t)) else {
                panic!("the cage is closed");
            };
            assert!(distance(p.jet.p, q.jet.p) < 1e-13, "{}", scheme.name());
        }
    }
}
