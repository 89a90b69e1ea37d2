//! The reader: one walk over the words of a file, then a look at what asked for later lines.

use std::collections::HashMap;

use super::fault::{Element, Faults, IndexKind, LineFault, ObjError, Reason, excerpt};
use super::primvars::Primvars;
use super::skipped::Skipped;
use super::tag::{self, Outcome};
use super::words::Words;
use super::{Obj, Source, UnknownTag};
use crate::io::kind::Kind;
use crate::mesh::{Faces, Mesh, Tags, VertexId};
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
pub(super) fn read(bytes: &[u8], limits: Limits) -> Result<Obj, ObjError> {
    if let Some(what) = Kind::not_obj(bytes) {
        let fault = LineFault { line: 1, element: None, reason: Reason::OtherKind { what } };
        return Err(ObjError { faults: vec![fault], num_more: 0 });
    }
    let mut reader = ObjReader::new(bytes, limits);
    let complete = reader.read_lines();
    // What asked for later lines can only be judged if all lines were seen.
    let late = if complete {
        reader.late_faults().merge(reader.late_tag_faults())
    } else {
        Faults::default()
    };
    std::mem::take(&mut reader.faults).merge(late).into_result()?;
    Ok(reader.into_obj())
}

/// What was read so far.
struct ObjReader<'a> {
    bytes: &'a [u8],
    words: Words<'a>,
    limits: Limits,
    positions: Vec<Point>,
    faces: Faces,
    num_normals: usize,
    primvars: Primvars,
    tags: Tags,
    source: Source,
    unknown: UnknownTags<'a>,
    skipped: Option<Skipped>,
    /// The corners with a number that nothing had yet, to be looked at again at the end.
    forward: Vec<Forward>,
    faults: Faults,
    /// The corners of the face being read, and their texture coordinates.
    corners: Vec<VertexId>,
    textures: Vec<Option<u32>>,
}

/// A corner that asks for something later.
struct Forward {
    line: u32,
    face: u32,
    /// Where the corner stands in the file.
    at: usize,
}

impl<'a> ObjReader<'a> {
    fn new(bytes: &'a [u8], limits: Limits) -> Self {
        Self {
            bytes,
            words: Words::new(bytes),
            limits,
            positions: Vec::new(),
            faces: Faces::default(),
            num_normals: 0,
            primvars: Primvars::default(),
            tags: Tags::default(),
            source: Source::default(),
            unknown: UnknownTags::default(),
            skipped: None,
            forward: Vec::new(),
            faults: Faults::default(),
            corners: Vec::new(),
            textures: Vec::new(),
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
            b"vt" => {
                let element = Element::Texture(self.primvars.num_textures() as u64 + 1);
                self.texture(tag).map_err(fault(Some(element)))?;
            }
            b"t" => self.tag(tag, line).map_err(fault(None))?,
            _ if Skipped::count(&mut self.skipped, tag, line) => {
                self.num_normals += usize::from(tag == b"vn");
            }
            _ => self.unknown.count(tag, line),
        }
        Ok(())
    }

    fn vertex(&mut self, tag: &[u8], line: u32) -> Result<(), Reason> {
        room("vertices", self.positions.len() + 1, self.limits.vertices)?;
        let numbers = self.numbers_of_line::<6>(self.words.position() - tag.len(), 3);
        // A faulty vertex keeps its place, so that the faces' numbers stay right.
        let [x, y, z, ..] = numbers.as_ref().map_or([0.0; 6], |numbers| numbers.values);
        self.positions.push([x, y, z]);
        self.source.vertex_lines.push(line);
        let numbers = numbers?;
        match (numbers.found, numbers.values[3]) {
            (3, _) | (4, 1.0) => {}
            (4, weight) => {
                return Err(Reason::Weight { text: excerpt(weight.to_string().as_bytes()) });
            }
            (6, _) => {
                numbers.refuse_non_finite()?;
                self.primvars.add_color(numbers.values);
            }
            _ => drop(Skipped::count(&mut self.skipped, tag, line)),
        }
        Ok(())
    }

