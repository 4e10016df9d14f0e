//! Forces that are given from outside, frame by frame.

use boucle_geometry::Vector;

use super::Simulation;
use crate::error::{Error, Result};
use crate::force::{Field, Water, check_wind_velocity};

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
        self.system.set_gravity(gravity);
        Ok(())
    }

    /// Puts the calm surface of the water at a height (m), and lets its current flow with this velocity (m/s), from the next frame
    /// on.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for a number that is not accepted, and where there is no water.
    pub fn set_water(&mut self, level: f64, velocity: Vector) -> Result<()> {
        let Some(water) = self.system.air.water() else {
            let quantity = "the level (m) of a water that the scene does not have".to_owned();
            let domain = "a scene with water";
            return Err(Error::OutOfDomain { quantity, value: level, domain });
        };
        Water { level, velocity, ..water.clone() }.check()?;
        self.system.air.set_water(level, velocity);
        Ok(())
    }

    /// How wet each vertex of a cloth is: 0 dry to 1 full. All are dry where no cloth takes up water.
    #[must_use]
    pub fn wetness(&self, cloth: usize) -> Vec<f64> {
        let particles = self.particles(cloth);
        let wetness = self.system.air.sea.as_ref().map_or(&[][..], |sea| sea.wetness(particles));
        if wetness.is_empty() { vec![0.0; self.particles(cloth).len()] } else { wetness.to_vec() }
    }

    /// Seconds from the first frame to the present one.
    fn seconds(&self) -> f64 {
        let frames = f64::from(self.frame) - f64::from(self.settings.first_frame);
        frames * self.frame_duration()
    }

    /// Begins a frame of air and water.
    pub(super) fn start_flows(&mut self) {
        let seconds = self.seconds();
        let Self { system, colliders, contacts, state, threads, frame, .. } = self;
        system.air.start_frame(*frame, seconds);
        if system.air.is_sheltered() {
            let [points, _] = contacts.collider_positions();
            threads.install(|| system.air.shelter(colliders, points, state));
        }
    }

    /// Ends a frame of air and water: what has become wetter is heavier.
    pub(super) fn end_flows(&mut self) {
        let duration = self.frame_duration();
        if self.system.air.end_frame(duration, &self.state) {
            self.weigh();
        }
    }

    /// Weighs all particles anew.
    pub(super) fn weigh(&mut self) {
        self.system.weigh(&self.cloths);
        self.method.follow_masses();
    }
}
