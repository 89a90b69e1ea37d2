//! Stencils: applied to the values of the cage they are what `Surface` says, for every scheme, tag
//! and kind of primvar; and nothing that they are asked for makes them panic.
#![allow(clippy::unwrap_used, reason = "a test that cannot make its cages fails")]

mod common;

use std::ops::ControlFlow;
use std::sync::Arc;

use common::{Random, fans, options};
use evenlight::cap::{CapKind, CapOptions};
use evenlight::mesh::{FaceVaryingRule, Interpolation, Primvar};
use evenlight::patch::Jet;
use evenlight::stencil::{StencilBuilder, StencilError, Stencils};
use evenlight::surface::{ArrayError, CreaseRings, Layout, Role, row_width};
use evenlight::task::Task;
use evenlight::{Cage, FaceId, Mesh, QuadId, SchemeKind, Surface, SurfaceOptions};

/// What results may differ by, as a part of the largest value and of the scale of a row; 2e-14 is
/// seen.
const ROUNDING: f64 = 1e-13;

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

/// Cages with every kind of extraordinary point.
fn some_cages() -> Vec<(String, Arc<Cage>)> {
    let names = [
        "own_polygons.obj",
        "obstacle/saddle_n5.obj",
        "features/boundary_valences.obj",
        "features/crease_dart.obj",
        "features/crease_fractional.obj",
        "features/holes.obj",
        "features/polygons_creased.obj",
        "features/star5_dart.obj",
        "features/star6_junction.obj",
        "features/star7_corner.obj",
        "features/valence_two.obj",
    ];
    names.map(|name| (name.to_owned(), common::cage(name))).into()
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
        if surface.is_omitted(surface.face_of(quad).unwrap().0) {
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

/// What the rows of places are made of before anything cancels, by the largest weight of a vertex:
/// the factors of derivatives in the pieces of their quads.
///
/// In ring l around a point derivatives of order k are (lambda / sigma^k)^l times those of ring 0.
/// A part of them may cancel: the tangents along a crease have no second derivative along it.
fn scales(surface: &Surface, places: &[Place], order: usize) -> Vec<f64> {
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
        let (lambda, sigma) =
            (surface.rings(p).unwrap().lambda(), surface.rings(p).unwrap().sigma());
        let ring = if distance > 0.0 { (distance.ln() / sigma.ln()).floor() } else { 0.0 };
        let ring = surface.cap_options().map_or(ring, |caps| ring.min(caps.rings as f64));
        let of_order = |k: i32| (lambda / sigma.powi(k)).powf(ring) * (4.0 * zoom).powi(k);
        [1.0, of_order(1), of_order(2)]
    };
    let orders = &[0, 1, 1, 2, 2, 2][..row_width::<1>(order).unwrap()];
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
fn check_sums(name: &str, stencils: &Stencils, order: usize, scales: &[f64]) {
    for (k, (columns, weights)) in stencils.rows().enumerate() {
        assert!(columns.windows(2).all(|pair| pair[0] < pair[1]), "{name}, row {k}: {columns:?}");
        let expected = if k % row_width::<1>(order).unwrap() == 0 { 1.0 } else { 0.0 };
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
            let builder = StencilBuilder::of_surface(&surface).unwrap();
            let stencils = builder.places(&places, 2).unwrap();
            let scales = scales(&surface, &places, 2);
            check(&name, &stencils, &scales, cage.positions(), &jets(&surface, &places));
            check_sums(&name, &stencils, 2, &scales);
        }
    }
}

#[test]
fn lower_orders_are_the_first_rows() {
    let surface = common::surface(&common::cage("own_polygons.obj"), SchemeKind::Qas4);
    let places = places(&surface);
    let builder = StencilBuilder::of_surface(&surface).unwrap();
    let all = builder.places(&places, 2).unwrap();
    for order in [0, 1] {
        let some = builder.places(&places, order).unwrap();
        assert_eq!(some.num_rows(), row_width::<1>(order).unwrap() * places.len());
        for (k, row) in some.rows().enumerate() {
            let same =
                6 * (k / row_width::<1>(order).unwrap()) + k % row_width::<1>(order).unwrap();
            assert_eq!(all.row(same), Some(row));
        }
    }
}

/// Ring after ring, until numbers end.
#[test]
fn places_are_those_of_the_surface_at_any_depth() {
    let cages = ["obstacle/saddle_n5.obj", "features/star5_dart.obj", "features/star5_crease.obj"];
    let cages = cages.into_iter().chain(["features/valence_two.obj", "obstacle/pillow_n3.obj"]);
    for cage in cages.map(common::cage) {
        for options in all_options() {
            let surface = Surface::build(cage.clone(), options).unwrap();
            let sectors = surface.extraordinary_points().iter().map(|point| point.sectors[0]);
            let at = |sector: &evenlight::surface::Sector, depth: f64| {
                let [u, v] = [0, 1].map(|k| {
                    sector.center[k] + depth * (0.9 * sector.along[0][k] + 0.4 * sector.along[1][k])
                });
                (sector.quad, u, v)
            };
            // Depths beyond 1e-16 are there where the parameters of the point are 0.
            let depths = (0..25).map(|k| 0.5 * 4_f64.powi(-k)).chain([1e-20, 1e-30, 1e-60]);
            let depths: Vec<f64> = depths.collect();
            let is_deep = |sector: &evenlight::surface::Sector, d: f64| {
                d > 1e-14 || sector.center == [0.0; 2]
            };
            let places: Vec<Place> = sectors
                .flat_map(|s| {
                    depths
                        .iter()
                        .filter(|&&d| is_deep(&s, d))
                        .map(move |&d| at(&s, d))
                        .collect::<Vec<_>>()
                })
                .collect();
            let builder = StencilBuilder::of_surface(&surface).unwrap();
            let stencils = builder.places(&places, 2).unwrap();
            let scales = scales(&surface, &places, 2);
            check(
                options.scheme.name(),
                &stencils,
                &scales,
                cage.positions(),
                &jets(&surface, &places),
            );
            check_sums(options.scheme.name(), &stencils, 2, &scales);
        }
    }
}

/// Curvature of results loses what the docs say: about 1e-16 lambda^-l of it in ring l.
#[test]
fn curvature_of_results_is_lost_slowly() {
    let cage = common::cage("obstacle/saddle_n5.obj");
    for scheme in SchemeKind::ALL {
        let surface = common::surface(&cage, scheme);
        let (point, rings) = (&surface.extraordinary_points()[0], surface.rings(0).unwrap());
        let sector = point.sectors[0];
        let builder = StencilBuilder::of_surface(&surface).unwrap();
        for ring in 0..30 {
            let depth = 0.8 * rings.sigma().powi(ring);
            let along = |k: usize| depth * (sector.along[0][k] + 0.3 * sector.along[1][k]);
            let place = (sector.quad, sector.center[0] + along(0), sector.center[1] + along(1));
            let rows = builder.places(&[place], 2).unwrap().apply(surface.positions()).unwrap();
            let [p, du, dv, duu, duv, dvv] = rows[..] else { panic!("6 rows") };
            let (_, mean) = Jet { p, du, dv, duu, duv, dvv }.curvature();
            let exact = surface.eval(place.0, place.1, place.2).unwrap().mean;
            let bound = 1e-13 * rings.lambda().powi(-ring) * (1.0 + exact.abs());
            assert!((mean - exact).abs() < bound, "{scheme:?}, ring {ring}: {mean}, not {exact}");
        }
    }
}

/// Beyond 64 faces between two sharp edges rows are made another way.
#[test]
fn places_at_fans_of_many_faces_are_those_of_the_surface() {
    for lines in [&[0, 70][..], &[0, 1, 68], &[2]] {
        let cage = Arc::new(Cage::new(fans::starred(140, lines, 5)).unwrap());
        let mut surface = common::surface(&cage, SchemeKind::Qas4);
        let sectors = surface.extraordinary_points().iter().flat_map(|p| &p.sectors).step_by(23);
        let at = |s: &evenlight::surface::Sector, a: f64, b: f64| {
            let [u, v] = [0, 1].map(|k| s.center[k] + a * s.along[0][k] + b * s.along[1][k]);
            (s.quad, u, v)
        };
        let near = [(0.9, 0.3), (0.1, 0.2), (0.01, 0.03), (0.0, 0.0)];
        let places: Vec<Place> = sectors.flat_map(|s| near.map(|(a, b)| at(s, a, b))).collect();
        let builder = StencilBuilder::of_surface(&surface).unwrap();
        let stencils = builder.places(&places, 2).unwrap();
        let scales: Vec<f64> = scales(&surface, &places, 2).iter().map(|x| x.max(1.0)).collect();
        let name = format!("{lines:?}");
        check(&name, &stencils, &scales, cage.positions(), &jets(&surface, &places));
        check_sums(&name, &stencils, 2, &scales);
        let patches: Vec<_> =
            surface.patch_places(3).filter(|place| place.point.is_some()).step_by(97).collect();
        let rows = builder.patches(&patches).unwrap();
        let expected: Vec<[f64; 3]> =
            patches.iter().flat_map(|p| surface.patch(p).unwrap().coefs().to_vec()).collect();
        check(&name, rows.stencils(), &vec![1.0; expected.len()], cage.positions(), &expected);
        // Their caps have too many unit nets.
        surface.set_caps(Some(CapOptions::default())).unwrap();
        let builder = StencilBuilder::of_surface(&surface).unwrap();
        let errors = places.iter().filter_map(|place| builder.places(&[*place], 0).err());
        assert!(
            errors.into_iter().all(|error| matches!(error, StencilError::Fan { most: 64, .. }))
        );
    }
}

/// At the point itself the position is the limit point; derivatives are NaN, unless there is a cap.
#[test]
fn at_the_point_itself_derivatives_do_not_exist() {
    for (name, cage) in cages() {
        let mut surface = common::surface(&cage, SchemeKind::Qas4);
        let sectors = surface.extraordinary_points().iter().flat_map(|point| &point.sectors);
        let places: Vec<Place> = sectors.map(|s| (s.quad, s.center[0], s.center[1])).collect();
        let stencils = StencilBuilder::of_surface(&surface).unwrap().places(&places, 2).unwrap();
        let scales = vec![1.0; stencils.num_rows()];
        let expected = jets(&surface, &places);
        assert!(expected.iter().filter(|p| p[0].is_nan()).count() == 5 * places.len());
        check(&name, &stencils, &scales, cage.positions(), &expected);
        surface.set_caps(Some(CapOptions { rings: 1, ..CapOptions::default() })).unwrap();
        let stencils = StencilBuilder::of_surface(&surface).unwrap().places(&places, 2).unwrap();
        assert!(stencils.weights().iter().all(|w| w.is_finite()), "{name}");
        let scales = self::scales(&surface, &places, 2);
        let scales: Vec<f64> = scales.iter().map(|s| s.max(100.0)).collect();
        check(&name, &stencils, &scales, cage.positions(), &jets(&surface, &places));
    }
}

/// Caps are linear in the cage too.
#[test]
fn places_in_caps_are_those_of_the_surface() {
    for (name, cage) in some_cages() {
        for options in all_options() {
            for (rings, kind) in [(0, CapKind::Auto), (3, CapKind::Bi4), (12, CapKind::Auto)] {
                let mut surface = Surface::build(cage.clone(), options).unwrap();
                if surface.set_caps(Some(CapOptions { rings, kind })).is_err() {
                    assert_eq!(kind, CapKind::Bi4, "{name}: auto fits all schemes");
                    continue;
                }
                let name = format!("{name} {} {rings} {kind:?}", options.scheme.name());
                let places = places(&surface);
                let builder = StencilBuilder::of_surface(&surface).unwrap();
                let stencils = builder.places(&places, 2).unwrap();
                let scales: Vec<f64> =
                    scales(&surface, &places, 2).iter().map(|x| 4.0 * x).collect();
                check(&name, &stencils, &scales, cage.positions(), &jets(&surface, &places));
                check_sums(&name, &stencils, 2, &scales);
            }
        }
    }
}

/// The rows of the coefficients of patches, at rings 1, 5 and 12, and of caps.
#[test]
fn patches_are_those_of_the_surface() {
    for (name, cage) in some_cages() {
        for options in all_options() {
            let mut surface = Surface::build(cage.clone(), options).unwrap();
            for caps in [None, Some(CapOptions { rings: 13, ..CapOptions::default() })] {
                surface.set_caps(caps).unwrap();
                let wanted =
                    [Role::Ring(1), Role::Ring(5), Role::Ring(12), Role::Regular, Role::Cap];
                let places: Vec<_> =
                    surface.patch_places(13).filter(|place| wanted.contains(&place.role)).collect();
                let builder = StencilBuilder::of_surface(&surface).unwrap();
                assert!(builder.patch_places(13).unwrap().len() >= places.len());
                let patches = builder.patches(&places).unwrap();
                let name = format!("{name} {} {caps:?}", options.scheme.name());
                let mut expected = Vec::new();
                for (k, place) in places.iter().enumerate() {
                    let patch = surface.patch(place).unwrap();
                    assert_eq!(patch.degree(), [patches.degree(k).unwrap(); 2], "{name}");
                    assert_eq!(patches.rows(k).unwrap().start, expected.len());
                    expected.extend(patch.coefs());
                }
                let ones = vec![1.0; expected.len()];
                check(&name, patches.stencils(), &ones, cage.positions(), &expected);
                check_sums(&name, patches.stencils(), 0, &ones);
            }
        }
    }
}

/// The rows of refined vertices by the reference that shares nothing with the library: corner by
/// corner, with creases, corners, boundaries and polygons.
#[test]
fn refined_vertices_are_those_of_the_reference() {
    for (name, cage) in cages() {
        let surface = common::surface(&cage, SchemeKind::CatmullClark);
        let builder = StencilBuilder::of_surface(&surface).unwrap();
        let mut mesh = Mesh {
            positions: cage.positions().to_vec(),
            faces: cage.topology().faces().clone(),
            tags: cage.tags().clone(),
            primvars: vec![],
        };
        // Sharpness is in single precision, which the reference does not know of.
        let single = |s: &mut f64| *s = f64::from(*s as f32);
        mesh.tags.creases.iter_mut().for_each(|crease| single(&mut crease.sharpness));
        mesh.tags.corners.iter_mut().for_each(|corner| single(&mut corner.sharpness));
        for steps in 0..=3 {
            let refined = builder.refined(steps).unwrap();
            let name = format!("{name}, {steps} steps");
            assert_eq!(refined.faces.len(), mesh.faces.len(), "{name}");
            let found = refined.stencils.apply(cage.positions()).unwrap();
            for (a, b) in refined.faces.all_corners().iter().zip(mesh.faces.all_corners()) {
                let (a, b) = (found[a.index()], mesh.positions[b.index()]);
                assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-13), "{name}: {a:?}, not {b:?}");
            }
            check_sums(&name, &refined.stencils, 0, &vec![1.0; found.len()]);
            if steps < 3 {
                mesh = common::refine::refine(&mesh);
            }
        }
    }
}

