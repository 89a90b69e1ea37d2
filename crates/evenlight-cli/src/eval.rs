//! `evenlight eval`: position, derivatives, normal and curvature at given parameters.
//!
//! ```text
//! face,u,v          face,u,v,x,y,z,xu,yu,zu, ... ,K,H
//! 0,0.5,0.25   ->   0,0.5,0.25,1.0000000000000000e0, ...
//! ```

use std::io::{self, Write};

use clap::Args;
use evenlight::mesh::Primvar;
use evenlight::patch::Answer;
use evenlight::{FaceId, QuadId, Surface, SurfacePoint};

use crate::cap::CapRingsArg;
use crate::error::Failure;
use crate::input::{self, Source, WHY_OMITTED};
use crate::output::Target;
use crate::progress::Progress;
use crate::surface::SurfaceArgs;

/// Arguments of `evenlight eval`.
#[derive(Args, Debug)]
pub struct EvalArgs {
    #[command(flatten)]
    surface: SurfaceArgs,

    #[command(flatten)]
    caps: CapRingsArg,

    /// The parameters: rows `face,u,v` with u and v in [0,1], or `face,u,v,corner` for faces
    /// that are no quads; all counted from 0. A header line, blank lines and comments (#) are
    /// skipped. `-` for stdin
    #[arg(long, value_name = "FILE")]
    points: Source,

    /// Also the primvars of the cage (texture coordinates, colours): for each, columns NAME.0,
    /// NAME.1 ... with its numbers, then NAME.0u ... and NAME.0v ... with their derivatives
    #[arg(long)]
    primvars: bool,

    /// The answers: the input columns, then x,y,z, the derivatives xu ... zvv, the unit normal
    /// nx,ny,nz, Gauss curvature K (1/length^2) and mean curvature H (1/length), with 17
    /// digits; `-` for stdout
    ///
    /// At an extraordinary point itself, unless --cap closes it, derivatives do not exist: they are
    /// `nan`. K and H are those of the quadratic or of the guide there for qas3, qas4, fair3, fair4
    /// and guided3 to guided6, and `nan` for the other schemes.
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: Target,
}

/// The columns of the answer.
const ANSWER: &str = "x,y,z,xu,yu,zu,xv,yv,zv,xuu,yuu,zuu,xuv,yuv,zuv,xvv,yvv,zvv,nx,ny,nz,K,H";

/// Points that are evaluated between two steps of the progress bar.
const BATCH: usize = 1 << 14;

/// Runs `evenlight eval`.
pub fn run(args: &EvalArgs, quiet: bool) -> Result<(), Failure> {
    let SurfaceArgs { cage, q, .. } = &args.surface;
    let q = q.file.iter().map(|file| ("--q", file));
    let sources = [("cage", &cage.source), ("points", &args.points)];
    input::refuse_shared_stdin(&sources.into_iter().chain(q).collect::<Vec<_>>())?;
    let surface = args.caps.read(&args.surface)?;
    let text = args.points.read_text()?;
    evaluate(&surface, &args.points, &text, args.primvars, &args.output, quiet)
}

/// Answers the queries in `text`, which was read from `source`.
pub fn evaluate(
    surface: &Surface,
    source: &Source,
    text: &str,
    with_primvars: bool,
    target: &Target,
    quiet: bool,
) -> Result<(), Failure> {
    let table = Table::parse(text).map_err(|fault| fault.in_file(source))?;
    let quads: Result<Vec<QuadId>, Fault> = table.rows.iter().map(|r| r.quad(surface)).collect();
    let quads = quads.map_err(|fault| fault.in_file(source))?;
    let progress = Progress::new(table.rows.len().div_ceil(BATCH), quiet);
    progress.stage("Evaluating");
    target.write(|out| {
        let corner = if table.has_corners { ",corner" } else { "" };
        let primvars = if with_primvars { surface.primvars() } else { &[] };
        writeln!(out, "face,u,v{corner},{ANSWER}{}", primvar_columns(primvars))?;
        for (rows, quads) in table.rows.chunks(BATCH).zip(quads.chunks(BATCH)) {
            for (k, answer) in answers(surface, rows, quads).iter().enumerate() {
                write_row(out, &rows[k], table.has_corners, answer)?;
                write_primvars(out, surface, primvars, quads[k], &rows[k])?;
                out.write_all(b"\n")?;
            }
            progress.step();
        }
        Ok(())
    })
}

