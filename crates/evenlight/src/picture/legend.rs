//! The colour bar beside a picture of curvature.

use super::canvas::{Label, Picture};
use super::color::{diverging, to_srgb};
use super::font::{Alignment, BOLD, Font, REGULAR};
use super::{INK, Style};

/// The width of the legend in font pixels: bar, tick marks, and numbers of up to 9 characters.
const WIDTH: usize = 108;
/// The smallest picture with a legend, in font pixels.
const LEAST: [usize; 2] = [3 * WIDTH, 140];

const BAR_LEFT: usize = 12;
const BAR_WIDTH: usize = 16;
const TICK: usize = 5;

/// The width in pixels that a picture of `size` in `style` needs for its legend: 0 if the style
/// has none or the picture is too small for it.
pub(super) fn width(style: Style, size: [usize; 2], scale: usize) -> usize {
    let fits = (0..2).all(|k| size[k] >= scale * LEAST[k]);
    if title(style).is_some() && fits { scale * WIDTH } else { 0 }
}

/// The quantity that `style` shows, and its unit.
fn title(style: Style) -> Option<&'static str> {
    match style {
        Style::Gauss => Some("K [1/unit\u{b2}]"),
        Style::Mean => Some("H [1/unit]"),
        Style::Shaded | Style::Highlight | Style::Patches => None,
    }
}

/// Draws the legend at the right end of `picture`: the colours from -`range` to `range`.
pub(super) fn draw(picture: &mut Picture, style: Style, range: f64, scale: usize) {
    let legend_width = width(style, [picture.width(), picture.height()], scale);
    let Some(title) = title(style).filter(|_| legend_width > 0) else { return };
    let left = picture.width() - legend_width + scale * BAR_LEFT;
    let (top, bottom) = (picture.height() / 5, picture.height() - picture.height() / 6);
    bar(picture, left, [top, bottom], scale);
    let mut write = |text: &str, x: usize, y: usize, font: &'static Font| {
        let alignment = Alignment::Left;
        picture.write(&Label { text, at: [x, y], alignment, font, color: INK, scale });
    };
    write(title, left, top - scale * 20, &BOLD);
    for (k, y) in ticks(top, bottom).into_iter().enumerate() {
        let value = range * (1.0 - 0.5 * k as f64);
        write(&number(value, range), left + scale * (BAR_WIDTH + TICK + 5), y, &REGULAR);
    }
}

/// The bar with its frame and tick marks.
fn bar(picture: &mut Picture, left: usize, [top, bottom]: [usize; 2], scale: usize) {
    let wide = scale * BAR_WIDTH;
    picture.fill([left - scale, top - scale], [wide + 2 * scale, bottom - top + 2 * scale], INK);
    for y in ticks(top, bottom) {
        picture.fill([left + wide, y - scale.div_ceil(2)], [scale * TICK, scale], INK);
    }
    for y in top..bottom {
        let t = 1.0 - 2.0 * (y as f64 + 0.5 - top as f64) / (bottom - top) as f64;
        picture.fill([left, y], [wide, 1], to_srgb(diverging(t)));
    }
}

/// The rows of the five tick marks.
fn ticks(top: usize, bottom: usize) -> [usize; 5] {
    std::array::from_fn(|k| top + (k * (bottom - top) + 2) / 4)
}

/// `value` as written at a bar that ends at `range`, which has two significant digits: as short
/// as it is exact, with an exponent only if the range is very large or very small.
fn number(value: f64, range: f64) -> String {
    if (1e-3..1e5).contains(&range) {
        let decimals = (2.0 - range.log10().floor()).clamp(0.0, 6.0) as usize;
        let text = format!("{value:.decimals$}");
        let text = if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.')
        } else {
            &text
        };
        if value == 0.0 { "0".into() } else { text.into() }
    } else if value == 0.0 {
        "0".into()
    } else {
        format!("{:e}", format!("{value:.2e}").parse::<f64>().unwrap_or(value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        for (value, range, text) in [
            (2.5, 2.5, "2.5"),
            (-1.25, 2.5, "-1.25"),
            (0.0, 2.5, "0"),
            (0.035, 0.035, "0.035"),
            (-0.0175, 0.035, "-0.0175"),
            (1300.0, 1300.0, "1300"),
            (650.0, 1300.0, "650"),
            (1.3e-5, 1.3e-5, "1.3e-5"),
            (-6.5e-6, 1.3e-5, "-6.5e-6"),
            (2e9, 2e9, "2e9"),
        ] {
            assert_eq!(number(value, range), text);
        }
    }

    #[test]
    fn the_bar_shows_the_ends_of_the_colour_map() {
        let mut picture = Picture::new([600, 400], |_| [1.0; 3]);
        draw(&mut picture, Style::Mean, 2.0, 1);
        let x = 600 - WIDTH + BAR_LEFT + 3;
        let close = |y: usize, t: f64| {
            let (a, b) = (picture.pixel(x, y).unwrap(), to_srgb(diverging(t)));
            (0..3).all(|k| a[k].abs_diff(b[k]) <= 2)
        };
        assert!(close(400 / 5, 1.0) && close(400 - 400 / 6 - 1, -1.0));
    }

    #[test]
    fn there_is_no_legend_without_curvature_or_without_room() {
        assert_eq!(width(Style::Shaded, [900, 700], 1), 0);
        assert_eq!(width(Style::Gauss, [100, 700], 1), 0);
        assert_eq!(width(Style::Gauss, [900, 700], 1), WIDTH);
        let mut picture = Picture::new([60, 40], |_| [1.0; 3]);
        draw(&mut picture, Style::Mean, 2.0, 1);
        assert!(picture.pixels().iter().all(|&p| p == [255; 3]));
    }
}
