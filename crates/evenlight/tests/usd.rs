//! USD cages: what is read, what is refused and in which words, and that nothing is lost.
//!
//! The test that is ignored asks Pixar's own library, the package `usd-core` of Python, whether it
//! finds the same; `EVENLIGHT_PYTHON` names a Python that has it:
//!
//! ```text
//! EVENLIGHT_PYTHON=.venv/bin/python cargo test -p evenlight --test usd -- --ignored
//! ```

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::path::Path;
use std::process::Command;

use evenlight::Mesh;
use evenlight::io::usd::{self, Usd};
use evenlight::mesh::{
    BoundaryRule, Corner, Crease, CreaseMethod, FaceId, FaceVaryingRule, Interpolation, Primvar,
    Tags, VertexId,
};
use proptest::prelude::*;

/// A quad and a triangle on it, with all that a mesh can have.
const HOUSE: &str = r#"#usda 1.0
(
    "A house"
    defaultPrim = "World"
    upAxis = "Z"
    customLayerData = { string[] authors = ["a", "b"]; dictionary x = { int y = 1 } }
)

def Xform "World" (
    kind = "component"
    prepend apiSchemas = ["MaterialBindingAPI"]
)
{
    rel material:binding = </Looks/Brick> (
        bindMaterialAs = "weakerThanDescendants"
    )
    def Mesh "House"
    {
        int[] faceVertexCounts = [4, 3]
        int[] faceVertexIndices = [0, 1, 2, 3, 3, 2, 4,]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (.5, 1.5e0, 0)]
        float3[] extent = [(0, 0, 0), (1, 1.5, 0)]
        uniform token subdivisionScheme = "catmullClark"
        uniform token interpolateBoundary = "edgeOnly"
        token faceVaryingLinearInterpolation = "boundaries"
        int[] creaseIndices = [0, 1, 2, 2, 3]
        int[] creaseLengths = [3, 2]
        float[] creaseSharpnesses = [2.5, inf] // one for each
        int[] cornerIndices = [4]
        float[] cornerSharpnesses = [10]
        int[] holeIndices = [1]
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (
            customData = {
                bool isMapping = true
            }
            interpolation = "faceVarying"
        )
        int[] primvars:st:indices = [0, 1, 2, 3, 0, 2, 1]
        color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0)] (interpolation = 'vertex')
        int[] primvars:displayColor:indices = [0, 1, 0, 1, 1]
        float[] primvars:heat = [1, 2, 3, 4, 5] (interpolation = "varying")
        matrix4d xformOp:unused = ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1) )
        normal3f[] normals.timeSamples = { 0: [(0, 0, 1)], 1.5: None, }
        asset texture = @./brick.png@; string note = '''a
        "note"'''
    }
}
"#;

fn read(text: &str) -> Usd {
    usd::read(text.as_bytes(), None).unwrap()
}

fn error(text: &str) -> String {
    usd::read(text.as_bytes(), None).unwrap_err().to_string()
}

fn written(mesh: &Mesh) -> String {
    let mut bytes = Vec::new();
    usd::write(mesh, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn house() -> Mesh {
    let positions = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0.5, 1.5, 0.]];
    let mut mesh = Mesh::new(positions, [&[0, 1, 2, 3][..], &[3, 2, 4]]);
    let crease = |a, b, sharpness| Crease { edge: [VertexId(a), VertexId(b)], sharpness };
    mesh.tags = Tags {
        boundary: BoundaryRule::EdgeOnly,
        face_varying: FaceVaryingRule::Boundaries,
        creases: vec![crease(0, 1, 2.5), crease(1, 2, 2.5), crease(2, 3, f64::INFINITY)],
        corners: vec![Corner { vertex: VertexId(4), sharpness: 10.0 }],
        holes: vec![FaceId(1)],
        ..Tags::default()
    };
    let st = Primvar {
        name: "st".to_owned(),
        interpolation: Interpolation::FaceVarying,
        width: 2,
        values: vec![0., 0., 1., 0., 1., 1., 0., 1.],
        indices: vec![0, 1, 2, 3, 0, 2, 1],
    };
    let color = Primvar {
        name: "color".to_owned(),
        interpolation: Interpolation::Vertex,
        width: 3,
        values: vec![1., 0., 0., 0., 1., 0., 1., 0., 0., 0., 1., 0., 0., 1., 0.],
        indices: vec![],
    };
    let heat = Primvar {
        name: "heat".to_owned(),
        interpolation: Interpolation::Varying,
        width: 1,
        values: vec![1., 2., 3., 4., 5.],
        indices: vec![],
    };
    mesh.primvars = vec![st, color, heat];
    mesh
}

