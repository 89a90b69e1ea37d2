//! Pictures of surfaces, drawn without a graphics card, as exact as the surface.
//!
//! At every sample the picture shows the surface itself, not a mesh of it: triangles only find
//! out roughly which point is seen; Newton's method then finds the parameters of the point that
//! projects on the sample, and position, normal and curvature are those of the patch there.
//!
//! ```text
//!  Surface --dice--> cells --raster--> (quad,u,v) --locate--> SurfacePoint --shade--> pixels
//!           camera           per tile, depth       Newton       exact
//! ```
//!
//! ```no_run
//! use evenlight::picture::{RenderOptions, Style, View, render};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let surface: evenlight::Surface = unimplemented!();
//! let view = View { azimuth: -20.0, ..View::default() };
//! let options = RenderOptions { style: Style::Highlight, view, ..RenderOptions::default() };
//! render(&surface, &options)?.write_png(std::fs::File::create("highlight.png")?)?;
//! # Ok(()) }
//! ```
//!
//! Equal input gives equal pictures, byte for byte, for any number of threads. (Machines whose
//! sine and power functions round differently may differ in the last bit of a colour.)

mod camera;
mod canvas;
mod color;
mod dice;
mod font;
mod graph;
mod legend;
mod panel;
mod raster;
mod shade;

pub use camera::View;
pub use canvas::Picture;
pub use graph::{GraphOptions, eigenfunctions};

use crate::Surface;
use crate::names::names;
use crate::task::{Cancelled, Steps};
use camera::Camera;
use canvas::Label;
use color::{Light, from_srgb, mix};
use font::{Alignment, LARGE_BOLD};
use panel::{Panel, typical_range};

/// The longest side of a picture in pixels.
pub const MAX_SIDE: usize = 16384;

/// The most samples per pixel in one direction.
pub const MAX_SAMPLES: usize = 8;

/// The colour of text and frames.
const INK: [u8; 3] = [44, 52, 62];

/// The colour behind names, which may lie on the surface.
const PLATE: [u8; 3] = [250, 251, 253];

/// The colour of the line between panels.
const SEPARATOR: [u8; 3] = [176, 184, 194];

/// What a picture shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Style {
    /// A material in the light of a studio.
    #[default]
    Shaded,
    /// Highlight lines, see [`crate::analyse::highlight`].
    Highlight,
    /// The Gauss curvature K, with a colour bar.
    Gauss,
    /// The mean curvature H, with a colour bar. Its sign follows the surface's orientation,
    /// even where the back is seen: convex bodies have H < 0.
    Mean,
    /// The layout of the patches: regular ones green, rings in gold and red by turns.
    Patches,
}

names! { Style, "style":
    Shaded => "shaded",
    Highlight => "highlight",
    Gauss => "gauss",
    Mean => "mean",
    Patches => "patches",
}

/// How a picture is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// What it shows.
    pub style: Style,
    /// Width and height of the whole picture (all panels and the colour bar) in pixels, 1 to
    /// [`MAX_SIDE`] each.
    pub size: [usize; 2],
    /// Where the surface is seen from.
    pub view: View,
    /// The curvature at the ends of the colour map, which runs from -`range` to `range`;
    /// values beyond look like the ends. `None`: large enough for all visible values but the
    /// lowest and the highest 2 percent, rounded up to two digits.
    pub range: Option<f64>,
    /// The number of dark highlight stripes over the half turn, 1 to 1000.
    pub stripes: usize,
    /// The direction of the lights in the picture, in degrees counter-clockwise from upright:
    /// stripes on an upright cylinder are upright at 0.
    pub stripe_direction: f64,
    /// Samples per pixel in either direction, 1 to [`MAX_SAMPLES`].
    pub samples: usize,
    /// Whether [`render`] writes the name of the scheme in the corner ([`compare`] always
    /// writes the names it is given).
    pub label: bool,
}

