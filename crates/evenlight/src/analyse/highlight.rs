//! Highlight lines: stripes on a surface that show how its normal turns.
//!
//! Long parallel light tubes hang over the surface; a point belongs to the highlight line of
//! the tube that its normal points at (\[BC94\]). Here the tubes lie infinitely far away, as
//! dark and light stripes of equal angle about their common direction `axis`, and the eye is
//! at infinity too, so that neither distorts the stripes and only the normal n counts:
//!
//! ```text
//!  seen along the axis                angle(n) = atan2(n . side, n . toward)
//!
//!              toward (to the eye)    side = axis x toward, to the right of an eye
//!    dark  \ light | light /  dark         for which the axis points up
//!           \      |      /
//!            \     |  n  /            dark stripe number k, k any integer, lies where
//!      light  \    | /  /  light      | angle stripes / pi - k - 1/2 | < 1/4
//!              \   |/  /
//!  ----------------o---------------- side
//! ```
//!
//! The angle is a smooth function of every normal that the eye sees, so the stripes have one
//! continuity less than the surface: a kink of the surface tears them, a join with continuous
//! normal (G1) gives them a corner at most, one with continuous curvature (G2) leaves them
//! smooth. Where they pinch, the normal turns quickly. On a plane the angle is constant; on
//! a cylinder the stripes follow its straight lines.

use std::f64::consts::PI;

use crate::patch::Jet;
use crate::point::{Vector, add, cross, dot, norm, scale, sub, unit};

/// Parallel light tubes at infinity, seen from infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HighlightLines {
    toward: Vector,
    side: Vector,
    stripes: usize,
}

impl HighlightLines {
    /// Tubes parallel to `axis` for an eye in the direction `toward`, with `stripes` dark
    /// stripes over the half turn that the eye can see.
    ///
    /// Both vectors may have any length but zero. Only the part of `axis` perpendicular to
    /// `toward` counts; if there is none, some perpendicular direction is taken.
    pub fn new(axis: Vector, toward: Vector, stripes: usize) -> Self {
        let toward = unit(toward);
        let side = cross(unit(axis), toward);
        let side = if norm(side) > 1e-9 { unit(side) } else { any_perpendicular(toward) };
        Self { toward, side, stripes }
    }

    /// The number of dark stripes over the half turn.
    pub fn stripes(&self) -> usize {
        self.stripes
    }

    /// The angle of `normal` about the axis, in (-pi, pi] and between -pi/2 and pi/2 for
    /// normals that face the eye. The length of `normal` does not matter.
    ///
    /// ```
    /// use evenlight::analyse::highlight::HighlightLines;
    ///
    /// // Tubes along z, seen against the y axis: a normal half way to the right.
    /// let lines = HighlightLines::new([0., 0., 1.], [0., -1., 0.], 24);
    /// assert_eq!(lines.angle([1., -1., 5.]), std::f64::consts::FRAC_PI_4);
    /// ```
    pub fn angle(&self, normal: Vector) -> f64 {
        dot(normal, self.side).atan2(dot(normal, self.toward))
    }

    /// The derivatives of the angle of the surface normal in u and v; not finite where the
    /// surface has no normal or the normal is parallel to the axis.
    pub fn gradient(&self, jet: &Jet) -> [f64; 2] {
        let area = cross(jet.du, jet.dv);
        let (s, t) = (dot(area, self.side), dot(area, self.toward));
        area_derivatives(jet)
            .map(|d| (t * dot(d, self.side) - s * dot(d, self.toward)) / (s * s + t * t))
    }

    /// How much light comes from the tubes within `angle` - `width`/2 to `angle` + `width`/2:
    /// 0 if all of them are dark, 1 if all are light.
    ///
    /// With `width` the change of the angle over a pixel this is the exact mean over the
    /// pixel, and hence free of jagged edges and moire. Normals n and -n look alike. If
    /// `angle` or `width` is not finite the answer is that of a pixel with many stripes, 1/2.
    pub fn brightness(&self, angle: f64, width: f64) -> f64 {
        let turns = self.stripes as f64 / PI;
        let (middle, half) = (angle * turns, 0.5 * (width.abs() * turns).max(1e-9));
        if !middle.is_finite() || half > 1e6 {
            return 0.5;
        }
        let light = light_up_to(middle + half) - light_up_to(middle - half);
        (light / (2.0 * half)).clamp(0.0, 1.0)
    }
}

/// The derivatives of du x dv in u and v.
fn area_derivatives(jet: &Jet) -> [Vector; 2] {
    [
        add(cross(jet.duu, jet.dv), cross(jet.du, jet.duv)),
        add(cross(jet.duv, jet.dv), cross(jet.du, jet.dvv)),
    ]
}

/// The integral from 0 to `t` of the wave of period 1 that is 1 within 1/4 of every integer and
/// 0 elsewhere.
fn light_up_to(t: f64) -> f64 {
    let part = t - t.floor();
    0.5 * t.floor() + part.min(0.25) + (part - 0.75).max(0.0)
}

