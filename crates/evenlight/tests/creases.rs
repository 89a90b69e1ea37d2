//! Boundaries, creases, corners: the surface is the limit of refinement by the published rules.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its cage fails")]

mod common;

use common::Random;
use common::fans::{fan_sheet, sheet, starred};
use common::refine::refine;
use evenlight::mesh::{BoundaryRule, Corner, Crease, CreaseMethod, Tags, VertexRule};
use evenlight::point::{norm, sub};
use evenlight::surface::{PatchPlace, PointRule, Reason};
use evenlight::{Cage, FaceId, Mesh, QuadId, SchemeKind, Surface, SurfacePoint, VertexId};

fn surface_of(mesh: &Mesh, scheme: SchemeKind) -> Surface {
    Surface::build(Cage::new(mesh.clone()).unwrap(), common::options(scheme)).unwrap()
}

/// The child of a quad in which (u,v) lies, and where in it.
fn child(u: f64, v: f64) -> (u32, f64, f64) {
    let (x, y) = (2.0 * u, 2.0 * v);
    match (x > 1.0, y > 1.0) {
        (false, false) => (0, x, y),
        (true, false) => (1, x - 1.0, y),
        (true, true) => (2, x - 1.0, y - 1.0),
        (false, true) => (3, x, y - 1.0),
    }
}

/// The surface of a mesh of quads is that of the mesh refined, at random points and corners.
fn is_surface_of_refined(mesh: &Mesh, levels: usize, random: &mut Random, name: &str) {
    let coarse = surface_of(mesh, SchemeKind::CatmullClark);
    let mut fine_mesh = mesh.clone();
    for _ in 0..levels {
        fine_mesh = refine(&fine_mesh);
    }
    let fine = surface_of(&fine_mesh, SchemeKind::CatmullClark);
    for face in mesh.faces.ids() {
        for _ in 0..8 {
            // Half of the points near a corner or a border.
            let near = |x: f64| if x < 0.5 { 0.06 * x } else { x };
            let [mut u, mut v] = [random.unit(), random.unit()].map(near);
            let (quad, at) = (coarse.quad(face, 0).unwrap(), [u, v]);
            let mut f = face.0;
            for _ in 0..levels {
                let (k, x, y) = child(u, v);
                (f, u, v) = (4 * f + k, x, y);
            }
            let a = coarse.eval(quad, at[0], at[1]);
            let b = fine.eval(fine.quad(FaceId(f), 0).unwrap(), u, v);
            let (Some(a), Some(b)) = (a, b) else {
                assert!(a.is_none() && b.is_none(), "{name}");
                continue;
            };
            let gap = norm(sub(a.jet.p, b.jet.p));
            assert!(gap < 1e-12, "{name}: face {} at {at:?}: {gap:e}", face.0);
            let scale = f64::from(1 << levels);
            let first = norm(sub(a.jet.du, b.jet.du.map(|x| x * scale)));
            let size = 1.0 + norm(a.jet.du);
            assert!(a.jet.du[0].is_nan() || first < 1e-10 * size, "{name}: du {first:e}");
        }
    }
}

#[test]
fn boundaries_of_a_sheet_by_every_rule() {
    let mut random = Random::new(1);
    for boundary in [BoundaryRule::None, BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner] {
        for (m, n) in [(1, 1), (1, 3), (2, 2), (3, 4)] {
            let mut mesh = sheet(m, n, &mut random);
            mesh.tags.boundary = boundary;
            if boundary == BoundaryRule::None {
                continue;
            }
            is_surface_of_refined(&mesh, 3, &mut random, &format!("{boundary:?} {m} x {n}"));
        }
    }
}

fn random_tags(mesh: &Mesh, random: &mut Random) -> Tags {
    let values = [0.25, 0.5, 1.0, 1.75, 2.5, 3.0, 10.0, 10.0, f64::INFINITY];
    let mut tags = Tags::default();
    if random.below(2) == 0 {
        tags.crease_method = CreaseMethod::Chaikin;
    }
    if random.below(3) == 0 {
        tags.boundary = BoundaryRule::EdgeOnly;
    }
    let only_hard = random.below(3) == 0;
    let mut value = || if only_hard { 10.0 } else { values[random.below(values.len())] };
    let mut random2 = Random::new((value() * 64.0) as u64 + mesh.positions.len() as u64);
    for face in mesh.faces.iter() {
        for k in 0..face.len() {
            if random2.below(5) == 0 {
                let edge = [face[k], face[(k + 1) % face.len()]];
                tags.creases.push(Crease { edge, sharpness: value() });
            }
            if random2.below(16) == 0 {
                tags.corners.push(Corner { vertex: face[k], sharpness: value() });
            }
        }
    }
    tags
}

#[test]
fn the_rings_of_a_fan_sheet_are_numbered_as_meant() {
    for n in 3..7 {
        let mesh = fan_sheet(n, &mut Random::new(3));
        let cage = Cage::new(mesh).unwrap();
        assert_eq!(cage.num_components(), 1);
        assert_eq!(cage.num_boundary_edges(), 6 * n as usize);
    }
}