#[test]
fn a_file_with_everything() {
    let usd = read(HOUSE);
    assert_eq!((usd.path.as_str(), &usd.mesh), ("/World/House", &house()));
    assert!(usd.remarks.is_empty(), "{:?}", usd.remarks);
    assert_eq!(read(&written(&usd.mesh)).mesh, usd.mesh);
}

#[test]
fn all_ways_to_write_it_mean_the_same() {
    for variant in [
        HOUSE.replace('\n', "\r\n"),
        HOUSE.replace('\n', "\n # \"comment\n"),
        HOUSE.replace(", ", ",\n\n"),
        HOUSE.replace("[2.5, inf]", "[2.5, 2.5, inf]"),
        HOUSE
            .replace(
                "point3f[] points = [",
                "point3d[] points.timeSamples = { 2: [(0, 0, 0)], 1: [",
            )
            .replace("1.5e0, 0)]", "1.5e0, 0)] }"),
        HOUSE
            .replace("primvars:heat =", "primvars:heat.timeSamples = { 1:")
            .replace("4, 5]", "4, 5]}"),
    ] {
        let mut mesh = read(&variant).mesh;
        // Values over time have no place of their own among the others.
        mesh.primvars.sort_by_key(|p| std::cmp::Reverse(p.name.clone()));
        let mut house = house();
        house.primvars.sort_by_key(|p| std::cmp::Reverse(p.name.clone()));
        assert_eq!(mesh, house, "{variant}");
    }
    let animated = HOUSE
        .replace("points = [", "points.timeSamples = { 1: [")
        .replace("0)]\n        float3", "0)]}\n float3");
    let remarks = read(&animated).remarks;
    assert_eq!(remarks, ["`points` changes over time: its first value is taken"]);
}

#[test]
fn left_handed_and_mirrored_faces_are_turned_round() {
    let left = HOUSE
        .replace("float3[] extent", "uniform token orientation = \"leftHanded\"\nfloat3[] extent");
    let mesh = read(&left).mesh;
    let corners: Vec<u32> = mesh.faces.all_corners().iter().map(|v| v.0).collect();
    assert_eq!(corners, [0, 3, 2, 1, 3, 4, 2]);
    assert_eq!(mesh.primvars[0].indices, [0, 3, 2, 1, 0, 1, 2]);
    let scale =
        "float3 xformOp:scale = (1, -1, 1)\nuniform token[] xformOpOrder = [\"xformOp:scale\"]\n";
    let mirrored = read(&HOUSE.replace("    def Mesh", &format!("{scale}    def Mesh"))).mesh;
    assert_eq!(mirrored.faces, mesh.faces);
    assert_eq!(mirrored.positions[4], [0.5, -1.5, 0.0]);
    let both = read(&left.replace("    def Mesh", &format!("{scale}    def Mesh"))).mesh;
    assert_eq!(both.faces, house().faces);
}

