//! Options that several subcommands share.

use std::ops::RangeInclusive;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use evenlight::mesh::BoundaryRule;
use evenlight::surface::CreaseRings;
use evenlight::{Contraction, RuleSet, SchemeKind, SurfaceOptions};

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
    #[arg(long, value_enum, value_name = "RULE")]
    pub boundary: Option<Boundary>,

    /// The rings of vertices on infinitely sharp creases and the boundary that are not regular there;
    /// the curves of creases are the same with both
    #[arg(long, value_enum, value_name = "RINGS", default_value_t = Creases::Cc)]
    pub creases: Creases,
}

/// The rings beside creases by their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Creases {
    /// Catmull-Clark's, as in OpenSubdiv: no tangent plane from four faces between sharp edges on
    Cc,
    /// Least energy: tangent plane and bounded curvature, for up to 12 faces
    Fair,
}

/// The rules at the boundary by their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Boundary {
    /// Faces that touch the boundary have no surface
    None,
    /// The boundary is a smooth curve, also at vertices of a single face
    EdgeOnly,
    /// The boundary is a smooth curve through the vertices of a single face
    EdgeAndCorner,
}

impl BoundaryArg {
    /// The rule at the boundary in the library's terms.
    fn rule(self) -> Option<BoundaryRule> {
        self.boundary.map(|boundary| match boundary {
            Boundary::None => BoundaryRule::None,
            Boundary::EdgeOnly => BoundaryRule::EdgeOnly,
            Boundary::EdgeAndCorner => BoundaryRule::EdgeAndCorner,
        })
    }

    /// The options with what happens at boundaries and creases.
    pub fn applied_to(self, options: SurfaceOptions) -> SurfaceOptions {
        let creases = match self.creases {
            Creases::Cc => CreaseRings::CatmullClark,
            Creases::Fair => CreaseRings::Fair,
        };
        SurfaceOptions { boundary: self.rule(), creases, ..options }
    }
}

/// Which rules the scheme takes.
#[derive(Args, Clone, Copy, Debug)]
pub struct RulesArg {
    /// Tables of weights of the scheme (`cc` is a formula and has none)
    #[arg(long, value_enum, default_value_t = Rules::Generated)]
    pub rules: Rules,

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
            rules: self.rules.into(),
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

/// Reads the short name of a scheme.
pub fn scheme_parser() -> impl TypedValueParser<Value = SchemeKind> {
    let values = SchemeKind::ALL.map(|s| PossibleValue::new(s.name()).help(about_scheme(s)));
    PossibleValuesParser::new(values).map(|name| {
        let scheme = SchemeKind::ALL.into_iter().find(|scheme| scheme.name() == name);
        scheme.expect("the name is one of the possible values")
    })
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
    }
}

/// The tables by their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rules {
    /// As the papers print them.
    Published,
    /// At full precision.
    Generated,
}

impl ValueEnum for Rules {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Published, Self::Generated]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, about) = match self {
            Self::Published => ("published", "Five digits, as the papers print them"),
            Self::Generated => ("generated", "Full precision"),
        };
        let help = format!("{about}; valences {}", valences((*self).into()));
        Some(PossibleValue::new(name).help(help))
    }
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

impl From<Rules> for RuleSet {
    fn from(rules: Rules) -> Self {
        match rules {
            Rules::Published => Self::Published,
            Rules::Generated => Self::Generated,
        }
    }
}

/// The name of the tables on the command line and in files; `None` for a scheme without.
pub fn rules_name(options: SurfaceOptions) -> Option<&'static str> {
    match (options.scheme, options.rules) {
        (SchemeKind::CatmullClark, _) => None,
        (_, RuleSet::Published) => Some("published"),
        (_, RuleSet::Generated) => Some("generated"),
    }
}

/// Two numbers with `separator` between them, as in `1200x900` or `-30,20`.
pub fn parse_pair<T: std::str::FromStr>(text: &str, separator: char) -> Result<[T; 2], String> {
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

fn number<T: std::str::FromStr>(text: &str) -> Option<T> {
    text.trim().parse().ok()
}
