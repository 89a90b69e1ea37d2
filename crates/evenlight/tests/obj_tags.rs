//! OBJ beyond positions and faces: the tags of OpenSubdiv's shapes, texture coordinates, colours.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use evenlight::Mesh;
use evenlight::io::load::Format;
use evenlight::io::load::Notice;
use evenlight::io::obj::{self, Obj};
use evenlight::mesh::{
    BoundaryRule, Corner, Crease, CreaseMethod, FaceId, FaceVaryingRule, Interpolation, Primvar,
    Tags, VertexId,
};
use proptest::prelude::*;

/// Two quads side by side: vertices 0 to 5, faces 0 and 1.
const TWO_QUADS: &str =
    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nf 1 2 5 4\nf 2 3 6 5\n";

fn read(lines: &str) -> Obj {
    obj::read((TWO_QUADS.to_owned() + lines).as_bytes()).unwrap()
}

fn tags(lines: &str) -> Tags {
    let obj = read(lines);
    assert!(obj.unknown_tags.is_empty() && obj.remarks.is_empty(), "{lines}");
    obj.mesh.tags
}

fn error(lines: &str) -> String {
    obj::read((TWO_QUADS.to_owned() + lines).as_bytes()).unwrap_err().to_string()
}

fn crease(a: u32, b: u32, sharpness: f64) -> Crease {
    Crease { edge: [VertexId(a), VertexId(b)], sharpness }
}

fn corner(v: u32, sharpness: f64) -> Corner {
    Corner { vertex: VertexId(v), sharpness }
}

#[test]
fn creases_are_pairs_or_chains() {
    for (line, expected) in [
        ("t crease 2/1/0 1 4 2.5", vec![crease(1, 4, 2.5)]),
        ("t crease 4/1/0 0 1 4 5 3", vec![crease(0, 1, 3.0), crease(4, 5, 3.0)]),
        ("t crease 4/2/0 0 1 4 5 3 .5", vec![crease(0, 1, 3.0), crease(4, 5, 0.5)]),
        (
            "t crease 4/3/0 0 1 4 5 3 .5 1",
            vec![crease(0, 1, 3.0), crease(1, 4, 0.5), crease(4, 5, 1.0)],
        ),
        ("t crease 3/1/0 0 1 2 10", vec![crease(0, 1, 10.0), crease(1, 2, 10.0)]),
        ("t crease 3/2/0 0 1 2 10 inf", vec![crease(0, 1, 10.0), crease(1, 2, f64::INFINITY)]),
        ("t crease 2/1/0 4 1 -0", vec![crease(4, 1, 0.0)]),
        ("t crease 2/1/0 0 1 1\nt crease 2/1/0 1 0 2", vec![crease(0, 1, 1.0), crease(1, 0, 2.0)]),
    ] {
        assert_eq!(tags(line).creases, expected, "{line}");
    }
}

#[test]
fn corners_and_holes_are_lists() {
    assert_eq!(tags("t corner 1/1/0 5 10").corners, [corner(5, 10.0)]);
    assert_eq!(tags("t corner 2/1/0 5 0 3").corners, [corner(5, 3.0), corner(0, 3.0)]);
    assert_eq!(tags("t corner 2/2/0 5 0 3 4").corners, [corner(5, 3.0), corner(0, 4.0)]);
    assert_eq!(tags("t hole 2/0/0 1 0").holes, [FaceId(1), FaceId(0)]);
}

#[test]
fn rules_have_opensubdivs_numbers() {
    use BoundaryRule as B;
    use FaceVaryingRule as F;
    for (k, rule) in [B::None, B::EdgeAndCorner, B::EdgeOnly].into_iter().enumerate() {
        assert_eq!(tags(&format!("t interpolateboundary 1/0/0 {k}")).boundary, rule);
    }
    let rules = [F::None, F::CornersOnly, F::CornersPlus1, F::CornersPlus2, F::Boundaries, F::All];
    for (k, rule) in rules.into_iter().enumerate() {
        let line = format!("t facevaryinginterpolateboundary 1/0/0 {k}");
        assert_eq!(tags(&line).face_varying, rule);
    }
    assert_eq!(tags("t creasemethod 0/0/1 chaikin").crease_method, CreaseMethod::Chaikin);
    assert_eq!(tags("t creasemethod 0/0/1 normal").crease_method, CreaseMethod::Uniform);
    let defaults = "t smoothtriangles 0/0/1 catmark\nt facevaryingpropagatecorners 1/0/0 0";
    assert_eq!(tags(defaults), Tags::default());
}

