//! `cargo xtask osd`: limit surfaces by OpenSubdiv, for comparison.
//!
//! Needs OpenSubdiv's library and a C++ compiler (Debian: `apt-get install libosd-dev g++`).
//! Nothing else of the project does: the results for our own cages are kept in
//! `data/golden/osd`, where the tests find them.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

/// Write limit surfaces by OpenSubdiv as text (needs libosd-dev and g++)
#[derive(Args)]
pub struct Arguments {
    /// Folder of OBJ files
    #[arg(default_value = "data/meshes/features")]
    cages: PathBuf,
    /// Folder for the results, a text of the same name for every file
    #[arg(default_value = "data/golden/osd")]
    results: PathBuf,
}

const FOLDER: &str = "tools/osd_oracle";

/// Writes the results.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let oracle = compile("oracle", &["-O2"])?;
    fs::create_dir_all(&arguments.results)?;
    let mut cages: Vec<PathBuf> = fs::read_dir(&arguments.cages)?
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<_, std::io::Error>>()?;
    cages.retain(|path| path.extension().is_some_and(|extension| extension == "obj"));
    cages.sort();
    for cage in &cages {
        let name = cage.file_stem().ok_or("a file without a name")?;
        let result = arguments.results.join(name).with_extension("txt");
        let output = Command::new(&oracle).arg(cage).output()?;
        if !output.status.success() {
            let message = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{}: {}", cage.display(), message.trim()).into());
        }
        fs::write(&result, output.stdout)?;
    }
    println!("{}: {} results", arguments.results.display(), cages.len());
    Ok(())
}

/// Compiles a program of the oracle's folder into the target folder.
pub fn compile(name: &str, flags: &[&str]) -> Result<PathBuf, Box<dyn Error>> {
    let source = crate::workspace(FOLDER).join(name).with_extension("cpp");
    let target = std::env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| crate::workspace("target"), PathBuf::from);
    fs::create_dir_all(&target)?;
    let program = target.join(format!("osd-{name}"));
    let mut compiler = Command::new("g++");
    compiler.args(["-std=c++17"]).args(flags).arg(&source).arg("-o").arg(&program).arg("-losdCPU");
    let status = compiler.status().map_err(|error| format!("cannot run g++: {error}"))?;
    if !status.success() {
        return Err("the program does not compile: is OpenSubdiv (libosd-dev) installed?".into());
    }
    Ok(absolute(&program)?)
}

fn absolute(path: &Path) -> std::io::Result<PathBuf> {
    fs::canonicalize(path)
}
