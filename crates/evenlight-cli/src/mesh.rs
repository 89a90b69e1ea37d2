//! `evenlight mesh`: triangles of the limit surface.

use clap::{Args, ValueEnum};
use evenlight::Surface;
use evenlight::io::{glb, obj_out, ply_out, stl};
use evenlight::mesh::{Interpolation, Primvar};
use evenlight::tessellate::{CornerValues, TriangleMesh, tessellate};

use crate::cap::CapRingsArg;
use crate::error::Failure;
use crate::options::SurfaceArgs;
use crate::output::Target;
use crate::progress::Progress;

/// Arguments of `evenlight mesh`.
#[derive(Args, Debug)]
pub struct MeshArgs {
    #[command(flatten)]
    surface: SurfaceArgs,

    #[command(flatten)]
    caps: CapRingsArg,

    /// The file to write: .obj with normals and texture coordinates, .ply or .glb with normals and
    /// curvature, or .stl; `-` for stdout
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
    /// Wavefront OBJ with normals, and the texture coordinates of the cage
    Obj,
    /// PLY with normals, Gauss and mean curvature per vertex
    Ply,
    /// Binary STL
    Stl,
    /// Binary glTF with normals, Gauss and mean curvature per vertex
    Glb,
}

/// Runs `evenlight mesh`.
pub fn run(args: &MeshArgs, quiet: bool) -> Result<(), Failure> {
    let format = args.output.format(args.format)?;
    let progress = Progress::new(3, quiet);
    progress.stage("Building the surface");
    let surface = args.caps.read(&args.surface)?;
    progress.step();
    progress.stage("Evaluating vertices");
    let mesh = triangles(&surface, args.rate.into())?;
    progress.step();
    progress.stage("Writing triangles");
    let texture = texture(&surface, &mesh).filter(|_| format == MeshFormat::Obj);
    write(&mesh, texture.as_ref(), format, &args.output)
}

/// Triangles with `rate` segments per edge.
pub fn triangles(surface: &Surface, rate: usize) -> Result<TriangleMesh, Failure> {
    tessellate(surface, rate).map_err(|error| Failure::Unusable(error.to_string()))
}

/// The texture coordinates of the triangles: the first channel of the cage with values of corners
/// that are two numbers or more.
fn texture(surface: &Surface, mesh: &TriangleMesh) -> Option<CornerValues> {
    let is_texture = |p: &Primvar| p.interpolation == Interpolation::FaceVarying && p.width >= 2;
    let primvar = surface.primvars().iter().position(is_texture)?;
    mesh.corner_values(surface, primvar)
}

/// Writes `mesh`.
pub fn write(
    mesh: &TriangleMesh,
    texture: Option<&CornerValues>,
    format: MeshFormat,
    target: &Target,
) -> Result<(), Failure> {
    target.write(|mut out| match (format, texture) {
        (MeshFormat::Obj, None) => obj_out::write(mesh, &mut out),
        (MeshFormat::Obj, Some(texture)) => obj_out::write_textured(mesh, texture, &mut out),
        (MeshFormat::Ply, _) => ply_out::write(mesh, &mut out),
        (MeshFormat::Stl, _) => stl::write(mesh, &mut out),
        (MeshFormat::Glb, _) => glb::write(mesh, &mut out),
    })
}
