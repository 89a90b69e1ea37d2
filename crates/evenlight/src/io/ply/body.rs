//! The values after the header, one by one, whatever their encoding.

use super::PlyPlace;
use super::header::{Encoding, Header, Scalar};
use crate::io::excerpt::excerpt;

/// A walk over the values of a file.
pub(super) struct Body<'a> {
    encoding: Encoding,
    bytes: &'a [u8],
    at: usize,
    line: usize,
    /// Where the latest value stands.
    place: PlyPlace,
}

impl<'a> Body<'a> {
    /// Stands after `header` at the beginning of `bytes`.
    pub fn new(bytes: &'a [u8], header: &Header) -> Self {
        let line = header.num_lines + 1;
        let place = PlyPlace::Line(line);
        Self { encoding: header.encoding, bytes, at: header.len, line, place }
    }

    /// Where the latest value stands.
    pub fn place(&self) -> PlyPlace {
        self.place
    }

    /// The line of the next value, in text.
    pub fn next_line(&mut self) -> Option<u32> {
        if self.encoding != Encoding::Ascii {
            return None;
        }
        self.skip_blanks();
        u32::try_from(self.line).ok()
    }

    /// How many bytes are left; blanks at the end of text do not count.
    pub fn num_left(&mut self) -> usize {
        if self.encoding == Encoding::Ascii {
            self.skip_blanks();
        }
        self.bytes.len() - self.at
    }

    /// The next value; all types fit into an `f64`.
    pub fn next(&mut self, scalar: Scalar) -> Result<f64, String> {
        let value = match self.encoding {
            Encoding::Ascii => self.next_word(scalar),
            Encoding::LittleEndian | Encoding::BigEndian => self.next_bytes(scalar),
        };
        value
            .ok_or_else(|| "the file ends before its last element: correct the counts".to_owned())?
    }

    fn next_bytes(&mut self, scalar: Scalar) -> Option<Result<f64, String>> {
        self.place = PlyPlace::Byte(self.at);
        Some(Ok(match scalar {
            Scalar::I8 => self.take().map(i8::from_le_bytes)?.into(),
            Scalar::U8 => self.take().map(u8::from_le_bytes)?.into(),
            Scalar::I16 => self.take().map(i16::from_le_bytes)?.into(),
            Scalar::U16 => self.take().map(u16::from_le_bytes)?.into(),
            Scalar::I32 => self.take().map(i32::from_le_bytes)?.into(),
            Scalar::U32 => self.take().map(u32::from_le_bytes)?.into(),
            Scalar::F32 => self.take().map(f32::from_le_bytes)?.into(),
            Scalar::F64 => self.take().map(f64::from_le_bytes)?,
        }))
    }

    /// The next `N` bytes, the least significant first.
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let mut bytes: [u8; N] = *self.bytes.get(self.at..)?.first_chunk()?;
        if self.encoding == Encoding::BigEndian {
            bytes.reverse();
        }
        self.at += N;
        Some(bytes)
    }

    fn next_word(&mut self, scalar: Scalar) -> Option<Result<f64, String>> {
        self.skip_blanks();
        self.place = PlyPlace::Line(self.line);
        let rest = &self.bytes[self.at..];
        let len = rest.iter().take_while(|b| !b.is_ascii_whitespace()).count();
        if len == 0 {
            return None;
        }
        self.at += len;
        Some(parse(&rest[..len], scalar))
    }

    fn skip_blanks(&mut self) {
        while let Some(&b) = self.bytes.get(self.at).filter(|b| b.is_ascii_whitespace()) {
            // CRLF is one end of a line.
            let is_half = b == b'\r' && self.bytes.get(self.at + 1) == Some(&b'\n');
            self.line += usize::from(matches!(b, b'\n' | b'\r') && !is_half);
            self.at += 1;
        }
    }
}

/// A word of an ascii file as a value of the type.
fn parse(word: &[u8], scalar: Scalar) -> Result<f64, String> {
    let text = std::str::from_utf8(word).unwrap_or_default();
    let Some((least, largest)) = scalar.range() else {
        return text
            .parse()
            .map_err(|_| format!("`{}` is not a number: correct it", excerpt(word)));
    };
    let value = text.parse::<i64>().ok().map(|i| i as f64);
    value.filter(|i| (least..=largest).contains(i)).ok_or_else(|| {
        format!(
            "`{}` is not a whole number from {least} to {largest} (`{}`): correct it",
            excerpt(word),
            scalar.name()
        )
    })
}
