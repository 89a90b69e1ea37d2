//! Stencils: applied to the values of the cage they are what `Surface` says, for every scheme, tag and
//! kind of primvar; and nothing that they are asked for makes them panic.
#![allow(clippy::unwrap_used, reason = "a test that cannot make its cages fails")]

mod common;

use std::sync::Arc;

use common::{Random, fans, options};
use evenlight::cap::{CapKind, CapOptions};
use evenlight::mesh::{BoundaryRule, FaceVaryingRule, Interpolation, Primvar};
use evenlight::stencil::{Order, StencilBuilder, StencilError, Stencils};
use evenlight::surface::{CreaseRings, Role};
use evenlight::{Cage, FaceId, Mesh, QuadId, SchemeKind, Surface, SurfaceOptions};

/// What results may differ by, as a part of the sum of |weight| |value|.
const ROUNDING: f64 = 1e-12;

type Place = (QuadId, f64, f64);

/// Closed and open bodies, and every kind of feature: creases, corners, darts, boundaries, holes,
/// polygons.
fn cages() -> Vec<(String, Arc<Cage>)> {
    let plain = ["own_polygons.obj", "obstacle/saddle_n5.obj", "obstacle/pillow_n3.obj"];
    let plain = plain.map(|name| (name.to_owned(), common::cage(name)));
    let starred = [(3, &[0][..]), (5, &[0, 1]), (5, &[0, 2, 3]), (7, &[0, 3]), (4, &[1])];
    let starred = starred.map(|(n, lines)| {
        let cage = Cage::new(fans::starred(n, lines, 5)).unwrap();
        (format!("star {n} {lines:?}"), Arc::new(cage))
    });
    common::feature_cages().into_iter().chain(plain).chain(starred).collect()
}

/// Options of every scheme, and fair rings beside creases.
fn all_options() -> Vec<SurfaceOptions> {
    let schemes = SchemeKind::ALL.into_iter().map(options);
    let fair = SurfaceOptions { creases: CreaseRings::Fair, ..SurfaceOptions::default() };
    schemes.chain([fair]).collect()
}

/// Places on every covered quad: inside, on sides and near corners at several depths.
fn places(surface: &Surface) -> Vec<Place> {
    let mut random = Random::new(7);
    let mut places = Vec::new();
    for quad in (0..surface.num_quads() as u32).map(QuadId) {
        if surface.is_omitted(surface.face_of(quad).0) {
            continue;
        }
        places.extend((0..2).map(|_| (quad, random.unit(), random.unit())));
        places.push((quad, 0.0, random.unit()));
        places.push((quad, 1.0, 0.5));
        for depth in [1e-2, 1e-7] {
            let near = |corner: f64, by: f64| if corner == 0.0 { by } else { 1.0 - by };
            let [a, b] = [0, 1].map(|_| random.below(2) as f64);
            places.push((quad, near(a, depth), near(b, 0.6 * depth)));
        }
    }
    places
}

/// What the rows of places are made of before anything cancels, by the largest weight of a vertex: the
/// factors of derivatives in the pieces of their quads.
///
/// In ring l around a point derivatives of order k are (lambda / sigma^k)^l times those of ring 0. A
/// part of them may cancel: the tangents along a crease have no second derivative along it.
fn scales(surface: &Surface, places: &[Place], order: Order) -> Vec<f64> {
    let of_place = |&(quad, u, v): &Place| {
        let points = surface.extraordinary_points().iter().enumerate();
        let sectors = points.flat_map(|(p, point)| point.sectors.iter().map(move |s| (p, s)));
        let mut sectors = sectors.filter(|(_, sector)| sector.quad == quad);
        let inside = sectors.find_map(|(p, sector)| {
            let along = sector.along.map(|[x, y]| {
                let part = (u - sector.center[0]) * x + (v - sector.center[1]) * y;
                part / (x * x + y * y)
            });
            let is_inside = along.iter().all(|x| (0.0..=1.0).contains(x));
            let zoom = 1.0 / sector.along[0].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            is_inside.then(|| (p, along[0].max(along[1]), zoom))
        });
        let Some((p, distance, zoom)) = inside else { return [1.0, 4.0, 16.0] };
        let (lambda, sigma) = (surface.rings(p).lambda(), surface.rings(p).sigma());
        let ring = if distance > 0.0 { (distance.ln() / sigma.ln()).floor() } else { 0.0 };
        let of_order = |k: i32| (lambda / sigma.powi(k)).powf(ring) * (4.0 * zoom).powi(k);
        [1.0, of_order(1), of_order(2)]
    };
    let orders = &[0, 1, 1, 2, 2, 2][..order.rows()];
    places.iter().map(of_place).flat_map(|scale| orders.iter().map(move |&k| scale[k])).collect()
}

