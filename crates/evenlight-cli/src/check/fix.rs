//! `evenlight check --fix`: repairs of a cage, on request only.

use std::io::{self, Write};

use clap::Args;
use evenlight::Cage;
use evenlight::mesh::fix::{self, Change, Repaired, Repairs};
use serde::Serialize;

use crate::convert::{self, CageFormat};
use crate::error::{Failure, warn};
use crate::input::{self, CageArg};
use crate::output::Target;

/// Arguments of `evenlight check --fix`.
#[derive(Args, Debug)]
pub struct FixArgs {
    /// Write the cage with the repairs below to this file, .obj, .ply or .usda, and say what was
    /// done instead of what is in it; nothing is written if there is nothing to do
    #[arg(long = "fix", value_name = "OUT")]
    pub target: Option<Target>,

    /// Repair: merge vertices not further apart than this, in the units of the cage
    #[arg(long, value_name = "DISTANCE", requires = "target", allow_negative_numbers = true, value_parser = distance)]
    merge: Option<f64>,

    /// Repair: flip faces that disagree with most of their piece
    #[arg(long, requires = "target")]
    flip: bool,

    /// Repair: give every fan of faces around a vertex a vertex of its own, and take apart what
    /// meets at edges of three faces or more
    #[arg(long, requires = "target")]
    split: bool,

    /// Repair: delete vertices in no face
    #[arg(long, requires = "target")]
    drop_unused: bool,
}

/// Reads a finite number from 0.
fn distance(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0);
    number.ok_or_else(|| "a distance is a number from 0".to_owned())
}

/// What was done. Vertices and faces are numbered as in the file that was read, those in
/// `errors` from 0 in the file that was written.
#[derive(Debug, Serialize)]
struct Report {
    changes: Vec<String>,
    /// What was asked for but cannot be done.
    obstacles: Vec<String>,
    /// What is still wrong.
    errors: Vec<String>,
}

impl FixArgs {
    /// Repairs the cage in `arg`, writes it to `target` and a report to `output`.
    ///
    /// # Errors
    ///
    /// No repair is chosen; there is nothing to do; faults remain.
    pub fn run(
        &self,
        arg: &CageArg,
        target: &Target,
        json: bool,
        output: &Target,
    ) -> Result<(), Failure> {
        if *target == Target::Stdout {
            let message = "--fix needs a file, .obj, .ply or .usda: on stdout there is the report";
            return Err(Failure::Usage(message.to_owned()));
        }
        let format = target.format::<CageFormat>(None)?;
        let repairs = self.repairs()?;
        let loaded = input::load(arg)?;
        for notice in &loaded.notices {
            warn(format_args!("{}: {notice}", arg.source));
        }
        let refused =
            |error: &dyn std::fmt::Display| Failure::Unusable(format!("{}: {error}", arg.source));
        let repaired = fix::fix(&loaded.mesh, &repairs).map_err(|error| refused(&error))?;
        let report = Report::new(&repaired, &loaded.naming);
        if repaired.changes.is_empty() {
            let why = if report.obstacles.is_empty() {
                "none of these repairs has anything to do".to_owned()
            } else {
                report.obstacles.join("\n")
            };
            return Err(refused(&format!("nothing is changed, and nothing written: {why}")));
        }
        convert::write(&repaired.mesh, format.into(), false, target)?;
        if json {
            output.write_json(&report)?;
        } else {
            output.write(|out| report.write_text(target, out))?;
        }
        report.result(target)
    }

    fn repairs(&self) -> Result<Repairs, Failure> {
        let Self { merge, flip, split, drop_unused, .. } = *self;
        let repairs = Repairs { merge, flip, split, drop_unused };
        if repairs == Repairs::default() {
            let message = "--fix needs to be told what to repair: --merge DISTANCE, --flip, \
                           --split or --drop-unused";
            return Err(Failure::Usage(message.to_owned()));
        }
        Ok(repairs)
    }
}

impl Report {
    fn new(repaired: &Repaired, names: &dyn evenlight::mesh::Names) -> Self {
        let faults = Cage::new(repaired.mesh.clone()).err();
        let errors = faults.iter().flat_map(|e| &e.errors).map(ToString::to_string);
        let changes = repaired.changes.iter().map(|change: &Change| change.describe(names));
        let obstacles = repaired.obstacles.iter().map(|obstacle| obstacle.describe(names));
        Self {
            changes: changes.collect(),
            obstacles: obstacles.collect(),
            errors: errors.collect(),
        }
    }

    /// The report for people.
    fn write_text(&self, target: &Target, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "{target}: written")?;
        self.changes.iter().try_for_each(|change| writeln!(out, "  {change}"))?;
        self.obstacles.iter().try_for_each(|obstacle| writeln!(out, "  not done: {obstacle}"))
    }

    /// A failure if the repaired cage cannot be used either.
    fn result(&self, target: &Target) -> Result<(), Failure> {
        match &self.errors[..] {
            [] => Ok(()),
            [first, others @ ..] => {
                let more = if others.is_empty() {
                    String::new()
                } else {
                    format!(" (and {} more faults; see `evenlight check`)", others.len())
                };
                Err(Failure::Unusable(format!("{target}: still cannot be used: {first}{more}")))
            }
        }
    }
}
