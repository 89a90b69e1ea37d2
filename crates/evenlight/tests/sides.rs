//! Triangle meshes at infinitely sharp edges and at the seams of primvars.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::collections::{HashMap, HashSet};

use evenlight::io::load::Format;
use evenlight::io::{glb, obj, obj_out, ply, ply_out};
use evenlight::mesh::{Crease, FaceVaryingRule, INFINITELY_SHARP, Interpolation, Mesh, Primvar};
use evenlight::point::{cross, dot, norm, sub, unit};
use evenlight::task::Task;
use evenlight::tessellate::{CornerPrimvars, TriangleMesh, tessellate};
use evenlight::{Cage, SchemeKind, Surface, SurfaceOptions, VertexId};

/// Every cage in data/meshes/features, which together have every kind of feature.
fn features() -> impl Iterator<Item = (String, Surface)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/meshes/features");
    let files = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names.into_iter().map(|name| {
        let cage = common::cage(&format!("features/{name}"));
        let surface = common::surface(&cage, SchemeKind::Qas4);
        (name, surface)
    })
}

fn surface(mesh: Mesh) -> Surface {
    common::surface(&Cage::new(mesh).unwrap().into(), SchemeKind::Qas4)
}

/// The cube with corners at -1 and 1, all its edges infinitely sharp.
fn sharp_cube() -> Mesh {
    let positions = [0, 1, 3, 2, 4, 5, 7, 6]
        .map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -1.0 } else { 1.0 }));
    let faces =
        [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    let mut mesh = Mesh::new(positions.to_vec(), faces);
    mesh.tags.creases = faces
        .iter()
        .flat_map(|f| (0..4).map(|k| [f[k], f[(k + 1) % 4]]))
        .map(|edge| Crease { edge: edge.map(VertexId), sharpness: INFINITELY_SHARP })
        .collect();
    mesh
}

/// The triangles with the side of each of their corners.
fn corners(mesh: &TriangleMesh) -> impl Iterator<Item = (usize, usize, u32)> + '_ {
    let of = |(t, sides): (usize, &[u32; 3])| [0, 1, 2].map(|k| (t, k, sides[k]));
    mesh.sides().iter().enumerate().flat_map(of)
}

#[test]
fn every_face_of_a_sharp_cube_has_its_own_normal() {
    let surface = surface(sharp_cube());
    for rate in [1, 2, 5] {
        let mesh = tessellate(&surface, rate).unwrap();
        assert_eq!(mesh.positions.len(), 6 * rate * rate + 2);
        assert_eq!(mesh.normals.len(), 6 * (rate + 1) * (rate + 1));
        let lens = [mesh.gauss.len(), mesh.mean.len(), mesh.origins.len()];
        assert_eq!(lens, [mesh.normals.len(); 3]);
        for (t, _, side) in corners(&mesh) {
            let face = mesh.parametric_triangle(t).unwrap().quad.0 as usize;
            let normal =
                [[0, 0, -1], [0, 0, 1], [0, -1, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0]][face];
            assert!(norm(sub(mesh.normals[side as usize], normal.map(f64::from))) < 1e-15);
            let curvatures = [&mesh.gauss, &mesh.mean].map(|of| of[side as usize]);
            assert!(curvatures.iter().all(|k| k.abs() < 1e-15), "{curvatures:?}");
        }
    }
}

#[test]
fn smooth_cages_have_one_side_per_vertex() {
    for (name, cage) in common::all_cages() {
        let mesh = tessellate(&common::surface(&cage, SchemeKind::CatmullClark), 2).unwrap();
        assert!(!mesh.is_folded() && mesh.corner_sides.is_empty(), "{name}");
        assert_eq!(mesh.sides().as_ptr(), mesh.triangles.as_ptr());
        assert_eq!(mesh.normals.len(), mesh.positions.len());
    }
}

/// Boundaries, holes, corners and semi-sharp edges fold nothing; and there is no side that no
/// triangle has.
#[test]
fn there_are_no_more_sides_than_infinitely_sharp_edges_make() {
    let mut num_folded = 0;
    for (name, surface) in features() {
        let creases = &surface.tags().creases;
        let has_infinite = creases.iter().any(|crease| crease.sharpness >= INFINITELY_SHARP);
        let mesh = tessellate(&surface, 2).unwrap();
        assert!(has_infinite || !mesh.is_folded(), "{name}");
        num_folded += usize::from(mesh.is_folded());
        let used: HashSet<u32> = corners(&mesh).map(|(_, _, side)| side).collect();
        assert_eq!(used.len(), mesh.normals.len(), "{name}");
    }
    assert!(num_folded > 5);
}

