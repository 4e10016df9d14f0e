//! What moves the particles by a step: a rule that needs nothing but the state ([`crate::integrator`]), or one that remembers the
//! states before ([`crate::implicit`]).

use crate::cloth::Cloth;
use crate::contact::{Contacts, Response};
use crate::implicit::{Implicit, Memory, Rule};
use crate::integrator::{Integrator, Scratch, explicit};
use crate::interrupter::Interrupter;
use crate::settings::{IntegratorKind, Settings};
use crate::state::State;
use crate::system::System;

/// An integrator with its memory.
pub(crate) enum Method {
    Explicit(&'static dyn Integrator, Box<Scratch>, Box<Response>),
    Implicit(Box<Implicit>),
}

impl Method {
    pub(crate) fn new(
        settings: &Settings,
        cloths: &[Cloth],
        system: &System,
        state: &State,
        interrupter: &Interrupter,
    ) -> Self {
        if let Some(rule) = explicit(settings.integrator) {
            let response = Box::new(Response::new(state.len(), interrupter));
            return Self::Explicit(rule, Box::new(Scratch::new(state)), response);
        }
        let rule = match settings.integrator {
            IntegratorKind::Bdf2 => Rule::Bdf2,
            _ => Rule::ImplicitEuler,
        };
        let implicit =
            Implicit::new(rule, settings.linear_solver, cloths, system, state, interrupter);
        Self::Implicit(Box::new(implicit))
    }

    /// What the next step depends on besides the state.
    pub(crate) fn memory(&self) -> Option<&Memory> {
        match self {
            Self::Explicit(..) => None,
            Self::Implicit(implicit) => Some(&implicit.memory),
        }
    }

    /// The same, to change it.
    pub(crate) fn memory_mut(&mut self) -> Option<&mut Memory> {
        match self {
            Self::Explicit(..) => None,
            Self::Implicit(implicit) => Some(&mut implicit.memory),
        }
    }

    /// Follows a change of which particles are pinned.
    pub(crate) fn follow_pins(&mut self, system: &System) {
        if let Self::Implicit(implicit) = self {
            implicit.follow_pins(system);
        }
    }

    /// Follows a change of the particles' masses.
    pub(crate) fn follow_masses(&mut self) {
        if let Self::Implicit(implicit) = self {
            implicit.follow_masses();
        }
    }

    /// The edges that implicit steps can hold at their allowed length, cloth by cloth in the order of their springs, and the
    /// tension (N) that does it now.
    pub(crate) fn held_edges(&self) -> impl Iterator<Item = ([u32; 2], f64)> {
        let implicit = match self {
            Self::Explicit(..) => None,
            Self::Implicit(implicit) => Some(implicit),
        };
        implicit.into_iter().flat_map(|implicit| implicit.held_edges())
    }

    /// Takes the present rest lengths of a cloth's springs; `base` is the number of its first particle.
    pub(crate) fn follow_rest_lengths(&mut self, cloth: &Cloth, base: u32) {
        if let Self::Implicit(implicit) = self {
            implicit.follow_rest_lengths(cloth, base);
        }
    }

    /// Takes the present stiffness of the cloths' springs.
    pub(crate) fn follow_stiffness(&mut self, cloths: &[Cloth], system: &System) {
        if let Self::Implicit(implicit) = self {
            implicit.follow_stiffness(cloths, system);
        }
    }

    pub(crate) fn is_implicit(&self) -> bool {
        matches!(self, Self::Implicit(_))
    }

    /// Iterations of the linear solver since they were last taken.
    pub(crate) fn take_iterations(&mut self) -> u32 {
        match self {
            Self::Explicit(..) => 0,
            Self::Implicit(implicit) => std::mem::take(&mut implicit.iterations),
        }
    }

    /// Moves `state` by one step of h seconds; `is_last` marks the last step of a frame.
    pub(crate) fn step(
        &mut self,
        system: &System,
        state: &mut State,
        contacts: &mut Contacts,
        h: f64,
        is_last: bool,
    ) {
        match self {
            Self::Explicit(rule, scratch, _) => rule.step(system, state, scratch, h),
            Self::Implicit(implicit) => implicit.step(system, state, contacts, h, is_last),
        }
    }
}
