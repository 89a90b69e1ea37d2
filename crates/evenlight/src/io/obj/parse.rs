//! The reader: one walk over the words of a file, then a look at what asked for later lines.

use std::collections::HashMap;

use super::fault::{Channel, Element, Faults, LineFault, ReadError, Reason, excerpt};
use super::words::Words;
use super::{Obj, Source, UnknownTag};
use crate::mesh::{Faces, Mesh, VertexId};
use crate::point::Point;

/// How many there may be of each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub lines: usize,
    pub vertices: usize,
    pub faces: usize,
    pub corners: usize,
}

impl Default for Limits {
    /// As many as 32 bits can number.
    fn default() -> Self {
        let all = u32::MAX as usize;
        Self { lines: all, vertices: all, faces: all, corners: all }
    }
}

/// [`super::read`] under `limits`, which tests can reach.
pub(super) fn read(bytes: &[u8], limits: Limits) -> Result<Obj, ReadError> {
    let mut reader = Reader::new(bytes, limits);
    let complete = reader.read_lines();
    // What asked for later lines can only be judged if all lines were seen.
    let late = if complete { reader.late_faults() } else { Faults::default() };
    std::mem::take(&mut reader.faults).merge(late).into_result()?;
    Ok(reader.into_obj())
}

/// What was read so far.
struct Reader<'a> {
    bytes: &'a [u8],
    words: Words<'a>,
    limits: Limits,
    positions: Vec<Point>,
    faces: Faces,
    num_textures: usize,
    num_normals: usize,
    source: Source,
    tags: Tags<'a>,
    /// The corners with a number that nothing had yet, to be looked at again at the end.
    forward: Vec<Forward>,
    faults: Faults,
    /// The corners of the face being read.
    corners: Vec<VertexId>,
}

/// A corner that asks for something later.
struct Forward {
    line: u32,
    face: u32,
    /// Where the corner stands in the file.
    at: usize,
}

impl<'a> Reader<'a> {
    fn new(bytes: &'a [u8], limits: Limits) -> Self {
        Self {
            bytes,
            words: Words::new(bytes),
            limits,
            positions: Vec::new(),
            faces: Faces::default(),
            num_textures: 0,
            num_normals: 0,
            source: Source::default(),
            tags: Tags::default(),
            forward: Vec::new(),
            faults: Faults::default(),
            corners: Vec::new(),
        }
    }

    /// Reads until the end, or until there is too much of something; whether to the end.
    fn read_lines(&mut self) -> bool {
        loop {
            if let Some(tag) = self.words.next()
                && let Err(fault) = self.statement(tag)
            {
                let too_many = matches!(fault.reason, Reason::TooMany { .. });
                self.faults.push(fault);
                if too_many {
                    return false;
                }
            }
            if !self.words.next_line() {
                return true;
            }
        }
    }

    /// Reads the rest of a line.
    fn statement(&mut self, tag: &'a [u8]) -> Result<(), LineFault> {
        let line = u32::try_from(self.words.line()).unwrap_or(u32::MAX);
        let fault = |element| move |reason| LineFault { line, element, reason };
        room("lines", self.words.line(), self.limits.lines).map_err(fault(None))?;
        match tag {
            b"v" => {
                let element = Element::Vertex(self.positions.len() as u64 + 1);
                self.vertex(tag, line).map_err(fault(Some(element)))?;
            }
            b"f" => {
                let element = Element::Face(self.faces.len() as u64 + 1);
                self.face(line).map_err(fault(Some(element)))?;
            }
            b"vt" => self.num_textures += 1,
            b"vn" => self.num_normals += 1,
            b"o" | b"g" | b"s" | b"usemtl" | b"mtllib" => {}
            _ => self.tags.count(tag, line),
        }
        Ok(())
    }

    fn vertex(&mut self, tag: &[u8], line: u32) -> Result<(), Reason> {
        room("vertices", self.positions.len() + 1, self.limits.vertices)?;
        let position = self.coordinates(self.words.position() - tag.len());
        // A faulty vertex keeps its place, so that the faces' numbers stay right.
        self.positions.push(position.clone().unwrap_or_default());
        self.source.vertex_lines.push(line);
        position.map(drop)
    }

