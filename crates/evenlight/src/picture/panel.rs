//! One surface drawn into its part of the picture, tile by tile.

use super::camera::Camera;
use super::canvas::Picture;
use super::color::{Light, to_srgb};
use super::dice::{Cell, GAP, dice};
use super::raster::{Seen, Tile, locate};
use super::shade::{Coat, Painter, curvature};
use super::{RenderOptions, Style};
use crate::analyse::highlight::HighlightLines;
use crate::point::{Point, add, add_scaled, scale};
use crate::surface::{QuadId, Surface};
use crate::task::map_indexed;

/// The side of a tile in pixels.
const TILE: usize = 32;

/// The longer side of the grid of points from which the range of curvature is found.
const RANGE_GRID: f64 = 400.0;

/// Curvature below this, for a picture two units wide, counts as none: a plane stays white
/// although its computed curvature is not exactly 0.
const NO_CURVATURE: f64 = 1e-6;

/// A surface cut into cells for a camera.
pub(super) struct Panel<'a> {
    surface: &'a Surface,
    camera: Camera,
    cells: Vec<Cell>,
    /// The cells that each tile may show, tiles row by row.
    bins: Vec<Vec<u32>>,
}

/// Points of the surface, nine per parametric quad, that tell its size.
pub(super) fn points(surface: &Surface) -> Vec<Point> {
    let quads = map_indexed(surface.num_quads(), |quad| {
        let steps = (0..9).map(|k| [0.5 * f64::from(k / 3), 0.5 * f64::from(k % 3)]);
        let points = steps.filter_map(|[u, v]| surface.eval(QuadId(quad as u32), u, v));
        points.map(|at| at.jet.p).filter(|p| p.iter().all(|x| x.is_finite())).collect::<Vec<_>>()
    });
    quads.concat()
}

/// A range for the colour map of `style`, see [`RenderOptions::range`], from what `camera` sees
/// of all surfaces; 1 for styles without curvature.
pub(super) fn typical_range(surfaces: &[(&str, &Surface)], camera: &Camera, style: Style) -> f64 {
    let order = match style {
        Style::Mean => 1,
        Style::Gauss => 2,
        Style::Shaded | Style::Highlight | Style::Patches => return 1.0,
    };
    let longer = camera.size[0].max(camera.size[1]) as f64;
    let coarse = camera.resized((RANGE_GRID / longer).min(1.0));
    let panels = surfaces.iter().map(|(_, surface)| Panel::new(surface, coarse.clone()));
    let mut values: Vec<f64> = panels.flat_map(|panel| panel.curvatures(style)).collect();
    values.sort_by(f64::total_cmp);
    let part = |k: usize| values.get(values.len() * k / 100).map_or(0.0, |x| x.abs());
    let least = NO_CURVATURE * camera.half_extent().powi(-order);
    round_up(part(2).max(part(98)).max(least))
}

/// The next number with two significant digits; `x` itself where there is none.
fn round_up(x: f64) -> f64 {
    let unit = 10.0_f64.powi((x.log10().floor() - 1.0) as i32);
    let digits = (x / unit - 1e-9).ceil();
    // Read back from its decimal form, the number is the double nearest to it.
    format!("{:.1e}", digits * unit).parse().ok().filter(|&y: &f64| y.is_normal()).unwrap_or(x)
}

impl<'a> Panel<'a> {
    /// Cuts all of `surface` that `camera` may see.
    pub fn new(surface: &'a Surface, camera: Camera) -> Self {
        let dice = |quad| dice(surface, &camera, QuadId(quad as u32));
        let cells = map_indexed(surface.num_quads(), dice).concat();
        let bins = bins(&cells, camera.size);
        Self { surface, camera, cells, bins }
    }

    /// Whether there is nothing to see.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Draws the surface into `picture`, the panel's upper left corner at `origin`.
    pub fn draw(
        &self,
        picture: &mut Picture,
        origin: [usize; 2],
        options: &RenderOptions,
        range: f64,
    ) {
        let painter = Painter::new(&self.camera, self.coat(options, range), options.samples);
        let [columns, rows] = self.tile_counts();
        for row in 0..rows {
            // One row of tiles at a time, which bounds the memory for large pictures.
            let tiles = map_indexed(columns, |column| {
                let tile = self.tile([column, row], options.samples);
                (tile, self.colors(&tile, &painter, |y| options.background(origin[1] + y)))
            });
            for (tile, colors) in &tiles {
                copy(picture, origin, tile, colors);
            }
        }
    }

