//! The OBJ reader: what it accepts, what it refuses and in which words.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use evenlight::io::load::Format;
use evenlight::io::load::Notice;
use evenlight::io::obj::{self, Obj, UnknownTag};
use evenlight::{Cage, FaceId, Mesh, VertexId};
use proptest::prelude::*;

/// A square and a triangle on it, with all that a corner can ask for.
const HOUSE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 1.5 0\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 1 0 0\n";

fn house() -> Mesh {
    let positions = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0.5, 1.5, 0.]];
    Mesh::new(positions, [&[0, 1, 2, 3][..], &[3, 2, 4]])
}

/// Positions and faces alone.
fn shape(mesh: Mesh) -> Mesh {
    Mesh { positions: mesh.positions, faces: mesh.faces, ..Mesh::default() }
}

fn read(text: impl AsRef<[u8]>) -> Obj {
    obj::read(text.as_ref()).unwrap()
}

fn read_error(text: impl AsRef<[u8]>) -> String {
    obj::read(text.as_ref()).unwrap_err().to_string()
}

fn load_error(text: impl AsRef<[u8]>) -> String {
    Format::Obj.read_cage(text.as_ref()).unwrap_err().to_string()
}

fn written(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = Vec::new();
    obj::write(mesh, &mut bytes).unwrap();
    bytes
}

#[test]
fn all_forms_of_a_corner_mean_the_same_vertex() {
    for faces in [
        "f 1 2 3 4\nf 4 3 5",
        "f 1/1 2/2 3/3 4/1\nf 4/1 3/2 5/3",
        "f 1//1 2//2 3//1 4//2\nf 4//1 3//2 5//1",
        "f 1/1/1 2/2/2 3/3/1 4/1/2\nf 4/1/1 3/1/2 5/1/2",
        "f -5 -4 -3 -2\nf -2 -3 -1",
        "f -5/-3/-2 -4/-2/-1 -3/-1/-2 -2/-3/-1\nf -2/1 -3//2 5",
        "f 1/ 2// 3/1/ 4\nf +4 03 5",
    ] {
        assert_eq!(shape(read(HOUSE.to_owned() + faces).mesh), house(), "{faces}");
    }
}

#[test]
fn all_ways_to_write_lines_mean_the_same_mesh() {
    let text = HOUSE.to_owned() + "f 1 2 3 4\nf 4 3 5\n";
    for variant in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.replace(' ', " \\\n "),
        text.replace(' ', "\\\r\n"),
        text.replace(' ', "\t \t"),
        text.replace('\n', " \t # comment \\\n# another f 1 1 1\n\n"),
        text.replace('\n', "\n  "),
        text.replace("\nv ", "\n\tv "),
        format!("\u{feff}{text}"),
        text.trim_end().to_owned(),
        text.trim_end().to_owned() + "\\",
        // Weights and colours.
        text.replace(" 0\nv", " 0 1.0\nv"),
        text.replace(" 0\nv", " 0 0.5 0.25 1e-2\nv"),
        // Faces first.
        "f 1/1/1 2/3/2 3 4\nf 4 3 5\n".to_owned() + HOUSE,
        // What is no concern of ours.
        text.replace("\nv", "\no x\ng a b\ns off\nusemtl #1\nmtllib c.mtl d.mtl\nv"),
        text.replace("vn 0 0 1", "vn nan what\nvn"),
    ] {
        let obj = read(&variant);
        assert_eq!(shape(obj.mesh), house(), "{variant}");
        assert_eq!(obj.unknown_tags, [], "{variant}");
    }
}

#[test]
fn bytes_that_are_not_utf_8_do_no_harm_where_they_do_not_matter() {
    let text = [
        b"# caf\xe9 \xff\xfe\no M\xfcller\n\x80\x81 \xc3\n\0\n",
        HOUSE.as_bytes(),
        b"f 1 2 3 4\nf 4 3 5",
    ];
    let obj = read(text.concat());
    assert_eq!(obj.mesh, house());
    let names: Vec<&str> = obj.unknown_tags.iter().map(|tag| &tag.name[..]).collect();
    assert_eq!(names, ["\u{fffd}\u{fffd}", "\u{fffd}"]);
    let error = read_error(b"v 0 1 2\xff");
    assert!(error.starts_with("line 1, vertex 1: `2\u{fffd}` is not a number"), "{error}");
}

