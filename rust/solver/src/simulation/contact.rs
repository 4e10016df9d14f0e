//! Colliders, and what touches.

use boucle_geometry::Vector;

use super::Simulation;
use crate::collider::Collider;
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
