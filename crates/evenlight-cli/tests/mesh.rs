//! `evenlight mesh`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use std::collections::BTreeMap;
use std::fs;

use common::{CUBE, PILLOW, SCHEMES, arg, cage, code, run, run_on, stderr, stdout};

fn obj(args: &[&str]) -> String {
    let pillow = cage(PILLOW);
    let fixed = ["mesh", arg(&pillow), "-o", "-", "--format", "obj"];
    stdout(&run(&[&fixed[..], args].concat()))
}

fn triangles(obj: &str) -> Vec<[u32; 3]> {
    let faces = obj.lines().filter_map(|line| line.strip_prefix("f "));
    let corner = |c: &str| c.split('/').next().unwrap().parse().unwrap();
    faces.map(|f| f.split(' ').map(corner).collect::<Vec<_>>().try_into().unwrap()).collect()
}

#[test]
fn a_closed_cage_gives_a_closed_mesh() {
    for scheme in SCHEMES {
        let triangles = triangles(&obj(&["--rate", "3", "--scheme", scheme]));
        assert_eq!(triangles.len(), 150 * 2 * 3 * 3);
        let mut edges: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        for [a, b, c] in triangles {
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_default() += 1;
            }
        }
        // Every directed edge once, and its opposite once: watertight and oriented.
        assert!(edges.iter().all(|(&(a, b), &n)| n == 1 && edges.get(&(b, a)) == Some(&1)));
    }
}

#[test]
fn the_default_rate_is_8() {
    assert_eq!(obj(&[]), obj(&["--rate", "8"]));
}

#[test]
fn normals_have_length_one() {
    let text = obj(&["--rate", "2"]);
    let normals: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("vn ")).collect();
    assert_eq!(normals.len(), text.lines().filter(|line| line.starts_with("v ")).count());
    for n in normals {
        let length: f64 = n.split(' ').map(|x| x.parse::<f64>().unwrap().powi(2)).sum();
        assert!((length - 1.0).abs() < 1e-14, "{n}");
    }
}

#[test]
fn the_extension_chooses_the_format() {
    let folder = tempfile::tempdir().unwrap();
    for (name, beginning) in [("a.obj", "v "), ("a.PLY", "ply\n"), ("a.stl", "Binary STL")] {
        let file = folder.path().join(name);
        stdout(&run_on(CUBE, &["mesh", "-", "-o", arg(&file)]));
        assert!(fs::read(&file).unwrap().starts_with(beginning.as_bytes()), "{name}");
    }
}

#[test]
fn ply_has_curvature_properties() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.ply");
    stdout(&run_on(CUBE, &["mesh", "-", "-o", arg(&file)]));
    let bytes = fs::read(&file).unwrap();
    let header = String::from_utf8_lossy(&bytes[..1000]).into_owned();
    assert!(header.contains("property float gauss_curvature"), "{header}");
    assert!(header.contains("property float mean_curvature"));
}

/// Nothing falls back silently: a scheme without rules for a point says that it is Catmull-Clark.
#[test]
fn catmull_clark_in_place_of_the_scheme_is_told() {
    let pillow = cage(PILLOW);
    let stderr = |scheme: &[&str]| {
        let fixed = ["mesh", arg(&pillow), "-o", "-", "--format", "obj", "--rate", "1"];
        let output = run(&[&fixed[..], scheme].concat());
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let told = stderr(&["--scheme", "guided5", "--rules", "published"]);
    let sentence =
        "scheme guided5 has no published rules, cc takes their place: vertex 0 has valence";
    assert!(told.contains(sentence) && told.contains(" more (numbers from 0)"), "{told}");
    assert_eq!(stderr(&["--scheme", "guided5"]), "");
}

/// A square of two quads with a sharp edge between them, texture coordinates and colours.
const ROOF: &str = "v 0 0 0 1 0 0\nv 1 0 1 0 1 0\nv 2 0 0 0 0 1\nv 0 1 0 1 0 0\nv 1 1 1 0 1 0\n\
                    v 2 1 0 0 0 1\nvt 0 0\nvt .5 0\nvt 1 0\nvt 0 1\nvt .5 1\nvt 1 1\n\
                    f 1/1 2/2 5/5 4/4\nf 2/2 3/3 6/6 5/5\nt crease 2/1/0 1 4 10\n";

#[test]
fn sharp_edges_have_two_normals_and_primvars_are_written() {
    let fixed = ["mesh", "-", "-o", "-", "--rate", "2", "--format"];
    let written = |format: &str| run_on(ROOF, &[&fixed[..], &[format]].concat());
    let text = stdout(&written("obj"));
    let count = |tag: &str| text.lines().filter(|line| line.starts_with(tag)).count();
    assert_eq!(["v ", "vt ", "vn ", "f "].map(count), [15, 15, 18, 16]);
    assert!(text.lines().filter(|l| l.starts_with("v ")).all(|l| l.split(' ').count() == 7));
    let glb = written("glb").stdout;
    let json = String::from_utf8_lossy(&glb[20..]).into_owned();
    assert!(json.contains(r#""TEXCOORD_0":4,"COLOR_0":5"#), "{json}");
}

#[test]
fn what_a_format_cannot_hold_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let told = |name: &str| {
        let file = folder.path().join(name);
        let output = run_on(ROOF, &["mesh", "-", "-o", arg(&file)]);
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    assert_eq!(told("a.glb") + &told("a.obj"), "");
    assert!(told("a.ply").contains("a.ply: PLY has one normal for a vertex: on sharp edges it is"));
    assert!(told("a.stl").contains("STL holds nothing but triangles: `st`, `color` left out"));
}

#[test]
fn coordinates_beyond_32_bits_are_refused_where_the_format_has_no_more() {
    let cage = CUBE.replace("v -1 -1 -1\n", "v -1e300 -1 -1\n");
    for format in ["stl", "glb"] {
        let output = run_on(&cage, &["mesh", "-", "-o", "-", "--format", format]);
        assert_eq!((code(&output), output.stdout.len()), (1, 0), "{format}");
        let message = stderr(&output);
        assert!(message.starts_with("error: stdout: a coordinate is too large for the 32 bits"));
    }
}
