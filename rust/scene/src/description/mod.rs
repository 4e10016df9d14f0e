//! A scene as data: the keys of SCENE.toml, typed and checked.
//!
//! The same keys come as TOML (files) and as JSON (from Blender). Either becomes a tree, overrides change the tree, and only
//! then it is typed, so that every refusal can name the key and the value that stands there. Keys that later versions will
//! take are known and refused by name; nothing is ignored.

mod choice;
mod cloth;
mod collider;
mod collision;
mod fabric;
mod field;
mod flow;
mod force;
mod pins;
mod shape;
mod solver;
mod springs;
mod table;
mod tree;

pub(crate) use choice::Choice;
pub use choice::{Later, LaterKeys, NotYet, TearKeys};
pub use cloth::{ClothDescription, Grid, Model, Plane, Transform, UpAxis};
pub use collider::{Capsule, ColliderDescription, Cuboid, HalfSpace, Sphere};
pub use collision::{ClothCollision, CollisionDescription};
pub use fabric::{FabricDescription, WarpDescription};
pub use field::FalloffDescription;
pub use flow::{ClothWater, GustsDescription, TurbulenceDescription, WaveDescription};
pub use force::{FieldWord, Force, ForceKind, RegionDescription};
pub use pins::{Keyframe, PinGroup, Pins};
pub use shape::{PressureDescription, PressureKeyframe, SewingDescription, Shrink, ShrinkKeyframe};
pub use solver::{SolverDescription, Substeps};
pub use springs::Springs;
pub(crate) use tree::joined;

use boucle_solver::Field;
use serde::{Deserialize, Serialize};
use toml::Value;

use crate::error::{Error, Result};
use crate::limits;
use crate::overrides;

/// A whole scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// `[scene]`: frames, frame rate, gravity.
    #[serde(default, deserialize_with = "table::one")]
    pub scene: Timing,
    /// `[[cloth]]`: at least one.
    #[serde(default, deserialize_with = "table::list")]
    pub cloth: Vec<ClothDescription>,
    /// `[solver]`.
    #[serde(default, deserialize_with = "table::one")]
    pub solver: SolverDescription,
    /// `[[force]]`.
    #[serde(default, deserialize_with = "table::list")]
    pub force: Vec<Force>,
    /// `[collision]`.
    #[serde(default, deserialize_with = "table::one")]
    pub collision: CollisionDescription,
    /// `[[collider]]`.
    #[serde(default, deserialize_with = "table::list")]
    pub collider: Vec<ColliderDescription>,
    /// `[tear]`, for later.
    pub tear: Option<Later<TearKeys>>,
}

/// Force fields out of a JSON list of tables with the keys of `[[force]]`: what a scene changes from frame to frame.
///
/// # Errors
/// [`Error::Input`] for the first thing that is wrong, and for a force that is no field.
pub fn fields_from_json(text: &str) -> Result<Vec<Field>> {
    let json: serde_json::Value = serde_json::from_str(text)
        .map_err(|error| Error::input(format!("the fields are not JSON: {error}")))?;
    let mut tree = toml::Table::new();
    tree.insert("force".to_owned(), tree_of_json("force", &json)?);
    let table::Table(Forces { force }) = tree::typed(&Value::Table(tree))?;
    let fields = force.iter().enumerate().map(|(index, force)| {
        let at = format!("force.{index}");
        force.check(&at, &[])?;
        force.field(&at)?.ok_or_else(|| {
            let kind = force.kind.word();
            let kept = "is no field, and a scene keeps it; accepted: fields";
            Error::input(format!("{at}.kind = \"{kind}\" {kept}"))
        })
    });
    fields.collect()
}

/// The forces of a scene alone.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Forces {
    #[serde(deserialize_with = "table::list")]
    force: Vec<Force>,
}

/// `[scene]`: when, and under which gravity.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Timing {
    /// First and last frame, both included; the first is the rest pose.
    pub frames: [i32; 2],
    /// Frames a second.
    pub fps: f64,
    /// Acceleration of gravity (m/s²).
    pub gravity: [f64; 3],
}

impl Default for Timing {
    fn default() -> Self {
        Self { frames: [1, 120], fps: 24.0, gravity: [0.0, 0.0, -9.81] }
    }
}

impl Scene {
    /// Reads a scene from TOML text, changed by overrides (`key.path=value`, in their order).
    ///
    /// # Errors
    /// [`Error::Input`] for the first thing that is wrong.
    pub fn from_toml(text: &str, overrides: &[String]) -> Result<Self> {
        let table: toml::Table = text.parse().map_err(|error| syntax(text, &error))?;
        let mut tree = Value::Table(table);
        for text in overrides {
            overrides::apply(&mut tree, text)?;
        }
        Self::from_tree(&tree)
    }

    /// Reads a scene from JSON text with the same keys; null stands for a missing key.
    ///
    /// # Errors
    /// [`Error::Input`] for the first thing that is wrong.
    pub fn from_json(text: &str) -> Result<Self> {
        let json: serde_json::Value = serde_json::from_str(text)
            .map_err(|error| Error::input(format!("the scene is not JSON: {error}")))?;
        Self::from_tree(&tree_of_json("", &json)?)
    }