#[test]
fn corners_without_indices_are_joined_where_they_are_equal() {
    let unindexed = HOUSE
        .replace("(1, 1), (0, 1)] (", "(1, 1), (0, 1), (0, 1), (1, 1), (.5, .5)] (")
        .replace("int[] primvars:st:indices = [0, 1, 2, 3, 0, 2, 1]\n", "");
    let mesh = read(&unindexed).mesh;
    assert_eq!(mesh.primvars[0].indices, [0, 1, 2, 3, 3, 2, 4]);
    assert_eq!(mesh.primvars[0].values[8..], [0.5, 0.5]);
}

#[test]
fn one_of_several_meshes_is_chosen_by_its_path() {
    let prim = |name: &str, z: f64| {
        format!(
            "def Mesh \"{name}\" {{ point3f[] points = [(0, 0, {z}), (1, 0, 0), (0, 1, 0)]\n\
             int[] faceVertexCounts = [3]; int[] faceVertexIndices = [0, 1, 2] }}\n"
        )
    };
    let text = format!(
        "#usda 1.0\n{}def Scope \"Geo\" {{ {} def \"Sub\" {{ {} }} }}\nclass Mesh \"C\" {{}}\n\
         over \"Geo\" {{ {} }}\ndef Mesh \"Off\" (active = false) {{}}\n",
        prim("A", 1.0),
        prim("AB", 2.0),
        prim("C", 3.0),
        prim("D", 4.0)
    );
    let z = |path| usd::read(text.as_bytes(), Some(path)).map(|usd| usd.mesh.positions[0][2]);
    assert_eq!(
        (z("/A"), z("/Geo/AB"), z("/Geo/Sub/C"), z("/Geo/Sub/")),
        (Ok(1.), Ok(2.), Ok(3.), Ok(3.))
    );
    let message = |path| z(path).unwrap_err().message;
    let all = "there are 3 meshes (/A, /Geo/AB, /Geo/Sub/C): choose one by its path (--prim)";
    assert_eq!(error(&text), format!("line 14: {all}"));
    assert_eq!(message("/"), all);
    assert_eq!(
        message("/Geo"),
        "there are 2 meshes (/Geo/AB, /Geo/Sub/C): choose one by its path (--prim)"
    );
    let expected = "there is no mesh at or below the path `/Ge`, but /A, /Geo/AB, /Geo/Sub/C";
    assert_eq!(message("/Ge"), expected);
    let none = "line 2: there is no mesh; define one as in `def Mesh \"Cage\" { ... }`";
    assert_eq!(error("#usda 1.0\ndef \"A\" {}"), none);
    let far = error("#usda 1.0\ndef \"A\" (references = @a.usd@</B> (offset = 1)) {}");
    assert!(
        far.ends_with("references and variants are not followed: write it by `usdcat --flatten`")
    );
}

#[test]
fn what_is_not_followed_is_said() {
    let text = HOUSE
        .replace("kind =", "prepend references = [@a.usda@, <../B>]\n kind =")
        .replace("\"catmullClark\"", "\"loop\"")
        .replace("\"varying\"", "\"constant\"")
        .replace("(interpolation = 'vertex')", "(interpolation = \"uniform\")")
        .replace(
            "asset texture",
            "token triangleSubdivisionRule = \"smooth\"; variantSet \"v\" = { \"a\" { int b = 1 } }\n\
             string[] primvars:tag = [\"a\"] (interpolation = \"vertex\"); asset texture",
        );
    let expected = [
        "`references` of the prim `World` is not followed",
        "`variantSet` of the prim `House` is not followed",
        "`subdivisionScheme` is `loop`, but is taken as `catmullClark`",
        "`triangleSubdivisionRule` is `smooth`, but is taken as `catmullClark`",
        "the primvar `displayColor` is skipped: only vertex, varying and faceVarying ones are kept",
        "the primvar `heat` is skipped: only vertex, varying and faceVarying ones are kept",
        "the primvar `tag` is skipped: it has no numbers",
    ];
    assert_eq!(read(&text).remarks, expected);
}