/// Vertices stay where they are; normals and curvatures are those of the triangle's own quad.
#[test]
fn every_corner_has_the_normal_of_its_own_quad() {
    for (name, surface) in features() {
        let mesh = tessellate(&surface, 4).unwrap();
        for (t, k, side) in corners(&mesh) {
            assert_eq!(mesh.vertex_of_side(side), Some(mesh.triangles[t][k]));
            let place = mesh.parametric_triangle(t).unwrap();
            let [u, v] = place.uv[k];
            let own = surface.eval(place.quad, u, v).unwrap();
            let normal = mesh.normals[side as usize];
            assert!((norm(normal) - 1.0).abs() < 1e-14, "{name}");
            if !own.normal[0].is_nan() {
                assert!(norm(sub(normal, own.normal)) < 1e-9, "{name}: {normal:?} {own:?}");
            }
            if !own.gauss.is_nan() {
                let near = |a: f64, b: f64| (a - b).abs() < 1e-6 * (1.0 + b.abs());
                let [gauss, mean] = [&mesh.gauss, &mesh.mean].map(|of| of[side as usize]);
                assert!(near(gauss, own.gauss) && near(mean, own.mean), "{name}: {own:?}");
            }
        }
    }
}

/// Two triangles at an edge have the same sides at its ends, but along infinitely sharp edges of
/// the cage, where they have different sides, but at darts.
#[test]
fn sides_change_at_sharp_edges_only() {
    let mut num_folds = 0;
    for (name, surface) in features() {
        let mesh = tessellate(&surface, 4).unwrap();
        let mut sides: HashMap<[u32; 2], ([u32; 2], usize)> = HashMap::new();
        for (t, (vertices, of)) in mesh.triangles.iter().zip(mesh.sides()).enumerate() {
            for k in 0..3 {
                let next = (k + 1) % 3;
                sides.insert([vertices[k], vertices[next]], ([of[k], of[next]], t));
            }
        }
        for (&[a, b], &(own, t)) in &sides {
            let Some(&([other_b, other_a], _)) = sides.get(&[b, a]) else { continue };
            let is_fold = lies_on_sharp_edge(&surface, &mesh, [a, b], t);
            assert_eq!(own != [other_a, other_b], is_fold, "{name}: {a} to {b}");
            num_folds += usize::from(is_fold);
        }
    }
    assert!(num_folds > 200);
}

/// Whether an edge of triangle `t` is on an infinitely sharp edge of the cage.
fn lies_on_sharp_edge(surface: &Surface, mesh: &TriangleMesh, edge: [u32; 2], t: usize) -> bool {
    let place = mesh.parametric_triangle(t).unwrap();
    let uv = edge.map(|v| place.uv[mesh.triangles[t].iter().position(|&w| w == v).unwrap()]);
    let (face, corner) = surface.face_of(place.quad).unwrap();
    let topology = surface.topology();
    let n = topology.faces().corners(face).len();
    let side = match uv {
        [[_, 0.0], [_, 0.0]] => corner,
        [[0.0, _], [0.0, _]] => (corner + n - 1) % n,
        [[1.0, _], [1.0, _]] if n == 4 => 1,
        [[_, 1.0], [_, 1.0]] if n == 4 => 2,
        _ => return false,
    };
    surface.is_infinitely_sharp(topology.half_edge_at(face, side).unwrap().id())
}

/// A wheel of `2 f` quads around the origin, folded along the sharp y axis: on the left in the
/// plane z = x, on the right in z = -x.
fn folded_wheel(f: u32) -> Mesh {
    let num_rim = 4 * f;
    let rim = |k: u32| {
        let angle =
            std::f64::consts::FRAC_PI_2 + std::f64::consts::TAU * f64::from(k) / f64::from(num_rim);
        let x = if k.is_multiple_of(2 * f) { 0.0 } else { angle.cos() };
        [x, angle.sin(), -f64::abs(x)]
    };
    let positions = std::iter::once([0.0; 3]).chain((0..num_rim).map(rim)).collect();
    let at = |k: u32| 1 + k % num_rim;
    let faces = (0..2 * f).map(|k| [0, at(2 * k), at(2 * k + 1), at(2 * k + 2)]);
    let mut mesh = Mesh::new(positions, faces);
    let crease = |v: u32| Crease { edge: [0, v].map(VertexId), sharpness: INFINITELY_SHARP };
    mesh.tags.creases = vec![crease(at(0)), crease(at(2 * f))];
    mesh
}

