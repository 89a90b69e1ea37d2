//! Guided surfaces at every contraction and valence that can be derived.
#![cfg(feature = "derive")]
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::sync::Arc;

use common::Random;
use evenlight::analyse::continuity::continuity;
use evenlight::net::CNet;
use evenlight::point::{norm, sub};
use evenlight::rings::Rings;
use evenlight::{Cage, Contraction, RuleSet, SchemeKind, Surface, SurfaceOptions};
use evenlight_guide::guided::characteristic::{CharacteristicRing, Square, sigma_of};
use evenlight_guide::guided::fit::{generating_matrix, guide};
use evenlight_guide::guided::rings::{self as derivation, Form};
use evenlight_guide::linear::Matrix;

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
            let surface = Surface::build(cage.clone(), options).unwrap();
            common::assert_rules(&name, &surface);
            let jumps = continuity(&surface, 6, 3).unwrap().all;
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
                let jumps = continuity(&surface(&cage, scheme, contraction), 8, 5).unwrap().all;
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

/// Two routes to one surface: the library's rules, and the rings of the derivation in 30 digits.
#[test]
fn rings_are_those_of_the_derivation() {
    let forms = [Form::Bi3, Form::Bi4, Form::Bi5, Form::Bi6];
    for (n, contraction) in [(3, 0.5), (5, 0.5), (6, 0.35), (8, 0.65), (32, 0.5)] {
        let chi = CharacteristicRing::new(n, sigma_of(n, contraction.into()));
        let cnet = random_cnet(n);
        let nodes: Vec<[f64; 3]> =
            cnet.sectors.iter().flatten().copied().chain([cnet.center]).collect();
        let net = Matrix::from_fn(nodes.len(), 3, |node, k| nodes[node][k].into());
        let guide = guide(&generating_matrix(&chi), n, &net);
        for (scheme, form) in GUIDED.into_iter().zip(forms) {
            let exact = derivation::Rings::new(&chi, form);
            let rings = Rings::from_cnet(&cnet, scheme, Contraction::Lambda(contraction)).unwrap();
            for level in 0..3 {
                let ring = exact.ring(level, &guide, &net);
                for (s, square) in [0, n - 1].into_iter().flat_map(|s| [0, 1, 2].map(|k| (s, k))) {
                    let place = [Square::B, Square::A, Square::C][square];
                    let table = &ring[s][place as usize];
                    let patches = form.patches(place, chi.sigma, table);
                    for (k, patch) in patches.iter().enumerate() {
                        let found = rings.patch(level, s, square * patches.len() + k).unwrap();
                        for (row, p) in found.coefs().iter().enumerate() {
                            let exact = [0, 1, 2].map(|k| patch[(row, k)].to_f64());
                            let gap = norm(sub(*p, exact));
                            assert!(gap < 1e-12, "n = {n}, {}, ring {level}: {gap}", scheme.name());
                        }
                    }
                }
            }
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
            let exact = surface.eval_on(place, u, v).unwrap().jet;
            assert_eq!(found, exact, "{} {contraction}", scheme.name());
        }
        for x in [f64::MIN_POSITIVE, f64::from_bits(1), 1e-300] {
            let point = surface.rings(0).unwrap().eval(0, x, 0.5 * x).unwrap();
            assert!(point.mean.is_finite() && point.gauss.is_finite());
        }
    }
}

/// The range of H over ring l shrinks by lambda per ring with bi-6 rings; with the others it has a
/// limit.
#[test]
fn curvature_is_continuous_with_bi_6_rings_and_bounded_with_the_others() {
    for (n, contraction) in [(3, 0.5), (5, 0.5), (6, 0.4), (8, 0.5), (10, 0.6), (20, 0.5)] {
        let contraction = Contraction::Lambda(contraction);
        for scheme in GUIDED {
            let rings = Rings::from_cnet(&random_cnet(n), scheme, contraction).unwrap();
            let (_, center) = rings.center_curvature().unwrap();
            let spread = |ring: i32| {
                let (h, s) = (rings.sigma().powi(ring), rings.sigma());
                let radii = [1.0, 0.7, 0.4].map(|t| h * (s + (1.0 - s) * t));
                let around = (0..n).flat_map(|s| (0..=8).map(move |k| (s, f64::from(k) / 8.0)));
                let means = around.flat_map(|(s, t)| {
                    let rings = &rings;
                    radii.into_iter().flat_map(move |r| {
                        [[r, t * r], [t * r, r]].map(|[a, b]| rings.eval(s, a, b).unwrap().mean)
                    })
                });
                means.fold(0.0_f64, |most, mean| most.max((mean - center).abs()))
            };
            let name = format!("{} n = {n}, {contraction}", scheme.name());
            if scheme == SchemeKind::Guided6 {
                let factor = spread(21) / spread(20);
                assert!((factor / rings.lambda() - 1.0).abs() < 0.01, "{name}: {factor}");
            } else {
                assert!((spread(60) / spread(80) - 1.0).abs() < 1e-3, "{name}");
                assert!(spread(60) > 1e-9, "{name}");
            }
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
        let deep = rings.eval(n - 1, 1e-30, 0.7e-30).unwrap();
        assert!((deep.gauss - gauss).abs() < 1e-9 * (1.0 + gauss.abs()), "n = {n}");
        assert!((deep.mean - mean).abs() < 1e-9 * (1.0 + mean.abs()), "n = {n}");
    }
    assert!(Rings::from_cnet(&random_cnet(33), SchemeKind::Guided6, Contraction::Half).is_none());
}
