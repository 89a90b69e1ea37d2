//! The eigenstructure of guided subdivision [KP18-Guided, Section 5]: multiplicities, eigenvectors
//! and eigenfunctions, against the conditions of curvature continuity.
#![cfg(feature = "spectrum")]
#![allow(clippy::unwrap_used, reason = "tests may panic")]

use evenlight::basis::{Eigenfunctions, HomogeneousGuide, MAX_TOTAL_DEGREE, Parity, multiplicity};
use evenlight::patch::Jet;
use evenlight::{Contraction, RuleSet, SchemeKind};
use nalgebra::DMatrix;

const VALENCES: [usize; 7] = [3, 5, 6, 7, 8, 9, 10];

const GUIDED: [SchemeKind; 4] =
    [SchemeKind::Guided3, SchemeKind::Guided4, SchemeKind::Guided5, SchemeKind::Guided6];

/// [KP18-Guided, table 5].
fn table_5(n: usize) -> [usize; 11] {
    let star = if n == 3 || n == 6 { n + 1 } else { n };
    [1, 2, 3, star, 2 * n, 3 * n, 3 * n, 3 * n, 3 * n, 2 * n, n]
}

fn catmull_clark_eigenvalue(n: usize) -> f64 {
    let c = (std::f64::consts::TAU / n as f64).cos();
    (c + 5.0 + ((c + 1.0) * (c + 9.0)).sqrt()) / 16.0
}

