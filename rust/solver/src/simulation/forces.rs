//! Forces that are given from outside, frame by frame.

use boucle_geometry::Vector;

use super::Simulation;
use crate::error::{Error, Result};
use crate::force::{Field, check_wind_velocity};

impl Simulation {
    /// Takes these force fields in the place of those before, from the next frame on. They stand still during a frame.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for the first value that is not accepted; the fields before then stay.
    pub fn set_fields(&mut self, fields: Vec<Field>) -> Result<()> {
        fields.iter().try_for_each(Field::check)?;
        self.system.air.set_fields(fields);
        Ok(())
    }

    /// Lets a wind, by its number in the order in which they were given, blow with this velocity (m/s) from the next frame on.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for a number that no wind has, and beyond 1e4 m/s along an axis.
    pub fn set_wind_velocity(&mut self, wind: usize, velocity: Vector) -> Result<()> {
        if wind >= self.system.air.wind_count() {
            let quantity = "the number of a wind".to_owned();
            let domain = "that of one of the winds of the scene, counted from 0";
            return Err(Error::OutOfDomain { quantity, value: wind as f64, domain });
        }
        check_wind_velocity(&velocity)?;
        self.system.air.set_wind_velocity(wind, velocity);
        Ok(())
    }

    /// Takes this gravity (m/s²) from the next frame on.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] beyond 1e6 m/s² along an axis.
    pub fn set_gravity(&mut self, gravity: Vector) -> Result<()> {
        if let Some(&value) = gravity.iter().find(|part| !(part.abs() <= 1e6)) {
            let quantity = "gravity (m/s²)".to_owned();
            return Err(Error::OutOfDomain { quantity, value, domain: "-1e6 to 1e6" });
        }
        self.settings.gravity = gravity;
        self.system.gravity = gravity;
        Ok(())
    }
}