    fn from_tree(tree: &Value) -> Result<Self> {
        let table::Table(scene): table::Table<Self> = tree::typed(tree)?;
        scene.check()?;
        Ok(scene)
    }

    /// Refuses values outside their ranges and keys that exclude each other.
    fn check(&self) -> Result<()> {
        self.scene.check()?;
        if self.cloth.is_empty() {
            return Err(Error::input("cloth is missing; accepted: one [[cloth]] or more"));
        }
        self.collision.check()?;
        let colliders =
            self.collider.iter().map(|collider| collider.name.as_str()).collect::<Vec<_>>();
        check_names("collider", &colliders, |name| (*name).to_owned(), "")?;
        for collider in &self.collider {
            collider.check(&format!("collider.{}", collider.name))?;
        }
        let cloths = self.cloth.iter().map(|cloth| cloth.name.as_str()).collect::<Vec<_>>();
        // Some systems take file names that differ by case alone for one.
        check_names("cloth", &cloths, |name| name.to_lowercase(), ", whatever its case")?;
        for cloth in &self.cloth {
            let at = format!("cloth.{}", cloth.name);
            cloth.check(&at)?;
            cloth.collision.check(&format!("{at}.collision"), &colliders, &cloths)?;
        }
        self.solver.check(self.scene.fps)?;
        for (index, force) in self.force.iter().enumerate() {
            force.check(&format!("force.{index}"), &cloths)?;
        }
        let mut waters = (0..).zip(&self.force).filter(|(_, force)| force.kind == ForceKind::Water);
        if let (Some(_), Some((index, _))) = (waters.next(), waters.next()) {
            let reason = "kind = \"water\" is the scene's second; accepted: one water";
            return Err(Error::input(format!("force.{index}.{reason}")));
        }
        Ok(())
    }
}

/// Refuses a name that stands twice in a list, as `folded` sees it.
fn check_names(list: &str, names: &[&str], folded: fn(&&str) -> String, how: &str) -> Result<()> {
    for (index, name) in names.iter().enumerate() {
        if names[..index].iter().any(|other| folded(other) == folded(name)) {
            let accepted = format!("a name that no other {list} has{how}");
            let key = format!("{list}.{index}.name");
            return Err(Error::refuse(&key, format!("\"{name}\""), &accepted));
        }
    }
    Ok(())
}

/// Refuses a name that is not among those of a kind of thing.
fn check_known(key: &str, name: &str, known: &[&str], kind: &str) -> Result<()> {
    if known.contains(&name) {
        return Ok(());
    }
    let known: Vec<String> = known.iter().map(|name| format!("\"{name}\"")).collect();
    let accepted = match known.as_slice() {
        [] => format!("names of {kind}, of which the scene has none"),
        known => known.join(", "),
    };
    Err(Error::refuse(key, format!("\"{name}\""), &accepted))
}

impl Timing {
    fn check(&self) -> Result<()> {
        let [first, last] = self.frames;
        limits::frame("scene.frames.0", first)?;
        limits::frame("scene.frames.1", last)?;
        if first > last {
            let shown = format!("[{first}, {last}]");
            return Err(Error::refuse("scene.frames", shown, "the first frame before the last"));
        }
        limits::within("scene.fps", self.fps, &(0.01..=1e6), "0.01 to 1e6 frames/s")?;
        limits::vector("scene.gravity", &self.gravity, limits::MAX_GRAVITY, " m/s²")
    }
}

/// A syntax error of TOML in one line, with where it is.
fn syntax(text: &str, error: &toml::de::Error) -> Error {
    let start = error.span().map_or(0, |span| span.start.min(text.len()));
    let before = text.get(..start).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|&letter| letter != '\n').count() + 1;
    let message = error.message().lines().collect::<Vec<_>>().join("; ");
    Error::input(format!("line {line}, column {column}: {message}; accepted: TOML"))
}

/// A JSON value as a tree; null is left out of tables.
fn tree_of_json(key: &str, json: &serde_json::Value) -> Result<Value> {
    use serde_json::Value as Json;
    Ok(match json {
        Json::Null => return Err(Error::refuse(key, "null", "a value")),
        Json::Bool(flag) => Value::Boolean(*flag),
        Json::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(whole), _) => Value::Integer(whole),
            (None, Some(real)) => Value::Float(real),
            (None, None) => return Err(Error::refuse(key, number, "a number")),
        },
        Json::String(text) => Value::String(text.clone()),
        Json::Array(list) => {
            let elements = list.iter().enumerate();
            let tree = |(index, value)| tree_of_json(&joined(key, &format!("{index}")), value);
            Value::Array(elements.map(tree).collect::<Result<_>>()?)
        }
        Json::Object(table) => {
            let entries = table.iter().filter(|(_, value)| !value.is_null());
            let tree = |(name, value): (&String, _)| {
                Ok((name.clone(), tree_of_json(&joined(key, name), value)?))
            };
            Value::Table(entries.map(tree).collect::<Result<_>>()?)
        }
    })
}

#[cfg(test)]
mod flow_tests;
#[cfg(test)]
mod tests;
