//! The header: what elements there are, of what properties.

use super::{PlyError, PlyPlace};
use crate::io::excerpt::excerpt;
use crate::io::kind::{Format, Kind};

/// How the values after the header are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// As text.
    Ascii,
    /// As bytes, the least significant first.
    LittleEndian,
    /// As bytes, the most significant first.
    BigEndian,
}

impl Encoding {
    /// The word for it in a header.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ascii => "ascii",
            Self::LittleEndian => "binary_little_endian",
            Self::BigEndian => "binary_big_endian",
        }
    }
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    /// Both names of every type, the older one first.
    const NAMES: [(Self, [&str; 2]); 8] = [
        (Self::I8, ["char", "int8"]),
        (Self::U8, ["uchar", "uint8"]),
        (Self::I16, ["short", "int16"]),
        (Self::U16, ["ushort", "uint16"]),
        (Self::I32, ["int", "int32"]),
        (Self::U32, ["uint", "uint32"]),
        (Self::F32, ["float", "float32"]),
        (Self::F64, ["double", "float64"]),
    ];

    fn from_name(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(_, names)| names.contains(&name)).map(|&(scalar, _)| scalar)
    }

    /// The older of its names.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].1[0]
    }

    /// The least and the largest value of a whole-number type.
    pub fn range(self) -> Option<(f64, f64)> {
        match self {
            Self::I8 => Some((i8::MIN.into(), i8::MAX.into())),
            Self::U8 => Some((0.0, u8::MAX.into())),
            Self::I16 => Some((i16::MIN.into(), i16::MAX.into())),
            Self::U16 => Some((0.0, u16::MAX.into())),
            Self::I32 => Some((i32::MIN.into(), i32::MAX.into())),
            Self::U32 => Some((0.0, u32::MAX.into())),
            Self::F32 | Self::F64 => None,
        }
    }
}

/// A property of all items of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub name: String,
    /// The type of its values.
    pub scalar: Scalar,
    /// The type of the number of values, if it is a list.
    pub count: Option<Scalar>,
}

/// A kind of items, one after the other in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
    /// The line that begins it.
    pub line: usize,
}

impl Element {
    /// The place of a property among all.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|p| p.name == name)
    }
}

/// What stands before the values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// The number of its bytes.
    pub len: usize,
    /// The number of its lines.
    pub num_lines: usize,
}

impl Header {
    /// Reads the header at the beginning of `bytes`.
    pub fn read(bytes: &[u8]) -> Result<Self, PlyError> {
        let mut lines = HeaderLines::new(bytes);
        if lines.next().map(<[u8]>::trim_ascii) != Some(b"ply") {
            let advice = Kind::advice(bytes, Format::Ply);
            return Err(
                lines.fault(&format!("the file does not begin with the line `ply`: {advice}"))
            );
        }
        let mut encoding = None;
        let mut elements = Vec::new();
        while let Some(line) = lines.next() {
            let text = String::from_utf8_lossy(line);
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            match words[..] {
                [] | ["comment" | "obj_info", ..] => Ok(()),
                ["end_header"] => return lines.end(encoding, elements),
                ["format", name, version] => {
                    read_format(name, version).map(|found| encoding = Some(found))
                }
                ["element", name, count] => add_element(&mut elements, name, count, lines.number),
                ["property", ref words @ ..] => add_property(&mut elements, words),
                _ => Err(format!(
                    "`{}` is no line of a header: they are written as in `format ascii 1.0`, \
                     `element vertex 8`, `property float x`, `comment ...`, `end_header`",
                    excerpt(line)
                )),
            }
            .map_err(|message| lines.fault(&message))?;
        }
        Err(lines.fault("the header has no end: add the line `end_header`"))
    }
}

/// The lines of a header, which all end like the first.
struct HeaderLines<'a> {
    bytes: &'a [u8],
    at: usize,
    line_end: &'static [u8],
    /// The number of the latest line, from 1.
    number: usize,
}

