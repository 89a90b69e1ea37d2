//! Caps: what they promise, for every scheme, degree and number of rings.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod golden;
mod nets;

use evenlight::cap::{Cap, CapError, CapKind, CapOptions};
use evenlight::net::CNet;
use evenlight::point::{Vector, add, cross, dot, norm, scale, sub};
use evenlight::rings::Rings;
use evenlight::{RuleSet, SchemeKind, SurfacePoint};

const VALENCES: [usize; 7] = [3, 5, 6, 7, 8, 9, 10];

/// A net without symmetry: a saddle with all nodes moved by some percent.
fn crooked(n: usize) -> CNet {
    let k = std::cell::Cell::new(0.0_f64);
    nets::net_of(&nets::characteristic_cnet(n), |[x, y, _]| {
        k.set(k.get() + 1.0);
        let k = k.get();
        let z = 0.4 * (x * x - 0.3 * y * y) + 0.05 * (7.3 * k).sin();
        [x + 0.03 * (3.7 * k).sin(), y + 0.03 * (5.1 * k).cos(), z]
    })
}

fn rings(net: &CNet, scheme: SchemeKind) -> Rings {
    Rings::from_cnet(net, scheme, RuleSet::Generated).expect("all schemes have these valences")
}

/// All caps that fit the rings of a scheme, behind `count` rings.
fn caps(rings: &Rings, count: usize) -> impl Iterator<Item = (CapKind, Cap)> {
    CapKind::ALL.into_iter().filter_map(move |kind| {
        Some((kind, Cap::new(rings, CapOptions { rings: count, kind }).ok()?))
    })
}

/// Runs `check` with a name on caps of all schemes, valences and degrees.
fn for_all(valences: &[usize], net: impl Fn(usize) -> CNet, check: impl Fn(&str, &Rings, &Cap)) {
    for (&n, scheme) in valences.iter().flat_map(|n| SchemeKind::ALL.map(|s| (n, s))) {
        let rings = rings(&net(n), scheme);
        for count in [0, 3] {
            for (kind, cap) in caps(&rings, count) {
                let name = format!("{} {} n = {n}, {count} rings", scheme.name(), kind.name());
                check(&name, &rings, &cap);
            }
        }
    }
}

fn steps(count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..=count).map(move |k| k as f64 / count as f64)
}

/// The largest first derivative of a cap along its lines.
fn size(rings: &Rings, cap: &Cap) -> f64 {
    let at = |s: usize, u: f64| norm(cap.eval(rings, s, [u, 0.0]).unwrap().jet.du);
    (0..rings.valence()).flat_map(|s| steps(8).map(move |u| at(s, u))).fold(0.0, f64::max)
}

/// What the sectors on both sides say at distance `u` on line s-1.
fn on_line(rings: &Rings, cap: &Cap, s: usize, u: f64) -> [SurfacePoint; 2] {
    let behind = (s + rings.valence() - 1) % rings.valence();
    [cap.eval(rings, s, [u, 0.0]).unwrap(), cap.eval(rings, behind, [0.0, u]).unwrap()]
}

fn angle(a: Vector, b: Vector) -> f64 {
    norm(cross(a, b)).atan2(dot(a, b))
}

#[test]
fn caps_join_in_themselves_and_with_the_rings() {
    for_all(&VALENCES, crooked, |name, rings, cap| {
        sectors_have_common_tangent_planes(name, rings, cap);
        rings_are_continued_with_first_derivatives(name, rings, cap);
        the_centre_has_one_quadratic(name, rings, cap);
    });
}

/// [KP18-Guided, eq. 6], and position on the lines.
fn sectors_have_common_tangent_planes(name: &str, rings: &Rings, cap: &Cap) {
    let n = rings.valence();
    let c = (std::f64::consts::TAU / n as f64).cos();
    let size = size(rings, cap);
    for (s, u) in (0..n).flat_map(|s| steps(24).map(move |u| (s, u))) {
        let [a, b] = on_line(rings, cap, s, u);
        assert!(norm(sub(a.jet.p, b.jet.p)) < 1e-13, "{name}");
        let along = scale(-2.0 * c * (1.0 - u) * (1.0 - u), a.jet.du);
        let rest = norm(add(add(a.jet.dv, b.jet.du), along)) / size;
        if cap.degree() > 3 {
            assert!(rest < 1e-12, "{name}: {rest:e}");
            assert!(angle(a.normal, b.normal) < 1e-12, "{name}");
        } else {
            // Bi-3 cannot: half a degree at most, far less behind some rings.
            assert!(angle(a.normal, b.normal) < 1e-2, "{name}");
        }
    }
}

