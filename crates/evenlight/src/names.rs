//! The names of choices in commands and files. Each choice has one list of names; writing, reading
//! and the message about an unknown name follow from it.

use std::fmt;

/// A text that names none of the choices.
///
/// ```
/// use evenlight::SchemeKind;
///
/// assert_eq!("qas4".parse(), Ok(SchemeKind::Qas4));
/// assert_eq!(SchemeKind::Qas4.to_string(), "qas4");
///
/// let error = "qas5".parse::<SchemeKind>().unwrap_err();
/// assert!(error.to_string().starts_with("'qas5' is no scheme; it can be cc, eg, pas3, "));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownName {
    what: &'static str,
    given: String,
    names: &'static [&'static str],
}

impl UnknownName {
    pub(crate) fn new(what: &'static str, given: &str, names: &'static [&'static str]) -> Self {
        Self { what, given: given.to_owned(), names }
    }

    /// The names that are allowed.
    pub fn names(&self) -> &'static [&'static str] {
        self.names
    }
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, given, names } = self;
        write!(f, "'{given}' is no {what}; it can be {}", names.join(", "))
    }
}

impl std::error::Error for UnknownName {}

/// Gives an enum of choices without data its names, in the order in which they are listed to users:
/// `ALL`, `name`, `Display` and `FromStr`.
macro_rules! names {
    ($choice:ident, $what:literal: $($variant:ident => $name:literal),* $(,)?) => {
        impl $choice {
            /// All choices, in the order in which they are listed to users.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$variant),*];

            /// The short name used in commands and files.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }
        }

        /// The short name used in commands and files.
        impl std::fmt::Display for $choice {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $choice {
            type Err = $crate::UnknownName;

            fn from_str(text: &str) -> Result<Self, Self::Err> {
                let found = Self::ALL.into_iter().find(|choice| choice.name() == text);
                found.ok_or_else(|| $crate::UnknownName::new($what, text, &[$($name),*]))
            }
        }
    };
}
pub(crate) use names;
