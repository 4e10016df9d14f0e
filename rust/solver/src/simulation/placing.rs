//! Positions and velocities that are given from outside.

use boucle_geometry::Vector;

use super::Simulation;
use super::parting::ATTEMPTS;

impl Simulation {
    /// Puts the vertices of a cloth as given at these positions (m), at rest, and its hard pins with them. Rest lengths and creases
    /// stay, and so does what draws soft pins. Where cloth is torn and collides with itself, both sides are drawn apart by a hair
    /// (at most 0.05 mm): from the same places contact could not tell which is which.
    pub fn set_positions(&mut self, cloth: usize, positions: &[Vector]) {
        let particles = self.particles(cloth);
        let positions = self.cloths[cloth].over_pieces(positions);
        for (particle, position) in particles.clone().zip(&positions) {
            self.state.position.set(particle, position);
            self.state.velocity.set(particle, &Vector::zeros());
        }
        let own = &self.cloths[cloth];
        if own.collision.as_ref().is_some_and(|collision| collision.with_self) {
            let parted = self.parted(cloth, self.given(cloth).positions.len());
            self.draw_apart(parted, ATTEMPTS);
        } else {
            self.intersect();
        }
        self.forget_motion();
        let state = &self.state;
        self.pins.place(|particle| {
            let particle = particle as usize;
            particles.contains(&particle).then(|| state.position.get(particle))
        });
        self.gather_goals();
    }

    /// Gives the vertices of a cloth as given these velocities (m/s); pinned ones follow their targets all the same.
    pub fn set_velocities(&mut self, cloth: usize, velocities: &[Vector]) {
        let velocities = self.cloths[cloth].over_pieces(velocities);
        for (particle, velocity) in self.particles(cloth).zip(&velocities) {
            if !self.system.is_pinned(particle) {
                self.state.velocity.set(particle, velocity);
            }
        }
        self.forget_motion();
    }

    /// What an implicit integrator remembers is of another motion.
    fn forget_motion(&mut self) {
        if let Some(memory) = self.method.memory_mut() {
            memory.clear();
        }
    }
}
