//! Strain limits: what keeps springs below their allowed length `(1 + rate) L0`.
//!
//! `stiffen` (the paper's equation 6) is part of the spring law ([`crate::law::spring`]); [`provot`] and [`project`] act on the
//! state after every step. Only `project` promises: at a frame's end no mesh edge is longer than allowed by more than a
//! thousandth of its rest length, unless pins force it ([`crate::overstretch`]). Implicit steps help it along, by taut edges and a pull
//! of all at once ([`crate::implicit`]).

mod marks;
mod order;
mod project;
mod provot;

pub(crate) use project::Project;
pub(crate) use provot::Provot;

use crate::cloth::Cloth;
use crate::contact::Walls;
use crate::interrupter::Interrupter;
use crate::material::Limiter;
use crate::state::State;

/// The limiter of a cloth that acts. What `provot` and `project` correct has no force, and would keep from breaking what breaks by
/// its load, but for the edges of springs that implicit steps hold; and what breaks at a strain that is not allowed never had it.
pub(crate) fn acting(cloth: &Cloth, is_implicit: bool) -> Limiter {
    let limiter = cloth.material.limiter;
    let Some(tear) = &cloth.tear else { return limiter };
    let has_force = limiter == Limiter::Project && is_implicit && cloth.fabric.is_none();
    let hides_load = !has_force && tear.force.or(tear.stress).is_some();
    let most = |strain: f64| strain * (1.0 + tear.noise);
    let hides_strain = tear.strain.is_some_and(|of| most(of) >= cloth.material.deformation_rate);
    match limiter {
        Limiter::Provot | Limiter::Project if hides_load || hides_strain => Limiter::None,
        _ => limiter,
    }
}

/// The limiter of one cloth that acts after a step.
#[derive(Debug)]
pub(crate) enum Limit {
    Provot(Provot),
    Project(Project),
}

impl Limit {
    /// The limiter of a cloth whose first particle is `base`, if it has one that acts after a step, given whether steps are
    /// implicit and which particles something holds.
    pub(crate) fn of(
        cloth: &Cloth,
        base: u32,
        is_implicit: bool,
        is_held: impl Fn(u32) -> bool,
    ) -> Option<Self> {
        match acting(cloth, is_implicit) {
            Limiter::None | Limiter::Stiffen => None,
            Limiter::Provot => Some(Self::Provot(Provot::new(cloth, base))),
            Limiter::Project => Some(Self::Project(Project::new(cloth, base, is_held))),
        }
    }

    /// Takes the present rest lengths of a cloth, if it is that whose first particle is `base`.
    pub(crate) fn follow_rest_lengths(&mut self, cloth: &Cloth, base: u32) {
        match self {
            Self::Provot(limit) if limit.base == base => {
                limit.follow_rest_lengths(&cloth.springs, 1.0 + cloth.material.deformation_rate);
            }
            Self::Project(limit) if limit.base == base => {
                limit.follow_rest_lengths(&cloth.springs);
            }
            Self::Provot(_) | Self::Project(_) => {}
        }
    }

    /// The longest explicit step (s) that a cloth's limiter keeps up with if its springs have these rest lengths (m).
    pub(crate) fn longest_step(
        cloth: &Cloth,
        gravity: f64,
        rest_lengths: impl Iterator<Item = f64>,
    ) -> f64 {
        match acting(cloth, false) {
            Limiter::Project => Project::longest_step(cloth, gravity, rest_lengths),
            Limiter::None | Limiter::Stiffen | Limiter::Provot => f64::INFINITY,
        }
    }

    /// Whether it is to hold its edges, whatever it takes.
    pub(crate) fn promises(&self) -> bool {
        matches!(self, Self::Project(_))
    }

    /// Moves ends that are too far apart after an implicit step, which has already held them as well as it can, in so
    /// many sweeps at the most and within walls, and says whether all are held now.
    pub(crate) fn hold(
        &mut self,
        state: &mut State,
        inverse_masses: &[f64],
        h: f64,
        most_sweeps: usize,
        walls: &Walls,
        interrupter: &Interrupter,
    ) -> bool {
        match self {
            Self::Provot(limit) => {
                limit.apply(state, inverse_masses, h);
                true
            }
            Self::Project(limit) => {
                limit.hold(state, inverse_masses, most_sweeps, walls, interrupter)
            }
        }
    }

    /// Moves ends that are too far apart after a step of h seconds; `is_last` marks the last step of a frame, whose
    /// result is seen.
    pub(crate) fn apply(
        &mut self,
        state: &mut State,
        inverse_masses: &[f64],
        h: f64,
        is_last: bool,
        interrupter: &Interrupter,
    ) {
        match self {
            Self::Provot(limit) => limit.apply(state, inverse_masses, h),
            Self::Project(limit) => limit.apply(state, inverse_masses, h, is_last, interrupter),
        }
    }
}
