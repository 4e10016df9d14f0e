//! Words to choose from.
//!
//! Both tell their refusal to [`tree`](super::tree) in its own short form: a message that begins with `; ` or ` is` stands
//! behind `KEY = VALUE`, one that begins with `is` behind `KEY` alone.

use serde::de::{Deserializer, Error};
use serde::{Deserialize, Serializer};

/// A word out of a fixed list, each standing for a value of `Self`.
pub(crate) trait Choice: Copy + PartialEq + 'static {
    /// The words that are taken, and what they mean.
    const WORDS: &'static [(&'static str, Self)];

    /// Reads the word.
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let word = String::deserialize(deserializer)?;
        match Self::WORDS.iter().find(|(name, _)| *name == word) {
            Some((_, choice)) => Ok(*choice),
            None => Err(D::Error::custom(format!("; {}", accepted::<Self>(&word)))),
        }
    }

    /// The word of this choice.
    fn word(self) -> &'static str {
        Self::WORDS.iter().find(|(_, choice)| *choice == self).map_or("", |(word, _)| word)
    }

    /// Writes the word.
    fn write<S: Serializer>(choice: &Self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(choice.word())
    }
}

/// The words that a choice takes, and the one that was perhaps meant.
fn accepted<C: Choice>(word: &str) -> String {
    let words: Vec<String> = C::WORDS.iter().map(|(name, _)| format!("\"{name}\"")).collect();
    let names = C::WORDS.iter().map(|(name, _)| *name);
    let hint = nearest(word, names).map(|name| format!(" (did you mean \"{name}\"?)"));
    format!("accepted: {}{}", words.join(", "), hint.unwrap_or_default())
}

/// The name nearest to what was written, if it is near at all: at most a third of its letters differ.
pub(crate) fn nearest<'a>(
    written: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let written = written.to_lowercase();
    names
        .into_iter()
        .map(|name| (strsim::damerau_levenshtein(&written, name), name))
        .filter(|(distance, name)| *distance <= name.len().div_ceil(3))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_near_names_are_suggested() {
        let names = ["density", "damping_stretch", "pins"];
        assert_eq!(nearest("densty", names), Some("density"));
        assert_eq!(nearest("Denisty", names), Some("density"));
        assert_eq!(nearest("dampening_stretch", names), Some("damping_stretch"));
        assert_eq!(nearest("colour", names), None);
    }
}
