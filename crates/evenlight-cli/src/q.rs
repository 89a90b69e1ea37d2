//! `evenlight q`: the quadratics at extraordinary points, and `--q`, which replaces them.
//!
//! ```text
//! evenlight q cage.obj --json -o q.json     the default quadratics
//!            (edit q.json)
//! evenlight mesh cage.obj --q q.json ...    the surface that they attract
//! ```
//!
//! The six points of a quadratic, as JSON lists them, lie like this in a sector:
//!
//! ```text
//!        line s                coefficients[0] = q_1 is the limit point, with q_2 and q_4 it
//!     q_6                      spans the tangent plane; the others bend the surface
//!     q_4  q_5
//!     q_1  q_2  q_3  line s-1
//! ```

use std::io::{self, Write};

use clap::Args;
use evenlight::mesh::isolation::Place;
use evenlight::net::Quadratic;
use evenlight::rings::Rings;
use evenlight::surface::ExtraordinaryPoint;
use evenlight::{Point, Surface};
use serde_json::json;

use crate::edits::no_quadratic;
use crate::error::Failure;
use crate::output::Target;
use crate::surface::{self, SurfaceArgs};
use crate::table::{Table, point_name, short, triple};

/// Arguments of `evenlight q`.
#[derive(Args, Debug)]
pub struct QArgs {
    #[command(flatten)]
    surface: SurfaceArgs,

    /// JSON instead of a table: a list that `--q` reads, with the six points of q in sector 0
    #[arg(long)]
    json: bool,

    /// JSON with the six points of q in every sector, in place of those in sector 0
    #[arg(long)]
    sectors: bool,

    /// The file to write; `-` for stdout
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: Target,
}

/// Runs `evenlight q`.
pub fn run(args: &QArgs) -> Result<(), Failure> {
    let scheme = args.surface.scheme;
    if !scheme.has_quadratic() {
        return Err(no_quadratic("q", scheme.name()));
    }
    let surface = surface::read_surface(&args.surface)?;
    let rows = rows(&surface);
    args.output.write(|out| match (args.json, args.sectors) {
        (false, false) => write!(out, "{}", table(&rows)),
        (_, with_sectors) => write_json(&rows, with_sectors, out),
    })
}

/// The quadratic at one point.
struct Row<'a> {
    point: &'a ExtraordinaryPoint,
    rings: &'a Rings,
    q: Quadratic,
    /// The larger first, in 1/unit; NaN without a tangent plane.
    principal_curvatures: [f64; 2],
}

fn rows(surface: &Surface) -> Vec<Row<'_>> {
    let points = surface.extraordinary_points().iter().enumerate();
    // Points with Catmull-Clark's rule have none.
    let row = |(k, point)| {
        let rings = surface.rings(k)?;
        let q = *rings.quadratic()?;
        let principal_curvatures = rings.eval(0, 0.0, 0.0)?.principal_curvatures();
        Some(Row { point, rings, q, principal_curvatures })
    };
    points.filter_map(row).collect()
}

/// The quadratics for people.
fn table(rows: &[Row]) -> Table {
    let mut table = Table::new(&["point", "valence", "center", "normal", "k1", "k2"]);
    for Row { point, rings, principal_curvatures: k, .. } in rows {
        let vectors = [rings.center(), rings.normal()].map(triple);
        let names = [point_name(point), point.valence.to_string()];
        table.push(names.into_iter().chain(vectors).chain(k.map(short)));
    }
    table
}

/// A list of objects, one point of a quadratic per line.
fn write_json(rows: &[Row], with_sectors: bool, out: &mut dyn Write) -> io::Result<()> {
    let objects: Vec<String> = rows.iter().map(|row| object(row, with_sectors)).collect();
    writeln!(out, "[{}]", objects.join(","))
}

fn object(row: &Row, with_sectors: bool) -> String {
    let Row { point, rings, q, principal_curvatures } = row;
    let id = match point.place {
        Place::Vertex(v) => format!("\"vertex\": {}", v.0),
        Place::FaceCentre(f) => format!("\"face\": {}", f.0),
    };
    let points = if with_sectors {
        let sectors = (0..point.valence).filter_map(|s| q.in_sector(point.valence, s));
        format!("\"sectors\": [{}]", sectors.map(|q| lines(&q.coefs)).collect::<Vec<_>>().join(","))
    } else {
        format!("\"coefficients\": {}", lines(&q.coefs))
    };
    // What does not exist is null: JSON has no word for NaN.
    format!(
        "\n{{{id}, \"valence\": {}, \"center\": {},\n\"normal\": {}, \"principal_curvatures\": {},\n{points}}}",
        point.valence,
        json!(rings.center()),
        json!(existing(rings.normal())),
        json!(existing(*principal_curvatures)),
    )
}

fn existing<const N: usize>(numbers: [f64; N]) -> Option<[f64; N]> {
    numbers.iter().all(|x| x.is_finite()).then_some(numbers)
}

fn lines(points: &[Point; 6]) -> String {
    format!("[\n  {}]", points.map(|p| json!(p).to_string()).join(",\n  "))
}