/// Also where a fan of four faces or more has no tangent plane, and the normal is the mean of those
/// around: those on the same side.
#[test]
fn both_sides_of_a_folded_plane_are_flat() {
    for f in 1..=6 {
        let mesh = tessellate(&surface(folded_wheel(f)), 4).unwrap();
        // The origin, and 4 vertices on each of the two sharp edges.
        assert_eq!(mesh.side_vertices.len(), 1 + 4 + 4);
        for (t, _, side) in corners(&mesh) {
            let is_left = mesh.parametric_triangle(t).unwrap().quad.0 < f;
            let normal = unit([if is_left { -1.0 } else { 1.0 }, 0.0, 1.0]);
            assert!(norm(sub(mesh.normals[side as usize], normal)) < 1e-12, "{f} faces");
            assert!(
                mesh.gauss[side as usize].abs() < 1e-9 && mesh.mean[side as usize].abs() < 1e-9
            );
        }
    }
}

/// A sharp cube with seams, a second set of texture coordinates x + 2 and y, and colours.
fn painted_cube() -> Mesh {
    let mut mesh = common::mesh("features/uv_unfolded_cube.obj");
    mesh.tags.creases = sharp_cube().tags.creases;
    mesh.tags.face_varying = FaceVaryingRule::CornersOnly;
    let plane = |p: &[f64; 3]| [p[0] + 2.0, p[1]];
    let plane = mesh.positions.iter().flat_map(plane).collect();
    let light = |p: &[f64; 3]| p.map(|x| 0.3 + 0.5 * x);
    let light = mesh.positions.iter().flat_map(light).collect();
    let primvar = |name: &str, width, values| Primvar {
        name: name.to_owned(),
        interpolation: Interpolation::Vertex,
        width,
        values,
        indices: Vec::new(),
    };
    mesh.primvars.insert(0, primvar("plane", 2, plane));
    mesh.primvars.push(primvar("displayColor", 3, light));
    mesh.primvars.push(primvar("heat", 1, vec![0.5; 8]));
    mesh
}

fn painted() -> (TriangleMesh, CornerPrimvars) {
    let surface = surface(painted_cube());
    let mesh = tessellate(&surface, 4).unwrap();
    let primvars = mesh.corner_primvars(&surface);
    (mesh, primvars)
}

#[test]
fn texture_coordinates_come_first_by_name_and_colours_by_name() {
    let (_, primvars) = painted();
    let names: Vec<_> = primvars.uv_sets.iter().map(|set| (set.name.as_str(), set.width)).collect();
    assert_eq!(names, [("st", 2), ("plane", 2)]);
    let color = primvars.color.unwrap();
    assert_eq!((color.name.as_str(), color.width), ("displayColor", 3));
}

/// Split vertices are all different, and their triangles have at every corner the side and the
/// values that the mesh has there.
#[test]
fn split_vertices_have_one_value_of_everything() {
    let (mesh, CornerPrimvars { uv_sets, color }) = painted();
    let primvars: Vec<_> = uv_sets.iter().chain(&color).collect();
    let split = mesh.split(&primvars).unwrap();
    let key = |v: usize| (split.sides[v], split.values.iter().map(|of| of[v]).collect::<Vec<_>>());
    let keys: HashSet<_> = (0..split.sides.len()).map(key).collect();
    assert_eq!(keys.len(), split.sides.len());
    let mut is_used = vec![false; split.sides.len()];
    for (t, triangle) in split.triangles.iter().enumerate() {
        for (k, &v) in triangle.iter().enumerate() {
            is_used[v as usize] = true;
            let values: Vec<u32> = primvars.iter().map(|primvar| primvar.corners[t][k]).collect();
            assert_eq!(key(v as usize), (mesh.sides()[t][k], values));
        }
    }
    assert!(is_used.iter().all(|&used| used));
    // All seams are on sharp edges, but not all sharp edges are seams.
    assert_eq!(split.sides.len(), mesh.normals.len());
    assert_eq!(mesh.split(&[]).unwrap().triangles, mesh.sides());
}