#[test]
fn faulty_files_are_told_the_line_and_what_to_do() {
    for (text, expected) in [
        (String::new(), "line 1: the file does not begin with `#usda 1.0`: it is empty"),
        (
            "v 0 0 0\n".to_owned(),
            "line 1: the file does not begin with `#usda 1.0`: it looks like OBJ: let its name end in",
        ),
        (swap("#usda", "#USDA"), "line 1: the file does not begin"),
        ("PXR-USDC\0\0".to_owned(), "line 1: this is binary USD, which is not read: convert it"),
        (
            swap("def Xform", "deaf Xform"),
            "line 9: `def`, `over` or `class` is expected, not `deaf`",
        ),
        (swap("\"World\" (", "World ("), "line 9: a string is expected, not `World`"),
        (swap("kind =", "kind"), "line 10: `=` is expected, not the string `component`"),
        (
            swap("[4, 3]", "[4 3]"),
            "line 19: after a value of a list, `,` or `]` is expected, not `3`",
        ),
        (
            swap("[4, 3]", "[4, 3"),
            "line 20: after a value of a list, `,` or `]` is expected, not `int`",
        ),
        (
            swap("(0, 0, 0), (1", "(0, 0 0), (1"),
            "line 21: after a number of a tuple, `,` or `)` is expected, not `0`",
        ),
        (swap("[4, 3]", "[4, x]"), "line 19: `faceVertexCounts` must be a list of numbers"),
        (swap("[4, 3]", "[4, 2.5]"), "line 19: `faceVertexCounts` has 2.5, which is not a whole"),
        (swap("[4, 3]", "[4, -3]"), "line 19: `faceVertexCounts` has -3, which is not a whole"),
        (swap("[4, 3]", "[4, 4]"), "line 19: `faceVertexCounts` adds up to 8, but `faceVertexI"),
        (
            swap("faceVertexCounts", "faceCounts"),
            "line 17: the mesh has no `faceVertexCounts`: add",
        ),
        (swap("3, 2, 4,", "3, 2, 5,"), "line 20: `faceVertexIndices` asks for vertex 5, but there"),
        (swap("(0, 0, 0), (1", "(0, 0), (1"), "line 21: `points` must have tuples of 3 numbers"),
        (swap("edgeOnly", "edges"), "line 24: `interpolateBoundary` is `edges`, but can be none, "),
        (swap("note = '''", "note = '"), "line 44: the string has no end"),
        (swap("'''\n", "\n"), "line 44: the string has no end: close it by '''"),
        (swap("        \"note\"'''\n    }\n}\n", "'''"), "line 45: a property, a prim or `}` is"),
        (swap("asset texture", "asset $"), "line 44: `$` has no meaning here"),
        (swap("1.5e0", "1.5ee"), "line 21: `1.5ee` is not a number: correct it"),
        (swap("[4, 3]", &"(".repeat(500)), "line 19: there are more than 100 brackets in each"),
    ] {
        let found = error(&text);
        assert!(found.starts_with(expected), "{expected}\n{found}");
    }
    let latin = [b"#usda 1.0\n# caf", &b"\xe9\n"[..]].concat();
    let fault = usd::read(&latin, None).unwrap_err().to_string();
    assert_eq!(fault, "line 2: the text is not UTF-8: convert it");
}

/// The house with one thing in it replaced.
fn swap(from: &str, to: &str) -> String {
    assert!(HOUSE.contains(from), "{from}");
    HOUSE.replacen(from, to, 1)
}