/// A unit vector perpendicular to the unit vector `a`.
fn any_perpendicular(a: Vector) -> Vector {
    let e = if a[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    unit(sub(e, scale(dot(e, a), a)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Vector = [0.0, 0.0, 1.0];
    const FRONT: Vector = [0.0, -1.0, 0.0];

    /// The jet at (u,v) of the cylinder (r sin u, -r cos u, v), whose axis is z; the front is
    /// at u = 0.
    fn cylinder(r: f64, u: f64, v: f64) -> Jet {
        let (s, c) = u.sin_cos();
        Jet {
            p: [r * s, -r * c, v],
            du: [r * c, r * s, 0.0],
            dv: [0.0, 0.0, 1.0],
            duu: [-r * s, r * c, 0.0],
            ..Jet::default()
        }
    }

    #[test]
    fn a_plane_has_one_angle() {
        let lines = HighlightLines::new([0.3, 0.1, 0.9], [1.0, -2.0, 0.5], 24);
        let plane = |u: f64, v: f64| Jet {
            p: [u + v, u - v, 0.3 * u],
            du: [1.0, 1.0, 0.3],
            dv: [1.0, -1.0, 0.0],
            ..Jet::default()
        };
        let angle = lines.angle(plane(0.0, 0.0).normal());
        for (u, v) in [(0.5, 0.1), (0.9, 0.9), (-3.0, 7.0)] {
            assert_eq!(lines.angle(plane(u, v).normal()), angle);
            assert_eq!(lines.gradient(&plane(u, v)), [0.0, 0.0]);
        }
    }

    /// The stripes of a cylinder along the lights are its straight lines, at equal angles.
    #[test]
    fn stripes_follow_the_lines_of_a_cylinder() {
        let lines = HighlightLines::new(UP, FRONT, 12);
        for u in [-1.5, -0.7, 0.0, 0.2, 1.5] {
            for v in [0.0, 0.4, 8.0] {
                let jet = cylinder(2.5, u, v);
                assert!((lines.angle(jet.normal()) - u).abs() < 1e-14);
                let [du, dv] = lines.gradient(&jet);
                assert!((du - 1.0).abs() < 1e-14 && dv.abs() < 1e-14);
            }
        }
    }

    #[test]
    fn gradient_is_the_derivative_of_the_angle() {
        // The paraboloid (u, v, u^2 + u v - v^2/2).
        let paraboloid = |u: f64, v: f64| Jet {
            p: [u, v, u * u + u * v - 0.5 * v * v],
            du: [1.0, 0.0, 2.0 * u + v],
            dv: [0.0, 1.0, u - v],
            duu: [0.0, 0.0, 2.0],
            duv: [0.0, 0.0, 1.0],
            dvv: [0.0, 0.0, -1.0],
        };
        let lines = HighlightLines::new([1.0, 0.5, 0.2], [0.1, 0.4, 1.0], 24);
        let angle = |u, v| lines.angle(paraboloid(u, v).normal());
        let (u, v, h) = (0.3, -0.2, 1e-5);
        let [du, dv] = lines.gradient(&paraboloid(u, v));
        assert!((du - (angle(u + h, v) - angle(u - h, v)) / (2.0 * h)).abs() < 1e-9);
        assert!((dv - (angle(u, v + h) - angle(u, v - h)) / (2.0 * h)).abs() < 1e-9);
    }

    #[test]
    fn half_of_the_light_is_dark_and_the_front_is_light() {
        let lines = HighlightLines::new(UP, FRONT, 24);
        let period = PI / 24.0;
        assert!((lines.brightness(0.0, 0.1 * period) - 1.0).abs() < 1e-12);
        assert!(lines.brightness(0.5 * period, 0.1 * period).abs() < 1e-12);
        assert!((lines.brightness(0.25 * period, 0.1 * period) - 0.5).abs() < 1e-12);
        assert!((lines.brightness(0.1, period) - 0.5).abs() < 1e-12);
        assert_eq!(lines.brightness(0.1, f64::INFINITY), 0.5);
        assert_eq!(lines.brightness(f64::NAN, 0.0), 0.5);
    }

    /// The mean over neighbouring intervals is the mean over their union.
    #[test]
    fn brightness_is_additive() {
        let lines = HighlightLines::new(UP, FRONT, 7);
        for (angle, width) in [(0.0, 0.3), (1.0, 0.01), (-1.2, 2.0), (0.33, 0.1)] {
            let quarter = 0.25 * width;
            let left = lines.brightness(angle - quarter, 2.0 * quarter);
            let right = lines.brightness(angle + quarter, 2.0 * quarter);
            assert!((0.5 * (left + right) - lines.brightness(angle, width)).abs() < 1e-12);
        }
    }

    #[test]
    fn both_sides_of_a_surface_look_alike() {
        let lines = HighlightLines::new([0.2, 0.1, 1.0], FRONT, 24);
        for n in [[0.3, -0.8, 0.1], [-0.5, -0.2, 0.9], [0.9, 0.3, 0.0]] {
            let (front, back) = (lines.angle(n), lines.angle(scale(-1.0, n)));
            assert!((lines.brightness(front, 0.02) - lines.brightness(back, 0.02)).abs() < 1e-9);
        }
    }

    #[test]
    fn an_axis_toward_the_eye_still_gives_stripes() {
        let lines = HighlightLines::new([0.0, 0.0, 2.0], [0.0, 0.0, 1.0], 24);
        assert!(lines.angle([0.3, 0.4, 0.8]).is_finite());
    }
}
