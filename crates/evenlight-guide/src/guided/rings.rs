//! The rings of a guided surface, as tables on the guide and on the c-net.
//!
//! A ring has three patches A, B, C per sector ([`super::characteristic`]). Each has bi-degree 5,
//! or 6, and takes its coefficients from three places [KP18-Guided, sec. 3.2]:
//!
//! ```text
//!           outer border: from the ring before, or the net
//!   o o o o o o | o o o o o o       bi-5: every corner of a patch owns 3 x 3 coefficients;
//!   o o o o o o | o o o o o o       * = 3 x 3 jets of g(chi^T), chi^T in the guide's
//!   o o o o o o | o o o o o o           coordinates, at the inner corners
//!   * * *   C   | * * * B o o       o = the three layers next to the outer boundary
//!   * * *       | * * *   o o
//!   * * * * * * | * * *   o o       bi-6: 4 x 4 jets; coefficients of index 3 belong to two
//!   ------------+-------------      corners and are averaged
//! ```
//!
//! Neighbouring patches share the jets at common corners, and their border is one piece; so all
//! joins are C2. In the first ring the border is the second-order data of the surrounding surface.
//! In all later rings it comes from the 3 x 3 jets at the ends of the unit square's outer edges, of
//! g composed with the continuation of chi outwards. These are the inner data of the ring before,
//! so that the rings join C2.
//!
//! The tables act on the 36 coefficients of one piece of the guide *at the level of the ring*,
//! g(lambda^l .), so all later rings share one table. In degree bi-6 the rings of a quadratic q are
//! q(chi) exactly: that makes the curvature of the surface continuous at the centre.
//!
//! Bi-4 and bi-3 rings replace the bi-5 patches by splines of the same corner data
//! ([`super::pieces`]).

use crate::guided::bb::{ENDS, End, bb_from_taylor, restrict, taylor_at, units};
use crate::guided::characteristic::{CharacteristicRing, SQUARES, Square};
use crate::guided::composition::{composed, jet_at, sampled};
use crate::guided::net::CNet;
use crate::guided::pieces::{knots, lines, parts, quintic_parts, spline};
use crate::guided::space::{COEFS, DEGREE};
use crate::linear::Matrix;
use crate::real::Real;

/// The patches of a ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// One bi-6 patch per square: curvature continuous at the centre.
    Bi6,
    /// One bi-5 patch per square: curvature bounded at the centre.
    Bi5,
    /// 2 x 2 bi-4 patches per square.
    Bi4,
    /// 3 x 3 bi-3 patches per square.
    Bi3,
}

impl Form {
    /// The degree of the patches.
    pub fn degree(self) -> usize {
        match self {
            Self::Bi6 => 6,
            Self::Bi5 => 5,
            Self::Bi4 => 4,
            Self::Bi3 => 3,
        }
    }

    /// The degree of the samples and of the tables: 6 or 5.
    pub fn sampled_degree(self) -> usize {
        self.degree().max(5)
    }

    /// The jets at the corners are this many by this many.
    fn jet_order(self) -> usize {
        if self == Self::Bi6 { 4 } else { 3 }
    }

    /// The coefficients along the two parts of a border, on those of the whole.
    fn border_parts(self, sigma: Real) -> [Matrix; 2] {
        match self {
            Self::Bi6 | Self::Bi5 => quintic_parts(self.degree(), sigma),
            Self::Bi4 | Self::Bi3 => parts(&knots(self.degree(), sigma)[0], sigma),
        }
    }

    /// The lines between the patches of the inner squares' side `[0,sigma]` and of the outer side
    /// `[sigma,1]`, both as parameters from 0 to 1.
    pub fn lines(self, sigma: Real) -> [Vec<Real>; 2] {
        knots(self.degree(), sigma).map(|knots| lines(&knots))
    }