/// The rows of two steps are those of one step of the cage refined once.
#[test]
fn steps_follow_each_other() {
    for cage in ["own_polygons.obj", "features/boundary_edge_only.obj"].map(common::cage) {
        let refined = |cage: &Arc<Cage>, steps: usize| {
            let surface = common::surface(cage, SchemeKind::Qas4);
            StencilBuilder::of_surface(&surface).unwrap().refined(steps).unwrap()
        };
        let (once, twice) = (refined(&cage, 1), refined(&cage, 2));
        let positions = once.stencils.apply(cage.positions()).unwrap();
        let tags = cage.tags().clone();
        let mesh = Mesh { faces: once.faces, tags, ..Mesh::new(positions, [[0; 0]; 0]) };
        let next = refined(&Arc::new(Cage::new(mesh).unwrap()), 1);
        assert_eq!(next.faces, twice.faces);
        let product = next.stencils.times(&once.stencils).unwrap();
        for (a, b) in product.rows().zip(twice.stencils.rows()) {
            assert_eq!(a.0, b.0);
            assert!(a.1.iter().zip(b.1).all(|(x, y)| (x - y).abs() < 1e-15));
        }
    }
}

/// Where a corner of a refined face lies in its quad; of cages of quads.
fn corner_in_quad(child: usize, steps: usize, corner: usize) -> [f64; 2] {
    const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut at = CORNERS[corner];
    for step in 0..steps {
        let k = child >> (2 * step) & 3;
        at = [0, 1].map(|d| 0.5 * (at[d] + CORNERS[k][d]));
    }
    at
}

