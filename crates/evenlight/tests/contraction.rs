//! Guided surfaces at every contraction and valence that can be derived.
#![cfg(feature = "derive")]
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::sync::Arc;

use common::Random;
use evenlight::analyse::continuity::continuity;
use evenlight::net::CNet;
use evenlight::rings::Rings;
use evenlight::{Cage, Contraction, RuleSet, SchemeKind, Surface, SurfaceOptions};

const GUIDED: [SchemeKind; 4] =
    [SchemeKind::Guided3, SchemeKind::Guided4, SchemeKind::Guided5, SchemeKind::Guided6];

/// Slow, usual, fast.
const CONTRACTIONS: [Contraction; 4] = [
    Contraction::Half,
    Contraction::Lambda(0.31),
    Contraction::Lambda(0.4321),
    Contraction::Lambda(0.69),
];

fn surface(cage: &Arc<Cage>, scheme: SchemeKind, contraction: Contraction) -> Surface {
    let options = SurfaceOptions { scheme, contraction, ..SurfaceOptions::default() };
    Surface::build(cage.clone(), options).unwrap()
}

fn random_cnet(n: usize) -> CNet {
    let mut random = Random::new(n as u64);
    let mut point = || [0.0; 3].map(|_: f64| random.unit() - 0.5);
    CNet { sectors: (0..n).map(|_| [0; 6].map(|_| point())).collect(), center: point() }
}

/// Ring|ring, sector|sector and ring|regular, all four degrees.
#[test]
fn all_borders_of_the_obstacle_cages_are_c2_at_contraction_one_half() {
    for (name, cage) in common::all_cages() {
        for scheme in GUIDED {
            let options = SurfaceOptions {
                scheme,
                contraction: Contraction::Half,
                ..common::options(scheme)
            };
            // A vertex of valence 2 or above 32 has Catmull-Clark rules only.
            let Ok(surface) = Surface::build(cage.clone(), options) else { continue };
            let jumps = continuity(&surface, 6, 3).all;
            assert!(jumps.parametric <= 1e-11, "{name}, {}: {jumps:?}", scheme.name());
        }
    }
}

/// Rounding is larger than at the usual speeds: guided3 has pieces as short as sigma^2 t = 0.04 of
/// a sector, and second derivatives have the square of that in the denominator.
#[test]
fn all_borders_are_c2_at_any_contraction() {
    for n in [3, 5, 8] {
        let cage = common::cage(&format!("obstacle/saddle_n{n}.obj"));
        for scheme in GUIDED {
            for contraction in CONTRACTIONS {
                let jumps = continuity(&surface(&cage, scheme, contraction), 8, 5).all;
                let name = scheme.name();
                assert!(jumps.parametric <= 1e-10, "n = {n}, {name}, {contraction}: {jumps:?}");
            }
        }
    }
}

/// lambda is what was asked for; the quartic of sigma holds.
#[test]
fn rings_contract_by_lambda() {
    for n in [3, 5, 9, 20, 32] {
        for contraction in CONTRACTIONS {
            let rings =
                Rings::from_cnet(&random_cnet(n), SchemeKind::Guided5, contraction).unwrap();
            let (lambda, s) = (rings.lambda(), rings.sigma());
            assert!((lambda - contraction.lambda().unwrap()).abs() < 1e-15);
            let c = (std::f64::consts::TAU / n as f64).cos();
            let trace = s * (1.0 + s * s + c * (1.0 - s) * (1.0 - s));
            assert!((lambda * lambda - trace * lambda + s.powi(4)).abs() < 1e-15);
        }
    }
}

/// The patch that evaluation chooses has the parameter in its domain, however deep or small.
#[test]
fn every_parameter_is_in_the_patch_that_has_it() {
    for (scheme, contraction) in GUIDED.into_iter().zip(CONTRACTIONS) {
        let cage = common::cage("obstacle/saddle_n5.obj");
        let surface = surface(&cage, scheme, contraction);
        let places: Vec<_> = surface.patch_places(5).collect();
        let mut random = Random::new(7);
        for place in &places {
            let [[u0, u1], [v0, v1]] = place.domain;
            let u = u0 + (u1 - u0) * random.unit();
            let v = v0 + (v1 - v0) * random.unit();
            let found = surface.eval(place.quad, u, v).unwrap().jet;
            let exact = surface.eval_on(place, u, v).jet;
            assert_eq!(found, exact, "{} {contraction}", scheme.name());
        }
        for x in [f64::MIN_POSITIVE, f64::from_bits(1), 1e-300] {
            let point = surface.rings(0).eval(0, x, 0.5 * x);
            assert!(point.mean.is_finite() && point.gauss.is_finite());
        }
    }
}

/// Curvature has the same limit from deep rings at every contraction of one guide's degree.
#[test]
fn any_valence_to_32_has_rings_that_tend_to_the_curvature_of_the_guide() {
    for n in [17, 25, 32] {
        let rings = Rings::from_cnet(&random_cnet(n), SchemeKind::Guided6, RuleSet::Generated);
        let rings = rings.unwrap();
        let (gauss, mean) = rings.center_curvature().unwrap();
        let deep = rings.eval(n - 1, 1e-30, 0.7e-30);
        assert!((deep.gauss - gauss).abs() < 1e-9 * (1.0 + gauss.abs()), "n = {n}");
        assert!((deep.mean - mean).abs() < 1e-9 * (1.0 + mean.abs()), "n = {n}");
    }
    assert!(Rings::from_cnet(&random_cnet(33), SchemeKind::Guided6, Contraction::Half).is_none());
}
