//! PLY cages: what is read, what is refused and in which words, and that nothing is lost.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use evenlight::Mesh;
use evenlight::io::ply::{self, Encoding, Ply, PlyPlace};
use evenlight::mesh::{BoundaryRule, Interpolation, Primvar};
use proptest::prelude::*;

const ENCODINGS: [Encoding; 3] = [Encoding::Ascii, Encoding::LittleEndian, Encoding::BigEndian];

/// A quad and a triangle on it, with all that a file can have.
const HOUSE: &str = "ply\n\
    format ascii 1.0\n\
    comment a house\n\
    obj_info front\n\
    element vertex 5\n\
    property uchar red\n\
    property float32 x\n\
    property double y\n\
    property int8 z\n\
    property uint8 green\n\
    property uchar blue\n\
    property float s\n\
    property list uchar int friends\n\
    property float t\n\
    property short heat\n\
    element edge 1\n\
    property int a\n\
    property int b\n\
    element face 2\n\
    property uchar material\n\
    property list uint8 int32 vertex_indices\n\
    property list uchar float texcoord\n\
    end_header\n\
    255 0 0 0 0 51 0 1 7 .5 -3\n\
    0 1 0 0 0 0 .25 0 .5 4\n\
    0 1 1 0 0 0 .5 2 1 2 .5 5\n\
    0 0 1 0 0 0 .75 0 .5 6 0 0.5 1.5 0 0 0 1 0 .5 7\n\
    0 1\n\
    9 4 0 1 2 3 8 0 0 1 0 1 1 0 1\n\
    9 3 3 2 4 6 0 1 1 1 .5 .75\n";

fn read(text: &str) -> Ply {
    ply::read(text.as_bytes()).unwrap()
}

fn error(text: &str) -> String {
    ply::read(text.as_bytes()).unwrap_err().to_string()
}

fn written(mesh: &Mesh, encoding: Encoding) -> Vec<u8> {
    let mut bytes = Vec::new();
    ply::write(mesh, encoding, &mut bytes).unwrap();
    bytes
}

fn primvar(name: &str, width: usize, values: &[f64]) -> Primvar {
    let (interpolation, indices) = (Interpolation::Vertex, vec![]);
    Primvar { name: name.to_owned(), interpolation, width, values: values.to_vec(), indices }
}

#[test]
fn a_file_with_everything() {
    let Ply { mesh, remarks, .. } = read(HOUSE);
    let positions = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0.5, 1.5, 0.]];
    let expected = Mesh::new(positions, [&[0, 1, 2, 3][..], &[3, 2, 4]]);
    assert_eq!((&mesh.positions, &mesh.faces), (&expected.positions, &expected.faces));
    let corners = Primvar {
        interpolation: Interpolation::FaceVarying,
        indices: vec![0, 1, 2, 3, 3, 2, 4],
        ..primvar("st", 2, &[0., 0., 1., 0., 1., 1., 0., 1., 0.5, 0.75])
    };
    let mut colors = [0.0; 15];
    (colors[0], colors[2]) = (1.0, 0.2);
    let primvars = [
        corners,
        primvar("color", 3, &colors),
        primvar("st_", 2, &[0.0, 0.5, 0.25, 0.5, 0.5, 0.5, 0.75, 0.5, 1.0, 0.5]),
        primvar("heat", 1, &[-3.0, 4.0, 5.0, 6.0, 7.0]),
    ];
    assert_eq!(mesh.primvars, primvars);
    let skipped = [
        "the property `friends` of `vertex` is skipped",
        "the element `edge` (1) is skipped",
        "the property `material` of `face` is skipped",
    ];
    assert_eq!(remarks, skipped);
}

