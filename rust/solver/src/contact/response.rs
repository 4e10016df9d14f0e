//! What contacts make of a step that an explicit integrator has taken without them.
//!
//! The nearest positions, by mass, at which contacts press and rub: with x* where the step leads,
//!
//! ```text
//! M (x - x*)/h² = f(x)        v += (x - x*)/h
//! ```
//!
//! solved as an implicit step is, by Newton's iterations, with the contacts alone for a matrix. Explicit steps are short: it
//! is done once for several of them.

use super::{ContactMatrix, Contacts};
use crate::interrupter::Interrupter;
use crate::linear::{BlockJacobi, ConjugateGradient, Field, Inverse, Operator, Stop};
use crate::state::State;
use crate::system::System;

/// Iterations of Newton: friction needs the pressure of one before it.
const NEWTON: usize = 4;

/// Tight: the system is small, and what is left is momentum of nobody.
const STOP: Stop = Stop { tolerance: 1e-5, least_iterations: 1, most_iterations: 200 };

/// Vectors of the solver.
#[derive(Debug)]
pub(crate) struct Response {
    /// m/h² (kg/s²); 0 where pinned.
    inertia: Vec<f32>,
    blocks: BlockJacobi,
    gradients: ConjugateGradient,
    step: Field,
    /// Where the step leads, and in the place of velocities what is left of the balance (N).
    wanted: State,
}

impl Response {
    pub(crate) fn new(count: usize, interrupter: &Interrupter) -> Self {
        Self {
            inertia: vec![0.0; count],
            blocks: BlockJacobi::new(count),
            gradients: ConjugateGradient::new(count, interrupter),
            step: Field::zeros(count),
            wanted: State::zeros(count),
        }
    }

    /// Moves a state that steps of h seconds in all have led to.
    pub(crate) fn respond(
        &mut self,
        system: &System,
        state: &mut State,
        contacts: &mut Contacts,
        h: f64,
    ) {
        contacts.detect(&state.position, &system.inverse_masses, h);
        if contacts.count() == 0 {
            return;
        }
        let inertia_of = |particle: usize| {
            if system.is_pinned(particle) { 0.0 } else { system.masses[particle] / (h * h) }
        };
        for (particle, inertia) in self.inertia.iter_mut().enumerate() {
            *inertia = inertia_of(particle) as f32;
        }
        self.wanted.position.copy_from(&state.position);
        for _ in 0..NEWTON {
            let State { position: wanted, velocity: residual } = &mut self.wanted;
            for axis in 0..3 {
                let ways = wanted.0[axis].iter().zip(&*state.position.0[axis]);
                for (particle, (out, (to, x))) in residual.0[axis].iter_mut().zip(ways).enumerate()
                {
                    *out = inertia_of(particle) * (to - x);
                }
            }
            contacts.push(&state.position, residual, h);
            self.solve(&contacts.matrix);
            let solution = &self.gradients.solution;
            for (positions, moves) in state.position.0.iter_mut().zip(&solution.0) {
                for (x, dx) in positions.iter_mut().zip(moves) {
                    *x += f64::from(*dx);
                }
            }
            contacts.press(solution);
        }
        for axis in 0..3 {
            let ways = state.position.0[axis].iter().zip(&*self.wanted.position.0[axis]);
            for (v, (x, wanted)) in state.velocity.0[axis].iter_mut().zip(ways) {
                *v += (x - wanted) / h;
            }
        }
        // Velocities without contacts, in the place of what is left of the balance.
        let State { position: wanted, velocity: free } = &mut self.wanted;
        let State { position, velocity } = state;
        for axis in 0..3 {
            let ways = position.0[axis].iter().zip(&*wanted.0[axis]);
            let velocities = free.0[axis].iter_mut().zip(&*velocity.0[axis]);
            for ((free, v), (x, wanted)) in velocities.zip(ways) {
                *free = v - (x - wanted) / h;
            }
        }
        let free_of = |particle: u32| free.get(particle as usize);
        contacts.stop(velocity, &system.inverse_masses, h, free_of);
    }

    fn solve(&mut self, contacts: &ContactMatrix) {
        let Self { inertia, blocks, gradients, step, wanted } = self;
        let own = &*inertia;
        blocks.invert(own, |first, mut blocks| {
            for (entry, block) in blocks.iter_mut().enumerate() {
                if [0, 2, 5].contains(&entry) {
                    let count = block.len();
                    block.copy_from_slice(&own[first..first + count]);
                } else {
                    block.fill(0.0);
                }
            }
            contacts.add_blocks(first, &mut blocks);
        });
        gradients.start();
        gradients.take_residual(&wanted.velocity);
        let mut inverse = Blocks { blocks, step };
        gradients.solve(&Matrix { inertia: own, contacts }, &mut inverse, STOP);
    }
}

/// Masses over h², and contacts.
struct Matrix<'a> {
    inertia: &'a [f32],
    contacts: &'a ContactMatrix,
}

impl Operator for Matrix<'_> {
    fn apply(&self, p: &Field, out: &mut Field) {
        for (out, p) in out.0.iter_mut().zip(&p.0) {
            for (out, (p, inertia)) in out.iter_mut().zip(p.iter().zip(self.inertia)) {
                *out = inertia * p;
            }
        }
        self.contacts.add::<false>(p, out);
    }
}

/// The inverse blocks as a preconditioner.
struct Blocks<'a> {
    blocks: &'a BlockJacobi,
    step: &'a mut Field,
}

impl Inverse for Blocks<'_> {
    fn apply_inverse(&mut self, r: &Field, z: &mut Field) {
        z.fill(0.0);
        self.blocks.relax([0.0, 1.0], r, self.step, z);
    }
}