/// How far the refined vertices of a primvar are from its limits at the same places.
fn distance_from_limit(builder: &StencilBuilder, primvar: &Primvar, steps: usize) -> f64 {
    let refined = builder.refined(steps).unwrap();
    let (width, faces) = (primvar.width, &refined.faces);
    let mut values = vec![0.0; refined.stencils.num_rows() * width];
    refined.stencils.apply_flat(width, &primvar.values, &mut values).unwrap();
    let corners = faces.ids().flat_map(|f| [0, 1, 2, 3].map(|k| (f, k)));
    let (places, rows): (Vec<Place>, Vec<usize>) = corners
        .map(|(f, k)| {
            let parent = refined.parents[f.index()];
            let first = refined.parents.partition_point(|&p| p < parent);
            let [u, v] = corner_in_quad(f.index() - first, steps, k);
            ((QuadId(parent.0), u, v), faces.corners(f)[k].index())
        })
        .unzip();
    let stencils = builder.places(&places, 0).unwrap();
    let mut limits = vec![0.0; places.len() * width];
    stencils.apply_flat(width, &primvar.values, &mut limits).unwrap();
    let numbers = rows.iter().flat_map(|&row| (0..width).map(move |k| row * width + k));
    limits.iter().zip(numbers).map(|(x, at)| (x - values[at]).abs()).fold(0.0, f64::max)
}

