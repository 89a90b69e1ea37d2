//! Evaluation from arrays into arrays says what evaluation says.
#![allow(clippy::unwrap_used, reason = "a test that cannot make its cages fails")]

mod common;

use std::ops::ControlFlow;

use common::{Random, cage, options};
use evenlight::mesh::BoundaryRule;
use evenlight::patch::{Answer, Jet};
use evenlight::surface::{ArrayError, row_width};
use evenlight::task::Task;
use evenlight::tessellate::{TriangleArrays, tessellate, tessellate_into};
use evenlight::{QuadId, SchemeKind, Surface, SurfaceOptions};

fn places(surface: &Surface, count: usize) -> (Vec<u32>, Vec<[f64; 2]>) {
    let mut random = Random::new(11);
    let quads = (0..count).map(|_| random.below(surface.num_quads()) as u32).collect();
    let mut random = Random::new(12);
    // Some are outside, and clamped.
    let uv = (0..count).map(|_| [1.1 * random.unit() - 0.05, random.unit()]).collect();
    (quads, uv)
}

#[test]
fn rows_have_the_bits_of_single_answers() {
    let boundary = Some(BoundaryRule::None);
    for (name, options) in [
        ("own_polygons.obj", SurfaceOptions::default()),
        ("features/star5_crease.obj", options(SchemeKind::Guided5)),
        ("obstacle/cone_flat_n5.obj", SurfaceOptions { boundary, ..SurfaceOptions::default() }),
    ] {
        let surface = Surface::build(cage(name), options).unwrap();
        let (quads, mut uv) = places(&surface, 5000);
        uv[17][1] = f64::NAN;
        for order in 0..=2 {
            let width = row_width::<3>(order).unwrap();
            let mut rows = vec![0.0_f64; width * quads.len()];
            let mut single = vec![0.0_f32; rows.len()];
            let run = |threads| Task::new().threads(threads);
            run(2).run(|| surface.eval_arrays(&quads, &uv, order, &mut rows)).unwrap();
            run(1).run(|| surface.eval_arrays(&quads, &uv, order, &mut single)).unwrap();
            for (k, row) in rows.chunks(width).enumerate() {
                let [u, v] = uv[k];
                let jet: Option<Jet> = surface.eval_second(QuadId(quads[k]), u, v);
                let rows = jet.unwrap_or(<Jet as Answer>::NAN).rows();
                for (x, y) in row.iter().zip(rows.as_flattened()) {
                    assert!(x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan(), "{name} {k}");
                }
            }
            assert!(rows[17 * width..][..width].iter().all(|x| x.is_nan()));
            let same = |(&x, &y): (&f64, &f32)| x as f32 == y || x.is_nan() && y.is_nan();
            assert!(rows.iter().zip(&single).all(same), "{name}: rounded once");
        }
    }
}

#[test]
fn faces_and_corners_are_quads() {
    let surface = Surface::build(cage("own_polygons.obj"), SurfaceOptions::default()).unwrap();
    let (quads, uv) = places(&surface, 300);
    let of_quad = |&quad: &u32| surface.face_of(QuadId(quad)).unwrap();
    let faces: Vec<u32> = quads.iter().map(|quad| of_quad(quad).0.0).collect();
    let corners: Vec<u32> = quads.iter().map(|quad| of_quad(quad).1 as u32).collect();
    let (mut a, mut b) = (vec![0.0; 9 * 300], vec![0.0; 9 * 300]);
    surface.eval_arrays(&quads, &uv, 1, &mut a).unwrap();
    surface.eval_faces(&faces, Some(&corners), &uv, 1, &mut b).unwrap();
    assert_eq!(a.map_bits(), b.map_bits());
    let error = surface.eval_faces(&[0, u32::MAX], None, &uv[..2], 0, &mut [0.0; 6]);
    assert_eq!(error, Err(ArrayError::NoSuchCorner { place: 1, face: u32::MAX, corner: 0 }));
    assert!(surface.eval_faces(&[0], Some(&[0, 0]), &uv[..1], 0, &mut [0.0; 3]).is_err());
}

trait Bits {
    fn map_bits(&self) -> Vec<u64>;
}

impl Bits for Vec<f64> {
    fn map_bits(&self) -> Vec<u64> {
        self.iter().map(|x| x.to_bits()).collect()
    }
}