#[test]
fn faulty_lines_are_named_with_their_text() {
    for (text, expected) in [
        ("v 1 2 x", "line 1, vertex 1: `x` is not a number: correct it"),
        ("v 0 0 0\n\nv 1,0 0 0", "line 3, vertex 2: `1,0` is not a number"),
        ("v 0 0 0 red", "line 1, vertex 1: `red` is not a number"),
        ("v 1 2 # 3", "line 1, vertex 1: `v 1 2` has 2 of the 3 coordinates: add"),
        ("v 0 0 0 0.5", "line 1, vertex 1: the weight `0.5` is not 1, but rational points are not"),
        ("v 0 0 0 nan", "line 1, vertex 1: the weight `NaN` is not 1"),
        ("v", "line 1, vertex 1: `v` has 0 of the 3 coordinates"),
        ("v 1 \\\n2\nf", "line 1, vertex 1: `v 1 \\ 2` has 2 of the 3 coordinates"),
        ("f 1 a 3", "line 1, face 1: `a` is not a corner: correct it, as in 1, 1/2,"),
        ("f 1 2.0 3", "line 1, face 1: `2.0` is not a corner"),
        ("f /1 2 3", "line 1, face 1: `/1` is not a corner"),
        ("f 1/2/3/4 2 3", "line 1, face 1: `1/2/3/4` is not a corner"),
        ("f 0 1 2", "line 1, face 1: `0` asks for vertex 0, but the first has number 1"),
        ("vt 0\nv 0 0 0\nf 1/0 1 1", "line 3, face 1: `1/0` asks for texture coordinate 0,"),
        ("vn 0\nv 0 0 0\nf 1//0", "line 3, face 1: `1//0` asks for normal 0,"),
        ("v 0 0 0\nf 1 2 1", "line 2, face 1: `2` asks for vertex 2, but the file has 1: correct"),
        (
            "v 0 0 0\nf 1/1 1 1",
            "line 2, face 1: `1/1` asks for texture coordinate 1, but the file has 0",
        ),
        ("v 0 0 0\nf 1//1 1 1", "line 2, face 1: `1//1` asks for normal 1, but the file has 0"),
        (
            "v 0 0 0\nf -2 1 1\nv 0 0 0",
            "line 2, face 1: `-2` asks for vertex -2, but 1 come before",
        ),
        ("v 0 0 0\nvt 0\nf 1/-2 1 1", "line 3, face 1: `1/-2` asks for texture coordinate -2,"),
        (
            "v 0 0 0\nf 1 1 1\nf 4294967297",
            "line 3, face 2: `4294967297` asks for vertex 4294967297",
        ),
        (
            "f 1/99999999999999999999 1 1\nv 0 0 0",
            "line 1, face 1: `1/99999999999999999999` asks for texture coordinate \
             99999999999999999999, but the file has 0",
        ),
        (
            "f 99999999999999999999",
            "line 1, face 1: `99999999999999999999` asks for vertex 99999999999999999999, but",
        ),
        (
            "f -99999999999999999999",
            "line 1, face 1: `-99999999999999999999` asks for vertex -99999999999999999999, but 0",
        ),
        (
            "ply\nformat ascii 1.0",
            "line 1: the file is read as OBJ, but it looks like PLY: let its",
        ),
        (
            "glTF\u{2}",
            "line 1: the file is read as OBJ, but it looks like glTF, which is not read:",
        ),
    ] {
        let error = read_error(text);
        assert!(error.starts_with(expected), "{text:?}: {error}");
        assert_eq!(error.lines().count(), 1, "one fault for each line: {error}");
    }
}

#[test]
fn long_words_are_shortened() {
    let error = read_error(format!("v {} 0 0", "9x".repeat(1000)));
    assert!(error.contains("`9x9x") && error.contains("...`") && error.len() < 150, "{error}");
}

