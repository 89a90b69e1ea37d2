//! The colour of a surface point in each style.
//!
//! The lamps move with the camera, so that every view is lit well:
//!
//! ```text
//!        key o                       key: warm, from the left above the eye
//!             \      . rim           fill: cool and weak, from the right
//!              \   .                 rim: from behind and above, along the outline
//!         eye ->  (surface)          sky and ground: light from everywhere
//!                /
//!         fill o
//! ```

use super::Style;
use super::camera::Camera;
use super::color::{Light, diverging, from_srgb, mix};
use super::raster::{Seen, length, parameter_gradients};
use crate::analyse::highlight::HighlightLines;
use crate::point::{Vector, dot, scale, unit};
use crate::surface::{PatchPlace, Role, Surface};

/// The colour of the material in style `Shaded`.
const CLAY: [u8; 3] = [142, 157, 178];

/// The colours of style `Patches`: regular patches, odd rings, even rings.
const REGULAR: [u8; 3] = [134, 190, 132];
const ODD_RING: [u8; 3] = [240, 190, 84];
const EVEN_RING: [u8; 3] = [212, 98, 78];
const CAP: [u8; 3] = [120, 130, 210];
const BORDER: [u8; 3] = [38, 44, 52];

/// The width of patch borders in pixels, and the size of patches (in pixels) below which they
/// fade, lest small rings become one black spot.
const BORDER_WIDTH: f64 = 1.2;
const FADE_BELOW: f64 = 9.0;

/// Colours the points that a camera sees.
#[derive(Debug)]
pub(super) struct Painter<'a> {
    camera: &'a Camera,
    coat: Coat<'a>,
    /// The distance between samples in pixels.
    spacing: f64,
}

/// What the surface is painted with.
#[derive(Debug)]
pub(super) enum Coat<'a> {
    /// One material.
    Clay,
    /// Highlight lines.
    Stripes(HighlightLines),
    /// The curvature that the style names, the value `range` being the end of the colour map.
    Curvature(Style, f64),
    /// The patches of this surface.
    Patches(&'a Surface),
}

impl<'a> Painter<'a> {
    /// Paints `coat` as seen by `camera` with `samples` x `samples` samples per pixel.
    pub fn new(camera: &'a Camera, coat: Coat<'a>, samples: usize) -> Self {
        Self { camera, coat, spacing: 1.0 / samples as f64 }
    }

    /// The light that comes from a visible point.
    pub fn color(&self, seen: &Seen) -> Light {
        let n = self.facing_normal(seen);
        match &self.coat {
            Coat::Clay => studio(from_srgb(CLAY), n),
            Coat::Stripes(lines) => self.stripe(lines, seen, n),
            Coat::Curvature(style, range) => {
                let value = curvature(*style, seen).unwrap_or(f64::NAN);
                dimmed(diverging(value / range), 0.30, n)
            }
            Coat::Patches(surface) => self.patch(surface, seen, n),
        }
    }

    /// The normal of the side that the eye sees, along right, up and to the eye.
    fn facing_normal(&self, seen: &Seen) -> Vector {
        let n = self.camera.turned(seen.point.normal);
        match n[2].partial_cmp(&0.0) {
            None => [0.0, 0.0, 1.0],
            Some(std::cmp::Ordering::Less) => scale(-1.0, n),
            Some(_) => n,
        }
    }

    fn stripe(&self, lines: &HighlightLines, seen: &Seen, n: Vector) -> Light {
        let width = self.spacing * self.change_per_pixel(lines.gradient(&seen.point.jet), seen);
        let brightness = lines.brightness(lines.angle(seen.point.normal), width);
        dimmed(mix([0.012, 0.013, 0.016], [0.93; 3], brightness), 0.45, n)
    }

    /// The length of the gradient over the picture of a function with derivatives `d` in (u,v).
    fn change_per_pixel(&self, d: [f64; 2], seen: &Seen) -> f64 {
        let Some([gu, gv]) = parameter_gradients(self.camera, &seen.point) else { return f64::NAN };
        length([d[0] * gu[0] + d[1] * gv[0], d[0] * gu[1] + d[1] * gv[1]])
    }

    fn patch(&self, surface: &Surface, seen: &Seen, n: Vector) -> Light {
        let Some(place) = surface.place_at(seen.quad, seen.uv[0], seen.uv[1]) else {
            return studio(from_srgb(EVEN_RING), n);
        };
        let lit = studio(from_srgb(role_color(place.role)), n);
        mix(lit, from_srgb(BORDER), self.border(&place, seen))
    }

    /// How much of the sample is covered by the border of a patch, 0 to 1.
    fn border(&self, place: &PatchPlace, seen: &Seen) -> f64 {
        let lines = (0..2).map(|k| {
            let unit_step = std::array::from_fn(|m| f64::from(u8::from(m == k)));
            let pixels = 1.0 / self.change_per_pixel(unit_step, seen);
            let [low, high] = place.domain[k];
            let distance = pixels * (seen.uv[k] - low).abs().min((high - seen.uv[k]).abs());
            let cover = ((0.5 * BORDER_WIDTH - distance) / self.spacing + 0.5).clamp(0.0, 1.0);
            cover * (pixels * (high - low) / FADE_BELOW).min(1.0)
        });
        // f64::max passes over NaN, the answer where the surface is seen edge-on.
        lines.fold(0.0, f64::max)
    }
}