    /// The patches of one square from its table, a table each: one, or 2 x 2 or 3 x 3 in the order
    /// (number along u) * (2 or 3) + (number along v).
    pub fn patches(self, square: Square, sigma: Real, table: &Matrix) -> Vec<Matrix> {
        if self.degree() >= DEGREE {
            return vec![table.clone()];
        }
        let [inner, outer] = knots(self.degree(), sigma).map(|knots| spline(&knots));
        let [of_u, of_v] = match square {
            Square::A => [&outer, &inner],
            Square::B => [&outer, &outer],
            Square::C => [&inner, &outer],
        };
        let order = self.degree() + 1;
        let count = inner.num_rows() / order;
        let rows = |along: &Matrix, k: usize| {
            along.select_rows(&(k * order..(k + 1) * order).collect::<Vec<_>>())
        };
        let piece = |k: usize| &rows(of_u, k / count).kronecker(&rows(of_v, k % count)) * table;
        (0..count * count).map(piece).collect()
    }
}

/// The tables of the squares A, B, C of a sector: (d + 1)^2 rows each, d the sampled degree.
pub type Squares = [Matrix; 3];

/// The rings of one characteristic ring and form.
#[derive(Clone, Debug)]
pub struct Rings {
    /// The valence n.
    pub valence: usize,
    /// The contraction per ring.
    pub lambda: Real,
    /// The kind of the patches.
    pub form: Form,
    /// Ring 1, 2, ..: on the 36 coefficients of the piece of the sector, at the level of the ring.
    pub later: Squares,
    /// Ring 0: on the coefficients of the piece of the sector.
    pub first_on_guide: Squares,
    /// Ring 0 of sector 0: on the nodes of the c-net.
    pub first_on_net: Squares,
}

impl Rings {
    /// The tables.
    pub fn new(chi: &CharacteristicRing, form: Form) -> Self {
        let degree = form.sampled_degree();
        let border = Border { sigma: chi.sigma, degree, parts: form.border_parts(chi.sigma) };
        let inside = SQUARES.map(|square| {
            let map = in_guide(chi, chi.square(square));
            sampled(&map, degree, form.jet_order())
        });
        let net = CNet { valence: chi.valence };
        let blank = Matrix::zeros((degree + 1) * (degree + 1), net.num_nodes());
        let no_border = Matrix::zeros(3 * (degree + 1), COEFS);
        Self {
            valence: chi.valence,
            lambda: chi.lambda,
            form,
            later: border.written(&inside, &guide_border(chi, form)),
            first_on_guide: border.written(&inside, &[no_border.clone(), no_border]),
            first_on_net: border.written(&SQUARES.map(|_| blank.clone()), &net.outer_data(degree)),
        }
    }

    /// Ring `level` of every sector: the coefficients of its squares, in the sampled degree, from
    /// the coefficients of the guide (36n rows) and the nodes (6n + 1 rows), column by column.
    pub fn ring(&self, level: usize, guide: &Matrix, net: &Matrix) -> Vec<Squares> {
        let shrunk =
            (0..level).fold(Matrix::identity(COEFS), |power, _| &shrinking(self.lambda) * &power);
        let sector = |s: usize| {
            let piece = guide.select_rows(&(COEFS * s..COEFS * (s + 1)).collect::<Vec<_>>());
            if level > 0 {
                let piece = &shrunk * &piece;
                return self.later.each_ref().map(|table| table * &piece);
            }
            let numbering = CNet { valence: self.valence };
            let seen = |node| numbering.turned(node, s as isize);
            let net = net.select_rows(&(0..numbering.num_nodes()).map(seen).collect::<Vec<_>>());
            SQUARES.map(|square| {
                let k = square as usize;
                &(&self.first_on_guide[k] * &piece) + &(&self.first_on_net[k] * &net)
            })
        };
        (0..self.valence).map(sector).collect()
    }
}

/// The coefficients of the guide's piece at the next level, g(lambda u, lambda v): 36 x 36.
pub fn shrinking(lambda: Real) -> Matrix {
    let along = restrict(DEGREE, Real::ZERO, lambda);
    along.kronecker(&along)
}

/// A map in the sector coordinates of chi, scaled into the domain of the guide.
fn in_guide(chi: &CharacteristicRing, map: [Matrix; 2]) -> [Matrix; 2] {
    map.map(|coordinate| coordinate.scaled(chi.domain_scale()))
}

