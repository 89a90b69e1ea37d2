//! Surfaces whose extraordinary points are closed by caps.
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::sync::Arc;

use common::{cage, surface};
use evenlight::analyse::caps::cap_report;
use evenlight::cap::{CapError, CapKind, CapOptions};
use evenlight::net::Quadratic;
use evenlight::point::{norm, sub};
use evenlight::surface::Role;
use evenlight::tessellate::tessellate;
use evenlight::{Cage, SchemeKind, Surface};

/// A closed cage with n-gons, one with many valences, one with a boundary.
const CAGES: [&str; 3] =
    ["own_polygons.obj", "own_blob_quadriflow_300.obj", "obstacle/monkey_n8.obj"];

fn closed(cage: &Arc<Cage>, scheme: SchemeKind, rings: usize, kind: CapKind) -> Surface {
    let mut surface = surface(cage, scheme);
    surface.set_caps(Some(CapOptions { rings, kind })).unwrap();
    surface
}

/// The patches of every quad cover it once, so nothing is left open.
#[test]
fn patches_with_caps_cover_every_quad() {
    for (name, scheme) in CAGES.into_iter().flat_map(|name| SchemeKind::ALL.map(|s| (name, s))) {
        for rings in [0, 1, 5] {
            let surface = closed(&cage(name), scheme, rings, CapKind::Auto);
            let mut covered = vec![0.0; surface.num_quads()];
            for place in surface.patch_places(rings) {
                let [u, v] = place.domain.map(|[from, to]| to - from);
                covered[place.quad.0 as usize] += u * v;
            }
            for (quad, area) in covered.into_iter().enumerate() {
                let omitted = surface.eval(evenlight::QuadId(quad as u32), 0.3, 0.3).is_none();
                let whole = if omitted { 0.0_f64 } else { 1.0 };
                assert!((area - whole).abs() < 1e-12, "{name} {}: {area}", scheme.name());
            }
        }
    }
}

/// Positions and tangent planes agree on all borders of caps in cages, whatever else is around.
#[test]
fn caps_join_in_cages() {
    for (name, scheme) in CAGES.into_iter().flat_map(|name| SchemeKind::ALL.map(|s| (name, s))) {
        let surface = closed(&cage(name), scheme, 2, CapKind::Auto);
        let reports = cap_report(&surface);
        assert_eq!(reports.len(), surface.extraordinary_points().len());
        for report in reports {
            for defect in [report.lines, report.inside, report.ring] {
                let what = format!("{name} {} {report:?}", scheme.name());
                assert!(defect.position < 1e-13, "{what}");
                assert!(defect.tangent_plane < 1e-10, "{what}");
            }
        }
    }
}

/// Evaluation, patches and the answers of a given patch are one.
#[test]
fn caps_evaluate_as_their_patches() {
    for scheme in [SchemeKind::Qas4, SchemeKind::Guided6] {
        let surface = closed(&cage(CAGES[0]), scheme, 3, CapKind::Auto);
        let caps = surface.patch_places(3).filter(|place| place.role == Role::Cap);
        for place in caps {
            let [[u0, u1], [v0, v1]] = place.domain;
            let (u, v) = (0.7 * u0 + 0.3 * u1, 0.4 * v0 + 0.6 * v1);
            let whole = surface.eval(place.quad, u, v).unwrap();
            let own = surface.eval_on(&place, u, v).unwrap();
            assert_eq!(whole, own, "evaluation takes this patch");
            let jet = surface.patch(&place).unwrap().jet(0.3, 0.6);
            assert!(norm(sub(jet.p, own.jet.p)) < 1e-14);
            let size = norm(jet.du);
            assert!(
                norm(sub(jet.du.map(|x| x / (u1 - u0)), own.jet.du)) < 1e-10 * size / (u1 - u0)
            );
        }
    }
}

/// A closed surface has derivatives and curvature everywhere, at extraordinary points too.
#[test]
fn closed_surfaces_have_no_holes() {
    for scheme in SchemeKind::ALL {
        let surface = closed(&cage(CAGES[0]), scheme, 1, CapKind::Auto);
        for (k, point) in surface.extraordinary_points().iter().enumerate() {
            let (sector, rings) = (point.sectors[0], surface.rings(k).unwrap());
            let center = surface.eval(sector.quad, sector.center[0], sector.center[1]).unwrap();
            assert!(center.jet.rows().iter().flatten().all(|x| x.is_finite()));
            assert!(center.gauss.is_finite() && center.mean.is_finite());
            assert!(norm(sub(center.jet.p, rings.center())) < 1e-14);
            assert!(norm(sub(center.normal, rings.normal())) < 1e-12);
        }
        let mesh = tessellate(&surface, 6).unwrap();
        assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()));
        assert!(mesh.mean.iter().all(|x| x.is_finite()));
    }
}

#[test]
fn caps_follow_the_quadratic() {
    let mut surface = closed(&cage("obstacle/monkey_n8.obj"), SchemeKind::Qas4, 2, CapKind::Auto);
    let q = *surface.rings(0).unwrap().quadratic().unwrap();
    let mut coefs = q.coefs;
    coefs[2][2] += 0.01;
    coefs[5][2] += 0.02;
    let sector = surface.extraordinary_points()[0].sectors[0];
    let at = |surface: &Surface| surface.eval(sector.quad, sector.center[0], sector.center[1]);
    let before = at(&surface).unwrap().mean;
    assert!(surface.set_quadratic(0, &Quadratic { coefs }));
    let (after, expected) =
        (at(&surface).unwrap(), surface.rings(0).unwrap().center_curvature().unwrap());
    assert!((after.mean - expected.1).abs() < 1e-12 * (1.0 + expected.1.abs()));
    assert!((after.mean - before).abs() > 1e-3);
}

#[test]
fn caps_that_do_not_fit_leave_the_surface_as_it_was() {
    let mut surface = surface(&cage(CAGES[0]), SchemeKind::Guided5);
    let options = CapOptions { rings: 1, kind: CapKind::Bi3 };
    assert!(matches!(surface.set_caps(Some(options)), Err(CapError::Degree { .. })));
    assert_eq!(surface.cap_options(), None);
}
