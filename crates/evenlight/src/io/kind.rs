//! The kinds of files, by their names and by how they begin.

use std::path::Path;

/// The kinds of files that hold cages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// PLY, ascii or binary.
    Ply,
    /// USD as text.
    Usda,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Obj, Self::Ply, Self::Usda];

    /// Its name, as in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Usda => "USD",
        }
    }

    /// How the names of such files end.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Obj => ".obj",
            Self::Ply => ".ply",
            Self::Usda => ".usda",
        }
    }

    /// The kind of file that ends in `.extension`, in small or capital letters.
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            // The reader says what to do with binary files.
            "usda" | "usd" | "usdc" | "usdz" => Some(Self::Usda),
            _ => None,
        }
    }

    /// The kind of file that the ending of its name tells, if it does.
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        Self::from_extension(path.as_ref().extension()?.to_str()?)
    }

    /// The kind of file that `bytes` seem to be, by their first line; OBJ if by none.
    pub fn of_content(bytes: &[u8]) -> Self {
        match Kind::of(bytes) {
            Some(Kind::Cage(format)) => format,
            Some(Kind::Other(_)) | None => Self::Obj,
        }
    }
}

/// What bytes seem to be, whatever the name of their file says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// One that holds cages.
    Cage(Format),
    /// One that is not read.
    Other(&'static str),
}

impl Kind {
    /// The kind that `bytes` begin as, if that is clear.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let begins = |start: &[u8]| bytes.starts_with(start);
        let head = &bytes[..bytes.len().min(1000)];
        match bytes {
            [b'p', b'l', b'y', b'\n' | b'\r' | b' ', ..] => Some(Self::Cage(Format::Ply)),
            _ if begins(b"#usda") || begins(b"PXR-USDC") => Some(Self::Cage(Format::Usda)),
            _ if begins(b"glTF") => Some(Self::Other("glTF")),
            _ if begins(b"Kaydara FBX") || begins(b"; FBX") => Some(Self::Other("FBX")),
            _ if begins(b"OFF\n") || begins(b"OFF\r") => Some(Self::Other("OFF")),
            _ if begins(b"solid") && contains(head, b"facet normal") => Some(Self::Other("STL")),
            _ if begins_as_obj(bytes) => Some(Self::Cage(Format::Obj)),
            _ => None,
        }
    }

    /// What to do with `bytes`, which are not of the kind `expected`, as the end of a sentence.
    pub fn advice(bytes: &[u8], expected: Format) -> String {
        match Self::of(bytes) {
            _ if bytes.trim_ascii().is_empty() => "it is empty".to_owned(),
            Some(Self::Cage(format)) if format != expected => {
                format!("it looks like {}: let its name end in {}", format.name(), format.ending())
            }
            Some(Self::Other(name)) => not_read(name),
            _ => format!(
                "let its name end in that of its format ({}), or correct it",
                Format::ALL.map(Format::ending).join(", ")
            ),
        }
    }

    /// Why `bytes` are no OBJ file, to which no beginning is prescribed, as the end of a sentence.
    pub fn not_obj(bytes: &[u8]) -> Option<String> {
        match Self::of(bytes)? {
            Self::Cage(Format::Obj) => None,
            Self::Cage(_) => Some(Self::advice(bytes, Format::Obj)),
            Self::Other(name) => Some(not_read(name)),
        }
    }
}

fn not_read(name: &str) -> String {
    let formats = Format::ALL.map(Format::name);
    format!("it looks like {name}, which is not read: convert it to one of {}", formats.join(", "))
}

fn contains(bytes: &[u8], word: &[u8]) -> bool {
    bytes.windows(word.len()).any(|w| w == word)
}

/// Whether the first line that is no comment begins with a word of OBJ.
fn begins_as_obj(bytes: &[u8]) -> bool {
    const WORDS: [&[u8]; 8] = [b"v", b"vt", b"vn", b"f", b"o", b"g", b"mtllib", b"usemtl"];
    let mut lines = bytes.split(|b| matches!(b, b'\n' | b'\r')).map(<[u8]>::trim_ascii);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with(b"#"));
    let word = first.and_then(|line| line.split(u8::is_ascii_whitespace).next());
    word.is_some_and(|word| WORDS.contains(&word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_known_by_their_beginning() {
        for (bytes, expected) in [
            (&b"ply\nformat"[..], Some(Kind::Cage(Format::Ply))),
            (b"#usda 1.0", Some(Kind::Cage(Format::Usda))),
            (b"# Blender\n\n  v 0 0 0", Some(Kind::Cage(Format::Obj))),
            (b"mtllib a.mtl\r\n", Some(Kind::Cage(Format::Obj))),
            (b"solid a\nfacet normal 0 0 1", Some(Kind::Other("STL"))),
            (b"glTF\x02\0\0\0", Some(Kind::Other("glTF"))),
            (b"Kaydara FBX Binary  \0", Some(Kind::Other("FBX"))),
            (b"solid ground", None),
            (b"plywood", None),
            (b"", None),
        ] {
            assert_eq!(Kind::of(bytes), expected, "{bytes:?}");
        }
    }
}
