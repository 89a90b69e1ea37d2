//! Fair rings beside creases: tangent plane, bounded curvature, and nothing else changes.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its cage fails")]

mod common;

use common::Random;
use evenlight::analyse::caps::cap_report;
use evenlight::analyse::continuity::continuity;
use evenlight::cap::{Cap, CapKind, CapOptions};
use evenlight::mesh::{Crease, VertexRule};
use evenlight::point::{norm, sub};
use evenlight::rings::Rings;
use evenlight::surface::{CreaseRings, PatchPlace, PointRule, Reason};
use evenlight::{Cage, Mesh, Point, SchemeKind, Surface, SurfaceOptions, VertexId};

/// The vertex (a,b) of sector s: a grid of 3 x 3 faces per sector between the lines of a half-disc,
/// angles of the quarter plane scaled by 2/f.
fn half_disc(f: u32, surface: impl Fn(f64, f64) -> Point) -> Mesh {
    let mut numbers = std::collections::BTreeMap::new();
    let mut mesh = Mesh::default();
    let mut vertex = |s: u32, a: u32, b: u32, positions: &mut Vec<Point>| -> u32 {
        let key = match (a, b) {
            (0, 0) => (0, 0, 0),
            (0, b) => (s + 1, b, 0),
            _ => (s, a, b),
        };
        *numbers.entry(key).or_insert_with(|| {
            let (a, b) = (f64::from(a), f64::from(b));
            let angle = 2.0 / f64::from(f) * b.atan2(a)
                + std::f64::consts::PI * f64::from(s) / f64::from(f);
            let r = a.hypot(b);
            positions.push(surface(r * angle.cos(), r * angle.sin()));
            positions.len() as u32 - 1
        })
    };
    let mut faces = Vec::new();
    for (s, a, b) in (0..f).flat_map(|s| (0..9).map(move |k| (s, k / 3, k % 3))) {
        let corners = [(a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1)];
        faces.push(corners.map(|(a, b)| vertex(s, a, b, &mut mesh.positions)));
    }
    let mut half = Mesh::new(mesh.positions, faces);
    half.tags.boundary = evenlight::mesh::BoundaryRule::EdgeOnly;
    half
}

/// Two half-discs of f and g faces with a crease between them, with random heights.
fn creased(f: u32, g: u32, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let mut rough = |x: f64, y: f64| {
        let mut noise = || 0.3 * (random.unit() - 0.5);
        [x + noise(), y + noise(), 0.2 * x * x - 0.1 * y + noise()]
    };
    let n = f + g;
    let mut positions = vec![[0.0, 0.0, 0.1]];
    for r in 1..=3_u32 {
        for k in 0..2 * n * r {
            let (s, along) = (k / (2 * r), f64::from(k % (2 * r)) / f64::from(2 * r));
            let step = |s: u32| {
                let pi = std::f64::consts::PI;
                if s < f { pi / f64::from(f) } else { pi / f64::from(g) }
            };
            let start: f64 = (0..s).map(step).sum();
            let angle = start + along * step(s);
            positions.push(rough(f64::from(r) * angle.cos(), f64::from(r) * angle.sin()));
        }
    }
    let at = |s: u32, a: u32, b: u32| -> u32 {
        let r = a.max(b);
        if r == 0 {
            return 0;
        }
        let along = if a == r { b } else { 2 * r - a };
        1 + n * r * (r - 1) + (2 * r * s + along) % (2 * n * r)
    };
    let cells = (0..n).flat_map(|s| (0..9).map(move |k| (s, k / 3, k % 3)));
    let corners =
        cells.map(|(s, a, b)| [at(s, a, b), at(s, a + 1, b), at(s, a + 1, b + 1), at(s, a, b + 1)]);
    let mut mesh = Mesh::new(positions, corners);
    for s in [0, f] {
        for r in 0..3 {
            let edge = [at(s, r, 0), at(s, r + 1, 0)].map(VertexId);
            mesh.tags.creases.push(Crease { edge, sharpness: 10.0 });
        }
    }
    mesh
}

