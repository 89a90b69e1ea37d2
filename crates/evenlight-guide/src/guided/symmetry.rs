//! The mirrors of a sector, and the matrix that fits a guide, averaged with its mirror images.
//!
//! The rows of a generating matrix, one for each coefficient p_ij of the piece of sector 0, weigh
//! the nodes of a c-net. Two mirrors keep a net's rules:
//!
//! ```text
//!   in the diagonal of the sector:   p_ji = p_ij of the mirrored net
//!   in line -1, where u runs:        p_i0 = p_i0 of the mirrored net
//! ```
//!
//! A matrix that was computed has both up to rounding; the averages here have both exactly.

use crate::guided::net::CNet;
use crate::guided::space::{COEFS, DEGREE};
use crate::linear::Matrix;
use crate::real::Real;

/// The rows of a generating matrix averaged with their mirror images.
pub(crate) fn symmetric_rows(generating: &Matrix, valence: usize) -> Vec<Vec<Real>> {
    let generating = symmetrised(generating, valence);
    let on_line = |row: usize| row.is_multiple_of(DEGREE + 1) || row <= DEGREE;
    let row = |row: usize| match on_line(row) {
        true => line_row(&generating, valence, row),
        false => generating.row(row).to_vec(),
    };
    (0..COEFS).map(row).collect()
}

/// The matrix averaged with its mirror image in the diagonal of the sector, which it equals up to
/// rounding.
pub fn symmetrised(generating: &Matrix, valence: usize) -> Matrix {
    let net = CNet { valence };
    let order = DEGREE + 1;
    Matrix::from_fn(COEFS, net.num_nodes(), |row, node| {
        let image = generating[(order * (row % order) + row / order, net.mirrored(node))];
        (generating[(row, node)] + image) * Real::ratio(1, 2)
    })
}

/// The row of p_i0, or of p_0i, averaged with its mirror image in the line, which it equals up to
/// rounding because the guide is continuous.
fn line_row(generating: &Matrix, valence: usize, row: usize) -> Vec<Real> {
    let net = CNet { valence };
    let is_first_line = row.is_multiple_of(DEGREE + 1);
    let own = if is_first_line { row } else { number(row, 0) };
    let weight = |node: usize| {
        let image = generating[(own, mirrored_in_line(net, node))];
        (generating[(own, node)] + image) * Real::ratio(1, 2)
    };
    let seen = |node| if is_first_line { node } else { net.mirrored(node) };
    (0..net.num_nodes()).map(|node| weight(seen(node))).collect()
}

/// The number of the coefficient (i, j) of a piece.
pub(crate) fn number(i: usize, j: usize) -> usize {
    (DEGREE + 1) * i + j
}

/// The image of a node in line -1, the first line of sector 0.
pub(crate) fn mirrored_in_line(net: CNet, node: usize) -> usize {
    net.mirrored(net.turned(node, 1))
}
