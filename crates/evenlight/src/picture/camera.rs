//! Where a surface is seen from, and how it is projected.
//!
//! The eye is at infinity (orthographic projection): parallel lines stay parallel and lengths
//! can be compared anywhere in the picture.
//!
//! ```text
//!   z up                           azimuth 0: the front view, x to the right
//!   |    eye o                     azimuth 90: from the side, the eye on the x axis
//!   |      /  ) elevation          elevation 90: from above, x to the right at azimuth 0
//!   |    /------> azimuth,
//!   |  /          counter-clockwise from above
//!   o---------- y
//! ```

use crate::point::{Point, Vector, add, cross, dot, scale, sub};
use crate::surface::Surface;

/// The part of the picture that the surface may fill.
const FILL: f64 = 0.9;

/// A direction of view, what is in the middle, and how large it is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The direction of the eye about the z axis in degrees: 0 is the front view, against the
    /// y axis with x to the right; 90 puts the eye on the x axis.
    pub azimuth: f64,
    /// The height of the eye over the xy plane in degrees: 90 looks straight down.
    pub elevation: f64,
    /// The magnification; 1 shows the whole surface.
    pub zoom: f64,
    /// The point in the middle of the picture; `None` for the middle of the surface.
    pub target: Option<Point>,
}

impl Default for View {
    /// From the right and above: azimuth 30, elevation 25, the whole surface.
    fn default() -> Self {
        Self { azimuth: 30.0, elevation: 25.0, zoom: 1.0, target: None }
    }
}

impl View {
    /// The view along the limit normal of extraordinary point number `point` of `surface`, with
    /// that point in the middle, at zoom 1; `None` if there is no such point or its normal is
    /// not defined.
    pub fn toward(surface: &Surface, point: usize) -> Option<Self> {
        let rings = surface.rings(point)?;
        let [x, y, z] = rings.normal();
        // Looking straight down, the front of the surface is at the bottom of the picture.
        let azimuth = if x.hypot(y) < 1e-9 { 0.0 } else { x.atan2(-y).to_degrees() };
        let elevation = z.clamp(-1.0, 1.0).asin().to_degrees();
        let view = Self { azimuth, elevation, zoom: 1.0, target: Some(rings.center()) };
        view.is_valid().then_some(view)
    }

    /// Whether all numbers are finite and the zoom is positive.
    pub(super) fn is_valid(&self) -> bool {
        let target = self.target.unwrap_or_default();
        [self.azimuth, self.elevation].iter().chain(&target).all(|x| x.is_finite())
            && self.zoom.is_finite()
            && self.zoom > 0.0
    }
}

/// An orthographic projection to the pixels of a panel.
#[derive(Clone, Debug)]
pub(super) struct Camera {
    /// To the right in the picture.
    pub right: Vector,
    /// Upwards in the picture.
    pub up: Vector,
    /// From the surface to the eye.
    pub toward: Vector,
    /// The point in the middle of the panel.
    pub center: Point,
    /// Pixels per unit of length.
    pub scale: f64,
    /// The size of the panel in pixels.
    pub size: [usize; 2],
}

/// Pixels per length of the largest coordinate at which rounding (1e-16 of it) is still far below
/// a pixel. Closer, or where a whole surface is no larger than rounding, a picture would show
/// noise, and cutting it into flat cells would not end.
const FINEST_SCALE: f64 = 1e13;

impl Camera {
    /// The camera of `view` for a panel of `size` pixels, such that `points` fill the panel at
    /// zoom 1.
    pub fn fit(view: &View, points: &[Point], size: [usize; 2]) -> Self {
        let mut camera = Self::directed(view, size);
        let Some([low, high]) = camera.bounds(points) else { return camera };
        let middle: Vector = std::array::from_fn(|k| 0.5 * low[k] + 0.5 * high[k]);
        camera.center = view.target.unwrap_or_else(|| camera.unturned(middle));
        let ratio = |k: usize| FILL * size[k] as f64 / (high[k] - low[k]);
        let fitted = ratio(0).min(ratio(1));
        camera.scale = if fitted.is_finite() { view.zoom * fitted } else { view.zoom };
        let largest = low.iter().chain(&high).fold(0.0_f64, |m, x| m.max(x.abs()));
        if largest > 0.0 {
            camera.scale = camera.scale.min(FINEST_SCALE / largest);
        }
        camera
    }

    /// The directions of `view`, with the origin in the middle and pixels of length 1.
    fn directed(view: &View, size: [usize; 2]) -> Self {
        let (sin_a, cos_a) = view.azimuth.to_radians().sin_cos();
        let (sin_e, cos_e) = view.elevation.to_radians().sin_cos();
        let toward = [cos_e * sin_a, -cos_e * cos_a, sin_e];
        let right = [cos_a, sin_a, 0.0];
        let center = view.target.unwrap_or_default();
        Self { right, up: cross(toward, right), toward, center, scale: 1.0, size }
    }

    /// The extent of the finite ones of `points` along right and up; `None` if there are none.
    fn bounds(&self, points: &[Point]) -> Option<[Vector; 2]> {
        let turned =
            points.iter().map(|&p| self.turned(p)).filter(|p| p.iter().all(|x| x.is_finite()));
        turned.fold(None, |bounds, p| {
            let [low, high] = bounds.unwrap_or([p, p]);
            Some([
                std::array::from_fn(|k| p[k].min(low[k])),
                std::array::from_fn(|k| p[k].max(high[k])),
            ])
        })
    }