#[test]
fn the_first_twenty_faulty_lines_are_listed_in_order_and_the_rest_counted() {
    // What comes too late to be there is only known at the end, but listed in its place.
    let text = "f 7 7 7\nv 0 0 x\n".repeat(15);
    let error = obj::read(text.as_bytes()).unwrap_err();
    assert_eq!(error.num_more, 0, "7 is no fault: there are 15 vertices");
    let error = obj::read(text.replace('7', "16").as_bytes()).unwrap_err();
    assert_eq!(error.num_more, 10);
    let lines: Vec<u32> = error.faults.iter().map(|fault| fault.line).collect();
    assert_eq!(lines, (1..=20).collect::<Vec<_>>());
    let message = error.to_string();
    assert!(message.starts_with("30 faults:\n  line 1, face 1: `16` asks for vertex 16,"));
    assert!(message.ends_with("\n  and 10 more") && message.lines().count() == 22);
}

#[test]
fn faults_of_the_mesh_are_named_by_number_and_line_of_the_file() {
    let points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\n";
    for (rest, expected) in [
        ("f 1 2", "face 1 (line 6) has 2 of at least 3 corners: complete or delete it"),
        ("f 1 2 3\n\nf", "face 2 (line 8) has 0 of at least 3 corners"),
        ("f 1 2 3 2", "face 1 (line 6) comes to vertex 2 (line 2) more than once: remove"),
        ("#\nv 1e999 0 0\nf 1 2 3", "vertex 6 (line 7) is at (inf, 0, 0): give it"),
        ("v 0 nan 0\nf 1 2 3", "vertex 6 (line 6) is at (0, NaN, 0): give it"),
        ("v 0 0 -inf\nf 1 2 6", "vertex 6 (line 6) is at (0, 0, -inf): give it"),
        (
            "f 1 2 3\nf 1 2 4",
            "faces 1 (line 6) and 2 (line 7) both run from vertex 1 (line 1) to vertex 2 (line 2): flip",
        ),
        (
            "f 1 2 3\nf 2 1 4\nf 1 2 5",
            "the edge of vertices 1 (line 1) and 2 (line 2) has 3 faces (1 (line 6), 2 (line 7), 3 (line 8)), but",
        ),
        ("f 1 2 3\nf 3 2 1\nf 1 3 2", "2 faults:\n  faces 1 (line 6) and 2 (line 7) have the same"),
        ("f 1 2 3\nf 3 4 5", "the faces around vertex 3 (line 3) form more than one fan: split"),
        ("", "there are no faces (5 vertices): give the mesh its faces"),
    ] {
        let error = load_error(points.to_owned() + rest);
        assert!(error.starts_with(expected), "{rest:?}: {error}");
    }
}

#[test]
fn a_file_without_faces_says_so_and_what_else_it_may_be() {
    for text in ["", "\n\n", "# empty", "\u{feff}", "\\"] {
        assert_eq!(load_error(text), "there are no faces (0 vertices): give the mesh its faces");
    }
    assert!(load_error("v 0 0 0").starts_with("there are no faces (1 vertex): "));
    let error = load_error("g a\nnff\nformat ascii 1.0\nelement vertex 8\nelement face 6\n");
    let note = "\nnote: line 2 is ignored: the tag `nff` is not supported, and 2 more";
    assert!(error.starts_with("there are no faces (0 vertices)") && error.ends_with(note));
}

#[test]
fn twenty_faults_of_the_mesh_are_listed_and_the_rest_counted() {
    let error = load_error("v 0 0 0\n".to_owned() + &"f 1 1 1\n".repeat(25));
    assert!(error.starts_with("25 faults:\n  face 1 (line 2) comes to vertex 1 (line 1) more"));
    assert!(error.ends_with("\n  and 5 more") && error.lines().count() == 22);
}

