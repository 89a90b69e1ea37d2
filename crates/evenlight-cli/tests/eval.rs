//! `evenlight eval`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use common::{
    CONE, CUBE, PILLOW, SCHEMES, TETRAHEDRON, arg, cage, code, file, run_on, stderr, stdout,
};

const ANSWER: &str = "x,y,z,xu,yu,zu,xv,yv,zv,xuu,yuu,zuu,xuv,yuv,zuv,xvv,yvv,zvv,nx,ny,nz,K,H";

fn eval(points: &str) -> String {
    let pillow = cage(PILLOW);
    stdout(&run_on(points, &["eval", arg(&pillow), "--points", "-", "--scheme", "cc"]))
}

fn error(points: &str, cage: &str) -> String {
    let (_folder, path) = file("cage.obj", cage);
    let output = run_on(points, &["eval", arg(&path), "--points", "-"]);
    assert_eq!((code(&output), output.stdout.len()), (1, 0));
    stderr(&output)
}

/// The answers of a row, without the `skip` columns of the input.
fn numbers(row: &str, skip: usize) -> Vec<f64> {
    row.split(',').skip(skip).map(|x| x.parse().unwrap()).collect()
}

#[test]
fn the_header_names_the_input_and_all_answers() {
    assert_eq!(eval("").lines().next().unwrap(), format!("face,u,v,{ANSWER}"));
    let with_corner = eval("face,u,v,corner\n3,0.5,0.5,\n");
    assert!(with_corner.starts_with(&format!("face,u,v,corner,{ANSWER}\n3,0.5,0.5,,")));
}

#[test]
fn answers_follow_the_input_columns_with_17_digits() {
    let text = eval("3,0.50,.25\n");
    let row = text.lines().nth(1).unwrap();
    assert!(row.starts_with("3,0.50,.25,"));
    let answers: Vec<&str> = row.split(',').skip(3).collect();
    assert_eq!(answers.len(), ANSWER.split(',').count());
    for x in answers {
        let digits = x.split('e').next().unwrap().chars().filter(char::is_ascii_digit).count();
        assert_eq!(digits, 17, "{x}");
    }
}