    /// What the surface is painted with.
    fn coat(&self, options: &RenderOptions, range: f64) -> Coat<'a> {
        match options.style {
            Style::Shaded => Coat::Clay,
            Style::Highlight => {
                let (sin, cos) = options.stripe_direction.to_radians().sin_cos();
                let axis = add(scale(cos, self.camera.up), scale(-sin, self.camera.right));
                Coat::Stripes(HighlightLines::new(axis, self.camera.toward, options.stripes))
            }
            Style::Gauss | Style::Mean => Coat::Curvature(options.style, range),
            Style::Patches => Coat::Patches(self.surface),
        }
    }

    /// The pixels of `tile`, row by row: the mean light of their samples.
    fn colors(
        &self,
        tile: &Tile,
        painter: &Painter,
        background: impl Fn(usize) -> Light,
    ) -> Vec<[u8; 3]> {
        let mut sums: Vec<Light> = vec![[0.0; 3]; tile.size[0] * tile.size[1]];
        let weight = 1.0 / (tile.rate * tile.rate) as f64;
        for (index, seen) in self.seen(tile).enumerate() {
            let [x, y] = tile.pixel(index);
            let light =
                seen.map_or_else(|| background(tile.origin[1] + y), |seen| painter.color(&seen));
            add_scaled(&mut sums[y * tile.size[0] + x], weight, light);
        }
        sums.into_iter().map(to_srgb).collect()
    }

    /// The point of the surface at every sample of `tile`, row by row.
    fn seen(&self, tile: &Tile) -> impl Iterator<Item = Option<Seen>> {
        let bin = &self.bins[self.bin_of(tile)];
        let candidates = tile.nearest(bin.iter().map(|&cell| &self.cells[cell as usize]));
        let tile = *tile;
        candidates.into_iter().enumerate().map(move |(index, candidate)| {
            locate(self.surface, &self.camera, &candidate?, tile.position(index))
        })
    }

    /// The curvature of `style` at one point per pixel.
    fn curvatures(&self, style: Style) -> Vec<f64> {
        let columns = self.tile_counts()[0];
        let tiles = map_indexed(self.bins.len(), |k| {
            let tile = self.tile([k % columns, k / columns], 1);
            self.seen(&tile).filter_map(|seen| curvature(style, &seen?)).collect::<Vec<_>>()
        });
        tiles.concat()
    }

    /// The number of tiles in a row and in a column.
    fn tile_counts(&self) -> [usize; 2] {
        self.camera.size.map(|side| side.div_ceil(TILE))
    }

    /// The tile in the given column and row of tiles.
    fn tile(&self, place: [usize; 2], rate: usize) -> Tile {
        let origin = place.map(|k| k * TILE);
        let size = std::array::from_fn(|k| TILE.min(self.camera.size[k] - origin[k]));
        Tile { origin, size, rate }
    }

    /// The number of the bin of `tile`.
    fn bin_of(&self, tile: &Tile) -> usize {
        tile.origin[1] / TILE * self.tile_counts()[0] + tile.origin[0] / TILE
    }
}

/// Sorts the cells into the tiles that their boxes touch.
fn bins(cells: &[Cell], size: [usize; 2]) -> Vec<Vec<u32>> {
    let [columns, rows] = size.map(|side| side.div_ceil(TILE));
    let mut bins = vec![Vec::new(); columns * rows];
    for (number, cell) in (0..).zip(cells) {
        let [low, high] = cell.bounds();
        // Casts to usize saturate: what is left of or above the panel counts as 0.
        let range = |k: usize, count: usize| {
            let first = (low[k] - GAP) as usize / TILE;
            let last = (high[k] + GAP) as usize / TILE;
            first..(last + 1).min(count)
        };
        for row in range(1, rows) {
            for column in range(0, columns) {
                bins[row * columns + column].push(number);
            }
        }
    }
    bins
}