/// Seams without folds, and folds without seams.
#[test]
fn vertices_are_split_along_seams_of_smooth_surfaces_too() {
    let mut cage = painted_cube();
    cage.tags.creases.clear();
    let surface = surface(cage);
    let mesh = tessellate(&surface, 4).unwrap();
    let primvars = mesh.corner_primvars(&surface);
    assert!(!mesh.is_folded());
    let split = mesh.split(&primvars.uv_sets.iter().collect::<Vec<_>>()).unwrap();
    // 14 values at 8 vertices, and 3 vertices along each of 7 seams.
    assert_eq!(split.sides.len(), mesh.positions.len() + (14 - 8) + 7 * 3);
    assert_eq!(mesh.split(&[&primvars.uv_sets[1]]).unwrap().triangles, mesh.triangles);
}

/// What a reader of glTF finds, in 32 bits.
struct Found {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<Vec<[f32; 2]>>,
    colors: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

fn glb_bytes(mesh: &TriangleMesh, primvars: &CornerPrimvars) -> Vec<u8> {
    let mut bytes = Vec::new();
    glb::write_textured(mesh, primvars, &mut bytes).unwrap();
    bytes
}

/// By the crate `gltf`, which checks the description against the rules of the format.
fn read_glb(bytes: &[u8]) -> Found {
    let gltf = gltf::Gltf::from_slice(bytes).unwrap();
    let blob = gltf.blob.as_deref().unwrap();
    let primitive = gltf.meshes().next().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(blob));
    let sets = 0..primitive
        .attributes()
        .filter(|(name, _)| matches!(name, gltf::Semantic::TexCoords(_)))
        .count();
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    Found {
        positions: reader.read_positions().unwrap().collect(),
        normals: reader.read_normals().unwrap().collect(),
        uvs: sets.map(|k| reader.read_tex_coords(k as u32).unwrap().into_f32().collect()).collect(),
        colors: reader.read_colors(0).map(|of| of.into_rgb_f32().collect()).unwrap_or_default(),
        triangles: indices.as_chunks().0.to_vec(),
    }
}

#[test]
fn welding_a_glb_by_position_gives_the_watertight_mesh() {
    let (mesh, primvars) = painted();
    let found = read_glb(&glb_bytes(&mesh, &primvars));
    assert!(found.positions.len() > mesh.positions.len());
    let mut vertices = HashMap::new();
    for (v, p) in mesh.positions.iter().enumerate() {
        vertices.insert(p.map(|x| (x as f32).to_bits()), v as u32);
    }
    assert_eq!(vertices.len(), mesh.positions.len());
    let weld = |v: u32| vertices[&found.positions[v as usize].map(f32::to_bits)];
    let welded: Vec<[u32; 3]> = found.triangles.iter().map(|t| t.map(weld)).collect();
    assert_eq!(welded, mesh.triangles);
    let edges: HashSet<_> = welded.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    assert_eq!(edges.len(), 3 * welded.len());
    assert!(edges.iter().all(|&[a, b]| edges.contains(&[b, a])));
}

/// A primvar that is (x + 2, y) in the cage is so on the surface; the axis of V runs down.
#[test]
fn a_glb_has_every_primvar_at_every_vertex() {
    let (mesh, primvars) = painted();
    let found = read_glb(&glb_bytes(&mesh, &primvars));
    let count = found.positions.len();
    assert!(
        [found.normals.len(), found.uvs[0].len(), found.uvs[1].len(), found.colors.len()]
            .iter()
            .all(|&len| len == count)
    );
    for (k, &[x, y, z]) in found.positions.iter().enumerate() {
        let [u, v] = found.uvs[1][k];
        assert!((u - (x + 2.0)).abs() < 1e-6 && (v - (1.0 - y)).abs() < 1e-6);
        for (light, x) in found.colors[k].iter().zip([x, y, z]) {
            assert!((light - (0.3 + 0.5 * x)).abs() < 1e-6);
        }
    }
    for (t, triangle) in found.triangles.iter().enumerate() {
        for (k, &v) in triangle.iter().enumerate() {
            let [u, w, ..] = primvars.uv_sets[0].values[primvars.uv_sets[0].corners[t][k] as usize];
            assert_eq!(found.uvs[0][v as usize], [u as f32, (1.0 - w) as f32]);
            let normal = mesh.normals[mesh.sides()[t][k] as usize];
            assert_eq!(found.normals[v as usize], normal.map(|x| x as f32));
        }
    }
}

