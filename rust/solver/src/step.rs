//! One substep: a table of contents.
//!
//! Move, by all forces and, if the step is implicit, by the contacts in its system; let explicit steps meet their contacts; hold
//! the edges that are too long; cut short the ways that still lead through something. At the end of a frame the last two take
//! turns until both hold.

use crate::contact::{Contacts, Walls};
use crate::implicit::Implicit;
use crate::interrupter::Interrupter;
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

/// How often limiters and contacts take turns at the end of a frame, until both hold.
const TURNS: usize = 16;

/// More steps are taken if one cuts the ways of more than one in so many particles short.
const MANY: usize = 20;

/// What a substep works with.
pub(crate) struct Step<'a> {
    pub(crate) system: &'a System,
    pub(crate) pins: &'a Pins,
    /// Length (s).
    pub(crate) h: f64,
    /// Its number in its frame, from 1, and how many there are.
    pub(crate) number: u32,
    pub(crate) count: u32,
    /// So many steps meet contacts together: one, or several explicit ones.
    pub(crate) stride: u32,
    /// A step that is asked to stop stops half way.
    pub(crate) interrupter: &'a Interrupter,
}

impl Step<'_> {
    /// Moves the state by one substep, and says whether it was short enough: contacts cut few ways short, and at the end of
    /// a frame all edges are held.
    pub(crate) fn run(
        &self,
        state: &mut State,
        method: &mut Method,
        contacts: &mut Contacts,
        limits: &mut [Limit],
    ) -> bool {
        let is_last = self.number == self.count;
        let done = self.number - 1;
        if !contacts.is_empty() && done.is_multiple_of(self.stride) {
            let end = (done + self.stride).min(self.count);
            contacts.start_step([done, end], self.count, &state.position);
        }
        let clipped_before = contacts.clipped();
        let meets = !contacts.is_empty() && (is_last || self.number.is_multiple_of(self.stride));
        method.step(self.system, state, contacts, self.h, is_last);
        if let (Method::Explicit(.., response), true) = (&mut *method, meets) {
            let steps = done % self.stride + 1;
            response.respond(self.system, state, contacts, f64::from(steps) * self.h);
        }
        if is_last {
            self.pins.arrive(state);
        }
        let mut is_held = self.limit(state, method, limits, is_last);
        if !meets {
            return true;
        }
        contacts.forget_walls();
        let mut clipped = contacts.truncate(&mut state.position);
        let clipped_in_step = contacts.clipped() - clipped_before;
        let is_short = clipped_in_step as usize * MANY <= self.system.particle_count();
        if clipped == 0 && contacts.count() == 0 {
            // If edges are not held all the same, it is pins that pull them: more steps would not help.
            return is_short;
        }
        for _ in 0..if is_last { TURNS } else { 0 } {
            if clipped == 0 && is_held || self.interrupter.is_asked() {
                break;
            }
            is_held = self.hold_again(state, limits, contacts.walls());
            clipped = contacts.truncate(&mut state.position);
        }
        is_short && (!is_last || is_held && clipped == 0)
    }

    /// Limits strain after the method's step, and says whether all edges are held.
    fn limit(
        &self,
        state: &mut State,
        method: &mut Method,
        limits: &mut [Limit],
        is_last: bool,
    ) -> bool {
        match method {
            Method::Explicit(..) => {
                for limit in limits {
                    let masses = &self.system.inverse_masses;
                    limit.apply(state, masses, self.h, is_last, self.interrupter);
                }
                true
            }
            Method::Implicit(_) if !is_last => self.hold(state, limits, SWEEPS),
            Method::Implicit(implicit) => self.hold_at_end(state, implicit, limits),
        }
    }

    /// Holds all edges at the end of a frame, as far as that is possible.
    fn hold_at_end(
        &self,
        state: &mut State,
        implicit: &mut Implicit,
        limits: &mut [Limit],
    ) -> bool {
        let mut is_held = self.hold(state, limits, SWEEPS_AT_END);
        for _ in 0..PULLS {
            if is_held || self.interrupter.is_asked() || !implicit.pull(self.system, state) {
                break;
            }
            is_held = self.hold_again(state, limits, &Walls::default());
        }
        is_held
    }

    /// Applies the limiters, and says whether all edges are held.
    fn hold(&self, state: &mut State, limits: &mut [Limit], most_sweeps: usize) -> bool {
        self.hold_within(state, limits.iter_mut(), most_sweeps, &Walls::default())
    }

    /// The same again, within walls: of the limiters, those that promise to hold their edges.
    fn hold_again(&self, state: &mut State, limits: &mut [Limit], walls: &Walls) -> bool {
        let limits = limits.iter_mut().filter(|limit| limit.promises());
        self.hold_within(state, limits, SWEEPS_AFTER_PULL, walls)
    }

    fn hold_within<'b>(
        &self,
        state: &mut State,
        limits: impl Iterator<Item = &'b mut Limit>,
        most_sweeps: usize,
        walls: &Walls,
    ) -> bool {
        let inverse_masses = &self.system.inverse_masses;
        let is_held = limits.map(|limit| {
            limit.hold(state, inverse_masses, self.h, most_sweeps, walls, self.interrupter)
        });
        is_held.fold(true, |all, held| all & held)
    }
}
