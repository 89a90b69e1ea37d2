//! The PLY reader and the checks meet files that nobody would write.
//!
//! Whatever the bytes, the reader must neither panic nor run away, an error must say something,
//! and a cage must be what its file says when written and read again in any encoding. The cases
//! are the same in every run; the long run has a million of them:
//!
//! ```text
//! cargo test --release -p evenlight --test fuzz_ply -- --ignored
//! ```

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod fuzz;

use evenlight::Mesh;
use evenlight::io::load::Format;
use evenlight::io::ply::{self, Encoding};
use fuzz::{Random, mutated, noise};

const ENCODINGS: [Encoding; 3] = [Encoding::Ascii, Encoding::LittleEndian, Encoding::BigEndian];

const WORDS: &[&str] = &[
    "ply",
    "format",
    "ascii",
    "binary_little_endian",
    "1.0",
    "element",
    "vertex",
    "face",
    "edge",
    "property",
    "list",
    "float",
    "double",
    "uchar",
    "int",
    "uint",
    "x",
    "y",
    "z",
    "red",
    "s",
    "t",
    "vertex_indices",
    "texcoord",
    "end_header",
    "comment",
    "0",
    "1",
    "2",
    "3",
    "4",
    "-1",
    "99",
    "18446744073709551615",
    "nan",
    "1e999",
    ".5",
    "a_0",
    "a_1",
    "\u{e9}",
];

/// Words of headers and bodies without any order, after a beginning that most files have.
fn rubble(random: &mut Random) -> Vec<u8> {
    let mut text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                    property float z\n"
        .to_owned();
    for _ in 0..random.below(60) {
        text += random.pick(WORDS);
        text += random.pick(&[" ", " ", " ", "\n", "\n", "\r\n"]);
    }
    text.into_bytes()
}

/// Small cages, good as they are, in all encodings.
fn good_files() -> Vec<Vec<u8>> {
    let ascii = "ply\nformat ascii 1.0\ncomment a cube\nelement vertex 8\nproperty float x\n\
        property float y\nproperty double z\nproperty uchar red\nproperty uchar green\n\
        property uchar blue\nproperty float s\nproperty float t\nproperty short a_0\n\
        property short a_1\nelement face 6\nproperty list uchar int vertex_indices\n\
        property list uchar float texcoord\nelement edge 1\nproperty int vertex1\nend_header\n\
        0 0 0 0 0 0 0 0 1 2\n1 0 0 9 0 0 0 0 1 2\n1 1 0 255 0 0 0 0 1 2\n0 1 0 0 0 0 0 0 1 2\n\
        0 0 1 0 0 0 0 0 1 2\n1 0 1 0 0 0 0 0 1 2\n1 1 1 0 7 0 0 .5 1 2\n0 1 1 0 0 0 0 0 1 2\n\
        4 0 3 2 1 8 0 0 1 0 1 1 0 1\n4 4 5 6 7 0\n4 0 1 5 4 0\n4 1 2 6 5 0\n4 2 3 7 6 0\n\
        4 3 0 4 7 8 1 1 1 1 0 0 2 2\n1\n";
    let mesh = ply::read(ascii.as_bytes()).unwrap().mesh;
    let mut files = vec![ascii.into(), ascii.replace('\n', "\r\n").into()];
    files.extend(ENCODINGS.map(|encoding| written(&mesh, encoding)));
    files
}

fn written(mesh: &Mesh, encoding: Encoding) -> Vec<u8> {
    let mut bytes = Vec::new();
    ply::write(mesh, encoding, &mut bytes).unwrap();
    bytes
}

fn case(seed: u64, good: &[Vec<u8>]) -> Vec<u8> {
    let random = &mut Random(seed);
    match random.below(8) {
        0 => noise(random),
        1 => [b"ply\n", &noise(random)[..]].concat(),
        2 => rubble(random),
        _ => {
            let file = &good[random.below(good.len())];
            mutated(file, b"0123456789- \n\r.xyz", random)
        }
    }
}

/// Reads and checks `bytes`; whether they are a cage.
fn hold_to_the_contract(bytes: &[u8]) -> bool {
    match Format::Ply.read(bytes, None).and_then(|loaded| loaded.check()) {
        Ok((cage, notices)) => {
            assert!(notices.iter().all(|notice| !notice.to_string().is_empty()));
            let mesh = Mesh {
                positions: cage.positions().to_vec(),
                faces: cage.topology().faces().clone(),
                tags: cage.tags().clone(),
                primvars: cage.primvars().to_vec(),
            };
            if ply::omitted(&mesh).is_empty() {
                for encoding in ENCODINGS {
                    let again = ply::read(&written(&mesh, encoding)).unwrap().mesh;
                    assert_eq!((&again.positions, &again.faces), (&mesh.positions, &mesh.faces));
                    assert_eq!(num_values(&again), num_values(&mesh));
                }
            }
            true
        }
        Err(error) => {
            let message = error.to_string();
            fuzz::assert_readable(&message);
            false
        }
    }
}

/// The numbers in all primvars of vertices. Primvars `a_0` and `a_1` may have become one.
fn num_values(mesh: &Mesh) -> usize {
    let of_vertices = mesh.primvars.iter().filter(|p| p.indices.is_empty());
    of_vertices.map(|p| p.values.len()).sum()
}

fn run(count: u64) -> usize {
    let good = good_files();
    assert!(good.iter().all(|file| hold_to_the_contract(file)));
    fuzz::run(count, |seed| case(seed, &good), hold_to_the_contract)
}

#[test]
fn twenty_thousand_cases() {
    let cages = run(20_000);
    assert!((1000..19_000).contains(&cages), "{cages}: the cases should be good and bad");
}

#[test]
#[ignore = "takes half a minute in release"]
fn a_million_cases() {
    println!("{} of 1000000 cases were cages", run(1_000_000));
}

/// Headers that promise more than the file has, without end or without bytes.
#[test]
fn promises_take_no_memory_and_no_time() {
    let header = |count: &str, more: &str| {
        format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {count}\nproperty float x\n\
             property float y\nproperty float z\n{more}end_header\n"
        )
    };
    for text in [
        header("4294967295", ""),
        header("0", "element face 18446744073709551615\nproperty list uint uint vertex_index\n"),
        header("0", "element edge 18446744073709551615\nproperty uchar a\n"),
        header("0", "element edge 18446744073709551615\n"),
        header("0", "element face 1\nproperty list uint uint vertex_index\n")
            + "\u{7f}\u{7f}\u{7f}\u{7f}",
    ] {
        assert!(!hold_to_the_contract(text.as_bytes()));
    }
}
