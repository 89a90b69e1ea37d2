//! `evenlight spectrum`: eigenvalues of the subdivision rules per valence.

mod pictures;

use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::Args;
use evenlight::analyse::spectrum::{Spectrum, spectrum};
use evenlight::scheme::ContractionError;
use evenlight::{RuleSet, SchemeKind, SurfaceOptions, Variant};
use serde::Serialize;

use crate::error::Failure;
use crate::options::{RulesArg, parse_valences, rules_name, scheme_parser};
use crate::output::Target;
use crate::progress::Progress;
use crate::table::{Table, short};

/// Arguments of `evenlight spectrum`.
#[derive(Args, Debug)]
pub struct SpectrumArgs {
    /// Subdivision scheme; what it is like around an extraordinary point of valence n
    #[arg(long, default_value = SchemeKind::default().name(), value_parser = scheme_parser())]
    scheme: SchemeKind,

    #[command(flatten)]
    rules: RulesArg,

    /// Valences: one, or a range that includes both ends and skips the regular valence 4
    #[arg(long, value_name = "N|A..B", default_value = "3..10", value_parser = parse_valences)]
    valence: RangeInclusive<usize>,

    /// JSON instead of a table, with all eigenvalues
    #[arg(long)]
    json: bool,

    /// Folder for pictures of the eigenfunctions, made if it is not there: for each valence and
    /// each degree s one file with the functions of eigenvalue lambda^s (guided schemes only)
    #[arg(long, value_name = "DIR")]
    eigenfunctions: Option<PathBuf>,

    /// The file to write; `-` for stdout
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: Target,
}

/// Runs `evenlight spectrum`.
pub fn run(args: &SpectrumArgs, quiet: bool) -> Result<(), Failure> {
    let options = args.rules.options(args.scheme);
    let spectra = spectra(options, &args.valence, quiet)?;
    if let Some(folder) = &args.eigenfunctions {
        pictures::write(folder, options, &spectra, quiet)?;
    }
    if args.json {
        args.output.write_json(&Document::new(options, &spectra))
    } else {
        args.output.write(|out| write!(out, "{}", table(&spectra)))
    }
}

/// The spectra at `valences`; a range leaves out the regular valence 4.
///
/// # Errors
///
/// Wrong usage if there are no rules for one of them.
pub fn spectra(
    options: SurfaceOptions,
    valences: &RangeInclusive<usize>,
    quiet: bool,
) -> Result<Vec<Spectrum>, Failure> {
    let (scheme, variant) = (options.scheme, options.variant());
    let wrong = |error: ContractionError| Failure::Usage(error.to_string());
    scheme.check_contraction(options.contraction).map_err(wrong)?;
    let is_range = valences.start() < valences.end();
    let valences: Vec<usize> = valences.clone().filter(|&n| !(is_range && n == 4)).collect();
    if let Some(&n) = valences.iter().find(|&&n| !scheme.has_rules(variant, n)) {
        return Err(Failure::Usage(no_rules(options, n)));
    }
    let progress = Progress::new(valences.len(), quiet);
    progress.stage("Computing eigenvalues");
    let spectra = valences.into_iter().filter_map(|n| spectrum(scheme, variant, n));
    Ok(spectra.inspect(|_| progress.step()).collect())
}

fn no_rules(options: SurfaceOptions, valence: usize) -> String {
    let (scheme, variant) = (options.scheme, options.variant());
    let kind = rules_name(options).map(|r| r.to_owned() + " ");
    let others = Variant { rules: RuleSet::Generated, ..variant };
    let advice = if variant != others && scheme.has_rules(others, valence) {
        format!("; its generated rules are for {}", scheme.valences(others))
    } else {
        String::new()
    };
    format!(
        "the scheme {} has {}rules for the valences {}, not for {valence}{advice}",
        scheme.name(),
        kind.unwrap_or_default(),
        scheme.valences(variant)
    )
}

/// The spectra for people.
pub fn table(spectra: &[Spectrum]) -> Table {
    let mut table = Table::new(&[
        "valence",
        "lambda",
        "mu/lambda^2",
        "M_d/lambda^2",
        "zeros %",
        "min Jacobian",
        "injective",
        "largest eigenvalues by modulus",
    ]);
    for s in spectra {
        let largest: Vec<String> = s.moduli.iter().take(8).map(|m| format!("{m:.4}")).collect();
        table.push([
            s.valence.to_string(),
            format!("{:.6}", s.lambda),
            format!("{:.6}", s.mu_over_lambda2),
            s.md_max_over_lambda2.map_or("-".to_owned(), |md| format!("{md:.6}")),
            format!("{:.1}", s.zeros_percent),
            short(s.jacobian_min),
            if s.injectivity_proved { "proved" } else { "no" }.to_owned(),
            largest.join(" "),
        ]);
    }
    table
}

/// The JSON document.
#[derive(Serialize)]
pub struct Document<'a> {
    scheme: &'static str,
    /// `null` for schemes without tables.
    rules: Option<&'static str>,
    /// `cc`, `half` or a number.
    contraction: String,
    spectra: Vec<Record<'a>>,
}

/// One valence.
#[derive(Serialize)]
struct Record<'a> {
    valence: usize,
    /// The moduli, falling.
    eigenvalues: &'a [f64],
    lambda: f64,
    mu_over_lambda2: f64,
    /// The largest eigenvalue of the control net's block over lambda^2; `null` for schemes
    /// without a quadratic.
    md_max_over_lambda2: Option<f64>,
    /// Zeros of the whole matrix.
    zeros_percent: f64,
    /// Relative to the largest Jacobian.
    jacobian_min: f64,
    /// Whether the characteristic map is proved to be injective.
    injectivity_proved: bool,
}

impl<'a> Document<'a> {
    /// The document on `spectra`, which were computed with `options`.
    pub fn new(options: SurfaceOptions, spectra: &'a [Spectrum]) -> Self {
        let record = |s: &'a Spectrum| Record {
            valence: s.valence,
            eigenvalues: &s.moduli,
            lambda: s.lambda,
            mu_over_lambda2: s.mu_over_lambda2,
            md_max_over_lambda2: s.md_max_over_lambda2,
            zeros_percent: s.zeros_percent,
            jacobian_min: s.jacobian_min,
            injectivity_proved: s.injectivity_proved,
        };
        Self {
            scheme: options.scheme.name(),
            rules: rules_name(options),
            contraction: options.contraction.to_string(),
            spectra: spectra.iter().map(record).collect(),
        }
    }
}
