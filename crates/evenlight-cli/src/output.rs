//! Where output goes: a file, whole or not at all, or stdout as `-`.
//!
//! A file is written beside its final place under a temporary name and renamed when it is
//! complete. A run that fails leaves neither half a file nor destroys the old one.

use std::convert::Infallible;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::ValueEnum;
use tempfile::NamedTempFile;

use crate::error::Failure;

/// A place to write to.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Standard output, `-` on the command line.
    Stdout,
    /// A file.
    File(PathBuf),
}

impl FromStr for Target {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(if text == "-" { Self::Stdout } else { Self::File(text.into()) })
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Stdout => f.write_str("stdout"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

impl Target {
    /// The format that the file's extension names, or that was `chosen`.
    ///
    /// # Errors
    ///
    /// Wrong usage, with the legal extensions, if there is no such format.
    pub fn format<F: ValueEnum>(&self, chosen: Option<F>) -> Result<F, Failure> {
        if let Some(format) = chosen {
            return Ok(format);
        }
        let path = match self {
            Self::Stdout => return Err(Failure::Usage(format_needed::<F>())),
            Self::File(path) => path,
        };
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        F::from_str(extension, true).map_err(|_| Failure::Usage(wrong_extension::<F>(path)))
    }

    /// Writes what `body` writes. Nothing changes at the target unless all of it succeeds
    /// (except on stdout and devices, which have no second name).
    pub fn write(
        &self,
        body: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        match self {
            Self::Stdout => write_buffered(io::stdout().lock(), body).map_err(stdout_failure),
            Self::File(path) if is_device(path) => File::create(path)
                .and_then(|file| write_buffered(file, body))
                .map_err(|error| Failure::io(self, &error)),
            Self::File(path) => {
                write_then_rename(path, body).map_err(|error| Failure::io(self, &error))
            }
        }
    }

    /// Writes `value` as JSON, indented, with a final newline.
    pub fn write_json(&self, value: &impl serde::Serialize) -> Result<(), Failure> {
        self.write(|out| {
            serde_json::to_writer_pretty(&mut *out, value)?;
            out.write_all(b"\n")
        })
    }
}

fn write_buffered(
    out: impl Write,
    body: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::new(out);
    body(&mut out)?;
    out.flush()
}

fn stdout_failure(error: io::Error) -> Failure {
    match error.kind() {
        ErrorKind::BrokenPipe => Failure::ReaderGone,
        _ => Failure::io("stdout", &error),
    }
}

/// Whether `path` is there and neither file nor folder: a pipe or `/dev/null`, which a rename
/// would replace.
fn is_device(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|meta| !meta.is_file() && !meta.is_dir())
}

fn write_then_rename(
    path: &Path,
    body: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    // Through a link to the file it names, so that the link stays a link.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if path.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    let file = temporary_beside(&path)?;
    write_buffered(&file, body)?;
    file.as_file().sync_all()?;
    file.persist(&path).map_err(|e| e.error)?;
    Ok(())
}

/// An empty file in the folder of `path` with the permissions that `path` has or would get.
fn temporary_beside(path: &Path) -> io::Result<NamedTempFile> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".evenlight-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let file = builder.tempfile_in(folder).map_err(|e| folder_error(folder, e.kind()))?;
    if let Ok(old) = fs::metadata(path) {
        file.as_file().set_permissions(old.permissions())?;
    }
    Ok(file)
}

/// Why nothing can be written in `folder`. The error of `tempfile` would name the temporary file,
/// which nobody asked for.
fn folder_error(folder: &Path, kind: ErrorKind) -> io::Error {
    match kind {
        ErrorKind::NotFound => {
            let message = format!("the folder {} does not exist: create it", folder.display());
            io::Error::new(kind, message)
        }
        _ => kind.into(),
    }
}

fn format_needed<F: ValueEnum>() -> String {
    format!("stdout has no extension: choose --format {}", names::<F>().join(" or "))
}

fn wrong_extension<F: ValueEnum>(path: &Path) -> String {
    let legal: Vec<String> = names::<F>().iter().map(|name| format!(".{name}")).collect();
    format!("{}: the extension names no format; it can be {}", path.display(), legal.join(", "))
}

fn names<F: ValueEnum>() -> Vec<String> {
    let values = F::value_variants().iter().filter_map(F::to_possible_value);
    values.map(|value| value.get_name().to_owned()).collect()
}
