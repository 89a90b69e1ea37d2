//! The USD reader and the checks meet texts that nobody would write.
//!
//! Whatever the bytes, the reader must neither panic nor run away, an error must name a line of
//! the file and say something, and a cage must be what its file says when written and read
//! again. The cases are the same in every run; the long run has a million of them:
//!
//! ```text
//! cargo test --release -p evenlight --test fuzz_usd -- --ignored
//! ```

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod fuzz;

use evenlight::Mesh;
use evenlight::io::load::{Format, LoadError};
use evenlight::io::usd;
use fuzz::{Random, mutated, noise};

const WORDS: &[&str] = &[
    "def",
    "over",
    "class",
    "Mesh",
    "Xform",
    "\"A\"",
    "'B'",
    "\"\"\"",
    "{",
    "}",
    "(",
    ")",
    "[",
    "]",
    "=",
    ",",
    ":",
    ";",
    "int[]",
    "point3f[]",
    "token",
    "uniform",
    "custom",
    "rel",
    "variantSet",
    "points",
    "faceVertexCounts",
    "faceVertexIndices",
    "holeIndices",
    "primvars:st",
    "primvars:st:indices",
    "interpolation",
    "\"vertex\"",
    "\"faceVarying\"",
    "orientation",
    "\"leftHanded\"",
    "xformOpOrder",
    "[\"xformOp:scale\"]",
    "xformOp:scale",
    "(1, 2, 3)",
    "0",
    "1",
    "3",
    "4294967295",
    "-1",
    "1e999",
    "inf",
    "nan",
    "None",
    "true",
    "@a@",
    "</A>",
    "@@@",
    "#",
    "//",
    "/*",
    "*/",
    "\\",
    "\u{e9}",
    "points.timeSamples",
    "{ 1: [(0, 0, 0)] }",
    "reorder",
    "add",
];

/// Words of the grammar without any order.
fn rubble(random: &mut Random) -> Vec<u8> {
    let mut text = "#usda 1.0\n".to_owned();
    if random.one_in(2) {
        text += "def Mesh \"M\" {\n";
    }
    for _ in 0..random.below(60) {
        text += random.pick(WORDS);
        text += random.pick(&[" ", " ", " ", "\n", "\n", ""]);
    }
    text.into_bytes()
}

/// Small cages, good as they are.
fn good_texts() -> Vec<Vec<u8>> {
    let shape = "point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), \
        (1, 0, 1), (1, 1, 1), (0, 1, 1)]\nint[] faceVertexCounts = [4, 4, 4, 4, 4, 4]\n\
        int[] faceVertexIndices = [0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, \
        3, 0, 4, 7]\n";
    let tags = "uniform token interpolateBoundary = \"none\"\nint[] creaseIndices = [0, 1, 2, 4, 5]\n\
        int[] creaseLengths = [3, 2]\nfloat[] creaseSharpnesses = [2.5, inf]\n\
        int[] cornerIndices = [3, 7]\nfloat[] cornerSharpnesses = [1, 10]\nint[] holeIndices = [2]\n\
        color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0)] (interpolation = \"vertex\")\n\
        int[] primvars:displayColor:indices = [0, 1, 0, 1, 0, 1, 0, 1]\n\
        float2[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = \"faceVarying\")\n\
        int[] primvars:st:indices = [0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, \
        0, 1, 2, 3]\n";
    let xform = "float3 xformOp:scale = (1, 2, 3)\nfloat xformOp:rotateX = 30\n\
        uniform token[] xformOpOrder = [\"xformOp:scale\", \"!invert!xformOp:rotateX\"]\n";
    let text = format!(
        "#usda 1.0\n(\n defaultPrim = \"W\"\n)\ndef Xform \"W\" (\n kind = \"group\"\n)\n{{\n{xform}\
         def Mesh \"M\"\n{{\n{shape}{tags}}}\n}}\n"
    );
    let bare = format!("#usda 1.0\ndef Mesh \"M\" {{\n{shape}}}\n");
    vec![text.clone().into(), text.replace('\n', "\r\n").into(), bare.into()]
}

fn case(seed: u64, good: &[Vec<u8>]) -> Vec<u8> {
    let random = &mut Random(seed);
    match random.below(8) {
        0 => [b"#usda 1.0\n", &noise(random)[..]].concat(),
        1..=2 => rubble(random),
        _ => {
            let file = &good[random.below(good.len())];
            mutated(file, b"0123456789- \n()[]{}=,:\"'#.", random)
        }
    }
}

/// Reads and checks `bytes`; whether they are a cage.
fn hold_to_the_contract(bytes: &[u8]) -> bool {
    match Format::Usda.read(bytes, None).and_then(|loaded| loaded.check()) {
        Ok((cage, notices)) => {
            assert!(notices.iter().all(|notice| !notice.to_string().is_empty()));
            let mesh = Mesh {
                positions: cage.positions().to_vec(),
                faces: cage.topology().faces().clone(),
                tags: cage.tags().clone(),
                primvars: cage.primvars().to_vec(),
            };
            let mut text = Vec::new();
            usd::write(&mesh, &mut text).unwrap();
            let again = usd::read(&text, None).unwrap();
            if usd::omitted(&mesh).is_empty() {
                assert_eq!(again.mesh, mesh);
            }
            assert!(again.remarks.is_empty());
            true
        }
        Err(error) => {
            let message = error.to_string();
            fuzz::assert_readable(&message);
            if let LoadError::Usd(error) = error {
                let lines = bytes.iter().filter(|&&b| b == b'\n').count() + 1;
                assert!((1..=lines).contains(&error.line), "{message}");
            }
            false
        }
    }
}

fn run(count: u64) -> usize {
    let good = good_texts();
    assert!(good.iter().all(|text| hold_to_the_contract(text)));
    fuzz::run(count, |seed| case(seed, &good), hold_to_the_contract)
}

#[test]
fn twenty_thousand_cases() {
    let cages = run(20_000);
    assert!((1000..19_000).contains(&cages), "{cages}: the cases should be good and bad");
}

#[test]
#[ignore = "takes a minute in release"]
fn a_million_cases() {
    println!("{} of 1000000 cases were cages", run(1_000_000));
}

/// Texts that would take the stack, or hours if anything were quadratic in them.
#[test]
fn monotony_is_read_in_linear_time() {
    const N: usize = 100_000;
    for (open, body, close) in [
        ("", "(".repeat(N), ""),
        ("def \"A\" {", "def \"A\" {".repeat(N), ""),
        ("def \"A\" { int a = ", "[".repeat(N), ""),
        ("def \"A\" { int a = ", "{ int a = ".repeat(N), ""),
        ("def \"A\" { int[] a = [", "1,".repeat(N), "]}"),
        ("def \"A\" {", "int a = 1\n".repeat(N), "}"),
        ("def \"A\" {", "def Mesh \"B\" {}\n".repeat(N), "}"),
        ("", "def \"A\" {}\n".repeat(N), ""),
        ("def \"A\" { string a = '''", "a\\'\n".repeat(N), "'''}"),
        ("", "#\n".repeat(N), ""),
        ("", "/* */".repeat(N), ""),
        ("def Mesh \"M\" {", "float primvars:a = 1 (interpolation = \"vertex\")\n".repeat(N), "}"),
    ] {
        assert!(!hold_to_the_contract(format!("#usda 1.0\n{open}{body}{close}").as_bytes()));
    }
}