/// Feature cages with texture coordinates; with them a varying and a vertex primvar.
fn textured(rule: FaceVaryingRule) -> Vec<(String, Cage)> {
    let cages = common::feature_cages().into_iter().filter(|(name, _)| name.starts_with("uv_"));
    let with_primvars = |(name, cage): (String, Arc<Cage>)| {
        let mut mesh = common::mesh(&format!("features/{name}"));
        mesh.tags.face_varying = rule;
        let values: Vec<f64> = cage.positions().as_flattened().iter().map(|x| 1.0 - x).collect();
        for interpolation in [Interpolation::Varying, Interpolation::Vertex] {
            let (name, indices) = (format!("{interpolation:?}"), vec![]);
            let values = values.clone();
            mesh.primvars.push(Primvar { name, interpolation, width: 3, values, indices });
        }
        (name, Cage::new(mesh).unwrap())
    };
    cages.map(with_primvars).collect()
}

#[test]
fn primvars_are_those_of_the_surface() {
    for (rule, scheme) in
        FaceVaryingRule::ALL.into_iter().flat_map(|rule| SchemeKind::ALL.map(|s| (rule, s)))
    {
        for (name, cage) in textured(rule) {
            let surface = Surface::build(cage, options(scheme)).unwrap();
            // Close to points at seams derivatives of primvars have lost digits themselves.
            let is_deep = |&(_, u, v): &Place| u * (1.0 - u) * v * (1.0 - v) < 1e-9;
            let mut places = places(&surface);
            places.retain(|place| !is_deep(place) || place.1 * (1.0 - place.1) == 0.0);
            for (k, primvar) in surface.primvars().iter().enumerate() {
                let name = format!("{name} {rule:?} {} {}", scheme.name(), primvar.name);
                let builder = StencilBuilder::of_primvar(&surface, k).unwrap();
                let stencils = builder.places(&places, 2).unwrap();
                let (values, width) = (&primvar.values, primvar.width);
                assert_eq!(stencils.num_columns() * width, values.len());
                let mut results = vec![0.0; stencils.num_rows() * width];
                stencils.apply_flat(width, values, &mut results).unwrap();
                // Primvars have points of their own at seams, at which second derivatives grow.
                let largest = values.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
                for (&(quad, u, v), found) in places.iter().zip(results.chunks(6 * width)) {
                    let rows = surface.eval_primvar::<4>(k, quad, u, v).unwrap().rows();
                    let size = rows.as_flattened().iter().fold(largest, |m: f64, x| m.max(x.abs()));
                    for (row, found) in rows.iter().zip(found.chunks(width)) {
                        let close = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e2 * ROUNDING * size;
                        let is_same = found.iter().zip(row).all(close);
                        assert!(is_same, "{name}, {quad:?} {u} {v}: {found:?}, not {row:?}");
                    }
                }
            }
        }
    }
}

