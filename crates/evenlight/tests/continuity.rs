//! All pieces of a surface join C2, whatever their kinds and levels: derivatives up to order two
//! in matched parameters agree across every patch border, except at extraordinary points.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod common;

use evenlight::SchemeKind;
use evenlight::analyse::continuity::continuity;
use evenlight::point::{norm, sub};
use evenlight::rings::Rings;
use evenlight::surface::Role;

/// Regular|regular, regular|ring 1, ring|ring, sector|sector of one point and of two, level|level.
#[test]
fn all_borders_of_all_cages_are_c2() {
    for (name, cage) in common::all_cages() {
        for scheme in SchemeKind::ALL {
            let surface = common::surface(&cage, scheme);
            common::assert_rules(&name, &surface);
            let jumps = continuity(&surface, 6, 3).unwrap().all;
            assert!(jumps.parametric <= 1e-11, "{name}, {}: {jumps:?}", scheme.name());
        }
    }
}

/// The test above would be empty if no cage had borders of some kind.
#[test]
fn the_cages_have_borders_of_every_kind() {
    let kinds = |name: &str| {
        let surface = common::surface(&common::cage(name), SchemeKind::EvolvingGuide);
        let levels: Vec<usize> = surface.extraordinary_points().iter().map(|p| p.level).collect();
        let sizes: Vec<f64> = surface
            .patch_places(1)
            .filter(|p| p.role == Role::Regular)
            .map(|p| p.domain[0][1] - p.domain[0][0])
            .collect();
        (levels, sizes)
    };
    let (levels, sizes) = kinds("own_blob_quadriflow_300.obj");
    assert!(levels.contains(&0) && levels.contains(&1));
    assert!(sizes.contains(&1.0) && sizes.contains(&0.5), "regular patches of two levels");
    let (levels, _) = kinds("obstacle/frame_tet_tight_n6.obj");
    assert!(levels.iter().all(|&level| level == 0), "sectors of two points side by side");
}

/// In the scale of a ring positions are lost at depth (they are rounded to 1e-16 of the cage), but
/// derivatives are not: those up to order two agree across the borders of rings 1 to 40.
#[test]
fn rings_join_c2_at_any_depth() {
    let cage = common::cage("obstacle/saddle_n7.obj");
    for scheme in SchemeKind::ALL {
        let surface = common::surface(&cage, scheme);
        let rings = surface.rings(0).unwrap();
        for ring in 1..40 {
            let h = 0.5_f64.powi(ring);
            // The border between ring `ring - 1` and `ring`: a = h, b from 0 to h.
            for (which, inner) in borders(rings) {
                let [[_, _], [b0, b1]] = rings.patch_domain(inner).unwrap();
                let b = h * (0.5 * b0 + 0.5 * b1);
                let out = rings.eval_on(ring as usize - 1, 2, which, h, b).unwrap().jet;
                let inn = rings.eval_on(ring as usize, 2, inner, h, b).unwrap().jet;
                let rows = out.rows().into_iter().zip(inn.rows()).skip(1);
                let scaled = |r: evenlight::Vector, order: usize| norm(r) * h.powi(order as i32);
                let size: f64 = scaled(out.du, 1) + scaled(out.duu, 2);
                for (k, (x, y)) in rows.enumerate() {
                    let gap = scaled(sub(x, y), if k < 2 { 1 } else { 2 });
                    assert!(gap < 1e-11 * size, "{} ring {ring}: {gap} of {size}", scheme.name());
                }
            }
        }
    }
}

/// Pairs of patches of a ring and the next that touch along a = 1/2 of the outer one.
fn borders(rings: &Rings) -> Vec<(usize, usize)> {
    let all = || 0..rings.patches_per_sector();
    let domain = |p: usize| rings.patch_domain(p).expect("there is such a patch");
    let outer = all().filter(|&p| domain(p)[0][0] == 0.5);
    let inner = all().filter(|&p| domain(p)[0][1] == 1.0);
    let inner: Vec<usize> = inner.collect();
    let touch = |p: usize, q: usize| {
        let ([_, [p0, p1]], [_, [q0, q1]]) = (domain(p), domain(q));
        let middle = 0.25 * (q0 + q1);
        p0 <= middle && middle <= p1
    };
    outer.flat_map(|p| inner.iter().filter(move |&&q| touch(p, q)).map(move |&q| (p, q))).collect()
}
