//! One substep: a table of contents.

use crate::limit::Limit;
use crate::method::Method;
use crate::pins::Pins;
use crate::state::State;
use crate::system::System;

/// How often edges that limiters cannot hold are pulled, at the most: where pins alone force the strain, it is in vain.
const PULLS: usize = 1;

/// The same at the end of a frame, whose result is seen.
const PULLS_AT_END: usize = 8;

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
                for _ in 0..if self.is_last { PULLS_AT_END } else { PULLS } {
                    let is_held = |limit: &mut Limit| limit.hold(state, inverse_masses, self.h);
                    if limits.iter_mut().map(is_held).fold(true, |all, held| all & held) {
                        break;
                    }
                    implicit.pull(self.system, state);
                }
            }
        }
    }
}
