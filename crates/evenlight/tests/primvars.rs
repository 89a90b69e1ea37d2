//! Primvars: what is carried beside positions goes where positions go.
#![allow(clippy::unwrap_used, reason = "a test that cannot make its cages fails")]

mod common;

use std::path::Path;
use std::sync::Arc;

use common::{Random, options};
use evenlight::cap::CapOptions;
use evenlight::io::{obj, obj_out};
use evenlight::mesh::{FaceVaryingRule, Interpolation, Primvar};
use evenlight::tessellate::tessellate;
use evenlight::{Cage, Mesh, QuadId, SchemeKind, Surface};

fn primvar(interpolation: Interpolation, width: usize, values: Vec<f64>, mesh: &Mesh) -> Primvar {
    let corners = mesh.faces.all_corners().iter().map(|v| v.0);
    let indices =
        if interpolation == Interpolation::FaceVarying { corners.collect() } else { vec![] };
    Primvar { name: format!("{interpolation:?}{width}"), interpolation, width, values, indices }
}

/// The first `width` of x, y, z and x + y of every vertex.
fn coordinates(mesh: &Mesh, width: usize) -> Vec<f64> {
    mesh.positions.iter().flat_map(|&[x, y, z]| [x, y, z, x + y].into_iter().take(width)).collect()
}

/// A closed body with extraordinary vertices, and one with triangles, a pentagon and hexagons.
fn closed_meshes() -> Vec<Mesh> {
    ["own_blob_quadriflow_300.obj", "own_polygons.obj"].map(common::mesh).into()
}

fn places(surface: &Surface) -> Vec<(QuadId, f64, f64)> {
    let mut random = Random::new(7);
    let mut places = Vec::new();
    for quad in 0..surface.num_quads() as u32 {
        places.extend((0..3).map(|_| (QuadId(quad), random.unit(), random.unit())));
        places.extend([
            (QuadId(quad), 0.0, 0.3),
            (QuadId(quad), 1e-4, 2e-4),
            (QuadId(quad), 0.0, 0.0),
        ]);
    }
    places
}

/// Whether numbers agree; NaN, where nothing exists, agrees with NaN.
fn agree(a: &[f64], b: &[f64], tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance || a.is_nan() && b.is_nan())
}

/// Positions as a primvar are the positions, with derivatives, for primvars of one value per vertex
/// and of one per corner, of any width, with every scheme.
#[test]
fn positions_as_a_primvar_are_the_surface() {
    for mesh in closed_meshes() {
        let mut mesh = mesh;
        for width in 1..=4 {
            for interpolation in [Interpolation::Vertex, Interpolation::FaceVarying] {
                let values = coordinates(&mesh, width);
                mesh.primvars.push(primvar(interpolation, width, values, &mesh));
            }
        }
        let cage = Arc::new(Cage::new(mesh).unwrap());
        for scheme in SchemeKind::ALL {
            let surface = Surface::build(cage.clone(), options(scheme)).unwrap();
            for (quad, u, v) in places(&surface) {
                let jet = surface.eval(quad, u, v).unwrap().jet;
                for (k, primvar) in surface.primvars().iter().enumerate() {
                    let found = surface.eval_primvar::<4>(k, quad, u, v).unwrap();
                    let rows = [found.p, found.du, found.dv, found.duu, found.duv, found.dvv];
                    for (order, (own, [x, y, z])) in rows.iter().zip(jet.rows()).enumerate() {
                        let expected = [x, y, z, x + y];
                        // Second derivatives grow towards extraordinary points.
                        let tolerance = if order < 3 { 1e-11 } else { 1e-7 };
                        assert!(
                            agree(&expected[..primvar.width], own, tolerance),
                            "{scheme:?}, {}, {quad:?}, ({u}, {v}), {order}: {own:?}, not {expected:?}",
                            primvar.name
                        );
                    }
                }
            }
        }
    }
}

/// Primvars are closed by caps where the surface is.
#[test]
fn primvars_have_the_caps_of_the_surface() {
    let mut mesh = common::mesh("own_blob_quadriflow_300.obj");
    let values = coordinates(&mesh, 3);
    mesh.primvars.push(primvar(Interpolation::Vertex, 3, values, &mesh));
    let mut surface = Surface::build(Cage::new(mesh).unwrap(), options(SchemeKind::Qas4)).unwrap();
    let point = surface.extraordinary_points()[0].sectors[0];
    let [u, v] = [0, 1].map(|k| point.center[k] + 0.01 * (point.along[0][k] + point.along[1][k]));
    let value = |surface: &Surface| {
        let value = surface.eval_primvar::<4>(0, point.quad, u, v).unwrap().p;
        let position = surface.eval(point.quad, u, v).unwrap().jet.p;
        assert!(agree(&value[..3], &position, 1e-11), "{value:?}, not {position:?}");
        value
    };
    let rings = value(&surface);
    surface.set_caps(Some(CapOptions { rings: 2, ..CapOptions::default() })).unwrap();
    assert!(rings != value(&surface), "the cap is another surface than the rings");
}

/// A cage with a texture, its corners' values by a function of their number.
fn feature(name: &str, rule: FaceVaryingRule) -> Mesh {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/meshes/features").join(name);
    let mut mesh = obj::read(&std::fs::read(path).unwrap()).unwrap().mesh;
    mesh.tags.face_varying = rule;
    mesh
}

