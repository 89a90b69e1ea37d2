//! The quadratic q of Quadratic-Attraction subdivision: that it is one for all sectors, that the
//! surface tends to it with bounded curvature, and that a designer may change it.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod common;
mod nets;

use std::path::Path;
use std::sync::Arc;

use common::Random;
use evenlight::analyse::continuity::continuity;
use evenlight::analyse::curvature::{Range, RingCurvature, curvature_over};
use evenlight::net::{CNet, DNet, Quadratic};
use evenlight::patch::Jet;
use evenlight::point::{Vector, add, add_scaled, dot, norm, scale, sub};
use evenlight::rings::Rings;
use evenlight::surface::Role;
use evenlight::{Cage, Point, RuleSet, SchemeKind, Surface};

const SCHEMES: [SchemeKind; 2] = [SchemeKind::Qas3, SchemeKind::Qas4];
const VALENCES: [usize; 13] = [3, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

// ---------------------------------------------------------------- bounded curvature

/// The valences of the obstacle course, and per valence rho and the width of the band of H.
///
/// rho is the larger of lambda and of the largest eigenvalue of M_d over lambda^2
/// (tests/spectrum.rs): what the curvature of ring l owes to the control net, not to q, is of the
/// size rho^l. The widths, for QAS3 and QAS4, are parts of sqrt(k1^2 + k2^2) of q, measured over
/// the obstacle course and rounded up: even where only q is left, a ring of bi-3 or bi-4 patches
/// has not the curvature of q in every direction. (Where lines meet at other angles than on the
/// obstacle course, as on our blobs, the band is up to twice as wide.)
const BANDS: [(usize, f64, [f64; 2]); 7] = [
    (3, 0.9383, [0.055, 0.031]),
    (5, 0.5933, [0.046, 0.005]),
    (6, 0.5797, [0.080, 0.016]),
    (7, 0.5987, [0.105, 0.033]),
    (8, 0.6114, [0.128, 0.060]),
    (9, 0.6203, [0.144, 0.083]),
    (10, 0.6268, [0.160, 0.110]),
];

/// The curvature ranges of rings 1 to `rings` around a point.
fn ring_ranges(surface: &Surface, point: usize, rings: usize) -> Vec<RingCurvature> {
    let mut found = vec![RingCurvature { gauss: Range::EMPTY, mean: Range::EMPTY }; rings];
    for place in surface.patch_places(rings).filter(|place| place.point == Some(point)) {
        let Role::Ring(ring) = place.role else { continue };
        let here = curvature_over(surface, &place);
        found[ring].mean = found[ring].mean.union(here.mean);
        found[ring].gauss = found[ring].gauss.union(here.gauss);
    }
    found
}

/// The largest absolute value in some ranges.
fn largest(ranges: &[Range]) -> f64 {
    ranges.iter().map(|r| r.max.abs().max(r.min.abs())).fold(0.0, f64::max)
}

/// Asserts for K and H over rings 1 to 40: the ends of their ranges move by less and less from
/// ring to ring, as rho^l says, and so converge; they converge to a band that contains the value
/// of q and is as narrow as [`BANDS`] says.
fn assert_bounded_curvature(name: &str, surface: &Surface, point: usize) {
    let rings = surface.rings(point).unwrap();
    let Some(&(_, rho, widths)) = BANDS.iter().find(|band| band.0 == rings.valence()) else {
        return;
    };
    let decay = |l: usize| rho.powi(l as i32);
    let (k, h) = rings.center_curvature().expect("the schemes have a quadratic");
    let found = ring_ranges(surface, point, 40);
    let [means, gausses] = [true, false].map(|of_h| -> Vec<Range> {
        found.iter().map(|ring| if of_h { ring.mean } else { ring.gauss }).collect()
    });
    for (ranges, of_q) in [(&means, h), (&gausses, k)] {
        let size = largest(ranges);
        for (l, pair) in ranges.windows(2).enumerate() {
            let moved = (pair[1].max - pair[0].max).abs().max((pair[1].min - pair[0].min).abs());
            let bound = size * (SLACK * decay(l + 1) + 1e-12);
            assert!(moved <= bound, "{name}: {moved:e} after ring {}, bound {bound:e}", l + 1);
        }
        let (last, slack) = (ranges[39], SLACK * size * decay(40));
        let is_inside = last.min - slack <= of_q && of_q <= last.max + slack;
        assert!(is_inside, "{name}: {of_q} is not in {last:?}");
    }
    let width = widths[usize::from(surface.options().scheme == SchemeKind::Qas4)];
    let size_of_q = (4.0 * h * h - 2.0 * k).max(0.0).sqrt();
    let bound = width * size_of_q + SLACK * largest(&means) * decay(40);
    let length = means[39].length();
    assert!(length <= bound, "{name}: the band of H is {length} long, bound {bound}");
}

/// The factor of rho^l, as a part of the largest curvature; measured up to 6.2.
const SLACK: f64 = 10.0;

fn assert_bounded_curvature_of(name: &str, cage: &Arc<Cage>) {
    for scheme in SCHEMES {
        let surface = common::surface(cage, scheme);
        for point in 0..surface.extraordinary_points().len().min(4) {
            let name = format!("{name}, {}, point {point}", scheme.name());
            assert_bounded_curvature(&name, &surface, point);
        }
    }
}

#[test]
fn curvature_stays_bounded_and_its_ranges_converge_to_a_band_around_that_of_q() {
    for family in ["saddle", "paraboloid_par", "raised_edge_node", "monkey"] {
        for n in [3, 5, 8, 10] {
            let name = format!("obstacle/{family}_n{n}.obj");
            assert_bounded_curvature_of(&name, &common::cage(&name));
        }
    }
}

/// At valence 3, where rho is .938, forty rings are not many: after 400, 1e-11 of the net is left.
#[test]
fn at_valence_3_the_band_is_reached_slowly() {
    for name in ["pillow_n5", "polycube_corner_m2", "saddle_n3", "cone_planar_sectors_n3"] {
        let cage = common::cage(&format!("obstacle/{name}.obj"));
        for (scheme, width) in SCHEMES.into_iter().zip(BANDS[0].2) {
            let surface = common::surface(&cage, scheme);
            let points = surface.extraordinary_points();
            let point = points.iter().position(|point| point.valence == 3).unwrap();
            let rings = surface.rings(point).unwrap();
            let (k, h) = rings.center_curvature().unwrap();
            let mut band = Range::EMPTY;
            for (s, i, j) in (0..3 * 17 * 17).map(|m| (m / 289, m / 17 % 17, m % 17)) {
                let [a, b] = [i, j].map(|x| x as f64 / 16.0 * 0.5_f64.powi(400));
                if i.max(j) > 8 {
                    band = band.with(rings.eval(s, a, b).unwrap().mean);
                }
            }
            assert!(band.min <= h && h <= band.max, "{name}: {h} is not in {band:?}");
            let size_of_q = (4.0 * h * h - 2.0 * k).sqrt();
            assert!(band.length() <= width * size_of_q, "{name}: {band:?} around {h}");
        }
    }
}

/// The same on the whole obstacle course but for its planes: half a minute.
#[test]
#[ignore = "slow"]
fn curvature_stays_bounded_on_all_obstacles() {
    let course = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/meshes/obstacle");
    for (name, cage) in common::all_cages() {
        let is_plane = name.starts_with("flat") || name.starts_with("linear");
        if !is_plane && course.join(&name).exists() {
            assert_bounded_curvature_of(&name, &cage);
        }
    }
}

/// Catmull-Clark's eigenvalues of Fourier mode 2 and (the second largest) of mode 0 over
/// lambda^2: a saddle has the one, a convex net the other.
fn catmull_clark_growth(n: usize) -> [f64; 2] {
    let count = n as f64;
    let eigenvalue = |c: f64| (c + 5.0 + ((c + 1.0) * (c + 9.0)).sqrt()) / 16.0;
    let angle = std::f64::consts::TAU / count;
    let lambda = eigenvalue(angle.cos());
    // x^2 - (3/4 - 7/(4n)) x + (1 - 3/n) / 16 = 0, left over from the eigenvalue 1.
    let (sum, product) = (0.75 - 1.75 / count, (1.0 - 3.0 / count) / 16.0);
    let second = 0.5 * (sum + (sum * sum - 4.0 * product).sqrt());
    [eigenvalue((2.0 * angle).cos()), second].map(|mu| mu / (lambda * lambda))
}

/// ... while Catmull-Clark's grow like (mu/lambda^2)^l, mu the eigenvalue of the net's Fourier
/// mode; at valence 3, where mu/lambda^2 is .991, they die out, and the surface has a flat point.
#[test]
fn catmull_clark_curvature_grows_as_its_spectrum_says() {
    for n in [3, 5, 6, 7, 8, 9, 10] {
        let [of_saddles, of_convex] = catmull_clark_growth(n);
        let nets = [("saddle", of_saddles), ("paraboloid", of_convex), ("cone_flat", of_convex)];
        for (family, growth) in nets.into_iter().filter(|net| n > 3 || net.0 != "saddle") {
            let cage = common::cage(&format!("obstacle/{family}_n{n}.obj"));
            let found = ring_ranges(&common::surface(&cage, SchemeKind::CatmullClark), 0, 40);
            let lengths = |k: usize| [found[k].mean.length(), found[k].gauss.length().sqrt()];
            for (late, early) in lengths(39).into_iter().zip(lengths(29)) {
                let rate = (late / early).powf(0.1);
                assert!((rate / growth - 1.0).abs() < 2e-3, "{family}_n{n}: {rate} {growth}");
            }
            assert_eq!(growth > 1.0, n > 3);
        }
    }
}

// ---------------------------------------------------------------- one quadratic, affine maps

fn random_vector(random: &mut Random) -> Vector {
    [0, 1, 2].map(|_| random.unit() - 0.5)
}

fn random_cnet(n: usize, random: &mut Random) -> CNet {
    let mut point = || random_vector(random);
    CNet { center: point(), sectors: (0..n).map(|_| std::array::from_fn(|_| point())).collect() }
}

/// A random quadratic with a tangent plane far from degenerate.
fn random_quadratic(random: &mut Random) -> Quadratic {
    let linear = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.0, 2.0)];
    Quadratic { coefs: linear.map(|(u, v)| add([u, v, 0.0], scale(0.5, random_vector(random)))) }
}

