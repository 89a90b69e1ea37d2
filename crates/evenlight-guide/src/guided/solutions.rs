//! All solutions of a linear system that does not determine its unknowns.

use crate::linear::Matrix;
use crate::real::Real;

/// A pivot below this is a zero: the smallest one kept in this crate is 0.02, the largest dropped
/// 1e-27.
const PIVOT_TOLERANCE: f64 = 1e-20;

/// The solutions of a system: `particular` + `kernel` y for any y.
#[derive(Clone, Debug)]
pub struct Solutions {
    /// One solution for every right-hand side, as columns.
    pub particular: Matrix,
    /// A basis of the solutions for the right-hand side 0, as columns.
    pub kernel: Matrix,
}

/// A basis of the solutions of `matrix` x = 0, as columns: each free unknown is 1 in one column and
/// 0 in the others.
pub fn kernel(matrix: &Matrix) -> Matrix {
    let no_right = Matrix::zeros(matrix.num_rows(), 0);
    solutions(matrix, &no_right).expect("zero is a solution").kernel
}

/// The solutions X of `matrix` X = `right`, by Gauss-Jordan elimination with complete pivoting;
/// `None` if there are none.
pub fn solutions(matrix: &Matrix, right: &Matrix) -> Option<Solutions> {
    let num_unknowns = matrix.num_columns();
    let mut system = matrix.beside(right);
    let mut pivots: Vec<usize> = Vec::new();
    while let Some((row, column)) = largest_below(&system, pivots.len(), 0..num_unknowns) {
        let rank = pivots.len();
        swap_rows(&mut system, rank, row);
        clear_column(&mut system, rank, column);
        pivots.push(column);
    }
    if largest_below(&system, pivots.len(), num_unknowns..system.num_columns()).is_some() {
        return None;
    }
    let free: Vec<usize> = (0..num_unknowns).filter(|x| !pivots.contains(x)).collect();
    let mut kernel = Matrix::zeros(num_unknowns, free.len());
    let mut particular = Matrix::zeros(num_unknowns, right.num_columns());
    free.iter().enumerate().for_each(|(k, &unknown)| kernel[(unknown, k)] = Real::ONE);
    for (row, &pivot) in pivots.iter().enumerate() {
        for (k, &unknown) in free.iter().enumerate() {
            kernel[(pivot, k)] = -system[(row, unknown)];
        }
        particular.set_row(pivot, &system.row(row)[num_unknowns..]);
    }
    Some(Solutions { particular, kernel })
}

impl Solutions {
    /// The solutions x that minimise x^T `energy` x, one for every right-hand side. The energy must
    /// be positive on the kernel.
    pub fn least(&self, energy: &Matrix) -> Matrix {
        let gradient = &self.kernel.transposed() * energy;
        let right = (&gradient * &self.particular).scaled(-Real::ONE);
        let y = (&gradient * &self.kernel).solve(&right).expect("the energy is positive");
        &self.particular + &(&self.kernel * &y)
    }
}

/// The place of the largest entry of some columns, from row `first` on; `None` if all are zero.
fn largest_below(
    matrix: &Matrix,
    first: usize,
    columns: std::ops::Range<usize>,
) -> Option<(usize, usize)> {
    let mut best = (Real::from(PIVOT_TOLERANCE), None);
    for row in first..matrix.num_rows() {
        for column in columns.clone() {
            let size = matrix[(row, column)].abs();
            if size > best.0 {
                best = (size, Some((row, column)));
            }
        }
    }
    best.1
}

fn swap_rows(matrix: &mut Matrix, a: usize, b: usize) {
    let (row_a, row_b) = (matrix.row(a).to_vec(), matrix.row(b).to_vec());
    matrix.set_row(a, &row_b);
    matrix.set_row(b, &row_a);
}

/// Makes column `column` the unit vector of row `pivot`.
fn clear_column(matrix: &mut Matrix, pivot: usize, column: usize) {
    let inverse = Real::ONE / matrix[(pivot, column)];
    let pivot_row: Vec<Real> = matrix.row(pivot).iter().map(|&x| inverse * x).collect();
    matrix.set_row(pivot, &pivot_row);
    for row in (0..matrix.num_rows()).filter(|&row| row != pivot) {
        let factor = matrix[(row, column)];
        if factor != Real::ZERO {
            let rest = matrix.row(row).iter().zip(&pivot_row);
            let rest: Vec<Real> = rest.map(|(&x, &p)| x - factor * p).collect();
            matrix.set_row(row, &rest);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::largest;

    #[test]
    fn every_solution_is_found_and_contradictions_are_told() {
        // x + 2y + 3z = r twice, written differently.
        let matrix = Matrix::from_fractions(&[[1, 2, 3], [2, 4, 6]], 1);
        let right = Matrix::from_fractions(&[[6], [12]], 1);
        let found = solutions(&matrix, &right).unwrap();
        assert_eq!(found.kernel.num_columns(), 2);
        assert!(largest(&(&matrix * &found.kernel)) < 1e-30);
        assert!(largest(&(&(&matrix * &found.particular) - &right)) < 1e-30);
        let contradiction = Matrix::from_fractions(&[[6], [11]], 1);
        assert!(solutions(&matrix, &contradiction).is_none());
    }

    #[test]
    fn the_least_solution_is_the_foot_of_the_perpendicular() {
        let matrix = Matrix::from_fractions(&[[1, 2, 3]], 1);
        let right = Matrix::from_fractions(&[[14]], 1);
        let least = solutions(&matrix, &right).unwrap().least(&Matrix::identity(3));
        assert!(largest(&(&least - &Matrix::from_fractions(&[[1], [2], [3]], 1))) < 1e-30);
    }
}
