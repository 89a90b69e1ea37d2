//! The finished picture: sRGB pixels, text on them, and the PNG file.

use std::io;

use super::color::{Light, to_srgb};
use super::font::{Alignment, Font};

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
    /// The left end or the middle of the text, as `alignment` says, at half its height.
    pub at: [usize; 2],
    pub alignment: Alignment,
    pub font: &'static Font,
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

    /// Writes `label`, as far as it is inside; a font pixel is a square of `scale` pixels, and only
    /// whole ones are inside.
    pub(super) fn write(&mut self, label: &Label) {
        let Label { at, alignment, font, color, scale, .. } = *label;
        let [x, y] = at.map(|x| x / scale);
        let [columns, rows] = [self.width, self.height].map(|n| n / scale);
        for (k, line) in label.text.lines().enumerate() {
            font.draw(line, [x, y + k * font.height], alignment, |x, y| {
                if x < columns && y < rows {
                    self.fill([x * scale, y * scale], [scale; 2], color);
                }
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::font::REGULAR;

    fn label(at: [usize; 2]) -> Label<'static> {
        let alignment = Alignment::Left;
        Label { text: "K = 0", at, alignment, font: &REGULAR, color: [9, 8, 7], scale: 2 }
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
        assert!(inked.iter().all(|&(x, y)| (10..80).contains(&x) && (8..34).contains(&y)));
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
