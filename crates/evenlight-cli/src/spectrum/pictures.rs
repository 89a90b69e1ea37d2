//! `evenlight spectrum --eigenfunctions`: pictures of the eigenfunctions.

use std::fs;
use std::path::Path;

use evenlight::SurfaceOptions;
use evenlight::analyse::spectrum::Spectrum;
use evenlight::basis::{Eigenfunctions, MAX_TOTAL_DEGREE};
use evenlight::picture::{GraphOptions, eigenfunctions};

use crate::error::Failure;
use crate::output::Target;
use crate::progress::Progress;

/// The side of a panel in pixels: one function.
const PANEL: usize = 300;

/// Writes for each valence of `spectra` and each degree s a file `SCHEME_nNN_sNN.png`.
///
/// # Errors
///
/// Wrong usage if the scheme has no eigenfunctions of guides; errors of writing.
pub fn write(
    folder: &Path,
    options: SurfaceOptions,
    spectra: &[Spectrum],
    quiet: bool,
) -> Result<(), Failure> {
    let SurfaceOptions { scheme, contraction, .. } = options;
    let none = || {
        Failure::Usage(format!(
            "--eigenfunctions: the scheme {} follows no guide; choose one of guided3 to guided6",
            scheme.name()
        ))
    };
    let of_valence =
        |s: &Spectrum| Eigenfunctions::with_contraction(scheme, contraction, s.valence);
    let functions: Vec<_> =
        spectra.iter().map(of_valence).collect::<Option<_>>().ok_or_else(none)?;
    fs::create_dir_all(folder).map_err(|e| Failure::io(folder.display(), &e))?;
    let progress = Progress::new(functions.len() * (MAX_TOTAL_DEGREE + 1), quiet);
    for functions in &functions {
        for degree in 0..=MAX_TOTAL_DEGREE {
            let name = format!("{}_n{:02}_s{degree:02}.png", scheme.name(), functions.valence());
            progress.stage(name.clone());
            draw(functions, degree, &Target::File(folder.join(name)))?;
            progress.step();
        }
    }
    Ok(())
}

/// Draws the functions of eigenvalue lambda^`degree`, about as many beside each other as above.
fn draw(functions: &Eigenfunctions, degree: usize, target: &Target) -> Result<(), Failure> {
    let which: Vec<usize> = functions.of_degree(degree).collect();
    let columns = (1..).find(|&k| k * k >= which.len()).unwrap_or(1);
    let size = [columns * PANEL, which.len().div_ceil(columns) * PANEL];
    let options = GraphOptions { size, ..GraphOptions::default() };
    let picture = eigenfunctions(functions, &which, &options);
    let picture = picture.map_err(|error| Failure::Usage(error.to_string()))?;
    target.write(|out| picture.write_png(out))
}