/// The largest distance between coefficients, relative to the size of the quadratic.
fn defect(a: &Quadratic, b: &Quadratic) -> f64 {
    let size = a.coefs.iter().map(|&p| norm(sub(p, a.center()))).fold(0.0, f64::max);
    let apart = a.coefs.iter().zip(&b.coefs).map(|(&p, &q)| norm(sub(p, q)));
    apart.fold(0.0, f64::max) / size
}

/// q is the same quadratic for every sector: going on from sector to sector it comes back, and
/// a net that is numbered from sector s has q as sector s sees it.
#[test]
fn the_default_quadratic_is_common_to_all_sectors() {
    let mut random = Random::new(3);
    for set in [RuleSet::Generated, RuleSet::Published] {
        for (scheme, n) in SCHEMES.into_iter().flat_map(|x| VALENCES.map(|n| (x, n))) {
            let cnet = random_cnet(n, &mut random);
            let Some(rings) = Rings::from_cnet(&cnet, scheme, set) else {
                assert!(set == RuleSet::Published && n > 10);
                continue;
            };
            let q = *rings.quadratic().unwrap();
            assert_eq!(q.center(), rings.center());
            for s in 0..n {
                let back = q.in_sector(n, s).unwrap().in_sector(n, (n - s) % n).unwrap();
                assert!(defect(&q, &back) <= 1e-13, "n = {n}, s = {s}: {:e}", defect(&q, &back));
                let mut turned = cnet.clone();
                turned.sectors.rotate_left(s);
                let found = Rings::from_cnet(&turned, scheme, set).unwrap();
                let found = defect(&q.in_sector(n, s).unwrap(), found.quadratic().unwrap());
                assert!(found <= 1e-13, "n = {n}, s = {s}: {found:e}");
            }
        }
    }
}

