//! Caps at boundaries, creases, corners, darts and valence 2: what they promise.
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::sync::Arc;

use common::fans::{fan_sheet, starred};
use common::{Random, surface};
use evenlight::analyse::caps::cap_report;
use evenlight::cap::{Cap, CapKind, CapOptions};
use evenlight::mesh::{BoundaryRule, Corner, VertexRule};
use evenlight::point::{cross, dot, norm, sub};
use evenlight::rings::Rings;
use evenlight::surface::{ExtraordinaryPoint, Role};
use evenlight::tessellate::tessellate;
use evenlight::{Cage, Mesh, SchemeKind, Surface, VertexId};

/// Fans of every kind: all around one vertex of a sheet, and along its border.
fn sheets() -> Vec<(String, Mesh)> {
    let mut sheets = Vec::new();
    for (n, lines) in [
        (4, vec![0]),
        (5, vec![0]),
        (9, vec![2]),
        (4, vec![0, 1]),
        (5, vec![0, 2]),
        (6, vec![0, 3]),
        (8, vec![0, 3]),
        (7, vec![0, 2, 3]),
        (12, vec![0, 5]),
    ] {
        sheets.push((format!("n = {n}, sharp {lines:?}"), starred(n, &lines, 21)));
    }
    for n in [3, 5, 6] {
        let mut mesh = fan_sheet(n, &mut Random::new(22));
        mesh.tags.boundary = BoundaryRule::EdgeOnly;
        mesh.tags.corners = vec![Corner { vertex: VertexId(0), sharpness: 10.0 }];
        sheets.push((format!("n = {n}, sharp vertex"), mesh));
    }
    sheets
}

fn closed(mesh: &Mesh, options: CapOptions) -> Surface {
    let cage = Arc::new(Cage::new(mesh.clone()).unwrap());
    let mut surface = surface(&cage, SchemeKind::Qas4);
    surface.set_caps(Some(options)).unwrap();
    surface
}

/// Runs `check` on the caps of all fans of the sheets.
fn for_all(kind: CapKind, check: impl Fn(&str, &ExtraordinaryPoint, &Rings, &Cap)) {
    for (name, mesh) in sheets() {
        for rings in [0, 3] {
            let surface = closed(&mesh, CapOptions { rings, kind });
            for (k, point) in surface.extraordinary_points().iter().enumerate() {
                if !point.fan.is_smooth() {
                    let name = format!("{name}, {:?}, {rings} rings, {}", point.fan, kind.name());
                    check(&name, point, surface.rings(k).unwrap(), surface.cap(k).unwrap());
                }
            }
        }
    }
}

fn steps(count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..=count).map(move |k| k as f64 / count as f64)
}

/// The lines inside a fan, by the sectors on both sides.
fn lines(point: &ExtraordinaryPoint) -> Vec<[usize; 2]> {
    let n = point.fan.faces;
    (0..n).filter(|&s| s > 0 || point.fan.is_closed).map(|s| [(s + n - 1) % n, s]).collect()
}

fn has_plane(rings: &Rings) -> bool {
    !rings.normal()[0].is_nan()
}

#[test]
fn they_are_small() {
    for_all(CapKind::Auto, |name, _, _, cap| {
        assert_eq!((cap.degree(), cap.patches_per_sector()), (4, 1), "{name}");
    });
    for_all(CapKind::Bi3, |name, _, _, cap| {
        assert_eq!((cap.degree(), cap.patches_per_sector()), (3, 1), "{name}");
    });
}

/// Position and first derivatives of the rings in front, whether there are any or not.
#[test]
fn they_go_on_from_the_rings() {
    for kind in [CapKind::Auto, CapKind::Bi3] {
        for_all(kind, |name, _, rings, cap| {
            let hole = rings.sigma().powi(cap.rings() as i32);
            for (s, t) in (0..rings.valence()).flat_map(|s| steps(16).map(move |t| (s, t))) {
                for at in [[1.0, t], [t, 1.0]] {
                    let own = cap.eval(rings, s, at).unwrap().jet;
                    let next = rings.eval(s, hole * at[0], hole * at[1]).unwrap().jet;
                    assert!(norm(sub(own.p, next.p)) < 1e-14, "{name}");
                    let size = norm(next.du) + norm(next.dv);
                    assert!(norm(sub(own.du, next.du)) < 1e-13 * size, "{name}");
                    assert!(norm(sub(own.dv, next.dv)) < 1e-13 * size, "{name}");
                }
            }
        });
    }
}

/// A crease is the same curve with caps and without, so that both sides of it meet.
#[test]
fn creases_stay_what_they_are() {
    for_all(CapKind::Auto, |name, point, rings, cap| {
        let n = rings.valence();
        if point.fan.is_closed {
            return;
        }
        let hole = rings.sigma().powi(cap.rings() as i32);
        for u in steps(16) {
            for (s, at) in [(0, [u, 0.0]), (n - 1, [0.0, u])] {
                let own = cap.eval(rings, s, at).unwrap().jet.p;
                let exact = rings.eval(s, hole * at[0], hole * at[1]).unwrap().jet.p;
                assert!(norm(sub(own, exact)) < 1e-15, "{name}: {:e}", norm(sub(own, exact)));
            }
        }
    });
}

/// Sectors meet, with one tangent plane all along if there is one at the centre.
#[test]
fn sectors_have_common_tangent_planes() {
    for_all(CapKind::Auto, |name, point, rings, cap| {
        for [behind, ahead] in lines(point) {
            for u in steps(16) {
                let [a, b] = [(behind, [0.0, u]), (ahead, [u, 0.0])]
                    .map(|(s, at)| cap.eval(rings, s, at).unwrap());
                assert!(norm(sub(a.jet.p, b.jet.p)) < 1e-15, "{name}");
                let is_sharp = point.fan.has_dart && ahead == 0;
                if has_plane(rings) && !(is_sharp && u > 0.0) {
                    let angle = norm(cross(a.normal, b.normal)).atan2(dot(a.normal, b.normal));
                    assert!(angle < 1e-11, "{name}: {angle:e} at {u}");
                }
            }
        }
    });
}