#[test]
fn faulty_tags_and_primvars_are_told_the_line_and_what_to_do() {
    for (text, expected) in [
        (swap("[3, 2]", "[3, 1]"), "line 27: `creaseLengths` must be numbers from 2 that add up"),
        (swap("[2.5, inf]", "[2.5]"), "line 28: `creaseSharpnesses` must have a number for each"),
        (swap("[2.5, inf]", "[2.5, nan]"), "line 28: `creaseSharpnesses` has NaN"),
        (swap("[0, 1, 2, 2, 3]", "[0, 1, 2, 2, 9]"), "line 26: `creaseIndices` asks for vertex 9"),
        (
            swap("[2.5, inf]", "[2.5, -1]"),
            "line 28: `creaseSharpnesses` has -1, but sharpness is 0 (smooth) or more: correct it",
        ),
        (swap("[10]", "[-0.5]"), "line 30: `cornerSharpnesses` has -0.5, but sharpness is 0"),
        (swap("[10]", "[10, 1]"), "line 30: `cornerSharpnesses` must have a number for each of"),
        (swap("cornerSharpnesses", "sharpnesses"), "line 17: the mesh has no `cornerSharpnesses`"),
        (swap("Indices = [4]", "Indices = [5]"), "line 29: `cornerIndices` asks for vertex 5"),
        (swap("holeIndices = [1]", "holeIndices = [2]"), "line 31: `holeIndices` asks for face 2"),
        (
            swap("0, 2, 1]\n", "0, 2, 4]\n"),
            "line 32: `primvars:st` has 4 values, but its indices ask",
        ),
        (
            swap("0, 2, 1]\n", "0, 2]\n"),
            "line 32: `primvars:st` has 6 values for 7 corners of faces",
        ),
        (
            swap("[1, 2, 3, 4, 5]", "[1, 2, 3, 4]"),
            "line 41: `primvars:heat` has 4 values for 5 ver",
        ),
    ] {
        let found = error(&text);
        assert!(found.starts_with(expected), "{expected}\n{found}");
    }
}

#[test]
fn transforms_that_cannot_be_applied_are_refused() {
    let with = |ops: &str| error(&HOUSE.replace("    def Mesh", &format!("{ops}\n    def Mesh")));
    for (ops, expected) in [
        (
            "token[] xformOpOrder = [\"xformOp:scale\"]",
            "`xformOpOrder` names `xformOp:scale`, which",
        ),
        (
            "float3 xformOp:scale = (1, 0, 1); token[] xformOpOrder = [\"!invert!xformOp:scale\"]",
            "`xformOpOrder` inverts `xformOp:scale`, which cannot be",
        ),
        (
            "float xformOp:shear = 1; token[] xformOpOrder = [\"xformOp:shear\"]",
            "`xformOp:shear` is no operation that is known: apply it",
        ),
        (
            "matrix4d xformOp:transform = ((1,0,0,1), (0,1,0,0), (0,0,1,0), (0,0,0,1))\n\
             token[] xformOpOrder = [\"xformOp:transform\"]",
            "`xformOp:transform` is not affine",
        ),
        (
            "float3 xformOp:scale = (1, inf, 1); token[] xformOpOrder = [\"xformOp:scale\"]",
            "`xformOp:scale` must be one finite value",
        ),
    ] {
        let found = with(ops);
        assert!(found.contains(expected), "{found}");
    }
}

#[test]
fn points_are_named_by_number_and_line() {
    let text = "#usda 1.0\ndef Mesh \"Cage\" {\n    point3f[] points = [(0, 0, 0),\n\
                (1, 0, 0), (0,\n1, inf)]\nint[] faceVertexCounts = [3]\n\
                int[] faceVertexIndices = [0, 1, 2]\n}\n";
    let loaded = evenlight::io::load::Loaded::from(read(text));
    let found = loaded.check().unwrap_err().to_string();
    assert!(found.starts_with("vertex 2 (line 4) is at (0, 1, inf): give it"), "{found}");
}

/// Texture coordinates stay what they are said to be.
#[test]
fn sets_of_texture_coordinates_keep_their_role() {
    for (name, interpolation, kind) in [
        ("uv2", "vertex", "texCoord2f"),
        ("UVMap_001", "vertex", "texCoord2f"),
        ("lightmap", "faceVarying", "texCoord2f"),
        ("stretch", "vertex", "float2"),
    ] {
        let values = if interpolation == "vertex" { 5 } else { 7 };
        let values: Vec<String> = (0..values).map(|k| format!("({k}, 0)")).collect();
        let line = format!(
            "{kind}[] primvars:{name} = [{}] (interpolation = \"{interpolation}\")\n",
            values.join(", ")
        );
        let text =
            written(&read(&HOUSE.replace("        color3f", &format!("{line}color3f"))).mesh);
        assert!(text.contains(&format!("{kind}[] primvars:{name} = ")), "{text}");
    }
}

