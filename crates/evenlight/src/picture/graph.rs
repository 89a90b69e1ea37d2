//! Graphs of eigenfunctions over the plane of the characteristic map.
//!
//! ```text
//!        z = f            a panel for each function, all seen from one direction; the ring l is
//!      __/\__             lambda^l as large, and rings are drawn until they are smaller than
//!     /      \            a pixel
//!    +---x,y--+           red above zero, blue below, every other ring a little darker
//! ```

use super::camera::{Camera, View};
use super::canvas::Picture;
use super::color::{Light, diverging, from_srgb, mix, to_srgb};
use super::shade::studio;
use super::{MAX_SAMPLES, MAX_SIDE, PictureError, annotate, panel_grid};
use crate::basis::{Eigenfunctions, HomogeneousGuide, Parity};
use crate::pairs::pairs;
use crate::patch::Patch;
use crate::point::{Point, Vector, cross, dot, scale, sub};
use crate::task::map_indexed;

/// The height of a graph over the plane, in radii of the plane.
const HEIGHT: f64 = 0.5;

/// Cells along a patch of ring 0, and at least.
const CELLS: [usize; 2] = [40, 4];

/// The light of odd rings, of even ones being 1.
const ODD_RING: f64 = 0.82;

/// How pictures of eigenfunctions are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct GraphOptions {
    /// Width and height of the whole picture in pixels, 1 to [`MAX_SIDE`] each.
    pub size: [usize; 2],
    /// The direction of view; the plane is level, and line -1 of the point runs to the right.
    pub view: View,
    /// Samples per pixel in either direction, 1 to [`MAX_SAMPLES`].
    pub samples: usize,
}

impl Default for GraphOptions {
    /// 1200 x 900 pixels, from above at 35 degrees with room for the names, 3 x 3 samples.
    fn default() -> Self {
        let view = View { azimuth: 15.0, elevation: 35.0, zoom: 0.85, target: None };
        Self { size: [1200, 900], view, samples: 3 }
    }
}

/// Draws the graphs of the eigenfunctions numbered `which`, each scaled to the same height and
/// named by its eigenvalue, mode and parity.
///
/// # Errors
///
/// If an option is out of range, there are no functions, or too many for the size, or there is no
/// function of a number.
pub fn eigenfunctions(
    functions: &Eigenfunctions,
    which: &[usize],
    options: &GraphOptions,
) -> Result<Picture, PictureError> {
    let &GraphOptions { size: [width, height], samples, .. } = options;
    if ![width, height].iter().all(|side| (1..=MAX_SIDE).contains(side)) {
        return Err(PictureError::Size { width, height });
    }
    let rules = [
        (options.view.is_valid(), "view", "finite, with a zoom above 0"),
        ((1..=MAX_SAMPLES).contains(&samples), "samples", "1 to 8"),
    ];
    if let Some((_, option, allowed)) = rules.into_iter().find(|(valid, ..)| !valid) {
        return Err(PictureError::Option { option, allowed });
    }
    let count = functions.len();
    if let Some(&number) = which.iter().find(|&&k| k >= count) {
        return Err(PictureError::Function { number, count });
    }
    let too_many = PictureError::Panels { panels: which.len(), width };
    let (columns, size) = panel_grid(which.len(), [width, height]).ok_or(too_many)?;
    let background = |y: usize| {
        let [top, foot] = [from_srgb([250, 251, 253]), from_srgb([226, 231, 238])];
        mix(top, foot, (y as f64 + 0.5) / height as f64)
    };
    let mut picture = Picture::new(options.size, background);
    let panels =
        map_indexed(which.len(), |k| Graph::new(functions, which[k], options, size).draw());
    for (k, pixels) in panels.into_iter().enumerate() {
        let origin = [k % columns * size[0], k / columns * size[1]];
        for (at, (light, cover)) in pixels.into_iter().enumerate() {
            let [x, y] = [origin[0] + at % size[0], origin[1] + at / size[0]];
            if cover > 0.0 {
                picture.set(x, y, to_srgb(mix(background(y), light, cover)));
            }
        }
        let scale = (width.min(height) / 900).max(1);
        annotate(
            &mut picture,
            origin,
            size,
            &functions.guide(which[k]).map_or_else(String::new, name),
            false,
            scale,
        );
    }
    Ok(picture)
}

/// As lambda^3, m = 2 even.
fn name(guide: &HomogeneousGuide) -> String {
    let parity = match guide.parity() {
        Parity::Even => "even",
        Parity::Odd => "odd",
    };
    format!("lambda^{} m={} {parity}", guide.degree(), guide.mode())
}

