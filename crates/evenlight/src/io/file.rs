//! From the path of a file to a cage.

use std::fmt;
use std::path::{Path, PathBuf};

use super::diagnostic::Diagnostic;
use super::load::{Format, LoadError, Naming, Notice};
use super::obj::Reason;
use crate::mesh::{Cage, MeshError};

/// Reads the cage in the file `path` and checks it; what was ignored or completed is told beside
/// it.
///
/// The ending of the name tells what kind of file it is, or else its first line does
/// ([`Format`]); of a USD file the only mesh is taken.
///
/// # Errors
///
/// [`FileError::Open`] if the file cannot be read, [`FileError::Load`] if there is no cage in it.
/// Both name the file, the latter all faults with their lines.
///
/// ```
/// let (cage, notices) = evenlight::io::read_cage("examples/cube.obj")?;
/// assert!(cage.num_faces() == 6 && notices.is_empty());
///
/// let error = evenlight::io::read_cage("examples/no such cube.obj").unwrap_err();
/// assert!(error.to_string().starts_with("examples/no such cube.obj: "));
/// # Ok::<(), evenlight::io::FileError>(())
/// ```
pub fn read_cage(path: impl AsRef<Path>) -> Result<(Cage, Vec<Notice>), FileError> {
    let path = path.as_ref();
    let bytes = std::fs::read(path)
        .map_err(|error| FileError::Open { path: path.to_owned(), message: error.to_string() })?;
    let format = Format::from_path(path).unwrap_or_else(|| Format::of_content(&bytes));
    let loaded = format.read(&bytes, None).and_then(|loaded| loaded.check());
    loaded.map_err(|error| FileError::Load { path: path.to_owned(), error })
}

/// Why a file gives no cage. The message names the file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FileError {
    /// It cannot be read at all.
    Open {
        /// The file.
        path: PathBuf,
        /// What the system says.
        message: String,
    },
    /// There is no cage in it.
    Load {
        /// The file.
        path: PathBuf,
        /// All faults.
        error: LoadError,
    },
}

impl FileError {
    /// Every fault as data; of a file that cannot be read what the system says, of kind
    /// `unreadable`.
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        match self {
            Self::Open { message, .. } => vec![Diagnostic::unreadable(message.clone(), None)],
            Self::Load { error, .. } => error.diagnostics(),
        }
    }

    /// What was ignored or completed before the fault was found.
    pub fn notices(&self) -> &[Notice] {
        match self {
            Self::Open { .. } => &[],
            Self::Load { error, .. } => error.notices(),
        }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open { path, message } => write!(f, "{}: {message}", path.display()),
            Self::Load { path, error } => {
                write!(f, "{}: {error}", path.display())?;
                note(f, Format::from_path(path), error)
            }
        }
    }
}

impl std::error::Error for FileError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Open { .. } => None,
            Self::Load { error, .. } => Some(error),
        }
    }
}

/// Says why a file was read as OBJ, if that may be the cause of the fault.
fn note(f: &mut fmt::Formatter<'_>, named: Option<Format>, error: &LoadError) -> fmt::Result {
    match named {
        Some(_) if is_other_kind(error) => {
            f.write_str("\nnote: it is read as OBJ because of its name")
        }
        None if may_be_no_obj(error) && !is_other_kind(error) => write!(
            f,
            "\nnote: it is read as OBJ, since neither its name nor its beginning tells what it \
             is; the names of cages end in {}",
            Format::ALL.map(Format::ending).join(", ")
        ),
        _ => Ok(()),
    }
}

/// Whether the file was to be read as OBJ and is something else.
fn is_other_kind(error: &LoadError) -> bool {
    let LoadError::Obj(error) = error else { return false };
    error.faults.iter().any(|fault| matches!(fault.reason, Reason::OtherKind { .. }))
}

/// Whether the file may be no OBJ at all, though it was read as such.
fn may_be_no_obj(error: &LoadError) -> bool {
    match error {
        LoadError::Obj(_) => true,
        LoadError::Check(refusal) => {
            let no_faces = |fault: &MeshError| matches!(fault, MeshError::NoFaces { .. });
            matches!(refusal.naming, Naming::Lines(_)) && refusal.error.errors.iter().any(no_faces)
        }
        LoadError::Ply(_) | LoadError::Usd(_) => false,
    }
}
