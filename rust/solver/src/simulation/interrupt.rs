//! Stopping in the middle of a frame, from another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Simulation;
use crate::error::Error;

/// Asks a simulation to stop, from any thread.
#[derive(Clone, Debug, Default)]
pub struct Interrupter(Arc<AtomicBool>);

impl Interrupter {
    /// Stops the frame under way at its next substep; if there is none, the next frame before its first.
    pub fn interrupt(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether a stop is asked for, which is then forgotten.
    pub(super) fn take(&self) -> bool {
        self.0.load(Ordering::Relaxed) && self.0.swap(false, Ordering::Relaxed)
    }
}

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