/// An affine map, linear part and translation.
const MAP: ([Vector; 3], Vector) =
    ([[2.0, -0.5, 0.25], [0.0, 0.75, 1.0], [-0.3, 0.1, 1.5]], [3.0, -1.0, 0.5]);

fn linear(r: Vector) -> Vector {
    MAP.0.map(|row| dot(row, r))
}

fn mapped(p: Point) -> Point {
    add(linear(p), MAP.1)
}

/// The jet of q at its centre, in the coordinates of sector 0.
fn jet_of(q: &Quadratic) -> Jet {
    let [p, q2, q3, q4, q5, q6] = q.coefs;
    let second = |end: Point, middle: Point| scale(20.0, add(sub(end, middle), sub(p, middle)));
    Jet {
        p,
        du: scale(5.0, sub(q2, p)),
        dv: scale(5.0, sub(q4, p)),
        duu: second(q3, q2),
        duv: scale(20.0, sub(add(p, q5), add(q2, q4))),
        dvv: second(q6, q4),
    }
}

/// Position, normal, K and H at the centre are those of q, whatever the net, and so an affine
/// image of q gives the affine image.
#[test]
fn the_centre_has_the_jet_of_the_quadratic() {
    let mut random = Random::new(5);
    for (scheme, n) in SCHEMES.into_iter().flat_map(|x| VALENCES.map(|n| (x, n))) {
        let rings = Rings::from_cnet(&random_cnet(n, &mut random), scheme, RuleSet::Generated);
        let q = random_quadratic(&mut random);
        for q in [q, q.transformed(MAP.0, MAP.1)] {
            let moved = rings.as_ref().unwrap().with_quadratic(&q).unwrap();
            let (jet, found) = (jet_of(&q), moved.eval(0, 0.0, 0.0).unwrap());
            let (k, h) = jet.curvature();
            assert_eq!(found.jet.p, q.center());
            assert!(defect(&q, moved.quadratic().unwrap()) < 1e-15);
            assert!(norm(sub(found.normal, jet.normal())) < 1e-12, "n = {n}");
            assert!((found.gauss - k).abs() < 1e-12 * (h * h + k.abs()), "n = {n}");
            assert!((found.mean - h).abs() < 1e-12 * (h.abs() + k.abs().sqrt()), "n = {n}");
        }
        let image = jet_of(&q.transformed(MAP.0, MAP.1));
        for (a, b) in jet_of(&q).rows()[1..].iter().zip(&image.rows()[1..]) {
            assert!(norm(sub(linear(*a), *b)) < 1e-12, "n = {n}");
        }
    }
}

