//! Evaluation against independent routes: refinement to the end, finite differences, theorems on
//! deep rings, and the limit at the extraordinary point.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::sync::Arc;

use common::Random;
use evenlight::patch::SurfacePoint;
use evenlight::point::{dot, norm, scale, sub};
use evenlight::surface::{QuadId, Sector};
use evenlight::{Cage, FaceId, Mesh, Point, SchemeKind, Surface};

fn distance(a: Point, b: Point) -> f64 {
    norm(sub(a, b))
}

/// One Catmull-Clark step of a closed mesh in the plainest way, with dense loops over all faces:
/// vertices first, then edges, then faces; children in the order of the corners.
fn refine_plainly(positions: &[Point], faces: &[Vec<usize>]) -> (Vec<Point>, Vec<Vec<usize>>) {
    let mean = |ids: &[usize]| {
        let n = ids.len() as f64;
        [0, 1, 2].map(|k| ids.iter().map(|&v| positions[v][k]).sum::<f64>() / n)
    };
    let face_points: Vec<Point> = faces.iter().map(|f| mean(f)).collect();
    let mut edges = std::collections::BTreeMap::<(usize, usize), Vec<usize>>::new();
    for (f, face) in faces.iter().enumerate() {
        for k in 0..face.len() {
            let (a, b) = (face[k], face[(k + 1) % face.len()]);
            edges.entry((a.min(b), a.max(b))).or_default().push(f);
        }
    }
    let mut refined = Vec::new();
    for (v, &p) in positions.iter().enumerate() {
        let around: Vec<usize> = (0..faces.len()).filter(|&f| faces[f].contains(&v)).collect();
        let n = around.len() as f64;
        let neighbours = edges.keys().filter(|e| e.0 == v || e.1 == v);
        let mut sum = scale((n - 2.0) / n, p);
        for other in neighbours.map(|e| e.0 + e.1 - v) {
            (0..3).for_each(|k| sum[k] += positions[other][k] / (n * n));
        }
        for f in around {
            (0..3).for_each(|k| sum[k] += face_points[f][k] / (n * n));
        }
        refined.push(sum);
    }
    let mut edge_ids = std::collections::BTreeMap::new();
    for (&(a, b), around) in &edges {
        let (f, g) = (face_points[around[0]], face_points[around[1]]);
        edge_ids.insert((a, b), refined.len());
        refined.push([0, 1, 2].map(|k| (positions[a][k] + positions[b][k] + f[k] + g[k]) / 4.0));
    }
    let first_face = refined.len();
    refined.extend(&face_points);
    let mut children = Vec::new();
    for (f, face) in faces.iter().enumerate() {
        let m = face.len();
        let edge = |k: usize| {
            let (a, b) = (face[k % m], face[(k + 1) % m]);
            edge_ids[&(a.min(b), a.max(b))]
        };
        children.extend((0..m).map(|k| vec![face[k], edge(k), first_face + f, edge(k + m - 1)]));
    }
    (refined, children)
}

#[test]
fn catmull_clark_is_the_limit_of_refinement() {
    // Triangles, quads and pentagons, valences 3, 4, 5.
    let mesh = common::mesh("obstacle/polycube_corner_m1.obj");
    let faces: Vec<Vec<usize>> =
        mesh.faces.iter().map(|f| f.iter().map(|v| v.index()).collect()).collect();
    let (mut faces, mut positions) = (faces, mesh.positions.clone());
    // A quad cut into triangles, another two joined to a hexagon, for n-gons.
    let quad = faces.remove(0);
    faces.push(vec![quad[0], quad[1], quad[2]]);
    faces.push(vec![quad[0], quad[2], quad[3]]);
    let cut = faces.clone();
    let flat: Vec<Vec<u32>> = cut.iter().map(|f| f.iter().map(|&v| v as u32).collect()).collect();
    let cage = Arc::new(Cage::new(Mesh::new(positions.clone(), flat)).unwrap());
    let surface = common::surface(&cage, SchemeKind::CatmullClark);
    for _ in 0..5 {
        (positions, faces) = refine_plainly(&positions, &faces);
    }
    // The vertices keep their numbers; after five steps a vertex is 4^-5 from its limit.
    for (f, corners) in cut.iter().enumerate() {
        for (k, &v) in corners.iter().enumerate() {
            let face = FaceId(f as u32);
            let limit = if corners.len() == 4 {
                let [u, v] = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]][k];
                surface.eval(surface.quad(face, 0).unwrap(), u, v)
            } else {
                surface.eval(surface.quad(face, k).unwrap(), 0.0, 0.0)
            };
            let limit = limit.unwrap().jet.p;
            assert!(distance(limit, positions[v]) < 2e-3, "{limit:?} {:?}", positions[v]);
        }
    }
}

