//! `pins` of a cloth: which vertices, how they are moved, when they are let go.
//!
//! One table, or a list whose elements are names or tables:
//!
//! ```toml
//! pins = ["top_left", "top_right"]
//! pins = { vertices = [0, 5], release = 60 }
//! pins = { vertices = [0, 1, 2], weights = [1.0, 0.5, 0.1] }
//! pins = [ { names = ["top"], motion = [ { frame = 1 }, { frame = 60, location = [0, 0, 0.5] } ] }, "bottom" ]
//! ```

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::table;
use crate::error::{Error, Result};
use crate::limits;

/// All pins of a cloth.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Pins {
    /// The groups, in the order of the file; of a vertex in several, the last holds.
    pub groups: Vec<PinGroup>,
    /// Whether the file gives a list (its keys have an index) or one table.
    pub is_list: bool,
}

/// Pins that move and are let go together.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PinGroup {
    /// Corners and edges of a grid.
    pub names: Vec<String>,
    /// Vertex numbers, from 0.
    pub vertices: Vec<u32>,
    /// The middle (m) of a ball; every vertex that rests in it is pinned.
    pub near: Option<[f64; 3]>,
    /// The ball's radius (m).
    pub radius: Option<f64>,
    /// 1 holds the vertices exactly where they are to be (the default), less draws them there by goal springs, 0 lets go.
    pub weight: Option<f64>,
    /// A weight for each of `vertices`, in the place of one for all.
    pub weights: Vec<f64>,
    /// Where the pins go; nowhere if empty.
    #[serde(deserialize_with = "table::list")]
    pub motion: Vec<Keyframe>,
    /// The frame at whose end the pins let go.
    pub release: Option<i32>,
}

/// A rigid displacement from the rest shape, about the world's origin, at one frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keyframe {
    /// The frame.
    pub frame: i32,
    /// Displacement (m), after the rotation.
    #[serde(default)]
    pub location: [f64; 3],
    /// Angles (degrees) about the world's x, then y, then z axis.
    #[serde(default)]
    pub rotation_deg: [f64; 3],
}

impl Pins {
    /// The key of a group, below the key of the pins.
    #[must_use]
    pub(crate) fn key(&self, at: &str, group: usize) -> String {
        if self.is_list { format!("{at}.{group}") } else { at.to_owned() }
    }

    pub(super) fn check(&self, at: &str) -> Result<()> {
        for (index, group) in self.groups.iter().enumerate() {
            group.check(&self.key(at, index))?;
        }
        Ok(())
    }
}

impl PinGroup {
    fn check(&self, at: &str) -> Result<()> {
        let ways = [!self.names.is_empty(), !self.vertices.is_empty(), self.near.is_some()];
        if ways.iter().filter(|&&is_given| is_given).count() != 1 {
            let accepted = "one of names, vertices, or near with radius, not empty";
            return Err(Error::input(format!("{at} accepts {accepted}")));
        }
        match (self.near, self.radius) {
            (Some(near), Some(radius)) => {
                limits::vector(&format!("{at}.near"), &near, limits::MAX_LENGTH, " m")?;
                limits::above_zero(&format!("{at}.radius"), radius, limits::MAX_LENGTH, " m")?;
            }
            (Some(_), None) => return Err(Error::input(format!("{at}.radius is missing"))),
            (None, Some(_)) => return Err(Error::input(format!("{at}.near is missing"))),
            (None, None) => {}
        }
        if let Some(weight) = self.weight {
            limits::within(&format!("{at}.weight"), weight, &(0.0..=1.0), "0 to 1")?;
        }
        for (index, &weight) in self.weights.iter().enumerate() {
            limits::within(&format!("{at}.weights.{index}"), weight, &(0.0..=1.0), "0 to 1")?;
        }
        let (given, wanted) = (self.weights.len(), self.vertices.len());
        if given != 0 && (given != wanted || self.weight.is_some()) {
            let accepted = format!("{wanted}, one for each of vertices, and no weight beside them");
            return Err(Error::refuse(&format!("the length of {at}.weights"), given, &accepted));
        }
        if let Some(frame) = self.release {
            limits::frame(&format!("{at}.release"), frame)?;
        }
        check_motion(&format!("{at}.motion"), &self.motion)
    }
}

/// Refuses keyframes out of their ranges or their order.
pub(super) fn check_motion(at: &str, motion: &[Keyframe]) -> Result<()> {
    for (index, keyframe) in motion.iter().enumerate() {
        let at = format!("{at}.{index}");
        limits::frame(&format!("{at}.frame"), keyframe.frame)?;
        limits::vector(&format!("{at}.location"), &keyframe.location, limits::MAX_LENGTH, " m")?;
        limits::vector(&format!("{at}.rotation_deg"), &keyframe.rotation_deg, 1e6, " degrees")?;
    }
    match motion.windows(2).position(|pair| pair[0].frame >= pair[1].frame) {
        Some(index) => Err(Error::refuse(
            &format!("{at}.{}.frame", index + 1),
            motion[index + 1].frame,
            &format!("a frame after {}", motion[index].frame),
        )),
        None => Ok(()),
    }
}

impl<'de> Deserialize<'de> for Pins {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_any(PinsVisitor)
    }
}

struct PinsVisitor;

impl<'de> Visitor<'de> for PinsVisitor {
    type Value = Pins;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of names and tables, or one table")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<Pins, A::Error> {
        let group = PinGroup::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Pins { groups: vec![group], is_list: false })
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> std::result::Result<Pins, A::Error> {
        let mut groups = Vec::new();
        while let Some(Element(group)) = list.next_element()? {
            groups.push(group);
        }
        Ok(Pins { groups, is_list: true })
    }
}

/// An element of the list: a name alone, or a table.
struct Element(PinGroup);

impl<'de> Deserialize<'de> for Element {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_any(ElementVisitor)
    }
}

struct ElementVisitor;

impl<'de> Visitor<'de> for ElementVisitor {
    type Value = Element;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a name such as \"top_left\", or a table")
    }

    fn visit_str<E>(self, name: &str) -> std::result::Result<Element, E> {
        Ok(Element(PinGroup { names: vec![name.to_owned()], ..PinGroup::default() }))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<Element, A::Error> {
        PinGroup::deserialize(MapAccessDeserializer::new(map)).map(Element)
    }
}