#[test]
fn all_ways_to_write_it_mean_the_same() {
    let house = read(HOUSE);
    let (header, body) = HOUSE.split_once("end_header\n").unwrap();
    for variant in [
        HOUSE.replace('\n', "\r\n"),
        HOUSE.replace('\n', "\r"),
        HOUSE.replace("vertex_indices", "vertex_index"),
        HOUSE.replace("int8", "char").replace("uchar32", "uint8"),
        format!("{header}end_header\n{}", body.replace(' ', "\n")),
        format!("{header}end_header\n{}", body.replace('\n', " ")),
        HOUSE.trim_end().to_owned(),
        HOUSE.to_owned() + "\n \t\n",
    ] {
        let found = read(&variant);
        assert_eq!((&found.mesh, &found.remarks), (&house.mesh, &house.remarks), "{variant}");
        // Where every item keeps its line, all is equal.
        if variant.trim_end().lines().count() == HOUSE.trim_end().lines().count() {
            assert_eq!(found, house, "{variant}");
        }
    }
    let more = read(&(HOUSE.to_owned() + "1 2\n"));
    assert_eq!(more.mesh, house.mesh);
    assert_eq!(more.remarks.last().unwrap(), "4 bytes after the last element are ignored");
}

/// What the format says in bytes, written by hand.
#[test]
fn binary_files_have_the_order_of_bytes_that_they_say() {
    let header = |order: &str| {
        format!(
            "ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty short x\n\
             property float y\nproperty double z\nelement face 1\n\
             property list ushort uint vertex_index\nend_header\n"
        )
    };
    let (mut little, mut big) = (header("little").into_bytes(), header("big").into_bytes());
    for (x, y, z) in [(-2i16, 0.5f32, 0.1f64), (258, -1e9, 1e-300), (0, 0.0, -0.0)] {
        little.extend([&x.to_le_bytes()[..], &y.to_le_bytes(), &z.to_le_bytes()].concat());
        big.extend([&x.to_be_bytes()[..], &y.to_be_bytes(), &z.to_be_bytes()].concat());
    }
    little.extend(b"\x03\0\0\0\0\0\x01\0\0\0\x02\0\0\0");
    big.extend(b"\0\x03\0\0\0\0\0\0\0\x01\0\0\0\x02");
    let positions = vec![[-2.0, 0.5, 0.1], [258.0, -1e9, 1e-300], [0.0, 0.0, -0.0]];
    let expected = Mesh::new(positions, [[0, 1, 2]]);
    assert_eq!(ply::read(&little).unwrap().mesh, expected);
    assert_eq!(ply::read(&big).unwrap().mesh, expected);
    // An index out of range, and a file cut short anywhere, are named by byte.
    let at = little.len() - 4;
    little[at] = 3;
    let fault = ply::read(&little).unwrap_err();
    assert_eq!((fault.place, fault.item), (PlyPlace::Byte(at), Some(("face".to_owned(), 0))));
    for len in header("big").len()..big.len() {
        let fault = ply::read(&big[..len]).unwrap_err();
        assert!(fault.message.starts_with("the file ends before its last element"));
    }
}