#[test]
fn unknown_tags_are_counted_and_reported_once() {
    let text = "l 1 2\np 1\nl 2 3 \\\n4 5\n V 1 2 3\n# l\nvp 1\nl\n";
    let obj = read(text);
    let tag = |name: &str, count, first_line| UnknownTag { name: name.into(), count, first_line };
    assert_eq!(obj.unknown_tags, [tag("l", 3, 1), tag("p", 1, 2), tag("V", 1, 5), tag("vp", 1, 7)]);
    let shown: Vec<String> = obj.unknown_tags[..2].iter().map(UnknownTag::to_string).collect();
    let expected = [
        "3 lines from line 1 are ignored: the tag `l` is not supported",
        "line 2 is ignored: the tag `p` is not supported",
    ];
    assert_eq!(shown, expected);
}

#[test]
fn what_is_no_part_of_a_cage_is_told_in_one_sentence() {
    let text = HOUSE.to_owned() + "g a\nf 1//1 2 3 4\nusemtl b\nf 4 3 5\ng\n";
    let (_, notices) = Format::Obj.read_cage(text.as_bytes()).unwrap();
    let shown: Vec<String> = notices.iter().map(Notice::to_string).collect();
    let expected = "line 9 and 4 more: groups, materials and normals (g, usemtl, vn) are not kept";
    assert_eq!(shown, [expected]);
    let obj = read("v 0 0 0 1\nv 0 0 0 1 2\nv 0 0 0 1 2 3 4\nv 0 0 0\n");
    let expected = "line 2 and 1 more: further numbers of vertices (v) are not kept";
    assert_eq!(obj.skipped.map(|skipped| skipped.to_string()).as_deref(), Some(expected));
}

#[test]
fn notices_tell_what_was_ignored_and_vertices_keep_their_numbers() {
    let (cage, notices) = Format::Obj
        .read_cage(b"v 9 9 9\nv 0 0 0\nv 1 0 0\nx 1\nv 0 1 0\nv 8 8 8\nf 2 3 4\n")
        .unwrap();
    let shown: Vec<String> = notices.iter().map(Notice::to_string).collect();
    let expected = [
        "line 4 is ignored: the tag `x` is not supported",
        "2 vertices are in no face and ignored: 1 (line 1), 5 (line 6)",
    ];
    assert_eq!(shown, expected);
    assert_eq!(cage.topology().faces().corners(FaceId(0)), [1, 2, 3].map(VertexId));
    assert_eq!(cage.positions()[1], [0.0; 3]);
    assert!(!cage.topology().is_used(VertexId(0)) && cage.topology().is_used(VertexId(1)));
}

#[test]
fn the_source_knows_the_lines_of_everything() {
    let source = read("#\nv 0 0 0\nv 0 \\\n0 0\n\nv 0 0 0\nf 1 \\\n2 3\nf 3 2 1\n").source;
    let vertices = [0, 1, 2, 3].map(|v| source.vertex_line(VertexId(v)));
    assert_eq!(vertices, [Some(2), Some(3), Some(6), None]);
    let faces = [0, 1, 2].map(|f| source.face_line(FaceId(f)));
    assert_eq!(faces, [Some(7), Some(9), None]);
}

proptest! {
    /// Whatever `str::parse` reads, we read as the same bits, and nothing else.
    #[test]
    fn coordinates_are_read_as_the_standard_library_reads_them(
        bits in any::<u64>(), digits in 0usize..25, word in "[-+]?[0-9.]{1,20}([eE][-+]?[0-9]{1,3})?",
    ) {
        let x = f64::from_bits(bits);
        for word in [format!("{x}"), format!("{x:e}"), format!("{x:.digits$e}"), word] {
            let expected = word.parse::<f64>().ok().map(f64::to_bits);
            let read = obj::read(format!("v {word} 0 0").as_bytes());
            prop_assert_eq!(read.ok().map(|obj| obj.mesh.positions[0][0].to_bits()), expected);
        }
    }

    /// Any mesh whose faces ask for what there is, checked or not.
    #[test]
    fn what_is_written_is_read_again(mesh in any_mesh()) {
        let text = written(&mesh);
        prop_assert_eq!(&read(&text).mesh, &mesh);
        prop_assert_eq!(written(&read(&text).mesh), text);
    }
}

