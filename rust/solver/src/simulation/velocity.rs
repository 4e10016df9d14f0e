//! Velocities that are given from outside.

use boucle_geometry::Vector;

use super::Simulation;

impl Simulation {
    /// Gives the vertices of a cloth these velocities (m/s); pinned ones follow their targets all the same.
    pub fn set_velocities(&mut self, cloth: usize, velocities: &[Vector]) {
        for (particle, velocity) in self.particles(cloth).zip(velocities) {
            if !self.system.is_pinned(particle) {
                self.state.velocity.set(particle, velocity);
            }
        }
        // What an implicit integrator remembers is of another motion.
        if let Some(memory) = self.method.memory_mut() {
            memory.clear();
        }
    }
}
