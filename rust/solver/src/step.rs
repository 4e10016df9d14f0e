//! One substep: a table of contents.

use crate::limit::Limit;
use crate::method::Method;
use crate::pins::Pins;
use crate::state::State;
use crate::system::System;

/// Sweeps that limiters may take after an implicit step. Within a frame, what they leave the next step mends.
const SWEEPS: usize = 48;

/// The same at the end of a frame, whose result is seen: a thousand sweeps cost as much as a few iterations of a pull.
const SWEEPS_AT_END: usize = 2000;

/// How often edges that are not held then are pulled, at the most; and the sweeps after each pull.
const PULLS: usize = 4;
const SWEEPS_AFTER_PULL: usize = 480;

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
        let inverse_masses = &self.system.inverse_masses;
        match method {
            Method::Explicit(..) => {
                for limit in limits {
                    limit.apply(state, inverse_masses, self.h, self.is_last);
                }
            }
            Method::Implicit(implicit) => {
                let mut hold = |state: &mut State, most_sweeps, is_again: bool| {
                    let limits = limits.iter_mut().filter(|limit| !is_again || limit.promises());
                    let is_held =
                        |limit: &mut Limit| limit.hold(state, inverse_masses, self.h, most_sweeps);
                    limits.map(is_held).fold(true, |all, held| all & held)
                };
                if !self.is_last {
                    hold(state, SWEEPS, false);
                    return;
                }
                let mut is_held = hold(state, SWEEPS_AT_END, false);
                for _ in 0..PULLS {
                    if is_held || !implicit.pull(self.system, state) {
                        break;
                    }
                    is_held = hold(state, SWEEPS_AFTER_PULL, true);
                }
            }
        }
    }
}
