//! The laws of triangle meshes of the limit surface.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::collections::{HashMap, HashSet};

use evenlight::mesh::{Mesh, Topology};
use evenlight::point::{Point, cross, dot, norm, sub, unit};
use evenlight::task::Task;
use evenlight::tessellate::{ParametricTriangle, TessellateError, TriangleMesh, tessellate};
use evenlight::{Cage, FaceId, SchemeKind, Surface, VertexId};

const CLOSED: [&str; 9] = [
    "pillow_n3",
    "pillow_n5",
    "pillow_n10",
    "frame_cube_n6",
    "frame_octa_long_n8",
    "frame_pyramid4",
    "frame_tet_tight_n6",
    "polycube_corner_m1",
    "polycube_corner_m3",
];

const OPEN: [&str; 4] = ["flat_n5", "monkey_n7", "paraboloid_n3", "planes3_cube_corner_n3"];

/// A cube of side 2 around the origin, one of its faces cut into two triangles.
fn cut_cube() -> Mesh {
    let positions = [0, 1, 3, 2, 4, 5, 7, 6]
        .map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -1.0 } else { 1.0 }));
    let faces: [&[u32]; 7] = [
        &[0, 3, 2, 1],
        &[4, 5, 6],
        &[4, 6, 7],
        &[0, 1, 5, 4],
        &[1, 2, 6, 5],
        &[2, 3, 7, 6],
        &[3, 0, 4, 7],
    ];
    Mesh::new(positions.to_vec(), faces)
}

fn obstacle(name: &str) -> Mesh {
    common::mesh(&format!("obstacle/{name}.obj"))
}

fn surface(mesh: Mesh, scheme: SchemeKind) -> Surface {
    common::surface(&Cage::new(mesh).unwrap().into(), scheme)
}

/// Every surface over the cages of `names`, and over the cube with triangles.
fn closed_surfaces() -> impl Iterator<Item = (String, Surface)> {
    let cages = CLOSED.map(|name| (name, obstacle(name))).into_iter();
    with_all_schemes(cages.chain([("cut cube", cut_cube())]))
}

fn open_surfaces() -> impl Iterator<Item = (String, Surface)> {
    with_all_schemes(OPEN.map(|name| (name, obstacle(name))).into_iter())
}