/// The image of net and q has the image of the surface; and deep inside, the image of q alone.
#[test]
fn affine_images_of_q_give_affine_images_of_the_limit_behaviour() {
    let mut random = Random::new(7);
    for (scheme, n) in SCHEMES.into_iter().flat_map(|x| VALENCES.map(|n| (x, n))) {
        let (cnet, q) = (random_cnet(n, &mut random), random_quadratic(&mut random));
        let on = |cnet: &CNet, q: &Quadratic| {
            Rings::from_cnet(cnet, scheme, RuleSet::Generated).unwrap().with_quadratic(q).unwrap()
        };
        let image_of_q = q.transformed(MAP.0, MAP.1);
        let rings = on(&cnet, &q);
        let image_of_both = on(&nets::net_of(&cnet, mapped), &image_of_q);
        let image_of_one = on(&cnet, &image_of_q);
        for (s, a, b) in [(0, 1.0, 0.3), (n - 1, 0.25, 0.4), (n / 2, 1e-3, 2e-3)] {
            let (p, image) =
                (rings.eval(s, a, b).unwrap().jet, image_of_both.eval(s, a, b).unwrap().jet);
            assert!(norm(sub(mapped(p.p), image.p)) < 1e-13 * 10.0, "n = {n}");
            assert!(norm(sub(linear(p.du), image.du)) < 1e-11 * norm(p.du), "n = {n}");
        }
        for (s, a, b) in [(0, 1.0, 0.3), (n - 1, 0.6, 0.8), (n / 2, 0.0, 0.7)] {
            let [a, b] = [a, b].map(|x| x * 0.5_f64.powi(60));
            let (p, image) = (rings.eval(s, a, b).unwrap(), image_of_one.eval(s, a, b).unwrap());
            for (x, y) in [(p.jet.du, image.jet.du), (p.jet.dv, image.jet.dv)] {
                assert!(norm(sub(linear(x), y)) < 1e-9 * norm(y), "n = {n}");
            }
        }
    }
}

