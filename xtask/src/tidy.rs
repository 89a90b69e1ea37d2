//! `cargo xtask tidy`: what the compiler does not check.
//!
//! - modules of the library use only modules below them (the order is in [`LAYERS`]);
//! - in no crate do modules use each other in a circle ([`circles`]);
//! - comments are no wider than code, [`MAX_COLUMNS`];
//! - every citation key `[Key...]` is in `docs/refs.bib`;
//! - no file is longer than [`MAX_LINES`] lines, no function than [`MAX_FUNCTION`];
//! - no text that a commit should not leave behind ([`FORBIDDEN`]).

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::path::{Path, PathBuf};

use crate::circles::circles;

/// The modules of the library from the bottom up: each may use those before it.
const LAYERS: [&str; 21] = [
    "names",
    "point",
    "angle",
    "task",
    "quadrature",
    "dense",
    "sparse",
    "patch",
    "net",
    "mesh",
    "scheme",
    "rings",
    "cap",
    "basis",
    "surface",
    "stencil",
    "complex",
    "tessellate",
    "analyse",
    "io",
    "picture",
];

/// The most lines of a hand-written file, tests included.
const MAX_LINES: usize = 700;

/// The most lines of a function outside of tests.
const MAX_FUNCTION: usize = 70;

/// The width of a comment; rustfmt keeps code to it, but lets comments be.
const MAX_COLUMNS: usize = 100;

/// Words that stand for unfinished work or for the machine of whoever wrote them.
const FORBIDDEN: [&str; 6] = ["TODO", "FIXME", "XXX", "dbg!(", "todo!(", "/home/"];

/// Check what the compiler does not: module order, citations, lengths, leftovers.
#[derive(clap::Args)]
pub struct Arguments {}

/// Prints every fault; an error if there is one.
pub fn run(_arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let keys = citation_keys(&std::fs::read_to_string(super::workspace(
        "crates/evenlight/docs/refs.bib",
    ))?);
    let mut faults = Vec::new();
    let mut files = Vec::new();
    let mut crates: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
    for folder in ["crates", "xtask"] {
        collect_rust_files(&super::workspace(folder), &mut files)?;
    }
    files.sort();
    for file in &files {
        let text = std::fs::read_to_string(file)?;
        let name = file.strip_prefix(super::workspace(""))?.display().to_string();
        check_file(&name, &text, &keys, &mut faults);
        if let Some((krate, inside)) = name.split_once("/src/") {
            crates.entry(krate.to_owned()).or_default().push((inside.to_owned(), text));
        }
    }
    for (krate, files) in &crates {
        let found = circles(files).into_iter();
        faults.extend(found.map(|circle| format!("{krate}/src: {circle}")));
    }
    for fault in &faults {
        println!("{fault}");
    }
    if !faults.is_empty() {
        return Err(format!("{} places are not tidy", faults.len()).into());
    }
    println!("{} files are tidy", files.len());
    Ok(())
}

fn citation_keys(bibliography: &str) -> BTreeSet<String> {
    let entries = bibliography.lines().filter(|line| line.starts_with('@'));
    let key = |line: &str| Some(line.split_once('{')?.1.trim_end_matches(',').to_owned());
    entries.filter_map(key).collect()
}

fn collect_rust_files(folder: &Path, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
            collect_rust_files(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    Ok(())
}

fn check_file(name: &str, text: &str, keys: &BTreeSet<String>, faults: &mut Vec<String>) {
    let is_generated = text.starts_with("// GENERATED");
    let own_rules = name.ends_with("xtask/src/tidy.rs");
    if !is_generated && text.lines().count() > MAX_LINES {
        faults.push(format!("{name}: {} lines, {MAX_LINES} at most", text.lines().count()));
    }
    for (number, line) in text.lines().enumerate() {
        let at = format!("{name}:{}", number + 1);
        for key in cited(line).filter(|key| !keys.contains(*key)) {
            faults.push(format!("{at}: [{key}] is not in refs.bib"));
        }
        if is_comment(line) && line.chars().count() > MAX_COLUMNS {
            faults.push(format!("{at}: a comment of {} columns", line.chars().count()));
        }
        for word in FORBIDDEN.into_iter().filter(|word| !own_rules && line.contains(word)) {
            faults.push(format!("{at}: {word}"));
        }
    }
    if let Some(inside) = name.split_once("crates/evenlight/src/").map(|(_, inside)| inside) {
        check_layers(name, inside, text, faults);
    }
    check_functions(name, text, faults);
}

/// Whether a line is a comment alone, and no row of a table, which cannot be broken.
fn is_comment(line: &str) -> bool {
    let text = line.trim_start();
    text.starts_with("//") && !text.trim_start_matches(['/', '!']).trim_start().starts_with('|')
}

/// The keys cited in a line: after `[`, letters, two digits of a year, perhaps a suffix `-EG`.
fn cited(line: &str) -> impl Iterator<Item = &str> {
    line.split('[').skip(1).filter_map(|rest| {
        let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '-')?;
        let (key, after) = rest.split_at(end);
        let stem = key.split('-').next()?;
        let letters = stem.trim_end_matches(|c: char| c.is_ascii_digit());
        let is_key = stem.len() == letters.len() + 2
            && letters.len() >= 2
            && letters.starts_with(|c: char| c.is_ascii_uppercase())
            && letters.chars().all(|c| c.is_ascii_alphabetic());
        (is_key && after.starts_with([']', ',', '\\'])).then_some(key)
    })
}

fn check_layers(name: &str, inside: &str, text: &str, faults: &mut Vec<String>) {
    let layer = |module: &str| LAYERS.iter().position(|&other| other == module);
    let module = inside.split(['/', '.']).next().unwrap_or_default();
    let Some(own) = layer(module) else { return };
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    for used in code.split("crate::").skip(1) {
        let used =
            used.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default();
        if layer(used).is_some_and(|other| other > own) {
            faults.push(format!("{name}: `{module}` uses `{used}`, which lies above it"));
        }
    }
}

/// Lengths of functions by the indentation that rustfmt gives them.
fn check_functions(name: &str, text: &str, faults: &mut Vec<String>) {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let mut start: Option<(usize, &str, String)> = None;
    for (number, line) in code.lines().enumerate() {
        let indent = &line[..line.len() - line.trim_start().len()];
        let head = line.trim_start();
        let is_function = ["fn ", "pub fn ", "pub(crate) fn ", "pub(super) fn "]
            .iter()
            .any(|start| head.starts_with(start));
        if is_function && line.ends_with('{') {
            start = Some((number, indent, head.to_owned()));
        } else if let Some((first, outer, head)) = &start
            && line == format!("{outer}}}")
        {
            if number - first + 1 > MAX_FUNCTION {
                faults.push(format!("{name}:{}: {} lines: {head}", first + 1, number - first + 1));
            }
            start = None;
        }
    }
}