fn with_all_schemes(
    cages: impl Iterator<Item = (&'static str, Mesh)>,
) -> impl Iterator<Item = (String, Surface)> {
    cages.flat_map(|(name, mesh)| {
        SchemeKind::ALL.map(|s| (format!("{name}, scheme {}", s.name()), surface(mesh.clone(), s)))
    })
}

/// The directed edges of all triangles, with the triangle of each.
///
/// # Panics
///
/// If two triangles run through an edge in the same direction.
fn directed_edges(mesh: &TriangleMesh) -> HashMap<(u32, u32), usize> {
    let mut edges = HashMap::new();
    for (t, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        for edge in [(a, b), (b, c), (c, a)] {
            assert_eq!(edges.insert(edge, t), None, "two triangles have {edge:?} alike");
        }
    }
    edges
}

/// V - E + F of a closed cage.
fn euler_characteristic(topology: &Topology) -> i64 {
    let used = (0..topology.num_vertices() as u32).filter(|&v| topology.is_used(VertexId(v)));
    let num_edges = topology.half_edges().count() / 2;
    used.count() as i64 - num_edges as i64 + topology.faces().len() as i64
}

fn corners(mesh: &TriangleMesh, triangle: usize) -> [Point; 3] {
    mesh.triangles[triangle].map(|v| mesh.positions[v as usize])
}

/// The largest coordinate.
fn size(mesh: &TriangleMesh) -> f64 {
    mesh.positions.iter().flatten().fold(0.0, |size: f64, x| size.max(x.abs()))
}

#[test]
fn closed_cages_give_closed_meshes_of_the_same_genus() {
    for (name, surface) in closed_surfaces() {
        for rate in [1, 2, 3, 6] {
            let mesh = tessellate(&surface, rate).unwrap();
            let edges = directed_edges(&mesh);
            assert!(edges.keys().all(|&(a, b)| edges.contains_key(&(b, a))), "{name}: a gap");
            let chi =
                mesh.positions.len() as i64 - edges.len() as i64 / 2 + mesh.triangles.len() as i64;
            assert_eq!(chi, euler_characteristic(surface.topology()), "{name}, rate {rate}");
        }
    }
}

#[test]
fn no_point_is_stored_twice() {
    for (name, surface) in closed_surfaces() {
        let mesh = tessellate(&surface, 4).unwrap();
        let points: HashSet<_> = mesh.positions.iter().map(|p| p.map(f64::to_bits)).collect();
        assert_eq!(points.len(), mesh.positions.len(), "{name}");
    }
}

#[test]
fn every_vertex_lies_where_each_of_its_triangles_says() {
    for (name, surface) in closed_surfaces().chain(open_surfaces()) {
        let mesh = tessellate(&surface, 3).unwrap();
        let tolerance = 1e-12 * size(&mesh);
        assert_eq!(mesh.parametric_triangles().count(), mesh.triangles.len());
        for (t, parametric) in mesh.parametric_triangles().enumerate() {
            assert_eq!(mesh.parametric_triangle(t), Some(parametric));
            let ParametricTriangle { quad, uv } = parametric;
            for (p, [u, v]) in corners(&mesh, t).into_iter().zip(uv) {
                let q = surface.eval(quad, u, v).unwrap().jet.p;
                assert!(norm(sub(p, q)) <= tolerance, "{name}: {p:?} and {q:?}");
            }
            assert!(signed_area(uv) > 0.0);
        }
    }
}

fn signed_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[test]
fn vertices_are_computed_in_the_lowest_of_their_quads() {
    let surface = surface(cut_cube(), SchemeKind::EvolvingGuide);
    let mesh = tessellate(&surface, 4).unwrap();
    let mut lowest = vec![None; mesh.positions.len()];
    for (parametric, triangle) in mesh.parametric_triangles().zip(&mesh.triangles) {
        for &v in triangle {
            lowest[v as usize].get_or_insert(parametric.quad);
        }
    }
    for (k, origin) in mesh.origins.iter().enumerate() {
        assert_eq!(Some(origin.quad), lowest[k]);
        let point = surface.eval(origin.quad, origin.uv[0], origin.uv[1]).unwrap();
        assert_eq!((point.jet.p, point.normal), (mesh.positions[k], mesh.normals[k]));
    }
}

#[test]
fn meshes_are_open_along_omitted_faces_only() {
    for (name, cage) in common::all_cages() {
        let surface = common::surface(&cage, SchemeKind::CatmullClark);
        for rate in [1, 2, 5] {
            let mesh = tessellate(&surface, rate).unwrap();
            let edges = directed_edges(&mesh);
            let open = edges.iter().filter(|((a, b), _)| !edges.contains_key(&(*b, *a)));
            let mut num_open = 0;
            for (&edge, &triangle) in open {
                num_open += 1;
                assert!(beside_omitted_face(&surface, &mesh, edge, triangle), "{name}");
            }
            assert_eq!(num_open, mesh.rate * num_edges_beside_omitted_faces(&surface), "{name}");
        }
    }
}

/// Whether `edge` of `triangle` lies on an edge of the cage behind which is no surface.
fn beside_omitted_face(
    surface: &Surface,
    mesh: &TriangleMesh,
    edge: (u32, u32),
    triangle: usize,
) -> bool {
    let ParametricTriangle { quad, uv } = mesh.parametric_triangle(triangle).unwrap();
    let parameters = |v| uv[mesh.triangles[triangle].iter().position(|&w| w == v).unwrap()];
    let side = match (parameters(edge.0), parameters(edge.1)) {
        ([_, 0.0], [_, 0.0]) => 0,
        ([1.0, _], [1.0, _]) => 1,
        ([_, 1.0], [_, 1.0]) => 2,
        ([0.0, _], [0.0, _]) => 3,
        _ => return false,
    };
    let (face, corner) = surface.face_of(quad).unwrap();
    let num_corners = surface.topology().faces().corners(face).len();
    let is_inside_ngon = num_corners != 4 && (side == 1 || side == 2);
    let side = if side == 3 { corner + num_corners - 1 } else { corner + side };
    !is_inside_ngon && has_surface_on_one_side(surface, face, side % num_corners)
}

fn has_surface_on_one_side(surface: &Surface, face: FaceId, side: usize) -> bool {
    let topology = surface.topology();
    let behind = topology.half_edge_at(face, side).unwrap().twin().map(|h| h.face());
    !surface.is_omitted(face) && behind.is_none_or(|f| surface.is_omitted(f))
}

fn num_edges_beside_omitted_faces(surface: &Surface) -> usize {
    let faces = surface.topology().faces();
    let sides = |f| (0..faces.corners(f).len()).map(move |side| (f, side));
    faces.ids().flat_map(sides).filter(|&(f, k)| has_surface_on_one_side(surface, f, k)).count()
}

#[test]
fn triangles_look_outward() {
    for (name, surface) in closed_surfaces() {
        let mesh = tessellate(&surface, 8).unwrap();
        let mut volume = 0.0;
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = corners(&mesh, t);
            let normal = cross(sub(b, a), sub(c, a));
            volume += dot(a, cross(b, c)) / 6.0;
            for v in triangle {
                assert!(dot(normal, mesh.normals[*v as usize]) > 0.0, "{name}, triangle {t}");
            }
        }
        assert!(volume > 0.0, "{name}: volume {volume}");
    }
}

