//! The finished picture: sRGB pixels, text on them, and the PNG file.

use std::convert::Infallible;
use std::io;

use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics::prelude::{Dimensions, DrawTarget, Drawable, OriginDimensions, Point, Size};
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyleBuilder};
use embedded_graphics::{Pixel, primitives::Rectangle};

use super::color::{Light, to_srgb};

/// A picture of 8-bit sRGB pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

/// A line of text: what, where and how.
pub(super) struct Label<'a> {
    pub text: &'a str,
    /// The left end, the middle or the right end of the text, as `alignment` says, at half its
    /// height.
    pub at: [usize; 2],
    pub alignment: Alignment,
    pub font: &'a MonoFont<'a>,
    pub color: [u8; 3],
    /// The side of a font pixel in pixels.
    pub scale: usize,
}

impl Picture {
    /// A picture whose row `y` has the colour `row(y)`.
    pub(super) fn new(size: [usize; 2], row: impl Fn(usize) -> Light) -> Self {
        let [width, height] = size;
        let row_colors = (0..height).map(|y| to_srgb(row(y)));
        let pixels = row_colors.flat_map(|color| std::iter::repeat_n(color, width)).collect();
        Self { width, height, pixels }
    }

    /// The number of columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The pixels as sRGB red, green and blue, row by row from the top left.
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// Column `x` from the left of row `y` from the top; `None` outside the picture.
    pub fn pixel(&self, x: usize, y: usize) -> Option<[u8; 3]> {
        (x < self.width && y < self.height).then(|| self.pixels[y * self.width + x])
    }

    /// Writes the picture as a PNG file with 8-bit sRGB pixels. There is no time, name or
    /// other changing text in the file: equal pictures are equal files.
    ///
    /// # Errors
    ///
    /// Those of writing to `out`.
    pub fn write_png(&self, out: impl io::Write) -> io::Result<()> {
        // Neither conversion can be too large: a side has at most 16384 pixels.
        let mut encoder = png::Encoder::new(out, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        Ok(writer.finish()?)
    }

    /// Colours one pixel; outside the picture nothing happens.
    pub(super) fn set(&mut self, x: usize, y: usize, color: [u8; 3]) {
        if x < self.width && y < self.height {
            self.pixels[y * self.width + x] = color;
        }
    }

    /// Colours the rectangle with corner `at` and `size`, as far as it is inside.
    pub(super) fn fill(&mut self, at: [usize; 2], size: [usize; 2], color: [u8; 3]) {
        for y in at[1]..at[1] + size[1] {
            for x in at[0]..at[0] + size[0] {
                self.set(x, y, color);
            }
        }
    }

    /// Writes `label`, as far as it is inside.
    pub(super) fn write(&mut self, label: &Label) {
        let at = label.at.map(|x| (x / label.scale) as i32);
        let [r, g, b] = label.color;
        let style = MonoTextStyle::new(label.font, Rgb888::new(r, g, b));
        let placed =
            TextStyleBuilder::new().alignment(label.alignment).baseline(Baseline::Middle).build();
        let text = Text::with_text_style(label.text, Point::new(at[0], at[1]), style, placed);
        let Ok(_) = text.draw(&mut Magnifier { picture: self, scale: label.scale });
    }
}

/// The picture as a target of `embedded-graphics` whose pixels are squares of `scale` pixels.
struct Magnifier<'a> {
    picture: &'a mut Picture,
    scale: usize,
}

impl OriginDimensions for Magnifier<'_> {
    fn size(&self) -> Size {
        let [w, h] = [self.picture.width, self.picture.height].map(|n| (n / self.scale) as u32);
        Size::new(w, h)
    }
}

impl DrawTarget for Magnifier<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        let inside: Rectangle = self.bounding_box();
        for Pixel(at, color) in pixels {
            if inside.contains(at) {
                let corner = [at.x as usize * self.scale, at.y as usize * self.scale];
                let color = [color.r(), color.g(), color.b()];
                self.picture.fill(corner, [self.scale; 2], color);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics::mono_font::ascii::FONT_6X10;

    fn label(at: [usize; 2]) -> Label<'static> {
        let alignment = Alignment::Left;
        Label { text: "K = 0", at, alignment, font: &FONT_6X10, color: [9, 8, 7], scale: 2 }
    }

    #[test]
    fn png_can_be_read_back() {
        let picture = Picture::new([5, 3], |y| [y as f64 / 3.0; 3]);
        let mut file = Vec::new();
        picture.write_png(&mut file).unwrap();
        let mut reader = png::Decoder::new(io::Cursor::new(file)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!((info.width, info.height), (5, 3));
        assert_eq!(bytes, picture.pixels().as_flattened());
    }

    #[test]
    fn text_leaves_ink_of_its_colour_inside_its_box_only() {
        let mut picture = Picture::new([100, 40], |_| [1.0; 3]);
        picture.write(&label([10, 20]));
        let ink = |x: usize, y: usize| picture.pixel(x, y) == Some([9, 8, 7]);
        let inked: Vec<_> =
            (0..4000).map(|i| (i % 100, i / 100)).filter(|&(x, y)| ink(x, y)).collect();
        assert!(!inked.is_empty());
        assert!(inked.iter().all(|&(x, y)| (10..70).contains(&x) && (10..30).contains(&y)));
    }

    #[test]
    fn text_outside_is_cut_off() {
        let mut picture = Picture::new([4, 4], |_| [1.0; 3]);
        for at in [[0, 0], [3, 3], [100, 100]] {
            picture.write(&label(at));
        }
        assert_eq!(picture.pixels().len(), 16);
    }
}
