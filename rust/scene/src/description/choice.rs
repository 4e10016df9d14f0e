//! Words to choose from, and keys of the format that are not supported yet.
//!
//! Both tell their refusal to [`tree`](super::tree) in its own short form: a message that begins with `; ` or ` is` stands
//! behind `KEY = VALUE`, one that begins with `is` behind `KEY` alone.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};

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

/// A key of the format that is not supported yet: whatever it holds is refused, by name.
#[derive(Clone, Debug, PartialEq)]
pub enum NotYet {}

impl<'de> Deserialize<'de> for NotYet {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(D::Error::custom("is not supported yet"))
    }
}

impl Serialize for NotYet {
    fn serialize<S: Serializer>(&self, _: S) -> Result<S::Ok, S::Error> {
        match *self {}
    }
}

/// The keys of a table (or of a list of tables) that is not supported yet.
pub trait LaterKeys {
    /// Every key of the table.
    const KEYS: &'static [&'static str];
}

/// A table that is not supported yet: its first key is refused, by name, and unknown keys as such.
#[derive(Clone, Debug, PartialEq)]
pub struct Later<K>(NotYet, PhantomData<K>);

impl<K> Serialize for Later<K> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de, K: LaterKeys> Deserialize<'de> for Later<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(LaterVisitor(PhantomData))
    }
}

struct LaterVisitor<K>(PhantomData<K>);

impl<'de, K: LaterKeys> Visitor<'de> for LaterVisitor<K> {
    type Value = Later<K>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let Some(key) = map.next_key::<String>()? else {
            return Err(A::Error::custom("is not supported yet"));
        };
        if !K::KEYS.contains(&key.as_str()) {
            return Err(A::Error::unknown_field(&key, K::KEYS));
        }
        Ok(Later(map.next_value()?, PhantomData))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        if let Some(later) = list.next_element()? {
            return Ok(later);
        }
        while list.next_element::<IgnoredAny>()?.is_some() {}
        Err(A::Error::custom("is not supported yet"))
    }
}

/// Makes a marker type that lists the keys of a table for later.
macro_rules! later_table {
    ($($(#[$doc:meta])* $name:ident { $($key:literal),+ $(,)? })+) => {$(
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        pub enum $name {}

        impl LaterKeys for $name {
            const KEYS: &'static [&'static str] = &[$($key),+];
        }
    )+};
}

later_table! {
    /// `[tear]`.
    TearKeys { "enabled", "force", "strain" }
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