/// Refinement of primvars goes to their limits: around irregular points by their eigenvalues, which
/// are below .75 here.
#[test]
fn refined_primvars_approach_their_limits() {
    for (name, cage) in FaceVaryingRule::ALL.into_iter().flat_map(textured) {
        if cage.topology().faces().iter().any(|corners| corners.len() != 4) {
            continue;
        }
        let surface = Surface::build(cage, options(SchemeKind::CatmullClark)).unwrap();
        for (k, primvar) in surface.primvars().iter().enumerate() {
            let builder = StencilBuilder::of_primvar(&surface, k).unwrap();
            let [coarse, fine] = [2, 4].map(|steps| distance_from_limit(&builder, primvar, steps));
            let name = format!("{name} {:?} {}", surface.tags().face_varying, primvar.name);
            assert!(fine <= 0.75 * 0.75 * coarse + 1e-14, "{name}: {coarse} {fine}");
        }
    }
}

/// The patches of a face-varying primvar are those of its own net.
#[test]
fn patches_of_primvars_have_the_limits() {
    for (name, cage) in textured(FaceVaryingRule::CornersPlus1) {
        let surface = Surface::build(cage, options(SchemeKind::Qas4)).unwrap();
        for (k, primvar) in surface.primvars().iter().enumerate() {
            let builder = StencilBuilder::of_primvar(&surface, k).unwrap();
            if primvar.interpolation == Interpolation::Varying {
                assert_eq!(builder.patch_places(2).unwrap_err(), StencilError::Linear);
                assert_eq!(builder.patches(&[]).unwrap_err(), StencilError::Linear);
                continue;
            }
            let places = builder.patch_places(2).unwrap();
            let patches = builder.patches(&places).unwrap();
            let width = primvar.width;
            let mut coefs = vec![0.0; patches.stencils().num_rows() * width];
            patches.stencils().apply_flat(width, &primvar.values, &mut coefs).unwrap();
            for (k, place) in places.iter().enumerate() {
                // The first coefficient is the value at the patch's own corner.
                let row = patches.rows(k).unwrap().start;
                let [[u, _], [v, _]] = place.domain;
                let mut limit = vec![0.0; width];
                let stencils = builder.places(&[(place.quad, u, v)], 0).unwrap();
                stencils.apply_flat(width, &primvar.values, &mut limit).unwrap();
                let found = &coefs[row * width..][..width];
                let is_same = limit.iter().zip(found).all(|(a, b)| (a - b).abs() < 1e-12);
                assert!(is_same, "{name} {}: {found:?}, not {limit:?}", primvar.name);
            }
        }
    }
}