fn answers(surface: &Surface, rows: &[Row], quads: &[QuadId]) -> Vec<SurfacePoint> {
    let places: Vec<_> = rows.iter().zip(quads).map(|(row, &quad)| (quad, row.u, row.v)).collect();
    // Rows on omitted faces were refused: there is an answer everywhere.
    let mut answers = vec![SurfacePoint::NAN; rows.len()];
    surface.eval_each(&places, &mut answers).expect("there is an answer for every place");
    answers
}

fn write_row(
    out: &mut dyn Write,
    row: &Row,
    has_corners: bool,
    answer: &SurfacePoint,
) -> io::Result<()> {
    out.write_all(row.text.as_bytes())?;
    if has_corners && !row.has_corner_field {
        out.write_all(b",")?;
    }
    let curvature = [answer.gauss, answer.mean];
    let vectors = answer.jet.rows().into_iter().chain([answer.normal]);
    vectors.flatten().chain(curvature).try_for_each(|x| write_number(out, x))
}

/// The columns of primvars, each with a comma before it.
fn primvar_columns(primvars: &[Primvar]) -> String {
    let mut columns = String::new();
    for primvar in primvars {
        let name = primvar.name.replace([',', '"', '\n', '\r'], "_");
        for order in ["", "u", "v"] {
            columns.extend((0..primvar.width).map(|k| format!(",{name}.{k}{order}")));
        }
    }
    columns
}

fn write_primvars(
    out: &mut dyn Write,
    surface: &Surface,
    primvars: &[Primvar],
    quad: QuadId,
    row: &Row,
) -> io::Result<()> {
    for (k, primvar) in primvars.iter().enumerate() {
        let jet = surface
            .eval_primvar::<4>(k, quad, row.u, row.v)
            .expect("rows on omitted faces were refused, and the primvar is one of the cage");
        let numbers = [jet.p, jet.du, jet.dv];
        let numbers = numbers.iter().flat_map(|x| &x[..primvar.width]);
        numbers.copied().try_for_each(|x| write_number(out, x))?;
    }
    Ok(())
}

/// A column with 17 digits; `nan` for what does not exist.
fn write_number(out: &mut dyn Write, x: f64) -> io::Result<()> {
    if x.is_nan() { out.write_all(b",nan") } else { write!(out, ",{x:.16e}") }
}

/// The queries of a file.
struct Table<'a> {
    rows: Vec<Row<'a>>,
    /// Whether there is a fourth column.
    has_corners: bool,
}

/// One query.
struct Row<'a> {
    line: usize,
    /// The columns as they were read.
    text: &'a str,
    face: FaceId,
    u: f64,
    v: f64,
    corner: Option<usize>,
    /// Whether there is a fourth column, which may be empty on quads.
    has_corner_field: bool,
}

/// What is wrong with a line.
struct Fault {
    line: usize,
    text: String,
}

impl Fault {
    fn in_file(self, source: &Source) -> Failure {
        Failure::Unusable(format!("{source}:{}: {}", self.line, self.text))
    }
}

impl<'a> Table<'a> {
    fn parse(text: &'a str) -> Result<Self, Fault> {
        let text = text.trim_start_matches('\u{feff}');
        let numbered = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
        let mut rows =
            numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with('#')).peekable();
        let header = rows.next_if(|(_, line)| is_header(line));
        let rows: Vec<Row> =
            rows.map(|(line, text)| Row::parse(line, text)).collect::<Result<_, _>>()?;
        let has_corners = header.is_some_and(|(_, line)| fields(line).count() == 4)
            || rows.iter().any(|row| row.has_corner_field);
        Ok(Self { rows, has_corners })
    }
}