    /// The coordinates on a line whose tag stands at `start`.
    fn coordinates(&mut self, start: usize) -> Result<Point, Reason> {
        let mut position = [0.0; 3];
        let mut found = 0;
        for word in &mut self.words {
            let x = number(word).ok_or_else(|| Reason::NotANumber { text: excerpt(word) })?;
            if let Some(coordinate) = position.get_mut(found) {
                *coordinate = x;
            }
            found += 1;
        }
        if found < 3 {
            let text = excerpt(self.bytes[start..self.words.position()].trim_ascii_end());
            return Err(Reason::TooFewCoordinates { text, found });
        }
        Ok(position)
    }

    fn face(&mut self, line: u32) -> Result<(), Reason> {
        room("faces", self.faces.len() + 1, self.limits.faces)?;
        let num_forward = self.forward.len();
        let corners = self.read_corners(line);
        if corners.is_err() {
            self.forward.truncate(num_forward); // one fault per line
        }
        let num_corners = self.faces.all_corners().len() + self.corners.len();
        room("corners", num_corners, self.limits.corners)?;
        self.faces.push(self.corners.iter().copied());
        self.source.face_lines.push(line);
        corners
    }

    fn read_corners(&mut self, line: u32) -> Result<(), Reason> {
        self.corners.clear();
        while let Some(word) = self.words.next() {
            let corner = corner(word).ok_or_else(|| Reason::NotACorner { text: excerpt(word) })?;
            let forward = self.reaches_forward(&corner, word)?;
            if forward {
                let at = self.words.position() - word.len();
                self.forward.push(Forward { line, face: self.faces.len() as u32, at });
            }
            self.corners.push(self.vertex_of(&corner));
        }
        Ok(())
    }

    /// Whether a number of the corner is of something later.
    fn reaches_forward(&self, corner: &Corner, word: &[u8]) -> Result<bool, Reason> {
        let mut forward = false;
        for (channel, index, count) in self.numbers(corner) {
            let text = || excerpt(word);
            if index == 0 {
                return Err(Reason::IndexZero { text: text(), channel });
            }
            if index.unsigned_abs() > count as u64 {
                if index < 0 {
                    return Err(Reason::IndexBeforeFirst { text: text(), channel, index, count });
                }
                forward = true;
            }
        }
        Ok(forward)
    }

    /// The numbers of a corner, with how many things there are so far of each kind.
    fn numbers(&self, corner: &Corner) -> impl Iterator<Item = (Channel, i64, usize)> + use<> {
        let [vertex, texture, normal] = *corner;
        let numbers = [
            (Channel::Vertex, vertex, self.positions.len()),
            (Channel::Texture, texture, self.num_textures),
            (Channel::Normal, normal, self.num_normals),
        ];
        numbers.into_iter().filter_map(|(channel, index, count)| Some((channel, index?, count)))
    }

    /// The vertex of a corner that does not reach back too far; one that no mesh has if its
    /// number is too large for a mesh.
    fn vertex_of(&self, corner: &Corner) -> VertexId {
        let index = corner[0].unwrap_or(0);
        let id = if index < 0 { self.positions.len() as i64 + index } else { index - 1 };
        VertexId(u32::try_from(id).unwrap_or(u32::MAX))
    }

    /// The faults of corners that asked for something later which did not come.
    fn late_faults(&self) -> Faults {
        let mut faults = Faults::default();
        let mut last_face = None;
        for forward in &self.forward {
            if last_face == Some(forward.face) {
                continue; // one fault per line
            }
            if let Some(reason) = self.late_fault(forward.at) {
                let element = Some(Element::Face(u64::from(forward.face) + 1));
                faults.push(LineFault { line: forward.line, element, reason });
                last_face = Some(forward.face);
            }
        }
        faults
    }

    fn late_fault(&self, at: usize) -> Option<Reason> {
        let word = Words::starting_at(self.bytes, at).next()?;
        let corner = corner(word)?;
        let mut missing = self.numbers(&corner).filter(|&(_, i, count)| i > count as i64);
        let (channel, index, count) = missing.next()?;
        Some(Reason::IndexTooLarge { text: excerpt(word), channel, index, count })
    }

