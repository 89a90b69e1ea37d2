//! Chores of the workspace: `cargo xtask CHORE`.
//!
//! One file per chore. Chores that run the library belong behind `#[cfg(feature = "library")]`,
//! so that `tables` can be built while the library cannot.

#[cfg(feature = "library")]
mod bench;
#[cfg(feature = "library")]
mod caps;
mod circles;
#[cfg(feature = "library")]
mod creases;
#[cfg(feature = "library")]
mod demo_cage;
#[cfg(feature = "library")]
mod document;
mod feature_cages;
mod font;
#[cfg(feature = "library")]
mod guided;
mod osd;
#[cfg(feature = "library")]
mod pictures;
#[cfg(feature = "library")]
mod shape;
#[cfg(feature = "library")]
mod study;
mod tables;
mod threads;
mod tidy;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;

/// Chores of the Evenlight workspace.
#[derive(Parser)]
#[command(name = "cargo xtask")]
enum Chore {
    #[cfg(feature = "library")]
    Bench(bench::Arguments),
    #[cfg(feature = "library")]
    Caps(caps::Arguments),
    #[cfg(feature = "library")]
    Creases(creases::Arguments),
    #[cfg(feature = "library")]
    DemoCage(demo_cage::Arguments),
    FeatureCages(feature_cages::Arguments),
    Font(font::Arguments),
    #[cfg(feature = "library")]
    Guided(guided::Arguments),
    Osd(osd::Arguments),
    #[cfg(feature = "library")]
    Pictures(pictures::Arguments),
    #[cfg(feature = "library")]
    Shape(shape::Arguments),
    #[cfg(feature = "library")]
    Study(study::Arguments),
    Tables(tables::Arguments),
    Tidy(tidy::Arguments),
}

fn main() -> ExitCode {
    match run(&Chore::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(chore: &Chore) -> Result<(), Box<dyn Error>> {
    match chore {
        #[cfg(feature = "library")]
        Chore::Bench(arguments) => bench::run(arguments),
        #[cfg(feature = "library")]
        Chore::Caps(arguments) => caps::run(arguments),
        #[cfg(feature = "library")]
        Chore::Creases(arguments) => creases::run(arguments),
        #[cfg(feature = "library")]
        Chore::DemoCage(arguments) => demo_cage::run(arguments),
        Chore::FeatureCages(arguments) => feature_cages::run(arguments),
        Chore::Font(arguments) => font::run(arguments),
        #[cfg(feature = "library")]
        Chore::Guided(arguments) => guided::run(arguments),
        Chore::Osd(arguments) => osd::run(arguments),
        #[cfg(feature = "library")]
        Chore::Pictures(arguments) => pictures::run(arguments),
        #[cfg(feature = "library")]
        Chore::Shape(arguments) => shape::run(arguments),
        #[cfg(feature = "library")]
        Chore::Study(arguments) => study::run(arguments),
        Chore::Tables(arguments) => tables::run(arguments),
        Chore::Tidy(arguments) => tidy::run(arguments),
    }
}

/// The folder or file `path` of the workspace.
fn workspace(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}