    /// The same picture on a panel `factor` times as large.
    pub fn resized(&self, factor: f64) -> Self {
        let size = self.size.map(|pixels| ((pixels as f64 * factor).round() as usize).max(1));
        Self { scale: self.scale * factor, size, ..self.clone() }
    }

    /// A vector along right, up and to the eye, at its own length.
    pub fn turned(&self, v: Vector) -> Vector {
        [dot(v, self.right), dot(v, self.up), dot(v, self.toward)]
    }

    /// The vector for which [`Camera::turned`] is `v`.
    pub fn unturned(&self, v: Vector) -> Vector {
        add(add(scale(v[0], self.right), scale(v[1], self.up)), scale(v[2], self.toward))
    }

    /// The position in pixels: from the left, from the top, and towards the eye.
    pub fn project(&self, p: Point) -> Vector {
        let [x, y, depth] = self.turned_to_pixels(sub(p, self.center));
        [0.5 * self.size[0] as f64 + x, 0.5 * self.size[1] as f64 + y, depth]
    }

    /// A vector in pixels: to the right, downwards, and towards the eye.
    pub fn turned_to_pixels(&self, v: Vector) -> Vector {
        let [x, y, depth] = self.turned(v);
        [self.scale * x, -self.scale * y, self.scale * depth]
    }

    /// The length of half the smaller side of the panel, in units of the surface.
    pub fn half_extent(&self) -> f64 {
        0.5 * self.size[0].min(self.size[1]) as f64 / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(azimuth: f64, elevation: f64) -> View {
        View { azimuth, elevation, ..View::default() }
    }

    fn close(a: Vector, b: Vector) -> bool {
        (0..3).all(|k| (a[k] - b[k]).abs() < 1e-12)
    }

    #[test]
    fn directions_are_a_right_handed_frame() {
        for (azimuth, elevation) in [(0.0, 0.0), (30.0, 25.0), (-120.0, 90.0), (400.0, -70.0)] {
            let camera = Camera::directed(&view(azimuth, elevation), [100, 100]);
            assert!(close(cross(camera.right, camera.up), camera.toward));
            for axis in [camera.right, camera.up, camera.toward] {
                assert!((dot(axis, axis) - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn front_side_and_top_views_are_as_documented() {
        let axes = |azimuth, elevation| {
            let camera = Camera::directed(&view(azimuth, elevation), [1, 1]);
            [camera.right, camera.up, camera.toward]
        };
        let (x, y, z) = ([1., 0., 0.], [0., 1., 0.], [0., 0., 1.]);
        let expected = [[x, z, [0., -1., 0.]], [y, z, x], [x, y, z]];
        for (found, expected) in
            [axes(0.0, 0.0), axes(90.0, 0.0), axes(0.0, 90.0)].iter().zip(expected)
        {
            assert!((0..3).all(|k| close(found[k], expected[k])), "{found:?}");
        }
    }

    #[test]
    fn projection_can_be_undone() {
        let points = [[0.0, 0.0, 0.0], [3.0, 1.0, -2.0], [-1.0, 5.0, 0.5]];
        let camera = Camera::fit(&view(77.0, -12.0), &points, [640, 480]);
        for p in points {
            let [x, y, depth] = camera.project(p);
            let turned = [x - 320.0, 240.0 - y, depth].map(|pixels| pixels / camera.scale);
            assert!(close(add(camera.center, camera.unturned(turned)), p));
        }
    }

    #[test]
    fn the_points_fill_the_panel_and_no_more() {
        let points = [[0.0, 0.0, 0.0], [3.0, 1.0, -2.0], [-1.0, 5.0, 0.5]];
        let camera = Camera::fit(&View::default(), &points, [600, 300]);
        let heights = points.map(|p| camera.project(p)[1]);
        let (low, high) =
            heights.iter().fold((f64::MAX, f64::MIN), |(a, b), &y| (a.min(y), b.max(y)));
        let widths = points.map(|p| camera.project(p)[0]);
        assert!(widths.iter().all(|&x| (0.0..=600.0).contains(&x)));
        assert!((low - 15.0).abs() < 1e-9 && (high - 285.0).abs() < 1e-9, "{low} to {high}");
    }

    #[test]
    fn the_target_is_in_the_middle_and_zoom_magnifies() {
        let points = [[0.0; 3], [2.0, 2.0, 2.0]];
        let whole = Camera::fit(&View::default(), &points, [200, 100]);
        let target = Some([0.5, 0.25, 1.0]);
        let near = View { zoom: 8.0, target, ..View::default() };
        let camera = Camera::fit(&near, &points, [200, 100]);
        assert!(close(camera.project([0.5, 0.25, 1.0]), [100.0, 50.0, 0.0]));
        assert!((camera.scale / whole.scale - 8.0).abs() < 1e-12);
    }

    #[test]
    fn no_points_and_equal_points_give_a_camera() {
        for points in [&[][..], &[[1.0, 2.0, 3.0]; 2], &[[f64::NAN; 3]]] {
            let camera = Camera::fit(&View::default(), points, [10, 10]);
            assert!(camera.scale.is_finite() && camera.scale > 0.0);
        }
    }

    #[test]
    fn what_is_no_larger_than_rounding_stays_small() {
        let points = [[1.0, 2.0, 3.0], [1.0 + 2e-16, 2.0, 3.0]];
        let camera = Camera::fit(&View::default(), &points, [1000, 1000]);
        assert!(camera.scale * 2e-16 < 0.01);
    }
}