    fn into_obj(self) -> Obj {
        let mesh = Mesh { positions: self.positions, faces: self.faces, ..Mesh::default() };
        Obj { mesh, source: self.source, unknown_tags: self.tags.list }
    }
}

/// Whether `count` things are no more than may be.
fn room(what: &'static str, count: usize, limit: usize) -> Result<(), Reason> {
    if count > limit { Err(Reason::TooMany { what, limit }) } else { Ok(()) }
}

/// The tags that are not known.
#[derive(Default)]
struct Tags<'a> {
    /// Where each tag stands in `list`.
    places: HashMap<&'a [u8], usize>,
    list: Vec<UnknownTag>,
}

impl<'a> Tags<'a> {
    fn count(&mut self, tag: &'a [u8], line: u32) {
        let place = *self.places.entry(tag).or_insert(self.list.len());
        if place == self.list.len() {
            self.list.push(UnknownTag { name: excerpt(tag), count: 0, first_line: line });
        }
        self.list[place].count += 1;
    }
}

/// The numbers of a corner as written: vertex, texture coordinate, normal. There is always the
/// first.
type Corner = [Option<i64>; 3];

fn corner(word: &[u8]) -> Option<Corner> {
    let mut corner = [None; 3];
    for (k, part) in word.split(|&b| b == b'/').enumerate() {
        let number = corner.get_mut(k)?;
        if !part.is_empty() {
            *number = Some(index(part)?);
        }
    }
    corner[0].is_some().then_some(corner)
}

/// A whole number; the nearest of 64 bits if it is too large.
fn index(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() {
        return None;
    }
    let value = digits.iter().try_fold(0i64, |value, &digit| {
        let digit = digit.is_ascii_digit().then(|| i64::from(digit - b'0'))?;
        Some(value.saturating_mul(10).saturating_add(digit))
    })?;
    Some(if negative { -value } else { value })
}

fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n\
        f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

    fn tetrahedron(limits: Limits) -> Result<Obj, ReadError> {
        read(TETRAHEDRON, limits)
    }

    #[test]
    fn more_than_can_be_numbered_is_an_error_that_names_where_it_became_too_much() {
        let just = Limits { lines: 8, vertices: 4, faces: 4, corners: 12 };
        assert!(tetrahedron(just).is_ok());
        for (limits, expected) in [
            (Limits { lines: 7, ..just }, "line 8: there are more than 7 lines: split the file"),
            (Limits { vertices: 3, ..just }, "line 4, vertex 4: there are more than 3 vertices"),
            (Limits { faces: 3, ..just }, "line 8, face 4: there are more than 3 faces"),
            (Limits { corners: 11, ..just }, "line 8, face 4: there are more than 11 corners"),
            // What the first face asks for is not missing: the reader did not come that far.
            (Limits { vertices: 0, ..just }, "line 1, vertex 1: there are more than 0 vertices"),
        ] {
            let error = tetrahedron(limits).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }

    #[test]
    fn indices_saturate() {
        assert_eq!(index(b"9223372036854775807"), Some(i64::MAX));
        assert_eq!(index(b"9223372036854775808"), Some(i64::MAX));
        assert_eq!(index(b"-99999999999999999999"), Some(-i64::MAX));
        assert_eq!(index(b"+0012"), Some(12));
        for word in [&b""[..], b"-", b"+", b"1.", b"1e0", b"--1", b"0x1", b"\xd9\xa1"] {
            assert_eq!(index(word), None);
        }
    }

    #[test]
    fn corners_have_one_to_three_parts() {
        assert_eq!(corner(b"1"), Some([Some(1), None, None]));
        assert_eq!(corner(b"1/2"), Some([Some(1), Some(2), None]));
        assert_eq!(corner(b"-1//3"), Some([Some(-1), None, Some(3)]));
        assert_eq!(corner(b"1/-2/3"), Some([Some(1), Some(-2), Some(3)]));
        assert_eq!(corner(b"1//"), corner(b"1"));
        for word in [&b"/1"[..], b"//", b"1/2/3/", b"1/a", b"1,2"] {
            assert_eq!(corner(word), None);
        }
    }
}