#[test]
fn eigenvalues_have_the_multiplicities_of_the_table() {
    for n in VALENCES.into_iter().chain(11..=32) {
        let found: Vec<usize> =
            (0..=MAX_TOTAL_DEGREE).map(|s| multiplicity(n, s).unwrap()).collect();
        assert_eq!(found, table_5(n), "n = {n}");
        let star = if n == 3 || n == 6 { n + 1 } else { n };
        assert_eq!(found.iter().sum::<usize>(), 17 * n + star + 6);
    }
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

/// The conditions [KP18-Guided, eq. 1 and 2] of all lines on BB coefficients, which are numbered
/// 36 sector + 6 i + j: 18n rows.
fn conditions(n: usize) -> DMatrix<f64> {
    let c = (std::f64::consts::TAU / n as f64).cos();
    let mut rows = DMatrix::zeros(18 * n, 36 * n);
    for (line, i) in (0..n).flat_map(|line| (0..6).map(move |i| (line, i))) {
        let ahead = |i: usize, j: usize| 36 * line + 6 * i + j;
        let behind = |i: usize, j: usize| 36 * ((line + n - 1) % n) + 6 * j + i;
        let row = 18 * line + 3 * i;
        let mut add = |k: usize, at: usize, w: f64| rows[(row + k, at)] += w;
        add(0, ahead(i, 0), 1.0);
        add(0, behind(i, 0), -1.0);
        for (j, w) in [(1, 5.0), (0, -5.0)] {
            add(1, ahead(i, j), w);
            add(1, behind(i, j), w);
        }
        for (j, w) in [(2, 20.0), (1, -40.0), (0, 20.0)] {
            add(2, behind(i, j), w);
            add(2, ahead(i, j), -w);
        }
        // A quartic, or a cubic, along the line, raised to degree 5.
        let raise = |degree: usize, q: usize| {
            let r = i.checked_sub(q).filter(|&r| r + degree <= 5)?;
            Some(binomial(degree, q) * binomial(5 - degree, r) / binomial(5, i))
        };
        for (q, w) in (0..=4).filter_map(|q| Some((q, raise(4, q)?))) {
            for (k, x) in [(q + 1, 1.0), (q, -1.0)] {
                add(1, ahead(k, 0), -10.0 * c * w * x);
                add(2, ahead(k, 1), 100.0 * c * w * x);
                add(2, ahead(k, 0), -100.0 * c * w * x);
            }
        }
        for (q, w) in (0..=3).filter_map(|q| Some((q, raise(3, q)?))) {
            for (k, x) in [(q + 2, 1.0), (q + 1, -2.0), (q, 1.0)] {
                add(2, ahead(k, 0), -80.0 * c * c * w * x);
            }
        }
    }
    rows
}

/// The homogeneous guides as columns of BB coefficients, with the degrees.
fn eigenvectors(n: usize) -> (DMatrix<f64>, Vec<usize>) {
    let guides: Vec<HomogeneousGuide> =
        (0..=MAX_TOTAL_DEGREE).flat_map(|s| HomogeneousGuide::all(n, s).unwrap()).collect();
    let bb = |guide: &HomogeneousGuide, at: usize| -> f64 {
        let (sector, p, q) = (at / 36, at % 36 / 6, at % 6);
        let terms = (0..=p).flat_map(|i| (0..=q).map(move |j| (i, j)));
        let weight = |i, p| binomial(p, i) / binomial(5, i);
        terms.map(|(i, j)| weight(i, p) * weight(j, q) * guide.coefficient(sector, i, j)).sum()
    };
    let columns = DMatrix::from_fn(36 * n, guides.len(), |at, k| bb(&guides[k], at));
    (columns, guides.iter().map(HomogeneousGuide::degree).collect())
}

/// An orthonormal basis of the kernel, by elimination with the largest pivots, and the gap: the
/// largest entry that was taken for zero and the smallest pivot.
fn kernel(matrix: &DMatrix<f64>) -> (DMatrix<f64>, [f64; 2]) {
    let (mut rows, size) = (matrix.clone(), matrix.ncols());
    let (mut pivots, mut gap) = (Vec::new(), [0.0, f64::INFINITY]);
    for step in 0..rows.nrows() {
        let rest = rows.rows(step, rows.nrows() - step);
        let (row, column) = rest.icamax_full();
        let pivot = rest[(row, column)];
        if pivot.abs() < 1e-9 {
            gap[0] = pivot.abs();
            break;
        }
        gap[1] = pivot.abs().min(gap[1]);
        rows.swap_rows(step, step + row);
        let scaled = rows.row(step) / pivot;
        for other in (0..rows.nrows()).filter(|&other| other != step) {
            let factor = rows[(other, column)];
            let reduced = rows.row(other) - factor * &scaled;
            rows.set_row(other, &reduced);
        }
        rows.set_row(step, &scaled);
        pivots.push(column);
    }
    let free: Vec<usize> = (0..size).filter(|k| !pivots.contains(k)).collect();
    let solutions = DMatrix::from_fn(size, free.len(), |at, k| {
        match pivots.iter().position(|&pivot| pivot == at) {
            Some(row) => -rows[(row, free[k])],
            None => f64::from(u8::from(at == free[k])),
        }
    });
    (solutions.qr().q(), gap)
}

/// The eigenvectors span all solutions of the conditions, and the map P_(l-1) -> P_l, de
/// Casteljau's algorithm at lambda in every piece, is in their basis the diagonal matrix of
/// lambda^s: the whole spectrum, and no Jordan blocks. At both contractions.
#[test]
fn the_subdivision_of_guides_is_diagonal() {
    for n in VALENCES {
        let (conditions, (vectors, degrees)) = (conditions(n), eigenvectors(n));
        assert!((&conditions * &vectors).amax() < 1e-11 * vectors.amax(), "n = {n}");
        let (basis, gap) = kernel(&conditions);
        assert!(gap[0] < 1e-11 && gap[1] > 0.05, "n = {n}: {gap:?}");
        assert_eq!(basis.ncols(), vectors.ncols(), "n = {n}");
        let unit = DMatrix::from_columns(
            &vectors.column_iter().map(|v| v.normalize()).collect::<Vec<_>>(),
        );
        // Independent: what each unit vector adds to those before it is far from zero.
        let gram = (unit.transpose() * &unit).cholesky().expect("the vectors are independent");
        let least = gram.l().diagonal().min();
        assert!(least > 1e-4, "n = {n}: {least:e}");
        for lambda in [catmull_clark_eigenvalue(n), 0.5] {
            let bernstein = |p: usize, i: usize| {
                if i > p {
                    0.0
                } else {
                    binomial(p, i) * lambda.powi(i as i32) * (1.0 - lambda).powi((p - i) as i32)
                }
            };
            let shrink = DMatrix::from_fn(6, 6, bernstein);
            let shrink = DMatrix::<f64>::identity(n, n).kronecker(&shrink.kronecker(&shrink));
            let shrunk = &shrink * &vectors;
            for (k, &s) in degrees.iter().enumerate() {
                let error = shrunk.column(k) - lambda.powi(s as i32) * vectors.column(k);
                assert!(error.amax() < 1e-14 * vectors.column(k).amax(), "n = {n}, {k}");
            }
            let matrix = basis.transpose() * &shrink * &basis;
            assert!((&shrink * &basis - &basis * &matrix).amax() < 1e-12, "n = {n}: invariant");
            // So the columns of C are eigenvectors of M, as many as M has columns.
            let eigenvectors = basis.transpose() * &vectors;
            let powers: Vec<f64> = degrees.iter().map(|&s| lambda.powi(s as i32)).collect();
            let diagonal = DMatrix::from_diagonal(&powers.into());
            let error = &matrix * &eigenvectors - &eigenvectors * diagonal;
            assert!(error.amax() < 1e-12 * vectors.amax(), "n = {n}: {:e}", error.amax());
        }
    }
}

/// Turning by a sector and the mirror in the diagonal of sector 0 act as modes and parities say.
#[test]
fn eigenvectors_are_modes() {
    for n in VALENCES {
        for s in 0..=MAX_TOTAL_DEGREE {
            for guide in HomogeneousGuide::all(n, s).unwrap() {
                let sign = if guide.parity() == Parity::Even { 1.0 } else { -1.0 };
                let turn = (std::f64::consts::TAU * guide.mode() as f64 / n as f64).cos();
                let at = |sector: usize, i: usize| guide.coefficient(sector % n, i, s - i);
                for sector in 0..n {
                    for i in s.saturating_sub(5)..=s.min(5) {
                        let mirrored = guide.coefficient((n - sector) % n, s - i, i);
                        assert!((at(sector, i) - sign * mirrored).abs() < 1e-14);
                        let three = at(sector, i) + at(sector + 2, i);
                        assert!((three - 2.0 * turn * at(sector + 1, i)).abs() < 1e-13);
                    }
                }
            }
        }
    }
}

/// The jet of sector s at a line, in the parameters of sector s + 1: a = -b', b = a'.
fn beyond_line(jet: Jet<1>) -> Jet<1> {
    let minus = |[x]: [f64; 1]| [-x];
    Jet { du: jet.dv, dv: minus(jet.du), duu: jet.dvv, duv: minus(jet.duv), dvv: jet.duu, ..jet }
}

fn assert_c2(before: Jet<1>, after: Jet<1>, scale: f64, what: &str) {
    for (a, b) in before.rows().as_flattened().iter().zip(after.rows().as_flattened()) {
        assert!((a - b).abs() < 1e-11 * scale, "{what}: {before:?} {after:?}");
    }
}

/// The eigenfunctions of a scheme at both contractions, if rules can be derived.
fn eigenfunctions(kind: SchemeKind, n: usize) -> Vec<Eigenfunctions> {
    let contractions = [Contraction::CatmullClark, Contraction::Half];
    let known = contractions.into_iter().filter(|&c| kind.check_contraction(c).is_ok());
    known.map(|c| Eigenfunctions::with_contraction(kind, c, n).unwrap()).collect()
}

/// The jet at (a,b) of ring 0, or of ring 1, on the side to which (da,db) points.
fn jet_beside(
    f: &Eigenfunctions,
    (k, ring, sector): (usize, usize, usize),
    [a, b]: [f64; 2],
    [da, db]: [f64; 2],
) -> Jet<1> {
    let size = f.sigma().powi(ring as i32);
    let [x, y] = [(a + 1e-9 * da) / size, (b + 1e-9 * db) / size];
    let has = |[[a0, a1], [b0, b1]]: [[f64; 2]; 2]| a0 <= x && x <= a1 && b0 <= y && y <= b1;
    let which = (0..f.patches_per_sector()).find(|&which| has(f.patch_domain(which).unwrap()));
    f.eval_on(k, ring, sector, which.unwrap(), [a, b]).unwrap()
}

#[test]
fn eigenfunctions_are_c2_and_scale() {
    let cases = GUIDED.into_iter().flat_map(|kind| [3, 5, 6, 8].map(|n| (kind, n)));
    for (kind, f) in
        cases.flat_map(|(kind, n)| eigenfunctions(kind, n).into_iter().map(move |f| (kind, f)))
    {
        let (n, sigma) = (f.valence(), f.sigma());
        for k in 0..f.len() {
            let what = format!("{} n = {n} sigma = {sigma}, function {k}", kind.name());
            let corner = f.eval(k, 0, 1.0, 1.0).unwrap().rows();
            let scale = corner.iter().fold(1.0, |m: f64, [x]| m.max(x.abs()));
            for (sector, t) in [(0, 0.13), (1, 0.77), (n - 1, 0.5)] {
                let (b, a) = (sigma * t, sigma + (1.0 - sigma) * t);
                let beside = |ring, place, toward| jet_beside(&f, (k, ring, sector), place, toward);
                // Between rings 0 and 1.
                let (outer, inner) = ([sigma, b], [b, sigma]);
                assert_c2(
                    beside(0, outer, [1.0, 0.0]),
                    beside(1, outer, [-1.0, 0.0]),
                    scale,
                    &what,
                );
                assert_c2(
                    beside(0, inner, [0.0, 1.0]),
                    beside(1, inner, [0.0, -1.0]),
                    scale,
                    &what,
                );
                // Across a line.
                let behind = f.eval(k, sector, 0.0, a).unwrap();
                let ahead = f.eval(k, (sector + 1) % n, a, 0.0).unwrap();
                assert_c2(beyond_line(behind), ahead, scale, &what);
                // Across the borders within the ring.
                let inside = [a, sigma];
                assert_c2(
                    beside(0, inside, [0.0, -1.0]),
                    beside(0, inside, [0.0, 1.0]),
                    scale,
                    &what,
                );
                // Scaling, at points inside patches and on their borders.
                let (lambda, h) = (f.eigenvalue(k).unwrap(), sigma * sigma * sigma);
                let [outer, inner] = [1.0, h].map(|h| f.eval(k, sector, h * a, h * b).unwrap());
                let expected = outer.scaled(lambda * lambda * lambda, [1.0 / h; 2]);
                assert_c2(expected, inner, 8.0 * scale / (h * h), &what);
            }
        }
    }
}

/// Functions 0, 1 and 2 are the constant and the characteristic map, function 1 along the diagonal
/// of sector 0; the two together turn with the sectors.
#[test]
fn the_first_functions_are_the_constant_and_the_plane() {
    for (kind, n) in GUIDED.into_iter().flat_map(|kind| VALENCES.map(|n| (kind, n))) {
        let f = Eigenfunctions::new(kind, n).unwrap();
        assert_eq!([0, 1, 2].map(|s| f.of_degree(s)), [0..1, 1..3, 3..6]);
        let half = std::f64::consts::PI / n as f64;
        for (sector, a, b) in [(0, 0.3, 0.9), (2, 0.75, 0.75), (n - 1, 1.0, 0.0)] {
            let constant = f.eval(0, sector, a, b).unwrap();
            assert!((constant.p[0] - 1.0).abs() < 1e-14 && constant.duu[0].abs() < 1e-11);
            let at = |k: usize, sector: usize| f.eval(k, sector % n, a, b).unwrap().p[0];
            let (x, y) = (at(1, sector), at(2, sector));
            let (sin, cos) = (2.0 * half).sin_cos();
            assert!((at(1, sector + 1) - (cos * x - sin * y)).abs() < 1e-13);
            assert!((at(2, sector + 1) - (sin * x + cos * y)).abs() < 1e-13);
        }
        // On line -1 at angle -half from the diagonal, both coordinates by the same unit.
        let [x, y] = [1, 2].map(|k| f.eval(k, 0, 1.0, 0.0).unwrap().p[0]);
        assert!((y / x + half.tan()).abs() < 1e-13, "n = {n}: {x} {y}");
    }
}

/// Bi-6 rings reproduce the quadratics of the characteristic map: products of functions 1 and 2 are
/// sums of functions 3 to 5. That makes curvature continuous.
#[test]
fn bi_6_eigenfunctions_of_degree_2_are_the_quadratics_of_the_plane() {
    for n in VALENCES {
        let f = Eigenfunctions::new(SchemeKind::Guided6, n).unwrap();
        let points: Vec<(usize, f64, f64)> = (0..n)
            .flat_map(|s| (0..=6).flat_map(move |i| (0..=6).map(move |j| (s, i, j))))
            .filter(|&(_, i, j)| i.max(j) > 3)
            .map(|(s, i, j)| (s, f64::from(i) / 6.0, f64::from(j) / 6.0))
            .collect();
        let value = |k: usize, &(s, a, b): &(usize, f64, f64)| f.eval(k, s, a, b).unwrap().p[0];
        let quadratics = DMatrix::from_fn(points.len(), 3, |row, k| value(3 + k, &points[row]));
        for [p, q] in [[1, 1], [1, 2], [2, 2]] {
            let product = DMatrix::from_fn(points.len(), 1, |row, _| {
                value(p, &points[row]) * value(q, &points[row])
            });
            let solved = quadratics.clone().svd(true, true).solve(&product, 1e-9).unwrap();
            let error = (&quadratics * solved - &product).amax();
            assert!(error < 1e-13 * product.amax().max(1.0), "n = {n}: {error:e}");
        }
    }
}

#[test]
fn other_schemes_have_no_eigenfunctions_of_guides() {
    for kind in SchemeKind::ALL {
        let n = 5;
        assert_eq!(Eigenfunctions::new(kind, n).is_some(), GUIDED.contains(&kind));
        assert!(Eigenfunctions::new(kind, 4).is_none() && Eigenfunctions::new(kind, 0).is_none());
        assert!(kind.has_rules(RuleSet::Generated, n));
    }
}
