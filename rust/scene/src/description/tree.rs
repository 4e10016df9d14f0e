//! From a tree of keys and values to typed data, with refusals that name the key and the value in one line.

use serde::de::DeserializeOwned;
use serde_path_to_error::{Path, Segment};
use toml::Value;

use super::choice::nearest;
use crate::error::{Error, Result, shorten};

/// Types a tree.
///
/// # Errors
/// [`Error::Input`] for the first key that is unknown, missing or holds what it cannot.
pub(crate) fn typed<T: DeserializeOwned>(tree: &Value) -> Result<T> {
    serde_path_to_error::deserialize(tree.clone())
        .map_err(|error| explain(tree, error.path(), error.inner().message()))
}

/// One line from where typing stopped and what serde says about it.
fn explain(tree: &Value, path: &Path, message: &str) -> Error {
    let (mut key, value) = locate(tree, path);
    if let Some(name) = quoted_after(message, "unknown field `") {
        return unknown_key(&mut key, name, message);
    }
    if let Some(name) = quoted_after(message, "missing field `") {
        return Error::input(format!("{} is missing", joined(&key, name)));
    }
    let key = if key.is_empty() { "the scene".to_owned() } else { key };
    if message.starts_with("is ") {
        return Error::input(format!("{key} {message}"));
    }
    let shown = value.map(|value| shorten(&value.to_string())).unwrap_or_default();
    if message.starts_with("; ") || message.starts_with(" is ") {
        return Error::input(format!("{key} = {shown}{message}"));
    }
    match message.rsplit_once("expected ") {
        Some((_, expected)) => Error::refuse(&key, shown, &plain(expected)),
        None => Error::input(format!("{key} = {shown}: {message}")),
    }
}

/// The refusal of a key that nobody knows, with the key that was perhaps meant.
fn unknown_key(key: &mut String, name: &str, message: &str) -> Error {
    let listed = message.split_once(", expected ").map_or("", |(_, names)| names);
    let names: Vec<&str> = listed.split('`').skip(1).step_by(2).collect();
    if *key != name && !key.ends_with(&format!(".{name}")) {
        *key = joined(key, name);
    }
    let accepted = match nearest(name, names.iter().copied()) {
        Some(meant) => format!("did you mean \"{meant}\"?"),
        None => format!("accepted: {}", names.join(", ")),
    };
    Error::input(format!("{key} is an unknown key; {accepted}"))
}

/// The text between a prefix and the next backquote.
fn quoted_after<'a>(message: &'a str, prefix: &str) -> Option<&'a str> {
    message.strip_prefix(prefix)?.split_once('`').map(|(name, _)| name)
}

/// A key below another.
pub(crate) fn joined(parent: &str, key: &str) -> String {
    if parent.is_empty() { key.to_owned() } else { format!("{parent}.{key}") }
}

/// The dotted key of a path, list elements by their name where they have one, and the value there.
fn locate<'a>(tree: &'a Value, path: &Path) -> (String, Option<&'a Value>) {
    let mut key = String::new();
    let mut place = Some(tree);
    for segment in path {
        let step = match segment {
            Segment::Seq { index } => {
                place = place.and_then(|value| value.get(*index));
                element_name(place, *index)
            }
            Segment::Map { key } => {
                place = place.and_then(|value| value.get(key.as_str()));
                key.clone()
            }
            Segment::Enum { .. } | Segment::Unknown => continue,
        };
        key = joined(&key, &step);
    }
    (key, place)
}

/// How an element of a list is called: by its name, else by its index.
fn element_name(element: Option<&Value>, index: usize) -> String {
    let name = element.and_then(|value| value.get("name")).and_then(Value::as_str);
    match name {
        Some(name) if !name.is_empty() => shorten(name),
        _ => index.to_string(),
    }
}

/// Serde's words for what it expected, in the user's.
fn plain(expected: &str) -> String {
    let words = match expected {
        "f64" => "a number",
        "i32" | "i64" => "a whole number",
        "u32" | "u64" | "usize" => "a whole number from 0",
        "a sequence" => "a list",
        "an array of length 2" => "2 numbers",
        "an array of length 3" => "3 numbers",
        "a boolean" => "true or false",
        "a string" => "text in quotes",
        other => other,
    };
    words.to_owned()
}