#[test]
fn the_columns_are_what_their_names_say() {
    // Central differences of step h have errors of order h^2 and, from rounding, 1e-16 / h^2.
    let h = 1e-4;
    let rows: Vec<String> = [-h, 0.0, h]
        .iter()
        .flat_map(|a| [-h, 0.0, h].map(|b| format!("40,{},{}", 0.4 + a, 0.6 + b)))
        .collect();
    let text = eval(&rows.join("\n"));
    let p: Vec<Vec<f64>> = text.lines().skip(1).map(|row| numbers(row, 3)).collect();
    let at = |i: usize, j: usize, k: usize| p[3 * i + j][k];
    for k in 0..3 {
        let close = |column: usize, difference: f64, tolerance: f64| {
            assert!((at(1, 1, 3 * column + k) - difference).abs() < tolerance, "column {column}");
        };
        close(1, (at(2, 1, k) - at(0, 1, k)) / (2.0 * h), 1e-7);
        close(2, (at(1, 2, k) - at(1, 0, k)) / (2.0 * h), 1e-7);
        close(3, (at(2, 1, k) - 2.0 * at(1, 1, k) + at(0, 1, k)) / (h * h), 1e-6);
        let mixed = at(2, 2, k) - at(2, 0, k) - at(0, 2, k) + at(0, 0, k);
        close(4, mixed / (4.0 * h * h), 1e-6);
        close(5, (at(1, 2, k) - 2.0 * at(1, 1, k) + at(1, 0, k)) / (h * h), 1e-6);
    }
    let normal = &p[4][18..21];
    assert!((normal.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-14);
    assert!((0..3).map(|k| normal[k] * p[4][3 + k]).sum::<f64>().abs() < 1e-14);
}

/// The answer at the first corner of a cube.
fn corner_of_cube(scheme: &str) -> String {
    let (_folder, path) = file("cage.obj", CUBE);
    let args = ["eval", arg(&path), "--points", "-", "--scheme", scheme];
    stdout(&run_on("0,0,0\n", &args)).lines().nth(1).unwrap().to_owned()
}

#[test]
fn corners_of_a_cube_lie_on_its_diagonals() {
    for scheme in SCHEMES {
        let row = numbers(&corner_of_cube(scheme), 3);
        assert!((row[0] - row[1]).abs() < 1e-14 && (row[0] - row[2]).abs() < 1e-14);
        // The limit normal is exact there; derivatives do not exist.
        assert!(row[0] < 0.0 && (row[18] + 1.0 / 3.0_f64.sqrt()).abs() < 1e-12);
        assert!(row[3..18].iter().all(|x| x.is_nan()));
    }
}

#[test]
fn curvature_at_an_extraordinary_vertex_is_that_of_its_quadratic_or_nan() {
    for scheme in SCHEMES {
        let text = corner_of_cube(scheme);
        let row = numbers(&text, 3);
        let [gauss, mean] = [row[21], row[22]];
        if scheme.starts_with("qas") {
            // Convex, and by symmetry the same in all directions.
            assert!(mean < 0.0 && (gauss / (mean * mean) - 1.0).abs() < 1e-12, "{scheme}");
        } else {
            assert!(gauss.is_nan() && mean.is_nan(), "{scheme}");
        }
        let words: Vec<&str> = text.split(',').filter(|x| x.contains(['n', 'N'])).collect();
        assert!(words.iter().all(|word| *word == "nan"), "{words:?}");
        assert_eq!(words.len(), if scheme.starts_with("qas") { 15 } else { 17 });
    }
}

#[test]
fn headers_comments_and_blank_lines_are_skipped() {
    let plain = eval("0,0.5,0.5\n1,0.25,1\n");
    let decorated = eval("\u{feff}# points\nFace, u, v\r\n0,0.5,0.5\r\n\r\n  # more\n1,0.25,1");
    assert_eq!(plain, decorated);
}

#[test]
fn faces_that_are_no_quads_are_asked_by_corner() {
    let (_folder, path) = file("cage.obj", TETRAHEDRON);
    // The centre of a face is the corner (1,1) of all its quads.
    let text =
        stdout(&run_on("0,1,1,0\n0,1,1,1\n0,1,1,2\n", &["eval", arg(&path), "--points", "-"]));
    let rows: Vec<Vec<f64>> = text.lines().skip(1).map(|row| numbers(row, 4)).collect();
    for row in &rows {
        assert!((0..3).all(|k| (row[k] - rows[0][k]).abs() < 1e-15));
    }
    assert!(error("0,1,1\n", TETRAHEDRON).contains("face 0 has 3 corners: say in a fourth column"));
    assert!(error("0,1,1,3\n", TETRAHEDRON).contains("face 0 has no corner 3, only 0 to 2"));
    assert!(error("0,1,1,1\n", CUBE).contains("face 0 is a quad"));
}

#[test]
fn faults_name_file_and_line() {
    for (points, message) in [
        ("0,0.5,0.5\n\n6,0,0\n", "stdin:3: there is no face 6: the cage has the faces 0 to 5"),
        ("0,1.5,0\n", "stdin:1: u = 1.5 is outside [0, 1]"),
        ("0,0,-1e-9\n", "stdin:1: v = -1e-9 is outside [0, 1]"),
        ("0,nan,0\n", "stdin:1: u = nan is outside [0, 1]"),
        ("face,u,v\n0,half,0\n", "stdin:2: u 'half' is not a number"),
        ("-1,0,0\n", "stdin:1: face '-1' is not a number counted from 0"),
        ("face,v,u\n0,0,0\n", "stdin:1: the columns must be face,u,v or face,u,v,corner, in this"),
        ("0,0\n", "stdin:1: a row is face,u,v or face,u,v,corner"),
        ("face;u;v\n", "stdin:1: a row is face,u,v or face,u,v,corner"),
    ] {
        let text = error(points, CUBE);
        assert!(text.starts_with(&format!("error: {message}")), "{text}");
    }
}

#[test]
fn faces_that_are_left_out_are_said_to_be() {
    let cone = cage(CONE);
    let points: String = (0..45).map(|face| format!("{face},0.5,0.5\n")).collect();
    let output = run_on(&points, &["eval", arg(&cone), "--points", "-", "--boundary", "none"]);
    assert_eq!((code(&output), output.stdout.len()), (1, 0));
    assert!(stderr(&output).contains("is left out (holes, or at the boundary"));
}

/// Over a single quad with sharp corners texture coordinates are bilinear.
#[test]
fn primvars_are_columns_behind_the_others() {
    let quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 2 1\nvt 0 1\n\
                t facevaryinginterpolateboundary 1/0/0 4\nf 1/1 2/2 3/3 4/4\n";
    let (_folder, path) = file("cage.obj", quad);
    let run = |more: &[&str]| {
        let fixed = ["eval", arg(&path), "--points", "-", "--scheme", "cc"];
        stdout(&run_on("0,0.25,0.5\n", &[&fixed[..], more].concat()))
    };
    let (plain, text) = (run(&[]), run(&["--primvars"]));
    let header = text.lines().next().unwrap();
    assert_eq!(header, format!("face,u,v,{ANSWER},st.0,st.1,st.0u,st.1u,st.0v,st.1v"));
    let row = text.lines().nth(1).unwrap();
    assert!(row.starts_with(plain.lines().nth(1).unwrap()));
    let found = numbers(row, 3 + ANSWER.split(',').count());
    for (found, expected) in found.iter().zip([0.5, 0.5, 2.0, 0.0, 0.0, 1.0]) {
        assert!((found - expected).abs() < 1e-14, "{row}");
    }
    assert_eq!(found.len(), 6);
}