#[test]
fn primvars_without_a_place_are_named() {
    let mut mesh = house();
    mesh.primvars[0].name = "map 1".to_owned();
    mesh.primvars[2].values.pop();
    let expected = [
        "the primvar `map 1` is not fit for a primvar of USD: it is left out",
        "the primvar `heat` is not fit for a primvar of USD: it is left out",
    ];
    assert_eq!(usd::omitted(&mesh), expected);
    assert_eq!(read(&written(&mesh)).mesh.primvars, [mesh.primvars[1].clone()]);
}

/// Meshes with everything that USD can hold.
fn full_mesh() -> impl Strategy<Value = Mesh> {
    let number = || prop::num::f64::NORMAL | prop::num::f64::ZERO;
    (3usize..20, 1usize..10, 1usize..8)
        .prop_flat_map(move |(num_vertices, num_faces, num_values)| {
            let vertex = move || (0..num_vertices as u32).prop_map(VertexId);
            let crease = (vertex(), vertex(), 0.0..12.0f64);
            let crease = crease.prop_map(|(a, b, sharpness)| Crease { edge: [a, b], sharpness });
            let corner = (vertex(), 0.0..12.0f64);
            let corner = corner.prop_map(|(vertex, sharpness)| Corner { vertex, sharpness });
            let tags = (
                prop::sample::select(vec![BoundaryRule::None, BoundaryRule::EdgeOnly]),
                prop::sample::select(vec![FaceVaryingRule::All, FaceVaryingRule::CornersPlus2]),
                prop::sample::select(vec![CreaseMethod::Uniform, CreaseMethod::Chaikin]),
                prop::collection::vec(crease, 0..6),
                prop::collection::vec(corner, 0..6),
                prop::collection::vec((0..num_faces as u32).prop_map(FaceId), 0..4),
            );
            let tags = tags.prop_map(
                |(boundary, face_varying, crease_method, creases, corners, holes)| Tags {
                    boundary,
                    face_varying,
                    crease_method,
                    creases,
                    corners,
                    holes,
                },
            );
            let corner = (0..num_vertices as u32, 0..num_values as u32);
            (
                prop::collection::vec(prop::array::uniform3(number()), num_vertices),
                prop::collection::vec(prop::collection::vec(corner, 0..6), num_faces),
                prop::collection::vec(number(), 4 * num_values),
                prop::collection::vec(number(), 3 * num_vertices),
                prop::collection::vec(number(), num_vertices),
                tags,
            )
        })
        .prop_map(|(positions, faces, corner_values, colors, heat, tags)| {
            let corners = faces.iter().map(|f| f.iter().map(|c| c.0).collect::<Vec<_>>());
            let mut mesh = Mesh::new(positions, corners);
            mesh.tags = tags;
            let indices = faces.iter().flatten().map(|c| c.1).collect();
            let primvar = |name: &str, interpolation, width, values| Primvar {
                name: name.to_owned(),
                interpolation,
                width,
                values,
                indices: vec![],
            };
            mesh.primvars = vec![
                primvar("color", Interpolation::Vertex, 3, colors),
                Primvar { indices, ..primvar("a:b", Interpolation::FaceVarying, 4, corner_values) },
                primvar("heat", Interpolation::Varying, 1, heat),
            ];
            mesh
        })
}