#[test]
fn faulty_files_are_told_the_place_and_what_to_do() {
    let swap = |from: &str, to: &str| {
        assert!(HOUSE.contains(from), "{from}");
        HOUSE.replacen(from, to, 1)
    };
    for (text, expected) in [
        (String::new(), "line 1: the file does not begin with the line `ply`: it is empty"),
        (
            "v 0 0 0\n".to_owned(),
            "line 1: the file does not begin with the line `ply`: it looks like OBJ: let its name end",
        ),
        (
            "plx\n".to_owned(),
            "line 1: the file does not begin with the line `ply`: let its name end in that of its",
        ),
        ("ply\n".to_owned(), "line 1: the header has no end: add the line `end_header`"),
        ("ply\nend_header\n".to_owned(), "line 2: the header names no format: add"),
        (swap("ascii", "text"), "line 2: `text` is no format: it can be ascii, binary_"),
        (
            swap("1.0", "2.0"),
            "line 2: version 2.0 of PLY is not known: write the file as `format ascii 1.0`",
        ),
        (
            swap("comment", "note"),
            "line 3: `note a house` is no line of a header: they are written as",
        ),
        (
            swap("vertex 5", "vertex five"),
            "line 5: `five` is no number of items: write how many follow, as in `element vertex 8`",
        ),
        (swap("vertex 5", "vertex -5"), "line 5: `-5` is no number of items"),
        (swap("vertex 5", "node 5"), "line 23: there is no element `vertex`: add it"),
        (swap("float32 x", "float32 X"), "line 5: the element `vertex` has no number `x`: add"),
        (swap("float32 x", "list uchar int x"), "line 5: the element `vertex` has no number `x`"),
        (swap("float32 x", "float128 x"), "line 7: `float128` is no type: it can be char, uchar,"),
        (swap("float32 x", "float32"), "line 7: a property is written as in"),
        (swap("green", "red"), "line 10: there is another property `red`: rename one"),
        (swap("element edge", "element vertex"), "line 16: there is another element `vertex`"),
        (swap("list uint8 int32", "list float int32"), "line 21: the number of values in a list"),
        (
            swap("uint8 int32 vertex", "uint8 float vertex"),
            "line 19: the element `face` has no list",
        ),
        (swap("vertex_indices", "corners"), "line 19: the element `face` has no list `vertex_ind"),
        (
            swap("property int a\nproperty int b\n", ""),
            "line 16: the element `edge` has no properties: delete it",
        ),
        (swap("0 1 0 0 0 0 .25", "0 x 0 0 0 0 .25"), "line 25, vertex 1: `x` is not a number"),
        (
            swap("255 0 0 0", "255 0 0 .5"),
            "line 24, vertex 0: `.5` is not a whole number from -128",
        ),
        (swap("255 0", "256 0"), "line 24, vertex 0: `256` is not a whole number from 0 to 255"),
        (swap("9 3 3 2 4", "9 3 3 2 5"), "line 30, face 1: a corner asks for vertex 5, but the"),
        (swap("9 3 3 2 4", "9 3 3 2 -1"), "line 30, face 1: a corner asks for vertex -1"),
        (swap("9 3 3 2 4 6", "9 3 3 2 4 5"), "line 30, face 1: `texcoord` has 5 numbers for 3"),
        (swap(" 1 .5 .75\n", ""), "line 30, face 1: the file ends before its last element: corr"),
        (swap("face 2", "face 99999999999999"), "line 31, face 2: the file ends before its last"),
    ] {
        let found = error(&text);
        assert!(found.starts_with(expected), "{expected}\n{found}");
    }
}

#[test]
fn a_count_of_corners_must_not_be_negative() {
    let text = "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\n\
                property int z\nelement face 1\nproperty list char int vertex_index\nend_header\n\
                0 0 0\n-1\n";
    assert_eq!(error(text), "line 11, face 0: the list `vertex_index` has -1 values");
}

#[test]
fn primvars_that_are_not_finite_are_left_out_and_positions_are_judged_with_the_mesh() {
    let Ply { mesh, remarks, .. } = read(&HOUSE.replace(".25 0 .5 4", "nan 0 .5 4"));
    assert!(mesh.primvars.iter().all(|p| p.name != "st_"));
    let expected = "the primvar `st_` has values that are not finite: it is left out";
    assert_eq!(remarks.last().unwrap(), expected);
    let mesh = read(&HOUSE.replace("255 0 0", "255 inf 0")).mesh;
    let fault = evenlight::Cage::new(mesh).unwrap_err().to_string();
    assert!(fault.starts_with("vertex 0 is at (inf, 0, 0): give it"), "{fault}");
}

#[test]
fn what_has_no_place_is_named() {
    let mut mesh = read(HOUSE).mesh;
    assert!(ply::omitted(&mesh).is_empty());
    mesh.tags.boundary = BoundaryRule::None;
    mesh.primvars.push(primvar("x", 1, &[0.0; 5]));
    mesh.primvars
        .push(Primvar { interpolation: Interpolation::Varying, ..primvar("flow", 1, &[0.0; 5]) });
    let expected = [
        "PLY has no place for creases, corners, holes and rules: they are left out",
        "PLY has no place for the primvar `x`: it is left out",
        "PLY has no place for the primvar `flow`: it is left out",
    ];
    assert_eq!(ply::omitted(&mesh), expected);
}

#[test]
fn bytes_of_colours_stay_bytes() {
    let mesh = read(HOUSE).mesh;
    let text = String::from_utf8(written(&mesh, Encoding::Ascii)).unwrap();
    assert!(text.contains("\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"));
    assert!(text.contains("\n0 0 0 255 0 51 "));
    let mut dim = mesh.clone();
    dim.primvars[1].values[0] = 0.3;
    let text = String::from_utf8(written(&dim, Encoding::Ascii)).unwrap();
    assert!(text.contains("\nproperty double red\n") && text.contains("\n0 0 0 0.3 0 0.2 "));
    assert_eq!(read(&text).mesh, dim);
}

