//! Where input comes from, a file or stdin as `-`, and the way from there to a surface.

use std::convert::Infallible;
use std::fmt;
use std::fs;
use std::io::{self, Read};
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;

use evenlight::cap::{CapKind, CapOptions, MAX_VALENCE};
use evenlight::io::load::{Format, LoadError, Loaded};
use evenlight::{Cage, Surface, SurfaceOptions};

use crate::error::{Failure, warn};
use crate::options::{CapArg, SurfaceArgs};

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
            Self::File(path) => Format::from_extension(path.extension()?.to_str()?),
        }
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

/// Refuses to read two things from stdin, as wrong usage.
pub fn refuse_shared_stdin(sources: &[(&str, &Source)]) -> Result<(), Failure> {
    let from_stdin = sources.iter().filter(|(_, source)| **source == Source::Stdin);
    let names: Vec<&str> = from_stdin.map(|(name, _)| *name).collect();
    match names[..] {
        [] | [_] => Ok(()),
        _ => Err(Failure::Usage(format!("{} cannot both come from stdin", names.join(" and ")))),
    }
}

/// The surface that `args` ask for; what is ignored or left out is said on stderr.
pub fn read_surface(args: &SurfaceArgs) -> Result<Surface, Failure> {
    let edits = args.q.read(&args.cage, &[args.scheme])?;
    let mut surface = build(read_cage(&args.cage)?, args.options(), &args.cage)?;
    report_omitted(&surface, &args.cage)?;
    edits.apply(&mut surface)?;
    Ok(surface)
}

/// The same, with caps behind `rings` rings if they are asked for.
pub fn read_closed_surface(args: &SurfaceArgs, cap: CapArg, rings: u8) -> Result<Surface, Failure> {
    let kind = cap.kind(&[args.scheme])?;
    let mut surface = read_surface(args)?;
    close(&mut surface, kind, rings.into(), &args.cage)?;
    Ok(surface)
}

/// Closes a surface by caps of some kind behind `rings` rings; points that have none are said on
/// stderr.
pub fn close(
    surface: &mut Surface,
    kind: Option<CapKind>,
    rings: usize,
    source: &Source,
) -> Result<(), Failure> {
    let options = kind.map(|kind| CapOptions { rings, kind });
    surface.set_caps(options).map_err(|error| Failure::Usage(format!("--cap: {error}")))?;
    let points = surface.points_without_cap();
    if !points.is_empty() {
        let all = surface.extraordinary_points().len();
        warn(format_args!(
            "{source}: {} of {all} extraordinary points have no cap, but rings without end: there \
             are caps for valences 3 to {MAX_VALENCE}",
            points.len()
        ));
    }
    Ok(())
}

/// The cage in `source`; what is ignored is said on stderr.
pub fn read_cage(source: &Source) -> Result<Arc<Cage>, Failure> {
    let refused = |error: LoadError| Failure::Unusable(format!("{source}: {error}"));
    let (cage, notices) = load(source)?.check().map_err(refused)?;
    for notice in notices {
        warn(format_args!("{source}: {notice}"));
    }
    Ok(Arc::new(cage))
}

/// The mesh in `source`, not checked.
pub fn load(source: &Source) -> Result<Loaded, Failure> {
    read_mesh(source)?.map_err(|error| Failure::Unusable(format!("{source}: {error}")))
}

/// The mesh in `source`, not checked, or why its bytes are none.
pub fn read_mesh(source: &Source) -> Result<Result<Loaded, LoadError>, Failure> {
    let bytes = source.read()?;
    Ok(source.format().unwrap_or_else(|| Format::of_content(&bytes)).read(&bytes))
}

/// The surface over `cage`, which was read from `source`.
pub fn build(
    cage: Arc<Cage>,
    options: SurfaceOptions,
    source: &Source,
) -> Result<Surface, Failure> {
    Surface::build(cage, options).map_err(|error| Failure::Unusable(format!("{source}: {error}")))
}

/// Says on stderr which faces have no surface.
///
/// # Errors
///
/// If none has.
pub fn report_omitted(surface: &Surface, source: &Source) -> Result<(), Failure> {
    let faces = surface.cage().num_faces();
    match surface.omitted_faces().len() {
        0 => Ok(()),
        omitted if omitted == faces => Err(Failure::Unusable(format!(
            "{source}: all {faces} faces touch a boundary and are left out: no surface remains"
        ))),
        omitted => {
            warn(format_args!("{source}: {}", omitted_text(omitted, faces)));
            Ok(())
        }
    }
}

/// The sentence on faces without a surface.
pub fn omitted_text(omitted: usize, faces: usize) -> String {
    format!("{omitted} of {faces} faces touch a boundary and are left out")
}
