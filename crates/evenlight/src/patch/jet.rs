//! Position and derivatives at a point of a surface, and what follows from them.

use super::basis::BasisJet;
use crate::point::{Vector, add_scaled, cross, dot, in_space, scale, unit};

/// Position and the derivatives up to order two of a map (u,v) -> space, or of the N numbers of a
/// primvar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<const N: usize = 3> {
    /// The position, or the value.
    pub p: [f64; N],
    /// The derivative in u.
    pub du: [f64; N],
    /// The derivative in v.
    pub dv: [f64; N],
    /// The second derivative in u.
    pub duu: [f64; N],
    /// The mixed second derivative.
    pub duv: [f64; N],
    /// The second derivative in v.
    pub dvv: [f64; N],
}

impl<const N: usize> Default for Jet<N> {
    #[inline]
    fn default() -> Self {
        let zero = [0.0; N];
        Self { p: zero, du: zero, dv: zero, duu: zero, duv: zero, dvv: zero }
    }
}

impl<const N: usize> Jet<N> {
    /// The jet of sum_ij bu_i bv_j p(i,j), from the first `counts` basis functions in each
    /// variable.
    pub(crate) fn tensor_product<const K: usize>(
        bu: &BasisJet<K>,
        bv: &BasisJet<K>,
        counts: [usize; 2],
        p: impl Fn(usize, usize) -> [f64; N],
    ) -> Self {
        let mut along_v = [[[0.0; N]; 3]; K];
        for (i, row) in along_v.iter_mut().enumerate().take(counts[0]) {
            *row = weighted_sums(bv, counts[1], |j| p(i, j));
        }
        let along_u = |order: usize| weighted_sums(bu, counts[0], |i| along_v[i][order]);
        let ([p, du, duu], [dv, duv, _], [dvv, ..]) = (along_u(0), along_u(1), along_u(2));
        Self { p, du, dv, duu, duv, dvv }
    }

    /// Position and derivatives in the order p, du, dv, duu, duv, dvv.
    pub fn rows(&self) -> [[f64; N]; 6] {
        [self.p, self.du, self.dv, self.duu, self.duv, self.dvv]
    }

    /// The jet of (u,v) -> map(w u, w v), whose derivatives of order k are w^k times as long.
    pub fn scaled_parameters(&self, w: f64) -> Self {
        Self {
            p: self.p,
            du: scale(w, self.du),
            dv: scale(w, self.dv),
            duu: scale(w * w, self.duu),
            duv: scale(w * w, self.duv),
            dvv: scale(w * w, self.dvv),
        }
    }

    /// The jet of (u,v) -> factor map(x u, y v).
    pub fn scaled(&self, factor: f64, [x, y]: [f64; 2]) -> Self {
        Self {
            p: scale(factor, self.p),
            du: scale(factor * x, self.du),
            dv: scale(factor * y, self.dv),
            duu: scale(factor * x * x, self.duu),
            duv: scale(factor * x * y, self.duv),
            dvv: scale(factor * y * y, self.dvv),
        }
    }

    /// The unit normal and the curvatures of the first three numbers; NaN where the derivatives are
    /// parallel or zero.
    #[inline]
    pub(crate) fn shape(&self) -> Shape {
        let [du, dv] = [self.du, self.dv].map(in_space);
        let area = cross(du, dv);
        Shape::new(du, dv, [self.duu, self.duv, self.dvv].map(|r| dot(area, in_space(r))))
    }
}

impl Jet {
    /// The unit normal du x dv; NaN where the derivatives are parallel or zero.
    pub fn normal(&self) -> Vector {
        normal_direction(self.du, self.dv).0
    }

    /// Gauss and mean curvature (K, H); NaN where the derivatives are parallel or zero.
    ///
    /// H is the mean of the principal curvatures, in 1/length, positive where the surface
    /// bends towards its normal: the unit sphere with outward normal has H = -1. K is in
    /// 1/length^2 and does not depend on the orientation.
    ///
    /// ```
    /// use evenlight::patch::Jet;
    ///
    /// // The paraboloid (u, v, u^2 + v^2) at its lowest point: both principal curvatures are 2.
    /// let (du, dv) = ([1., 0., 0.], [0., 1., 0.]);
    /// let jet = Jet { du, dv, duu: [0., 0., 2.], dvv: [0., 0., 2.], ..Jet::default() };
    /// assert_eq!(jet.curvature(), (4.0, 2.0));
    /// ```
    pub fn curvature(&self) -> (f64, f64) {
        let Shape { gauss, mean, .. } = self.shape();
        (gauss, mean)
    }
}