#[test]
fn evaluation_does_not_depend_on_the_level_at_which_it_happens() {
    // Catmull-Clark of the refined cage is the same surface; its faces are quarters.
    for name in ["obstacle/pillow_n5.obj", "obstacle/polycube_corner_m1.obj"] {
        let mesh = common::mesh(name);
        let faces: Vec<Vec<usize>> =
            mesh.faces.iter().map(|f| f.iter().map(|v| v.index()).collect()).collect();
        let (positions, children) = refine_plainly(&mesh.positions, &faces);
        let children: Vec<Vec<u32>> =
            children.iter().map(|f| f.iter().map(|&v| v as u32).collect()).collect();
        let coarse = common::surface(&Arc::new(Cage::new(mesh).unwrap()), SchemeKind::CatmullClark);
        let fine = Arc::new(Cage::new(Mesh::new(positions, children)).unwrap());
        let fine = common::surface(&fine, SchemeKind::CatmullClark);
        let mut random = Random::new(1);
        for _ in 0..2000 {
            let f = random.below(faces.len());
            let (k, a, b) = (random.below(4), random.unit(), random.unit());
            // Child k starts at corner k and its u runs along edge k.
            let [u, v] = [[a, b], [2.0 - b, a], [2.0 - a, 2.0 - b], [b, 2.0 - a]][k];
            let p = coarse.eval(QuadId(f as u32), u / 2.0, v / 2.0).unwrap();
            let q = fine.eval(QuadId(4 * f as u32 + k as u32), a, b).unwrap();
            assert!(distance(p.jet.p, q.jet.p) < 1e-13, "{name}");
            assert!(distance(p.normal, q.normal) < 1e-11, "{name}");
            assert!((p.mean - q.mean).abs() < 1e-8 * (1.0 + p.mean.abs()), "{name}");
        }
    }
}

/// The cage moved so that the limit point of its first extraordinary point is the origin; there
/// positions are exact relative to the size of the ring, so that differences mean something.
fn centred(name: &str, scheme: SchemeKind) -> Surface {
    let mut mesh = common::mesh(name);
    for _ in 0..3 {
        let surface = common::surface(&Arc::new(Cage::new(mesh.clone()).unwrap()), scheme);
        let center = surface.rings(0).unwrap().center();
        mesh.positions.iter_mut().for_each(|p| *p = sub(*p, center));
    }
    common::surface(&Arc::new(Cage::new(mesh).unwrap()), scheme)
}

fn at(surface: &Surface, sector: &Sector, a: f64, b: f64) -> SurfacePoint {
    let [u, v] = [0, 1].map(|d| sector.center[d] + a * sector.along[0][d] + b * sector.along[1][d]);
    surface.eval(sector.quad, u, v).unwrap()
}

/// The derivatives of a function of one variable at 0, from seven values; exact for polynomials
/// of degree 6.
fn differences(f: impl Fn(f64) -> Point, h: f64) -> [Point; 2] {
    let values = [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0].map(|k| f(k * h));
    let sum = |weights: [f64; 7], factor: f64| {
        [0, 1, 2].map(|d| (0..7).map(|k| weights[k] * values[k][d]).sum::<f64>() / factor)
    };
    [
        sum([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0], 60.0 * h),
        sum([2.0, -27.0, 270.0, -490.0, 270.0, -27.0, 2.0], 180.0 * h * h),
    ]
}

