//! Options that several subcommands share.

use std::ops::RangeInclusive;
use std::str::FromStr;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use evenlight::mesh::BoundaryRule;
use evenlight::surface::CreaseRings;
use evenlight::{Contraction, RuleSet, SchemeKind, SurfaceOptions, UnknownName};

/// Options that stand before or after any subcommand.
#[derive(Args, Clone, Copy, Debug)]
pub struct Global {
    /// Never draw the progress bar (which shows on a terminal only, after one second);
    /// warnings and errors are still written
    #[arg(short, long, global = true, display_order = 100)]
    pub quiet: bool,

    /// Number of threads; the results do not depend on it [default: one per core]
    #[arg(long, global = true, display_order = 101, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// What happens at the boundary and beside creases.
#[derive(Args, Clone, Copy, Debug)]
pub struct BoundaryArg {
    /// The rule at the boundary of an open cage [default: what the file says, or else
    /// edge-and-corner]
    #[arg(long, value_name = "RULE", value_parser = named(BoundaryRule::ALL, BoundaryRule::name, about_boundary))]
    pub boundary: Option<BoundaryRule>,

    /// The rings of vertices on infinitely sharp creases and the boundary that are not regular
    /// there; the curves of creases are the same with both
    #[arg(long, value_name = "RINGS", default_value_t, value_parser = named(CreaseRings::ALL, CreaseRings::name, about_creases))]
    pub creases: CreaseRings,
}

impl BoundaryArg {
    /// The options with what happens at boundaries and creases.
    pub fn applied_to(self, options: SurfaceOptions) -> SurfaceOptions {
        SurfaceOptions { boundary: self.boundary, creases: self.creases, ..options }
    }
}

/// Which rules the scheme takes.
#[derive(Args, Clone, Copy, Debug)]
pub struct RulesArg {
    /// Tables of weights of the scheme (`cc` is a formula and has none)
    #[arg(long, default_value_t, value_parser = named(RuleSet::ALL, RuleSet::name, about_rules))]
    pub rules: RuleSet,

    /// How fast the rings of guided schemes contract: `cc` as Catmull-Clark's, `half` by 1/2 at
    /// every valence, or any factor between 0.3 and 0.7; other schemes contract as they do
    #[arg(long, value_name = "cc|half|LAMBDA", default_value = "cc")]
    pub contraction: Contraction,
}

impl RulesArg {
    /// How a surface of the only scheme is built.
    pub fn options(&self, scheme: SchemeKind) -> SurfaceOptions {
        SurfaceOptions {
            scheme,
            rules: self.rules,
            contraction: self.contraction,
            ..SurfaceOptions::default()
        }
    }

    /// How a surface of one of several schemes is built: those with one contraction keep it.
    pub fn options_among(&self, schemes: &[SchemeKind], scheme: SchemeKind) -> SurfaceOptions {
        let has = |scheme: &SchemeKind| scheme.check_contraction(self.contraction).is_ok();
        let options = self.options(scheme);
        if schemes.iter().any(has) && !has(&scheme) {
            return SurfaceOptions { contraction: Contraction::CatmullClark, ..options };
        }
        options
    }
}

/// Reads the name of one of `all` choices, each listed with what `about` says of it.
fn named<T, const N: usize>(
    all: [T; N],
    name: fn(T) -> &'static str,
    about: fn(T) -> String,
) -> impl TypedValueParser<Value = T>
where
    T: Copy + FromStr<Err = UnknownName> + Send + Sync + 'static,
{
    let values = all.map(|choice| PossibleValue::new(name(choice)).help(about(choice)));
    PossibleValuesParser::new(values).try_map(|name| name.parse())
}

/// Reads the short name of a scheme.
pub fn scheme_parser() -> impl TypedValueParser<Value = SchemeKind> {
    named(SchemeKind::ALL, SchemeKind::name, |scheme| about_scheme(scheme).to_owned())
}

/// The degree, the patches around a point of valence n, the continuity there.
fn about_scheme(scheme: SchemeKind) -> &'static str {
    match scheme {
        SchemeKind::CatmullClark => {
            "Catmull-Clark: bi-3, 3n patches per ring; C1, curvature unbounded"
        }
        SchemeKind::EvolvingGuide => {
            "Evolving-Guide: bi-4, 3n patches per ring; C1, curvature grows slowly"
        }
        SchemeKind::Pas3 => {
            "Point-augmented: bi-3, 12n patches per ring; C1, curvature grows slowly"
        }
        SchemeKind::Pas4 => {
            "Point-augmented: bi-4, 3n patches per ring; C1, curvature grows slowly"
        }
        SchemeKind::Qas3 => {
            "Quadratic-Attraction: bi-3, 12n patches per ring; C1, curvature bounded"
        }
        SchemeKind::Qas4 => {
            "Quadratic-Attraction: bi-4, 3n patches per ring; C1, curvature bounded"
        }
        SchemeKind::Guided3 => "Guided C2: bi-3, 27n patches per ring; C1, curvature bounded",
        SchemeKind::Guided4 => "Guided C2: bi-4, 12n patches per ring; C1, curvature bounded",
        SchemeKind::Guided5 => "Guided C2: bi-5, 3n patches per ring; C1, curvature bounded",
        SchemeKind::Guided6 => "Guided C2: bi-6, 3n patches per ring; C2, curvature continuous",
        SchemeKind::Fair4 => "Fairness-optimal: QAS4's net with the rules of least energy, bi-4",
        SchemeKind::Fair4d => "Fairness-optimal: EG's net with the rules of least energy, bi-4",
        SchemeKind::Fair3 => "Fairness-optimal: QAS3's net with the rules of least energy, bi-3",
        _ => "Described in the library",
    }
}