#[test]
fn tags_may_come_before_what_they_are_of() {
    let text = "t crease 2/1/0 1 4 2\nt hole 1/0/0 1\n".to_owned() + TWO_QUADS;
    let tags = obj::read(text.as_bytes()).unwrap().mesh.tags;
    assert_eq!((tags.creases, tags.holes), (vec![crease(1, 4, 2.0)], vec![FaceId(1)]));
}

#[test]
fn what_is_not_there_is_ignored_and_reported() {
    let lines = "t smoothtriangles 0/0/1 smooth\nt facevaryingpropagatecorners 1/0/0 1\n\
                 t bend 1/0/0 1\nt bend 1/0/0 2";
    let obj = read(lines);
    assert_eq!(obj.mesh.tags, Tags::default());
    let shown: Vec<String> = obj.unknown_tags.iter().map(ToString::to_string).collect();
    let expected = [
        "line 9 is ignored: the tag `t smoothtriangles` is not supported",
        "line 10 is ignored: the tag `t facevaryingpropagatecorners` is not supported",
        "2 lines from line 11 are ignored: the tag `t bend` is not supported",
    ];
    assert_eq!(shown, expected);
}

#[test]
fn faulty_tags_are_named_by_line() {
    for (line, expected) in [
        ("t", "`t ` is not a tag: write `t NAME ints/floats/strings`"),
        ("t crease", "`t crease` is not a tag"),
        ("t crease 2/1 0 1 2", "`t crease` is not a tag"),
        ("t crease 2/1/0 0 1", "`t crease` is not a tag"),
        ("t crease 2/1/0 0 1 2 3", "`t crease` is not a tag"),
        ("t crease 1/1/0 0 2", "the tag `crease` takes pairs of vertices, and one number"),
        ("t crease 2/2/0 0 1 2 3", "the tag `crease` takes pairs of vertices"),
        ("t crease 2/1/0 0 1 x", "`x` is no argument of the tag `crease`: write a number"),
        ("t crease 2/1/0 0 1 nan", "`nan` is no argument of the tag `crease`: write a number"),
        ("t crease 2/1/0 0 1.5 1", "`1.5` is no argument of the tag `crease`: write a whole"),
        (
            "t crease 4/2/0 0 1 4 5 1 -0.5",
            "`-0.5` is no argument of the tag `crease`: write a sharpness from 0 (smooth) to 10",
        ),
        (
            "t corner 1/1/0 0 -inf",
            "`-inf` is no argument of the tag `corner`: write a sharpness from 0 (smooth) to 10",
        ),
        ("t crease 2/1/0 0 -1 1", "`-1` is no argument of the tag `crease`: write a number from 0"),
        ("t crease 2/1/0 0 6 1", "the tag asks for vertex 6, but the file has 6, and tags count"),
        ("t corner 1/1/0 9 1", "the tag asks for vertex 9, but the file has 6"),
        ("t hole 1/0/0 2", "the tag asks for face 2, but the file has 2"),
        ("t hole 0/0/0", "the tag `hole` takes faces"),
        (
            "t interpolateboundary 1/0/0 3",
            "`3` is no argument of the tag `interpolateboundary`: \
          write a number from 0 to 2",
        ),
        ("t interpolateboundary 0/0/0", "the tag `interpolateboundary` takes one whole number"),
        (
            "t creasemethod 0/0/1 odd",
            "`odd` is no argument of the tag `creasemethod`: write `normal`",
        ),
        ("t creasemethod 0/0/0", "the tag `creasemethod` takes one word"),
        ("t vertexedit 3/3/2 0 0 0 1 2 3 add P", "`vertexedit` is a hierarchical edit, which"),
        ("t faceedit what ever", "`faceedit` is a hierarchical edit"),
        ("vt 1e999 0", "texture coordinate 1: `1e999` is not finite"),
        ("vt", "texture coordinate 1: `vt` has 0 of the 1 coordinates"),
        ("v 0 0 0 1 0 inf", "vertex 7: `inf` is not finite"),
    ] {
        let found = error(line);
        let rest = found.strip_prefix("line 9").unwrap_or_else(|| panic!("{line}: {found}"));
        let rest = rest.trim_start_matches([':', ',', ' ']);
        assert!(rest.starts_with(expected), "{line}: {found}");
        assert_eq!(found.lines().count(), 1, "{found}");
    }
}

