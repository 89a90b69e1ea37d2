//! The OBJ reader and the checks meet texts that nobody would write.
//!
//! Whatever the bytes, the reader must neither panic nor run away, an error must name a line
//! of the file and say something, and a cage must be what its file says when written and read
//! again. The cases are the same in every run; the long run has a million of them:
//!
//! ```text
//! cargo test --release -p evenlight --test fuzz_obj -- --ignored
//! ```

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod fuzz;

use std::path::Path;

use evenlight::Mesh;
use evenlight::io::load::Format;
use evenlight::io::load::LoadError;
use evenlight::io::obj;
use fuzz::{Random, mutated, noise};

/// Bytes that mean something to the reader, without any order.
fn rubble(random: &mut Random) -> Vec<u8> {
    const BYTES: &[u8] = b"vvvfff     \n\n\n\r\\#/-+.0123456789entiaosg\t\xff\0";
    (0..random.below(300)).map(|_| random.pick(BYTES)).collect()
}

const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "1",
    "0.5",
    "-2.25",
    "1e3",
    "1e-7",
    "1e999",
    "-1e999",
    "nan",
    "inf",
    "-Infinity",
    "1e-400",
    "4.9e-324",
    "1.7976931348623157e308",
    ".",
    ".5",
    "5.",
    "+1",
    "1e",
    "0x10",
    "1,5",
];

const INDICES: &[&str] = &[
    "0",
    "-0",
    "1",
    "2",
    "3",
    "4",
    "5",
    "6",
    "7",
    "8",
    "-1",
    "-2",
    "-3",
    "-4",
    "4294967295",
    "4294967296",
    "4294967297",
    "-4294967297",
    "9223372036854775807",
    "9223372036854775808",
    "-99999999999999999999999",
    "",
    "+3",
    "1.0",
    "x",
];

const OTHERS: &[&str] = &[
    "",
    "#",
    "# f 1 2 3",
    "o a",
    "g",
    "s off",
    "usemtl \u{e9}",
    "l 1 2",
    "\\",
    "\\ \\",
    "vt",
    "vn 1",
    "vt 0 0",
    "vt 1 0.5",
    "vt 0.25 1 -3",
    "vt 1e999 0",
    "vn 0 0 1",
    "t crease 2/1/0 0 1 2.5",
    "t crease 3/2/0 0 1 2 inf 3",
    "t crease 4/1/0 0 1 4294967295 2 nan",
    "t corner 2/1/0 0 7 10",
    "t hole 1/0/0 0",
    "t hole 0/0/0",
    "t interpolateboundary 1/0/0 2",
    "t facevaryinginterpolateboundary 1/0/0 9",
    "t creasemethod 0/0/1 chaikin",
    "t smoothtriangles 0/0/1 smooth",
    "t vertexedit 1/3/2 0 1 1 1 add P",
    "t crease 99999999999999999999/1/0",
    "t x 0/0/1 \u{e9}",
    "t",
    "v 0 0 0 1 0 0.5",
    "\u{feff}v 1 2 3",
    "curv 0 1 \\",
    "f",
    "v",
    "vv 1 2 3",
];

/// Lines of vertices and faces, most of them good.
fn lines(random: &mut Random) -> Vec<u8> {
    let mut text = String::new();
    for _ in 0..random.below(12) {
        text += "v";
        for _ in 0..if random.one_in(8) { random.below(8) } else { 3 } {
            text += " ";
            text +=
                if random.one_in(20) { random.pick(NUMBERS) } else { random.pick(&NUMBERS[..7]) };
        }
        text += random.pick(&["\n", "\n", "\n", "\r\n", "\r", " # c\n", "\\\n"]);
    }
    for _ in 0..random.below(12) {
        if random.one_in(6) {
            text += random.pick(OTHERS);
        } else {
            text += "f";
            for _ in 0..if random.one_in(6) { random.below(9) } else { 3 + random.below(2) } {
                text += " ";
                text += &corner(random);
            }
        }
        text += random.pick(&["\n", "\n", "\n", "\r\n", "\r", " # c\n", "\\\n"]);
    }
    text.into_bytes()
}

fn corner(random: &mut Random) -> String {
    let mut index =
        || if random.one_in(25) { random.pick(INDICES) } else { random.pick(&INDICES[2..9]) };
    let (v, vt, vn) = (index(), index(), index());
    match random.below(12) {
        0 => format!("{v}/{vt}"),
        1 => format!("{v}//{vn}"),
        2 => format!("{v}/{vt}/{vn}"),
        _ => v.to_owned(),
    }
}

