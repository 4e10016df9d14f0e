//! Stopping a frame in its midst, from another thread.
//!
//! Long loops look whether they are asked to stop, and leave what they do half done: the frame under way is discarded.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Asks a simulation to stop, from any thread.
#[derive(Clone, Debug, Default)]
pub struct Interrupter(Arc<AtomicBool>);

impl Interrupter {
    /// Stops the frame under way as soon as one of its loops looks; if there is none, the next frame before its first step.
    pub fn interrupt(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether a stop is asked for.
    pub(crate) fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// The same, which is then forgotten.
    pub(crate) fn take(&self) -> bool {
        self.is_asked() && self.0.swap(false, Ordering::Relaxed)
    }
}
