//! Implicit integrators: implicit Euler and BDF2, linearised.
//!
//! A step of h seconds looks for the positions x at its end. With a base position and velocity made of the states
//! before it, and h' a part of h (see [`history`]),
//!
//! ```text
//! v = (x - base)/h'        M (x - target)/h'² = f(x, v)        target = base + h' v_base
//! ```
//!
//! A Newton iteration solves `H dx = r` with
//!
//! ```text
//! r = f - M (x - target)/h'²        H = M/h'² + D/h' + K        (tangents of the springs, see [`hessian`])
//! ```
//!
//! from the inertial prediction `x = target + h'² g`, by conjugate gradients. Their preconditioner is the inverse of
//! `P = M/h'² + D/h' + sum k_e L_e`, the matrix of Projective Dynamics, between two smoothings ([`smoothed`]). P is
//! constant while step, stiffness and pins are, and one number for each pair of particles; bend springs are left out.
//! For fabric, H itself with a bound of what bends is factored in its place ([`factored`]).
//!
//! Iterations end when one brings the guess nearer by a small part only of what all have, in the norm of H. Mostly two
//! of Newton are made; BDF2 needs the second where cloth snaps taut. What is woven is solved further ([`solving`]).
//!
//! Source: Baraff & Witkin 1998 for the step; Bouaziz et al. 2014 for P.

mod factored;
mod hessian;
mod history;
mod inflated;
mod momentum;
mod newton;
mod preconditioner;
mod pull;
mod smoothed;
mod solving;
mod step_error;
mod substeps;
mod taut;
#[cfg(test)]
mod tests;

use crate::cloth::{Cloth, placed};
use crate::contact::Contacts;
use crate::interrupter::Interrupter;
use crate::linear::{BlockJacobi, ConjugateGradient};
use crate::settings::LinearSolver;
use crate::state::{Coordinates, State};
use crate::system::{Observed, System};
use factored::Factored;
use hessian::Hessian;
use history::Formula;
pub(crate) use history::Memory;
use momentum::Pieces;
use preconditioner::Preconditioner;
use smoothed::Scratch;
use solving::Solving;
pub(crate) use substeps::Accuracy;
use taut::Taut;

/// Which formula makes the base of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rule {
    ImplicitEuler,
    Bdf2,
}

/// Iterations of Newton in contact: friction needs the pressure of one before it, or of the step before.
const LEAST_IN_CONTACT: usize = 3;
const LEAST_IN_NEW_CONTACT: usize = 4;
const MOST_IN_CONTACT: usize = 6;

/// How often a step is taken up again where it was cut short, if more than one in so many particles were.
const ROUNDS: usize = 2;
const MANY: usize = 100;

/// An implicit integrator and all that it keeps between steps.
#[derive(Debug)]
pub(crate) struct Implicit {
    rule: Rule,
    /// What the next step depends on besides the state.
    pub(crate) memory: Memory,
    preconditioner: Preconditioner,
    /// In the place of P.
    factored: Option<Factored>,
    blocks: BlockJacobi,
    scratch: Scratch,
    hessian: Hessian,
    taut: Taut,
    pulling: pull::Scratch,
    pieces: Pieces,
    gradients: ConjugateGradient,
    solving: Solving,
    linear_solver: LinearSolver,
    /// h' of the last step (s).
    step: f64,
    /// Base position, and the target in the place of velocities.
    base: State,
    /// The present guess.
    at: State,
    /// What forces leave at the guess, in the place of positions, and accelerations in that of velocities.
    residual: State,
    /// Where the ways to the guess lead that are cut short.
    reached: Coordinates,
    /// Zeros.
    still: State,
    observed: Observed,
    interrupter: Interrupter,
    /// Iterations since they were last counted.
    pub(crate) iterations: u32,
}

