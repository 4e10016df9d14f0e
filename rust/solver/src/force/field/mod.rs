//! Force fields: what stands somewhere in the scene and pushes all cloth around it, as in Blender.
//!
//! A field is a pressure p (N/m²) at each point x, for cloth that moves there with v. A vertex feels it on its share A of
//! the cloth's area as it is now:
//!
//! ```text
//! F = A [ (1 - w) p + w (p·n) n ]        (N)       w: wind factor, n: normal of each face
//! ```
//!
//! A field stands still during a frame. Its laws are in [`kinds`], how they fade with distance in [`falloff`].
//!
//! Blender's cloth feels 0.48 N/m² for each unit of a field's strength at 24 frames a second: that is its
//! [`Field::pressure`] there.

mod falloff;
mod kinds;
mod noise;
mod numbers;

pub use falloff::{Falloff, FalloffShape, Range, Side};
pub(super) use kinds::Push;
pub(super) use noise::{draw, turbulence};
pub(crate) use numbers::COUNT as NUMBERS;

use boucle_geometry::Vector;

use crate::cloth::FARTHEST;
use crate::error::{Error, Result};

/// Which law a field follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldKind {
    /// Away from the field.
    Point {
        /// Divided by the square of the distance (m) besides.
        inverse_square: bool,
    },
    /// Along the field's axis.
    Wind,
    /// Around the field's axis.
    Vortex,
    /// Any way, from place to place.
    Turbulence {
        /// Size (m) of the largest eddies.
        size: f64,
        /// Eddies stand still in the world when the field moves.
        is_global: bool,
    },
    /// Against the velocity (m/s): strength times its square, damping times itself.
    Drag,
    /// Back to the field, or to a distance from it, by strength times the way (m).
    Harmonic {
        /// Distance (m) without force.
        rest_length: f64,
    },
    /// Across velocity and field, as on a charge.
    Magnetic,
}

/// From where a field acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FieldShape {
    /// From its location.
    #[default]
    Point,
    /// From the nearest point of its axis.
    Line,
    /// From the nearest point of the plane across its axis.
    Plane,
}

/// One force field at a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its law.
    pub kind: FieldKind,
    /// How strong; a law's result is 1 where strength, way and velocity are.
    pub strength: f64,
    /// Pressure (N/m²) of a result of 1.
    pub pressure: f64,
    /// Part of the pressure that is let through, as the falloff is: 0 or more.
    pub weight: f64,
    /// Drag: for each m/s. Harmonic: part of what lets a mass of 1 kg/m² come to rest without swinging.
    pub damping: f64,
    /// Slows what moves: less 1 for each m/s, of all kinds but drag and harmonic.
    pub flow: f64,
    /// Part of strength that changes at random with each frame and vertex.
    pub noise: f64,
    /// Chooses the random numbers.
    pub seed: u32,
    /// From where it acts.
    pub shape: FieldShape,
    /// How it fades.
    pub falloff: Falloff,
    /// Part of the force that acts along the cloth's normal alone: 0 to 1.
    pub wind_factor: f64,
    /// Where it stands (m).
    pub location: Vector,
    /// Its direction, of any length above 0.
    pub axis: Vector,
}

impl Field {
    /// A field at the origin, upright, with 1 N/m² for a strength of 1 everywhere.
    #[must_use]
    pub fn new(kind: FieldKind, strength: f64) -> Self {
        Self {
            kind,
            strength,
            pressure: 1.0,
            weight: 1.0,
            damping: 0.0,
            flow: 0.0,
            noise: 0.0,
            seed: 1,
            shape: FieldShape::default(),
            falloff: Falloff::default(),
            wind_factor: 0.0,
            location: Vector::zeros(),
            axis: Vector::z(),
        }
    }

    /// Refuses values outside their domains.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for the first thing that is not accepted.
    pub fn check(&self) -> Result<()> {
        const LARGE: f64 = 1e9;
        let within = |quantity: &str, value: f64, [least, most]: [f64; 2], domain| {
            if (least..=most).contains(&value) {
                return Ok(());
            }
            let quantity = format!("force field: {quantity}");
            Err(Error::OutOfDomain { quantity, value, domain })
        };
        within("strength", self.strength, [-LARGE, LARGE], "-1e9 to 1e9")?;
        within("noise", self.noise, [-LARGE, LARGE], "-1e9 to 1e9")?;
        for (quantity, value) in [
            ("pressure (N/m²)", self.pressure),
            ("weight", self.weight),
            ("flow", self.flow),
            ("damping", self.damping),
        ] {
            within(quantity, value, [0.0, LARGE], "0 to 1e9")?;
        }
        within("wind_factor", self.wind_factor, [0.0, 1.0], "0 to 1")?;
        for &coordinate in &self.location {
            within("location (m)", coordinate, [-FARTHEST, FARTHEST], "-1e6 to 1e6")?;
        }
        within("length of the axis", self.axis.norm(), [1e-9, LARGE], "1e-9 to 1e9")?;
        if let FieldKind::Turbulence { size, .. } = self.kind {
            within("size (m)", size, [0.0, FARTHEST], "0 to 1e6")?;
        }
        if let FieldKind::Harmonic { rest_length } = self.kind {
            within("rest_length (m)", rest_length, [0.0, FARTHEST], "0 to 1e6")?;
        }
        for range in [&self.falloff.distance, &self.falloff.radial] {
            within("power of the falloff", range.power, [0.0, 100.0], "0 to 100")?;
            for bound in range.min.iter().chain(&range.max) {
                within("bound of the falloff", *bound, [0.0, LARGE], "0 to 1e9")?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