impl Default for RenderOptions {
    /// Shaded, 900 x 700, 3 x 3 samples, 24 stripes turned by 45 degrees.
    fn default() -> Self {
        Self {
            style: Style::Shaded,
            size: [900, 700],
            view: View::default(),
            range: None,
            stripes: 24,
            stripe_direction: 45.0,
            samples: 3,
            label: false,
        }
    }
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The picture is empty or too large.
    #[error("a picture of {width} x {height} pixels: each side must have 1 to {MAX_SIDE}")]
    Size {
        /// The width asked for.
        width: usize,
        /// The height asked for.
        height: usize,
    },
    /// There are no surfaces, or more than columns of pixels.
    #[error("{panels} surfaces side by side do not fit into {width} pixels")]
    Panels {
        /// The number of surfaces.
        panels: usize,
        /// The width asked for.
        width: usize,
    },
    /// There is no such eigenfunction.
    #[error("there is no eigenfunction {number}, but 0 to {}", count.saturating_sub(1))]
    Function {
        /// The number asked for.
        number: usize,
        /// How many there are.
        count: usize,
    },
    /// An option is out of range.
    #[error("{option} must be {allowed}")]
    Option {
        /// The option.
        option: &'static str,
        /// The values it may have.
        allowed: &'static str,
    },
    /// Who watches the work stopped it ([`Task::watch`](crate::task::Task::watch)).
    #[error("the work was cancelled")]
    Cancelled,
}

impl From<Cancelled> for PictureError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// Draws `surface`.
///
/// A surface without any face gives an empty picture with a note in it.
///
/// # Errors
///
/// If an option is out of range.
pub fn render(surface: &Surface, options: &RenderOptions) -> Result<Picture, PictureError> {
    let name = if options.label { surface.options().scheme.name() } else { "" };
    compare(&[(name, surface)], options)
}

/// Draws surfaces side by side, many of them in several rows, with their names: the same camera
/// (fitted to the first one), the same range of curvature (from all of them) and one colour bar.
///
/// # Errors
///
/// If an option is out of range, or there are no surfaces or too many for the width.
pub fn compare(
    surfaces: &[(&str, &Surface)],
    options: &RenderOptions,
) -> Result<Picture, PictureError> {
    options.check()?;
    let scale = options.text_scale();
    let legend_width = legend::width(options.style, options.size, scale);
    let too_many = PictureError::Panels { panels: surfaces.len(), width: options.size[0] };
    let room = [options.size[0] - legend_width, options.size[1]];
    let (columns, panel_size) = panel_grid(surfaces.len(), room).ok_or(too_many)?;
    let camera = fitted_camera(surfaces, options, panel_size);
    let range = options.range.unwrap_or_else(|| typical_range(surfaces, &camera, options.style));

    let mut steps = Steps::new("Drawing", surfaces.len())?;
    let mut picture = Picture::new(options.size, |y| options.background(y));
    for (k, &(name, surface)) in surfaces.iter().enumerate() {
        let origin = [k % columns * panel_size[0], k / columns * panel_size[1]];
        let panel = Panel::new(surface, camera.clone());
        panel.draw(&mut picture, origin, options, range);
        annotate(&mut picture, origin, panel_size, name, panel.is_empty(), scale);
        steps.step()?;
    }
    legend::draw(&mut picture, options.style, range, scale);
    Ok(picture)
}

/// How many columns of panels, and their size: one more row wherever the shorter side of the panels
/// gains a quarter or more by it. `None` if there are no panels or no room.
fn panel_grid(count: usize, room: [usize; 2]) -> Option<(usize, [usize; 2])> {
    let size = |rows: usize| [room[0] / count.div_ceil(rows), room[1] / rows];
    let shorter = |rows: usize| size(rows)[0].min(size(rows)[1]);
    let rows = (1..=count)
        .reduce(|best, rows| if 4 * shorter(rows) >= 5 * shorter(best) { rows } else { best })?;
    let size = size(rows);
    size.iter().all(|&side| side > 0).then_some((count.div_ceil(rows), size))
}

/// The camera for the first surface that has points.
fn fitted_camera(
    surfaces: &[(&str, &Surface)],
    options: &RenderOptions,
    size: [usize; 2],
) -> Camera {
    let mut clouds = surfaces.iter().map(|(_, surface)| panel::points(surface));
    let points = clouds.find(|points| !points.is_empty()).unwrap_or_default();
    Camera::fit(&options.view, &points, size)
}

/// Writes the name of a panel on a plate in its corner, lines to its left and above it unless the
/// picture ends there, and a note if it is empty.
fn annotate(
    picture: &mut Picture,
    [left, top]: [usize; 2],
    size: [usize; 2],
    name: &str,
    empty: bool,
    scale: usize,
) {
    if left > 0 {
        picture.fill([left, top], [scale, size[1]], SEPARATOR);
    }
    if top > 0 {
        picture.fill([left, top], [size[0], scale], SEPARATOR);
    }
    if !name.is_empty() {
        let width = LARGE_BOLD.width * name.chars().count();
        let corner = [left + 8 * scale, top + 8 * scale];
        picture.fill(corner, [(width + 12) * scale, 24 * scale], PLATE);
    }
    let mut write = |text: &str, at: [usize; 2], alignment: Alignment| {
        picture.write(&Label { text, at, alignment, font: &LARGE_BOLD, color: INK, scale });
    };
    write(name, [left + 14 * scale, top + 20 * scale], Alignment::Left);
    if empty {
        let middle = [left + size[0] / 2, top + size[1] / 2];
        write("no surface to show", middle, Alignment::Center);
    }
}