/// The outer border of a later ring from the guide: along u = 1, and along v = 1, as
/// [`CNet::outer_data`].
pub(crate) fn guide_border(chi: &CharacteristicRing, form: Form) -> [Matrix; 2] {
    let map = in_guide(chi, chi.border());
    let transposed = map.each_ref().map(Matrix::transposed);
    [map, transposed].map(|map| edge_data(&map, form))
}

/// The data along u = 1 of g composed with `map`: at the two ends its jets, orders 0..2 across;
/// along the edge the polynomial of these jets, averaged where they overlap.
fn edge_data(map: &[Matrix; 2], form: Form) -> Matrix {
    let (degree, count) = (form.sampled_degree(), form.jet_order());
    let mut sums = Matrix::zeros(3 * (degree + 1), COEFS);
    let mut hits = vec![0; degree + 1];
    for end in ENDS {
        let jets = map.each_ref().map(|patch| jet_at(patch, count, [End::Finish, end]));
        let across = Matrix::identity(count).kronecker(&bb_from_taylor(degree, count, end));
        let block = &across * &composed(&jets);
        let first = end.first(degree, count);
        for k in 0..count {
            hits[first + k] += 1;
            for (order, column) in (0..3).flat_map(|order| (0..COEFS).map(move |c| (order, c))) {
                let weight = block[(count * order + k, column)];
                sums[(order * (degree + 1) + first + k, column)] += weight;
            }
        }
    }
    Matrix::from_fn(sums.num_rows(), COEFS, |row, column| {
        sums[(row, column)] / Real::from(hits[row % (degree + 1)])
    })
}

/// How the outer border of a ring enters its squares.
struct Border {
    sigma: Real,
    degree: usize,
    parts: [Matrix; 2],
}

impl Border {
    /// The squares with their three outer layers replaced by the data `along`: the edge u = 1 is
    /// that of A and B, the edge v = 1 that of C and B.
    fn written(&self, squares: &Squares, along: &[Matrix; 2]) -> Squares {
        let mut squares = squares.clone();
        let order = self.degree + 1;
        let outer = self.degree - 2;
        for (square, part) in [(Square::A, 0), (Square::B, 1)] {
            let layers = &self.layers(part) * &along[0];
            for (layer, i) in (0..3).flat_map(|layer| (0..order).map(move |i| (layer, i))) {
                squares[square as usize]
                    .set_row(order * (outer + layer) + i, layers.row(order * layer + i));
            }
        }
        for (square, part) in [(Square::C, 0), (Square::B, 1)] {
            let layers = &self.layers(part) * &along[1];
            for (layer, i) in (0..3).flat_map(|layer| (0..order).map(move |i| (layer, i))) {
                squares[square as usize]
                    .set_row(order * i + outer + layer, layers.row(order * layer + i));
            }
        }
        squares
    }

    /// The three layers of BB coefficients beside one part of an edge, rows (layer) (d + 1) +
    /// (index along), on the data along the whole edge. The squares are 1 - sigma wide.
    fn layers(&self, part: usize) -> Matrix {
        let width = units(3, Real::ONE - self.sigma);
        (&bb_from_taylor(self.degree, 3, End::Finish) * &width).kronecker(&self.parts[part])
    }
}

/// The second-order data of a patch across one of its sides, in units of which the patch is
/// `width` wide: rows (order across) (d + 1) + (index along) on its coefficients. `across_u` says
/// whether the side is u = const, else v = const; `end` is that constant.
pub fn side_data(degree: usize, across_u: bool, end: End, width: Real) -> Matrix {
    let across = &units(3, Real::ONE / width) * &taylor_at(degree, 3, end);
    let along = Matrix::identity(degree + 1);
    if across_u {
        return across.kronecker(&along);
    }
    let order = degree + 1;
    Matrix::from_fn(3 * order, order * order, |row, column| {
        let (k, i) = (row / order, row % order);
        if column / order == i { across[(k, column % order)] } else { Real::ZERO }
    })
}
