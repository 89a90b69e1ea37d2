//! The command line of Evenlight: cage in, class-A surface out.
//!
//! Every subcommand is one file and one short story: arguments, library, file.
//!
//! ```text
//! check      is the cage fit, and what is in it     convert   cages: .obj .ply .usda
//! mesh       triangles: .obj .ply .stl .glb
//! patches    BB patches: .bv .json                  eval      points, derivatives, curvature
//! render     pictures: .png                         analyze   fairness in numbers
//! q          quadratics, to be edited for --q       spectrum  eigenvalues of the rules
//! demo       all of it on a cage of ours
//! ```

mod analyze;
mod cap;
mod check;
mod convert;
mod demo;
mod edits;
mod error;
mod eval;
mod input;
mod mesh;
mod options;
mod output;
mod patches;
mod progress;
mod q;
mod render;
mod spectrum;
mod surface;
mod table;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use evenlight::task::Task;

use error::Failure;
use options::Global;

/// Fair subdivision surfaces from quad cages: Quadratic-Attraction and Evolving-Guide surfaces
/// beside Catmull-Clark, as exact Bernstein-Bezier patches.
///
/// Faces and vertices are numbered from 0, but in messages about a line of a file as there. A face
/// with four corners a b c d has parameters (u,v) in the unit square, a at (0,0), b at (1,0), c at
/// (1,1), d at (0,1). Any other face is one such square per corner, from the corner at (0,0) to the
/// face's centre at (1,1). Lengths are in the units of the cage, angles in degrees.
///
/// Exit codes: 0 good, 1 the input cannot be used, 2 wrong usage.
#[derive(Parser)]
#[command(name = "evenlight", version, max_term_width = 100)]
struct Cli {
    #[command(flatten)]
    global: Global,

    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Everything below on a cage of ours, with a report
    Demo(demo::DemoArgs),
    /// Whether a cage can be used, and what is in it
    Check(check::CheckArgs),
    /// A cage from one kind of file to another: .obj, .ply, .usda
    Convert(convert::ConvertArgs),
    /// The surface as Bernstein-Bezier patches: BezierView .bv or .json
    Patches(patches::PatchesArgs),
    /// Triangles of the limit surface with exact normals: .obj, .ply, .stl or .glb
    Mesh(mesh::MeshArgs),
    /// Position, derivatives, normal and curvature at given parameters: .csv
    Eval(eval::EvalArgs),
    /// A picture: shaded, highlight lines, curvature or patches: .png
    Render(render::RenderArgs),
    /// Curvature and continuity around every extraordinary vertex
    Analyze(analyze::AnalyzeArgs),
    /// The quadratics to which surfaces tend at extraordinary points, to be edited for --q
    Q(q::QArgs),
    /// Eigenvalues of the subdivision rules per valence
    Spectrum(spectrum::SpectrumArgs),
    /// A completion script for a shell, to stdout
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let threads = cli.global.threads.map_or(0, usize::from);
    match Task::new().threads(threads).run(|| run(&cli)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

fn run(cli: &Cli) -> Result<(), Failure> {
    let quiet = cli.global.quiet;
    match &cli.command {
        Command::Demo(args) => demo::run(args, quiet),
        Command::Check(args) => check::run(args),
        Command::Convert(args) => convert::run(args),
        Command::Patches(args) => patches::run(args, quiet),
        Command::Mesh(args) => mesh::run(args, quiet),
        Command::Eval(args) => eval::run(args, quiet),
        Command::Render(args) => render::run(args, quiet),
        Command::Analyze(args) => analyze::run(args, quiet),
        Command::Q(args) => q::run(args),
        Command::Spectrum(args) => spectrum::run(args, quiet),
        Command::Completions { shell } => completions(*shell),
    }
}

/// Runs the program again on other words, without progress bar and usage message.
fn run_words(words: &[OsString]) -> Result<(), Failure> {
    let program = ["evenlight", "--quiet"].map(OsString::from);
    let cli = Cli::try_parse_from(program.iter().chain(words))
        .map_err(|error| Failure::Usage(error.to_string()))?;
    run(&cli)
}

fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "evenlight", &mut script);
    output::Target::Stdout.write(|out| out.write_all(&script))
}