#[test]
fn what_does_not_fit_is_refused_and_the_array_untouched() {
    let surface = Surface::build(cage("own_polygons.obj"), SurfaceOptions::default()).unwrap();
    let count = surface.num_quads();
    let mut rows = [7.0_f32; 6];
    let mut eval = |quads: &[u32], uv: &[[f64; 2]], order| {
        let result = surface.eval_arrays(quads, uv, order, &mut rows);
        assert_eq!(rows, [7.0; 6]);
        result.unwrap_err()
    };
    let uv = [[0.5; 2]; 2];
    let text = eval(&[0, count as u32], &uv, 0).to_string();
    assert!(text.contains("place 1") && text.contains(&format!("quad {count}")), "{text}");
    assert_eq!(eval(&[0, 0], &uv, 3), ArrayError::Order { order: 3 });
    assert!(matches!(eval(&[0, 0], &uv[..1], 0), ArrayError::Length { what: "uv", .. }));
    let wrong = ArrayError::Length { what: "the array of answers", expected: 18, found: 6 };
    assert_eq!(eval(&[0, 0], &uv, 1), wrong);
    let impatient = Task::new().watch(|_| ControlFlow::Break(()));
    assert_eq!(impatient.run(|| eval(&[0, 0], &uv, 0)), ArrayError::Cancelled);
}

#[test]
fn blocks_hold_all_patches() {
    let surface = common::surface(&cage("own_polygons.obj"), SchemeKind::Qas4);
    let blocks = surface.patch_blocks(3);
    assert_eq!(blocks.iter().map(|block| block.degree).collect::<Vec<_>>(), [3, 4]);
    let patches: Vec<_> = surface.patches(3).collect();
    let mut met = vec![false; patches.len()];
    for block in &blocks {
        let size = 3 * (block.degree + 1) * (block.degree + 1);
        assert_eq!(block.coefs.len(), size * block.patches.len());
        for (&number, coefs) in block.patches.iter().zip(block.coefs.chunks(size)) {
            assert_eq!(patches[number as usize].patch.coefs().as_flattened(), coefs);
            met[number as usize] = true;
        }
    }
    assert!(met.into_iter().all(|met| met));
}

#[test]
fn triangles_are_written_into_arrays_and_into_used_meshes() {
    let surface = common::surface(&cage("features/cube_creased.obj"), SchemeKind::Qas4);
    let mesh = tessellate(&surface, 3).unwrap();
    assert!(mesh.is_folded());
    let mut again =
        tessellate(&common::surface(&cage("own_polygons.obj"), SchemeKind::Qas4), 4).unwrap();
    tessellate_into(&surface, 3, &mut again).unwrap();
    assert!(again == mesh, "nothing of what was there remains");
    assert!(tessellate_into(&surface, 0, &mut again).is_err() && again == mesh);

    let (vertices, sides) = (mesh.positions.len(), mesh.normals.len());
    let (mut positions, mut normals) = (vec![0.0_f64; 3 * vertices], vec![0.0; 3 * sides]);
    let (mut curvature, count) = (vec![0.0; 2 * sides], 3 * mesh.triangles.len());
    let (mut triangles, mut corner_sides) = (vec![0; count], vec![0; count]);
    mesh.write_arrays(TriangleArrays {
        positions: Some(&mut positions),
        normals: Some(&mut normals),
        curvature: Some(&mut curvature),
        triangles: Some(&mut triangles),
        corner_sides: Some(&mut corner_sides),
    })
    .unwrap();
    assert_eq!(positions, mesh.positions.as_flattened());
    assert_eq!(normals, mesh.normals.as_flattened());
    assert!(curvature.chunks(2).zip(&mesh.gauss).all(|(row, k)| row[0].to_bits() == k.to_bits()));
    assert_eq!(triangles, mesh.triangles.as_flattened());
    assert_eq!(corner_sides, mesh.sides().as_flattened());
    let mut short = vec![0.0_f32; 3 * vertices - 1];
    let arrays = TriangleArrays { positions: Some(&mut short[..]), ..TriangleArrays::default() };
    let error = mesh.write_arrays(arrays).unwrap_err();
    assert!(matches!(error, ArrayError::Length { what: "positions", .. }), "{error}");
}