proptest! {
    /// USD -> USD keeps all that the format can hold, to the last bit.
    #[test]
    fn everything_is_read_as_it_was_written(mesh in full_mesh()) {
        prop_assert!(usd::omitted(&mesh).is_empty());
        let text = written(&mesh);
        let usd = read(&text);
        prop_assert_eq!(&usd.mesh, &mesh);
        prop_assert!(usd.remarks.is_empty());
        prop_assert_eq!(written(&usd.mesh), text);
    }
}

/// Prims with every operation of a transform: the paths of the meshes below them.
fn transforms() -> (String, Vec<String>) {
    let mesh = "def Mesh \"M\" { point3f[] points = [(1, 2, 3), (2, 2, 3), (1, 5, 3.5)]\n\
                int[] faceVertexCounts = [3]; int[] faceVertexIndices = [0, 1, 2]\n}\n";
    let mut cases: Vec<(String, &str)> = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"]
        .iter()
        .map(|order| (format!("float3 xformOp:rotate{order} = (10, 200, -37)"), ""))
        .collect();
    for axis in ["X", "Y", "Z"] {
        cases.push((format!("float xformOp:rotate{axis}:a = 123.5"), ""));
    }
    cases.push(("quatf xformOp:orient = (0.5, 0.5, -0.5, 0.5)".to_owned(), ""));
    cases.push(("double3 xformOp:translate = (4, 5, 6)".to_owned(), ""));
    cases.push(("float3 xformOp:scale = (2, 3, -0.5)".to_owned(), ""));
    cases.push((
        "matrix4d xformOp:transform = ((1, 2, 0, 0), (0, 1, 3, 0), (1, 0, 1, 0), (7, 8, 9, 1))"
            .to_owned(),
        "",
    ));
    cases.push((
        "double3 xformOp:translate = (4, 5, 6); float3 xformOp:rotateXYZ = (10, 20, 30); \
         float3 xformOp:translate:pivot = (1, 0, 0)"
            .to_owned(),
        "\"xformOp:translate\", \"xformOp:translate:pivot\", \"xformOp:rotateXYZ\", \
         \"!invert!xformOp:translate:pivot\"",
    ));
    let mut text = "#usda 1.0\n".to_owned();
    let mut paths = Vec::new();
    for (k, (operations, order)) in cases.iter().enumerate() {
        let name = operations.split_once(' ').unwrap().1.split_once(" =").unwrap().0;
        let order = if order.is_empty() { format!("\"{name}\"") } else { (*order).to_owned() };
        let reset = if k % 3 == 2 { "\"!resetXformStack!\", " } else { "" };
        text += &format!(
            "def Xform \"P{k}\" {{ {operations}\nuniform token[] xformOpOrder = [{order}]\n\
             def Xform \"Q\" {{ double3 xformOp:translate = (1, 2, {k})\n\
             uniform token[] xformOpOrder = [{reset}\"xformOp:translate\"]\n{mesh}}}\n}}\n"
        );
        paths.push(format!("/P{k}/Q/M"));
    }
    (text, paths)
}

/// Points of a mesh as Pixar's library finds them on the stage, and all of its attributes that we
/// keep, one line each.
const ORACLE: &str = r#"
import sys
from pxr import Usd, UsdGeom, Gf
stage = Usd.Stage.Open(sys.argv[1])
for path in sys.argv[2:]:
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath(path))
    to_stage = UsdGeom.XformCache().GetLocalToWorldTransform(mesh.GetPrim())
    def show(name, values):
        print(path, name, *values)
    def numbers(values):
        return [float(x) for v in values for x in (v if hasattr(v, "__len__") else [v])]
    show("points", numbers(to_stage.TransformAffine(Gf.Vec3d(p)) for p in mesh.GetPointsAttr().Get()))
    show("counts", mesh.GetFaceVertexCountsAttr().Get())
    show("indices", mesh.GetFaceVertexIndicesAttr().Get())
    show("scheme", [mesh.GetSubdivisionSchemeAttr().Get()])
    show("boundary", [mesh.GetInterpolateBoundaryAttr().Get()])
    show("fvar", [mesh.GetFaceVaryingLinearInterpolationAttr().Get()])
    for name in ("CreaseIndices", "CreaseLengths", "CreaseSharpnesses", "CornerIndices",
                 "CornerSharpnesses", "HoleIndices"):
        show(name, getattr(mesh, f"Get{name}Attr")().Get() or [])
    for primvar in UsdGeom.PrimvarsAPI(mesh).GetPrimvarsWithValues():
        name, _, interpolation, _ = primvar.GetDeclarationInfo()
        show(name, [interpolation])
        show(name + ".values", numbers(primvar.Get()))
        show(name + ".indices", primvar.GetIndices() or [])