#[test]
fn derivatives_agree_with_finite_differences_in_rings_1_to_20() {
    for name in ["obstacle/saddle_n3.obj", "obstacle/paraboloid_n5.obj", "obstacle/ridges_n8.obj"] {
        for scheme in SchemeKind::ALL {
            let surface = centred(name, scheme);
            let point = &surface.extraordinary_points()[0];
            let mut random = Random::new(7);
            for ring in 0..20 {
                let h = 0.5_f64.powi(ring);
                for _ in 0..20 {
                    // Inside one of the patches, so that the stencil stays in it.
                    let rings = surface.rings(0).unwrap();
                    let domain =
                        rings.patch_domain(random.below(rings.patches_per_sector())).unwrap();
                    let [a, b] = domain
                        .map(|[from, to]| h * (from + (to - from) * (0.3 + 0.4 * random.unit())));
                    // Parameters straight from the sector: at corner 0 of their quad (u,v) is
                    // (a,b), so nothing is lost near the point.
                    let sector = &point.sectors[random.below(point.sectors.len())];
                    if sector.center != [0.0, 0.0] {
                        continue;
                    }
                    let step = 0.015 * h;
                    let jet = at(&surface, sector, a, b).jet;
                    let [du, duu] = differences(|t| at(&surface, sector, a + t, b).jet.p, step);
                    let [dv, dvv] = differences(|t| at(&surface, sector, a, b + t).jet.p, step);
                    let [duv, _] = differences(|t| at(&surface, sector, a, b + t).jet.du, step);
                    let (first, second) = (norm(jet.du) + norm(jet.dv), norm(jet.du) / h);
                    assert!(distance(du, jet.du) < 1e-9 * first, "{name} ring {ring}");
                    assert!(distance(dv, jet.dv) < 1e-9 * first, "{name} ring {ring}");
                    for (found, exact) in [(duu, jet.duu), (duv, jet.duv), (dvv, jet.dvv)] {
                        let gap = distance(found, exact);
                        assert!(gap < 1e-7 * second, "{name} ring {ring}: {gap} of {second}");
                    }
                }
            }
        }
    }
}

#[test]
fn normal_and_curvature_agree_with_the_derivatives_where_those_are_well_conditioned() {
    let surface =
        common::surface(&common::cage("obstacle/pillow_n8.obj"), SchemeKind::EvolvingGuide);
    let mut random = Random::new(3);
    for _ in 0..5000 {
        let quad = QuadId(random.below(surface.num_quads()) as u32);
        let (u, v) = (0.05 + 0.9 * random.unit(), 0.05 + 0.9 * random.unit());
        let p = surface.eval(quad, u, v).unwrap();
        let (gauss, mean) = p.jet.curvature();
        assert!(distance(p.normal, p.jet.normal()) < 1e-11);
        assert!((p.gauss - gauss).abs() < 1e-9 * (1.0 + gauss.abs()));
        assert!((p.mean - mean).abs() < 1e-9 * (1.0 + mean.abs()));
    }
}

#[test]
fn the_limit_at_the_extraordinary_point_is_the_limit_of_the_surface() {
    for name in ["obstacle/saddle_n5.obj", "obstacle/pillow_n6.obj", "obstacle/monkey_n7.obj"] {
        for scheme in SchemeKind::ALL {
            let surface = common::surface(&common::cage(name), scheme);
            for (index, point) in surface.extraordinary_points().iter().enumerate() {
                let rings = surface.rings(index).unwrap();
                let lambda = rings.lambda();
                for sector in &point.sectors {
                    let center = at(&surface, sector, 0.0, 0.0);
                    assert_eq!(center.jet.p, rings.center());
                    assert_eq!(center.normal, rings.normal());
                    assert!(center.jet.du[0].is_nan());
                    assert_eq!(center.gauss.is_nan(), !scheme.has_center_curvature());
                    // Distance falls like lambda per ring, the angle of normals likewise (times
                    // (mu / lambda^2) per ring, at most 1.33 here).
                    let near = at(&surface, sector, 0.5_f64.powi(30), 0.3 * 0.5_f64.powi(30));
                    assert!(distance(near.jet.p, rings.center()) < 20.0 * lambda.powi(30));
                    assert!(1.0 - dot(near.normal, rings.normal()) < 1e-6, "{name}");
                }
            }
        }
    }
}

#[test]
fn the_deepest_parameters_have_a_position_and_a_normal() {
    let surface =
        common::surface(&common::cage("obstacle/paraboloid_n5.obj"), SchemeKind::EvolvingGuide);
    let point = &surface.extraordinary_points()[0];
    let sector = point.sectors.iter().find(|s| s.center == [0.0, 0.0]).unwrap();
    for exponent in [10, 31, 32, 33, 100, 500, 1000, 1022] {
        let p = at(&surface, sector, 0.5_f64.powi(exponent), 0.5_f64.powi(exponent + 1));
        assert!(p.jet.p.iter().chain(&p.normal).all(|x| x.is_finite()), "2^-{exponent}");
        assert!(p.gauss.is_finite() && p.mean.is_finite(), "2^-{exponent}");
    }
    let p = at(&surface, sector, 5e-324, 0.0);
    assert!(distance(p.jet.p, surface.rings(0).unwrap().center()) < 1e-15 && p.gauss.is_finite());
}

