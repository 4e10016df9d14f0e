//! `[[force]]`: what pushes the cloth besides gravity. Wind, for now.

use boucle_solver::WindLaw;
use serde::{Deserialize, Serialize};
use toml::Value;

use super::check_known;
use super::choice::Choice;
use super::table;
use crate::error::{Error, Result};
use crate::limits;

/// Largest wind coefficient (N·s/m) and air density (kg/m³).
const MAX_COEFFICIENT: f64 = 1e6;
/// Largest component of the wind's velocity (m/s).
const MAX_SPEED: f64 = 1e4;

/// One force.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Force {
    /// Which force.
    #[serde(deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub kind: ForceKind,
    /// Velocity (m/s) of the air.
    pub velocity: [f64; 3],
    /// The classic law by vertex normal (N·s/m).
    pub coefficient: Option<f64>,
    /// Pressure on faces: density (kg/m³) of the air.
    pub air_density: Option<f64>,
    /// Where it blows; everywhere if missing.
    #[serde(default, deserialize_with = "table::optional")]
    pub region: Option<RegionDescription>,
}

/// Which force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceKind {
    /// Moving air.
    Wind,
}

impl Choice for ForceKind {
    const WORDS: &'static [(&'static str, Self)] = &[("wind", Self::Wind)];
    const LATER: &'static [&'static str] = &["drag", "turbulence", "vortex", "water", "point"];
}

/// Where a force acts: a box of the world, or a cloth, or vertices of that or of every cloth.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegionDescription {
    /// Its smallest and its largest corner (m).
    pub r#box: Option<[[f64; 3]; 2]>,
    /// Vertex numbers, from 0.
    pub vertices: Option<Vec<u32>>,
    /// The name of the one cloth it acts on.
    pub cloth: Option<String>,
}

impl Force {
    /// The wind's law as the solver takes it.
    ///
    /// # Errors
    /// When neither or both of `coefficient` and `air_density` are given.
    pub fn law(&self, at: &str) -> Result<WindLaw> {
        match (self.coefficient, self.air_density) {
            (Some(coefficient), None) => Ok(WindLaw::Vertex { coefficient }),
            (None, Some(air_density)) => Ok(WindLaw::Face { air_density }),
            (None, None) => Err(Error::input(format!(
                "{at}.coefficient is missing; accepted: it or air_density"
            ))),
            (Some(_), Some(_)) => Err(Error::input(format!(
                "{at}: coefficient and air_density; accepted: one of the two"
            ))),
        }
    }

    pub(super) fn check(&self, at: &str, cloths: &[&str]) -> Result<()> {
        limits::vector(&format!("{at}.velocity"), &self.velocity, MAX_SPEED, " m/s")?;
        self.law(at)?;
        let numbers = [("coefficient", self.coefficient), ("air_density", self.air_density)];
        for (key, value) in numbers {
            if let Some(value) = value {
                let range = 0.0..=MAX_COEFFICIENT;
                limits::within(&format!("{at}.{key}"), value, &range, "0 to 1e6")?;
            }
        }
        let region = self.region.as_ref();
        region.map_or(Ok(()), |region| region.check(&format!("{at}.region"), cloths))
    }
}

impl RegionDescription {
    fn check(&self, at: &str, cloths: &[&str]) -> Result<()> {
        let of_cloth = self.vertices.is_some() || self.cloth.is_some();
        match (&self.r#box, of_cloth) {
            (Some(_), true) | (None, false) => {
                Err(Error::input(format!("{at} accepts either box or vertices, cloth or both")))
            }
            (None, true) => match &self.cloth {
                Some(name) => check_known(&format!("{at}.cloth"), name, cloths, "cloths"),
                None => Ok(()),
            },
            (Some([min, max]), false) => {
                limits::vector(&format!("{at}.box.0"), min, f64::MAX, " m")?;
                limits::vector(&format!("{at}.box.1"), max, f64::MAX, " m")?;
                match (0..3).find(|&axis| min[axis] > max[axis]) {
                    Some(axis) => Err(Error::refuse(
                        &format!("{at}.box.1.{axis}"),
                        format!("{:?}", max[axis]),
                        &format!("{:?} or more, as in the first corner", min[axis]),
                    )),
                    None => Ok(()),
                }
            }
        }
    }
}

/// Refuses forces for later by their kind, before their own keys are met.
pub(super) fn refuse_later_kinds(tree: &Value) -> Result<()> {
    let forces = tree.get("force").and_then(Value::as_array);
    for (index, force) in forces.into_iter().flatten().enumerate() {
        let kind = force.get("kind").and_then(Value::as_str).unwrap_or_default();
        if ForceKind::LATER.contains(&kind) {
            let later = "is not supported yet; accepted: \"wind\"";
            return Err(Error::input(format!("force.{index}.kind = \"{kind}\" {later}")));
        }
    }
    Ok(())
}
