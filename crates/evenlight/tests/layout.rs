//! Topology apart from values: new poses are what a fresh build is, and nothing old remains.
#![allow(clippy::mutable_key_type, reason = "what a layout has of a cache is not hashed")]
#![allow(clippy::unwrap_used, reason = "a test that cannot make its cages fails")]

mod common;

use std::collections::HashSet;
use std::sync::Arc;

use common::{Random, cage, options};
use evenlight::cap::{CapKind, CapOptions};
use evenlight::mesh::{Crease, Interpolation, Primvar, ValuesError};
use evenlight::point::add;
use evenlight::surface::{CreaseRings, Layout, RuleCache};
use evenlight::{Cage, Mesh, Point, QuadId, SchemeKind, Surface, SurfaceOptions, VertexId};

/// Smooth, with n-gons, with creases, with texture coordinates on a cage with n-gons.
const CAGES: [&str; 4] = [
    "obstacle/saddle_n7.obj",
    "own_polygons.obj",
    "features/star5_crease.obj",
    "features/uv_polygons.obj",
];

/// The positions of a cage, moved a little.
fn moved(cage: &Cage, seed: u64) -> Vec<Point> {
    let mut random = Random::new(seed);
    let mut by = || [0; 3].map(|_| 0.2 * random.unit());
    cage.positions().iter().map(|&p| add(p, by())).collect()
}

/// All bits of what a surface says, at extraordinary points and near them too.
fn bits(surface: &Surface) -> Vec<u64> {
    let mut random = Random::new(3);
    let mut bits = Vec::new();
    for quad in (0..surface.num_quads() as u32).map(QuadId) {
        let near = [0.0, 1.0].map(|u| [u, u]);
        let places = near.into_iter().chain([[1e-5, 3e-6], [random.unit(), random.unit()]]);
        for [u, v] in places {
            let Some(found) = surface.eval(quad, u, v) else { continue };
            let rows = found.jet.rows().into_iter().chain([found.normal]);
            bits.extend(rows.flatten().chain([found.gauss, found.mean]).map(f64::to_bits));
            for primvar in 0..surface.primvars().len() {
                let jet = surface.eval_primvar::<4>(primvar, quad, u, v).unwrap();
                bits.extend(jet.rows().into_iter().flatten().map(f64::to_bits));
            }
        }
    }
    bits
}

#[test]
fn a_pose_is_what_a_fresh_build_is() {
    for name in CAGES {
        let cage = cage(name);
        for scheme in SchemeKind::ALL {
            for rings in [None, Some(2)] {
                let caps = rings.map(|rings| CapOptions { rings, kind: CapKind::Auto });
                let mut surface = Surface::build(cage.clone(), options(scheme)).unwrap();
                surface.set_caps(caps).unwrap();
                // What is computed before must not be seen after.
                let before = bits(&surface);
                let positions = moved(&cage, 5);
                let pose = surface.with_positions(positions.clone()).unwrap();
                assert_eq!(bits(&surface), before, "{name} {scheme:?}: the first is as it was");
                let fresh = cage.with_positions(positions.clone()).unwrap();
                let mut fresh = Surface::build(fresh, options(scheme)).unwrap();
                fresh.set_caps(caps).unwrap();
                let expected = bits(&fresh);
                assert!(bits(&pose) == expected, "{name} {scheme:?} {caps:?}");
                surface.set_positions(positions).unwrap();
                assert!(bits(&surface) == expected, "{name} {scheme:?} {caps:?}, in place");
                assert!(Arc::ptr_eq(surface.layout(), pose.layout()));
            }
        }
    }
}

#[test]
fn quadratics_and_caps_of_old_values_are_forgotten() {
    let cage = cage("obstacle/saddle_n7.obj");
    let mut surface = Surface::build(cage.clone(), SurfaceOptions::default()).unwrap();
    surface.set_caps(Some(CapOptions { rings: 1, kind: CapKind::Bi5 })).unwrap();
    let before = bits(&surface);
    let q = *surface.rings(0).unwrap().quadratic().unwrap();
    let lifted = q.transformed([[1., 0., 0.], [0., 1., 0.], [0., 0., 1.]], [0.0, 0.0, 0.1]);
    assert!(surface.set_quadratic(0, &lifted));
    assert_ne!(bits(&surface), before, "the cap follows the quadratic");
    surface.set_positions(cage.positions().to_vec()).unwrap();
    assert_eq!(bits(&surface), before, "new values have the default quadratic");
    surface.set_caps(None).unwrap();
    assert_ne!(bits(&surface), before);
    assert!(!surface.set_quadratic(usize::MAX, &q), "there is no such point");
}

