//! What is written is what readers of the formats find.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use evenlight::io::{bv, glb, obj_out, ply_out, stl};
use evenlight::mesh::Mesh;
use evenlight::patch::Patch;
use evenlight::surface::{PlacedPatch, Role};
use evenlight::tessellate::TriangleMesh;
use evenlight::{Cage, SchemeKind, Surface, SurfaceOptions};

/// A tetrahedron with a vertex in each format's dark corners: no curvature, no normal.
fn tetrahedron() -> TriangleMesh {
    let third = 1.0 / 3.0;
    TriangleMesh {
        positions: vec![[0.0; 3], [third, 0.0, 0.0], [0.0, 1e-7, 0.0], [0.0, -0.0, 2.5]],
        normals: vec![[-0.6, -0.8, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f64::NAN; 3]],
        gauss: vec![0.0, 0.25, -3.0, f64::NAN],
        mean: vec![-1.0, 0.5, 0.0, f64::NAN],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        ..TriangleMesh::default()
    }
}

fn written(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    bytes
}

#[test]
fn obj_has_a_line_for_everything() {
    let text = String::from_utf8(written(|out| obj_out::write(&tetrahedron(), out))).unwrap();
    let expected = "v 0 0 0\nv 0.3333333333333333 0 0\nv 0 1e-7 0\nv 0 -0 2.5\n\
                    vn -0.6 -0.8 0\nvn 1 0 0\nvn 0 1 0\nvn 0 0 0\n\
                    f 1//1 3//3 2//2\nf 1//1 2//2 4//4\nf 2//2 3//3 4//4\nf 3//3 1//1 4//4\n";
    assert_eq!(text, expected);
}

#[test]
fn obj_is_read_by_our_own_reader() {
    let mesh = tetrahedron();
    let read = evenlight::io::obj::read(&written(|out| obj_out::write(&mesh, out))).unwrap();
    assert_eq!(read.mesh, Mesh::new(mesh.positions, mesh.triangles));
}

#[test]
fn stl_has_its_layout() {
    let mesh = tetrahedron();
    let bytes = written(|out| stl::write(&mesh, out));
    assert!(!bytes.starts_with(b"solid"), "this word means text");
    assert_eq!(bytes.len(), 84 + 50 * mesh.triangles.len());
    assert_eq!(bytes[80..84], 4u32.to_le_bytes());
    for (facet, triangle) in bytes[84..].chunks_exact(50).zip(&mesh.triangles) {
        let numbers: Vec<f32> = (0..12).map(|k| f32_at(facet, 4 * k)).collect();
        let corners = triangle.iter().flat_map(|&v| mesh.positions[v as usize]);
        assert!(numbers[3..].iter().zip(corners).all(|(&x, y)| x == y as f32));
        assert!((numbers[..3].iter().map(|x| x * x).sum::<f32>() - 1.0).abs() < 1e-6);
        assert_eq!(facet[48..], [0, 0]);
    }
    assert_eq!([0, 4, 8].map(|at| f32_at(&bytes[84..], at)), [0.0, 0.0, -1.0]);
}

fn f32_at(bytes: &[u8], at: usize) -> f32 {
    f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

/// The elements of a binary little-endian PLY file, in order: their names, and for each item
/// its properties as numbers. Written after the format, not after the writer.
fn parse_ply(bytes: &[u8]) -> Vec<(String, Vec<Vec<Property>>)> {
    const END: &[u8] = b"end_header\n";
    let header_len = bytes.windows(END.len()).position(|w| w == END).unwrap() + END.len();
    let header = std::str::from_utf8(&bytes[..header_len]).unwrap();
    assert!(header.starts_with("ply\nformat binary_little_endian 1.0\n"));
    let mut elements: Vec<(String, usize, Vec<Vec<&str>>)> = Vec::new();
    for line in header.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        match words[0] {
            "element" => elements.push((words[1].into(), words[2].parse().unwrap(), vec![])),
            "property" => elements.last_mut().unwrap().2.push(words[1..].to_vec()),
            "ply" | "format" | "comment" | "end_header" => {}
            _ => panic!("header line {line:?}"),
        }
    }
    let mut body = &bytes[header_len..];
    let mut parse_element = |(name, count, properties): (String, usize, Vec<Vec<&str>>)| {
        let mut item = || properties.iter().map(|p| parse_property(p, &mut body)).collect();
        (name, (0..count).map(|_| item()).collect())
    };
    let parsed = elements.into_iter().map(&mut parse_element).collect();
    assert!(body.is_empty(), "bytes are left");
    parsed
}

