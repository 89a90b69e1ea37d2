//! Where input comes from, a file or stdin as `-`, and the way from there to a cage.

use std::convert::Infallible;
use std::fmt;
use std::fs;
use std::io::{self, Read};
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;

use clap::Args;
use evenlight::Cage;
use evenlight::io::FileError;
use evenlight::io::load::{Format, LoadError, Loaded};

use crate::error::{Failure, warn};

/// A place to read from.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Standard input, `-` on the command line.
    Stdin,
    /// A file.
    File(PathBuf),
}

impl FromStr for Source {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(if text == "-" { Self::Stdin } else { Self::File(text.into()) })
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Stdin => f.write_str("stdin"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

impl Source {
    /// All bytes; a failure names the place.
    pub fn read(&self) -> Result<Vec<u8>, Failure> {
        let bytes = match self {
            Self::Stdin => read_stdin(),
            Self::File(path) => fs::read(path),
        };
        bytes.map_err(|error| Failure::io(self, &error))
    }

    /// The kind of cage file that the extension names, if it does.
    fn format(&self) -> Option<Format> {
        match self {
            Self::Stdin => None,
            Self::File(path) => Format::from_path(path),
        }
    }

    /// The failure that a cage from here cannot be used.
    pub fn refused(&self, error: &LoadError) -> Failure {
        Failure::Unusable(match self {
            Self::Stdin => format!("{self}: {error}"),
            Self::File(path) => {
                FileError::Load { path: path.clone(), error: error.clone() }.to_string()
            }
        })
    }

    /// All bytes, which must be UTF-8; a failure names the place.
    pub fn read_text(&self) -> Result<String, Failure> {
        String::from_utf8(self.read()?)
            .map_err(|_| Failure::Unusable(format!("{self}: this is not a text file (UTF-8)")))
    }
}

fn read_stdin() -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    io::stdin().lock().read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The cage, and which one if there are several in the file.
#[derive(Args, Clone, Debug)]
pub struct CageArg {
    /// The cage, .obj, .ply or .usda: quads and n-gons, counter-clockwise; `-` for stdin
    #[arg(value_name = "CAGE")]
    pub source: Source,

    /// The mesh in a USD file with several, as in /World/Cage
    #[arg(long, value_name = "PATH")]
    prim: Option<String>,
}

impl From<Source> for CageArg {
    /// The only cage in `source`.
    fn from(source: Source) -> Self {
        Self { source, prim: None }
    }
}

/// Refuses to read two things from stdin, as wrong usage.
pub fn refuse_shared_stdin(sources: &[(&str, &Source)]) -> Result<(), Failure> {
    let from_stdin = sources.iter().filter(|(_, source)| **source == Source::Stdin);
    let names: Vec<&str> = from_stdin.map(|(name, _)| *name).collect();
    match names[..] {
        [] | [_] => Ok(()),
        _ => Err(Failure::Usage(format!("{} cannot both come from stdin", names.join(" and ")))),
    }
}

/// The cage that `arg` names; what is ignored is said on stderr.
pub fn read_cage(arg: &CageArg) -> Result<Arc<Cage>, Failure> {
    let source = &arg.source;
    let (cage, notices) = load(arg)?.check().map_err(|error| source.refused(&error))?;
    for notice in notices {
        warn(format_args!("{source}: {notice}"));
    }
    Ok(Arc::new(cage))
}

/// The mesh that `arg` names, not checked.
pub fn load(arg: &CageArg) -> Result<Loaded, Failure> {
    read_mesh(arg)?.map_err(|error| arg.source.refused(&error))
}

/// The mesh that `arg` names, not checked, or why the bytes are none.
pub fn read_mesh(arg: &CageArg) -> Result<Result<Loaded, LoadError>, Failure> {
    let bytes = arg.source.read()?;
    let format = arg.source.format().unwrap_or_else(|| Format::of_content(&bytes));
    if arg.prim.is_some() && format != Format::Usda {
        return Err(Failure::Usage(format!("{}: --prim is for USD files only", arg.source)));
    }
    Ok(format.read(&bytes, arg.prim.as_deref()))
}

/// Which faces have no surface.
pub const WHY_OMITTED: &str = "holes, or at the boundary under the rule none";

/// The sentence on faces without a surface.
pub fn omitted_text(omitted: usize, faces: usize) -> String {
    let are = if omitted == 1 { "is" } else { "are" };
    format!("{omitted} of {faces} faces {are} left out ({WHY_OMITTED})")
}