// ---------------------------------------------------------------- the limit of the rings

/// The characteristic map chi at (a,b) of sector s, in the coordinates of sector 0: what is left
/// of a linear q deep inside, where it is scaled up by lambda^-l.
fn characteristic_map(rings: &Rings) -> impl Fn(usize, f64, f64) -> [f64; 2] + use<> {
    let linear = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.0, 2.0)];
    let q = Quadratic { coefs: linear.map(|(u, v)| [0.2 * u, 0.2 * v, 0.0]) };
    let deep = rings.with_quadratic(&q).expect("the schemes have a quadratic");
    let up = deep.lambda().powi(-100);
    move |s, a, b| {
        let [a, b] = [a, b].map(|x| x * 0.5_f64.powi(100));
        let [u, v, _] = deep.eval(s, a, b).unwrap().jet.p;
        [up * u, up * v]
    }
}

/// (p - q(0)) / lambda^l tends to the linear part of q at chi, the same for all nets, and what is
/// left, divided by lambda^(2l), to the quadratic part, up to the band of a few thousandths that
/// patches of degree 3 and 4 leave.
#[test]
fn deep_rings_are_the_quadratic_over_the_characteristic_map() {
    let mut random = Random::new(9);
    for (scheme, n) in SCHEMES.into_iter().flat_map(|x| [3, 5, 6, 8, 10, 16].map(|n| (x, n))) {
        let mut q = random_quadratic(&mut random);
        q.coefs[0] = [0.0; 3]; // so that positions are exact relative to the centre
        let on = |cnet: CNet| Rings::from_cnet(&cnet, scheme, RuleSet::Generated).unwrap();
        let nets = [0, 1].map(|_| on(random_cnet(n, &mut random)));
        let chi = characteristic_map(&nets[0]);
        let surfaces = nets.each_ref().map(|rings| rings.with_quadratic(&q).unwrap());
        // At valence 3 rho is .938, and lambda^2 soon below rounding.
        let (l, first, second, between) = match n {
            3 => (20, 1e-6, 0.6, 1e-2),
            _ => (40, 1e-6, 2.5e-3, 1e-5),
        };
        let up = surfaces[0].lambda().powi(-l);
        let jet = jet_of(&q);
        let mut errors = [0.0_f64; 3];
        let mut sizes = [0.0_f64; 2];
        for s in 0..n {
            for (a, b) in [(1.0, 0.0), (1.0, 0.5), (1.0, 1.0), (0.75, 0.25), (0.6, 0.9)] {
                let [u, v] = chi(s, a, b);
                let linear = add(scale(u, jet.du), scale(v, jet.dv));
                let mut quadratic = scale(0.5 * u * u, jet.duu);
                add_scaled(&mut quadratic, u * v, jet.duv);
                add_scaled(&mut quadratic, 0.5 * v * v, jet.dvv);
                let [a, b] = [a, b].map(|x| x * 0.5_f64.powi(l));
                let left = surfaces
                    .each_ref()
                    .map(|rings| sub(scale(up, rings.eval(s, a, b).unwrap().jet.p), linear));
                let rest = left.map(|r| scale(up, r));
                let found =
                    [norm(left[0]), norm(sub(rest[0], quadratic)), norm(sub(rest[0], rest[1]))];
                errors = std::array::from_fn(|k| errors[k].max(found[k]));
                sizes = [sizes[0].max(norm(linear)), sizes[1].max(norm(quadratic))];
            }
        }
        let found = [errors[0] / sizes[0], errors[1] / sizes[1], errors[2] / sizes[1]];
        let small = found[0] <= first && found[1] <= second && found[2] <= between;
        assert!(small, "{}, n = {n}: {found:?}", scheme.name());
    }
}

