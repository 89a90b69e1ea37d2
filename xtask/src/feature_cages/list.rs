//! The cages, each with the rules that it is for.

use super::build::{Cage, at};

const INFINITE: f64 = 10.0;

/// All cages with their names.
pub fn all() -> Vec<(&'static str, Cage)> {
    [creases(), vertices(), stars(), boundaries(), polygons(), textures(), dependent_textures()]
        .concat()
}

fn creases() -> Vec<(&'static str, Cage)> {
    let row = |n: usize, i: usize| -> Vec<usize> { (0..=n).map(|j| at(n, i, j)).collect() };
    vec![
        (
            "crease_infinite",
            Cage::sheet(4, 3)
                .about("an infinitely sharp crease from boundary to boundary")
                .crease(&row(3, 2), INFINITE),
        ),
        (
            "crease_fractional",
            Cage::sheet(4, 4)
                .about("creases of sharpness .5, 1.3 and 2.7 side by side")
                .crease(&row(4, 1), 0.5)
                .crease(&row(4, 2), 1.3)
                .crease(&row(4, 3), 2.7),
        ),
        (
            "crease_graded",
            Cage::sheet(3, 5)
                .about("a crease whose sharpness changes from edge to edge, up to 5")
                .graded_crease(&row(5, 1), &[0.5, 2.75, 5.0, 1.25, INFINITE])
                .crease(&row(5, 2), 3.0),
        ),
        (
            "crease_chaikin",
            Cage::sheet(3, 5)
                .about("a crease of changing sharpness by Chaikin's rule, with ends and a branch")
                .chaikin()
                .graded_crease(&row(5, 1), &[0.5, 2.75, 5.0, 1.25, 3.0])
                .graded_crease(&row(5, 2)[1..4], &[3.5, 1.5])
                .crease(&[at(5, 1, 3), at(5, 2, 3)], 2.25),
        ),
        (
            "crease_dart",
            Cage::sheet(4, 4)
                .about("creases that end inside: infinitely sharp and 2.7")
                .crease(&row(4, 1)[..3], INFINITE)
                .crease(&row(4, 3)[2..], 2.7),
        ),
        (
            "crease_turning",
            Cage::sheet(4, 4)
                .about("an infinitely sharp crease that turns at regular vertices")
                .crease(&[at(4, 0, 1), at(4, 1, 1), at(4, 1, 2), at(4, 2, 2)], INFINITE)
                .crease(&[at(4, 2, 2), at(4, 3, 2), at(4, 3, 3), at(4, 3, 4)], INFINITE),
        ),
        (
            "crease_junction",
            Cage::sheet(4, 4)
                .about("three infinitely sharp creases meet, three of sharpness 1.5, and four")
                .crease(&[at(4, 0, 1), at(4, 1, 1), at(4, 2, 1)], INFINITE)
                .crease(&[at(4, 1, 0), at(4, 1, 1)], INFINITE)
                .crease(&[at(4, 2, 1), at(4, 3, 1), at(4, 4, 1)], 1.5)
                .crease(&[at(4, 3, 0), at(4, 3, 1)], 1.5)
                .crease(&row(4, 2)[2..], INFINITE)
                .crease(&[at(4, 1, 3), at(4, 2, 3), at(4, 3, 3)], INFINITE),
        ),
    ]
}

fn vertices() -> Vec<(&'static str, Cage)> {
    vec![
        (
            "corner_sharp",
            Cage::sheet(4, 4)
                .about("vertices of sharpness .5, 2.7 and infinity, inside and at the boundary")
                .corner(at(4, 1, 1), INFINITE)
                .corner(at(4, 3, 1), 0.5)
                .corner(at(4, 2, 3), 2.7)
                .corner(at(4, 0, 3), INFINITE)
                .corner(at(4, 4, 2), 1.5)
                .corner(at(4, 2, 0), 4.0),
        ),
        (
            "corner_creased",
            Cage::sheet(4, 3)
                .about("sharp vertices on creases: semi-sharp and infinite on both")
                .crease(&[at(3, 1, 0), at(3, 1, 1), at(3, 1, 2), at(3, 1, 3)], INFINITE)
                .crease(&[at(3, 3, 0), at(3, 3, 1), at(3, 3, 2), at(3, 3, 3)], 2.5)
                .corner(at(3, 1, 1), 1.25)
                .corner(at(3, 1, 2), INFINITE)
                .corner(at(3, 3, 1), 3.75)
                .corner(at(3, 3, 2), INFINITE),
        ),
        (
            "holes",
            Cage::sheet(4, 4).about("holes inside and at the boundary").holes(&[5, 6, 3, 12]),
        ),
        (
            "cube_creased",
            cube()
                .about("a cube: all edges of sharpness 1.5, those of one face infinitely sharp")
                .crease(&[0, 1, 2, 3, 0], 1.5)
                .crease(&[4, 5, 6, 7, 4], INFINITE)
                .crease(&[0, 4], 1.5)
                .crease(&[1, 5], 1.5)
                .crease(&[2, 6], 1.5)
                .crease(&[3, 7], 1.5),
        ),
        ("valence_two", two_quads().about("a closed cage with vertices of valence 2 and 4")),
    ]
}

