//! What can be wrong with a line, and how its author is told.

use std::fmt;

pub(super) use crate::io::excerpt::excerpt;
use crate::mesh::{MAX_LISTED, one_per_line};

/// Why a file cannot be read: its faulty lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ObjError {
    /// The first faulty lines in order, 20 at most and at least one.
    pub faults: Vec<LineFault>,
    /// The number of faulty lines after those.
    pub num_more: usize,
}

impl fmt::Display for ObjError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let listed: Vec<String> = self.faults.iter().map(LineFault::to_string).collect();
        let total = listed.len() + self.num_more;
        f.write_str(&one_per_line(listed, total))
    }
}

impl std::error::Error for ObjError {}

/// A fault of a line; the first one if it has several.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineFault {
    /// The line on which the vertex or face begins, from 1.
    pub line: u32,
    /// What the line describes, if it matters.
    pub element: Option<Element>,
    /// What is wrong.
    pub reason: Reason,
}

impl fmt::Display for LineFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.element {
            Some(element) => write!(f, "line {}, {element}: {}", self.line, self.reason),
            None => write!(f, "line {}: {}", self.line, self.reason),
        }
    }
}

/// What a line describes, with its number in the file, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Element {
    /// A vertex.
    Vertex(u64),
    /// A texture coordinate.
    Texture(u64),
    /// A face.
    Face(u64),
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex(number) => write!(f, "vertex {number}"),
            Self::Texture(number) => write!(f, "texture coordinate {number}"),
            Self::Face(number) => write!(f, "face {number}"),
        }
    }
}

/// What the numbers in a corner of a face are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum IndexKind {
    /// Vertices, `v`.
    Vertex,
    /// Texture coordinates, `vt`.
    Texture,
    /// Normals, `vn`.
    Normal,
}

impl fmt::Display for IndexKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Vertex => "vertex",
            Self::Texture => "texture coordinate",
            Self::Normal => "normal",
        })
    }
}

/// What is wrong with a line. A `text` is of the file, shortened, with U+FFFD for bytes that
/// are not text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Reason {
    /// A coordinate is not a number.
    #[error("`{text}` is not a number: correct it, as in 1.5 or -2e-3")]
    NotANumber {
        /// The word.
        text: String,
    },
    /// A vertex has fewer than three coordinates, or a texture coordinate none.
    #[error("`{text}` has {found} of the {needed} coordinates: add those that are missing")]
    TooFewCoordinates {
        /// The line.
        text: String,
        /// How many there are, 0 to 2.
        found: usize,
        /// How many there must be.
        needed: usize,
    },
    /// A vertex has four numbers, of which the last is not 1.
    #[error("the weight `{text}` is not 1, but rational points are not supported: delete it")]
    Weight {
        /// The weight.
        text: String,
    },
    /// The whole file is of another kind.
    #[error("the file is read as OBJ, but {what}")]
    OtherKind {
        /// What it is and what to do.
        what: String,
    },
    /// A corner of a face has not the form of one.
    #[error("`{text}` is not a corner: correct it, as in 1, 1/2, 1//3 or 1/2/3")]
    NotACorner {
        /// The word.
        text: String,
    },
    /// A corner has the number 0.
    #[error("`{text}` asks for {kind} 0, but the first has number 1: correct the number")]
    IndexZero {
        /// The corner.
        text: String,
        /// What the number is of.
        kind: IndexKind,
    },
    /// A corner has a number that is greater than how many there are in the file.
    #[error(
        "`{text}` asks for {kind} {index}, but the file has {count}: correct the number or \
         add what is missing"
    )]
    IndexTooLarge {
        /// The corner.
        text: String,
        /// What the number is of.
        kind: IndexKind,
        /// The number as it is written.
        index: String,
        /// How many there are.
        count: usize,
    },
    /// A corner counts back past the beginning.
    #[error(
        "`{text}` asks for {kind} {index}, but {count} come before it: correct the number or \
         move the line to after what it asks for"
    )]
    IndexBeforeFirst {
        /// The corner.
        text: String,
        /// What the number is of.
        kind: IndexKind,
        /// The number as it is written, which is negative.
        index: String,
        /// How many come before it.
        count: usize,
    },
    /// A texture coordinate or colour is infinite or NaN.
    #[error("`{text}` is not finite: correct it, as in 0.25")]
    NotFinite {
        /// The word.
        text: String,
    },
    /// A line `t` does not have the form of a tag.
    #[error(
        "`t {name}` is not a tag: write `t NAME ints/floats/strings`, as in \
         `t crease 2/1/0 4 5 2.5`, and then as many of each, or delete the line"
    )]
    TagForm {
        /// The name of the tag.
        name: String,
    },
    /// A tag has the wrong number of arguments.
    #[error("the tag `{name}` takes {expected}: correct the counts and the arguments")]
    TagArguments {
        /// The name of the tag.
        name: String,
        /// What it takes.
        expected: &'static str,
    },
    /// An argument of a tag is not what it takes.
    #[error("`{text}` is no argument of the tag `{name}`: write {expected}")]
    TagValue {
        /// The name of the tag.
        name: String,
        /// The argument.
        text: String,
        /// What would be one.
        expected: String,
    },
    /// A tag asks for a vertex or face that does not exist.
    #[error(
        "the tag asks for {what} {index}, but the file has {count}, and tags count from 0: \
         correct the number"
    )]
    TagIndex {
        /// "vertex" or "face".
        what: &'static str,
        /// The number, from 0.
        index: u32,
        /// How many there are.
        count: usize,
    },
    /// A tag edits the surface at a level of refinement.
    #[error(
        "`{name}` is a hierarchical edit, which is not supported: apply it in the program that \
         wrote it, or delete the line"
    )]
    HierarchicalEdit {
        /// The name of the tag.
        name: String,
    },
    /// There is more than can be numbered with 32 bits.
    #[error("there are more than {limit} {what}: split the file")]
    TooMany {
        /// What there is too much of: "lines", "vertices", "faces" or "corners".
        what: &'static str,
        /// How many there may be.
        limit: usize,
    },
}