fn any_mesh() -> impl Strategy<Value = Mesh> {
    let number = prop::num::f64::ANY.prop_filter("NaN is not equal to itself", |x| !x.is_nan());
    let positions = prop::collection::vec(prop::array::uniform3(number), 1..30);
    positions.prop_flat_map(|positions| {
        let vertex = 0..positions.len() as u32;
        let faces = prop::collection::vec(prop::collection::vec(vertex, 0..7), 0..20);
        faces.prop_map(move |faces| Mesh::new(positions.clone(), faces))
    })
}

#[test]
fn nan_and_negative_zero_are_written_as_they_are() {
    let mesh = Mesh::new(vec![[f64::NAN, -0.0, f64::INFINITY]], [[0; 0]; 0]);
    let [x, y, z] = read(written(&mesh)).mesh.positions[0];
    assert!(x.is_nan() && y.to_bits() == (-0.0f64).to_bits() && z == f64::INFINITY);
}

/// Our own meshes: every OBJ file below `data/meshes`.
fn data_files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/meshes");
    let (mut folders, mut files) = (vec![root], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "obj") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn load(path: &Path) -> (Cage, Vec<Notice>) {
    let loaded = Format::Obj.read_cage(&std::fs::read(path).unwrap());
    loaded.unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn all_our_meshes_are_read_checked_and_written() {
    let files = data_files();
    assert!(!files.is_empty());
    for path in &files {
        let (cage, notices) = load(path);
        assert_eq!(notices, [], "{}", path.display());
        let mesh = Mesh {
            positions: cage.positions().to_vec(),
            faces: cage.topology().faces().clone(),
            ..Mesh::default()
        };
        assert_eq!(read(written(&mesh)).mesh, mesh, "{}", path.display());
    }
}

/// Vertices that are neither regular nor of the valence in the file's name are only in the
/// closed bodies.
#[test]
fn an_obstacle_has_one_vertex_of_the_valence_in_its_name() {
    let mut seen = 0;
    for path in data_files() {
        let stem = path.file_stem().unwrap().to_str().unwrap();
        let closed = ["frame", "pillow", "polycube"].iter().any(|kind| stem.starts_with(kind));
        let Some((_, valence)) = stem.rsplit_once("_n").filter(|_| !closed) else { continue };
        let mut valences = load(&path).0.interior_valences();
        valences.remove(&4);
        assert_eq!(valences, BTreeMap::from([(valence.parse().unwrap(), 1)]), "{stem}");
        seen += 1;
    }
    assert!(seen > 100);
}

#[test]
fn the_blobs_are_closed_and_of_known_valences() {
    let blobs: Vec<_> =
        data_files().into_iter().filter(|p| p.to_string_lossy().contains("own_blob")).collect();
    assert_eq!(blobs.len(), 2);
    for path in blobs {
        let (cage, _) = load(&path);
        assert_eq!((cage.num_boundary_edges(), cage.num_components()), (0, 1));
        let excess: i64 =
            cage.interior_valences().iter().map(|(&n, &k)| (4 - n as i64) * k as i64).sum();
        assert_eq!(excess, 8, "the valences of a quad mesh of a sphere miss 4 by 8 in all");
    }
}

/// A wavy square of `n` x `n` quads with full 17-digit coordinates.
fn large_file(n: usize) -> Vec<u8> {
    let positions = (0..=n)
        .flat_map(|i| (0..=n).map(move |j| (i as f64 / n as f64, j as f64 / n as f64)))
        .map(|(x, y)| [x, y, (3.0 * x).sin() * (5.0 * y).cos()])
        .collect();
    let vertex = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    let face = |i, j| [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
    let faces = (0..n).flat_map(|i| (0..n).map(move |j| face(i, j)));
    written(&Mesh::new(positions, faces))
}

#[test]
fn a_million_quads_are_read_and_checked() {
    let text = large_file(1000);
    let start = Instant::now();
    let obj = obj::read(&text).unwrap();
    let reading = start.elapsed();
    let cage = Cage::new(obj.mesh).unwrap();
    let total = start.elapsed();
    println!("{} bytes: read in {reading:?}, read and checked in {total:?}", text.len());
    assert_eq!((cage.num_faces(), cage.num_boundary_edges()), (1_000_000, 4000));
    assert_eq!(cage.interior_valences(), BTreeMap::from([(4, 999 * 999)]));
}
