//! Pins: particles that go where they are told.
//!
//! Over a frame a pin moves in a straight line to its target, at the velocity that takes it there, so that damping
//! and limiters see it move. At the frame's end it is put exactly on its target.

use boucle_geometry::Vector;

use crate::state::State;

/// Where the pins of all cloths are to be at the end of the next frame.
#[derive(Debug, Default)]
pub(crate) struct Pins {
    /// Particle and target (m), by particle.
    targets: Vec<(u32, Vector)>,
}

impl Pins {
    pub(crate) fn new(particles: impl IntoIterator<Item = u32>, state: &State) -> Self {
        let mut targets: Vec<_> = particles
            .into_iter()
            .map(|particle| (particle, state.position.get(particle as usize)))
            .collect();
        targets.sort_unstable_by_key(|&(particle, _)| particle);
        targets.dedup_by_key(|&mut (particle, _)| particle);
        Self { targets }
    }

    pub(crate) fn particles(&self) -> impl Iterator<Item = u32> {
        self.targets.iter().map(|&(particle, _)| particle)
    }

    /// Sets the targets of the pins for which there is one.
    pub(crate) fn aim(&mut self, target_of: impl Fn(u32) -> Option<Vector>) {
        for (particle, target) in &mut self.targets {
            *target = target_of(*particle).unwrap_or(*target);
        }
    }

    /// Removes the pins of which this is true.
    pub(crate) fn release(&mut self, is_released: impl Fn(u32) -> bool) {
        self.targets.retain(|&(particle, _)| !is_released(particle));
    }

    /// Sends the pins off to their targets, to arrive after `duration` seconds.
    pub(crate) fn start(&self, state: &mut State, duration: f64) {
        for &(particle, target) in &self.targets {
            let position = state.position.get(particle as usize);
            state.velocity.set(particle as usize, &((target - position) / duration));
        }
    }

    /// The largest change of a pin's velocity (m/s) if it is to arrive after `duration` seconds.
    pub(crate) fn largest_change(&self, state: &State, duration: f64) -> f64 {
        let changes = self.targets.iter().map(|&(particle, target)| {
            let particle = particle as usize;
            let way = target - state.position.get(particle);
            (way / duration - state.velocity.get(particle)).norm()
        });
        changes.fold(0.0, f64::max)
    }

    /// Puts the pins on their targets.
    pub(crate) fn arrive(&self, state: &mut State) {
        for &(particle, target) in &self.targets {
            state.position.set(particle as usize, &target);
        }
    }
}