"#;

/// What the oracle says of the meshes at `paths` in `text`: words of each line.
fn ask_oracle(name: &str, text: &str, paths: &[String]) -> Vec<Vec<String>> {
    let python = std::env::var("EVENLIGHT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&file, text).unwrap();
    let mut command = Command::new(&python);
    let output = command.args(["-c", ORACLE]).arg(&file).args(paths).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{python} -m pip install usd-core\n{errors}");
    assert!(errors.is_empty(), "{errors}");
    let lines = String::from_utf8(output.stdout).unwrap();
    lines.lines().map(|line| line.split(' ').map(str::to_owned).collect()).collect()
}

fn floats(words: &[String]) -> Vec<f64> {
    words.iter().map(|word| word.parse().unwrap()).collect()
}

fn agree(ours: &[f64], words: &[String]) {
    let theirs = floats(words);
    assert_eq!(ours.len(), theirs.len());
    for (a, b) in ours.iter().zip(theirs) {
        // USD has 24 bits.
        assert!((a - b).abs() <= 1e-6 * a.abs().max(1.0) || *a == b, "{a} {b}");
    }
}

#[test]
#[ignore = "needs a Python with usd-core"]
fn pixars_library_finds_the_same_points_behind_every_transform() {
    let (text, paths) = transforms();
    let answers = ask_oracle("transforms.usda", &text, &paths);
    for path in &paths {
        let mesh = usd::read(text.as_bytes(), Some(path)).unwrap().mesh;
        let points = answers.iter().find(|words| words[0] == *path && words[1] == "points");
        agree(&mesh.positions.concat(), &points.unwrap()[2..]);
    }
}

#[test]
#[ignore = "needs a Python with usd-core"]
fn pixars_library_reads_what_we_read_and_what_we_write() {
    let mesh = house();
    for (text, path) in [(HOUSE.to_owned(), "/World/House"), (written(&mesh), "/Cage")] {
        let answers = ask_oracle("house.usda", &text, &[path.to_owned()]);
        let find = |name: &str| &answers.iter().find(|words| words[1] == name).unwrap()[2..];
        agree(&mesh.positions.concat(), find("points"));
        agree(&[4.0, 3.0], find("counts"));
        agree(&[0.0, 1.0, 2.0, 3.0, 3.0, 2.0, 4.0], find("indices"));
        assert_eq!(
            (find("scheme"), find("boundary")),
            (&["catmullClark".into()][..], &["edgeOnly".into()][..])
        );
        assert_eq!(find("fvar"), ["boundaries"]);
        agree(&[4.0], find("CornerIndices"));
        agree(&[10.0], find("CornerSharpnesses"));
        agree(&[1.0], find("HoleIndices"));
        let lengths = floats(find("CreaseLengths"));
        assert_eq!(lengths.iter().sum::<f64>(), find("CreaseIndices").len() as f64);
        assert_eq!(find("st"), ["faceVarying"]);
        agree(&mesh.primvars[0].values, find("st.values"));
        agree(&[0.0, 1.0, 2.0, 3.0, 0.0, 2.0, 1.0], find("st.indices"));
        assert_eq!(
            (find("displayColor"), find("heat")),
            (&["vertex".into()][..], &["varying".into()][..])
        );
        agree(&mesh.primvars[2].values, find("heat.values"));
    }
}
