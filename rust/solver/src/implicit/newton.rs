//! One iteration of Newton: the residual and the tangents at a guess, the solve, and the move.

use super::Implicit;
use super::inflated::Inflated;
use super::smoothed::Smoothed;
use crate::contact::Contacts;
use crate::force::AirScratch;
use crate::linear::{Inverse, Solved, Stop};
use crate::system::{Motion, Rate, System};

impl Implicit {
    /// Takes the residual and the tangents at the present guess.
    pub(super) fn linearize(
        &mut self,
        system: &System,
        contacts: &mut Contacts,
        h: f64,
        whole: f64,
    ) {
        let Self { base, at, residual, still, observed, hessian, taut, gradients, memory, .. } =
            self;
        let by_square = 1.0 / (h * h);
        let System { masses, inverse_masses, .. } = system;
        let from_rest = Motion { from: still, kick: 1.0, drift: 0.0, rate: Rate::New, stage: 1.0 };
        system.advance(at, residual, observed, from_rest);
        for axis in 0..3 {
            let accelerations = residual.velocity.0[axis].iter();
            let out = residual.position.0[axis].iter_mut().zip(accelerations);
            let x = at.position.0[axis].iter().zip(&*base.velocity.0[axis]);
            for (i, ((out, a), (x, target))) in out.zip(x).enumerate() {
                let mass = if inverse_masses[i] > 0.0 { masses[i] } else { 0.0 };
                *out = mass * (a - (x - target) * by_square);
            }
        }
        taut.freeze(&at.position, &memory.tensions, 1.0, system);
        taut.add_forces(&mut residual.position);
        contacts.push(&at.position, &mut residual.position, whole);
        gradients.take_residual(&residual.position);
        for (i, inertia) in hessian.inertia.iter_mut().enumerate() {
            *inertia = inertia_of(system, &observed.air, i, h) as f32;
        }
        for (particle, tangent) in system.goals.tangents(h) {
            if !system.is_pinned(particle) {
                hessian.inertia[particle] += tangent as f32;
            }
        }
        hessian.freeze(system, observed, &at.position, h);
        hessian.tauten(taut.pulling());
        contacts.matrix.weigh(&hessian.inertia);
    }

    /// Solves for the move from the present guess.
    pub(super) fn solve(
        &mut self,
        system: &System,
        contacts: &Contacts,
        h: f64,
        stop: Stop,
    ) -> Solved {
        let Self { preconditioner, factored, hessian, blocks, scratch, gradients, .. } = self;
        let contacts = &contacts.matrix;
        let matrix = &hessian.without_bends(system, contacts);
        let operator = hessian.on(system, contacts);
        let largest = hessian.largest();
        hessian.invert_blocks(system, contacts, blocks);
        let (inverse, contacts): (&mut dyn Inverse, _) = match factored {
            Some(factored) => (factored.inverse(hessian, system, contacts), None),
            None => (preconditioner.inverse(system, h), Some(contacts)),
        };
        let inverse = &mut Smoothed { matrix, contacts, blocks, inverse, largest, scratch };
        if system.air.pressures.is_empty() {
            return gradients.solve(&operator, inverse, stop);
        }
        gradients.solve(&Inflated::new(operator, system, &self.observed.air), inverse, stop)
    }

    /// Moves the guess by the solution.
    pub(super) fn correct(&mut self, system: &System, contacts: &Contacts, h: f64) {
        let solution = &self.gradients.solution;
        self.taut.follow(solution, &mut self.memory.tensions);
        let inertia = |particle: usize| inertia_of(system, &self.observed.air, particle, h);
        let residual = &self.residual.position;
        let shifts = self.pieces.shifts(residual, solution, inertia, &contacts.matrix);
        for axis in 0..3 {
            let position = self.at.position.0[axis].iter_mut();
            let velocity = self.at.velocity.0[axis].iter_mut();
            let base = self.base.position.0[axis].iter();
            let moves = solution.0[axis].iter().zip(base).enumerate();
            for ((x, v), (particle, (dx, base))) in position.zip(velocity).zip(moves) {
                let shift = shifts.as_ref().map_or(0.0, |shifts| shifts.of(particle)[axis]);
                let dx = f64::from(*dx) + shift;
                if dx != 0.0 {
                    *x += dx;
                    *v = (*x - base) / h;
                }
            }
        }
    }
}

/// `m/h² + ka/h + k` (kg/s²) of a particle, wind and fields included; 0 of a pinned one.
fn inertia_of(system: &System, air: &AirScratch, particle: usize, h: f64) -> f64 {
    if system.is_pinned(particle) {
        return 0.0;
    }
    let damping = system.air_damping[particle] + system.air.damping_of(particle, air);
    let stiffness = air.stiffness_of(particle);
    system.masses[particle] / (h * h) + damping / h + stiffness
}