/// The primvar of texture coordinates of a file that must have one.
fn uvs(obj: &Obj) -> &Primvar {
    let [uvs] = &obj.mesh.primvars[..] else { panic!("{:?}", obj.mesh.primvars) };
    assert_eq!((uvs.name.as_str(), uvs.interpolation), ("st", Interpolation::FaceVarying));
    uvs
}

#[test]
fn texture_coordinates_are_a_face_varying_primvar() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt .5\nvt 1 1\nvt 9 9 0\n\
                f 1/1 2/2 3/3\nf 1/-4/ 3/3 4/2\n";
    let obj = obj::read(text.as_bytes()).unwrap();
    let uvs = uvs(&obj);
    assert_eq!(uvs.values, [0.0, 0.0, 0.5, 0.0, 1.0, 1.0, 9.0, 9.0]);
    assert_eq!((uvs.width, &uvs.indices[..]), (2, &[0, 1, 2, 0, 2, 1][..]));
    let deep = obj::read(text.replace("9 9 0", "9 9 1").as_bytes()).unwrap();
    assert_eq!((deep.mesh.primvars[0].width, deep.mesh.primvars[0].values[11]), (3, 1.0));
}

#[test]
fn corners_without_texture_coordinate_get_one_and_it_is_said() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt .1 .2\n\
                f 1 2 3\nf 1/1 3/1 4\nf 4 2 1\n";
    let obj = obj::read(text.as_bytes()).unwrap();
    assert_eq!(uvs(&obj).indices, [1, 1, 1, 0, 0, 1, 1, 1, 1]);
    assert_eq!(uvs(&obj).values, [0.1, 0.2, 0.0, 0.0]);
    let expected = "7 of 9 corners of faces have no texture coordinate and get (0, 0)";
    assert_eq!(obj.remarks, [expected]);
}

#[test]
fn colours_are_kept_if_all_vertices_have_one() {
    let text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 .5 .25 1\nf 1 2 3\n";
    let obj = obj::read(text.as_bytes()).unwrap();
    let [colors] = &obj.mesh.primvars[..] else { panic!() };
    assert_eq!((colors.name.as_str(), colors.width), ("color", 3));
    assert_eq!(colors.values, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, 0.25, 1.0]);
    let some = text.replace(" 0 1 0\n", "\n");
    let (cage, notices) = Format::Obj.read_cage(some.as_bytes()).unwrap();
    assert!(cage.primvars().is_empty());
    let remark = "only 2 of 3 vertices have a colour: colours are ignored";
    assert_eq!(notices, [Notice::Remark(remark.to_owned())]);
}

#[test]
fn a_cage_has_what_its_file_says() {
    let text = TWO_QUADS.to_owned() + "t crease 2/1/0 1 4 2\nt interpolateboundary 1/0/0 0\n";
    let (cage, _) = Format::Obj.read_cage(text.as_bytes()).unwrap();
    assert_eq!(cage.tags().creases, [crease(1, 4, 2.0)]);
    assert_eq!(cage.tags().boundary, BoundaryRule::None);
}

