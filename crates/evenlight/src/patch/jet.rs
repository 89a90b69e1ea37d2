//! Position and derivatives at a point of a surface, and what follows from them.

use super::basis::BasisJet;
use crate::point::{Point, Vector, add_scaled, cross, dot, norm, scale, unit};

/// Position and the derivatives up to order two of a map (u,v) -> space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// The position.
    pub p: Point,
    /// The derivative in u.
    pub du: Vector,
    /// The derivative in v.
    pub dv: Vector,
    /// The second derivative in u.
    pub duu: Vector,
    /// The mixed second derivative.
    pub duv: Vector,
    /// The second derivative in v.
    pub dvv: Vector,
}

impl Jet {
    /// The jet of sum_ij bu_i bv_j p(i,j), from the first `counts` basis functions in each
    /// variable.
    pub(crate) fn tensor_product<const M: usize, const N: usize>(
        bu: &BasisJet<M>,
        bv: &BasisJet<N>,
        counts: [usize; 2],
        p: impl Fn(usize, usize) -> Point,
    ) -> Self {
        let mut along_v = [[[0.0; 3]; 3]; M];
        for (i, row) in along_v.iter_mut().enumerate().take(counts[0]) {
            *row = weighted_sums(bv, counts[1], |j| p(i, j));
        }
        let along_u = |order: usize| weighted_sums(bu, counts[0], |i| along_v[i][order]);
        let ([p, du, duu], [dv, duv, _], [dvv, ..]) = (along_u(0), along_u(1), along_u(2));
        Self { p, du, dv, duu, duv, dvv }
    }

    /// Position and derivatives in the order p, du, dv, duu, duv, dvv.
    pub fn rows(&self) -> [Vector; 6] {
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

    /// The unit normal du x dv; NaN where the derivatives are parallel or zero.
    pub fn normal(&self) -> Vector {
        unit(cross(self.du, self.dv))
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
        let area = cross(self.du, self.dv);
        let w = norm(area);
        let (e, f, g) = (dot(self.du, self.du), dot(self.du, self.dv), dot(self.dv, self.dv));
        let (l, m, n) = (dot(self.duu, area) / w, dot(self.duv, area) / w, dot(self.dvv, area) / w);
        let w2 = w * w;
        ((l * n - m * m) / w2, (e * n - 2.0 * f * m + g * l) / (2.0 * w2))
    }
}

/// The sums of values, first and second derivatives of the first `count` basis functions times
/// points.
fn weighted_sums<const N: usize>(
    basis: &BasisJet<N>,
    count: usize,
    p: impl Fn(usize) -> Point,
) -> [Vector; 3] {
    let [values, first, second] = basis;
    let weights = values.iter().zip(first).zip(second).take(count);
    let mut sums = [[0.0; 3]; 3];
    for (k, ((&w0, &w1), &w2)) in weights.enumerate() {
        let p = p(k);
        add_scaled(&mut sums[0], w0, p);
        add_scaled(&mut sums[1], w1, p);
        add_scaled(&mut sums[2], w2, p);
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
        let (gauss, mean) = jet.curvature();
        Self { jet, normal: jet.normal(), gauss, mean }
    }
}
