//! The force fields among `[[force]]`: their words and keys as the solver's fields.
//!
//! ```toml
//! kind = "wind_field"
//! strength = 2.0                 # N/m² along the axis; times `pressure`, if that is given
//! location = [0, 0, -1]
//! axis = [0, 0, 1]
//! falloff = { shape = "cone", side = "positive", power = 2, max = 5, radial_max = 30 }
//! ```

use boucle_geometry::Vector;
use boucle_solver::{Falloff, FalloffShape, Field, FieldKind, FieldShape, Range, Side};
use serde::{Deserialize, Serialize};

use super::choice::Choice;
use super::force::{FieldWord, Force};
use crate::error::{Error, Result};

impl Choice for FieldShape {
    const WORDS: &'static [(&'static str, Self)] =
        &[("point", Self::Point), ("line", Self::Line), ("plane", Self::Plane)];
}

impl Choice for FalloffShape {
    const WORDS: &'static [(&'static str, Self)] =
        &[("sphere", Self::Sphere), ("tube", Self::Tube), ("cone", Self::Cone)];
}

impl Choice for Side {
    const WORDS: &'static [(&'static str, Self)] =
        &[("both", Self::Both), ("positive", Self::Positive), ("negative", Self::Negative)];
}

/// How a field fades.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FalloffDescription {
    /// Along what.
    #[serde(default, deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub shape: FalloffShape,
    /// On which side of the plane across its axis it acts.
    #[serde(default, deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub side: Side,
    /// With which power of the distance.
    #[serde(default)]
    pub power: f64,
    /// Distance (m) up to which it does not fade.
    pub min: Option<f64>,
    /// Distance (m) from which on it is nothing.
    pub max: Option<f64>,
    /// Tube and cone: the same across the axis (m, or degrees).
    #[serde(default)]
    pub radial_power: f64,
    /// The same.
    pub radial_min: Option<f64>,
    /// The same.
    pub radial_max: Option<f64>,
}

impl FalloffDescription {
    fn falloff(&self) -> Falloff {
        Falloff {
            shape: self.shape,
            side: self.side,
            distance: Range { power: self.power, min: self.min, max: self.max },
            radial: Range { power: self.radial_power, min: self.radial_min, max: self.radial_max },
        }
    }
}

/// The field that a force's keys describe.
pub(super) fn field_of(word: FieldWord, force: &Force, at: &str) -> Result<Field> {
    let kind = match word {
        FieldWord::Point => {
            FieldKind::Point { inverse_square: force.inverse_square.unwrap_or_default() }
        }
        FieldWord::Wind => FieldKind::Wind,
        FieldWord::Vortex => FieldKind::Vortex,
        FieldWord::Turbulence => FieldKind::Turbulence {
            size: force.size.unwrap_or(1.0),
            is_global: force.global.unwrap_or_default(),
        },
        FieldWord::Drag => FieldKind::Drag,
        FieldWord::Harmonic => {
            FieldKind::Harmonic { rest_length: force.rest_length.unwrap_or_default() }
        }
        FieldWord::Magnetic => FieldKind::Magnetic,
    };
    let plain = Field::new(kind, 0.0);
    let Some(strength) = force.strength else {
        return Err(Error::input(format!("{at}.strength is missing")));
    };
    let field = Field {
        strength,
        pressure: force.pressure.unwrap_or(plain.pressure),
        weight: force.weight.unwrap_or(plain.weight),
        damping: force.damping.unwrap_or(plain.damping),
        flow: force.flow.unwrap_or(plain.flow),
        noise: force.noise.unwrap_or(plain.noise),
        seed: force.seed.unwrap_or(plain.seed),
        shape: force.shape,
        falloff: force.falloff.as_ref().map_or(plain.falloff, FalloffDescription::falloff),
        wind_factor: force.wind_factor.unwrap_or(plain.wind_factor),
        location: force.location.map_or(plain.location, Vector::from),
        axis: force.axis.map_or(plain.axis, Vector::from),
        kind,
    };
    field.check().map_err(|error| Error::input(format!("{at}: {error}")))?;
    Ok(field)
}
