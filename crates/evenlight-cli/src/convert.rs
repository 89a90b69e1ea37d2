//! `evenlight convert`: a cage from one kind of file to another.

use std::io;

use clap::{Args, ValueEnum};
use evenlight::Mesh;
use evenlight::io::load::Format;
use evenlight::io::ply::Encoding;
use evenlight::io::{obj, ply, usd};

use crate::error::{Failure, warn};
use crate::input::{self, CageArg};
use crate::output::Target;

/// Arguments of `evenlight convert`. The cage need not be fit for a surface.
#[derive(Args, Debug)]
pub struct ConvertArgs {
    #[command(flatten)]
    cage: CageArg,

    /// The file to write: .obj, .ply or .usda, or `-` for stdout
    output: Target,

    /// Format of the output, if the file's extension does not tell
    #[arg(long, value_enum)]
    format: Option<CageFormat>,

    /// PLY as text instead of bytes
    #[arg(long)]
    ascii: bool,
}

/// Files that hold cages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CageFormat {
    /// Wavefront OBJ with the tags of OpenSubdiv's shapes
    Obj,
    /// PLY
    Ply,
    /// USD as text
    Usda,
}

impl From<CageFormat> for Format {
    fn from(format: CageFormat) -> Self {
        match format {
            CageFormat::Obj => Self::Obj,
            CageFormat::Ply => Self::Ply,
            CageFormat::Usda => Self::Usda,
        }
    }
}

/// Runs `evenlight convert`.
pub fn run(args: &ConvertArgs) -> Result<(), Failure> {
    let format = Format::from(args.output.format(args.format)?);
    let loaded = input::load(&args.cage)?;
    for notice in &loaded.notices {
        warn(format_args!("{}: {notice}", args.cage.source));
    }
    write(&loaded.mesh, format, args.ascii, &args.output)
}

/// Writes a cage; what the format cannot hold is said on stderr.
pub fn write(mesh: &Mesh, format: Format, ascii: bool, target: &Target) -> Result<(), Failure> {
    let encoding = if ascii { Encoding::Ascii } else { Encoding::LittleEndian };
    let (omitted, written): (_, Result<(), Failure>) = match format {
        Format::Obj => (obj::omitted(mesh), target.write(|mut out| obj::write(mesh, &mut out))),
        Format::Ply => {
            let write = |mut out: &mut dyn io::Write| ply::write(mesh, encoding, &mut out);
            (ply::omitted(mesh), target.write(write))
        }
        Format::Usda => (usd::omitted(mesh), target.write(|mut out| usd::write(mesh, &mut out))),
        _ => return Err(Failure::Usage(format!("{} is not written", format.name()))),
    };
    written?;
    omitted.iter().for_each(|sentence| warn(format_args!("{target}: {sentence}")));
    Ok(())
}
