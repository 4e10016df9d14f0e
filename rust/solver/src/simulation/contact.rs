//! Colliders, and what touches.

use boucle_geometry::Vector;

use super::Simulation;
use crate::awake::with_others_awake;
use crate::collider::Collider;
use crate::contact::Detection;
use crate::error::Result;

impl Simulation {
    /// How many colliders there are.
    #[must_use]
    pub fn collider_count(&self) -> usize {
        self.colliders.len()
    }

    /// A collider as it was given.
    ///
    /// # Panics
    /// When there is no collider of this number; so does [`Self::set_collider_targets`].
    #[must_use]
    pub fn collider(&self, collider: usize) -> &Collider {
        &self.colliders[collider]
    }

    /// Where the points of a collider are to be at the end of the next frame (m). They move there in straight lines, and
    /// rest there until they are told anew.
    ///
    /// # Errors
    /// [`Error::BadCollider`](crate::Error::BadCollider) when there are not as many as it has, or one is no place in space.
    pub fn set_collider_targets(&mut self, collider: usize, targets: &[Vector]) -> Result<()> {
        self.colliders[collider].check_positions(targets)?;
        let before = self.colliders[..collider].iter().map(|collider| collider.positions.len());
        self.contacts.aim(before.sum(), targets);
        Ok(())
    }

    /// Finds what would touch over the next step if all went on with the velocity they have, without moving: the contacts
    /// that [`Self::vertex_contacts`] speaks of are then those. `None` if nothing can touch.
    ///
    /// # Errors
    /// As [`Self::advance`]: when the next frame has no allowed number of steps.
    pub fn detect_contacts(&mut self) -> Result<Option<Detection>> {
        let substeps = self.plan()?;
        if self.contacts.is_empty() {
            return Ok(None);
        }
        let h = self.frame_duration() / f64::from(substeps);
        let Self { contacts, system, state, threads, .. } = self;
        let mut ends = state.position.clone();
        for (ends, velocities) in ends.0.iter_mut().zip(&state.velocity.0) {
            for (end, velocity) in ends.iter_mut().zip(velocities.iter()) {
                *end += h * velocity;
            }
        }
        Ok(Some(threads.install(|| {
            with_others_awake(usize::MAX, || {
                contacts.start_step([0, 1], substeps, &state.position);
                contacts.detect(&ends, &system.inverse_masses, h)
            })
        })))
    }

    /// The force (N) with which contacts press each vertex of a cloth, as the last step of a frame leaves them.
    #[must_use]
    pub fn vertex_contacts(&self, cloth: usize) -> Vec<f32> {
        let mut forces = vec![0.0; self.state.len()];
        for (particle, force) in self.contacts.pressures() {
            forces[particle as usize] += force;
        }
        self.particles(cloth).map(|particle| forces[particle] as f32).collect()
    }

    /// How many edges and triangles that pass through each other each vertex of a cloth belongs to.
    #[must_use]
    pub fn vertex_intersections(&self, cloth: usize) -> Vec<f32> {
        let mut counts = vec![0.0; self.state.len()];
        for particle in self.contacts.tangled() {
            counts[particle as usize] += 1.0;
        }
        self.particles(cloth).map(|particle| counts[particle]).collect()
    }

    /// Counts the intersections of the present state.
    pub(super) fn intersect(&mut self) {
        let Self { contacts, state, threads, .. } = self;
        if !contacts.is_empty() {
            let count = threads.install(|| contacts.intersections(&state.position));
            self.intersections = Some(count);
        }
    }
}