impl Reason {
    /// The kind of the fault: a word that stays the same when messages change.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NotANumber { .. } => "not-a-number",
            Self::TooFewCoordinates { .. } => "too-few-coordinates",
            Self::Weight { .. } => "weight",
            Self::OtherKind { .. } => "other-kind",
            Self::NotACorner { .. } => "not-a-corner",
            Self::IndexZero { .. } => "index-zero",
            Self::IndexTooLarge { .. } => "index-too-large",
            Self::IndexBeforeFirst { .. } => "index-before-first",
            Self::NotFinite { .. } => "not-finite",
            Self::TagForm { .. } => "tag-form",
            Self::TagArguments { .. } => "tag-arguments",
            Self::TagValue { .. } => "tag-value",
            Self::TagIndex { .. } => "tag-index",
            Self::HierarchicalEdit { .. } => "hierarchical-edit",
            Self::TooMany { .. } => "too-many",
        }
    }
}

/// Collects the faults of a file: keeps the first few, counts the others.
#[derive(Debug, Default)]
pub(super) struct Faults {
    kept: Vec<LineFault>,
    num_more: usize,
}

impl Faults {
    /// Adds a fault. Faults must come in the order of their lines.
    pub fn push(&mut self, fault: LineFault) {
        if self.kept.len() < MAX_LISTED {
            self.kept.push(fault);
        } else {
            self.num_more += 1;
        }
    }

    /// All faults of both, in the order of their lines.
    pub fn merge(mut self, other: Self) -> Self {
        self.kept.extend(other.kept);
        self.kept.sort_by_key(|fault| fault.line);
        let extra = self.kept.len().saturating_sub(MAX_LISTED);
        self.kept.truncate(MAX_LISTED);
        Self { kept: self.kept, num_more: self.num_more + other.num_more + extra }
    }

    /// The error that lists the faults, if there are any.
    pub fn into_result(self) -> Result<(), ObjError> {
        if self.kept.is_empty() {
            return Ok(());
        }
        Err(ObjError { faults: self.kept, num_more: self.num_more })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(line: u32) -> LineFault {
        let reason = Reason::TooMany { what: "lines", limit: 1 };
        LineFault { line, element: None, reason }
    }

    #[test]
    fn the_first_twenty_of_merged_faults_are_kept() {
        let (mut even, mut odd) = (Faults::default(), Faults::default());
        for line in 0..50 {
            even.push(fault(2 * line));
            odd.push(fault(2 * line + 1));
        }
        let error = even.merge(odd).into_result().unwrap_err();
        let lines: Vec<u32> = error.faults.iter().map(|f| f.line).collect();
        assert_eq!(lines, (0..20).collect::<Vec<_>>());
        assert_eq!(error.num_more, 80);
        assert_eq!(error.to_string().lines().count(), 22);
    }
}
