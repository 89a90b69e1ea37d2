//! The arguments that make a surface, and the way from them to it.
//!
//! ```text
//! SurfaceArgs --input--> cage --options--> surface --edits--> surface with the quadratics of --q
//! ```

use std::sync::Arc;

use clap::Args;
use evenlight::mesh::isolation::Place;
use evenlight::surface::{PointRule, Reason, SurfaceError};
use evenlight::{Cage, SchemeKind, Surface, SurfaceOptions};

use crate::edits::QArg;
use crate::error::{Failure, warn};
use crate::input::{CageArg, Source, WHY_OMITTED, omitted_text, read_cage};
use crate::options::{BoundaryArg, RulesArg, scheme_parser};

/// The cage and the rules that make a surface of it.
#[derive(Args, Clone, Debug)]
pub struct SurfaceArgs {
    #[command(flatten)]
    pub cage: CageArg,

    /// Subdivision scheme; what it is like around an extraordinary point of valence n
    #[arg(long, default_value = SchemeKind::default().name(), value_parser = scheme_parser())]
    pub scheme: SchemeKind,

    #[command(flatten)]
    pub rules: RulesArg,

    #[command(flatten)]
    pub boundary: BoundaryArg,

    #[command(flatten)]
    pub q: QArg,
}

impl SurfaceArgs {
    /// Scheme and rules in the library's terms.
    pub fn options(&self) -> SurfaceOptions {
        self.boundary.applied_to(self.rules.options(self.scheme))
    }
}

/// The surface that `args` ask for; what is ignored or left out is said on stderr.
pub fn read_surface(args: &SurfaceArgs) -> Result<Surface, Failure> {
    let source = &args.cage.source;
    let edits = args.q.read(source, &[args.scheme])?;
    let mut surface = build(read_cage(&args.cage)?, args.options(), source)?;
    report_omitted(&surface, source)?;
    edits.apply(&mut surface)?;
    Ok(surface)
}

/// The surface over `cage`, which was read from `source`; says on stderr which points have not the
/// rules of the scheme because it has none for their valence.
pub fn build(
    cage: Arc<Cage>,
    options: SurfaceOptions,
    source: &Source,
) -> Result<Surface, Failure> {
    let surface = Surface::build(cage, options).map_err(|error| match error {
        SurfaceError::Contraction(error) => Failure::Usage(error.to_string()),
        error => Failure::Unusable(format!("{source}: {error}")),
    })?;
    let places = surface.extraordinary_points().iter().filter_map(|point| {
        (point.rule == PointRule::CatmullClark(Reason::Valence))
            .then_some((point.place, point.valence))
    });
    if let Some(warning) = valence_warning(places, options) {
        warn(format_args!("{source}: {warning}"));
    }
    Ok(surface)
}

/// The most points that a warning names.
const LISTED: usize = 8;

/// The sentence on the points, with their valences, for which the scheme has no rules.
pub fn valence_warning(
    points: impl Iterator<Item = (Place, usize)>,
    options: SurfaceOptions,
) -> Option<String> {
    let SurfaceOptions { scheme, rules, .. } = options;
    if scheme == SchemeKind::CatmullClark {
        return None; // nothing can take its place: where it has no rules, there is no surface
    }
    let name = |(place, valence): (Place, usize)| match place {
        Place::Vertex(v) => format!("vertex {} has valence {valence}", v.0),
        Place::FaceCentre(f) => format!("face {} has {valence} corners", f.0),
    };
    let without_rules = points.filter(|&(_, valence)| !scheme.has_rules(rules, valence));
    let mut names: Vec<String> = without_rules.map(name).collect();
    if names.is_empty() {
        return None;
    }
    let more = names.len().saturating_sub(LISTED);
    names.truncate(LISTED);
    if more > 0 {
        names.push(format!("{more} more"));
    }
    let valences = match scheme.valences(rules) {
        "none" => "no published rules".to_owned(),
        valences => format!("rules for valences {valences} only"),
    };
    Some(format!(
        "scheme {} has {valences}, cc takes their place: {} (numbers from 0)",
        scheme.name(),
        names.join(", ")
    ))
}

/// Says on stderr which faces have no surface.
///
/// # Errors
///
/// If none has.
pub fn report_omitted(surface: &Surface, source: &Source) -> Result<(), Failure> {
    let faces = surface.topology().faces().len();
    match surface.omitted_faces().len() {
        0 => Ok(()),
        omitted if omitted == faces => {
            let all = if faces == 1 {
                "the only face is".to_owned()
            } else {
                format!("all {faces} faces are")
            };
            Err(Failure::Unusable(format!(
                "{source}: {all} left out ({WHY_OMITTED}): no surface remains"
            )))
        }
        omitted => {
            warn(format_args!("{source}: {}", omitted_text(omitted, faces)));
            Ok(())
        }
    }
}
