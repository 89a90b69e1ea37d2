//! `cargo xtask caps`: how well caps join and how fair they are, over the obstacle course.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use evenlight::analyse::caps::{CapReport, cap_report};
use evenlight::cap::{CapKind, CapOptions};
use evenlight::io::obj;
use evenlight::{Cage, SchemeKind, Surface, SurfaceOptions};

use crate::threads::map_on_threads;

/// Measure caps over the obstacle course.
#[derive(clap::Args)]
pub struct Arguments {
    /// The rings in front of caps
    #[arg(long, value_delimiter = ',', default_value = "0,2,4,6")]
    rings: Vec<usize>,
}

const OBSTACLES: &str = "data/meshes/obstacle";

/// H may leave the range of the rings in front by this part of the curvature.
const SLACK: f64 = 1e-3;

/// Prints the table.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let mut files = std::fs::read_dir(crate::workspace(OBSTACLES))?
        .map(|entry| Ok(entry?.path()))
        .collect::<std::io::Result<Vec<_>>>()?;
    files.sort();
    for scheme in SchemeKind::ALL {
        for kind in CapKind::ALL {
            for &rings in &arguments.rings {
                let options = CapOptions { rings, kind };
                let found = map_on_threads(&files, |file| {
                    measured(file, scheme, options).map_err(|error| error.to_string())
                });
                let found = found.into_iter().collect::<Result<Vec<_>, String>>()?;
                let found: Vec<(String, CapReport)> = found.into_iter().flatten().collect();
                if !found.is_empty() {
                    print_row(scheme, options, &found);
                }
            }
        }
    }
    Ok(())
}

fn print_row(scheme: SchemeKind, options: CapOptions, found: &[(String, CapReport)]) {
    let most = |f: &dyn Fn(&CapReport) -> f64| found.iter().map(|(_, r)| f(r)).fold(0.0, f64::max);
    let mean = |f: &dyn Fn(&CapReport) -> f64| {
        found.iter().map(|(_, r)| f(r)).sum::<f64>() / found.len() as f64
    };
    let outside: Vec<_> =
        found.iter().filter(|(_, r)| r.excess().is_some_and(|e| e > SLACK)).collect();
    println!(
        "{:8} {} K {} | G0 {:.0e} | G1 deg lines {:.1e} ({:.1e}) ring {:.0e} | G2 lines {:.3} ({:.3}) inside {:.3} ({:.3}) ring {:.3} ({:.3}) | outside {} of {} most {:.3} {:?} mean {:.4}",
        scheme.name(),
        options.kind.name(),
        options.rings,
        most(&|r| r.lines.position.max(r.ring.position)),
        most(&|r| r.lines.tangent_plane.to_degrees()),
        mean(&|r| r.lines.tangent_plane.to_degrees()),
        most(&|r| r.ring.tangent_plane.max(r.inside.tangent_plane).to_degrees()),
        most(&|r| r.lines.curvature),
        mean(&|r| r.lines.curvature),
        most(&|r| r.inside.curvature),
        mean(&|r| r.inside.curvature),
        most(&|r| r.ring.curvature),
        mean(&|r| r.ring.curvature),
        outside.len(),
        found.len(),
        most(&|r| r.excess().unwrap_or(0.0)),
        found
            .iter()
            .max_by(|a, b| a.1.excess().unwrap_or(0.0).total_cmp(&b.1.excess().unwrap_or(0.0)))
            .map(|a| &a.0),
        mean(&|r| r.excess().unwrap_or(0.0)),
    );
}

/// The caps of the extraordinary points of a cage that are not flat; none if they do not fit.
fn measured(
    file: &Path,
    scheme: SchemeKind,
    options: CapOptions,
) -> Result<Vec<(String, CapReport)>, Box<dyn Error>> {
    let (cage, _) = obj::read_cage(&std::fs::read(file)?)?;
    let cage: Arc<Cage> = Arc::new(cage);
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut surface = Surface::build(cage, SurfaceOptions { scheme, ..SurfaceOptions::default() })?;
    if options.kind.check(scheme).is_err() {
        return Ok(Vec::new());
    }
    surface.set_caps(Some(options))?;
    let reports = cap_report(&surface).into_iter().filter(|report| report.scale > 0.0);
    Ok(reports.map(|report| (name.clone(), report)).collect())
}