#[test]
fn normals_are_unit_vectors_and_curvature_exists_everywhere() {
    for (name, surface) in closed_surfaces().chain(open_surfaces()) {
        // At rate 1 a vertex may have no neighbour but extraordinary points.
        for rate in [1, 4] {
            let mesh = tessellate(&surface, rate).unwrap();
            assert!(mesh.normals.iter().all(|&n| (norm(n) - 1.0).abs() < 1e-14), "{name}");
            assert!(mesh.gauss.iter().chain(&mesh.mean).all(|x| x.is_finite()), "{name}");
        }
    }
}

/// A quad cut into three along two paths between opposite corners: the middle of each path has
/// two edges only, and no tangent plane.
#[test]
fn vertices_of_valence_2_have_a_normal_too() {
    let mut mesh = common::mesh("obstacle/polycube_corner_m2.obj");
    let faces: Vec<Vec<u32>> = mesh.faces.iter().map(|f| f.iter().map(|v| v.0).collect()).collect();
    let [a, b, c, d] = faces[0][..] else { unreachable!("the cage has quads only") };
    let middle = |x: u32, y: u32, z: u32| {
        let p = [x, y, z].map(|v| mesh.positions[v as usize]);
        [0, 1, 2].map(|k| (p[0][k] + p[1][k] + p[2][k]) / 3.0)
    };
    let added = [middle(a, b, c), middle(a, c, d)];
    let n = mesh.positions.len() as u32;
    mesh.positions.extend(added);
    let split = [vec![a, b, c, n], vec![a, n, c, n + 1], vec![a, n + 1, c, d]];
    let faces = split.into_iter().chain(faces.into_iter().skip(1));
    let mesh = Mesh::new(mesh.positions, faces);
    let surface = surface(mesh, SchemeKind::CatmullClark);
    let points = surface.extraordinary_points().iter().enumerate();
    let valence_2: Vec<usize> = points.filter(|(_, p)| p.valence == 2).map(|(k, _)| k).collect();
    assert_eq!(valence_2.len(), 2);
    assert!(valence_2.iter().all(|&k| surface.rings(k).unwrap().normal()[0].is_nan()));
    for rate in [1, 4] {
        let triangles = tessellate(&surface, rate).unwrap();
        assert!(triangles.normals.iter().all(|&n| (norm(n) - 1.0).abs() < 1e-14));
        assert!(triangles.gauss.iter().chain(&triangles.mean).all(|x| x.is_finite()));
    }
}

/// A plane sheet one of whose faces has a vertex in the middle of a straight edge, turned in space:
/// no digit of the derivatives there tells a normal.
#[test]
fn straight_corners_have_the_normal_of_what_is_around() {
    for turn in 0..12 {
        let (c, s) = f64::from(turn).sin_cos();
        let turned = |x: f64, y: f64| [c * x, 0.6 * s * x - 0.8 * y, 0.8 * s * x + 0.6 * y];
        let mut positions: Vec<Point> =
            (0..16).map(|k| turned(f64::from(k % 4), f64::from(k / 4))).collect();
        positions.push(turned(1.3, 0.0));
        let mut faces: Vec<Vec<u32>> =
            (0..9).map(|k| k % 3 + 4 * (k / 3)).map(|a| vec![a, a + 1, a + 5, a + 4]).collect();
        faces[1] = vec![1, 16, 2, 6, 5];
        let surface = surface(Mesh::new(positions, faces), SchemeKind::Qas4);
        let normal = unit(cross(turned(1.0, 0.0), turned(0.0, 1.0)));
        let mesh = tessellate(&surface, 4).unwrap();
        assert!(mesh.normals.iter().all(|&n| norm(sub(n, normal)) < 1e-9), "turn {turn}");
        assert!(mesh.gauss.iter().chain(&mesh.mean).all(|k| k.abs() < 1e-6), "turn {turn}");
    }
}

