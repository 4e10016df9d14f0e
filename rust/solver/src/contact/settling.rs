//! No bounce from an impact that a step has resolved.
//!
//! A velocity that is extrapolated over an impact bounces: by half with BDF2, which goes on from before it. Across each
//! contact that presses, the velocity is therefore at most that of the way that the step has gone,
//!
//! ```text
//! n·sum_i w_i v_i <= n·sum_i w_i (x_i - x0_i)/h        v_i -= excess w_i/m_i / (sum_j w_j²/m_j) n
//! ```
//!
//! by impulses, contact after contact, which keep the momentum of what touches. Along the surface nothing changes.

use boucle_geometry::Vector;

use super::Contacts;
use super::contact::Contact;
use crate::state::Coordinates;

impl Contacts {
    /// Takes the bounce out of the velocities (m/s) of particles that a step of h seconds has brought to these positions (m).
    pub(crate) fn settle(
        &self,
        positions: &Coordinates,
        velocities: &mut Coordinates,
        inverse_masses: &[f64],
        h: f64,
    ) {
        self.change(velocities, inverse_masses, h, |contact, speed| {
            (speed - self.along_way(contact, h, positions)).max(0.0)
        });
    }

    /// Gives velocities (m/s) from before the step the part along the normals that the step has had, so that what goes on
    /// from them knows nothing of the impact.
    pub(crate) fn forget_impact(
        &self,
        positions: &Coordinates,
        velocities: &mut Coordinates,
        inverse_masses: &[f64],
        h: f64,
    ) {
        self.change(velocities, inverse_masses, h, |contact, speed| {
            speed - self.along_way(contact, h, positions)
        });
    }

    /// Takes out what contacts have given to velocities (m/s) beyond a stop: what was pushed out of their reach does not
    /// fly on. `free_of` are the velocities without contacts.
    pub(super) fn stop(
        &self,
        velocities: &mut Coordinates,
        inverse_masses: &[f64],
        h: f64,
        free_of: impl Fn(u32) -> Vector,
    ) {
        self.change(velocities, inverse_masses, h, |contact, speed| {
            (speed - self.along(contact, h, &free_of).max(0.0)).max(0.0)
        });
    }

    /// How fast (m/s) a contact has opened on the way to these positions (m).
    fn along_way(&self, contact: &Contact, h: f64, positions: &Coordinates) -> f64 {
        self.along(contact, h, |particle| {
            (positions.get(particle as usize) - self.origins[particle as usize]) / h
        })
    }

    /// How fast (m/s) a contact opens if particles have these velocities.
    fn along(&self, contact: &Contact, h: f64, velocity_of: impl Fn(u32) -> Vector) -> f64 {
        let ends = contact.points.iter().zip(&contact.weights).filter(|end| *end.1 != 0.0);
        let speeds = ends.map(|(&point, weight)| {
            let velocity = if self.bodies.is_particle(point) {
                velocity_of(point)
            } else {
                (self.paths.end(point) - self.origins[point as usize]) / h
            };
            weight * contact.normal.dot(&velocity)
        });
        speeds.sum()
    }

    /// Takes from each contact that presses, one after the other, so much of the speed (m/s) at which it opens.
    fn change(
        &self,
        velocities: &mut Coordinates,
        inverse_masses: &[f64],
        h: f64,
        taken_of: impl Fn(&Contact, f64) -> f64,
    ) {
        let pressing = self.near.iter().zip(&self.pressures);
        for (contact, _) in pressing.filter(|(_, pressure)| pressure.force > 0.0) {
            let speed = self.along(contact, h, |point| velocities.get(point as usize));
            let ends = || {
                let ends = contact.points.iter().zip(&contact.weights);
                ends.filter(|end| *end.1 != 0.0 && self.paths.is_free(*end.0))
            };
            let inverse_mass = |point: u32| inverse_masses[point as usize];
            let by_mass: f64 =
                ends().map(|(&point, weight)| weight * weight * inverse_mass(point)).sum();
            let taken = taken_of(contact, speed);
            if taken == 0.0 || by_mass == 0.0 {
                continue;
            }
            for (&point, weight) in ends() {
                let share = taken * weight * inverse_mass(point) / by_mass;
                let velocity = velocities.get(point as usize) - contact.normal * share;
                velocities.set(point as usize, &velocity);
            }
        }
    }
}