/// In the plane the surface of a regular grid is the grid: u and v are reproduced, and their
/// squares up to the constant that splines add.
#[test]
fn a_regular_grid_is_reproduced() {
    let n = 6;
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let faces = cells.map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    let nodes = (0..=n).flat_map(|i| (0..=n).map(move |j| [f64::from(i), f64::from(j), 0.0]));
    let cage = Cage::new(Mesh::new(nodes.collect(), faces)).unwrap();
    let squares: Vec<[f64; 2]> = cage.positions().iter().map(|&[x, y, _]| [x * x, x * y]).collect();
    let surface = Surface::build(cage, SurfaceOptions::default()).unwrap();
    // The middle face, from (2,3).
    let place = (surface.quad(FaceId(2 * n + 3), 0).unwrap(), 0.25, 0.75);
    let stencils = StencilBuilder::of_surface(&surface).unwrap().places(&[place], 2).unwrap();
    let (x, y) = (2.25, 3.75);
    let expected =
        [[x * x + 1.0 / 3.0, x * y], [2.0 * x, y], [0.0, x], [2.0, 0.0], [0.0, 1.0], [0.0, 0.0]];
    for (a, b) in stencils.apply(&squares).unwrap().iter().zip(expected) {
        assert!((0..2).all(|k| (a[k] - b[k]).abs() < 1e-13), "{a:?}, not {b:?}");
    }
    assert_eq!(stencils.row(0).unwrap().0.len(), 16);
}