/// One panel.
struct Graph {
    camera: Camera,
    size: [usize; 2],
    samples: usize,
    /// The largest height.
    height: f64,
    /// The patches (x, y, z), with the ring of each.
    patches: Vec<(usize, Patch)>,
}

/// A vertex: in samples from the left and the top and towards the eye; its normal in the picture;
/// its height, from -1 to 1.
type GraphVertex = (Vector, Vector, f64);

impl Graph {
    fn new(functions: &Eigenfunctions, k: usize, options: &GraphOptions, size: [usize; 2]) -> Self {
        let n = functions.valence();
        let half = std::f64::consts::PI / n as f64;
        // Functions 1 and 2 have the diagonal of sector 0 as x axis.
        let (sin, cos) = half.sin_cos();
        let coefs = |k: usize, (ring, s, which): (usize, usize, usize)| {
            functions.coefs_on(k, ring, s, which)
        };
        let per_sector = functions.patches_per_sector();
        let ring_of = |ring: usize| {
            (0..n * per_sector).map(move |at| (ring, at / per_sector, at % per_sector))
        };
        let largest = |k: usize| {
            let all = ring_of(0).flat_map(|at| coefs(k, at));
            all.fold(0.0, |m: f64, x| m.max(x.abs()))
        };
        let radius = largest(1).max(largest(2));
        let height = HEIGHT * radius / largest(k);
        let patch = |at: (usize, usize, usize)| {
            let [x, y, z] = [1, 2, k].map(|k| coefs(k, at));
            let points = x.iter().zip(&y).zip(&z);
            let place = |((x, y), z): ((&f64, &f64), &f64)| {
                [cos * x - sin * y, sin * x + cos * y, height * z]
            };
            (at.0, Patch::of([functions.degree(); 2], points.map(place).collect()))
        };
        let outer: Vec<Point> = ring_of(0).map(patch).flat_map(|p| p.1.coefs().to_vec()).collect();
        let top = HEIGHT * radius;
        let extent: Vec<Point> =
            outer.iter().flat_map(|p| [[p[0], p[1], -top], [p[0], p[1], top]]).collect();
        let camera = Camera::fit(&options.view, &extent, size).resized(options.samples as f64);
        let mut rings = 1;
        while radius * camera.scale * functions.lambda().powi(rings) > 1.0 && rings < 40 {
            rings += 1;
        }
        let patches = (0..rings as usize).flat_map(ring_of).map(patch).collect();
        Self { camera, size, samples: options.samples, height: top, patches }
    }

    /// The light of every pixel and how much of it is covered.
    fn draw(&self) -> Vec<(Light, f64)> {
        let width = self.size[0] * self.samples;
        let mut buffer: Vec<Option<(f64, Light)>> = vec![None; width * self.size[1] * self.samples];
        for (ring, patch) in &self.patches {
            let cells = (CELLS[0] >> ring).max(CELLS[1]);
            let corner =
                |i: usize, j: usize| self.corner(patch, [i, j].map(|k| k as f64 / cells as f64));
            let corners: Vec<Vec<GraphVertex>> =
                (0..=cells).map(|i| (0..=cells).map(|j| corner(i, j)).collect()).collect();
            let darker = if ring % 2 == 1 { ODD_RING } else { 1.0 };
            for (i, j) in pairs(cells, cells) {
                let [a, b] = [corners[i][j], corners[i + 1][j + 1]];
                for c in [corners[i + 1][j], corners[i][j + 1]] {
                    self.cover(&mut buffer, [a, b, c], darker);
                }
            }
        }
        let pixels = (0..self.size[0] * self.size[1]).map(|at| {
            let [x, y] = [at % self.size[0], at / self.size[0]].map(|k| k * self.samples);
            let places = (0..self.samples * self.samples)
                .map(|k| (y + k / self.samples) * width + x + k % self.samples);
            mean(places.filter_map(|place| buffer[place]).map(|(_, light)| light), self.samples)
        });
        pixels.collect()
    }

    fn corner(&self, patch: &Patch, [u, v]: [f64; 2]) -> GraphVertex {
        let jet = patch.jet(u, v);
        let p = self.camera.project(jet.p);
        let normal = self.camera.turned(cross(jet.du, jet.dv));
        (p, scale(1.0 / dot(normal, normal).sqrt(), normal), jet.p[2])
    }