fn cube() -> Cage {
    let corner = |k: usize| [[0., 0.], [2., 0.], [2., 2.], [0., 2.]][k % 4];
    let positions: Vec<_> =
        (0..8).map(|k| [corner(k)[0], corner(k)[1], (k / 4) as f64 * 2.0]).collect();
    let faces: [&[usize]; 6] =
        [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
    Cage::solid(&positions, &faces)
}

/// A cube with one face cut into two quads that meet in two edges, with a vertex of valence 2.
fn two_quads() -> Cage {
    let corner = |k: usize| [[0., 0.], [2., 0.], [2., 2.], [0., 2.]][k % 4];
    let mut positions: Vec<_> =
        (0..8).map(|k| [corner(k)[0], corner(k)[1], (k / 4) as f64 * 2.0]).collect();
    positions.push([1.0, 1.0, 2.6]);
    let faces: [&[usize]; 7] = [
        &[0, 3, 2, 1],
        &[0, 1, 5, 4],
        &[1, 2, 6, 5],
        &[2, 3, 7, 6],
        &[3, 0, 4, 7],
        &[4, 5, 6, 8],
        &[4, 8, 6, 7],
    ];
    Cage::solid(&positions, &faces)
}

fn stars() -> Vec<(&'static str, Cage)> {
    let star = |n: usize, r: usize, creases: &[(usize, f64)]| {
        creases.iter().fold(Cage::star(n, r), |cage, &(s, sharpness)| {
            let line = cage.spoke(s).to_vec();
            cage.crease(&line, sharpness)
        })
    };
    vec![
        (
            "star5_crease",
            star(5, 2, &[(0, INFINITE), (2, INFINITE)])
                .about("an infinitely sharp crease through a vertex of valence 5"),
        ),
        (
            "star3_semi_sharp",
            star(3, 2, &[(0, 1.3), (1, 1.3)])
                .about("a crease of 1.3 through a vertex of valence 3"),
        ),
        (
            "star5_semi_sharp",
            star(5, 1, &[(0, 2.5), (1, 0.5), (3, 1.0)])
                .about("three creases of different sharpness meet in a vertex of valence 5"),
        ),
        (
            "star5_dart",
            star(5, 1, &[(1, INFINITE)]).about("a crease ends in a vertex of valence 5"),
        ),
        (
            "star5_ending",
            star(5, 1, &[(0, 0.7), (2, 0.4), (3, 0.3)])
                .about("three creases end together in a vertex of valence 5"),
        ),
        (
            "star6_chaikin",
            star(6, 1, &[(0, 0.7), (2, 2.1), (3, 3.3), (5, 4.6)])
                .about("four creases meet by Chaikin's rule in a vertex of valence 6")
                .chaikin(),
        ),
        (
            "star6_junction",
            star(6, 1, &[(0, INFINITE), (2, INFINITE), (3, INFINITE)])
                .about("three infinitely sharp creases meet in a vertex of valence 6"),
        ),
        (
            "star3_corner",
            star(3, 1, &[]).corner(0, INFINITE).about("an infinitely sharp vertex of valence 3"),
        ),
        (
            "star7_corner",
            star(7, 1, &[(4, 1.5)]).corner(0, 1.75).about("a semi-sharp vertex of valence 7"),
        ),
    ]
}

fn boundaries() -> Vec<(&'static str, Cage)> {
    let fans = |faces: &[usize]| {
        faces.iter().fold(Cage::fan(1, 4, 1), |cage, &k| {
            cage.and(&Cage::fan(k, k.max(3) + 1, 1), 1.5 * (k - 1) as f64)
        })
    };
    vec![
        (
            "boundary_valences",
            fans(&[2, 3, 4, 5, 6]).about("boundary vertices with 1 to 6 faces").boundary(1),
        ),
        (
            "boundary_edge_only",
            fans(&[2, 3, 5])
                .about("boundary vertices with 1, 2, 3 and 5 faces, smooth corners")
                .boundary(2),
        ),
        (
            "boundary_omitted",
            Cage::sheet(4, 4)
                .about("no surface at the boundary, but along an edge that is sharp")
                .boundary(0)
                .crease(
                    &[at(4, 0, 0), at(4, 0, 1), at(4, 0, 2), at(4, 0, 3), at(4, 0, 4)],
                    INFINITE,
                )
                .crease(&[at(4, 2, 1), at(4, 2, 2), at(4, 2, 3)], 1.5),
        ),
        (
            "boundary_concave",
            Cage::sheet(4, 4)
                .without(&[0, 1, 4, 5])
                .about("concave corners of the boundary, one of them sharp by its tag")
                .without(&[11])
                .corner(8, INFINITE),
        ),
        (
            "boundary_creased",
            Cage::sheet(3, 4)
                .about("creases that run into the boundary, and semi-sharp boundary edges")
                .crease(&[at(4, 0, 1), at(4, 1, 1)], INFINITE)
                .crease(&[at(4, 3, 2), at(4, 2, 2), at(4, 1, 2)], 1.5)
                .crease(&[at(4, 1, 4), at(4, 1, 3)], 0.5)
                .crease(&[at(4, 0, 3), at(4, 0, 4)], 3.0)
                .boundary(2),
        ),
    ]
}

fn polygons() -> Vec<(&'static str, Cage)> {
    vec![
        (
            "polygons_boundary",
            Cage::sheet(3, 3)
                .about("triangles and a hexagon at the boundary, rule edge-and-corner")
                .replaced(0, &[&[0, 4, 1], &[4, 5, 1]])
                .merged(7, 8),
        ),
        (
            "polygons_creased",
            Cage::sheet(3, 3)
                .about(
                    "a triangulated quad inside, a crease of 1.5 and an infinite one on polygons",
                )
                .replaced(4, &[&[5, 9, 6], &[9, 10, 6]])
                .merged(0, 1)
                .crease(&[at(3, 1, 0), at(3, 1, 1), at(3, 1, 2)], 1.5)
                .crease(&[at(3, 2, 1), at(3, 2, 2), at(3, 2, 3)], INFINITE),
        ),
        (
            "tetrahedron_creased",
            tetrahedron().about("triangles only, with creases 1.5 and infinity"),
        ),
    ]
}

fn tetrahedron() -> Cage {
    let positions = [[0., 0., 0.], [2., 0., 0.], [1., 2., 0.], [1., 1., 2.]];
    let faces: [&[usize]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
    Cage::solid(&positions, &faces).crease(&[0, 1, 3], 1.5).crease(&[1, 2], INFINITE)
}

fn textures() -> Vec<(&'static str, Cage)> {
    vec![
        (
            "uv_dart",
            Cage::sheet(2, 2).about("a texture seam that ends inside, at vertex 4").textured(
                &[0; 4],
                &[[4, 5]],
                &[4],
            ),
        ),
        (
            "uv_three_islands",
            Cage::star(6, 1)
                .about("three islands of two faces meet in a vertex of valence 6")
                .textured(&[0, 0, 1, 1, 2, 2], &[], &[]),
        ),
        (
            "uv_concave",
            Cage::sheet(2, 2)
                .about("an island of one face beside one with a concave corner; smooth corners")
                .boundary(2)
                .textured(&[0, 0, 0, 1], &[], &[]),
        ),
        (
            "uv_unfolded_cube",
            cube()
                .about("a cube unfolded to a cross, and creased")
                .crease(&[0, 1, 2], 1.5)
                .textured(&[0; 6], &[[4, 5], [5, 6], [6, 7], [0, 4], [1, 5], [2, 6], [3, 7]], &[]),
        ),
        (
            "uv_creased_seam",
            Cage::sheet(3, 2)
                .about("a seam crossed by creases: infinitely sharp and 1.5; a sharp vertex on it")
                .crease(&[at(2, 1, 0), at(2, 1, 1)], 1.5)
                .crease(&[at(2, 2, 2), at(2, 2, 1)], INFINITE)
                .corner(at(2, 3, 1), 2.5)
                .textured(&[0, 1, 0, 1, 0, 1], &[], &[]),
        ),
        (
            "uv_polygons",
            Cage::sheet(3, 2)
                .about("a seam through triangles and a hexagon")
                .replaced(2, &[&[3, 6, 4], &[6, 7, 4]])
                .merged(1, 3)
                .textured(&[0, 1, 0, 0, 1, 0], &[], &[]),
        ),
    ]
}

/// Seams through creases that end.
fn dependent_textures() -> Vec<(&'static str, Cage)> {
    vec![
        (
            "uv_dependent",
            halved(&[(1, 1.5), (2, 1.8)])
                .about("creases on one side of a seam, which end together, hold the other side"),
        ),
        (
            "uv_dependent_infinite",
            halved(&[(1, INFINITE), (4, 1.5)])
                .about("an infinitely sharp crease on one side of a seam, 1.5 on the other"),
        ),
        (
            "uv_dependent_seam",
            halved(&[(0, 3.2), (1, 1.5), (3, 2.4)]).about(
                "a crease on one side of a seam holds the other; the seam is sharp for longer",
            ),
        ),
        (
            "uv_dependent_corner",
            halved(&[(2, 2.7)])
                .about("a vertex of sharpness 1.3 on a seam, and a crease on one side")
                .corner(0, 1.3),
        ),
        (
            "uv_chaikin",
            halved(&[(0, 3.2), (1, 1.4), (2, 2.3), (4, 0.9)])
                .about("creases along and on both sides of a seam by Chaikin's rule")
                .chaikin(),
        ),
    ]
}

/// A small star of 6 sectors with creases on spokes, and a seam along the spokes 0 and 3.
fn halved(creases: &[(usize, f64)]) -> Cage {
    let mut cage = Cage::star(6, 1);
    for &(spoke, sharpness) in creases {
        let line = cage.spoke(spoke).to_vec();
        cage = cage.crease(&line, sharpness);
    }
    cage.textured(&[0, 0, 0, 1, 1, 1], &[], &[])
}
