//! Guided subdivision: rings against `data/golden/guided`, computed by an independent program.

mod golden;

use evenlight::rings::Rings;
use evenlight::{RuleSet, SchemeKind};

/// Prototype data are good to about 1e-13.
const TOLERANCE: f64 = 1e-12;

/// Rings 0 and 1 of sector 1: the guide's table, chi, the border and the sampling in one.
#[test]
fn rings_of_a_cnet_are_the_prototypes() {
    for n in [3, 5, 6, 7, 8, 9, 10] {
        let golden = golden::guided(n);
        let cnet = golden::cnet(&golden, n);
        for (kind, name) in [(SchemeKind::Guided5, "bi5"), (SchemeKind::Guided6, "bi6")] {
            let rings = Rings::from_cnet(&cnet, kind, RuleSet::Generated).unwrap();
            for ring in [0, 1] {
                // The squares A, B, C of the files are 1, 0, 2 here.
                for (square, which) in [1, 0, 2].into_iter().enumerate() {
                    let patch = rings.patch(ring, 1, which).unwrap();
                    let order = patch.degree()[0] + 1;
                    for (k, p) in patch.coefs().iter().enumerate() {
                        let expected =
                            &golden[format!("ring{ring}_{name}")][square][k / order][k % order];
                        for (a, b) in p.iter().zip(golden::point(expected)) {
                            assert!((a - b).abs() < TOLERANCE, "n = {n} {name}: {a} {b}");
                        }
                    }
                }
            }
        }
    }
}

/// Bi-4 and bi-3 rings have the jets of the bi-5 ring at the corners of its patches, but for the
/// middles of the outer edges, where they have those of the splines along the edges.
#[test]
fn splines_keep_the_corners_of_bi_5_rings() {
    for n in [3, 5, 6, 7, 8, 9, 10] {
        let cnet = golden::cnet(&golden::guided(n), n);
        let rings = |kind| Rings::from_cnet(&cnet, kind, RuleSet::Generated).unwrap();
        let quintic = rings(SchemeKind::Guided5);
        for (kind, split) in [(SchemeKind::Guided4, 2), (SchemeKind::Guided3, 3)] {
            let rings = rings(kind);
            for (ring, square) in (0..4).flat_map(|ring| (0..3).map(move |square| (ring, square))) {
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    if matches!((square, i, j), (0, 0, 1) | (0, 1, 0) | (1 | 2, 1, 1)) {
                        continue;
                    }
                    let which = square * split * split + (split - 1) * (i * split + j);
                    let [a, b] = [i as f64, j as f64];
                    let found = rings.patch(ring, 0, which).unwrap().jet(a, b);
                    let exact = quintic.patch(ring, 0, square).unwrap().jet(a, b);
                    let h = split as f64;
                    for k in 0..3 {
                        assert!((found.p[k] - exact.p[k]).abs() < TOLERANCE);
                        assert!((h * found.du[k] - exact.du[k]).abs() < 10.0 * TOLERANCE);
                        assert!((h * h * found.duv[k] - exact.duv[k]).abs() < 100.0 * TOLERANCE);
                        assert!((h * h * found.dvv[k] - exact.dvv[k]).abs() < 100.0 * TOLERANCE);
                    }
                }
            }
        }
    }
}

/// The range of H over ring l: with bi-6 rings it shrinks like lambda^l, so that curvature is
/// continuous; with the others it stays bounded.
#[test]
fn curvature_is_continuous_with_bi_6_rings_and_bounded_with_the_others() {
    for n in [3, 5, 6, 7, 8, 9, 10] {
        let cnet = golden::cnet(&golden::guided(n), n);
        for kind in
            [SchemeKind::Guided3, SchemeKind::Guided4, SchemeKind::Guided5, SchemeKind::Guided6]
        {
            let rings = Rings::from_cnet(&cnet, kind, RuleSet::Generated).unwrap();
            let (_, center) = rings.center_curvature().unwrap();
            let spread = |ring: i32| {
                let h = 0.5_f64.powi(ring);
                let grid =
                    (0..n).flat_map(|s| (0..=8).flat_map(move |i| (0..=8).map(move |j| (s, i, j))));
                grid.filter(|&(_, i, j)| i.max(j) > 4)
                    .map(|(s, i, j)| {
                        rings.eval(s, f64::from(i) * h / 8.0, f64::from(j) * h / 8.0).unwrap().mean
                    })
                    .fold(0.0_f64, |most, mean| most.max((mean - center).abs()))
            };
            let name = format!("{} n = {n}: {} {}", kind.name(), spread(20), spread(21));
            if kind == SchemeKind::Guided6 {
                let factor = spread(21) / spread(20);
                assert!((factor / rings.lambda() - 1.0).abs() < 0.01, "{name}");
                assert!(spread(200) < 1e-9 * (1.0 + center.abs()), "{name}");
            } else {
                assert!((spread(60) / spread(80) - 1.0).abs() < 1e-3, "{name}");
                assert!(spread(60) > 1e-9, "{name}");
            }
        }
    }
}
