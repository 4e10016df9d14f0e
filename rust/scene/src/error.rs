//! Every refusal of this crate: one line each, and the exit code that a bake ends with.

use std::fmt;
use std::path::Path;

/// What this crate's functions return.
pub type Result<T> = std::result::Result<T, Error>;

/// A refusal, told in one line.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The input is wrong: file, key, value, what is accepted.
    Input(String),
    /// A position left the finite numbers; the frames before it are kept.
    Diverged {
        /// The frame that could not be reached.
        frame: i32,
        /// The first such vertex, in its cloth's numbering.
        vertex: usize,
        /// The cloth's name.
        cloth: String,
    },
    /// From here on the settings would not stay stable; the frames before it are kept.
    Unstable {
        /// The frame that could not be simulated.
        frame: i32,
        /// Why, and what would be accepted.
        reason: String,
    },
    /// A frame was stopped from outside; the frames before it are kept.
    Interrupted {
        /// The frame that was not reached.
        frame: i32,
    },
    /// A result cannot be written or read; the frames before it are kept.
    Cache(String),
}

impl Error {
    /// A refusal of a value: the key it stands at, the value, what would be accepted.
    pub(crate) fn refuse(key: &str, value: impl fmt::Display, accepted: &str) -> Self {
        Self::Input(format!("{key} = {}; accepted: {accepted}", shorten(&value.to_string())))
    }

    /// A refusal in free words.
    pub(crate) fn input(message: impl fmt::Display) -> Self {
        Self::Input(message.to_string())
    }

    /// A file of the result that cannot be written or read.
    pub(crate) fn cache(path: &Path, action: &str, error: &std::io::Error) -> Self {
        let cure = if action == "read" {
            "accepted: the file as the bake left it, or a bake without --resume"
        } else {
            "free disk space or allow writing there, then --resume goes on"
        };
        Self::Cache(format!("{} cannot be {action}: {error}; {cure}", path.display()))
    }

    /// The same refusal with the name of the input it was found in before it.
    #[must_use]
    pub(crate) fn within(self, place: &str) -> Self {
        match self {
            Self::Input(message) => Self::Input(format!("{place}: {message}")),
            other => other,
        }
    }

    /// The exit code of a bake that ends so: 2 wrong input, 3 diverged or about to, 4 cache, 130 stopped.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::Diverged { .. } | Self::Unstable { .. } => 3,
            Self::Cache(_) => 4,
            Self::Interrupted { .. } => 130,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(message) | Self::Cache(message) => f.write_str(&one_line(message)),
            Self::Diverged { frame, vertex, cloth } => f.write_str(&one_line(&format!(
                "diverged at frame {frame}, vertex {vertex} of cloth \"{cloth}\""
            ))),
            Self::Interrupted { frame } => write!(f, "frame {frame} was interrupted"),
            Self::Unstable { frame, reason } => {
                f.write_str(&one_line(&format!("frame {frame} cannot be simulated: {reason}")))
            }
        }
    }
}

impl std::error::Error for Error {}

/// The solver's refusals: divergence keeps its place, all others are wrong input.
impl From<boucle_solver::Error> for Error {
    fn from(error: boucle_solver::Error) -> Self {
        match error {
            boucle_solver::Error::Diverged { frame, vertex, cloth } => {
                Self::Diverged { frame, vertex, cloth }
            }
            boucle_solver::Error::Interrupted { frame } => Self::Interrupted { frame },
            other => Self::Input(other.to_string()),
        }
    }
}

/// The text with control characters written as escapes, so that it stays on one line.
fn one_line(text: &str) -> String {
    text.chars().fold(String::with_capacity(text.len()), |mut line, letter| {
        if letter.is_control() || matches!(letter, '\u{2028}' | '\u{2029}') {
            line.extend(letter.escape_default());
        } else {
            line.push(letter);
        }
        line
    })
}

/// A value as an error shows it: at most 80 characters.
pub(crate) fn shorten(value: &str) -> String {
    const SHOWN: usize = 80;
    match value.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}...", &value[..end]),
        None => value.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_stays_on_one_line_whatever_it_quotes() {
        let error = Error::refuse("cloth.a\nb.name", "\"x\r\ny\u{2028}\"", "a name");
        assert!(!error.to_string().contains(['\n', '\r', '\u{2028}']));
    }

    #[test]
    fn a_long_value_is_cut() {
        let error = Error::refuse("cloth.0.name", "é".repeat(10_000), "a short name");
        assert!(error.to_string().len() < 300, "{error}");
    }

    #[test]
    fn divergence_keeps_its_place_and_its_exit_code() {
        let diverged = boucle_solver::Error::Diverged { frame: 7, vertex: 3, cloth: "flag".into() };
        let error = Error::from(diverged);
        assert_eq!(error.to_string(), "diverged at frame 7, vertex 3 of cloth \"flag\"");
        assert_eq!(error.exit_code(), 3);
    }
}
