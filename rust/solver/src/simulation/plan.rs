//! How many steps the next frame takes.

use boucle_geometry::Vector;

use super::{Outcome, Simulation};
use crate::certificate::length;
use crate::cloth::Cloth;
use crate::contact::LONGEST_WAY;
use crate::error::{Error, Result};
use crate::implicit::Accuracy;
use crate::integrator::explicit;
use crate::limit::Limit;
use crate::method::Method;
use crate::settings::{MOST_SUBSTEPS, StepSize};
use crate::stability::stiffening;
use crate::system::System;

/// How much of the largest stable step `auto` takes.
const AUTO_STEP: f64 = 0.95;

impl Simulation {
    /// The largest step (s) that is stable and that every limiter keeps up with, at most a frame; 0 if there is none.
    #[must_use]
    pub fn safe_time_step(&self) -> f64 {
        self.stable_step().min(self.limited_step())
    }

    /// The largest step (s) that is stable with the springs, the pressure and the wind of all the next frame, at most that; 0 if there
    /// is none.
    fn stable_step(&self) -> f64 {
        let Some(rule) = explicit(self.settings.integrator) else {
            return self.frame_duration();
        };
        let factor = stiffening(&self.cloths, |cloth| self.longest_ratio(cloth));
        let System { air, inverse_masses, .. } = &self.system;
        let fall = self.settings.gravity.norm() * self.frame_duration();
        let pressure = air.wind_damping(&self.state, inverse_masses, fall);
        let [damping, w_squared] =
            air.push_rates(&self.state, inverse_masses, [fall, self.frame_duration()]);
        let inflation = air.pressures.stiffness(&self.state, inverse_masses);
        let goals = self.system.goals.largest_rates(inverse_masses);
        let spectrum = self.spectrum.stiffened(factor).with_goals(goals);
        let spectrum = spectrum.with(pressure + damping, w_squared + inflation);
        spectrum.largest_step(rule, self.frame_duration())
    }

    /// Steps that the next frame begins with; 0 if there is no stable number.
    #[must_use]
    pub fn substeps(&self) -> u32 {
        self.plan().unwrap_or(0)
    }

    /// Largest ratio of length to the least rest length of the next frame, over the springs of a cloth.
    fn longest_ratio(&self, cloth: usize) -> f64 {
        let (springs, base) = (&self.cloths[cloth].springs, self.bases[cloth]);
        let ratios = springs.iter().zip(self.least_rest_lengths(cloth));
        let ratios = ratios.map(|(spring, least)| length(&self.state, spring.ends, base) / least);
        ratios.fold(0.0, f64::max)
    }

    /// The least rest length (m) of each spring of a cloth within the next frame.
    fn least_rest_lengths(&self, cloth: usize) -> impl Iterator<Item = f64> {
        let ends = self.rests[cloth].as_ref().map(|rest| rest.both());
        let springs = self.cloths[cloth].springs.iter().enumerate();
        springs.map(move |(number, spring)| match ends {
            Some([from, to]) => from[number].min(to[number]),
            None => spring.rest_length,
        })
    }

    /// The longest step (s) that every cloth's limiter keeps up with.
    fn limited_step(&self) -> f64 {
        if self.method.is_implicit() {
            return f64::INFINITY;
        }
        let gravity = self.settings.gravity.norm();
        let steps = self.cloths.iter().enumerate().map(|(number, cloth)| {
            Limit::longest_step(cloth, gravity, self.least_rest_lengths(number))
        });
        steps.fold(f64::INFINITY, f64::min)
    }

    /// Steps of the next frame, or why there is no such number.
    pub(super) fn plan(&self) -> Result<u32> {
        let duration = self.frame_duration();
        let asked = match self.settings.step_size {
            StepSize::Auto => None,
            StepSize::Substeps(count) => Some(f64::from(count)),
            // A step that divides the frame but for rounding is not cut once more.
            StepSize::Seconds(step) => Some((duration / step * (1.0 - 1e-9)).ceil().max(1.0)),
        };
        let allowed = |count: f64| {
            if count <= f64::from(MOST_SUBSTEPS) {
                return Ok(count as u32);
            }
            let integrator = self.settings.integrator.name();
            Err(Error::TooManySubsteps { substeps: count, limit: MOST_SUBSTEPS, integrator })
        };
        if let (Some(memory), None) = (self.method.memory(), asked) {
            let change = self.pins.largest_change(&self.state, duration);
            let way = self.longest_way();
            return Ok(self.accuracy.plan(memory.substeps, change, way, duration));
        }
        if let Some(count) = asked
            && (self.settings.allow_unstable || self.method.is_implicit())
        {
            return allowed(count);
        }
        let bound = self.stable_step();
        match asked {
            None => allowed((duration / (AUTO_STEP * bound).min(self.limited_step())).ceil()),
            Some(count) if duration / count <= bound * (1.0 + 1e-9) => allowed(count),
            Some(count) => {
                let substeps = (duration / bound).ceil() as u64;
                Err(Error::Unstable { step: duration / count, bound, substeps })
            }
        }
    }

    /// How far (m) colliders and cloth go towards each other over the next frame at the most.
    pub(super) fn longest_way(&self) -> f64 {
        let pin_way = self.pins.longest_way(&self.state);
        self.contacts.longest_way(&self.state.velocity, pin_way, self.frame_duration())
    }

    /// How exact a frame is after which things touch as they do now.
    pub(super) fn accuracy_now(&self) -> Accuracy {
        Accuracy { is_in_contact: self.contacts.count() > 0, ..self.accuracy }
    }

    /// Steps with which the frame just run is to be done once more, if it is.
    pub(super) fn plan_again(&self, substeps: u32, outcome: &Outcome) -> Option<u32> {
        let memory = self.method.memory().filter(|_| self.settings.step_size == StepSize::Auto)?;
        match outcome {
            Outcome::TooLong => Accuracy::shorter(substeps),
            Outcome::Interrupted => None,
            _ => self.accuracy_now().again(substeps, memory.mean_error(substeps)),
        }
    }

    /// Whether a frame of so many steps may be done once more with more, if they are too long for its contacts.
    pub(super) fn may_shorten(&self, substeps: u32) -> bool {
        let is_free = self.method.is_implicit() && self.settings.step_size == StepSize::Auto;
        is_free && substeps < Accuracy::most_for_contacts(self.longest_way())
    }
}

/// Parts of a frame after which explicit steps meet contacts, at the least.
const MEETINGS: f64 = 24.0;

/// After how many steps contacts are met, if colliders and cloth go so far (m) towards each other over a frame.
pub(super) fn stride(method: &Method, way: f64, substeps: u32) -> u32 {
    if method.is_implicit() {
        return 1;
    }
    (f64::from(substeps) / MEETINGS.max(way / LONGEST_WAY)).floor().max(1.0) as u32
}

/// Root mean square distance (m) of the particles from the middle of their cloth.
pub(super) fn size_of(cloths: &[Cloth]) -> f64 {
    let squares = cloths.iter().map(|cloth| {
        let count = cloth.positions.len().max(1) as f64;
        let middle = cloth.positions.iter().sum::<Vector>() / count;
        cloth.positions.iter().map(|x| (x - middle).norm_squared()).sum::<f64>()
    });
    let count: usize = cloths.iter().map(|cloth| cloth.positions.len()).sum();
    (squares.sum::<f64>() / count.max(1) as f64).sqrt().max(f64::MIN_POSITIVE)
}