fn build(mesh: &Mesh, creases: CreaseRings) -> Surface {
    let options = SurfaceOptions { creases, ..SurfaceOptions::default() };
    Surface::build(Cage::new(mesh.clone()).unwrap(), options).unwrap()
}

/// The points with fair rings.
fn fair_points(surface: &Surface) -> Vec<usize> {
    let points = surface.extraordinary_points().iter().enumerate();
    points.filter(|(_, p)| matches!(p.rule, PointRule::FairCrease(_))).map(|(k, _)| k).collect()
}

const SIDES: [(u32, u32); 6] = [(1, 3), (3, 4), (2, 5), (6, 2), (1, 8), (12, 3)];

/// All patches join C2 but across the crease, where they meet; on it the curve is that of the
/// default.
#[test]
fn all_is_c2_but_for_the_crease_whose_curve_stays() {
    for (f, g) in SIDES {
        let mesh = creased(f, g, u64::from(10 * f + g));
        let (fair, default) =
            (build(&mesh, CreaseRings::Fair), build(&mesh, CreaseRings::default()));
        let expected = [f, g].into_iter().filter(|&f| f != 2).count();
        assert_eq!(fair_points(&fair).len(), expected);
        let found = continuity(&fair, 5, 3).unwrap();
        assert!(found.all.parametric < 1e-11, "{f} {g}: {:e}", found.all.parametric);
        assert!(
            found.all.defect.tangent_plane < 1e-10,
            "{f} {g}: {:e}",
            found.all.defect.tangent_plane
        );
        assert!(
            found.creases.defect.position < 1e-14,
            "{f} {g}: {:e}",
            found.creases.defect.position
        );
        for point in fair_points(&fair) {
            let (rings, before) = (fair.rings(point).unwrap(), default.rings(point).unwrap());
            assert!(norm(sub(rings.center(), before.center())) < 1e-15);
            for t in [1.0, 0.7, 0.5, 0.3, 0.1, 1e-3, 1e-6] {
                for (s, a, b) in [(0, t, 0.0), (rings.valence() - 1, 0.0, t)] {
                    let (p, q) = (rings.eval(s, a, b).unwrap(), before.eval(s, a, b).unwrap());
                    assert!(norm(sub(p.jet.p, q.jet.p)) < 1e-14, "{f} {g} {t}");
                }
            }
        }
    }
}

/// The surface is that of the default, to the bit, but for the fair rings.
#[test]
fn all_else_stays_to_the_bit() {
    for (f, g) in SIDES {
        let mesh = creased(f, g, 77);
        let (fair, default) =
            (build(&mesh, CreaseRings::Fair), build(&mesh, CreaseRings::default()));
        let is_fair = |p: Option<usize>| p.is_some_and(|p| fair_points(&fair).contains(&p));
        let places = |surface: &Surface| -> Vec<PatchPlace> {
            surface.patch_places(2).filter(|place| !is_fair(place.point)).collect()
        };
        let (a, b) = (places(&fair), places(&default));
        assert_eq!(a.len(), b.len());
        a.iter().zip(&b).for_each(|(p, q)| assert_eq!(fair.patch(p), default.patch(q)));
    }
}

/// The default is Catmull-Clark's, and fair rings are for creases alone.
#[test]
fn fair_rings_are_asked_for_and_for_creases_alone() {
    assert_eq!(SurfaceOptions::default().creases, CreaseRings::CatmullClark);
    let mesh = creased(3, 5, 5);
    assert!(fair_points(&build(&mesh, CreaseRings::default())).is_empty());
    let surface = build(&mesh, CreaseRings::Fair);
    let points = surface.extraordinary_points().iter();
    let mut of_center = points.filter(|p| p.vertex() == Some(VertexId(0)));
    assert!(of_center.all(|p| p.rule == PointRule::FairCrease(Reason::Crease)));
    let half = build(&half_disc(5, |x, y| [x, y, 0.0]), CreaseRings::Fair);
    assert_eq!(half.extraordinary_points()[0].rule, PointRule::FairCrease(Reason::Boundary));
    let mut dart = creased(3, 5, 5);
    dart.tags.creases.truncate(3);
    let surface = build(&dart, CreaseRings::Fair);
    let center = surface.extraordinary_points().iter().find(|p| p.vertex() == Some(VertexId(0)));
    assert_eq!(center.unwrap().rule, PointRule::CatmullClark(Reason::Dart));
}