#[test]
fn the_centre_is_the_limit() {
    for_all(CapKind::Auto, |name, point, rings, cap| {
        for s in 0..rings.valence() {
            let center = cap.eval(rings, s, [0.0; 2]).unwrap();
            assert!(norm(sub(center.jet.p, rings.center())) < 1e-15, "{name}");
            assert!(center.gauss.is_nan() && center.mean.is_nan(), "{name}");
            if has_plane(rings) {
                assert_eq!(center.normal, rings.normal(), "{name}");
                // A single face between the ends of a crease has no angle there.
                let is_tip = point.fan.faces == 1 && point.fan.rule == VertexRule::Crease;
                let own = center.jet.normal();
                assert!(is_tip || norm(sub(own, rings.normal())) < 1e-12, "{name}");
            } else {
                assert!(center.normal[0].is_nan(), "{name}");
            }
        }
    });
}

/// Flat cages have flat caps that do not fold.
#[test]
fn flat_caps_are_regular() {
    for (name, mut mesh) in sheets() {
        mesh.positions.iter_mut().for_each(|p| p[2] = 0.0);
        for (rings, kind) in [(0, CapKind::Auto), (3, CapKind::Auto), (2, CapKind::Bi3)] {
            let surface = closed(&mesh, CapOptions { rings, kind });
            for (k, point) in surface.extraordinary_points().iter().enumerate() {
                let (around, cap) = (surface.rings(k).unwrap(), surface.cap(k).unwrap());
                for (s, a, b) in (0..point.fan.faces)
                    .flat_map(|s| steps(8).map(move |a| (s, a)))
                    .flat_map(|(s, a)| steps(8).map(move |b| (s, a, b)))
                {
                    let jet = cap.eval(around, s, [a, b]).unwrap().jet;
                    assert_eq!(jet.p[2], 0.0);
                    let area = cross(jet.du, jet.dv)[2];
                    let size = norm(jet.du).max(norm(jet.dv));
                    let what = format!("{name}, {:?}, {rings} rings: at {a}, {b}", point.fan);
                    // A single face between the ends of a straight crease is folded open.
                    let is_tip = point.fan.rule == VertexRule::Crease && point.fan.faces == 1;
                    assert!(
                        area > 1e-3 * size * size || (is_tip && area > -1e-12),
                        "{what}: {area:e}"
                    );
                }
            }
        }
    }
}

/// All is linear: the cap of an image is the image of the cap.
#[test]
fn caps_of_images_are_images() {
    let map = |[x, y, z]: [f64; 3]| [2.0 * x - y + 1.0, 0.3 * z + y, x + 0.7 * z - 2.0];
    for (name, mesh) in sheets() {
        let mut image = mesh.clone();
        image.positions.iter_mut().for_each(|p| *p = map(*p));
        let options = CapOptions { rings: 1, kind: CapKind::Auto };
        let [own, mapped] = [mesh, image].map(|mesh| closed(&mesh, options));
        for (k, point) in own.extraordinary_points().iter().enumerate() {
            if point.fan.is_smooth() {
                continue;
            }
            for s in 0..point.fan.faces {
                let [p, q] = [&own, &mapped].map(|surface| {
                    surface.cap(k).unwrap().patch(surface.rings(k).unwrap(), s, 0).unwrap()
                });
                for (&p, &q) in p.coefs().iter().zip(q.coefs()) {
                    assert!(norm(sub(map(p), q)) < 1e-13, "{name}");
                }
            }
        }
    }
}

/// With caps nothing is left open: every quad is covered once.
#[test]
fn feature_cages_are_covered() {
    for (name, cage) in common::feature_cages() {
        for rings in [0, 2] {
            let mut surface = surface(&cage, SchemeKind::Qas4);
            surface.set_caps(Some(CapOptions { rings, kind: CapKind::Auto })).unwrap();
            let mut covered = vec![0.0; surface.num_quads()];
            for place in surface.patch_places(rings) {
                let [u, v] = place.domain.map(|[from, to]| to - from);
                covered[place.quad.0 as usize] += u * v;
                if place.role == Role::Cap {
                    let patch = surface.patch(&place).unwrap();
                    assert!(patch.coefs().iter().flatten().all(|x| x.is_finite()), "{name}");
                }
            }
            for (quad, area) in covered.into_iter().enumerate() {
                let omitted = surface.eval(evenlight::QuadId(quad as u32), 0.3, 0.3).is_none();
                let whole = if omitted { 0.0_f64 } else { 1.0 };
                assert!((area - whole).abs() < 1e-12, "{name}: {area}");
            }
            let triangles = tessellate(&surface, 6).unwrap();
            assert!(triangles.gauss.iter().all(|k| k.abs() < 1e6), "{name}");
            for report in cap_report(&surface) {
                let curvature = report.curvature.gauss;
                assert!(
                    curvature.max.abs() < 1e8 && curvature.min.abs() < 1e8,
                    "{name}: {report:?}"
                );
                assert!(report.lines.position < 1e-13 && report.ring.position < 1e-13, "{name}");
                assert!(report.ring.tangent_plane < 1e-11, "{name}: {report:?}");
                if has_plane(surface.rings(report.point).unwrap()) {
                    assert!(report.lines.tangent_plane < 1e-10, "{name}: {report:?}");
                }
            }
        }
    }
}