#[test]
fn every_rule_at_random() {
    for seed in 0..60 {
        let mut random = Random::new(100 + seed);
        let mut mesh = match seed % 3 {
            0 => sheet(3, 3, &mut random),
            1 => fan_sheet(3 + (seed as u32 / 3) % 5, &mut random),
            _ => common::torus(4, 4),
        };
        mesh.tags = random_tags(&mesh, &mut random);
        is_surface_of_refined(&mesh, 3, &mut random, &format!("seed {seed}: {:?}", mesh.tags));
    }
}

/// The position at vertex k of a quad.
fn at_corner(surface: &Surface, face: u32, k: usize) -> SurfacePoint {
    let [u, v] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][k];
    surface.eval(surface.quad(FaceId(face), 0).unwrap(), u, v).unwrap()
}

/// (a + 4 b + c) / 6.
fn on_spline(mesh: &Mesh, [a, b, c]: [u32; 3]) -> [f64; 3] {
    let [a, b, c] = [a, b, c].map(|v| mesh.positions[v as usize]);
    std::array::from_fn(|k| (a[k] + 4.0 * b[k] + c[k]) / 6.0)
}

fn assert_near(p: [f64; 3], q: [f64; 3]) {
    assert!(norm(sub(p, q)) < 1e-14, "{p:?} {q:?}");
}

#[test]
fn the_boundary_is_a_cubic_spline_that_passes_through_corners_or_not() {
    // Vertices 3 i + j; faces 2 i + j with corner 0 at (i,j).
    let mut mesh = sheet(2, 2, &mut Random::new(5));
    let surface = surface_of(&mesh, SchemeKind::CatmullClark);
    assert!(surface.extraordinary_points().is_empty(), "all regular");
    assert_near(at_corner(&surface, 0, 0).jet.p, mesh.positions[0]);
    assert_near(at_corner(&surface, 0, 1).jet.p, on_spline(&mesh, [0, 3, 6]));
    mesh.tags.boundary = BoundaryRule::EdgeOnly;
    let surface = surface_of(&mesh, SchemeKind::CatmullClark);
    assert_eq!(surface.extraordinary_points().len(), 4, "the corners");
    assert_near(at_corner(&surface, 0, 0).jet.p, on_spline(&mesh, [1, 0, 3]));
    assert_near(at_corner(&surface, 0, 1).jet.p, on_spline(&mesh, [0, 3, 6]));
    mesh.tags.boundary = BoundaryRule::None;
    let surface = surface_of(&mesh, SchemeKind::CatmullClark);
    assert_eq!(surface.omitted_faces().len(), 4);
}

#[test]
fn holes_have_no_surface_and_change_nothing_around() {
    let mut mesh = sheet(3, 3, &mut Random::new(6));
    let whole = surface_of(&mesh, SchemeKind::Qas4);
    mesh.tags.holes = vec![FaceId(4)];
    let surface = surface_of(&mesh, SchemeKind::Qas4);
    assert_eq!(surface.omitted_faces(), [FaceId(4)]);
    for face in 0..9 {
        let quad = surface.quad(FaceId(face), 0).unwrap();
        let found = surface.eval(quad, 0.3, 0.6);
        assert_eq!(found, whole.eval(quad, 0.3, 0.6).filter(|_| face != 4));
    }
}

/// The vertex of the first ring on line s.
fn on_line(n: u32, s: u32) -> u32 {
    1 + 2 * (s % n)
}

#[test]
fn creases_are_cubic_splines_and_separate_their_sides() {
    for (n, f) in [(4, 1), (5, 2), (6, 3), (7, 2)] {
        let mesh = starred(n, &[0, f], 11);
        let before = surface_of(&mesh, SchemeKind::Qas4);
        let center = at_corner(&before, 0, 0).jet.p;
        assert_near(center, on_spline(&mesh, [on_line(n, 0), 0, on_line(n, f)]));
        // Lift a vertex on one side: the other stays as it is, to the bit.
        let mut lifted = mesh.clone();
        lifted.positions[on_line(n, n - 1) as usize][2] += 1.0;
        let after = surface_of(&lifted, SchemeKind::Qas4);
        let quads = |s: u32| (9 * s..9 * s + 9).map(QuadId);
        let same = |quad| before.eval(quad, 0.2, 0.3) == after.eval(quad, 0.2, 0.3);
        assert!((0..f).flat_map(quads).all(same), "n = {n}");
        assert!(!quads(n - 1).all(same), "n = {n}");
    }
}

#[test]
fn three_sharp_edges_and_sharp_vertices_are_interpolated() {
    let three = starred(6, &[0, 2, 3], 12);
    let mut vertex = fan_sheet(5, &mut Random::new(13));
    vertex.tags.corners = vec![Corner { vertex: VertexId(0), sharpness: 12.0 }];
    for mesh in [three, vertex] {
        let surface = surface_of(&mesh, SchemeKind::Guided4);
        assert_near(at_corner(&surface, 0, 0).jet.p, mesh.positions[0]);
    }
}

