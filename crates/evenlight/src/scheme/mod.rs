//! The schemes: rules per valence.

/// Which subdivision scheme makes the surface around extraordinary vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SchemeKind {
    /// Catmull-Clark subdivision: bi-3 rings, C1 at the centre, unbounded curvature there.
    CatmullClark,
    /// Evolving-Guide subdivision: bi-4 rings, C1 at the centre, no oscillation.
    EvolvingGuide,
}

impl SchemeKind {
    /// All schemes, in the order in which they are listed to users.
    pub const ALL: [Self; 2] = [Self::CatmullClark, Self::EvolvingGuide];

    /// The short name used in commands and files: `cc`, `eg`.
    pub fn name(self) -> &'static str {
        match self {
            Self::CatmullClark => "cc",
            Self::EvolvingGuide => "eg",
        }
    }
}

/// Which tables of weights are used (schemes with tables only).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RuleSet {
    /// Full precision, valences 3 and 5 to 16.
    #[default]
    Generated,
    /// As the paper prints them: truncated to 5 digits, valences 3 and 5 to 10.
    Published,
}