/// Position and first derivatives of the ring in front, or of the ring that would be next.
fn rings_are_continued_with_first_derivatives(name: &str, rings: &Rings, cap: &Cap) {
    let hole = rings.sigma().powi(cap.rings() as i32);
    let size = size(rings, cap);
    for (s, t) in (0..rings.valence()).flat_map(|s| steps(24).map(move |t| (s, t))) {
        for at in [[1.0, t], [t, 1.0]] {
            let own = cap.eval(rings, s, at).unwrap().jet;
            let next = rings.eval(s, hole * at[0], hole * at[1]).unwrap().jet;
            assert!(norm(sub(own.p, next.p)) < 1e-13, "{name}");
            for (a, b) in [(own.du, next.du), (own.dv, next.dv)] {
                assert!(norm(sub(a, b)) < 1e-12 * size, "{name}: {:e}", norm(sub(a, b)) / size);
            }
        }
    }
}

/// All sectors have the curvature of one quadratic at the centre: that of the scheme if it has one,
/// over the scheme's limit tangent plane.
fn the_centre_has_one_quadratic(name: &str, rings: &Rings, cap: &Cap) {
    let first = cap.eval(rings, 0, [0.0; 2]).unwrap();
    assert!(norm(sub(first.jet.p, rings.center())) < 1e-15, "{name}");
    assert!(norm(sub(first.normal, rings.normal())) < 1e-12, "{name}");
    let (gauss, mean) = rings.center_curvature().unwrap_or((first.gauss, first.mean));
    for s in 0..rings.valence() {
        let own = cap.eval(rings, s, [0.0; 2]).unwrap();
        let scale = 1.0 + mean.abs();
        assert!((own.gauss - gauss).abs() < 1e-12 * scale * scale, "{name}: {}", own.gauss - gauss);
        assert!((own.mean - mean).abs() < 1e-12 * scale, "{name}: {}", own.mean - mean);
        // The second fundamental form, not only its invariants: see it along line s-1.
        let [a, b] = on_line(rings, cap, s, 0.0);
        let normal_curvature = |d: Vector, dd: Vector| dot(dd, first.normal) / dot(d, d);
        let apart = normal_curvature(a.jet.du, a.jet.duu) - normal_curvature(b.jet.dv, b.jet.dvv);
        assert!(apart.abs() < 1e-11 * scale, "{name}: {apart:e}");
    }
}

/// A planar net gives a planar cap that does not fold.
#[test]
fn caps_of_plane_nets_are_plane_and_regular() {
    for_all(&[3, 5, 6, 8, 10], nets::characteristic_cnet, |name, rings, cap| {
        let size = size(rings, cap);
        for s in [0, rings.valence() - 1] {
            for (u, v) in steps(16).flat_map(|u| steps(16).map(move |v| (u, v))) {
                let jet = cap.eval(rings, s, [u, v]).unwrap().jet;
                assert!(jet.rows().iter().all(|r| r[2] == 0.0), "{name}");
                let area = cross(jet.du, jet.dv)[2] / (size * size);
                assert!(area > 0.02, "{name}: {area} at ({u}, {v})");
            }
        }
    });
}

/// Rings that shrink at another speed; those cut in unequal parts have no caps.
#[test]
#[cfg(feature = "derive")]
fn caps_join_rings_of_any_contraction() {
    use evenlight::{Contraction, scheme::Variant};
    for (n, scheme) in [3, 5, 8].into_iter().flat_map(|n| SchemeKind::ALL.map(|s| (n, s))) {
        let contraction = Contraction::Lambda(0.42);
        if scheme.check_contraction(contraction).is_err() {
            continue;
        }
        let variant = Variant { contraction, ..Variant::default() };
        let rings = Rings::from_cnet(&crooked(n), scheme, variant).expect("they have rules");
        for count in [0, 3] {
            for (kind, cap) in caps(&rings, count) {
                let name = format!("{} {} n = {n}, {count} rings", scheme.name(), kind.name());
                sectors_have_common_tangent_planes(&name, &rings, &cap);
                rings_are_continued_with_first_derivatives(&name, &rings, &cap);
                the_centre_has_one_quadratic(&name, &rings, &cap);
            }
        }
        let bi6 = Cap::new(&rings, CapOptions { rings: 3, kind: CapKind::Bi6 });
        assert_eq!(bi6.is_ok(), rings.patches_per_sector() == 3, "{}", scheme.name());
    }
}