impl<'a> HeaderLines<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        let first = bytes.iter().position(|b| matches!(b, b'\n' | b'\r'));
        let line_end: &[u8] = match first.map(|at| &bytes[at..]) {
            Some([b'\r', b'\n', ..]) => b"\r\n",
            Some([b'\r', ..]) => b"\r",
            _ => b"\n",
        };
        Self { bytes, at: 0, line_end, number: 0 }
    }

    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let len = rest.windows(self.line_end.len()).position(|w| w == self.line_end);
        if rest.is_empty() {
            return None;
        }
        self.number += 1;
        let len = len.unwrap_or(rest.len());
        self.at = (self.at + len + self.line_end.len()).min(self.bytes.len());
        Some(&rest[..len])
    }

    fn fault(&self, message: &str) -> PlyError {
        let place = PlyPlace::Line(self.number.max(1));
        PlyError { place, item: None, message: message.to_owned() }
    }

    fn end(&self, encoding: Option<Encoding>, elements: Vec<Element>) -> Result<Header, PlyError> {
        let encoding = encoding.ok_or_else(|| {
            self.fault("the header names no format: add a line as in `format ascii 1.0`")
        })?;
        // An item without properties takes no place: any number of them would be there.
        if let Some(empty) = elements.iter().find(|e| e.count > 0 && e.properties.is_empty()) {
            let message =
                format!("the element `{}` has no properties: delete it", word(&empty.name));
            return Err(PlyError { place: PlyPlace::Line(empty.line), item: None, message });
        }
        Ok(Header { encoding, elements, len: self.at, num_lines: self.number })
    }
}

fn read_format(name: &str, version: &str) -> Result<Encoding, String> {
    let all = [Encoding::Ascii, Encoding::LittleEndian, Encoding::BigEndian];
    match all.into_iter().find(|encoding| encoding.name() == name) {
        Some(encoding) if version == "1.0" => Ok(encoding),
        Some(_) => Err(format!(
            "version {} of PLY is not known: write the file as `format {name} 1.0`",
            word(version)
        )),
        None => Err(format!(
            "`{}` is no format: it can be ascii, binary_little_endian or binary_big_endian",
            word(name)
        )),
    }
}

fn add_element(
    elements: &mut Vec<Element>,
    name: &str,
    count: &str,
    line: usize,
) -> Result<(), String> {
    if elements.iter().any(|e| e.name == name) {
        return Err(format!("there is another element `{}`: join them", word(name)));
    }
    let count = count.parse().map_err(|_| {
        let name = word(name);
        let count = word(count);
        format!("`{count}` is no number of items: write how many follow, as in `element {name} 8`")
    })?;
    elements.push(Element { name: name.to_owned(), count, properties: Vec::new(), line });
    Ok(())
}

fn add_property(elements: &mut [Element], words: &[&str]) -> Result<(), String> {
    let element = elements.last_mut().ok_or("a property must follow the line of its element")?;
    let property = match *words {
        ["list", count, scalar, name] => {
            let count = read_scalar(count)?;
            if count.range().is_none() {
                return Err("the number of values in a list must be of a whole-number type".into());
            }
            Property { name: name.to_owned(), scalar: read_scalar(scalar)?, count: Some(count) }
        }
        [scalar, name] if scalar != "list" => {
            Property { name: name.to_owned(), scalar: read_scalar(scalar)?, count: None }
        }
        _ => {
            return Err("a property is written as in `property float x` or `property list uchar \
                        int vertex_indices`"
                .into());
        }
    };
    if element.find(&property.name).is_some() {
        return Err(format!("there is another property `{}`: rename one", word(&property.name)));
    }
    element.properties.push(property);
    Ok(())
}

fn read_scalar(name: &str) -> Result<Scalar, String> {
    Scalar::from_name(name).ok_or_else(|| {
        let names: Vec<&str> = Scalar::NAMES.iter().map(|(_, names)| names[0]).collect();
        format!("`{}` is no type: it can be {}", word(name), names.join(", "))
    })
}

/// A word of the header, fit for messages.
pub(super) fn word(word: &str) -> String {
    excerpt(word.as_bytes())
}