/// The limit normal is that of the rings, to which they come linearly: curvature is bounded.
#[test]
fn there_is_a_tangent_plane() {
    for (f, g) in SIDES {
        let surface = build(&creased(f, g, 21), CreaseRings::Fair);
        for point in fair_points(&surface) {
            let rings = surface.rings(point).unwrap();
            let sector = surface.extraordinary_points()[point].sectors[0];
            let [u, v] = sector.center;
            assert_eq!(surface.eval(sector.quad, u, v).unwrap().normal, rings.normal());
            for s in 0..rings.valence() {
                for distance in [1e-4, 1e-8, 1e-12] {
                    for (a, b) in [(1.0, 0.0), (0.8, 0.7), (0.1, 1.0)] {
                        let near = rings.eval(s, a * distance, b * distance).unwrap();
                        let gap = norm(sub(near.normal, rings.normal()));
                        assert!(gap < 100.0 * distance + 1e-15, "{f} {g}: {gap:e} at {distance:e}");
                    }
                }
            }
        }
    }
}

/// Curvature comes to a limit along every ray, which it repeats from ring to ring, and the normal
/// curvature across the crease vanishes there: K <= 0 on it.
#[test]
fn curvature_is_bounded() {
    for (f, g) in SIDES {
        let surface = build(&creased(f, g, 33), CreaseRings::Fair);
        for point in fair_points(&surface) {
            let rings = surface.rings(point).unwrap();
            for s in 0..rings.valence() {
                for (a, b) in [(0.9, 0.0), (0.7, 0.6), (0.2, 0.75)] {
                    let at = |ring: i32| {
                        let scale = 0.5_f64.powi(ring);
                        rings.eval(s, a * scale, b * scale).unwrap()
                    };
                    let [near, nearer, nearest] = [20, 30, 40].map(at);
                    let size = 1.0 + near.mean.abs();
                    assert!(
                        (near.mean - nearest.mean).abs() < 1e-3 * size,
                        "{f} {g}: {}",
                        near.mean
                    );
                    assert!((nearer.mean - nearest.mean).abs() < 1e-6 * size);
                    assert!((nearer.gauss - nearest.gauss).abs() < 1e-6 * (1.0 + size * size));
                }
            }
        }
    }
}

/// A flat cage stays flat, its normal is there for any number of faces, and nothing folds.
#[test]
fn flat_cages_stay_flat_and_do_not_fold() {
    for (f, g) in SIDES {
        let mut mesh = creased(f, g, 44);
        mesh.positions.iter_mut().for_each(|p| p[2] = 0.0);
        let surface = build(&mesh, CreaseRings::Fair);
        for point in fair_points(&surface) {
            assert_eq!(surface.extraordinary_points()[point].fan.rule, VertexRule::Crease);
            let rings = surface.rings(point).unwrap();
            assert!(norm(sub(rings.normal(), [0.0, 0.0, 1.0])) < 1e-15);
            for s in 0..rings.valence() {
                for k in 0..40 {
                    let [a, b] = [0.13 * f64::from(k % 8), 0.2 * f64::from(k / 8)];
                    if a + b == 0.0 {
                        continue;
                    }
                    let at = rings.eval(s, a, b).unwrap();
                    assert!(at.jet.p[2].abs() < 1e-15);
                    assert!(at.normal[2] > 0.999_999, "{f} {g}: fold in sector {s} at {a} {b}");
                }
            }
        }
    }
}