const TEXTURED: [&str; 6] = [
    "uv_concave.obj",
    "uv_creased_seam.obj",
    "uv_dart.obj",
    "uv_polygons.obj",
    "uv_three_islands.obj",
    "uv_unfolded_cube.obj",
];

/// Weights sum to 1 on both sides of every seam: one value everywhere stays so.
#[test]
fn a_constant_primvar_is_constant() {
    for (name, rule) in
        TEXTURED.into_iter().flat_map(|name| FaceVaryingRule::ALL.map(|rule| (name, rule)))
    {
        let mut mesh = feature(name, rule);
        mesh.primvars[0].values.fill(3.0);
        let surface = Surface::build(Cage::new(mesh).unwrap(), options(SchemeKind::Qas4)).unwrap();
        for (quad, u, v) in places(&surface).into_iter().filter(|&(_, u, v)| u + v > 0.0) {
            let jet = surface.eval_primvar::<4>(0, quad, u, v).unwrap();
            assert!(agree(&jet.p[..2], &[3.0; 2], 1e-13), "{name}, {rule:?}: {jet:?}");
            let derivatives = [jet.du, jet.dv].concat();
            assert!(agree(&derivatives, &[0.0; 8], 1e-12), "{name}, {rule:?}: {jet:?}");
        }
    }
}

/// The value that an interpolation gives at the corners of faces: with linear boundaries that of
/// the file at every corner on a seam; with linear everything at every corner.
#[test]
fn linear_primvars_pass_through_their_values() {
    for name in TEXTURED {
        let mut mesh = feature(name, FaceVaryingRule::All);
        let values = coordinates(&mesh, 3);
        mesh.primvars.push(primvar(Interpolation::Varying, 3, values, &mesh));
        let surface = Surface::build(Cage::new(mesh).unwrap(), options(SchemeKind::Qas4)).unwrap();
        let faces = surface.topology().faces();
        for face in faces.ids() {
            for (k, v) in faces.corners(face).iter().enumerate() {
                let is_quad = faces.corners(face).len() == 4;
                let quad = surface.quad(face, if is_quad { 0 } else { k }).unwrap();
                let [a, b] = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]][if is_quad { k } else { 0 }];
                let st = &surface.primvars()[0];
                let corner: usize =
                    faces.ids().take(face.index()).map(|f| faces.corners(f).len()).sum();
                let value = &st.values[2 * st.indices[corner + k] as usize..][..2];
                assert_eq!(surface.eval_primvar::<4>(0, quad, a, b).unwrap().p[..2], *value);
                let position = surface.positions()[v.index()];
                assert_eq!(surface.eval_primvar::<4>(1, quad, a, b).unwrap().p[..3], position);
            }
        }
    }
}

#[test]
fn what_is_not_there_has_no_value() {
    let mesh = feature("uv_dart.obj", FaceVaryingRule::None);
    let surface = Surface::build(Cage::new(mesh).unwrap(), options(SchemeKind::Qas4)).unwrap();
    let quad = QuadId(0);
    assert!(surface.eval_primvar::<4>(0, quad, 0.5, 0.5).is_some());
    assert_eq!(surface.eval_primvar::<4>(1, quad, 0.5, 0.5), None);
    assert_eq!(surface.eval_primvar::<4>(0, QuadId(4), 0.5, 0.5), None);
    assert_eq!(surface.eval_primvar::<4>(0, quad, f64::NAN, 0.5), None);
}

/// Triangles share values where the primvar is continuous: the unfolded cube has seams along 7 of
/// its 12 edges, where vertices have the values of both sides.
#[test]
fn triangles_have_one_value_per_side_of_a_seam() {
    let (rate, rule) = (4, FaceVaryingRule::CornersOnly);
    let mut mesh = feature("uv_unfolded_cube.obj", rule);
    let positions = coordinates(&mesh, 3);
    mesh.primvars.push(primvar(Interpolation::FaceVarying, 3, positions, &mesh));
    let surface = Surface::build(Cage::new(mesh).unwrap(), options(SchemeKind::Qas4)).unwrap();
    let triangles = tessellate(&surface, rate).unwrap();
    let without_seams = triangles.corner_values(&surface, 1).unwrap();
    assert_eq!(without_seams.values.len(), triangles.positions.len());
    for (corners, vertices) in without_seams.corners.iter().zip(&triangles.triangles) {
        for (&value, &vertex) in corners.iter().zip(vertices) {
            let position = triangles.positions[vertex as usize];
            assert!(agree(&without_seams.values[value as usize][..3], &position, 1e-11));
        }
    }
    let texture = triangles.corner_values(&surface, 0).unwrap();
    // 14 values at the 8 vertices of the cage, and rate - 1 more along each seam.
    let more = (14 - 8) + 7 * (rate - 1);
    assert_eq!(texture.values.len(), triangles.positions.len() + more);
    let mut text = Vec::new();
    obj_out::write_textured(&triangles, &triangles.corner_primvars(&surface), &mut text).unwrap();
    let read = obj::read(&text).unwrap().mesh;
    assert_eq!(read.primvars[0].indices, texture.corners.concat());
    let flat: Vec<f64> = texture.values.iter().flat_map(|value| value[..2].to_vec()).collect();
    assert_eq!(read.primvars[0].values, flat);
}