#[test]
fn bad_input_is_an_error() {
    let cage = common::cage("features/holes.obj");
    let surface = common::surface(&cage, SchemeKind::Qas4);
    let builder = StencilBuilder::of_surface(&surface).unwrap();
    let error = |place: Place| builder.places(&[(QuadId(0), 0.5, 0.5), place], 1).unwrap_err();
    let quad = QuadId(surface.num_quads() as u32);
    assert_eq!(error((quad, 0.5, 0.5)), StencilError::Quad { place: 1, quad });
    assert_eq!(error((QuadId(0), f64::NAN, 0.5)), StencilError::Parameter { place: 1 });
    let hole = surface.quad(surface.omitted_faces()[0], 0).unwrap();
    assert_eq!(error((hole, 0.5, 0.5)), StencilError::Omitted { place: 1, quad: hole });
    let inside = builder.places(&[(QuadId(0), 0.0, 1.0)], 2).unwrap();
    let clamped = builder.places(&[(QuadId(0), f64::NEG_INFINITY, 7.0)], 2).unwrap();
    assert_eq!(inside, clamped);
    let missing = StencilBuilder::of_primvar(&surface, 3).unwrap_err();
    assert_eq!(missing, StencilError::Primvar { primvar: 3 });
    assert_eq!(builder.refined(40).unwrap_err(), StencilError::TooLarge);
    assert!(inside.apply(&[[0.0]; 3]).is_err());

    let other = common::surface(&common::cage("own_polygons.obj"), SchemeKind::Guided3);
    let places: Vec<_> = other.patch_places(2).collect();
    let patch = places.iter().position(|place| builder.patches(&[*place]).is_err()).unwrap();
    assert_eq!(builder.patches(&places).unwrap_err(), StencilError::Patch { patch });
    assert_eq!(builder.places(&[], 1).unwrap().num_rows(), 0);
}

#[test]
fn the_number_of_threads_does_not_change_a_byte() {
    let surface = common::surface(&common::cage("own_blob_quadriflow_1500.obj"), SchemeKind::Qas4);
    let places: Vec<Place> = std::iter::repeat_n(places(&surface), 4).flatten().collect();
    let made = [1, 2, 5].map(|threads| {
        Task::new().threads(threads).run(|| {
            let builder = StencilBuilder::of_surface(&surface).unwrap();
            let rows = builder.places(&places, 1).unwrap();
            let results = rows.apply(surface.positions()).unwrap();
            (builder.refined(1).unwrap().stencils, rows, results)
        })
    });
    assert!(made[0] == made[1] && made[1] == made[2]);
}

#[test]
fn who_watches_may_stop_the_work() {
    let surface = common::surface(&common::cage("own_polygons.obj"), SchemeKind::Qas4);
    let builder = StencilBuilder::of_surface(&surface).unwrap();
    let task = Task::new().watch(|_| ControlFlow::Break(()));
    let stopped = task.run(|| builder.places(&[(QuadId(0), 0.5, 0.5)], 1));
    assert_eq!(stopped.unwrap_err(), StencilError::Cancelled);
}

/// The layout is enough: no values are needed, and arrays are the same places.
#[test]
fn stencils_are_of_the_layout() {
    let cage = common::cage("own_polygons.obj");
    let layout = Arc::new(Layout::new(&cage, SurfaceOptions::default()).unwrap());
    let caps = Some(CapOptions { rings: 2, ..CapOptions::default() });
    let mut surface = Surface::of_cage(&layout, &cage).unwrap();
    surface.set_caps(caps).unwrap();
    let places = places(&surface);
    let by_layout = StencilBuilder::new(&layout, caps).unwrap();
    let by_surface = StencilBuilder::of_surface(&surface).unwrap().places(&places, 1).unwrap();
    assert_eq!(by_layout.places(&places, 1).unwrap(), by_surface);
    let quads: Vec<u32> = places.iter().map(|place| place.0.0).collect();
    let uv: Vec<[f64; 2]> = places.iter().map(|&(_, u, v)| [u, v]).collect();
    assert_eq!(by_layout.place_arrays(&quads, &uv, 1).unwrap(), by_surface);
    let expected = ArrayError::Length { what: "uv", expected: quads.len(), found: 1 };
    let error = by_layout.place_arrays(&quads, &uv[..1], 1).unwrap_err();
    assert_eq!(error, StencilError::Array(expected));
    let error = by_layout.places(&places, 3).unwrap_err();
    assert_eq!(error, StencilError::Array(ArrayError::Order { order: 3 }));
    let kind = CapKind::Bi3;
    let caps = Some(CapOptions { rings: 2, kind });
    assert!(matches!(StencilBuilder::new(&layout, caps), Err(StencilError::Cap(_))));
}