fn about_boundary(rule: BoundaryRule) -> String {
    match rule {
        BoundaryRule::None => "Faces that touch the boundary have no surface",
        BoundaryRule::EdgeOnly => {
            "The boundary is a smooth curve, also at vertices of a single face"
        }
        BoundaryRule::EdgeAndCorner => {
            "The boundary is a smooth curve through the vertices of a single face"
        }
    }
    .to_owned()
}

fn about_creases(rings: CreaseRings) -> String {
    match rings {
        CreaseRings::CatmullClark => {
            "Catmull-Clark's, as in OpenSubdiv: no tangent plane from four faces between sharp \
             edges on"
        }
        CreaseRings::Fair => {
            "Least energy: tangent plane and bounded curvature, for up to 12 faces"
        }
        _ => "Described in the library",
    }
    .to_owned()
}

fn about_rules(rules: RuleSet) -> String {
    let about = match rules {
        RuleSet::Published => "Five digits, as the papers print them",
        RuleSet::Generated => "Full precision",
        _ => "Described in the library",
    };
    format!("{about}; valences {}", valences(rules))
}

/// The valences with rules, in words, schemes with the same valences together.
fn valences(rules: RuleSet) -> String {
    let mut groups: Vec<(&str, Vec<&str>)> = Vec::new();
    for scheme in SchemeKind::ALL {
        let valences = scheme.valences(rules);
        match groups.iter_mut().find(|(other, _)| *other == valences) {
            Some((_, names)) => names.push(scheme.name()),
            None => groups.push((valences, vec![scheme.name()])),
        }
    }
    let texts = groups.iter().map(|(valences, names)| format!("{valences} ({})", names.join(", ")));
    texts.collect::<Vec<_>>().join(", ")
}

/// The name of the tables on the command line and in files; `None` for a scheme without.
pub fn rules_name(options: SurfaceOptions) -> Option<&'static str> {
    (options.scheme != SchemeKind::CatmullClark).then(|| options.rules.name())
}

/// Two numbers with `separator` between them, as in `1200x900` or `-30,20`.
pub fn parse_pair<T: FromStr>(text: &str, separator: char) -> Result<[T; 2], String> {
    let parts = text.split_once(separator).and_then(|(a, b)| Some([number(a)?, number(b)?]));
    parts.ok_or_else(|| format!("two numbers with '{separator}' between them are needed"))
}

/// A point `x,y,z`.
pub fn parse_point(text: &str) -> Result<[f64; 3], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
    let point = numbers.and_then(|n| <[f64; 3]>::try_from(n).ok());
    point
        .filter(|p| p.iter().all(|x| x.is_finite()))
        .ok_or_else(|| "three numbers x,y,z are needed".to_owned())
}

/// A range of valences `a..b` (both included), or a single one.
pub fn parse_valences(text: &str) -> Result<RangeInclusive<usize>, String> {
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    let last = last.strip_prefix('=').unwrap_or(last);
    let range = number(first).zip(number(last)).map(|(a, b): (usize, usize)| a..=b);
    range
        .filter(|range| !range.is_empty())
        .ok_or_else(|| "a valence or an inclusive range such as 3..10 is needed".to_owned())
}

fn number<T: FromStr>(text: &str) -> Option<T> {
    text.trim().parse().ok()
}