/// Small meshes of ours, good as they are.
fn good_texts() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/meshes/obstacle");
    let names = ["flat_n3", "monkey_n5", "frame_tet_tight_n6", "polycube_corner_m1"];
    let mut texts: Vec<Vec<u8>> = names
        .iter()
        .map(|name| std::fs::read(folder.join(name).with_extension("obj")).unwrap())
        .collect();
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvt 0 0\nvn 0 0 1\n\
        f 1/1/1 4/1/1 3 2\nf -4//1 -3 -2 -1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 \\\n8 7\nf 4 1 5 8\n";
    texts.extend([cube.into(), cube.replace('\n', "\r\n").into()]);
    texts
}

fn case(seed: u64, good: &[Vec<u8>]) -> Vec<u8> {
    let random = &mut Random(seed);
    match random.below(8) {
        0 => noise(random),
        1 => rubble(random),
        2..=4 => lines(random),
        _ => {
            let text = &good[random.below(good.len())];
            mutated(text, b"0123456789- \n\\#/vf.", random)
        }
    }
}

/// Reads and checks `bytes`; whether they are a cage.
fn hold_to_the_contract(bytes: &[u8]) -> bool {
    match Format::Obj.read_cage(bytes) {
        Ok((cage, notices)) => {
            assert!(notices.iter().all(|notice| !notice.to_string().is_empty()));
            let mesh = Mesh {
                positions: cage.positions().to_vec(),
                faces: cage.topology().faces().clone(),
                tags: cage.tags().clone(),
                primvars: cage.primvars().to_vec(),
            };
            let mut text = Vec::new();
            obj::write(&mesh, &mut text).unwrap();
            assert_eq!(obj::read(&text).unwrap().mesh, mesh);
            true
        }
        Err(error) => {
            let message = error.to_string();
            fuzz::assert_readable(&message);
            if let LoadError::Obj(error) = error {
                let ends = bytes.iter().filter(|b| matches!(b, b'\n' | b'\r')).count() as u32;
                assert!(error.faults.iter().all(|f| (1..=ends + 1).contains(&f.line)));
                assert!(error.faults.is_sorted_by(|a, b| a.line < b.line));
            }
            false
        }
    }
}

/// Runs the cases with seeds 0 to `count - 1`; how many were cages.
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
#[ignore = "takes a quarter of a minute in release"]
fn a_million_cases() {
    let start = std::time::Instant::now();
    let cages = run(1_000_000);
    println!("{cages} of 1000000 cases were cages; {:?}", start.elapsed());
}

/// Texts of a megabyte that would take hours if anything were quadratic in them.
#[test]
fn monotony_is_read_in_linear_time() {
    const N: usize = 300_000;
    let points = |n: usize| "v 0 0 0\n".repeat(n);
    let each = |text: &dyn Fn(usize) -> String| (1..=N).map(text).collect::<String>();
    let start = std::time::Instant::now();
    for (text, is_cage) in [
        // One line, one word, one comment, one continuation after the other.
        ("f 1 ".repeat(N), false),
        ("v".repeat(N), false),
        ("\\".repeat(N), false),
        ("\\ ".repeat(N), false),
        ("\\\n".repeat(N), false),
        ("\\".to_owned() + &" ".repeat(N), false),
        ("#".repeat(N), false),
        ("v 1".to_owned() + &"0".repeat(N) + " 0 0", false),
        ("v 0.".to_owned() + &"1".repeat(N) + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", true),
        // Faults and strange tags without end.
        ("v x\n".repeat(N), false),
        ("f 9 9 9\n".repeat(N), false),
        (each(&|k| format!("t{k}\n")), false),
        // One face with all corners; the same face again and again; faces before vertices.
        (points(N) + "f" + &each(&|k| format!(" {k}")), true),
        (points(N) + "f" + &" 1".repeat(N), false),
        (points(3) + &"f 1 2 3\n".repeat(N), false),
        ("f 1 2 3\n".to_owned() + &points(N), true),
        // All faces at one vertex, in one fan and in many; all faces at one edge.
        (points(N + 2) + &each(&|k| format!("f 1 {} {}\n", k + 1, k + 2)), true),
        (points(2 * N + 1) + &each(&|k| format!("f 1 {} {}\n", 2 * k, 2 * k + 1)), false),
        (points(N + 2) + &each(&|k| format!("f 1 2 {}\n", k + 2)), false),
        // All neighbours of opposite orientation.
        (points(N + 2) + &each(&|k| format!("f {k} {} {}\n", k + 1, k + 2)), false),
    ] {
        assert_eq!(hold_to_the_contract(text.as_bytes()), is_cage, "{text:.60}");
    }
    println!("odd megabytes: {:?}", start.elapsed());
}
