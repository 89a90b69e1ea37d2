//! `evenlight mesh`: triangles of the limit surface.

use clap::{Args, ValueEnum};
use evenlight::tessellate::{CornerPrimvars, TriangleMesh, tessellate};
use evenlight::{Surface, io};

use crate::cap::CapRingsArg;
use crate::error::{Failure, warn};
use crate::output::Target;
use crate::progress::Progress;
use crate::surface::SurfaceArgs;

/// Arguments of `evenlight mesh`.
#[derive(Args, Debug)]
pub struct MeshArgs {
    #[command(flatten)]
    surface: SurfaceArgs,

    #[command(flatten)]
    caps: CapRingsArg,

    /// The file to write: .obj with normals, .ply or .glb with normals and curvature, these with
    /// the texture coordinates and colours of the cage, or .stl; `-` for stdout
    #[arg(short, long, value_name = "FILE")]
    output: Target,

    /// Format, if the file's extension does not tell
    #[arg(long, value_enum)]
    format: Option<MeshFormat>,

    /// Segments per edge of the cage; made even if the cage has faces that are no quads
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=1024))]
    rate: u16,
}

/// Files that hold triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MeshFormat {
    /// Wavefront OBJ with normals, hard at infinitely sharp edges, texture coordinates and colours
    Obj,
    /// PLY with one normal, Gauss and mean curvature and colour per vertex, texture coordinates
    Ply,
    /// Binary STL
    Stl,
    /// Binary glTF with normals, hard at infinitely sharp edges, Gauss and mean curvature, all sets
    /// of texture coordinates, and colours
    Glb,
}

impl From<MeshFormat> for io::MeshFormat {
    fn from(format: MeshFormat) -> Self {
        match format {
            MeshFormat::Obj => Self::Obj,
            MeshFormat::Ply => Self::Ply,
            MeshFormat::Stl => Self::Stl,
            MeshFormat::Glb => Self::Glb,
        }
    }
}

/// Runs `evenlight mesh`.
pub fn run(args: &MeshArgs, quiet: bool) -> Result<(), Failure> {
    let format = args.output.format(args.format)?;
    let progress = Progress::new(3, quiet);
    progress.stage("Building the surface");
    let surface = args.caps.read(&args.surface)?;
    progress.step();
    let mesh = progress.show(|| triangles(&surface, args.rate.into()))?;
    progress.step();
    progress.stage("Writing triangles");
    let has_primvars = io::MeshFormat::from(format).has_primvars();
    let primvars =
        if has_primvars { mesh.corner_primvars(&surface) } else { CornerPrimvars::default() };
    write(&mesh, &primvars, format, &args.output)?;
    let omitted = io::MeshFormat::from(format).omitted(&surface, &mesh, &primvars);
    omitted.iter().for_each(|sentence| warn(format_args!("{}: {sentence}", args.output)));
    Ok(())
}

/// Triangles with `rate` segments per edge.
pub fn triangles(surface: &Surface, rate: usize) -> Result<TriangleMesh, Failure> {
    tessellate(surface, rate).map_err(|error| Failure::Unusable(error.to_string()))
}

/// Writes `mesh`.
pub fn write(
    mesh: &TriangleMesh,
    primvars: &CornerPrimvars,
    format: MeshFormat,
    target: &Target,
) -> Result<(), Failure> {
    target.write(|mut out| io::MeshFormat::from(format).write(mesh, primvars, &mut out))
}
