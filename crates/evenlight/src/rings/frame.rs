//! The frame of the limit tangent plane, and the step from its coordinates to world coordinates.

use crate::patch::{Jet, Shape};
use crate::point::{Vector, add_scaled, cross, dot, in_space, norm, scale, unit};
use crate::scheme::Subdominant;

/// Tangents shorter than this part of the net, or closer to parallel, count as zero: rounding
/// leaves 1e-16 where they should vanish, and a sound cage stays far above.
const FLATTEST: f64 = 1e-12;

/// Where X, Y and Z point, and how Z shrinks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame<const N: usize> {
    pub(super) axes: [[f64; N]; N],
    /// Whether Z is the height over a tangent plane. There is none if the tangents are parallel
    /// or zero (a cusp, or all points in one); then Z shrinks like X and Y.
    pub(super) has_plane: bool,
}

/// The number of the coordinate that is the height over the tangent plane.
pub(super) const HEIGHT: usize = 2;

impl<const N: usize> Frame<N> {
    /// The axes of space; there is no tangent plane.
    pub(super) const WORLD: Self = {
        let (mut axes, mut k) = ([[0.0; N]; N], 0);
        while k < N {
            axes[k][k] = 1.0;
            k += 1;
        }
        Self { axes, has_plane: false }
    };

    /// The frame of the limit tangent plane of a net.
    pub(super) fn new(subdominant: &Subdominant, net: &[[f64; N]]) -> Self {
        let [a, b] = subdominant.tangents(net).map(in_space);
        let normal = cross(b, a);
        let longer = dot(a, a).max(dot(b, b));
        let size_sq = net.iter().map(|&p| in_space(p)).map(|p| dot(p, p)).fold(0.0, f64::max);
        let has_plane = longer > FLATTEST * FLATTEST * size_sq && norm(normal) > FLATTEST * longer;
        let mut axes = Self::WORLD.axes;
        if has_plane {
            let normal = unit(normal);
            let first = unit(if dot(a, a) > dot(b, b) { a } else { b });
            for (axis, turned) in axes.iter_mut().zip([first, cross(normal, first), normal]) {
                axis.iter_mut().zip(turned).for_each(|(x, y)| *x = y);
            }
        }
        Self { axes, has_plane }
    }

    /// Whether one of the numbers is a height over a tangent plane.
    pub(super) fn has_height(&self) -> bool {
        self.has_plane && N > HEIGHT
    }

    /// The normal of the tangent plane, or NaN.
    pub(super) fn normal(&self) -> Vector {
        match self.axes.get(HEIGHT) {
            Some(&axis) if self.has_plane => in_space(axis),
            _ => [f64::NAN; 3],
        }
    }

    pub(super) fn coordinates(&self, p: [f64; N]) -> [f64; N] {
        self.axes.map(|axis| dot(axis, p))
    }

    /// F r, without any factor.
    pub(super) fn world(&self, r: [f64; N]) -> [f64; N] {
        let mut p = scale(r[0], self.axes[0]);
        for (&x, &axis) in r.iter().zip(&self.axes).skip(1) {
            add_scaled(&mut p, x, axis);
        }
        p
    }

    /// A direction of the first three coordinates.
    pub(super) fn direction(&self, r: Vector) -> Vector {
        let mut p = scale(r[0], in_space(self.axes[0]));
        for (&x, &axis) in r.iter().zip(&self.axes).skip(1) {
            add_scaled(&mut p, x, in_space(axis));
        }
        p
    }
}

/// How the coordinates of a ring become world coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct RingScale<const N: usize> {
    /// The axes of the frame, the height with its factor zeta.
    pub(super) axes: [[f64; N]; N],
    pub(super) zeta: f64,
    /// lambda^l, the factor of positions.
    pub(super) sigma: f64,
    /// The factors of first and second derivatives by a and b. The ring's own parameters run
    /// sigma^-l times as fast as a and b.
    pub(super) first: f64,
    pub(super) second: f64,
}

impl<const N: usize> RingScale<N> {
    /// factor (X, Y, zeta Z) in world coordinates.
    #[inline(always)]
    pub(super) fn world(&self, factor: f64, r: [f64; N]) -> [f64; N] {
        let mut world = [0.0; N];
        for (k, x) in world.iter_mut().enumerate() {
            let mut sum = r[0] * self.axes[0][k];
            for (y, axis) in r.iter().zip(&self.axes).skip(1) {
                sum += y * axis[k];
            }
            *x = factor * sum;
        }
        world
    }
}

/// Unit normal, Gauss and mean curvature of the map sigma (X, Y, zeta Z), whose jet is given
/// without the factors.
///
/// With r = (X, Y, zeta Z), w = |r_u x r_v| and the determinants D_uu = det(X_u, X_v, X_uu) of the
/// unscaled coordinates,
///
/// ```text
/// K = (zeta/sigma)^2 (D_uu D_vv - D_uv^2) / w^4,
/// H = (zeta/sigma) (E D_vv - 2 F D_uv + G D_uu) / (2 w^3),   E, F, G of r.
/// ```
///
/// Nothing in it becomes small when sigma = zeta does.
pub(super) fn frame_shape<const N: usize>(jet: &Jet<N>, sigma: f64, zeta: f64) -> Shape {
    let flat = |r: Vector| [r[0], r[1], zeta * r[2]];
    let [du, dv] = [jet.du, jet.dv].map(in_space);
    let volume = cross(du, dv);
    let determinants = [jet.duu, jet.duv, jet.dvv].map(|r| dot(volume, in_space(r)));
    let shape = Shape::new(flat(du), flat(dv), determinants);
    let ratio = if zeta == sigma { 1.0 } else { zeta / sigma };
    Shape { gauss: ratio * ratio * shape.gauss, mean: ratio * shape.mean, ..shape }
}