/// Position and first derivatives of a map (u,v) -> space, or of the N numbers of a primvar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstJet<const N: usize = 3> {
    /// The position, or the value.
    pub p: [f64; N],
    /// The derivative in u.
    pub du: [f64; N],
    /// The derivative in v.
    pub dv: [f64; N],
}

impl<const N: usize> Default for FirstJet<N> {
    fn default() -> Self {
        Self { p: [0.0; N], du: [0.0; N], dv: [0.0; N] }
    }
}

impl FirstJet {
    /// The unit normal du x dv; NaN where the derivatives are parallel or zero.
    ///
    /// ```
    /// use evenlight::patch::FirstJet;
    ///
    /// let jet = FirstJet { p: [0.0; 3], du: [2., 0., 0.], dv: [1., 3., 0.] };
    /// assert_eq!(jet.normal(), [0.0, 0.0, 1.0]);
    /// ```
    pub fn normal(&self) -> Vector {
        normal_direction(self.du, self.dv).0
    }
}

/// The unit normal, and Gauss and mean curvature (K, H).
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// The unit normal.
    pub normal: Vector,
    /// K.
    pub gauss: f64,
    /// H.
    pub mean: f64,
}

impl Shape {
    /// From r_u, r_v and the determinants det(r_u, r_v, r_uu), with r_uv and r_vv.
    #[inline]
    pub(crate) fn new(ru: Vector, rv: Vector, determinants: [f64; 3]) -> Self {
        let (normal, inverse) = normal_direction(ru, rv);
        let (e, f, g) = (dot(ru, ru), dot(ru, rv), dot(rv, rv));
        let [l, m, n] = determinants.map(|d| d * inverse);
        let inverse_sq = inverse * inverse;
        let gauss = (l * n - m * m) * inverse_sq;
        let mean = 0.5 * (e * n - 2.0 * f * m + g * l) * inverse_sq;
        Self { normal, gauss, mean }
    }
}

/// If the sine of the angle between two derivatives is below this, it is rounding: the angle is 0
/// or pi, as at a corner whose two edges lie on one straight line.
const PARALLEL: f64 = 1e-12;

/// r_u x r_v at length one, and one divided by its length; NaN if they are parallel or zero.
#[inline]
fn normal_direction(ru: Vector, rv: Vector) -> (Vector, f64) {
    /// Squares of lengths far from the ends of the range of `f64`, where they are exact to
    /// rounding.
    const SAFE: std::ops::Range<f64> = 1e-250..1e250;
    let area = cross(ru, rv);
    let square = dot(area, area);
    if !SAFE.contains(&square) {
        return (unit(area), 1.0 / square.sqrt());
    }
    let is_parallel = square <= PARALLEL * dot(ru, ru) * (PARALLEL * dot(rv, rv));
    let inverse = if is_parallel { f64::NAN } else { 1.0 / square.sqrt() };
    (scale(inverse, area), inverse)
}

/// The sums of values, first and second derivatives of the first `count` basis functions times
/// points.
fn weighted_sums<const K: usize, const N: usize>(
    basis: &BasisJet<K>,
    count: usize,
    p: impl Fn(usize) -> [f64; N],
) -> [[f64; N]; 3] {
    let mut sums = [[0.0; N]; 3];
    for k in 0..count.min(K) {
        let p = p(k);
        for (sum, weights) in sums.iter_mut().zip(basis) {
            add_scaled(sum, weights[k], p);
        }
    }
    sums
}

/// Everything that a surface answers at one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position and derivatives in the (u,v) of the face that was asked.
    pub jet: Jet,
    /// The unit normal, outward for counter-clockwise faces.
    pub normal: Vector,
    /// The Gauss curvature K, in 1/length^2.
    pub gauss: f64,
    /// The mean curvature H, in 1/length; negative where the surface bends away from its
    /// normal (convex bodies have H < 0).
    pub mean: f64,
}

impl SurfacePoint {
    /// The principal curvatures, the larger first, in 1/unit: H +- sqrt(H^2 - K).
    pub fn principal_curvatures(&self) -> [f64; 2] {
        // At an umbilic rounding may leave H^2 - K just below zero; NaN stays NaN.
        let difference = self.mean * self.mean - self.gauss;
        let root = if difference < 0.0 { 0.0 } else { difference.sqrt() };
        [self.mean + root, self.mean - root]
    }
}

impl From<Jet> for SurfacePoint {
    fn from(jet: Jet) -> Self {
        let Shape { normal, gauss, mean } = jet.shape();
        Self { jet, normal, gauss, mean }
    }
}