/// The limit normals of creases and darts are the limits of the normals around.
#[test]
fn normals_at_creases_and_darts_are_limits() {
    for (n, lines) in [(4, vec![0]), (5, vec![0]), (6, vec![1]), (5, vec![0, 3]), (6, vec![0, 3])] {
        let mesh = starred(n, &lines, 14);
        let surface = surface_of(&mesh, SchemeKind::CatmullClark);
        for (k, point) in surface.extraordinary_points().iter().enumerate() {
            if point.vertex() != Some(VertexId(0)) {
                continue;
            }
            let rings = surface.rings(k).unwrap();
            for s in 0..rings.valence() {
                let near = rings.eval(s, 1e-9, 0.7e-9).unwrap().normal;
                // The second direction shrinks little faster than the third.
                let gap = norm(sub(near, rings.normal()));
                assert!(gap < 2e-2, "n = {n} {lines:?} {:?}: {gap}", point.fan);
            }
        }
    }
}

/// A flat cage has the normal above everywhere, and none where there is no tangent plane.
#[test]
fn flat_cages_have_their_normal() {
    for (n, lines) in
        [(3, vec![]), (5, vec![0]), (6, vec![0, 2]), (5, vec![0, 2, 3]), (4, vec![0, 1])]
    {
        let mut mesh = starred(n, &lines, 15);
        mesh.positions.iter_mut().for_each(|p| p[2] = 0.0);
        for boundary in [BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner] {
            mesh.tags.boundary = boundary;
            let surface = surface_of(&mesh, SchemeKind::CatmullClark);
            for (k, point) in surface.extraordinary_points().iter().enumerate() {
                let normal = surface.rings(k).unwrap().normal();
                let has_plane = point.fan.rule != VertexRule::Corner
                    && (point.fan.is_closed || point.fan.faces < 4);
                if has_plane {
                    assert_near(normal, [0.0, 0.0, 1.0]);
                } else {
                    assert!(normal[0].is_nan());
                }
            }
        }
    }
}

/// Where there is no smooth extraordinary point all schemes are one, to the bit.
#[test]
fn schemes_differ_at_smooth_extraordinary_points_only() {
    for seed in 0..12 {
        let mut random = Random::new(700 + seed);
        let mut mesh = fan_sheet(3 + seed as u32 % 5, &mut random);
        mesh.tags = random_tags(&mesh, &mut random);
        let cc = surface_of(&mesh, SchemeKind::CatmullClark);
        for scheme in [SchemeKind::EvolvingGuide, SchemeKind::Qas3, SchemeKind::Guided6] {
            let other = surface_of(&mesh, scheme);
            let has_scheme = |point: Option<usize>| {
                point.is_some_and(|p| other.extraordinary_points()[p].rule == PointRule::Scheme)
            };
            let places = |surface: &Surface| -> Vec<PatchPlace> {
                surface.patch_places(3).filter(|place| !has_scheme(place.point)).collect()
            };
            let (a, b) = (places(&cc), places(&other));
            assert_eq!(a.len(), b.len());
            for (p, q) in a.iter().zip(&b) {
                assert_eq!(cc.patch(p), other.patch(q));
            }
        }
    }
}

/// A semi-sharp crease of sharpness s has left after s levels, rounded up, and its points are then
/// those of a smooth surface; each gets its rule for its reason.
#[test]
fn points_are_isolated_as_soon_as_sharpness_allows() {
    for (sharpness, level) in [(0.0, 0), (0.5, 1), (2.0, 2), (2.5, 3), (9.0, 9)] {
        let mut mesh = fan_sheet(5, &mut Random::new(16));
        let edge = [0, on_line(5, 0)].map(VertexId);
        mesh.tags.creases = vec![Crease { edge, sharpness }];
        let surface = surface_of(&mesh, SchemeKind::Qas4);
        let [point] = surface.extraordinary_points() else { panic!("one point") };
        assert_eq!((point.rule, point.fan.faces), (PointRule::Scheme, 5));
        assert_eq!(point.level, level, "sharpness {sharpness}");
    }
    let reasons = |mesh: &Mesh| -> Vec<PointRule> {
        let surface = surface_of(mesh, SchemeKind::Qas4);
        let mut rules: Vec<PointRule> =
            surface.extraordinary_points().iter().map(|p| p.rule).collect();
        rules.dedup();
        rules
    };
    let cc = PointRule::CatmullClark;
    assert_eq!(reasons(&starred(5, &[0], 1))[0], cc(Reason::Dart));
    assert_eq!(reasons(&starred(5, &[0, 2], 1))[0], cc(Reason::Crease));
    assert_eq!(reasons(&starred(7, &[0, 2, 4], 1))[0], cc(Reason::Corner));
    assert_eq!(reasons(&fan_sheet(18, &mut Random::new(1)))[0], cc(Reason::Valence));
}