#[test]
fn colours_are_cut_to_what_the_format_demands() {
    let (mesh, mut primvars) = painted();
    primvars.color.as_mut().unwrap().values[0] = [-0.5, 7.0, f64::NAN, 0.0];
    let found = read_glb(&glb_bytes(&mesh, &primvars));
    assert!(found.colors.contains(&[0.0, 1.0, 0.0]));
    assert!(found.colors.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
}

/// Colours of four numbers have an opacity, where a format has one.
#[test]
fn opacity_is_kept_or_missed() {
    let mut cage = painted_cube();
    let color = cage.primvars.iter_mut().find(|p| p.name == "displayColor").unwrap();
    color.values = color.values.chunks(3).flat_map(|rgb| [rgb[0], rgb[1], rgb[2], 0.25]).collect();
    color.width = 4;
    let surface = surface(cage);
    let mesh = tessellate(&surface, 2).unwrap();
    let primvars = mesh.corner_primvars(&surface);
    let bytes = glb_bytes(&mesh, &primvars);
    let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
    let primitive = gltf.meshes().next().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| gltf.blob.as_deref());
    let gltf::mesh::util::ReadColors::RgbaF32(colors) = reader.read_colors(0).unwrap() else {
        panic!("four floats")
    };
    assert!(colors.into_iter().all(|color| (color[3] - 0.25).abs() < 1e-6));
    let mut bytes = Vec::new();
    ply_out::write_textured(&mesh, &primvars, &mut bytes).unwrap();
    let read = ply::read(&bytes).unwrap().mesh;
    let color = read.primvars.iter().find(|p| p.name == "color").unwrap();
    assert!(color.width == 4 && color.values.iter().skip(3).step_by(4).all(|&a| a == 64.0 / 255.0));
    let omitted = obj_out::omitted(&mesh, &primvars);
    assert_eq!(omitted[1], "OBJ has no opacity: that of the primvar `displayColor` is left out");
}

#[test]
fn primvars_of_another_mesh_are_an_error() {
    let (_, primvars) = painted();
    let other = tessellate(&surface(sharp_cube()), 2).unwrap();
    let error = glb::write_textured(&other, &primvars, &mut Vec::new()).unwrap_err();
    assert_eq!(error.to_string(), "the primvar `st` is not of this mesh");
}

