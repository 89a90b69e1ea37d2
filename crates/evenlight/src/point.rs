//! Points and vectors, with the few operations that the geometry needs.
//!
//! A point is a plain array, so that callers need no type of ours and coordinates can be
//! handed over without a copy. All operations round like the formula that is written.
//!
//! Linear operations work on `[f64; N]`: positions have three numbers, primvars one to four.

/// A point in space, in the units of the input mesh.
pub type Point = [f64; 3];

/// A difference of points, in the units of the input mesh.
pub type Vector = [f64; 3];

/// `a + b`.
#[inline]
pub fn add<const N: usize>(mut a: [f64; N], b: [f64; N]) -> [f64; N] {
    for k in 0..N {
        a[k] += b[k];
    }
    a
}

/// `a - b`.
#[inline]
pub fn sub<const N: usize>(mut a: [f64; N], b: [f64; N]) -> [f64; N] {
    for k in 0..N {
        a[k] -= b[k];
    }
    a
}

/// `w a`.
#[inline]
pub fn scale<const N: usize>(w: f64, mut a: [f64; N]) -> [f64; N] {
    for x in &mut a {
        *x *= w;
    }
    a
}

/// `sum += w a`, the step of every weighted sum.
#[inline]
pub fn add_scaled<const N: usize>(sum: &mut [f64; N], w: f64, a: [f64; N]) {
    for k in 0..N {
        sum[k] += w * a[k];
    }
}

/// The scalar product of `a` and `b`.
#[inline]
pub fn dot<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    let mut sum = a[0] * b[0];
    for k in 1..N {
        sum += a[k] * b[k];
    }
    sum
}

/// The cross product `a x b`, right-handed.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length of `a`.
pub fn norm<const N: usize>(a: [f64; N]) -> f64 {
    dot(a, a).sqrt()
}

/// `a` at length one; NaN in every coordinate if `a` is zero, since it has no direction.
pub fn unit(a: Vector) -> Vector {
    // Scaled by the largest coordinate first: the square of a tiny vector would underflow.
    let largest = a[0].abs().max(a[1].abs()).max(a[2].abs());
    let b = [a[0] / largest, a[1] / largest, a[2] / largest];
    scale(1.0 / norm(b), b)
}

/// The first three numbers of `a`; if `a` has fewer, the others are zero.
#[inline]
pub(crate) fn in_space<const N: usize>(a: [f64; N]) -> Vector {
    let mut r = [0.0; 3];
    let count = N.min(3);
    r[..count].copy_from_slice(&a[..count]);
    r
}

/// The point `(1 - t) a + t b`.
pub fn lerp<const N: usize>(a: [f64; N], b: [f64; N], t: f64) -> [f64; N] {
    std::array::from_fn(|k| (1.0 - t) * a[k] + t * b[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cross_is_right_handed_and_orthogonal() {
        assert_eq!(cross([1., 0., 0.], [0., 1., 0.]), [0., 0., 1.]);
        let (a, b) = ([1., 2., 3.], [-2., 0.5, 4.]);
        assert_eq!(dot(a, cross(a, b)), 0.0);
    }

    #[test]
    fn unit_of_tiny_vectors_has_length_one() {
        let n = unit([3e-200, 4e-200, 0.0]);
        assert!((n[0] - 0.6).abs() < 1e-15 && (n[1] - 0.8).abs() < 1e-15);
        assert!(unit([0.0; 3])[0].is_nan());
    }
}
