//! Caps that follow the guide of guided subdivision [KP18-Guided, App. B].
//!
//! A ring samples the guide along chi; the cap samples it along the bi-6 map of the plane, in jets
//! at the corners of its patches. The samples do not join; they are changed as little as possible
//! until they do. With one bi-6 patch per sector they change only where the paper changes them:
//!
//! ```text
//!   r r r r r r r      r  first-order data of the last ring
//!   r r r r r r r      *  4 x 4 jets of the guide, averaged where they overlap
//!   x * * * * r r      x  the line's curve, and
//!   x a * * * r r      a  what tangency asks for, both sides changed by the same amount
//!   x a * * * r r
//!   * * a a * r r
//!   * * x x x r r
//! ```

use super::plane;
use super::sector::{Complex, Sector, product};
use super::spline::{Space, restriction};
use crate::angle::{cosine, sine};
use crate::dense::Matrix;
use crate::scheme::{guide_monomials, sampled_guide};

/// One bi-6 patch per sector.
pub(super) const SEXTIC: Space = Space { degree: 6, pieces: 1, smooth: 2 };

/// The guide sampled for a cap.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    /// The BB coefficients of the pieces of a sector, sampled from the powers u^i v^j of the guide.
    table: Matrix,
    /// The 2-jet of the map at the centre, in the BB form of the cap.
    pub(super) center: [Complex; 6],
}

impl Samples {
    /// For chi given by its border data on [`SEXTIC`], `scale` times which is the guide's domain.
    pub(super) fn new(sector: &Sector, chi: &[Complex], scale: f64) -> Self {
        let map = plane::map(&Sector::new(sector.valence, SEXTIC), chi);
        let half = std::f64::consts::PI / sector.valence as f64;
        // zeta = u exp(-i half) + v exp(i half)
        let (along, across) = (2.0 * cosine(half), 2.0 * sine(half));
        let coordinates = [-1.0, 1.0].map(|sign| {
            map.iter().map(|[x, y]| scale * (x / along + sign * y / across)).collect::<Vec<f64>>()
        });
        let m = sector.space.pieces;
        let rows = (0..m * m).flat_map(|which| {
            let part = coordinates.each_ref().map(|f| part_of(f, which / m, which % m, m));
            let samples = sampled_guide(&part, sector.space.degree);
            let order = sector.space.degree + 1;
            (0..order * order).map(move |k| samples.iter().map(|patch| patch[k]).collect())
        });
        let rows: Vec<Vec<f64>> = rows.collect();
        Self {
            table: Matrix::from_rows(guide_monomials().len(), &rows),
            center: center_in(sector.space, &map),
        }
    }

    /// The rows of the distance between the BB coefficients of a sector and the samples: on z, the
    /// border data and the guide.
    pub(super) fn distance(&self, sector: &Sector) -> Matrix {
        let (order, m) = (sector.space.degree + 1, sector.space.pieces);
        let mut rows = Vec::new();
        for (which, k) in (0..m * m).flat_map(|w| (0..order * order).map(move |k| (w, k))) {
            let (a, b) = (which / m * order + k / order, which % m * order + k % order);
            let mut row = product(sector.to_bb.row(a), sector.to_bb.row(b));
            row.resize(row.len() + sector.num_border(), 0.0);
            row.extend(self.table.row(which * order * order + k).iter().map(|x| -x));
            rows.push(row);
        }
        let columns = rows[0].len();
        Matrix::from_rows(columns, &rows)
    }

    /// z_ij as weights of the guide, where the paper takes the sample as it is.
    pub(super) fn kept(&self, sector: &Sector, at: usize) -> Option<&[f64]> {
        let (i, j) = (at / sector.space.dim(), at % sector.space.dim());
        let changes = matches!((i.max(j), i.min(j)), (3 | 4, 0) | (2 | 3, 1));
        (sector.space == SEXTIC && !changes).then(|| self.table.row(at))
    }
}

/// Piece (a,b) of m x m of a bi-6 function.
fn part_of(f: &[f64], a: usize, b: usize, m: usize) -> Vec<f64> {
    let ends = |k: usize| [k as f64 / m as f64, (k + 1) as f64 / m as f64];
    let (u, v) = (restriction(6, ends(a)), restriction(6, ends(b)));
    let columns: Vec<Vec<f64>> = f.chunks(7).map(<[f64]>::to_vec).collect();
    let part = u.times(&Matrix::from_rows(7, &columns)).times(&v.transposed());
    (0..7).flat_map(|i| part.row(i).to_vec()).collect()
}

/// The 2-jet of a bi-6 map at the centre as BB coefficients of another space.
fn center_in(space: Space, map: &[Complex]) -> [Complex; 6] {
    let combination = |terms: [(f64, usize); 3]| {
        terms.iter().fold([0.0; 2], |[x, y], &(w, at)| [x + w * map[at][0], y + w * map[at][1]])
    };
    let (d, h) = (space.degree as f64, space.step());
    // Taylor coefficients of orders (1,0), (0,1), then (2,0), (1,1), (0,2), in steps h.
    let (u, v) = (
        combination([(6.0 * h, 7), (0.0, 0), (0.0, 0)]),
        combination([(6.0 * h, 1), (0.0, 0), (0.0, 0)]),
    );
    let uu = combination([(15.0 * h * h, 14), (-30.0 * h * h, 7), (0.0, 0)]);
    let uv = combination([(36.0 * h * h, 8), (-36.0 * h * h, 7), (-36.0 * h * h, 1)]);
    let vv = combination([(15.0 * h * h, 2), (-30.0 * h * h, 1), (0.0, 0)]);
    let sum = |terms: [(f64, Complex); 3]| {
        terms.iter().fold([0.0; 2], |[x, y], &(w, z)| [x + w * z[0], y + w * z[1]])
    };
    let zero = (0.0, [0.0; 2]);
    [
        [0.0; 2],
        sum([(1.0 / d, u), zero, zero]),
        sum([(1.0 / d, v), zero, zero]),
        sum([(2.0 / d, u), (2.0 / (d * (d - 1.0)), uu), zero]),
        sum([(1.0 / d, u), (1.0 / d, v), (1.0 / (d * d), uv)]),
        sum([(2.0 / d, v), (2.0 / (d * (d - 1.0)), vv), zero]),
    ]
}

/// The datum of a sector that changes places with another when u and v do.
pub(super) fn mirrored_datum(sector: &Sector, at: usize) -> usize {
    let count = sector.num_border();
    if at < count {
        return sector.mirrored_border(at);
    }
    let monomials = guide_monomials();
    let (i, j) = monomials[at - count];
    let image = monomials.iter().position(|&other| other == (j, i));
    count + image.expect("the powers are those with both exponents up to 5")
}
