//! `evenlight demo`: all subcommands on a cage of ours, and a report.
//!
//! Every file but the cage, the points, the edited quadratic and the report is made by a command
//! that the report shows: whoever types it in the folder gets the same bytes.

mod report;
mod steps;
mod subject;

use std::fs;
use std::path::PathBuf;

use clap::Args;

use crate::error::Failure;
use crate::input::Source;
use crate::options::parse_pair;
use crate::output::Target;
use crate::progress::Progress;
use steps::{Step, steps};
use subject::Subject;

/// A closed body with extraordinary vertices of valence 3, 5, 6 and 8.
const CAGE: &str = include_str!("../assets/demo.obj");

/// The names of the files from which all others are made.
const CAGE_FILE: &str = "cage.obj";
const POINTS_FILE: &str = "points.csv";
const EDIT_FILE: &str = "edit.json";

/// Arguments of `evenlight demo`.
#[derive(Args, Debug)]
pub struct DemoArgs {
    /// The folder to write to; made if it is not there
    #[arg(value_name = "DIR", default_value = "evenlight-demo")]
    folder: PathBuf,

    /// Width and height of single pictures in pixels; comparisons have 3/2 of the width and
    /// 2/3 of the height
    #[arg(long, value_name = "WxH", default_value = "1200x900", value_parser = parse_size)]
    size: [usize; 2],
}

fn parse_size(text: &str) -> Result<[usize; 2], String> {
    let size: [usize; 2] = parse_pair(text, 'x')?;
    let legal = size.iter().all(|side| (12..=6000).contains(side));
    if legal { Ok(size) } else { Err("each side has 12 to 6000 pixels".to_owned()) }
}

/// Runs `evenlight demo`.
pub fn run(args: &DemoArgs, quiet: bool) -> Result<(), Failure> {
    let folder = Folder { path: args.folder.clone() };
    folder.create()?;
    folder.write(CAGE_FILE, CAGE)?;
    let subject = Subject::new(&folder.source(CAGE_FILE))?;
    let close_ups = subject.close_ups();
    folder.write(POINTS_FILE, &subject.points_towards(&close_ups))?;
    let handle = subject.handle().expect("our cage has extraordinary vertices");
    folder.write(EDIT_FILE, &handle.edit())?;

    let steps = steps(&close_ups, &handle, args.size);
    let progress = Progress::new(steps.len(), quiet);
    for step in &steps {
        progress.stage(step.file.clone());
        crate::run_words(&folder.words(step))?;
        progress.step();
    }
    folder.write("report.md", &report::markdown(&subject, &close_ups, &steps)?)?;
    let summary = report::summary(&args.folder, &subject, &steps);
    Target::Stdout.write(|out| out.write_all(summary.as_bytes()))
}

/// The folder of the demonstration.
struct Folder {
    path: PathBuf,
}

impl Folder {
    fn create(&self) -> Result<(), Failure> {
        fs::create_dir_all(&self.path).map_err(|e| Failure::io(self.path.display(), &e))
    }

    fn write(&self, file: &str, text: &str) -> Result<(), Failure> {
        Target::File(self.path.join(file)).write(|out| out.write_all(text.as_bytes()))
    }

    fn source(&self, file: &str) -> Source {
        Source::File(self.path.join(file))
    }

    /// The words of a step's command with its files in this folder.
    fn words(&self, step: &Step) -> Vec<std::ffi::OsString> {
        let is_file = |word: &str| [&step.file, CAGE_FILE, POINTS_FILE, EDIT_FILE].contains(&word);
        let words = step.command.split(' ');
        words.map(|w| if is_file(w) { self.path.join(w).into() } else { w.into() }).collect()
    }
}
