//! Evaluation of what is wanted alone: the same numbers as in the full answer, and those of the
//! polynomials by plain sums.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use common::Random;
use evenlight::cap::CapOptions;
use evenlight::patch::{Answer, FirstJet, Jet};
use evenlight::point::{norm, sub};
use evenlight::tessellate::tessellate;
use evenlight::{Point, QuadId, SchemeKind, Surface, SurfacePoint};

const CAGES: [&str; 4] = [
    "obstacle/polycube_corner_m1.obj",
    "obstacle/paraboloid_n5.obj",
    "features/star5_semi_sharp.obj",
    "features/polygons_boundary.obj",
];

fn surfaces() -> Vec<Surface> {
    let cages: Vec<_> = CAGES.into_iter().map(common::cage).collect();
    let of_scheme = |scheme| cages.iter().map(move |cage| common::surface(cage, scheme));
    let mut surfaces: Vec<Surface> = SchemeKind::ALL.into_iter().flat_map(of_scheme).collect();
    for scheme in [SchemeKind::CatmullClark, SchemeKind::Qas4, SchemeKind::Guided5] {
        let mut closed = common::surface(&cages[0], scheme);
        closed.set_caps(Some(CapOptions::default())).unwrap();
        surfaces.push(closed);
    }
    #[cfg(feature = "derive")]
    for scheme in [SchemeKind::Guided3, SchemeKind::Guided5] {
        let contraction = evenlight::Contraction::Half;
        let options = evenlight::SurfaceOptions { contraction, ..common::options(scheme) };
        surfaces.push(Surface::build(cages[0].clone(), options).unwrap());
    }
    surfaces
}

/// Places at random, on corners and sides, close to corners, out of range and of no quad.
fn places(surface: &Surface) -> Vec<(QuadId, f64, f64)> {
    let mut random = Random::new(3);
    let quads = surface.num_quads();
    let mut parameter = |k: usize| match k % 5 {
        0 => 0.0,
        1 => 1.0,
        2 => 0.5,
        3 => random.unit() * 0.5_f64.powi((k % 40) as i32),
        _ => random.unit(),
    };
    let mut places: Vec<_> = (0..2000)
        .map(|k| (QuadId((k % quads) as u32), parameter(k / 3), parameter(k / 7)))
        .collect();
    places.extend(
        [(0, f64::NAN, 0.0), (u32::MAX, 0.5, 0.5), (0, -1.0, 2.0), (0, 1e-320, 1e-300)]
            .map(|(quad, u, v)| (QuadId(quad), u, v)),
    );
    places
}

/// The bits of everything, NaN being one number.
fn bits(rows: &[Point]) -> Vec<u64> {
    rows.iter().flatten().map(|x| if x.is_nan() { 0 } else { x.to_bits() }).collect()
}

#[test]
fn answers_of_all_kinds_have_the_same_bits() {
    for surface in surfaces() {
        for (quad, u, v) in places(&surface) {
            let full = surface.eval(quad, u, v);
            let second = surface.eval_second(quad, u, v);
            let first = surface.eval_first(quad, u, v);
            let position = surface.eval_position(quad, u, v);
            assert_eq!(full.is_some(), position.is_some());
            assert_eq!(full.is_some(), first.is_some() && second.is_some());
            let Some(full) = full else { continue };
            assert_eq!(bits(&full.jet.rows()), bits(&second.unwrap().rows()));
            let FirstJet { p, du, dv } = first.unwrap();
            assert_eq!(bits(&full.jet.rows()[..3]), bits(&[p, du, dv]));
            assert_eq!(bits(&[p]), bits(&[position.unwrap()]));
        }
    }
}

/// All answers at once, as rows.
fn each<A: Answer>(
    surface: &Surface,
    places: &[(QuadId, f64, f64)],
    rows: impl Fn(&A) -> Vec<Point>,
) -> Vec<u64> {
    let mut answers = vec![A::NAN; places.len()];
    surface.eval_each(places, &mut answers).unwrap();
    bits(&answers.iter().flat_map(rows).collect::<Vec<_>>())
}

