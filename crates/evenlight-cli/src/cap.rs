//! `--cap`: the holes behind rings closed by finitely many patches.

use clap::{Args, ValueEnum};
use evenlight::cap::{CapError, CapKind, CapOptions};
use evenlight::{SchemeKind, Surface};

use crate::error::Failure;
use crate::surface::{self, SurfaceArgs};

/// What closes the holes behind rings.
#[derive(Args, Clone, Copy, Debug)]
pub struct CapArg {
    /// Close the hole behind the last of the --rings around every extraordinary point by
    /// finitely many patches, so that the surface has no end of rings; on boundaries, creases and
    /// corners one bi-4 patch per sector (bi-3 with bi3)
    #[arg(long, value_enum, default_value_t = CapChoice::None)]
    pub cap: CapChoice,
}

/// The caps by their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CapChoice {
    /// Rings without end
    None,
    /// What suits the scheme: bi6 for guided6, else bi5
    Auto,
    /// Bi-3, 3 x 3 patches per sector (more where the rings are split); tangent planes across lines
    /// agree to small angles only
    Bi3,
    /// Bi-4, 2 x 2 patches per sector, or as the rings are split
    Bi4,
    /// Bi-5, 2 x 2 patches per sector, or as the rings are split
    Bi5,
    /// Bi-6, one patch per sector, or as the rings are split
    Bi6,
}

impl CapArg {
    /// The kind of caps, if there are to be any; checked against the schemes.
    pub fn kind(self, schemes: &[SchemeKind]) -> Result<Option<CapKind>, Failure> {
        let kind = match self.cap {
            CapChoice::None => return Ok(None),
            CapChoice::Auto => CapKind::Auto,
            CapChoice::Bi3 => CapKind::Bi3,
            CapChoice::Bi4 => CapKind::Bi4,
            CapChoice::Bi5 => CapKind::Bi5,
            CapChoice::Bi6 => CapKind::Bi6,
        };
        let checked: Result<(), CapError> =
            schemes.iter().try_for_each(|&scheme| kind.check(scheme));
        checked.map_err(|error| Failure::Usage(format!("--cap: {error}")))?;
        Ok(Some(kind))
    }

    /// The surface that `args` ask for, with caps behind `rings` rings if they are asked for.
    pub fn read(self, args: &SurfaceArgs, rings: u8) -> Result<Surface, Failure> {
        let kind = self.kind(&[args.scheme])?;
        let mut surface = surface::read_surface(args)?;
        close(&mut surface, kind, rings.into())?;
        Ok(surface)
    }
}

/// Where caps are, for commands to which rings are nothing else.
#[derive(Args, Clone, Copy, Debug)]
pub struct CapRingsArg {
    #[command(flatten)]
    pub cap: CapArg,

    /// Number of rings in front of caps, 0 to 48
    #[arg(long, value_name = "K", default_value_t = 6, requires = "cap", value_parser = clap::value_parser!(u8).range(0..=48))]
    pub rings: u8,
}

impl CapRingsArg {
    /// The surface that `surface` asks for, closed if caps are asked for.
    pub fn read(self, surface: &SurfaceArgs) -> Result<Surface, Failure> {
        self.cap.read(surface, self.rings)
    }
}

/// Closes a surface by caps of some kind behind `rings` rings.
pub fn close(surface: &mut Surface, kind: Option<CapKind>, rings: usize) -> Result<(), Failure> {
    let options = kind.map(|kind| CapOptions { rings, kind });
    surface.set_caps(options).map_err(|error| Failure::Usage(format!("--cap: {error}")))
}
