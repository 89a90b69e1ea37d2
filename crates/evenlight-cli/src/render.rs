//! `evenlight render`: pictures, drawn without a graphics card.

use std::sync::Arc;

use clap::{Args, ValueEnum};
use evenlight::picture::{self, MAX_SIDE, Picture, RenderOptions, View};
use evenlight::{SchemeKind, Surface, VertexId};

use crate::cap::{self, CapRingsArg};
use crate::error::Failure;
use crate::input;
use crate::options::{parse_pair, parse_point, scheme_parser};
use crate::output::Target;
use crate::progress::Progress;
use crate::surface::{self, SurfaceArgs};

/// Arguments of `evenlight render`.
#[derive(Args, Debug)]
pub struct RenderArgs {
    #[command(flatten)]
    surface: SurfaceArgs,

    #[command(flatten)]
    caps: CapRingsArg,

    /// Schemes to show side by side, as `cc,eg,qas4`, with one camera and one range of colours
    #[arg(
        long,
        value_delimiter = ',',
        value_name = "SCHEMES",
        value_parser = scheme_parser(),
        hide_possible_values = true,
        conflicts_with = "scheme"
    )]
    compare: Vec<SchemeKind>,

    /// The file to write, .png; `-` for stdout
    #[arg(short, long, value_name = "FILE")]
    output: Target,

    #[command(flatten)]
    look: LookArgs,

    #[command(flatten)]
    camera: CameraArgs,
}

/// What a picture shows.
#[derive(Args, Debug)]
#[command(next_help_heading = "Look")]
struct LookArgs {
    /// What is shown
    #[arg(long, value_enum, default_value_t = Style::Shaded)]
    style: Style,

    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1200x900", value_parser = parse_size)]
    size: [usize; 2],

    /// Ends of the colour map, -R to R: 1/length for `mean`, 1/length^2 for `gauss` [default: so
    /// that 96 percent of what is seen lies within]
    #[arg(long, value_name = "R")]
    range: Option<f64>,

    /// Dark highlight stripes over the half turn that is seen
    #[arg(long, value_name = "N", default_value_t = 24)]
    stripes: usize,

    /// Direction of the lights of the highlight lines, in degrees counter-clockwise from upright
    #[arg(long, value_name = "DEG", default_value_t = 45.0, allow_negative_numbers = true)]
    stripe_direction: f64,

    /// Samples per pixel in either direction, 1 to 8
    #[arg(long, value_name = "N", default_value_t = 3)]
    samples: usize,

    /// Write the name of the scheme in the corner (`--compare` always does)
    #[arg(long)]
    label: bool,
}

/// Where a surface is seen from.
#[derive(Args, Debug)]
#[command(next_help_heading = "Camera")]
struct CameraArgs {
    /// Direction of the eye in degrees: azimuth about the z axis (0: the front, against the y
    /// axis; 90: from the x axis) and elevation (90: straight down)
    #[arg(long, value_name = "AZ,EL", default_value = "30,25", value_parser = parse_direction, allow_hyphen_values = true)]
    view: [f64; 2],

    /// Magnification; 1 shows the whole surface
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    zoom: f64,

    /// Point in the middle of the picture, in the units of the cage [default: the middle of the
    /// surface]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true)]
    target: Option<[f64; 3]>,

    /// Extraordinary vertex (numbered from 0) to look at, along its limit normal
    #[arg(long, value_name = "VERTEX", conflicts_with_all = ["view", "target"])]
    at: Option<u32>,
}

/// What can be shown, by the short names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Style {
    /// Clay in the light of a studio
    Shaded,
    /// Highlight lines, which show how the normal turns
    Highlight,
    /// Gauss curvature with a colour bar
    Gauss,
    /// Mean curvature with a colour bar
    Mean,
    /// Layout of the patches
    Patches,
}

impl From<Style> for picture::Style {
    fn from(style: Style) -> Self {
        match style {
            Style::Shaded => Self::Shaded,
            Style::Highlight => Self::Highlight,
            Style::Gauss => Self::Gauss,
            Style::Mean => Self::Mean,
            Style::Patches => Self::Patches,
        }
    }
}

/// Files that hold pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum PictureFormat {
    Png,
}