    fn texture(&mut self, tag: &[u8]) -> Result<(), Reason> {
        room("texture coordinates", self.primvars.num_textures() + 1, self.limits.corners)?;
        let numbers = self.numbers_of_line::<3>(self.words.position() - tag.len(), 1);
        self.primvars.add_texture(numbers.as_ref().map_or([0.0; 3], |numbers| numbers.values));
        numbers?.refuse_non_finite()
    }

    /// The first `N` numbers on a line whose tag stands at `start`, of which there must be
    /// `needed`; all words must be numbers.
    fn numbers_of_line<const N: usize>(
        &mut self,
        start: usize,
        needed: usize,
    ) -> Result<Numbers<'a, N>, Reason> {
        let mut numbers = Numbers { values: [0.0; N], found: 0, non_finite: None };
        for word in &mut self.words {
            let x = number(word).ok_or_else(|| Reason::NotANumber { text: excerpt(word) })?;
            if let Some(value) = numbers.values.get_mut(numbers.found) {
                *value = x;
                // The positions are judged with the mesh, as they can also come from elsewhere.
                if !x.is_finite() && numbers.found >= N - 3 {
                    numbers.non_finite = Some(word);
                }
            }
            numbers.found += 1;
        }
        if numbers.found < needed {
            let text = excerpt(self.bytes[start..self.words.position()].trim_ascii_end());
            return Err(Reason::TooFewCoordinates { text, found: numbers.found, needed });
        }
        Ok(numbers)
    }

    fn tag(&mut self, tag: &[u8], line: u32) -> Result<(), Reason> {
        let start = self.words.position() - tag.len();
        let tags = tag::Line::read(&mut self.words)?;
        match tags.apply(&mut self.tags)? {
            Outcome::Kept => self.source.end_tags(line, &self.tags),
            Outcome::Ignored => self.unknown.count(&self.bytes[start..tags.name_end], line),
        }
        Ok(())
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
        self.primvars.add_corners(self.faces.all_corners().len(), &self.textures);
        self.faces.push(self.corners.iter().copied());
        self.source.face_lines.push(line);
        corners
    }

    fn read_corners(&mut self, line: u32) -> Result<(), Reason> {
        self.corners.clear();
        self.textures.clear();
        while let Some(word) = self.words.next() {
            let corner = corner(word).ok_or_else(|| Reason::NotACorner { text: excerpt(word) })?;
            let forward = self.reaches_forward(&corner, word)?;
            if forward {
                let at = self.words.position() - word.len();
                self.forward.push(Forward { line, face: self.faces.len() as u32, at });
            }
            self.corners.push(VertexId(id(corner[0].unwrap_or(0), self.positions.len())));
            self.textures.push(corner[1].map(|index| id(index, self.primvars.num_textures())));
        }
        Ok(())
    }

    /// Whether a number of the corner is of something later.
    fn reaches_forward(&self, corner: &CornerIndices, word: &[u8]) -> Result<bool, Reason> {
        let mut forward = false;
        for (kind, index, count) in self.numbers(corner) {
            let text = || excerpt(word);
            if index == 0 {
                return Err(Reason::IndexZero { text: text(), kind });
            }
            if index.unsigned_abs() > count as u64 {
                if index < 0 {
                    let index = part(word, kind);
                    return Err(Reason::IndexBeforeFirst { text: text(), kind, index, count });
                }
                forward = true;
            }
        }
        Ok(forward)
    }

    /// The numbers of a corner, with how many things there are so far of each kind.
    fn numbers(
        &self,
        corner: &CornerIndices,
    ) -> impl Iterator<Item = (IndexKind, i64, usize)> + use<> {
        let [vertex, texture, normal] = *corner;
        let numbers = [
            (IndexKind::Vertex, vertex, self.positions.len()),
            (IndexKind::Texture, texture, self.primvars.num_textures()),
            (IndexKind::Normal, normal, self.num_normals),
        ];
        numbers.into_iter().filter_map(|(kind, index, count)| Some((kind, index?, count)))
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
        let (kind, _, count) = missing.next()?;
        let index = part(word, kind);
        Some(Reason::IndexTooLarge { text: excerpt(word), kind, index, count })
    }

    /// The faults of tags that asked for something which did not come.
    fn late_tag_faults(&self) -> Faults {
        let (num_vertices, num_faces) = (self.positions.len(), self.faces.len());
        let vertex = |id: VertexId| ("vertex", id.0, num_vertices);
        let tags = &self.tags;
        let creases = tags.creases.iter().map(|c| c.edge[0].max(c.edge[1])).map(vertex);
        let corners = tags.corners.iter().map(|c| c.vertex).map(vertex);
        let holes = tags.holes.iter().map(|f| ("face", f.0, num_faces));
        let lines = &self.source.tag_lines;
        let creases = late_tag_faults(creases.zip(&lines.creases));
        let corners = late_tag_faults(corners.zip(&lines.corners));
        creases.merge(corners).merge(late_tag_faults(holes.zip(&lines.holes)))
    }

    fn into_obj(self) -> Obj {
        let num_corners = self.faces.all_corners().len();
        let (primvars, remarks) = self.primvars.finish(self.positions.len(), num_corners);
        let mesh = Mesh { positions: self.positions, faces: self.faces, tags: self.tags, primvars };
        let Self { source, skipped, unknown, .. } = self;
        Obj { mesh, source, skipped, unknown_tags: unknown.list, remarks }
    }
}