impl RenderOptions {
    /// Checks every option.
    fn check(&self) -> Result<(), PictureError> {
        let [width, height] = self.size;
        if !self.size.iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            return Err(PictureError::Size { width, height });
        }
        let range_is_valid = self.range.is_none_or(|range| range.is_finite() && range > 0.0);
        let rules = [
            (self.view.is_valid(), "view", "finite, with a zoom above 0"),
            (range_is_valid, "range", "a positive number"),
            ((1..=1000).contains(&self.stripes), "stripes", "1 to 1000"),
            (self.stripe_direction.is_finite(), "stripe direction", "a number of degrees"),
            ((1..=MAX_SAMPLES).contains(&self.samples), "samples", "1 to 8"),
        ];
        match rules.into_iter().find(|(valid, ..)| !valid) {
            Some((_, option, allowed)) => Err(PictureError::Option { option, allowed }),
            None => Ok(()),
        }
    }

    /// The side of a font pixel in pixels: 1 in common sizes, more in large pictures.
    fn text_scale(&self) -> usize {
        (self.size[0].min(self.size[1]) / 900).max(1)
    }

    /// The colour of the background in row `y`: a light wall, a little darker at its foot and
    /// darker behind styles that use white.
    fn background(&self, y: usize) -> Light {
        let [top, foot] = match self.style {
            Style::Shaded | Style::Patches => [[250, 251, 253], [226, 231, 238]],
            Style::Highlight | Style::Gauss | Style::Mean => [[222, 227, 233], [198, 205, 214]],
        };
        mix(from_srgb(top), from_srgb(foot), (y as f64 + 0.5) / self.size[1] as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(change: impl Fn(&mut RenderOptions)) -> Result<(), PictureError> {
        let mut options = RenderOptions::default();
        change(&mut options);
        options.check()
    }

    #[test]
    fn the_default_is_valid() {
        assert_eq!(checked(|_| ()), Ok(()));
    }

    #[test]
    fn every_option_out_of_range_is_refused() {
        assert!(checked(|o| o.size = [0, 100]).is_err());
        assert!(checked(|o| o.size = [100, MAX_SIDE + 1]).is_err());
        assert!(checked(|o| o.view.zoom = 0.0).is_err());
        assert!(checked(|o| o.view.zoom = f64::INFINITY).is_err());
        assert!(checked(|o| o.view.azimuth = f64::NAN).is_err());
        assert!(checked(|o| o.view.target = Some([0.0, f64::NAN, 0.0])).is_err());
        assert!(checked(|o| o.range = Some(0.0)).is_err());
        assert!(checked(|o| o.range = Some(f64::NAN)).is_err());
        assert!(checked(|o| o.stripes = 0).is_err());
        assert!(checked(|o| o.stripe_direction = f64::NAN).is_err());
        assert!(checked(|o| o.samples = 0).is_err());
        assert!(checked(|o| o.samples = MAX_SAMPLES + 1).is_err());
    }

    #[test]
    fn no_surface_is_refused() {
        let none = compare(&[], &RenderOptions::default());
        assert_eq!(none, Err(PictureError::Panels { panels: 0, width: 900 }));
    }

    #[test]
    fn panels_stand_in_a_row_until_a_second_row_makes_them_larger() {
        assert_eq!(panel_grid(3, [1200, 900]), Some((3, [400, 900])));
        assert_eq!(panel_grid(4, [1200, 900]), Some((2, [600, 450])));
        assert_eq!(panel_grid(6, [1800, 1100]), Some((3, [600, 550])));
        assert_eq!(panel_grid(3, [1500, 500]), Some((3, [500, 500])));
        assert_eq!(panel_grid(2, [1, 1]), None);
    }

    #[test]
    fn messages_name_the_option_and_the_limit() {
        let text = |change: fn(&mut RenderOptions)| checked(change).unwrap_err().to_string();
        assert_eq!(text(|o| o.samples = 9), "samples must be 1 to 8");
        assert!(text(|o| o.size = [0, 7]).contains("0 x 7"));
    }
}