/// What our prototype in another language has: (faces, ring, position, H) at a place of the last
/// sector.
const PROTOTYPE: [(u32, i32, [f64; 3], f64); 8] = [
    (1, 0, [0.065102854287, 0.881653809484, 0.361926735471], 0.253454957),
    (1, 3, [-0.001881421447, 0.075593244794, 0.088331956413], 0.083528491),
    (3, 0, [-1.059100550920, 0.684747514836, 0.579862309567], 0.321584637),
    (3, 3, [-0.126556123831, 0.102519670005, 0.090065057466], 0.192038270),
    (5, 0, [-1.230232057366, 0.480236057955, 0.613259932797], 0.353888699),
    (5, 3, [-0.143169070078, 0.075767976964, 0.087772746946], 0.148156040),
    (8, 0, [-1.293630485424, 0.346791145563, 0.618156324720], 0.421599554),
    (8, 3, [-0.148538092543, 0.055528034003, 0.085393806997], 0.042577529),
];

#[test]
fn the_rings_are_those_of_the_prototype() {
    let graph = |x: f64, y: f64| {
        let height = 0.2 * x * x - 0.1 * x * y + 0.15 * y * y - 0.05 * x * x * x;
        [x + 0.1 * y * y, y + 0.05 * x * x, height]
    };
    for (f, ring, p, mean) in PROTOTYPE {
        let surface = build(&half_disc(f, graph), CreaseRings::Fair);
        let points = surface.extraordinary_points();
        let center = points.iter().position(|p| p.vertex() == Some(VertexId(0))).unwrap();
        assert_eq!(points[center].level, 0);
        let scale = 0.25 * 0.5_f64.powi(ring);
        let found =
            surface.rings(center).unwrap().eval(f as usize - 1, 3.25 * scale, 3.5 * scale).unwrap();
        assert!(norm(sub(found.jet.p, p)) < 1e-10, "{f}, {ring}: {:?}", found.jet.p);
        assert!((found.mean - mean).abs() < 1e-8, "{f}, {ring}: {}", found.mean);
    }
}

/// Boundaries and creases of any valence, n-gons, semi-sharp edges and seams around: all joins.
#[test]
fn whole_cages_join() {
    let features = [
        "boundary_concave",
        "boundary_creased",
        "boundary_edge_only",
        "boundary_valences",
        "crease_turning",
        "cube_creased",
        "polygons_boundary",
        "star5_crease",
        "uv_concave",
    ];
    for name in features {
        let mesh = common::mesh(&format!("features/{name}.obj"));
        let surface = build(&mesh, CreaseRings::Fair);
        assert!(!fair_points(&surface).is_empty(), "{name}");
        let found = continuity(&surface, 3, 2).unwrap();
        assert!(found.all.parametric < 1e-10, "{name}: {:e}", found.all.parametric);
        assert!(
            found.creases.defect.position < 1e-13,
            "{name}: {:e}",
            found.creases.defect.position
        );
        for point in fair_points(&surface) {
            assert!(surface.rings(point).unwrap().normal()[0].is_finite(), "{name}");
        }
    }
}

/// They are the same with every scheme.
#[test]
fn every_scheme_has_them() {
    let mesh = creased(4, 3, 8);
    let rings = |scheme: SchemeKind| {
        let options =
            SurfaceOptions { scheme, creases: CreaseRings::Fair, ..SurfaceOptions::default() };
        let surface = Surface::build(Cage::new(mesh.clone()).unwrap(), options).unwrap();
        let points = fair_points(&surface);
        points
            .into_iter()
            .map(|p| surface.rings(p).unwrap().patches(2).unwrap())
            .collect::<Vec<_>>()
    };
    let first = rings(SchemeKind::CatmullClark);
    assert!(SchemeKind::ALL.into_iter().all(|scheme| rings(scheme) == first));
}