#[test]
fn primvars_without_a_place_are_named_and_left_out() {
    let mut mesh = Mesh::new(vec![[0.0; 3]; 3], [[0, 1, 2]]);
    let heat = Primvar {
        name: "heat".to_owned(),
        interpolation: Interpolation::Vertex,
        width: 1,
        values: vec![1.0, 2.0, 3.0],
        indices: vec![],
    };
    let st = Primvar { name: "st".to_owned(), width: 2, values: vec![0.5; 6], ..heat.clone() };
    mesh.primvars = vec![heat, st];
    let expected = "OBJ has no place for the primvar `heat`: it is left out";
    assert_eq!(obj::omitted(&mesh), [expected]);
    let mut text = Vec::new();
    obj::write(&mesh, &mut text).unwrap();
    // A value for each vertex is a value for each corner.
    assert_eq!(uvs(&obj::read(&text).unwrap()).indices, [0, 1, 2]);
}

/// Meshes with everything that OBJ can hold.
fn full_mesh() -> impl Strategy<Value = Mesh> {
    let number = || prop::num::f64::NORMAL | prop::num::f64::ZERO;
    let sharpness = || 0.0..12.0f64;
    let shapes = (3usize..20, 1usize..10, 1usize..8);
    shapes
        .prop_flat_map(move |(num_vertices, num_faces, num_uvs)| {
            let vertex = move || (0..num_vertices as u32).prop_map(VertexId);
            let uv = 0..num_uvs as u32;
            let corner = (0..num_vertices as u32, uv);
            let crease = (vertex(), vertex(), sharpness());
            let crease = crease.prop_map(|(a, b, sharpness)| Crease { edge: [a, b], sharpness });
            let corner_tag = (vertex(), sharpness());
            let corner_tag =
                corner_tag.prop_map(|(vertex, sharpness)| Corner { vertex, sharpness });
            let tags = (
                prop::sample::select(vec![BoundaryRule::None, BoundaryRule::EdgeOnly]),
                prop::bool::ANY,
                prop::collection::vec(crease, 0..6),
                prop::collection::vec(corner_tag, 0..6),
                prop::collection::vec((0..num_faces as u32).prop_map(FaceId), 0..4),
            );
            let tags = tags.prop_map(|(boundary, chaikin, creases, corners, holes)| Tags {
                boundary,
                crease_method: if chaikin { CreaseMethod::Chaikin } else { CreaseMethod::Uniform },
                face_varying: if chaikin { FaceVaryingRule::All } else { FaceVaryingRule::None },
                creases,
                corners,
                holes,
            });
            (
                prop::collection::vec(prop::array::uniform3(number()), num_vertices),
                prop::collection::vec(prop::collection::vec(corner, 1..6), num_faces),
                prop::collection::vec(number(), 2 * num_uvs),
                prop::collection::vec(0.0..1.0f64, 3 * num_vertices),
                tags,
            )
        })
        .prop_map(|(positions, faces, uvs, colors, tags)| {
            let corners = faces.iter().map(|f| f.iter().map(|c| c.0).collect::<Vec<_>>());
            let indices = faces.iter().flatten().map(|c| c.1).collect();
            let mut mesh = Mesh::new(positions, corners);
            mesh.tags = tags;
            let st = Primvar {
                name: "st".to_owned(),
                interpolation: Interpolation::FaceVarying,
                width: 2,
                values: uvs,
                indices,
            };
            let color = Primvar {
                name: "color".to_owned(),
                interpolation: Interpolation::Vertex,
                width: 3,
                values: colors,
                indices: vec![],
            };
            mesh.primvars = vec![st, color];
            mesh
        })
}

proptest! {
    /// OBJ -> OBJ keeps all that the format can hold, to the last bit.
    #[test]
    fn everything_is_read_as_it_was_written(mesh in full_mesh()) {
        let mut text = Vec::new();
        obj::write(&mesh, &mut text).unwrap();
        prop_assert!(obj::omitted(&mesh).is_empty());
        let read = obj::read(&text).unwrap();
        prop_assert_eq!(&read.mesh, &mesh);
        prop_assert!(read.unknown_tags.is_empty() && read.remarks.is_empty());
        let mut again = Vec::new();
        obj::write(&read.mesh, &mut again).unwrap();
        prop_assert_eq!(text, again);
    }
}