// ---------------------------------------------------------------- reproduction

/// Nets that are linear functions of the characteristic net: q is that linear function, and the
/// rings only shrink.
#[test]
fn linear_functions_are_reproduced() {
    for (scheme, n) in SCHEMES.into_iter().flat_map(|x| VALENCES.map(|n| (x, n))) {
        let cnet = nets::net_of(&nets::characteristic_cnet(n), mapped);
        let rings = Rings::from_cnet(&cnet, scheme, RuleSet::Generated).unwrap();
        let jet = jet_of(rings.quadratic().unwrap());
        assert!(norm(sub(jet.p, MAP.1)) < 1e-14 * 10.0, "n = {n}");
        for second in [jet.duu, jet.duv, jet.dvv] {
            assert!(norm(second) < 1e-11 * norm(jet.du), "n = {n}: {second:?}");
        }
        let lambda = rings.lambda();
        for (a, b) in [(1.0, 0.2), (0.7, 0.9), (0.0, 0.8)] {
            let outer = sub(rings.eval(0, a, b).unwrap().jet.p, MAP.1);
            for l in 1..12 {
                let [a, b] = [a, b].map(|x| x * 0.5_f64.powi(l));
                let inner = sub(rings.eval(0, a, b).unwrap().jet.p, MAP.1);
                assert!(norm(sub(inner, scale(lambda.powi(l), outer))) < 1e-13, "n = {n}");
            }
        }
    }
}

/// Every planar net, however distorted, has q and the surface in its plane.
#[test]
fn planar_nets_keep_q_in_their_plane() {
    let mut random = Random::new(11);
    let height = |[x, y, _]: Point| 0.25 * x - 0.5 * y + 2.0;
    for (scheme, n) in SCHEMES.into_iter().flat_map(|x| VALENCES.map(|n| (x, n))) {
        let cnet = nets::net_of(&random_cnet(n, &mut random), |p| [p[0], p[1], height(p)]);
        let rings = Rings::from_cnet(&cnet, scheme, RuleSet::Generated).unwrap();
        for p in rings.quadratic().unwrap().coefs {
            assert!((p[2] - height(p)).abs() < 1e-13, "n = {n}");
        }
        for p in (0..8).flat_map(|l| rings.patches(l).unwrap()).flat_map(|p| p.coefs().to_vec()) {
            assert!((p[2] - height(p)).abs() < 1e-13, "n = {n}");
        }
    }
}

// ---------------------------------------------------------------- joins and design

/// QAS3 as QAS4: the rings join each other and the surface around them C2, with the default q
/// and with any other.
#[test]
fn rings_join_c2_with_each_other_and_with_the_surround_whatever_q() {
    for name in
        ["obstacle/saddle_n7.obj", "obstacle/pillow_n5.obj", "obstacle/frame_tet_tight_n6.obj"]
    {
        for scheme in SCHEMES {
            let mut surface = common::surface(&common::cage(name), scheme);
            for point in 0..surface.extraordinary_points().len() {
                let jumps = continuity(&surface, 6, 3).unwrap().all;
                assert!(jumps.parametric <= 1e-11, "{name}: {jumps:?}");
                let q = *surface.rings(point).unwrap().quadratic().unwrap();
                let wider =
                    q.transformed([[1.1, 0.0, 0.0], [0.0, 0.9, 0.2], [0.0, 0.1, 1.0]], [0.1; 3]);
                assert!(surface.set_quadratic(point, &wider));
                assert_eq!(surface.rings(point).unwrap().center(), wider.center());
            }
            let jumps = continuity(&surface, 6, 3).unwrap().all;
            assert!(jumps.parametric <= 1e-11, "{name}, changed: {jumps:?}");
        }
    }
}