#[test]
fn primvars_share_the_layout_and_outlive_a_pose() {
    let mut mesh = common::mesh("features/uv_polygons.obj");
    let values = mesh.positions.iter().flat_map(|p| [p[0], p[1], p[2], 1.0]).collect();
    mesh.primvars.push(Primvar {
        name: "color".to_owned(),
        interpolation: Interpolation::Vertex,
        width: 4,
        values,
        indices: Vec::new(),
    });
    let surface = Surface::build(Cage::new(mesh).unwrap(), SurfaceOptions::default()).unwrap();
    let color = surface.primvar_surface::<4>(1).unwrap();
    assert!(Arc::ptr_eq(color.layout(), surface.layout()));
    assert!(surface.primvar_surface::<3>(1).is_none(), "it has four numbers");
    let st = surface.primvar_surface::<2>(0).unwrap();
    assert!(!Arc::ptr_eq(st.layout(), surface.layout()), "seams are boundaries");
    let pose = surface.with_positions(surface.positions().to_vec()).unwrap();
    assert!(std::ptr::eq(pose.primvar_surface::<2>(0).unwrap(), st), "it is built once");
}

#[test]
fn values_that_do_not_fit_are_refused() {
    let cage = cage("obstacle/saddle_n7.obj");
    let mut surface = Surface::build(cage.clone(), SurfaceOptions::default()).unwrap();
    let before = bits(&surface);
    let count = cage.positions().len();
    let too_few = cage.positions()[1..].to_vec();
    let expected = ValuesError::Count { expected: count, found: count - 1 };
    assert_eq!(surface.set_positions(too_few.clone()), Err(expected));
    assert_eq!(cage.with_positions(too_few).unwrap_err(), expected);
    let mut broken = cage.positions().to_vec();
    broken[7][1] = f64::INFINITY;
    let error = surface.set_positions(broken).unwrap_err();
    assert_eq!(error, ValuesError::NotFinite { vertex: VertexId(7) });
    assert!(error.to_string().contains("vertex 7"), "{error}");
    assert_eq!(bits(&surface), before, "the surface stays as it was");
    let values = vec![[0.0]; count + 1];
    assert!(Surface::over(surface.layout(), values).is_err());
    assert!(Surface::of_cage(surface.layout(), &common::cage("own_polygons.obj")).is_err());
}

#[test]
fn layouts_are_equal_if_all_that_they_depend_on_is() {
    let mesh = common::mesh("obstacle/saddle_n7.obj");
    let layout = |mesh: &Mesh, options: SurfaceOptions| {
        Layout::new(&Cage::new(mesh.clone()).unwrap(), options).unwrap()
    };
    let first = layout(&mesh, SurfaceOptions::default());
    let mut same = mesh.clone();
    same.positions.iter_mut().for_each(|p| p[0] += 1.0);
    let mut creased = mesh.clone();
    let corners = mesh.faces.corners(evenlight::FaceId(0));
    creased.tags.creases.push(Crease { edge: [corners[0], corners[1]], sharpness: 2.0 });
    let mut isolated = mesh.clone();
    isolated.positions.push([0.0; 3]);
    let others = [
        layout(&mesh, options(SchemeKind::CatmullClark)),
        layout(&mesh, SurfaceOptions { creases: CreaseRings::Fair, ..SurfaceOptions::default() }),
        layout(&creased, SurfaceOptions::default()),
        layout(&isolated, SurfaceOptions::default()),
        layout(&common::mesh("obstacle/saddle_n8.obj"), SurfaceOptions::default()),
    ];
    let same = layout(&same, SurfaceOptions::default());
    assert_eq!(same, first);
    assert_eq!(same.fingerprint(), first.fingerprint());
    for other in &others {
        assert!(*other != first && other.fingerprint() != first.fingerprint());
    }
    let all: HashSet<Layout> = others.into_iter().chain([first, same]).collect();
    assert_eq!(all.len(), 6);
}

#[test]
fn a_cache_is_shared_by_those_who_hold_it() {
    let cache = RuleCache::default();
    let cages = ["obstacle/pillow_n5.obj", "obstacle/saddle_n7.obj"].map(cage);
    for cage in &cages {
        Layout::with_cache(cage, SurfaceOptions::default(), &cache).unwrap();
    }
    assert_eq!(cache.len(), 3, "valences 3 and 5, then 7");
    // The rules do not depend on it.
    let tiny = RuleCache::with_capacity(0);
    let layout = Layout::with_cache(&cages[0], SurfaceOptions::default(), &tiny).unwrap();
    let surface = Surface::of_cage(&Arc::new(layout), &cages[0]).unwrap();
    let usual = Surface::build(cages[0].clone(), SurfaceOptions::default()).unwrap();
    assert_eq!(bits(&surface), bits(&usual));
}

#[test]
fn everything_may_be_shared_between_threads() {
    fn shareable<T: Send + Sync>() {}
    shareable::<Arc<Layout>>();
    shareable::<Surface>();
    shareable::<Surface<1>>();
    shareable::<RuleCache>();
}