fn fields(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(str::trim)
}

fn is_header(line: &str) -> bool {
    let names: Vec<String> = fields(line).map(str::to_ascii_lowercase).collect();
    names == ["face", "u", "v"] || names == ["face", "u", "v", "corner"]
}

/// Whether `name` is the name of a column rather than a value.
fn is_word(name: &str) -> bool {
    name.starts_with(|c: char| c.is_alphabetic()) && name.parse::<f64>().is_err()
}

impl<'a> Row<'a> {
    fn parse(line: usize, text: &'a str) -> Result<Self, Fault> {
        let fault = |text: String| Fault { line, text };
        let columns: Vec<&str> = fields(text).collect();
        if columns.len() > 1 && columns.iter().all(|name| is_word(name)) {
            let message = "the columns must be face,u,v or face,u,v,corner, in this order: \
                           correct the header and the rows";
            return Err(fault(message.to_owned()));
        }
        let (face, u, v, corner) = match columns[..] {
            [face, u, v] => (face, u, v, ""),
            [face, u, v, corner] => (face, u, v, corner),
            _ => return Err(fault("a row is face,u,v or face,u,v,corner".to_owned())),
        };
        Ok(Self {
            line,
            text,
            face: FaceId(count("face", face).map_err(fault)?),
            u: parameter("u", u).map_err(fault)?,
            v: parameter("v", v).map_err(fault)?,
            corner: optional_count("corner", corner).map_err(fault)?,
            has_corner_field: columns.len() == 4,
        })
    }

    /// The parametric quad that is asked for, which has a surface.
    fn quad(&self, surface: &Surface) -> Result<QuadId, Fault> {
        let fault = |text: String| Fault { line: self.line, text };
        let faces = surface.topology().faces();
        if self.face.index() >= faces.len() {
            return Err(fault(format!(
                "there is no face {}: {}",
                self.face.0,
                all_faces(faces.len())
            )));
        }
        let size = faces.corners(self.face).len();
        let corner = corner_of(self.face, size, self.corner).map_err(fault)?;
        if surface.is_omitted(self.face) {
            return Err(fault(format!("face {} is left out ({WHY_OMITTED})", self.face.0)));
        }
        Ok(surface.quad(self.face, corner).expect("face and corner were checked"))
    }
}

fn all_faces(count: usize) -> String {
    match count {
        0 => "the cage has no faces".to_owned(),
        _ => format!("the cage has the faces 0 to {}", count - 1),
    }
}

/// The corner of the parametric quad in a face with `size` corners.
fn corner_of(face: FaceId, size: usize, corner: Option<usize>) -> Result<usize, String> {
    match (size, corner) {
        (4, None | Some(0)) => Ok(0),
        (4, Some(_)) => {
            Err(format!("face {} is a quad: leave the corner empty (or write 0)", face.0))
        }
        (_, None) => Err(format!(
            "face {} has {size} corners: say in a fourth column at which corner (0 to {})",
            face.0,
            size - 1
        )),
        (_, Some(k)) if k < size => Ok(k),
        (_, Some(k)) => Err(format!("face {} has no corner {k}, only 0 to {}", face.0, size - 1)),
    }
}

fn count<T: std::str::FromStr>(name: &str, text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("{name} '{text}' is not a number counted from 0"))
}

fn optional_count<T: std::str::FromStr>(name: &str, text: &str) -> Result<Option<T>, String> {
    if text.is_empty() { Ok(None) } else { count(name, text).map(Some) }
}

fn parameter(name: &str, text: &str) -> Result<f64, String> {
    let x: f64 = text.parse().map_err(|_| format!("{name} '{text}' is not a number"))?;
    if (0.0..=1.0).contains(&x) { Ok(x) } else { Err(format!("{name} = {text} is outside [0, 1]")) }
}