/// H of Catmull-Clark grows by mu / lambda^2 per ring in the end, mu the eigenvalue of Fourier
/// mode 2, (c + 5 + sqrt((c+1) (c+9))) / 16 with c = cos(4 pi / n): a check of curvature at depths
/// where world coordinates have long lost it.
#[test]
fn curvature_at_depth_follows_the_spectrum() {
    let eigenvalue = |turns: f64, n: f64| {
        let c = (std::f64::consts::TAU * turns / n).cos();
        (c + 5.0 + ((c + 1.0) * (c + 9.0)).sqrt()) / 16.0
    };
    for n in [5, 6, 8] {
        let name = format!("obstacle/saddle_n{n}.obj");
        let surface = common::surface(&common::cage(&name), SchemeKind::CatmullClark);
        let point = &surface.extraordinary_points()[0];
        let sector = point.sectors.iter().find(|s| s.center == [0.0, 0.0]).unwrap();
        let mean = |ring: i32| {
            let h = 0.5_f64.powi(ring);
            at(&surface, sector, 0.9 * h, 0.7 * h).mean
        };
        let growth = eigenvalue(2.0, f64::from(n)) / eigenvalue(1.0, f64::from(n)).powi(2);
        for ring in [60, 90] {
            let found = mean(ring + 1) / mean(ring);
            assert!((found / growth - 1.0).abs() < 1e-6, "n = {n}: {found}, {growth}");
        }
    }
}

/// With a quadratic or a guide the rings tend to copies of one another: curvature in a fixed
/// direction has a limit, and hundreds of rings later it is still that.
#[test]
fn bounded_curvature_has_a_limit_in_every_direction() {
    for scheme in SchemeKind::ALL.into_iter().filter(|s| s.has_center_curvature()) {
        for n in [3, 5, 8, 10] {
            let surface = common::surface(
                &common::cage(&format!("obstacle/paraboloid_par_n{n}.obj")),
                scheme,
            );
            let point = &surface.extraordinary_points()[0];
            let sector = point.sectors.iter().find(|s| s.center == [0.0, 0.0]).unwrap();
            for (a, b) in [(0.9, 0.0), (0.9, 0.6), (0.7, 0.7)] {
                let mean = |ring: i32| {
                    let h = 0.5_f64.powi(ring);
                    at(&surface, sector, a * h, b * h).mean
                };
                let limit = mean(200);
                assert!(
                    (mean(150) - limit).abs() < 1e-9 * limit.abs(),
                    "{} n = {n}",
                    scheme.name()
                );
                assert!(
                    (mean(900) - limit).abs() < 1e-11 * limit.abs(),
                    "{} n = {n}",
                    scheme.name()
                );
            }
        }
    }
}

/// Anywhere on cages with faces split to every level and n-gons: central differences of positions
/// and of first derivatives, which the C2 borders do not disturb.
#[test]
fn derivatives_agree_with_differences_at_random_points() {
    for name in ["own_polygons.obj", "own_blob_quadriflow_300.obj", "obstacle/pillow_n8.obj"] {
        for scheme in SchemeKind::ALL {
            let surface = common::surface(&common::cage(name), scheme);
            let mut random = Random::new(13);
            for _ in 0..200 {
                let quad = QuadId(random.below(surface.num_quads()) as u32);
                let [u, v] = [0, 1].map(|_| 0.02 + 0.96 * random.unit());
                let h = 1e-4;
                let jet = |u: f64, v: f64| surface.eval(quad, u, v).unwrap().jet;
                let here = jet(u, v);
                let slope = |a: Point, b: Point| scale(0.5 / h, sub(a, b));
                let (right, left) = (jet(u + h, v), jet(u - h, v));
                let (above, below) = (jet(u, v + h), jet(u, v - h));
                let size = norm(here.du) + norm(here.dv) + norm(here.duu) + norm(here.dvv);
                for (found, exact) in [
                    (slope(right.p, left.p), here.du),
                    (slope(above.p, below.p), here.dv),
                    (slope(right.du, left.du), here.duu),
                    (slope(above.du, below.du), here.duv),
                    (slope(above.dv, below.dv), here.dvv),
                ] {
                    // Third derivatives are bounded by 1/(distance to a point) times the second.
                    let gap = distance(found, exact);
                    assert!(gap < 0.02 * size, "{name}, {}: {gap} of {size}", scheme.name());
                }
            }
        }
    }
}