/// A change of q leaves the outer border of ring 1 with its first and second derivatives.
#[test]
fn a_change_of_q_keeps_the_outer_border_up_to_second_derivatives() {
    let mut random = Random::new(13);
    for (scheme, n) in SCHEMES.into_iter().flat_map(|x| VALENCES.map(|n| (x, n))) {
        let rings = Rings::from_cnet(&random_cnet(n, &mut random), scheme, RuleSet::Generated);
        let rings = rings.unwrap();
        let changed = rings.with_quadratic(&random_quadratic(&mut random)).unwrap();
        for (s, k) in (0..n).flat_map(|s| (0..=8).map(move |k| (s, k))) {
            let t = f64::from(k) / 8.0;
            for (a, b) in [(1.0, t), (t, 1.0)] {
                let (p, q) = (rings.eval(s, a, b).unwrap().jet, changed.eval(s, a, b).unwrap().jet);
                for (x, y) in p.rows().iter().zip(q.rows()) {
                    assert!(norm(sub(*x, y)) < 1e-12, "n = {n}: {x:?} {y:?}");
                }
            }
        }
        let inside =
            sub(rings.eval(0, 0.3, 0.3).unwrap().jet.p, changed.eval(0, 0.3, 0.3).unwrap().jet.p);
        assert!(norm(inside) > 1e-3, "the change is seen inside");
        let back = changed.with_quadratic(rings.quadratic().unwrap()).unwrap();
        for (p, q) in rings.patches(3).unwrap().iter().zip(back.patches(3).unwrap()) {
            assert!(p.coefs().iter().zip(q.coefs()).all(|(x, y)| norm(sub(*x, *y)) < 1e-13));
        }
    }
}

// ---------------------------------------------------------------- odd input

#[test]
fn valences_without_rules_and_schemes_without_quadratics_say_so() {
    let q = Quadratic { coefs: [[0.0; 3]; 6] };
    for scheme in SCHEMES {
        for n in [0, 1, 2, 4, 17, 1000] {
            let cnet = CNet { center: [0.0; 3], sectors: vec![[[0.0; 3]; 6]; n] };
            assert!(Rings::from_cnet(&cnet, scheme, RuleSet::Generated).is_none());
            if n > 0 {
                let dnet = DNet { sectors: vec![[[0.0; 3]; 12]; n] };
                assert!(Rings::from_dnet(&dnet, scheme, RuleSet::Generated).is_none());
            }
        }
    }
    let mut random = Random::new(15);
    for scheme in SchemeKind::ALL.into_iter().filter(|scheme| !scheme.has_quadratic()) {
        let rings = Rings::from_cnet(&random_cnet(5, &mut random), scheme, RuleSet::Generated);
        let rings = rings.unwrap();
        assert!(rings.quadratic().is_none() && rings.with_quadratic(&q).is_none());
        assert_eq!(rings.center_curvature().is_some(), scheme.has_center_curvature());
    }
}

/// A quadratic in one point, in one line, with numbers that are none.
#[test]
fn degenerate_quadratics_are_evaluated_without_panic() {
    let mut random = Random::new(17);
    let line = std::array::from_fn(|k| [k as f64, 2.0 * k as f64, 0.0]);
    for coefs in [[[0.0; 3]; 6], line, [[f64::NAN; 3]; 6], [[f64::INFINITY; 3]; 6], [[1e300; 3]; 6]]
    {
        for scheme in SCHEMES {
            let rings = Rings::from_cnet(&random_cnet(5, &mut random), scheme, RuleSet::Generated);
            let rings = rings.unwrap().with_quadratic(&Quadratic { coefs }).unwrap();
            assert!(rings.center_curvature().is_none());
            assert!(rings.eval(0, 0.0, 0.0).unwrap().normal.iter().all(|x| x.is_nan()));
            for depth in [0, 1, 10, 100] {
                let t = 0.5_f64.powi(depth);
                rings.eval(2, t, 0.3 * t).unwrap();
            }
            if coefs[0] == [0.0; 3] {
                let p = rings.eval(1, 0.7, 0.2).unwrap().jet.p;
                assert!(p.iter().all(|x| x.is_finite()));
            }
        }
    }
}
