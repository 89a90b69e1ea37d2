//! `evenlight patches`: the surface as Bernstein-Bezier patches.

use std::io::{self, Write};

use clap::{Args, ValueEnum};
use evenlight::Surface;
use evenlight::io::bv;
use evenlight::surface::{PlacedPatch, Role};
use serde::{Serialize, Serializer};

use crate::cap::CapArg;
use crate::error::Failure;
use crate::options::rules_name;
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
    target.write(|mut out| match format {
        PatchFormat::Bv => bv::write(surface.patches(rings), &mut out),
        PatchFormat::Json => write_json(surface, rings, out),
    })
}

fn write_json(surface: &Surface, rings: usize, out: &mut dyn Write) -> io::Result<()> {
    let options = surface.options();
    let document = Document {
        scheme: options.scheme.name(),
        rules: rules_name(options),
        contraction: options.contraction.to_string(),
        rings,
        patches: AllPatches { surface, rings },
    };
    serde_json::to_writer(&mut *out, &document)?;
    out.write_all(b"\n")
}

#[derive(Serialize)]
struct Document<'a> {
    scheme: &'static str,
    /// `null` for schemes without tables.
    rules: Option<&'static str>,
    /// `cc`, `half` or a number.
    contraction: String,
    rings: usize,
    patches: AllPatches<'a>,
}

/// The patches, made one by one while they are written: there can be millions.
struct AllPatches<'a> {
    surface: &'a Surface,
    rings: usize,
}

impl Serialize for AllPatches<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let patches = self.surface.patches(self.rings);
        serializer.collect_seq(patches.map(|patch| Record::new(self.surface, patch)))
    }
}

/// One patch in the file.
#[derive(Serialize)]
struct Record {
    role: String,
    face: u32,
    /// The corner of the face, if that is an n-gon.
    corner: Option<usize>,
    /// The extraordinary vertex; `null` for regular patches and around the centre of an n-gon.
    vertex: Option<u32>,
    /// The n-gon around whose centre the patch lies.
    centre_of: Option<u32>,
    sector: Option<usize>,
    ring: Option<usize>,
    /// The part of the face's unit square: `[[u0, u1], [v0, v1]]`.
    domain: [[f64; 2]; 2],
    degree: [usize; 2],
    /// `(du + 1) (dv + 1)` points, v index fastest.
    coefficients: Vec<[f64; 3]>,
}

impl Record {
    fn new(surface: &Surface, placed: PlacedPatch) -> Self {
        let PlacedPatch { place, patch } = placed;
        let (face, corner) = surface.face_of(place.quad).expect("patches are in quads");
        let is_quad = surface.topology().faces().corners(face).len() == 4;
        let center = place.point.map(|i| &surface.extraordinary_points()[i]);
        Self {
            role: place.role.to_string(),
            face: face.0,
            corner: (!is_quad).then_some(corner),
            vertex: center.and_then(|p| p.vertex()).map(|v| v.0),
            centre_of: center.and_then(|p| p.face()).map(|f| f.0),
            sector: place.sector,
            ring: ring(place.role),
            domain: place.domain,
            degree: patch.degree(),
            coefficients: patch.coefs().to_vec(),
        }
    }
}

fn ring(role: Role) -> Option<usize> {
    match role {
        Role::Ring(k) => Some(k + 1),
        _ => None,
    }
}
