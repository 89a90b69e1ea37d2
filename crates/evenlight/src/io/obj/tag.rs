//! Lines `t NAME ints/floats/strings ...`: rules, sharpness and holes, in the grammar of the
//! shapes that OpenSubdiv is tested with (`regression/common/shape_utils.cpp`).
//!
//! ```text
//! t crease 2/1/0 4 5 2.5        the edge of vertices 4 and 5 has sharpness 2.5
//!   |      | | |  ints | floats | strings: as many of each as the word in the middle says
//! ```

use super::fault::{Reason, excerpt};
use super::words::Words;
use crate::mesh::{
    BoundaryRule, Corner, Crease, CreaseMethod, FaceId, FaceVaryingRule, Tags, VertexId,
};

/// What a line `t` says, taken apart.
pub(super) struct Line<'a> {
    name: &'a [u8],
    /// Where the name ends in the file.
    pub name_end: usize,
    ints: Vec<i64>,
    floats: Vec<f64>,
    strings: Vec<&'a [u8]>,
}

/// What becomes of a line `t`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// It is now in the tags.
    Kept,
    /// It is not known, or asks for what is not there.
    Ignored,
}

impl<'a> Line<'a> {
    /// Reads the words after the `t`.
    pub fn read(words: &mut Words<'a>) -> Result<Self, Reason> {
        let name = words.next().ok_or_else(|| form(b""))?;
        if is_edit(name) {
            return Err(Reason::HierarchicalEdit { name: excerpt(name) });
        }
        let name_end = Words::position(words);
        let counts = words.next().and_then(counts).ok_or_else(|| form(name))?;
        let mut line = Self { name, name_end, ints: vec![], floats: vec![], strings: vec![] };
        for word in words {
            line.push(word, counts)?;
        }
        let found = [line.ints.len(), line.floats.len(), line.strings.len()];
        if found == counts { Ok(line) } else { Err(form(name)) }
    }

    /// Takes the next word as what the counts leave for it.
    fn push(&mut self, word: &'a [u8], [ints, floats, strings]: [usize; 3]) -> Result<(), Reason> {
        let text = std::str::from_utf8(word).unwrap_or_default();
        if self.ints.len() < ints {
            self.ints.push(text.parse().map_err(|_| self.value(word, "a whole number"))?);
        } else if self.floats.len() < floats {
            let number = text.parse().ok().filter(|x: &f64| !x.is_nan());
            self.floats.push(number.ok_or_else(|| self.value(word, "a number"))?);
        } else if self.strings.len() < strings {
            self.strings.push(word);
        } else {
            return Err(form(self.name));
        }
        Ok(())
    }

    /// Adds what the line says to `tags`, or nothing if it is faulty.
    pub fn apply(&self, tags: &mut Tags) -> Result<Outcome, Reason> {
        match self.name {
            b"crease" => tags.creases.extend(self.creases()?),
            b"corner" => tags.corners.extend(self.corners()?),
            b"hole" => tags.holes.extend(self.holes()?),
            b"interpolateboundary" => tags.boundary = self.choose(&BOUNDARY_RULES)?,
            b"facevaryinginterpolateboundary" => tags.face_varying = self.choose(&FACE_VARYING)?,
            b"creasemethod" => tags.crease_method = self.crease_method()?,
            b"facevaryingpropagatecorners" => {
                return self.only_without(self.choose(&[false, true]));
            }
            b"smoothtriangles" => return self.only_without(self.smooth_triangles()),
            _ => return Ok(Outcome::Ignored),
        }
        Ok(Outcome::Kept)
    }

    /// Pairs of vertices with one number for all or one for each pair; or a chain of vertices
    /// with one number for each of its edges. An odd number of vertices is a chain.
    fn creases(&self) -> Result<Vec<Crease>, Reason> {
        let (vertices, sharpness) = (self.vertices()?, &self.floats);
        let n = vertices.len();
        let is_chain = n % 2 == 1 || (n > 2 && sharpness.len() == n - 1);
        let edges: Vec<[VertexId; 2]> = if is_chain {
            vertices.windows(2).map(|w| [w[0], w[1]]).collect()
        } else {
            vertices.chunks_exact(2).map(|w| [w[0], w[1]]).collect()
        };
        if edges.is_empty() || !(sharpness.len() == 1 || sharpness.len() == edges.len()) {
            return Err(self.counts("pairs of vertices, and one number or one for each pair"));
        }
        let each = edges.into_iter().zip(sharpness.iter().cycle());
        each.map(|(edge, &s)| Ok(Crease { edge, sharpness: self.sharpness(s)? })).collect()
    }