impl Implicit {
    pub(crate) fn new(
        rule: Rule,
        linear_solver: LinearSolver,
        cloths: &[Cloth],
        system: &System,
        state: &State,
        interrupter: &Interrupter,
    ) -> Self {
        let count = state.len();
        let springs = placed(cloths)
            .flat_map(|(cloth, base)| cloth.springs.iter().map(move |spring| (spring, base)));
        let taut = Taut::new(cloths, &system.layout);
        let solving = Solving::of(cloths, linear_solver).within(system);
        let preconditioner = Preconditioner::new(cloths, &system.fabrics, linear_solver);
        let factored = solving.is_factored.then(|| Factored::new(&preconditioner, system));
        Self {
            rule,
            memory: Memory::new(state, taut.edge_count()),
            preconditioner,
            factored,
            blocks: BlockJacobi::new(count),
            scratch: Scratch::new(count),
            hessian: Hessian::new(system, count),
            pulling: pull::Scratch::new(count, taut.edge_count()),
            taut,
            pieces: Pieces::new(count, springs),
            gradients: ConjugateGradient::new(count, interrupter),
            solving,
            linear_solver,
            step: 0.0,
            base: State::zeros(count),
            at: State::zeros(count),
            residual: State::zeros(count),
            reached: State::zeros(count).position,
            still: State::zeros(count),
            observed: Observed::default(),
            interrupter: interrupter.clone(),
            iterations: 0,
        }
    }

    /// The edges that can be held at their allowed length, and the tension (N) that does it.
    pub(crate) fn held_edges(&self) -> impl Iterator<Item = ([u32; 2], f64)> {
        self.taut.ends().zip(self.memory.tensions.iter().copied())
    }

    /// Forgets what depends on which particles are pinned.
    pub(crate) fn follow_pins(&mut self, system: &System) {
        self.preconditioner.forget();
        self.pieces.follow_pins(|particle| system.is_held(particle));
    }

    /// Forgets what depends on the masses of particles.
    pub(crate) fn follow_masses(&mut self) {
        self.preconditioner.forget();
    }

    /// Takes the present rest lengths of a cloth's springs; `base` is the number of its first particle.
    pub(crate) fn follow_rest_lengths(&mut self, cloth: &Cloth, base: u32) {
        self.taut.follow_rest_lengths(cloth, base);
    }

    /// Takes the present stiffness of the cloths' springs.
    pub(crate) fn follow_stiffness(&mut self, cloths: &[Cloth], system: &System) {
        self.preconditioner.follow_stiffness(cloths, &system.fabrics);
        self.solving = Solving::of(cloths, self.linear_solver).within(system);
    }

    /// Moves `state` by one step of h seconds, among contacts that were told of the step; `is_last` marks the last step of a frame.
    pub(crate) fn step(
        &mut self,
        system: &System,
        state: &mut State,
        contacts: &mut Contacts,
        h: f64,
        is_last: bool,
    ) {
        let formula = self.formula(h);
        self.step = formula.step;
        let solving = if is_last { self.solving.at_end() } else { self.solving };
        let iterations = self.iterations;
        self.predict(system, state, formula, h);
        if contacts.is_empty() {
            self.approach(system, contacts, solving, h);
        } else {
            self.approach_and_touch(system, contacts, solving, h);
        }
        let weight = solving.weight_of_error(self.iterations - iterations);
        self.memory.error += weight * self.error(state, contacts, h);
        self.memory.before.copy_from(state);
        self.memory.step = h;
        if self.rule == Rule::Bdf2 {
            let Self { at: State { position, velocity }, memory, .. } = self;
            contacts.settle(position, velocity, &system.inverse_masses, h);
            let before = &mut memory.before.velocity;
            contacts.forget_impact(position, before, &system.inverse_masses, h);
        }
        state.copy_from(&self.at);
    }