/// Whether results are as expected, by the scales of the rows; NaN agrees with NaN.
fn check<const N: usize>(
    name: &str,
    stencils: &Stencils,
    scales: &[f64],
    values: &[[f64; N]],
    expected: &[[f64; N]],
) {
    let results = stencils.apply(values).unwrap();
    assert_eq!([results.len(), scales.len()], [expected.len(); 2], "{name}");
    let largest = values.as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for (k, (a, b)) in results.iter().zip(expected).enumerate() {
        for (x, y) in a.iter().zip(b) {
            let bound = ROUNDING * largest * scales[k];
            let is_same = x.is_nan() && y.is_nan() || (x - y).abs() <= bound;
            assert!(is_same, "{name}, row {k}: {a:?}, not {b:?}, bound {bound:e}");
        }
    }
}

/// Rows of positions sum to 1, those of derivatives to 0.
fn check_sums(name: &str, stencils: &Stencils, order: Order, scales: &[f64]) {
    for (k, (columns, weights)) in stencils.rows().enumerate() {
        assert!(columns.windows(2).all(|pair| pair[0] < pair[1]), "{name}, row {k}: {columns:?}");
        let expected = if k % order.rows() == 0 { 1.0 } else { 0.0 };
        let sum = weights.iter().sum::<f64>();
        let is_exact = (sum - expected).abs() <= 1e-13 * scales[k] || sum.is_nan();
        assert!(is_exact, "{name}, row {k}: {sum}, scale {}", scales[k]);
    }
}

fn jets(surface: &Surface, places: &[Place]) -> Vec<[f64; 3]> {
    let jet = |&(quad, u, v): &Place| surface.eval_second(quad, u, v).unwrap().rows();
    places.iter().flat_map(jet).collect()
}

#[test]
fn places_are_those_of_the_surface_for_every_scheme_and_feature() {
    for (name, cage) in cages() {
        for options in all_options() {
            let surface = Surface::build(cage.clone(), options).unwrap();
            let name = format!("{name} {} {:?}", options.scheme.name(), options.creases);
            let places = places(&surface);
            let builder = StencilBuilder::new(&surface).unwrap();
            let stencils = builder.places(&places, Order::Second).unwrap();
            let scales = scales(&surface, &places, Order::Second);
            check(&name, &stencils, &scales, cage.positions(), &jets(&surface, &places));
            check_sums(&name, &stencils, Order::Second, &scales);
        }
    }
}

#[test]
fn lower_orders_are_the_first_rows() {
    let surface = common::surface(&common::cage("own_polygons.obj"), SchemeKind::Qas4);
    let places = places(&surface);
    let builder = StencilBuilder::new(&surface).unwrap();
    let all = builder.places(&places, Order::Second).unwrap();
    for order in [Order::Position, Order::First] {
        let some = builder.places(&places, order).unwrap();
        assert_eq!(some.num_rows(), order.rows() * places.len());
        for (k, row) in some.rows().enumerate() {
            let same = 6 * (k / order.rows()) + k % order.rows();
            assert_eq!(all.row(same), Some(row));
        }
    }
}