    fn corners(&self) -> Result<Vec<Corner>, Reason> {
        let (vertices, sharpness) = (self.vertices()?, &self.floats);
        if vertices.is_empty() || !(sharpness.len() == 1 || sharpness.len() == vertices.len()) {
            return Err(self.counts("vertices, and one number or one for each vertex"));
        }
        let each = vertices.into_iter().zip(sharpness.iter().cycle());
        each.map(|(vertex, &s)| Ok(Corner { vertex, sharpness: self.sharpness(s)? })).collect()
    }

    /// A number from 0, without the sign of -0.
    fn sharpness(&self, number: f64) -> Result<f64, Reason> {
        if number < 0.0 {
            let expected = "a sharpness from 0 (smooth) to 10 (sharp for ever)";
            return Err(self.value(number.to_string().as_bytes(), expected));
        }
        Ok(number.abs())
    }

    fn holes(&self) -> Result<Vec<FaceId>, Reason> {
        if self.ints.is_empty() {
            return Err(self.counts("faces"));
        }
        Ok(self.ids()?.into_iter().map(FaceId).collect())
    }

    fn vertices(&self) -> Result<Vec<VertexId>, Reason> {
        Ok(self.ids()?.into_iter().map(VertexId).collect())
    }

    /// The whole numbers as numbers of vertices or faces, which count from 0.
    fn ids(&self) -> Result<Vec<u32>, Reason> {
        let id = |&i: &i64| {
            u32::try_from(i)
                .map_err(|_| self.value(i.to_string().as_bytes(), "a number from 0 to 4294967295"))
        };
        self.ints.iter().map(id).collect()
    }

    /// The one whole number as a place in `choices`.
    fn choose<T: Copy>(&self, choices: &[T]) -> Result<T, Reason> {
        let [choice] = self.ints[..] else { return Err(self.counts("one whole number")) };
        let chosen = usize::try_from(choice).ok().and_then(|k| choices.get(k)).copied();
        chosen.ok_or_else(|| {
            let expected = format!("a number from 0 to {}", choices.len() - 1);
            self.value(choice.to_string().as_bytes(), &expected)
        })
    }

    fn crease_method(&self) -> Result<CreaseMethod, Reason> {
        match self.strings[..] {
            [b"normal"] => Ok(CreaseMethod::Uniform),
            [b"chaikin"] => Ok(CreaseMethod::Chaikin),
            [word] => Err(self.value(word, "`normal` or `chaikin`")),
            _ => Err(self.counts("one word, `normal` or `chaikin`")),
        }
    }

    /// Whether triangles should have rules of their own; older files say it by a number.
    fn smooth_triangles(&self) -> Result<bool, Reason> {
        match (&self.ints[..], &self.strings[..]) {
            ([], [b"catmark" | b"normal"]) => Ok(false),
            ([], [b"smooth"]) => Ok(true),
            ([_], []) => Ok(self.choose(&[false, true, true])?),
            ([], [word]) => Err(self.value(word, "`catmark` or `smooth`")),
            _ => Err(self.counts("one word, `catmark` or `smooth`")),
        }
    }

    /// A tag that is only understood when it asks for nothing.
    fn only_without(&self, asks: Result<bool, Reason>) -> Result<Outcome, Reason> {
        asks.map(|asks| if asks { Outcome::Ignored } else { Outcome::Kept })
    }

    fn counts(&self, expected: &'static str) -> Reason {
        Reason::TagArguments { name: excerpt(self.name), expected }
    }

    fn value(&self, word: &[u8], expected: &str) -> Reason {
        let (name, text) = (excerpt(self.name), excerpt(word));
        Reason::TagValue { name, text, expected: expected.to_owned() }
    }
}

/// `interpolateboundary` 0, 1, 2.
pub(super) const BOUNDARY_RULES: [BoundaryRule; 3] =
    [BoundaryRule::None, BoundaryRule::EdgeAndCorner, BoundaryRule::EdgeOnly];

/// `facevaryinginterpolateboundary` 0 to 5.
pub(super) const FACE_VARYING: [FaceVaryingRule; 6] = [
    FaceVaryingRule::None,
    FaceVaryingRule::CornersOnly,
    FaceVaryingRule::CornersPlus1,
    FaceVaryingRule::CornersPlus2,
    FaceVaryingRule::Boundaries,
    FaceVaryingRule::All,
];

fn form(name: &[u8]) -> Reason {
    Reason::TagForm { name: excerpt(name) }
}

fn is_edit(name: &[u8]) -> bool {
    matches!(name, b"vertexedit" | b"edgeedit" | b"faceedit" | b"corneredit")
}

/// The numbers in `a/b/c`.
fn counts(word: &[u8]) -> Option<[usize; 3]> {
    let mut counts = [0; 3];
    let mut parts = std::str::from_utf8(word).ok()?.split('/');
    for count in &mut counts {
        *count = parts.next()?.parse().ok()?;
    }
    parts.next().is_none().then_some(counts)
}
