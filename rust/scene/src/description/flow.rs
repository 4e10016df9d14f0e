//! What air and water do among `[[force]]`, and what water does to a cloth.
//!
//! ```toml
//! [[force]]
//! kind = "wind"
//! velocity = [0, 8, 0]            # m/s, the mean
//! air_density = 1.2               # kg/m³
//! drag_coefficient = 1.17
//! lift_coefficient = 0.8          # missing: pressure along the normal alone
//! gusts = { strength = 0.5, period = 3.0, seed = 1 }
//! turbulence = { intensity = 0.2, size = 1.0, seed = 1 }
//! shelter = true                  # still air behind colliders
//!
//! [[force]]
//! kind = "water"
//! level = 0.0                     # m
//! velocity = [0.5, 0, 0]          # m/s, the current
//! waves = [ { amplitude = 0.1, length = 3.0, direction = [1, 0, 0] } ]
//!
//! [cloth.water]
//! bulk_density = 400.0            # kg/m³, dry, pores included
//! absorbency = 2.0                # kg of water for each kg of dry cloth
//! ```

use boucle_geometry::Vector;
use boucle_solver::{Bulk, Flow, Gusts, Turbulence, Water, Wave, WindLaw};
use serde::{Deserialize, Serialize};

use super::force::Force;
use crate::error::{Error, Result};

/// Gusts of a wind.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GustsDescription {
    /// By how much of its mean velocity the wind grows at the most.
    pub strength: f64,
    /// How long (s) each is.
    pub period: f64,
    /// Chooses the random numbers.
    #[serde(default = "first")]
    pub seed: u32,
}

/// Turbulence of a wind.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TurbulenceDescription {
    /// Spread of each component of the velocity, in parts of the mean speed.
    pub intensity: f64,
    /// Size (m) of the largest eddies.
    pub size: f64,
    /// Chooses the eddies.
    #[serde(default = "first")]
    pub seed: u32,
}

/// Waves on the water.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaveDescription {
    /// Half of the height (m) from trough to crest.
    pub amplitude: f64,
    /// From crest to crest (m).
    pub length: f64,
    /// Where they run; along x if missing.
    #[serde(default = "along_x")]
    pub direction: [f64; 3],
}

/// `[cloth.water]`: how a cloth meets water.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ClothWater {
    /// What it weighs by its volume while it is dry, pores included (kg/m³); 500 if missing.
    pub bulk_density: Option<f64>,
    /// Whether water stays outside it; that of a closed mesh does if missing.
    pub hull: Option<bool>,
    /// Mass of the water that it takes up at the most, in parts of its own; 0 if missing.
    pub absorbency: Option<f64>,
    /// Seconds in which it takes up all that; 10 if missing.
    pub soak_time: Option<f64>,
    /// Seconds in which it dries out of the water; never if missing.
    pub dry_time: Option<f64>,
}

fn first() -> u32 {
    1
}

fn along_x() -> [f64; 3] {
    [1.0, 0.0, 0.0]
}

impl ClothWater {
    /// The same as the solver takes it.
    #[must_use]
    pub fn bulk(&self) -> Bulk {
        let default = Bulk::default();
        Bulk {
            density: self.bulk_density.unwrap_or(default.density),
            is_hull: self.hull,
            absorbency: self.absorbency.unwrap_or(default.absorbency),
            soak_time: self.soak_time.unwrap_or(default.soak_time),
            dry_time: self.dry_time,
        }
    }
}

/// Gusts and turbulence of a wind.
pub(super) fn weather_of(force: &Force) -> (Option<Gusts>, Option<Turbulence>) {
    let gusts = force.gusts.as_ref().map(|gusts| {
        let GustsDescription { strength, period, seed } = *gusts;
        Gusts { strength, period, seed }
    });
    let turbulence = force.turbulence.as_ref().map(|turbulence| {
        let TurbulenceDescription { intensity, size, seed } = *turbulence;
        Turbulence { intensity, size, seed }
    });
    (gusts, turbulence)
}

/// How a wind becomes force.
pub(super) fn law_of(force: &Force, at: &str) -> Result<WindLaw> {
    match (force.coefficient, force.air_density) {
        (Some(coefficient), None) => match coefficients(force).into_iter().find(|(_, is)| *is) {
            None => Ok(WindLaw::Vertex { coefficient }),
            Some((key, _)) => Err(Error::input(format!(
                "{at}: coefficient and {key}; accepted: {key} with air_density"
            ))),
        },
        (None, Some(air_density)) => Ok(WindLaw::Face(flow_of(force, Flow::new(air_density)))),
        (None, None) => {
            Err(Error::input(format!("{at}.coefficient is missing; accepted: it or air_density")))
        }
        (Some(_), Some(_)) => Err(Error::input(format!(
            "{at}: coefficient and air_density; accepted: one of the two"
        ))),
    }
}

/// The water that a force's keys describe.
pub(super) fn water_of(force: &Force, at: &str) -> Result<Water> {
    let plain = Water::default();
    let density = force.density.unwrap_or(plain.flow.density);
    let waves = force.waves.iter().map(|wave| Wave {
        amplitude: wave.amplitude,
        length: wave.length,
        direction: Vector::from(wave.direction),
    });
    let water = Water {
        level: force.level.unwrap_or(plain.level),
        velocity: force.velocity.map_or(plain.velocity, Vector::from),
        flow: flow_of(force, Flow { density, ..plain.flow }),
        waves: waves.collect(),
    };
    water.check().map_err(|error| Error::input(format!("{at}: {error}")))?;
    Ok(water)
}

/// A flow with the coefficients that are given.
fn flow_of(force: &Force, plain: Flow) -> Flow {
    Flow {
        drag: force.drag_coefficient.unwrap_or(plain.drag),
        lift: force.lift_coefficient.or(plain.lift),
        friction: force.friction_coefficient.unwrap_or(plain.friction),
        ..plain
    }
}

/// The keys of coefficients by face, and whether they are given.
fn coefficients(force: &Force) -> [(&'static str, bool); 3] {
    [
        ("drag_coefficient", force.drag_coefficient.is_some()),
        ("lift_coefficient", force.lift_coefficient.is_some()),
        ("friction_coefficient", force.friction_coefficient.is_some()),
    ]
}
