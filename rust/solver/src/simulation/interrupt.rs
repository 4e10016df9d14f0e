//! What is left of a frame that was stopped in its midst: nothing.

use super::Simulation;
use crate::error::Error;
use crate::interrupter::Interrupter;

impl Simulation {
    /// What stops this simulation.
    #[must_use]
    pub fn interrupter(&self) -> Interrupter {
        self.interrupter.clone()
    }

    /// Returns to the start of the frame. Where it stopped is chance, so nothing that it found may stay.
    pub(super) fn interrupted(&mut self) -> Error {
        self.fall_back();
        self.intersect();
        Error::Interrupted { frame: self.frame + 1 }
    }
}