#[test]
fn a_face_of_many_corners_is_written_with_a_wider_count() {
    let positions = (0..300).map(|k| [k.into(), 0.0, 0.0]).collect();
    let mesh = Mesh::new(positions, [(0..300).collect::<Vec<u32>>(), vec![2, 1, 0]]);
    for encoding in ENCODINGS {
        assert_eq!(ply::read(&written(&mesh, encoding)).unwrap().mesh, mesh);
    }
}

/// Meshes with everything that PLY can hold.
fn full_mesh() -> impl Strategy<Value = Mesh> {
    let number = || prop::num::f64::NORMAL | prop::num::f64::ZERO;
    let sizes = (1usize..20, 1usize..10);
    sizes.prop_flat_map(move |(num_vertices, num_faces)| {
        let corner = (0..num_vertices as u32, -2..2i32);
        (
            prop::collection::vec(prop::array::uniform3(number()), num_vertices),
            prop::collection::vec(prop::collection::vec(corner, 0..6), num_faces),
            prop::collection::vec(0..=255u8, 4 * num_vertices),
            prop::collection::vec(number(), 3 * num_vertices),
            prop::collection::vec(number(), num_vertices),
        )
            .prop_map(|(positions, faces, colors, flow, heat)| {
                let corners = faces.iter().map(|f| f.iter().map(|c| c.0).collect::<Vec<_>>());
                let mut mesh = Mesh::new(positions, corners);
                mesh.primvars.extend(uvs(faces.iter().flatten()));
                let colors: Vec<f64> = colors.iter().map(|&c| f64::from(c) / 255.0).collect();
                mesh.primvars.push(primvar("color", 4, &colors));
                mesh.primvars.push(primvar("flow", 3, &flow));
                mesh.primvars.push(primvar("heat", 1, &heat));
                mesh
            })
    })
}

/// A face-varying primvar in the form that the reader makes: in the order of the corners.
fn uvs<'a>(corners: impl Iterator<Item = &'a (u32, i32)>) -> Option<Primvar> {
    let (mut known, mut indices) = (Vec::new(), Vec::new());
    for corner in corners {
        let place = known.iter().position(|k| k == corner).unwrap_or(known.len());
        if place == known.len() {
            known.push(*corner);
        }
        indices.push(place as u32);
    }
    let values: Vec<f64> = known.iter().flat_map(|&(v, k)| [v.into(), k.into()]).collect();
    let interpolation = Interpolation::FaceVarying;
    let uvs = Primvar { interpolation, indices, ..primvar("st", 2, &values) };
    (!values.is_empty()).then_some(uvs)
}

proptest! {
    /// PLY -> PLY keeps all that the format can hold, to the last bit, in all three encodings.
    #[test]
    fn everything_is_read_as_it_was_written(mesh in full_mesh()) {
        prop_assert!(ply::omitted(&mesh).is_empty());
        for encoding in ENCODINGS {
            let bytes = written(&mesh, encoding);
            let read = ply::read(&bytes).unwrap();
            prop_assert_eq!(&read.mesh, &mesh);
            prop_assert!(read.remarks.is_empty());
            prop_assert_eq!(written(&read.mesh, encoding), bytes);
        }
    }
}

#[test]
fn faults_of_the_mesh_are_named_by_number_and_line_in_text_alone() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
                end_header\n0 0 0\n1 0\n0 0 nan 0\n\n4 0 1\n2 1\n";
    let fault = |bytes: &[u8]| {
        let loaded = evenlight::io::load::Format::Ply.read(bytes, None).unwrap();
        loaded.check().unwrap_err().to_string()
    };
    let expected = "2 faults:\n  vertex 2 (line 12) is at (0, NaN, 0): give it coordinates that are \
                    finite numbers\n  face 0 (line 14) comes to vertex 1 (line 11) more than once:";
    let found = fault(text.as_bytes());
    assert!(found.starts_with(expected), "{found}");
    assert!(found.ends_with(" (vertices and faces are counted from 0)"), "{found}");
    let binary = fault(&written(&read(text).mesh, Encoding::LittleEndian));
    let without = ["12", "14", "11"]
        .iter()
        .fold(found, |text, line| text.replace(&format!(" (line {line})"), ""));
    assert_eq!(binary, without);
}
