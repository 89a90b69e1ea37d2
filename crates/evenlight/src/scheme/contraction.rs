//! How fast the rings of a scheme contract.
//!
//! Catmull-Clark subdivision inserts a knot half way between the extraordinary point and the first
//! knot line. Its rings shrink by an eigenvalue lambda that grows with the valence, from .41 at
//! valence 3 to .65. If the knot is at sigma instead, lambda can be chosen [KP18-Guided, sec. 6.3].
//! Then lambda is the larger root of
//!
//! ```text
//!   lambda^2 - sigma (1 + sigma^2 + c (1 - sigma)^2) lambda + sigma^4 = 0,   c = cos(2 pi / n).
//! ```
//!
//! Ring l of a sector then covers sigma^(l+1) < max(a,b) <= sigma^l.

use std::fmt;
use std::str::FromStr;

use super::{RuleSet, SchemeKind};

/// How fast rings contract. Guided schemes can have any contraction; the others have the
/// contraction of Catmull-Clark subdivision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Contraction {
    /// The subdominant eigenvalue of Catmull-Clark subdivision; rings halve the parameters.
    #[default]
    CatmullClark,
    /// 1/2 at every valence.
    Half,
    /// Any lambda between [`Contraction::LIMITS`], at every valence.
    Lambda(f64),
}

impl Contraction {
    /// The limits between which lambda can be chosen, both excluded.
    pub const LIMITS: [f64; 2] = [0.3, 0.7];

    /// The chosen lambda; `None` for Catmull-Clark's contraction, where lambda depends on the
    /// valence.
    pub fn lambda(self) -> Option<f64> {
        match self {
            Self::CatmullClark => None,
            Self::Half => Some(0.5),
            Self::Lambda(lambda) => Some(lambda),
        }
    }

    /// This contraction, if its lambda is between the limits.
    fn checked(self) -> Result<Self, ContractionError> {
        let [low, high] = Self::LIMITS;
        match self {
            Self::Lambda(lambda) if !(low < lambda && lambda < high) => {
                Err(ContractionError::OutOfRange { lambda })
            }
            _ => Ok(self),
        }
    }
}

/// As on the command line: cc, half or the number.
impl fmt::Display for Contraction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CatmullClark => f.write_str("cc"),
            Self::Half => f.write_str("half"),
            Self::Lambda(lambda) => write!(f, "{lambda}"),
        }
    }
}

impl FromStr for Contraction {
    type Err = ContractionError;

    /// Reads what [`fmt::Display`] writes, and checks the limits.
    fn from_str(text: &str) -> Result<Self, ContractionError> {
        let contraction = match text {
            "cc" => Self::CatmullClark,
            "half" => Self::Half,
            _ => Self::Lambda(text.parse().map_err(|_| ContractionError::Unknown)?),
        };
        contraction.checked()
    }
}

/// Which rules of a scheme are taken: tables and contraction. Most functions also take one of the
/// two alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variant {
    /// The tables of weights.
    pub rules: RuleSet,
    /// The contraction of the rings.
    pub contraction: Contraction,
}

impl From<RuleSet> for Variant {
    fn from(rules: RuleSet) -> Self {
        Self { rules, ..Self::default() }
    }
}

impl From<Contraction> for Variant {
    fn from(contraction: Contraction) -> Self {
        Self { contraction, ..Self::default() }
    }
}

/// Why a scheme does not have a contraction.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ContractionError {
    /// lambda is not between [`Contraction::LIMITS`].
    #[error(
        "rings can contract by a factor between {} and {}, not by {lambda}",
        Contraction::LIMITS[0],
        Contraction::LIMITS[1]
    )]
    OutOfRange {
        /// The lambda that was asked for.
        lambda: f64,
    },
    /// A text that names no contraction.
    #[error("a contraction is 'cc', 'half' or a number")]
    Unknown,
    /// Only guided schemes have contractions other than Catmull-Clark's.
    #[error(
        "scheme {} contracts like Catmull-Clark subdivision (cc) only; \
         the schemes guided3 to guided6 can have other contractions",
        scheme.name()
    )]
    Fixed {
        /// The scheme.
        scheme: SchemeKind,
    },
    /// The rules must be derived, but the library was built without the feature `derive`.
    #[error(
        "contractions other than that of Catmull-Clark subdivision (cc) are derived at run time, \
         for which this program was built without the feature `derive`"
    )]
    NotDerivable,
}

impl SchemeKind {
    /// Whether the scheme has this contraction at some valence.
    ///
    /// # Errors
    ///
    /// If lambda is out of range, if the scheme has one contraction only, or if the library was
    /// built without the feature `derive`.
    pub fn check_contraction(self, contraction: Contraction) -> Result<(), ContractionError> {
        if contraction.checked()? == Contraction::CatmullClark {
            return Ok(());
        }
        if self.guided_degree().is_none() {
            return Err(ContractionError::Fixed { scheme: self });
        }
        if !cfg!(feature = "derive") {
            return Err(ContractionError::NotDerivable);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contractions_are_between_the_limits_and_for_guided_schemes() {
        let check = |scheme: SchemeKind, x| scheme.check_contraction(Contraction::Lambda(x));
        for scheme in SchemeKind::ALL {
            assert_eq!(scheme.check_contraction(Contraction::CatmullClark), Ok(()));
            for lambda in [0.3, 0.7, 0.0, -0.5, f64::INFINITY] {
                assert_eq!(
                    check(scheme, lambda),
                    Err(ContractionError::OutOfRange { lambda }),
                    "the ends are excluded"
                );
            }
            assert!(check(scheme, f64::NAN).is_err());
            let is_guided = scheme.guided_degree().is_some();
            assert_eq!(check(scheme, 0.31).is_ok(), is_guided && cfg!(feature = "derive"));
        }
        for text in ["cc", "half", "0.45"] {
            assert_eq!(text.parse::<Contraction>().map(|c| c.to_string()), Ok(text.to_owned()));
        }
        assert_eq!("slow".parse::<Contraction>(), Err(ContractionError::Unknown));
        assert!("0.8".parse::<Contraction>().is_err());
        let message = check(SchemeKind::Qas4, 0.5).unwrap_err().to_string();
        assert!(message.contains("qas4") && message.contains("guided3 to guided6"), "{message}");
    }
}