/// The first numbers of a line.
struct Numbers<'a, const N: usize> {
    values: [f64; N],
    /// How many numbers there are, also more than `N`.
    found: usize,
    /// One of the last three of `values` that is infinite or NaN.
    non_finite: Option<&'a [u8]>,
}

impl<const N: usize> Numbers<'_, N> {
    fn refuse_non_finite(&self) -> Result<(), Reason> {
        self.non_finite.map_or(Ok(()), |word| Err(Reason::NotFinite { text: excerpt(word) }))
    }
}

/// The faults of the numbers that are not below how many things there are; one per line.
fn late_tag_faults<'a>(
    asked: impl Iterator<Item = ((&'static str, u32, usize), &'a u32)>,
) -> Faults {
    let mut faults = Faults::default();
    let mut last_line = None;
    for ((what, index, count), &line) in asked {
        if index as usize >= count && last_line != Some(line) {
            let reason = Reason::TagIndex { what, index, count };
            faults.push(LineFault { line, element: None, reason });
            last_line = Some(line);
        }
    }
    faults
}

/// What the number of a corner asks for, counted from 0, if it does not reach back too far and
/// there are `count` so far; one that nothing has if the number is too large.
fn id(index: i64, count: usize) -> u32 {
    let id = if index < 0 { count as i64 + index } else { index - 1 };
    u32::try_from(id).unwrap_or(u32::MAX)
}

/// Whether `count` things are no more than may be.
fn room(what: &'static str, count: usize, limit: usize) -> Result<(), Reason> {
    if count > limit { Err(Reason::TooMany { what, limit }) } else { Ok(()) }
}

/// The tags that are not known.
#[derive(Default)]
struct UnknownTags<'a> {
    /// Where each tag stands in `list`.
    places: HashMap<&'a [u8], usize>,
    list: Vec<UnknownTag>,
}

impl<'a> UnknownTags<'a> {
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
type CornerIndices = [Option<i64>; 3];

fn corner(word: &[u8]) -> Option<CornerIndices> {
    let mut corner = [None; 3];
    for (k, part) in word.split(|&b| b == b'/').enumerate() {
        let number = corner.get_mut(k)?;
        if !part.is_empty() {
            *number = Some(index(part)?);
        }
    }
    corner[0].is_some().then_some(corner)
}

/// The number of `kind` in a corner, as it is written.
fn part(corner: &[u8], kind: IndexKind) -> String {
    let place = match kind {
        IndexKind::Vertex => 0,
        IndexKind::Texture => 1,
        IndexKind::Normal => 2,
    };
    excerpt(corner.split(|&b| b == b'/').nth(place).unwrap_or_default())
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

    fn tetrahedron(limits: Limits) -> Result<Obj, ObjError> {
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
