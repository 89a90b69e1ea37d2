//! `evenlight patches`: the surface as Bernstein-Bezier patches.

use clap::{Args, ValueEnum};
use evenlight::{Surface, io};

use crate::cap::CapArg;
use crate::error::Failure;
use crate::output::Target;
use crate::progress::Progress;
use crate::surface::SurfaceArgs;

/// Arguments of `evenlight patches`.
#[derive(Args, Debug)]
pub struct PatchesArgs {
    #[command(flatten)]
    surface: SurfaceArgs,

    /// The file to write, .bv (BezierView, type 5) or .json; `-` for stdout
    #[arg(short, long, value_name = "FILE")]
    output: Target,

    /// Format, if the file's extension does not tell
    #[arg(long, value_enum)]
    format: Option<PatchFormat>,

    /// Number of rings around every extraordinary point; ring k reaches to 2^-k of a sector
    /// (at contraction cc)
    #[arg(long, value_name = "K", default_value_t = 6, value_parser = clap::value_parser!(u8).range(0..=48))]
    rings: u8,

    #[command(flatten)]
    cap: CapArg,
}

/// Files that hold patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PatchFormat {
    /// BezierView: one group per role, patches of type 5
    Bv,
    /// JSON, one object per patch
    Json,
}

impl From<PatchFormat> for io::PatchFormat {
    fn from(format: PatchFormat) -> Self {
        match format {
            PatchFormat::Bv => Self::Bv,
            PatchFormat::Json => Self::Json,
        }
    }
}

/// Runs `evenlight patches`.
pub fn run(args: &PatchesArgs, quiet: bool) -> Result<(), Failure> {
    let format = args.output.format(args.format)?;
    let progress = Progress::new(2, quiet);
    progress.stage("Building the surface");
    let surface = args.cap.read(&args.surface, args.rings)?;
    progress.step();
    progress.stage("Writing patches");
    write(&surface, args.rings.into(), format, &args.output)
}

/// Writes all regular patches, `rings` rings and, if it is closed, the caps of `surface`.
pub fn write(
    surface: &Surface,
    rings: usize,
    format: PatchFormat,
    target: &Target,
) -> Result<(), Failure> {
    target.write(|mut out| io::PatchFormat::from(format).write(surface, rings, &mut out))
}
