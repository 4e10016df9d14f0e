//! One substep: a table of contents.

use crate::limit::Limit;
use crate::method::Method;
use crate::pins::Pins;
use crate::state::State;
use crate::system::System;

/// What a substep works with.
pub(crate) struct Step<'a> {
    pub(crate) system: &'a System,
    pub(crate) pins: &'a Pins,
    /// Length (s).
    pub(crate) h: f64,
    /// Whether it ends a frame.
    pub(crate) is_last: bool,
}

impl Step<'_> {
    /// Moves the state by one substep.
    pub(crate) fn run(&self, state: &mut State, method: &mut Method, limits: &mut [Limit]) {
        method.step(self.system, state, self.h);
        if self.is_last {
            self.pins.arrive(state);
        }
        for limit in limits {
            if method.is_implicit() {
                limit.hold(state, &self.system.inverse_masses, self.h);
            } else {
                limit.apply(state, &self.system.inverse_masses, self.h, self.is_last);
            }
        }
    }
}