/// Caps close the hole behind any number of rings: with second derivatives to the last ring,
/// tangent planes inside, and the crease as it was.
#[test]
fn caps_close_them() {
    for (f, g) in SIDES {
        let mesh = creased(f, g, 55);
        for (rings, kind) in [(0, CapKind::Auto), (3, CapKind::Auto), (2, CapKind::Bi3)] {
            let mut surface = build(&mesh, CreaseRings::Fair);
            surface.set_caps(Some(CapOptions { rings, kind })).unwrap();
            let reports = cap_report(&surface);
            for point in fair_points(&surface) {
                let name = format!("{f} {g}, {rings} rings, {}", kind.name());
                let report = reports.iter().find(|report| report.point == point).unwrap();
                for defect in [report.lines, report.inside, report.ring] {
                    assert!(defect.position < 1e-14, "{name}: {defect:?}");
                }
                let planes = [report.inside.tangent_plane, report.ring.tangent_plane];
                assert!(planes.into_iter().all(|angle| angle < 1e-9), "{name}: {planes:?}");
                let across = if kind == CapKind::Bi3 { 0.3 } else { 1e-9 };
                assert!(report.lines.tangent_plane < across, "{name}: {:?}", report.lines);
                goes_on(&name, surface.rings(point).unwrap(), surface.cap(point).unwrap());
            }
        }
    }
}

fn goes_on(name: &str, rings: &Rings, cap: &Cap) {
    assert_eq!(cap.patches_per_sector(), 4);
    let hole = 0.5_f64.powi(cap.rings() as i32);
    let near = |a: [f64; 3], b: [f64; 3], size: f64| {
        assert!(norm(sub(a, b)) < 1e-12 * size, "{name}: {a:?} {b:?}");
    };
    for (s, k) in (0..rings.valence()).flat_map(|s| (0..=16).map(move |k| (s, k))) {
        let t = f64::from(k) / 16.0;
        for at in [[1.0, t], [t, 1.0]] {
            let (own, next) = (
                cap.eval(rings, s, at).unwrap().jet,
                rings.eval(s, hole * at[0], hole * at[1]).unwrap().jet,
            );
            let size = norm(next.du) + norm(next.dv);
            near(own.p, next.p, 1.0);
            near(own.du, next.du, size);
            near(own.dv, next.dv, size);
            for (a, b) in [(own.duu, next.duu), (own.duv, next.duv), (own.dvv, next.dvv)] {
                near(a, b, 16.0 * size / hole);
            }
        }
        for (s, at) in [(0, [t, 0.0]), (rings.valence() - 1, [0.0, t])] {
            let next = if k == 0 {
                rings.center()
            } else {
                rings.eval(s, hole * at[0], hole * at[1]).unwrap().jet.p
            };
            near(cap.eval(rings, s, at).unwrap().jet.p, next, 1.0);
        }
    }
    let center = cap.eval(rings, 0, [0.0, 0.0]).unwrap();
    near(center.jet.p, rings.center(), 1.0);
    near(center.normal, rings.normal(), 1e3);
}

/// Caps of flat cages are flat and do not fold.
#[test]
fn flat_caps_do_not_fold() {
    for (f, g) in SIDES {
        let mut mesh = creased(f, g, 44);
        mesh.positions.iter_mut().for_each(|p| p[2] = 0.0);
        let mut surface = build(&mesh, CreaseRings::Fair);
        surface.set_caps(Some(CapOptions { rings: 2, kind: CapKind::Auto })).unwrap();
        for point in fair_points(&surface) {
            let (rings, cap) = (surface.rings(point).unwrap(), surface.cap(point).unwrap());
            for (s, k) in (0..rings.valence()).flat_map(|s| (1..81).map(move |k| (s, k))) {
                let at = [f64::from(k % 9) / 8.0, f64::from(k / 9) / 8.0];
                let found = cap.eval(rings, s, at).unwrap();
                assert!(found.jet.p[2].abs() < 1e-15);
                assert!(found.normal[2] > 0.999_999, "{f} {g}: fold in sector {s} at {at:?}");
            }
        }
    }
}
