//! All pieces of a surface join C2, whatever their kinds and levels: derivatives up to order two
//! in matched parameters agree across every patch border, except at extraordinary points.

mod common;

use evenlight::analyse::continuity::continuity;
use evenlight::surface::Role;
use evenlight::{SchemeKind, Surface};

/// Regular|regular, regular|ring 1, ring|ring, sector|sector, cap|cap and level|level.
#[test]
fn all_borders_of_all_cages_are_c2() {
    for (name, cage) in common::all_cages() {
        for scheme in SchemeKind::ALL {
            // A vertex of valence 2 or above 16 has Catmull-Clark rules only.
            let Ok(surface) = Surface::build(cage.clone(), common::options(scheme)) else {
                assert_ne!(scheme, SchemeKind::CatmullClark, "{name}");
                continue;
            };
            let jumps = continuity(&surface, 6, 3).all;
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

#[test]
fn rings_join_c2_at_any_depth() {
    let cage = common::cage("obstacle/saddle_n7.obj");
    for scheme in SchemeKind::ALL {
        let jumps = continuity(&common::surface(&cage, scheme), 40, 2).all;
        // World positions are rounded to 1e-16, so that only derivatives say something here.
        assert!(jumps.tangent_plane < 1e-9, "{jumps:?}");
    }
}