/// Gauss or mean curvature at `seen`; `None` in other styles or where it is not defined.
pub(super) fn curvature(style: Style, seen: &Seen) -> Option<f64> {
    let value = match style {
        Style::Gauss => seen.point.gauss,
        Style::Mean => seen.point.mean,
        Style::Shaded | Style::Highlight | Style::Patches => return None,
    };
    (!value.is_nan()).then_some(value)
}

fn role_color(role: Role) -> [u8; 3] {
    match role {
        Role::Regular => REGULAR,
        Role::Ring(k) if k % 2 == 0 => ODD_RING,
        Role::Ring(_) => EVEN_RING,
        Role::Cap => CAP,
    }
}

/// A lamp: where it is seen from the surface (right, up, to the eye), how much light it gives,
/// and how far that reaches around the surface (0: to the shadow line).
struct Lamp {
    direction: Vector,
    light: Light,
    wrap: f64,
}

const KEY: Lamp = Lamp { direction: [-0.50, 0.62, 0.60], light: [1.26, 1.22, 1.16], wrap: 0.20 };
const FILL: Lamp = Lamp { direction: [0.80, -0.05, 0.60], light: [0.26, 0.30, 0.37], wrap: 0.40 };
const RIM: Lamp = Lamp { direction: [0.45, 0.60, -0.66], light: [0.90, 0.97, 1.10], wrap: 0.15 };
const SKY: Light = [0.40, 0.42, 0.45];
const GROUND: Light = [0.19, 0.185, 0.18];

/// A material of colour `albedo` with a satin gloss in the light of the studio, at normal `n`.
pub(super) fn studio(albedo: Light, n: Vector) -> Light {
    let mut light = mix(GROUND, SKY, 0.5 + 0.5 * n[1]);
    for lamp in [&KEY, &FILL, &RIM] {
        let amount = diffuse(lamp, n);
        light = std::array::from_fn(|k| light[k] + amount * lamp.light[k]);
    }
    let gloss = gloss(n);
    soft_limit(std::array::from_fn(|k| albedo[k] * light[k] + gloss[k]))
}

/// How much of the light of `lamp` falls on a surface with normal `n`.
fn diffuse(lamp: &Lamp, n: Vector) -> f64 {
    let cosine = dot(n, unit(lamp.direction));
    let amount = ((cosine + lamp.wrap) / (1.0 + lamp.wrap)).max(0.0);
    amount * (0.3 + 0.7 * amount)
}

/// The light that is mirrored to the eye: a broad and a sharp reflection of the key lamp, and
/// the sky along the outline.
fn gloss(n: Vector) -> Light {
    let [x, y, z] = unit(KEY.direction);
    let half_way = dot(n, unit([x, y, z + 1.0])).max(0.0);
    let lamp = 0.07 * half_way.powi(12) + 0.16 * half_way.powi(70);
    let outline = 0.30 * (1.0 - n[2].clamp(0.0, 1.0)).powi(4) * (0.5 + 0.5 * n[1]);
    std::array::from_fn(|k| lamp * KEY.light[k] + outline * SKY[k])
}

/// `light` as it is up to 0.7, then weakened so that it never exceeds 1; the hue is kept.
fn soft_limit(light: Light) -> Light {
    const KNEE: f64 = 0.7;
    let strongest = light.into_iter().fold(0.0, f64::max);
    let over = (strongest - KNEE) / (1.0 - KNEE);
    if over <= 0.0 {
        return light;
    }
    scale((KNEE + (1.0 - KNEE) * over / (1.0 + over)) / strongest, light)
}

/// `color` with a hint of shape: darker by at most the part `depth` where `n` turns away from a
/// lamp straight above the eye, so that what is symmetric looks symmetric.
fn dimmed(color: Light, depth: f64, n: Vector) -> Light {
    let facing = dot(n, unit([0.0, 0.35, 0.90])).clamp(0.0, 1.0);
    scale(1.0 - depth * (1.0 - facing), color)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unit normals towards the eye.
    fn normals() -> impl Iterator<Item = Vector> {
        (-10..=10)
            .flat_map(|i| (-10..=10).map(move |j| [0.1 * f64::from(i), 0.1 * f64::from(j), 0.4]))
            .map(unit)
    }

    #[test]
    fn nothing_is_brighter_than_white_or_darker_than_black() {
        for n in normals() {
            for color in [studio(from_srgb(CLAY), n), studio([1.0; 3], n), dimmed([1.0; 3], 0.3, n)]
            {
                assert!(color.iter().all(|x| (0.0..=1.0).contains(x)), "{color:?} at {n:?}");
            }
        }
    }

    /// A small turn of the normal changes the light little: no edge that is not in the surface.
    #[test]
    fn light_is_continuous() {
        for n in normals() {
            let turned = unit([n[0] + 1e-6, n[1] - 1e-6, n[2]]);
            let (a, b) = (studio(from_srgb(CLAY), n), studio(from_srgb(CLAY), turned));
            assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-4));
        }
    }

    #[test]
    fn dimming_keeps_the_hue() {
        for n in normals() {
            let [r, g, b] = dimmed([0.8, 0.4, 0.2], 0.3, n);
            assert!((r - 2.0 * g).abs() < 1e-12 && (g - 2.0 * b).abs() < 1e-12);
        }
    }
}
