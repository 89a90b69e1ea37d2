//! Letters of fixed width, as bitmaps.
//!
//! ```text
//!        at (middle of the left side)
//!         |   +-------+-------+
//!         |   |  ##   |       |   a row is a number: its bit k, from the least, is column k
//!         +-> | #  #  | ...   |   from the left
//!             |  ##   |       |
//!             +-------+-------+
//!               width   width
//! ```
//!
//! A font has the characters of Latin-1 that can be seen; `?` stands for any other. The bitmaps
//! ([`glyphs`]) are generated, so that the library needs no crate to draw text.

mod glyphs;

pub(super) use glyphs::{BOLD, LARGE_BOLD, REGULAR};

/// A font of fixed width.
#[derive(Debug)]
pub(super) struct Font {
    /// The columns of a character.
    pub width: usize,
    /// The rows of a character.
    pub height: usize,
    /// The rows of all characters, one character after the other: U+0020 to U+007F, then U+00A0 to
    /// U+00FF.
    rows: &'static [u16],
}

/// Which part of a text is at the place where it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Alignment {
    /// The left end.
    Left,
    /// The middle.
    Center,
}

impl Font {
    /// Calls `ink` with the column and the row of every pixel of `line` that is not empty; what is
    /// left of or above the picture is left out.
    pub fn draw(
        &self,
        line: &str,
        [x, y]: [usize; 2],
        alignment: Alignment,
        mut ink: impl FnMut(usize, usize),
    ) {
        let width = self.width * line.chars().count();
        let (left, top) = match alignment {
            Alignment::Left => (x as isize, y as isize),
            Alignment::Center => (x as isize - (width as isize - 1) / 2, y as isize),
        };
        let top = top - (self.height as isize - 1) / 2;
        for (k, c) in line.chars().enumerate() {
            for (row, bits) in (top..).zip(self.glyph(c)) {
                for column in (0..self.width).filter(|column| bits >> column & 1 == 1) {
                    let column = left + (k * self.width + column) as isize;
                    if let (Ok(x), Ok(y)) = (usize::try_from(column), usize::try_from(row)) {
                        ink(x, y);
                    }
                }
            }
        }
    }

    /// The rows of a character from the top.
    fn glyph(&self, c: char) -> &[u16] {
        let at = index(c) * self.height;
        &self.rows[at..at + self.height]
    }
}

/// Which of the characters of a font `c` is.
fn index(c: char) -> usize {
    match c {
        ' '..='\u{7f}' => c as usize - 0x20,
        '\u{a0}'..='\u{ff}' => c as usize - 0xa0 + 0x60,
        _ => index('?'),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(font: &Font, line: &str, at: [usize; 2], alignment: Alignment) -> Vec<[usize; 2]> {
        let mut pixels = Vec::new();
        font.draw(line, at, alignment, |x, y| pixels.push([x, y]));
        pixels
    }

    #[test]
    fn fonts_have_all_rows_of_all_characters() {
        for font in [&REGULAR, &BOLD, &LARGE_BOLD] {
            assert_eq!(font.rows.len(), 192 * font.height);
            assert!(font.rows.iter().all(|row| usize::from(*row) < 1 << font.width));
            assert!(
                font.glyph('K').iter().any(|row| *row > 0)
                    && font.glyph(' ') == font.glyph('\u{a0}')
            );
        }
    }

    #[test]
    fn unknown_characters_are_question_marks() {
        for c in ['\u{3bb}', '\u{80}', '\u{1f9ca}', '\n'] {
            assert_eq!(REGULAR.glyph(c), REGULAR.glyph('?'));
        }
        assert_ne!(REGULAR.glyph('\u{e9}'), REGULAR.glyph('?'));
    }

    #[test]
    fn a_vertical_bar_shows_where_text_is_put() {
        // A symmetric letter of width 7: its stem is column 3 of the character.
        let columns = |at, alignment| -> Vec<usize> {
            let pixels = drawn(&REGULAR, "|", at, alignment);
            pixels.into_iter().map(|[x, _]| x).collect()
        };
        assert!(columns([10, 20], Alignment::Left).iter().all(|&x| x == 13));
        assert!(columns([10, 20], Alignment::Center).iter().all(|&x| x == 10));
        let rows = drawn(&REGULAR, "|", [10, 20], Alignment::Left);
        assert!(rows.iter().all(|[_, y]| (14..27).contains(y)));
    }

    #[test]
    fn text_beyond_the_left_and_upper_end_is_left_out() {
        let all = drawn(&LARGE_BOLD, "abc", [100, 100], Alignment::Center);
        let some = drawn(&LARGE_BOLD, "abc", [0, 0], Alignment::Center);
        let [dx, dy] = [100, 100];
        let kept: Vec<_> = all.iter().filter(|[x, y]| *x >= dx && *y >= dy).collect();
        assert!(!some.is_empty() && some.len() < all.len());
        assert!(kept.iter().zip(&some).all(|(a, b)| [a[0] - dx, a[1] - dy] == *b));
    }
}