/// Runs `evenlight render`.
pub fn run(args: &RenderArgs, quiet: bool) -> Result<(), Failure> {
    let stdout = (args.output == Target::Stdout).then_some(PictureFormat::Png);
    args.output.format(stdout)?;
    let progress = Progress::new(3, quiet);
    progress.stage("Building the surface");
    let surfaces = surfaces(args)?;
    progress.step();
    let options = options(args, &surfaces[0])?;
    let picture = progress.show(|| draw(&surfaces, &options, !args.compare.is_empty()))?;
    progress.step();
    progress.stage("Writing the picture");
    write(&picture, &args.output)
}

/// Draws one surface, or several side by side with the names of their schemes.
pub fn draw(
    surfaces: &[Surface],
    options: &RenderOptions,
    with_names: bool,
) -> Result<Picture, Failure> {
    let named: Vec<(&str, &Surface)> =
        surfaces.iter().map(|surface| (surface.options().scheme.name(), surface)).collect();
    let picture = match surfaces {
        [only] if !with_names => picture::render(only, options),
        _ => picture::compare(&named, options),
    };
    picture.map_err(|error| Failure::Usage(error.to_string()))
}

/// Writes `picture` as PNG.
pub fn write(picture: &Picture, target: &Target) -> Result<(), Failure> {
    target.write(|out| picture.write_png(out))
}

/// The view along the limit normal of the extraordinary vertex `vertex`.
pub fn view_at(surface: &Surface, vertex: VertexId) -> Option<View> {
    let points = surface.extraordinary_points();
    View::toward(surface, points.iter().position(|point| point.vertex() == Some(vertex))?)
}

/// The surfaces to show, at least one.
fn surfaces(args: &RenderArgs) -> Result<Vec<Surface>, Failure> {
    let SurfaceArgs { cage, scheme, q, .. } = &args.surface;
    let source = &cage.source;
    let single = [*scheme];
    let schemes = if args.compare.is_empty() { &single[..] } else { &args.compare };
    let kind = args.caps.cap.kind(schemes)?;
    let edits = q.read(source, schemes)?;
    let cage = input::read_cage(cage)?;
    let build = |&scheme| -> Result<Surface, Failure> {
        let options = args.surface.rules.options_among(schemes, scheme);
        let options = args.surface.boundary.applied_to(options);
        let mut surface = surface::build(Arc::clone(&cage), options, source)?;
        edits.apply(&mut surface)?;
        cap::close(&mut surface, kind, args.caps.rings.into())?;
        Ok(surface)
    };
    let surfaces = schemes.iter().map(build).collect::<Result<Vec<_>, _>>()?;
    surface::report_omitted(&surfaces[0], source)?;
    Ok(surfaces)
}

fn options(args: &RenderArgs, surface: &Surface) -> Result<RenderOptions, Failure> {
    let look = &args.look;
    Ok(RenderOptions {
        style: look.style.into(),
        size: look.size,
        view: view(&args.camera, surface)?,
        range: look.range,
        stripes: look.stripes,
        stripe_direction: look.stripe_direction,
        samples: look.samples,
        label: look.label,
    })
}

fn view(camera: &CameraArgs, surface: &Surface) -> Result<View, Failure> {
    let [azimuth, elevation] = camera.view;
    let view = match camera.at {
        None => View { azimuth, elevation, target: camera.target, ..View::default() },
        Some(vertex) => view_at(surface, VertexId(vertex)).ok_or_else(|| {
            Failure::Usage(format!(
                "--at {vertex}: this is no extraordinary vertex with a surface and a normal \
                 ('evenlight check' lists them)"
            ))
        })?,
    };
    Ok(View { zoom: camera.zoom, ..view })
}

fn parse_size(text: &str) -> Result<[usize; 2], String> {
    let size: [usize; 2] = parse_pair(&text.to_ascii_lowercase(), 'x')?;
    let legal = size.iter().all(|side| (1..=MAX_SIDE).contains(side));
    if legal { Ok(size) } else { Err(format!("each side has 1 to {MAX_SIDE} pixels")) }
}

fn parse_direction(text: &str) -> Result<[f64; 2], String> {
    let angles: [f64; 2] = parse_pair(text, ',')?;
    let finite = angles.iter().all(|angle| angle.is_finite());
    if finite { Ok(angles) } else { Err("angles must be finite".to_owned()) }
}