    /// Enters a triangle into the depth buffer.
    fn cover(&self, buffer: &mut [Option<(f64, Light)>], corners: [GraphVertex; 3], darker: f64) {
        let [a, b, c] = corners.map(|corner| corner.0);
        let (ab, ac) = (sub(b, a), sub(c, a));
        let area = ab[0] * ac[1] - ab[1] * ac[0];
        if area == 0.0 {
            return;
        }
        let sides = self.size.map(|side| side * self.samples);
        let range = |k: usize| {
            let (low, high) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
            let end = sides[k] as f64;
            (low - 0.5).ceil().clamp(0.0, end) as usize
                ..(high + 0.5).floor().clamp(0.0, end) as usize
        };
        for (y, x) in range(1).flat_map(|y| range(0).map(move |x| (y, x))) {
            let p = [x as f64 + 0.5 - a[0], y as f64 + 0.5 - a[1]];
            let s = (p[0] * ac[1] - p[1] * ac[0]) / area;
            let t = (ab[0] * p[1] - ab[1] * p[0]) / area;
            let weights = [1.0 - s - t, s, t];
            if weights.iter().any(|&w| w < -1e-9) {
                continue;
            }
            let mixed = |of: &dyn Fn(&GraphVertex) -> f64| -> f64 {
                weights.iter().zip(&corners).map(|(w, corner)| w * of(corner)).sum()
            };
            let depth = mixed(&|corner| corner.0[2]);
            let place = &mut buffer[y * sides[0] + x];
            if place.is_none_or(|(other, _)| depth > other) {
                let normal = [0, 1, 2].map(|k| mixed(&|corner| corner.1[k]));
                let color = self.color(mixed(&|corner| corner.2), normal);
                *place = Some((depth, scale(darker, color)));
            }
        }
    }

    /// The light of a point at height z with this normal in the picture.
    fn color(&self, z: f64, normal: Vector) -> Light {
        let toward = if normal[2] < 0.0 { -1.0 } else { 1.0 };
        let normal = scale(toward / dot(normal, normal).sqrt(), normal);
        studio(scale(0.85, diverging(z / self.height)), normal)
    }
}

/// The mean light, and the part of the pixel's samples that there are.
fn mean(lights: impl Iterator<Item = Light>, samples: usize) -> (Light, f64) {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for light in lights {
        sum = std::array::from_fn(|k| sum[k] + light[k]);
        count += 1.0;
    }
    (scale(1.0 / f64::max(count, 1.0), sum), count / (samples * samples) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SchemeKind;

    #[test]
    fn even_functions_have_symmetric_graphs() {
        let functions = Eigenfunctions::new(SchemeKind::Guided5, 5).expect("there are rules");
        // From above, the diagonal of sector 0 upright.
        let view = View { azimuth: 36.0 - 90.0, elevation: 90.0, ..View::default() };
        let options = GraphOptions { size: [120, 120], view, samples: 2 };
        let k = functions.of_degree(4).start + 1;
        let picture = eigenfunctions(&functions, &[k], &options).expect("the options are good");
        let pixel = |x: usize, y: usize| picture.pixel(x, y).expect("it is inside");
        let differing = (0..60).flat_map(|x| (40..120).map(move |y| (x, y))).filter(|&(x, y)| {
            let [a, b] = [pixel(x, y), pixel(119 - x, y)];
            // The lamps are not symmetric: blue against red is what counts.
            let warmth = |p: [u8; 3]| i32::from(p[0]) - i32::from(p[2]);
            (warmth(a) - warmth(b)).abs() > 60
        });
        assert!(differing.count() < 100);
    }

    #[test]
    fn faults_are_named() {
        let functions = Eigenfunctions::new(SchemeKind::Guided5, 5).expect("there are rules");
        let draw = |which: &[usize], size, samples| {
            let options = GraphOptions { size, samples, ..GraphOptions::default() };
            eigenfunctions(&functions, which, &options).map(|_| ())
        };
        let panels = |panels| Err(PictureError::Panels { panels, width: 2 });
        assert_eq!(draw(&[], [2, 2], 1), panels(0));
        assert_eq!(draw(&[1; 9], [2, 2], 1), panels(9));
        assert_eq!(draw(&[1], [0, 2], 1), Err(PictureError::Size { width: 0, height: 2 }));
        assert!(matches!(draw(&[1], [2, 2], 9), Err(PictureError::Option { .. })));
        let none = PictureError::Function { number: 96, count: 96 };
        assert_eq!(draw(&[1, 96], [20, 20], 1), Err(none));
    }
}