#[test]
fn many_places_at_once_are_each_place_alone() {
    for surface in surfaces() {
        let mut places = places(&surface);
        places.extend_from_within(..);
        places.extend_from_within(..);
        let alone: Vec<SurfacePoint> = places
            .iter()
            .map(|&(quad, u, v)| surface.eval(quad, u, v).unwrap_or(SurfacePoint::NAN))
            .collect();
        let of_alone = |rows: fn(&SurfacePoint) -> Vec<Point>| {
            bits(&alone.iter().flat_map(rows).collect::<Vec<_>>())
        };
        let all =
            |p: &SurfacePoint| [&p.jet.rows()[..], &[p.normal, [p.gauss, p.mean, 0.0]]].concat();
        assert_eq!(each(&surface, &places, all), of_alone(all));
        assert_eq!(
            each(&surface, &places, |jet: &Jet| jet.rows().to_vec()),
            of_alone(|p| p.jet.rows().to_vec())
        );
        assert_eq!(each(&surface, &places, |p: &Point| vec![*p]), of_alone(|p| vec![p.jet.p]));
    }
}

/// Evaluation against de Casteljau-free plain sums over the BB coefficients of every patch.
#[test]
fn evaluation_agrees_with_the_polynomials() {
    for surface in surfaces() {
        let positions = surface.positions();
        let size = positions.iter().fold(0.0, |size: f64, &p| size.max(norm(p)));
        let mut random = Random::new(11);
        for place in surface.patch_places(2) {
            let [[u0, u1], [v0, v1]] = place.domain;
            let patch = surface.patch(&place).unwrap();
            for _ in 0..2 {
                let (a, b) = (random.unit(), random.unit());
                let found = surface
                    .eval_on(&place, u0 + a * (u1 - u0), v0 + b * (v1 - v0))
                    .unwrap()
                    .jet
                    .rows();
                let plain = patch.jet(a, b).rows();
                let [w, h] = [u1 - u0, v1 - v0];
                let steps = [1.0, w, h, w * w, w * h, h * h];
                for ((found, plain), step) in found.iter().zip(plain).zip(steps) {
                    let gap = norm(sub(found.map(|x| x * step), plain));
                    assert!(gap < 1e-13 * size, "{gap} in {:?}", place.role);
                }
            }
        }
    }
}

#[test]
fn grids_are_each_place_alone() {
    let mut random = Random::new(5);
    let some: Vec<f64> = (0..5).map(|_| random.unit()).collect();
    let us = [&[0.0, 0.25, 0.5, 1.0, 0.01, 1e-9, 1.0 - 1e-12, f64::NAN, 7.0], &some[..]].concat();
    let vs = [&[1.0, 0.125, 1e-310, 0.0, 0.75, -3.0], &some[2..]].concat();
    for surface in surfaces() {
        let mut grid = vec![SurfacePoint::NAN; us.len() * vs.len()];
        for quad in (0..=surface.num_quads() as u32).map(QuadId) {
            surface.eval_grid(quad, &us, &vs, &mut grid).unwrap();
            for (k, found) in grid.iter().enumerate() {
                let (u, v) = (us[k / vs.len()], vs[k % vs.len()]);
                let alone = surface.eval(quad, u, v).unwrap_or(SurfacePoint::NAN);
                assert_eq!(bits(&found.jet.rows()), bits(&alone.jet.rows()), "{quad:?} {u} {v}");
                let rest = |p: &SurfacePoint| bits(&[p.normal, [p.gauss, p.mean, 0.0]]);
                assert_eq!(rest(found), rest(&alone), "{quad:?} {u} {v}");
            }
        }
    }
}

#[test]
fn vertices_of_triangles_are_each_place_alone() {
    for surface in surfaces() {
        for rate in [1, 3, 4, 10] {
            let mesh = tessellate(&surface, rate).unwrap();
            for (side, origin) in mesh.origins.iter().enumerate() {
                let [u, v] = origin.uv;
                let alone = surface.eval(origin.quad, u, v).unwrap();
                if side < mesh.positions.len() {
                    assert_eq!(bits(&[mesh.positions[side]]), bits(&[alone.jet.p]));
                }
                // Where curvature does not exist a mesh has that of the cells around.
                if !alone.gauss.is_nan() {
                    let rows = [mesh.normals[side], [mesh.gauss[side], mesh.mean[side], 0.0]];
                    assert_eq!(bits(&rows), bits(&[alone.normal, [alone.gauss, alone.mean, 0.0]]));
                }
            }
        }
    }
}