/// Copies the pixels of `tile` into the panel whose upper left corner is at (`left`, `top`).
fn copy(picture: &mut Picture, [left, top]: [usize; 2], tile: &Tile, colors: &[[u8; 3]]) {
    for (y, row) in colors.chunks_exact(tile.size[0]).enumerate() {
        for (x, &color) in row.iter().enumerate() {
            picture.set(left + tile.origin[0] + x, top + tile.origin[1] + y, color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::View;
    use super::*;
    use crate::mesh::{BoundaryRule, Cage, Mesh};
    use crate::scheme::SchemeKind;
    use crate::surface::SurfaceOptions;

    fn surface(mesh: Mesh) -> Surface {
        // The splines below go on beyond the faces of their inner vertices.
        let options = SurfaceOptions {
            scheme: SchemeKind::CatmullClark,
            boundary: Some(BoundaryRule::None),
            ..SurfaceOptions::default()
        };
        Surface::build(Cage::new(mesh).unwrap(), options).unwrap()
    }

    /// The bicubic spline with control points (i, j, (i^2 + j^2) / 8), i and j from -4 to 4, which
    /// is the paraboloid z = (x^2 + y^2) / 8 + 1/12.
    fn paraboloid() -> Surface {
        let steps = || -4..=4;
        let height = |i: i32, j: i32| f64::from(i * i + j * j) / 8.0;
        let points =
            steps().flat_map(|j| steps().map(move |i| [f64::from(i), f64::from(j), height(i, j)]));
        let corner = |k: u32| 9 * (k / 8) + k % 8;
        let faces = (0..64).map(|k| [corner(k), corner(k) + 1, corner(k) + 10, corner(k) + 9]);
        surface(Mesh::new(points.collect(), faces))
    }

    /// A double pyramid over a regular polygon with `n` corners, cut into 3 n quads on each
    /// side: two vertices of valence n.
    fn bipyramid(n: u32) -> Surface {
        let ring = |z: f64, r: f64, shift: f64| {
            (0..n).map(move |k| {
                let (sin, cos) =
                    ((f64::from(k) + shift) * std::f64::consts::TAU / f64::from(n)).sin_cos();
                [r * cos, r * sin, z]
            })
        };
        let mut points = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
        for (z, r, shift) in [(0.8, 0.8, 0.0), (0.8, 0.9, 0.5), (-0.8, 0.8, 0.0), (-0.8, 0.9, 0.5)]
        {
            points.extend(ring(z, r, shift));
        }
        let at = |circle: u32, k: u32| 2 + circle * n + k % n;
        let faces = (0..n).flat_map(|k| {
            let (top, bottom) =
                ([0, at(0, k), at(1, k), at(0, k + 1)], [1, at(2, k + 1), at(3, k), at(2, k)]);
            let sides = [
                [at(0, k), at(2, k), at(3, k), at(1, k)],
                [at(1, k), at(3, k), at(2, k + 1), at(0, k + 1)],
            ];
            [top, bottom, sides[0], sides[1]]
        });
        surface(Mesh::new(points, faces.collect::<Vec<_>>()))
    }

    fn panel<'a>(surface: &'a Surface, view: &View, size: [usize; 2]) -> Panel<'a> {
        Panel::new(surface, Camera::fit(view, &points(surface), size))
    }

    /// All samples of `panel`, at one per pixel: where they are, and what is seen.
    fn samples(panel: &Panel) -> Vec<([f64; 2], Option<Seen>)> {
        let [columns, rows] = panel.tile_counts();
        let tiles = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
        let seen = tiles.flat_map(|place| {
            let tile = panel.tile(place, 1);
            panel
                .seen(&tile)
                .enumerate()
                .map(move |(i, seen)| (tile.position(i), seen))
                .collect::<Vec<_>>()
        });
        seen.collect()
    }

    #[test]
    fn every_sample_shows_the_exact_point_normal_and_curvature() {
        let surface = paraboloid();
        for (azimuth, elevation) in [(0.0, 90.0), (30.0, 50.0), (-100.0, 75.0)] {
            let view = View { azimuth, elevation, ..View::default() };
            let panel = panel(&surface, &view, [150, 120]);
            let visible = samples(&panel).into_iter().filter_map(|(at, seen)| Some((at, seen?)));
            let mut count = 0;
            for (at, seen) in visible {
                let [x, y, z] = seen.point.jet.p;
                let [px, py, _] = panel.camera.project([x, y, z]);
                assert!((px - at[0]).hypot(py - at[1]) < 0.2, "{:?} for {at:?}", (px, py));
                assert!((z - (x * x + y * y) / 8.0 - 1.0 / 12.0).abs() < 1e-12);
                let w = 1.0 + (x * x + y * y) / 16.0; // 1 + |gradient|^2
                assert!((seen.point.gauss - 1.0 / 16.0 / (w * w)).abs() < 1e-12);
                let normal = [-x / 4.0, -y / 4.0, 1.0].map(|c| c / w.sqrt());
                assert!((0..3).all(|k| (seen.point.normal[k] - normal[k]).abs() < 1e-12));
                count += 1;
            }
            assert!(count > 5000, "only {count} samples show the surface");
        }
    }

    /// Inside the outline, Newton's method always arrives.
    #[test]
    fn samples_of_a_surface_seen_from_above_are_met_exactly() {
        let surface = paraboloid();
        let panel = panel(&surface, &View { elevation: 90.0, ..View::default() }, [150, 120]);
        for (at, seen) in samples(&panel) {
            let Some(seen) = seen else { continue };
            let [px, py, _] = panel.camera.project(seen.point.jet.p);
            let inside = seen.uv.iter().all(|t| (0.01..0.99).contains(t));
            assert!(!inside || (px - at[0]).hypot(py - at[1]) <= 0.01);
        }
    }

    /// Cells of different size leave no gaps, at any magnification.
    #[test]
    fn there_are_no_holes_around_extraordinary_points() {
        for n in [3, 5, 9] {
            let surface = bipyramid(n);
            let target = surface
                .extraordinary_points()
                .iter()
                .position(|p| p.vertex().is_some_and(|v| v.0 == 0));
            for zoom in [3.0, 30.0, 1e3, 1e6] {
                let view = View {
                    zoom,
                    azimuth: 10.0,
                    ..View::toward(&surface, target.unwrap()).unwrap()
                };
                let panel = panel(&surface, &view, [90, 70]);
                for (at, seen) in samples(&panel) {
                    let seen =
                        seen.unwrap_or_else(|| panic!("n = {n}, zoom {zoom}: hole at {at:?}"));
                    let up = seen.point.normal[2];
                    assert!(
                        seen.point.gauss.is_finite() && up > 0.0,
                        "n = {n}, zoom {zoom}, {at:?}: {seen:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_is_outside_the_picture_is_not_cut() {
        let surface = bipyramid(5);
        let target = Some([1e4, 0.0, 0.0]);
        let panel = panel(&surface, &View { target, ..View::default() }, [90, 70]);
        assert!(panel.is_empty());
    }

    /// Sizes at the limits of numbers, and cages without any extent, give pictures.
    #[test]
    fn degenerate_surfaces_do_no_harm() {
        let (paraboloid, options) = (
            paraboloid(),
            RenderOptions { size: [400, 160], samples: 1, ..RenderOptions::default() },
        );
        for factor in [
            [0.0; 3],
            [1e-300; 3],
            [1e150; 3],
            [1e307; 3],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [1e-9, 1.0, 1e9],
        ] {
            let faces = paraboloid.topology().faces().clone();
            let move_point = |p: &Point| std::array::from_fn(|k| factor[k] * p[k]);
            let positions = paraboloid.positions().iter().map(move_point).collect();
            let surface = surface(Mesh { positions, faces, ..Mesh::default() });
            for style in Style::ALL {
                let picture =
                    super::super::render(&surface, &RenderOptions { style, ..options.clone() });
                assert_eq!(picture.unwrap().width(), 400);
            }
        }
    }

    #[test]
    fn the_number_of_threads_does_not_change_the_picture() {
        let surface = bipyramid(5);
        let draw = |threads: usize, style: Style| {
            let options = RenderOptions { style, size: [360, 150], ..RenderOptions::default() };
            let task = crate::task::Task::new().threads(threads);
            task.run(|| super::super::render(&surface, &options).unwrap())
        };
        for style in Style::ALL {
            assert_eq!(draw(1, style), draw(2, style));
        }
    }

    #[test]
    fn ranges_are_rounded_up_to_two_digits() {
        for (x, rounded) in [
            (0.341, 0.35),
            (0.35, 0.35),
            (1.0, 1.0),
            (0.999, 1.0),
            (1234.0, 1300.0),
            (9.91e-7, 1e-6),
            (3.01e-7, 3.1e-7),
            (2e300, 2e300),
        ] {
            assert_eq!(round_up(x), rounded);
        }
    }

    #[test]
    fn ranges_stay_usable_at_the_limits_of_numbers() {
        for x in [f64::MIN_POSITIVE, f64::MAX, 1e-300] {
            let range = round_up(x);
            assert!(range.is_normal() && range > 0.0, "{x} became {range}");
        }
    }
}
