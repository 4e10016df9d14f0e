//! Overrides: `key.path=value`, applied to the tree of keys before it is typed.
//!
//! The path is a TOML dotted key; elements of lists are called by index or by their `name` (`cloth.0.density`,
//! `cloth.curtain.density`). The value is TOML; a bare word (`rk4`) is taken as text. Tables on the way are made where they
//! are missing, list elements are not. Where a key has an alternative (density or mass per vertex), setting one takes the
//! other out.

use toml::{Table, Value};

use crate::error::{Error, Result, shorten};

/// Keys of one table that exclude each other.
const ALTERNATIVES: &[[&str; 2]] = &[
    ["density", "mass_per_vertex"],
    ["grid", "mesh"],
    ["substeps", "time_step"],
    ["coefficient", "air_density"],
];

/// Applies one override to a tree.
///
/// # Errors
/// [`Error::Input`] when the text is no `key.path=value` or names a list element that is not there.
pub(crate) fn apply(tree: &mut Value, text: &str) -> Result<()> {
    let refuse = |reason: &str| {
        let accepted = "accepted: key.path=value with a TOML value";
        Error::input(format!("--set {}: {reason}; {accepted}", shorten(text)))
    };
    let (key, value) = text.split_once('=').ok_or_else(|| refuse("there is no \"=\""))?;
    let path = parse_key(key).ok_or_else(|| refuse("the key cannot be read"))?;
    let value = parse_value(value).ok_or_else(|| refuse("the value cannot be read"))?;
    let mut place = tree;
    for (depth, step) in path.iter().enumerate() {
        let is_last = depth + 1 == path.len();
        place = child(place, step, is_last).map_err(|reason| refuse(&reason))?;
    }
    *place = value;
    Ok(())
}

/// The steps of a dotted key, as TOML reads it.
fn parse_key(key: &str) -> Option<Vec<String>> {
    if key.contains(['\n', '\r', '#']) {
        return None;
    }
    let mut value = Value::Table(format!("{key} = 0").parse::<Table>().ok()?);
    let mut path = Vec::new();
    while let Value::Table(table) = value {
        let (step, next) = table.into_iter().next()?;
        path.push(step);
        value = next;
    }
    Some(path)
}

/// A TOML value, or a bare word as text.
fn parse_value(text: &str) -> Option<Value> {
    let text = text.trim();
    if let Ok(mut table) = format!("value = {text}").parse::<Table>()
        && table.len() == 1
    {
        return table.remove("value");
    }
    let is_word = text.starts_with(|first: char| first.is_ascii_alphabetic())
        && text.chars().all(|letter| letter.is_ascii_alphanumeric() || "_-./".contains(letter));
    is_word.then(|| Value::String(text.to_owned()))
}

/// The value below `place` that a step leads to, made if a table lacks it.
fn child<'a>(
    place: &'a mut Value,
    step: &str,
    is_last: bool,
) -> std::result::Result<&'a mut Value, String> {
    match place {
        Value::Table(table) => {
            if is_last {
                remove_alternatives(table, step);
            }
            Ok(table.entry(step).or_insert_with(|| Value::Table(Table::new())))
        }
        Value::Array(list) => {
            let index = step.parse().ok().filter(|&index: &usize| index < list.len());
            let named = || {
                list.iter()
                    .position(|element| element.get("name").and_then(Value::as_str) == Some(step))
            };
            let count = list.len();
            index
                .or_else(named)
                .map(|index| &mut list[index])
                .ok_or_else(|| format!("the list of {count} has no element \"{}\"", shorten(step)))
        }
        _ => Err(format!("\"{}\" would stand below a value", shorten(step))),
    }
}

fn remove_alternatives(table: &mut Table, key: &str) {
    for [one, other] in ALTERNATIVES {
        if key == *one {
            table.remove(*other);
        } else if key == *other {
            table.remove(*one);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree() -> Value {
        let text = "[[cloth]]\nname = \"flag\"\ndensity = 0.2\n[[cloth]]\nname = \"a.b\"\n";
        Value::Table(text.parse().expect("good TOML"))
    }

    fn applied(text: &str) -> Value {
        let mut tree = tree();
        apply(&mut tree, text).expect("a good override");
        tree
    }

    #[test]
    fn a_list_element_is_found_by_index_and_by_name() {
        for text in ["cloth.0.density=0.5", "cloth.flag.density = 0.5"] {
            assert_eq!(applied(text)["cloth"][0]["density"].as_float(), Some(0.5), "{text}");
        }
        let quoted = applied("cloth.\"a.b\".density=3");
        assert_eq!(quoted["cloth"][1]["density"].as_integer(), Some(3));
    }

    #[test]
    fn missing_tables_are_made_on_the_way() {
        let tree = applied("solver.substeps=20");
        assert_eq!(tree["solver"]["substeps"].as_integer(), Some(20));
    }

    #[test]
    fn a_bare_word_is_text() {
        assert_eq!(applied("solver.integrator=rk4")["solver"]["integrator"].as_str(), Some("rk4"));
        assert_eq!(applied("a=\"rk4\"")["a"].as_str(), Some("rk4"));
        assert_eq!(applied("a=true")["a"].as_bool(), Some(true));
        assert_eq!(applied("a=[1, 2]")["a"].as_array().map(Vec::len), Some(2));
    }

    #[test]
    fn setting_one_of_two_alternatives_takes_the_other_out() {
        let tree = applied("cloth.0.mass_per_vertex=0.1");
        assert!(tree["cloth"][0].get("density").is_none());
    }

    #[test]
    fn what_is_no_override_is_refused_in_one_line() {
        for text in [
            "",
            "density",
            "=3",
            "a b=3",
            "cloth.2.density=1",
            "cloth.sail.density=1",
            "cloth.0.density.x=1",
            "a=1\nb=2",
            "a=[1",
            "a.=1",
            "a=",
            "a\n=1",
        ] {
            let error = apply(&mut tree(), text).expect_err(text).to_string();
            assert!(error.starts_with("--set "), "{error}");
            assert!(!error.contains('\n'), "{error}");
        }
    }
}