/// OBJ has numbers of their own for positions, texture coordinates and normals.
#[test]
fn obj_has_shared_positions_and_the_normals_of_all_sides() {
    let (mesh, primvars) = painted();
    let mut bytes = Vec::new();
    obj_out::write_textured(&mesh, &primvars, &mut bytes).unwrap();
    let read = obj::read(&bytes).unwrap().mesh;
    assert_eq!((&read.positions, read.faces.len()), (&mesh.positions, mesh.triangles.len()));
    let text = String::from_utf8(bytes).unwrap();
    let normals: Vec<[f64; 3]> = text
        .lines()
        .filter_map(|line| line.strip_prefix("vn "))
        .map(|line| {
            line.split(' ').map(|x| x.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap()
        })
        .collect();
    assert_eq!(normals, mesh.normals);
    let faces = text.lines().filter_map(|line| line.strip_prefix("f "));
    for (t, face) in faces.enumerate() {
        for (k, corner) in face.split(' ').enumerate() {
            let expected =
                [mesh.triangles[t][k], primvars.uv_sets[0].corners[t][k], mesh.sides()[t][k]];
            assert_eq!(corner, expected.map(|n| (n + 1).to_string()).join("/"));
        }
    }
    let uvs: Vec<_> =
        primvars.uv_sets[0].values.iter().flat_map(|value| &value[..2]).copied().collect();
    assert_eq!((read.primvars[0].name.as_str(), &read.primvars[0].values), ("st", &uvs));
    let color = primvars.color.as_ref().unwrap();
    let numbers = color.of_vertices(&mesh).unwrap();
    let colors: Vec<_> =
        numbers.iter().flat_map(|&k| &color.values[k as usize][..3]).copied().collect();
    assert_eq!((read.primvars[1].name.as_str(), &read.primvars[1].values), ("color", &colors));
    assert_eq!(
        obj_out::omitted(&mesh, &primvars),
        ["OBJ has one set of texture coordinates: the primvar `plane` is left out"]
    );
}

#[test]
fn ply_has_the_texture_of_corners_and_the_colours_of_vertices() {
    let (mesh, primvars) = painted();
    let mut bytes = Vec::new();
    ply_out::write_textured(&mesh, &primvars, &mut bytes).unwrap();
    let read = ply::read(&bytes).unwrap().mesh;
    assert_eq!(read.positions, mesh.positions);
    let find = |name: &str| read.primvars.iter().find(|p| p.name == name).unwrap();
    let (texture, color) = (find("st"), find("color"));
    let mut corners = primvars.uv_sets[0].corners.concat().into_iter();
    for &index in &texture.indices {
        let [u, v, ..] = primvars.uv_sets[0].values[corners.next().unwrap() as usize];
        let found = &texture.values[2 * index as usize..][..2];
        assert_eq!(found, [u, v].map(|x| f64::from(x as f32)));
    }
    for (light, p) in color.values.chunks_exact(3).zip(&mesh.positions) {
        assert!((0..3).all(|k| (light[k] - (0.3 + 0.5 * p[k])).abs() < 0.5 / 255.0 + 1e-12));
    }
    let omitted = ply_out::omitted(&mesh, &primvars);
    assert!(omitted.len() == 2 && omitted[0].starts_with("PLY has one normal for a vertex"));
}

/// No triangle is lit from behind.
#[test]
fn normals_of_sides_look_outward() {
    // One of these cages has a corner of a single face with an angle of 180.7 degrees, where the
    // surface itself turns over.
    for (name, surface) in features().filter(|(name, _)| name != "polygons_boundary.obj") {
        let mesh = tessellate(&surface, 8).unwrap();
        for (t, k, side) in corners(&mesh) {
            let [a, b, c] = mesh.triangles[t].map(|v| mesh.positions[v as usize]);
            let flat = unit(cross(sub(b, a), sub(c, a)));
            let cosine = dot(flat, mesh.normals[side as usize]);
            assert!(cosine > 0.5, "{name}: triangle {t}, corner {k}: {cosine}");
        }
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_byte() {
    let surface = surface(painted_cube());
    let bytes = [1, 2, 5].map(|num_threads| {
        Task::new().threads(num_threads).run(|| {
            let mesh = tessellate(&surface, 7).unwrap();
            glb_bytes(&mesh, &mesh.corner_primvars(&surface))
        })
    });
    assert!(bytes[0] == bytes[1] && bytes[1] == bytes[2]);
}

/// Topology tells where a seam is: values may be as near to each other as they like, measured by
/// what else there is.
#[test]
fn a_seam_of_a_quarter_beside_a_distant_island_remains() {
    // Two quads with a seam between them, a quarter wide, and a third quad far away in u.
    let text = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n\
                v 4 0 0\nv 5 0 0\nv 5 1 0\nv 4 1 0\n\
                vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                vt 1.25 0\nvt 2.25 0\nvt 2.25 1\nvt 1.25 1\n\
                vt 3e8 0\nvt 300000001 0\nvt 300000001 1\nvt 3e8 1\n\
                f 1/1 2/2 5/3 4/4\nf 2/5 3/6 6/7 5/8\nf 7/9 8/10 9/11 10/12\n";
    let (cage, _) = Format::Obj.read_cage(text.as_bytes()).unwrap();
    let surface = Surface::build(cage, SurfaceOptions::default()).unwrap();
    let mesh = tessellate(&surface, 4).unwrap();
    let primvars = mesh.corner_primvars(&surface);
    let split = mesh.split(&[&primvars.uv_sets[0]]).unwrap();
    assert_eq!(mesh.positions.len(), 2 * 25 - 5 + 25);
    assert_eq!(split.sides.len(), 3 * 25, "the five vertices on the seam are two each");
}
