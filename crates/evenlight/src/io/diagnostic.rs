//! Faults and notices as data, for front ends that mark them in place.
//!
//! ```text
//! LoadError --diagnostics()--> [Diagnostic { severity, kind, message, line, marks }]
//! Notice    --diagnostic()-->
//! ```

use std::fmt;

use super::load::{LoadError, Notice, Refusal};
use super::obj::{self, Element};
use super::ply;
use crate::mesh::{FaceId, Marks, MeshError, VertexId};

/// A fault of a file or its mesh, or something that was ignored or completed.
///
/// Shown as its message.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// Whether it keeps the cage from being used.
    pub severity: Severity,
    /// What kind it is: a word that stays the same when messages change, as `repeated-vertex`.
    ///
    /// [`MeshError::kind`] and [`obj::Reason::kind`] name the kinds of faults; `more-lines` counts
    /// further lines of OBJ, and `unreadable` is a fault of another format, or a file that cannot
    /// be opened. Notices are `unused-vertices`, `unsupported-tag`, `not-kept` or `remark`.
    pub kind: &'static str,
    /// What is wrong, where, and what to do, in the numbers of the file.
    pub message: String,
    /// The line of the file, from 1, if it is known.
    pub line: Option<u32>,
    /// The vertices, edges and faces that it is about, in the numbers of the library, from 0.
    pub marks: Marks,
}

/// How serious a [`Diagnostic`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Severity {
    /// The cage cannot be used.
    Error,
    /// The cage can be used.
    Warning,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl Diagnostic {
    fn error(kind: &'static str, message: String) -> Self {
        let severity = Severity::Error;
        Self { severity, kind, message, line: None, marks: Marks::default() }
    }

    /// The only fault of a file that cannot be read, on `line`.
    pub(super) fn unreadable(message: String, line: Option<usize>) -> Self {
        let line = line.and_then(|line| u32::try_from(line).ok());
        Self { line, ..Self::error("unreadable", message) }
    }

    fn warning(kind: &'static str, message: String) -> Self {
        Self { severity: Severity::Warning, ..Self::error(kind, message) }
    }
}

impl LoadError {
    /// Every fault.
    ///
    /// ```
    /// use evenlight::FaceId;
    /// use evenlight::io::load::Format;
    ///
    /// let error = Format::Obj.read_cage(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n").unwrap_err();
    /// let fault = &error.diagnostics()[0];
    /// assert_eq!((fault.kind, fault.line), ("repeated-vertex", Some(4)));
    /// assert_eq!(fault.marks.faces, [FaceId(0)]);
    /// ```
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        match self {
            Self::Obj(error) => of_obj(error),
            Self::Ply(error) => {
                let line = match error.place {
                    ply::PlyPlace::Line(line) => Some(line),
                    ply::PlyPlace::Byte(_) => None,
                };
                vec![Diagnostic::unreadable(error.to_string(), line)]
            }
            Self::Usd(error) => vec![Diagnostic::unreadable(error.to_string(), Some(error.line))],
            Self::Check(refusal) => of_refusal(refusal),
        }
    }
}

fn of_obj(error: &obj::ObjError) -> Vec<Diagnostic> {
    let of_line = |fault: &obj::LineFault| Diagnostic {
        line: Some(fault.line),
        marks: fault.element.map(marked).unwrap_or_default(),
        ..Diagnostic::error(fault.reason.kind(), fault.to_string())
    };
    let more = format!("and {} more lines that cannot be read", error.num_more);
    let more = (error.num_more > 0).then(|| Diagnostic::error("more-lines", more));
    error.faults.iter().map(of_line).chain(more).collect()
}

/// The vertex or face that a line describes.
fn marked(element: Element) -> Marks {
    let from_zero = |number: u64| u32::try_from(number.saturating_sub(1)).ok();
    let mut marks = Marks::default();
    match element {
        Element::Vertex(number) => marks.vertices.extend(from_zero(number).map(VertexId)),
        Element::Face(number) => marks.faces.extend(from_zero(number).map(FaceId)),
        Element::Texture(_) => {}
    }
    marks
}

fn of_refusal(refusal: &Refusal) -> Vec<Diagnostic> {
    let faults = refusal.error.errors.iter().enumerate();
    let of_fault = |(k, fault): (usize, &MeshError)| Diagnostic {
        line: refusal.lines.get(k).copied().flatten(),
        marks: fault.marks(),
        ..Diagnostic::error(fault.kind(), fault.describe(&refusal.naming))
    };
    faults.map(of_fault).collect()
}

impl Notice {
    /// The notice as data.
    pub fn diagnostic(&self) -> Diagnostic {
        let message = self.to_string();
        match self {
            Self::UnknownTag(tag) => Diagnostic {
                line: Some(tag.first_line),
                ..Diagnostic::warning("unsupported-tag", message)
            },
            Self::Skipped(skipped) => Diagnostic {
                line: Some(skipped.first_line),
                ..Diagnostic::warning("not-kept", message)
            },
            Self::OfMesh { warning, line, .. } => Diagnostic {
                line: *line,
                marks: warning.marks(),
                ..Diagnostic::warning(warning.kind(), message)
            },
            Self::Remark(_) => Diagnostic::warning("remark", message),
        }
    }
}