/// The name and the values of a property of one item.
type Property = (String, Vec<f64>);

fn parse_property(words: &[&str], body: &mut &[u8]) -> Property {
    match words {
        ["list", count, kind, name] => {
            let count = parse_number(count, body) as usize;
            (name.to_string(), (0..count).map(|_| parse_number(kind, body)).collect())
        }
        [kind, name] => (name.to_string(), vec![parse_number(kind, body)]),
        _ => panic!("property {words:?}"),
    }
}

fn parse_number(kind: &str, body: &mut &[u8]) -> f64 {
    fn take<const N: usize>(body: &mut &[u8]) -> [u8; N] {
        let (bytes, rest) = body.split_first_chunk().expect("the file is too short");
        *body = rest;
        *bytes
    }
    match kind {
        "uchar" => f64::from(u8::from_le_bytes(take(body))),
        "int" => f64::from(i32::from_le_bytes(take(body))),
        "float" => f64::from(f32::from_le_bytes(take(body))),
        "double" => f64::from_le_bytes(take(body)),
        _ => panic!("type {kind}"),
    }
}

#[test]
fn ply_is_read_by_an_independent_reader() {
    let mesh = tetrahedron();
    let elements = parse_ply(&written(|out| ply_out::write(&mesh, out)));
    let [(vertex, vertices), (face, faces)] = &elements[..] else { panic!("{elements:?}") };
    assert_eq!((vertex.as_str(), face.as_str()), ("vertex", "face"));
    let names = ["x", "y", "z", "nx", "ny", "nz", "gauss_curvature", "mean_curvature"];
    for (k, properties) in vertices.iter().enumerate() {
        assert!(properties.iter().map(|p| &p.0).eq(names));
        let values: Vec<f64> = properties.iter().flat_map(|p| p.1.clone()).collect();
        assert_eq!(values[..3], mesh.positions[k]);
        let rest = mesh.normals[k].into_iter().chain([mesh.gauss[k], mesh.mean[k]]);
        for (&value, x) in values[3..].iter().zip(rest) {
            assert_eq!((value as f32).to_bits(), (x as f32).to_bits());
        }
    }
    for (properties, triangle) in faces.iter().zip(&mesh.triangles) {
        assert_eq!(properties[..], [("vertex_indices".into(), triangle.map(f64::from).to_vec())]);
    }
    assert_eq!((vertices.len(), faces.len()), (4, 4));
}

/// The crate `gltf` checks the file's description against the format's rules.
#[test]
fn glb_is_read_by_an_independent_reader() {
    let mesh = tetrahedron();
    let bytes = written(|out| glb::write(&mesh, out));
    assert!(bytes.len().is_multiple_of(4));
    let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = gltf.blob.as_deref().unwrap();
    let primitive = gltf.meshes().next().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(blob));
    let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
    assert_eq!(positions, mesh.positions.iter().map(|p| p.map(|x| x as f32)).collect::<Vec<_>>());
    let bounds = primitive.bounding_box();
    assert_eq!((bounds.min, bounds.max), ([0.0; 3], [1.0f32 / 3.0, 1e-7, 2.5]));
    let normals: Vec<[f32; 3]> = reader.read_normals().unwrap().collect();
    assert_eq!(normals, [[-0.6, -0.8, 0.0], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]]);
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    assert_eq!(indices, mesh.triangles.concat());
    for (name, values) in
        [("GAUSS_CURVATURE", [0.0, 0.25, -3.0, 0.0]), ("MEAN_CURVATURE", [-1.0, 0.5, 0.0, 0.0])]
    {
        let semantic = gltf::Semantic::Extras(name.to_owned());
        let accessor = primitive.get(&semantic).unwrap();
        let values_found = gltf::accessor::Iter::<f32>::new(accessor, |_| Some(blob)).unwrap();
        assert_eq!(values_found.collect::<Vec<_>>(), values);
    }
}