/// Behind l rings of a characteristic net the cap is that of none, scaled by lambda^l.
#[test]
fn caps_of_characteristic_nets_shrink_by_lambda() {
    for n in [3, 5, 8] {
        let rings = rings(&nets::characteristic_cnet(n), SchemeKind::CatmullClark);
        for (large, small) in caps(&rings, 0).zip(caps(&rings, 7)) {
            let factor = rings.lambda().powi(7);
            for which in 0..large.1.patches_per_sector() {
                let [a, b] = [&large.1, &small.1].map(|cap| cap.patch(&rings, 1, which).unwrap());
                for (a, b) in a.coefs().iter().zip(b.coefs()) {
                    assert!(norm(sub(scale(factor, *a), *b)) < 1e-13 * factor, "n = {n}");
                }
            }
        }
    }
}

#[test]
fn caps_commute_with_affine_maps_and_with_turning() {
    let image = |[x, y, z]: [f64; 3]| [2.0 * x - z + 3.0, 0.5 * y + 0.3 * x, z - 0.7 * y + 1.0];
    for (n, scheme) in [3, 5, 6].into_iter().flat_map(|n| SchemeKind::ALL.map(|s| (n, s))) {
        let net = crooked(n);
        let mut turned = net.clone();
        turned.sectors.rotate_left(1);
        let all = [net.clone(), nets::net_of(&net, image), turned].map(|net| rings(&net, scheme));
        for kind in CapKind::ALL {
            let options = CapOptions { rings: 2, kind };
            let [Ok(cap), Ok(mapped), Ok(turned)] = all.each_ref().map(|r| Cap::new(r, options))
            else {
                continue;
            };
            let name = format!("{} {} n = {n}", scheme.name(), kind.name());
            for which in 0..cap.patches_per_sector() {
                let own = cap.patch(&all[0], 1, which).unwrap();
                let mapped = mapped.patch(&all[1], 1, which).unwrap();
                let turned = turned.patch(&all[2], 0, which).unwrap();
                for (k, &p) in own.coefs().iter().enumerate() {
                    assert!(norm(sub(image(p), mapped.coefs()[k])) < 1e-12, "{name}");
                    assert!(norm(sub(p, turned.coefs()[k])) < 1e-12, "{name}");
                }
            }
        }
    }
}

/// However deep a cap lies, its curvature is exact: rings and guide tend to a quadratic, so caps
/// behind 90 and 91 rings are alike.
#[test]
fn deep_caps_are_as_exact_as_others() {
    for n in [3, 5, 8] {
        let rings = rings(&crooked(n), SchemeKind::Guided6);
        let cap = |rings_before: usize| {
            let options = CapOptions { rings: rings_before, kind: CapKind::Auto };
            Cap::new(&rings, options).expect("bi-6 fits")
        };
        let (a, b) = (cap(90), cap(91));
        for (u, v) in steps(8).flat_map(|u| steps(8).map(move |v| (u, v))) {
            let [a, b] = [&a, &b].map(|cap| cap.eval(&rings, 1, [u, v]).unwrap().mean);
            assert!((a - b).abs() < 1e-12, "n = {n}: {a} {b}");
        }
    }
}

/// The paper's cap behind two bi-6 rings, computed by an independent program.
#[test]
fn bi_6_caps_of_guided_rings_are_the_prototypes() {
    for n in [3, 5, 6, 7, 8, 9, 10] {
        let golden = golden::guided(n);
        let rings = rings(&golden::cnet(&golden, n), SchemeKind::Guided6);
        let cap = Cap::new(&rings, CapOptions { rings: 2, kind: CapKind::Bi6 }).expect("it fits");
        for (k, &p) in cap.patch(&rings, 1, 0).unwrap().coefs().iter().enumerate() {
            let expected = golden::point(&golden["cap_bi6"][k / 7][k % 7]);
            assert!(norm(sub(p, expected)) < 1e-12, "n = {n}, {k}: {p:?} {expected:?}");
        }
    }
}

#[test]
fn caps_that_cannot_join_are_refused() {
    let guided = rings(&crooked(5), SchemeKind::Guided5);
    let error = Cap::new(&guided, CapOptions { rings: 1, kind: CapKind::Bi4 }).unwrap_err();
    assert_eq!(error, CapError::Degree { scheme: SchemeKind::Guided5, ring: 5, cap: 4 });
    assert!(error.to_string().contains("take bi-5 or more"), "{error}");
}
