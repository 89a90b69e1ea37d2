//! How a run can fail, and the exit code that says so.
//!
//! ```text
//! 0  good          1  the input cannot be used, or the output not be written
//!                  2  wrong usage
//! ```

use std::fmt::Display;
use std::io;
use std::process::ExitCode;

/// Why a run ended early.
#[derive(Debug)]
pub enum Failure {
    /// The command line asks for something that does not exist: exit code 2.
    Usage(String),
    /// The input cannot be used, or a file not be read or written: exit code 1.
    Unusable(String),
    /// The reader of our standard output has gone, as in `evenlight ... | head`: nothing is
    /// wrong, exit code 0.
    ReaderGone,
}

impl Failure {
    /// The failure of reading or writing `place`.
    pub fn io(place: impl Display, error: &io::Error) -> Self {
        Self::Unusable(format!("{place}: {error}"))
    }

    /// Says on stderr what is wrong; the exit code.
    pub fn report(&self) -> ExitCode {
        match self {
            Self::Usage(message) => {
                let message = printable(message);
                eprintln!("error: {message}\n\nFor more information, try '--help'.");
                ExitCode::from(2)
            }
            Self::Unusable(message) => {
                eprintln!("error: {}", printable(message));
                ExitCode::from(1)
            }
            Self::ReaderGone => ExitCode::SUCCESS,
        }
    }
}

/// Says on stderr something that the user should know though the run goes on.
pub fn warn(message: impl Display) {
    eprintln!("warning: {}", printable(&message.to_string()));
}

/// `text` with its control characters spelled out, but for the ends of lines: what comes from a
/// file must not steer the terminal.
fn printable(text: &str) -> String {
    let steers = |c: char| c.is_control() && c != '\n';
    let spelled = |c: char| if steers(c) { c.escape_default().to_string() } else { c.to_string() };
    text.chars().map(spelled).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_spelled_out() {
        assert_eq!(printable("a\x1b[2J\r\tb\u{9b}"), "a\\u{1b}[2J\\r\\tb\\u{9b}");
        let harmless = "kubus \u{e9}, `\u{fffd}` \"x\" \\ \u{1f9ca}\nnext line";
        assert_eq!(printable(harmless), harmless);
    }
}