/// Two faces around a vertex have two edges in common, whose middles no diagonal joins.
#[test]
fn no_edge_is_one_of_four_triangles_at_valence_2() {
    // A beak: vertex 0 is its tip, 0-1 and 0-2 are near each other.
    let positions =
        vec![[0.0; 3], [1.0, 0.2, 0.0], [1.0, -0.2, 0.0], [2.0, 0.0, 0.5], [2.0, 0.0, -0.5]];
    let beak = Mesh::new(positions, [[0_u32, 1, 3, 2], [0, 2, 4, 1]]);
    let surface = surface(beak, SchemeKind::CatmullClark);
    for rate in [2, 4, 6] {
        let mesh = tessellate(&surface, rate).unwrap();
        assert!(directed_edges(&mesh).len() == 3 * mesh.triangles.len(), "rate {rate}");
    }
}

#[test]
fn extraordinary_points_are_vertices_with_the_limit_normal() {
    for (name, surface) in closed_surfaces() {
        let mesh = tessellate(&surface, 5).unwrap();
        for (k, point) in surface.extraordinary_points().iter().enumerate() {
            let rings = surface.rings(k).unwrap();
            let vertex = mesh.positions.iter().position(|&p| p == rings.center());
            let vertex = vertex.unwrap_or_else(|| panic!("{name}: no vertex at {point:?}"));
            assert_eq!(mesh.normals[vertex], rings.normal(), "{name}");
        }
    }
}

#[test]
fn a_flat_cage_gives_a_flat_mesh() {
    // The plane z = (2 x - y) / 4, so that no coordinate is flat for trivial reasons.
    let mut cage = obstacle("flat_n5");
    cage.positions.iter_mut().for_each(|p| p[2] = (2.0 * p[0] - p[1]) / 4.0);
    let normal = unit([-2.0, 1.0, 4.0]);
    for scheme in SchemeKind::ALL {
        let mesh = tessellate(&surface(cage.clone(), scheme), 7).unwrap();
        assert!(!mesh.triangles.is_empty());
        assert!(mesh.positions.iter().all(|&p| dot(p, normal).abs() < 1e-14));
        assert!(mesh.normals.iter().all(|&n| norm(sub(n, normal)) < 1e-13));
        assert!(mesh.gauss.iter().chain(&mesh.mean).all(|k| k.abs() < 1e-9));
    }
}

#[test]
fn total_curvature_is_that_of_the_topology() {
    // Gauss-Bonnet: the integral of K is 2 pi chi; here by the trapezoidal rule.
    for (name, surface) in closed_surfaces() {
        let mesh = tessellate(&surface, 32).unwrap();
        let total: f64 = (0..mesh.triangles.len())
            .map(|t| {
                let [a, b, c] = corners(&mesh, t);
                let k: f64 = mesh.triangles[t].iter().map(|&v| mesh.gauss[v as usize]).sum();
                k / 3.0 * norm(cross(sub(b, a), sub(c, a))) / 2.0
            })
            .sum();
        let chi = euler_characteristic(surface.topology()) as f64;
        let error = total / (2.0 * std::f64::consts::PI) - chi;
        assert!(error.abs() < 0.02 * chi.abs().max(1.0), "{name}: error {error}, chi {chi}");
    }
}

#[test]
fn the_rate_is_rounded_up_for_n_gons_only() {
    let rate =
        |mesh, rate| tessellate(&surface(mesh, SchemeKind::CatmullClark), rate).unwrap().rate;
    assert_eq!([1, 2, 3, 4].map(|r| rate(cut_cube(), r)), [2, 2, 4, 4]);
    assert_eq!([1, 2, 3].map(|r| rate(obstacle("pillow_n5"), r)), [1, 2, 3]);
}

#[test]
fn impossible_rates_are_errors() {
    let surface = surface(obstacle("pillow_n5"), SchemeKind::CatmullClark);
    assert_eq!(tessellate(&surface, 0), Err(TessellateError::ZeroRate));
    for rate in [10_000, 1 << 31, u32::MAX as usize, usize::MAX] {
        assert_eq!(tessellate(&surface, rate), Err(TessellateError::TooManyVertices { rate }));
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_byte() {
    let surface = surface(obstacle("frame_cube_n6"), SchemeKind::EvolvingGuide);
    let bytes = [1, 2, 5].map(|num_threads| {
        let mut bytes = Vec::new();
        let mesh = Task::new().threads(num_threads).run(|| tessellate(&surface, 7)).unwrap();
        evenlight::io::ply_out::write(&mesh, &mut bytes).unwrap();
        bytes
    });
    assert!(bytes[0] == bytes[1] && bytes[1] == bytes[2]);
}