#[test]
fn glb_refuses_what_the_format_cannot_hold() {
    let mut mesh = tetrahedron();
    mesh.positions[0][1] = 1e39;
    let error = glb::write(&mesh, &mut Vec::new()).unwrap_err().to_string();
    assert!(error.starts_with("a coordinate is too large for the 32 bits of glTF"));
    let error = glb::write(&TriangleMesh::default(), &mut Vec::new()).unwrap_err().to_string();
    assert_eq!(error, "a glTF file needs a triangle");
}

/// A bilinear patch at height `z`.
fn placed(role: Role, z: f64) -> PlacedPatch {
    let square = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]])).unwrap();
    let surface = Surface::build(cage, SurfaceOptions::default()).unwrap();
    let mut place = surface.patch_places(0).next().unwrap();
    place.role = role;
    let coefs = vec![[0.0, 0.0, z], [0.0, 1.0, z], [1.0, 0.0, z], [1.0, 1.0, z]];
    PlacedPatch { place, patch: Patch::new([1, 1], coefs).unwrap() }
}

#[test]
fn bv_has_one_group_for_each_role_whatever_the_order() {
    let mixed = [
        placed(Role::Ring(1), 1.0),
        placed(Role::Regular, 2.0),
        placed(Role::Ring(0), 3.0),
        placed(Role::Regular, 4.0),
        placed(Role::Ring(1), 0.1),
    ];
    let text = String::from_utf8(written(|out| bv::write(mixed, out))).unwrap();
    let patch = |z| format!("5 1 1\n0 0 {z}\n0 1 {z}\n1 0 {z}\n1 1 {z}\n");
    let expected = format!(
        "Group 0 regular\n{}{}Group 1 ring-1\n{}Group 2 ring-2\n{}{}",
        patch(2.0),
        patch(4.0),
        patch(3.0),
        patch(1.0),
        patch(0.1)
    );
    assert_eq!(text, expected);
}

#[test]
fn bv_of_no_patches_is_empty() {
    assert!(written(|out| bv::write([], out)).is_empty());
}

#[test]
fn bv_gives_back_every_patch_to_the_last_bit() {
    let surface = common::surface(
        &common::cage("obstacle/polycube_corner_m2.obj"),
        SchemeKind::EvolvingGuide,
    );
    let text = String::from_utf8(written(|out| bv::write(surface.patches(4), out))).unwrap();
    let groups = bv::read(&text).unwrap();
    let mut num_patches = 0;
    for group in &groups {
        let is_of_group = |p: &PlacedPatch| group.name == p.place.role.to_string();
        let patches: Vec<Patch> = surface.patches(4).filter(is_of_group).map(|p| p.patch).collect();
        assert_eq!(group.patches, patches, "{}", group.name);
        num_patches += patches.len();
    }
    assert!(num_patches > 0);
    assert_eq!(num_patches, surface.patches(4).count());
}

#[test]
fn a_full_disk_is_an_error() {
    let mesh = tetrahedron();
    assert!(obj_out::write(&mesh, &mut &mut [0; 10][..]).is_err());
    assert!(ply_out::write(&mesh, &mut &mut [0; 10][..]).is_err());
    assert!(stl::write(&mesh, &mut &mut [0; 10][..]).is_err());
    assert!(glb::write(&mesh, &mut &mut [0; 10][..]).is_err());
    assert!(bv::write([placed(Role::Regular, 0.0)], &mut &mut [0; 10][..]).is_err());
}