    /// Newton's iterations from the present guess.
    fn approach(&mut self, system: &System, contacts: &mut Contacts, solving: Solving, h: f64) {
        let step = self.step;
        let [least, most] = match (contacts.count(), contacts.remembers()) {
            (0, _) => [1, solving.newton],
            (_, true) => [LEAST_IN_CONTACT, MOST_IN_CONTACT],
            (_, false) => [LEAST_IN_NEW_CONTACT, MOST_IN_CONTACT],
        };
        self.gradients.start();
        let mut gained = 0.0;
        for iteration in 1..=most {
            if self.interrupter.is_asked() {
                break;
            }
            self.linearize(system, contacts, step, h);
            let solved = self.solve(system, contacts, step, solving.stop);
            self.iterations += solved.iterations;
            if solved.iterations == 0 {
                break;
            }
            self.correct(system, contacts, step);
            contacts.press(&self.gradients.solution);
            gained += solved.gained;
            if iteration >= least && solved.gained <= solving.left * solving.left * gained {
                break;
            }
        }
    }

    /// The same among contacts: what is cut short goes on from there, among the contacts that it then has.
    fn approach_and_touch(
        &mut self,
        system: &System,
        contacts: &mut Contacts,
        solving: Solving,
        h: f64,
    ) {
        let step = self.step;
        for round in 1..=ROUNDS {
            contacts.detect(&self.at.position, &system.inverse_masses, step);
            self.approach(system, contacts, solving, h);
            self.reached.copy_from(&self.at.position);
            let clipped = contacts.truncate(&mut self.reached);
            let is_whole = clipped as usize * MANY <= system.particle_count();
            if round == ROUNDS || is_whole || self.interrupter.is_asked() {
                break;
            }
            contacts.start_again(&self.reached);
        }
        self.take_reached(step);
    }

    /// Moves the guess to where the cut ways lead.
    fn take_reached(&mut self, h: f64) {
        for (axis, reached) in self.reached.0.iter().enumerate() {
            let position = self.at.position.0[axis].iter_mut();
            let velocity = self.at.velocity.0[axis].iter_mut();
            let base = self.base.position.0[axis].iter();
            for (((x, v), reached), base) in position.zip(velocity).zip(reached.iter()).zip(base) {
                if x.to_bits() != reached.to_bits() {
                    *x = *reached;
                    *v = (*x - base) / h;
                }
            }
        }
    }

    fn formula(&self, h: f64) -> Formula {
        if self.rule == Rule::Bdf2 && self.memory.step > 0.0 {
            Formula::bdf2(h, self.memory.step)
        } else {
            Formula::implicit_euler(h)
        }
    }

    /// Fills the base and the target, and takes the inertial prediction as the first guess.
    fn predict(&mut self, system: &System, state: &State, formula: Formula, h: f64) {
        let Formula { last, before, step } = formula;
        let old = &self.memory.before;
        for axis in 0..3 {
            let fall = step * step * system.gravity[axis];
            let [x, v] = [&state.position.0[axis][..], &state.velocity.0[axis]];
            let [ox, ov] = [&old.position.0[axis][..x.len()], &old.velocity.0[axis][..x.len()]];
            let base = &mut self.base.position.0[axis][..x.len()];
            let target = &mut self.base.velocity.0[axis][..x.len()];
            let at_position = &mut self.at.position.0[axis][..x.len()];
            let at_velocity = &mut self.at.velocity.0[axis][..x.len()];
            let v = &v[..x.len()];
            for i in 0..x.len() {
                if system.is_pinned(i) {
                    at_position[i] = x[i] + h * v[i];
                    at_velocity[i] = v[i];
                    target[i] = at_position[i];
                    base[i] = at_position[i] - step * v[i];
                    continue;
                }
                base[i] = last * x[i] + before * ox[i];
                target[i] = base[i] + step * (last * v[i] + before * ov[i]);
                at_position[i] = target[i] + fall;
                at_velocity[i] = (at_position[i] - base[i]) / step;
            }
        }
    }
}
