//! Edges that no limiter can hold one by one, pulled to their allowed length all at once.

use super::taut::WithTaut;
use super::{Implicit, inertia};
use crate::linear::{Field, Operator, Stop};
use crate::state::State;
use crate::system::System;

/// Edges that are pulled are so much stiffer than in the time step, in at most so many rounds.
const STIFFER: f64 = 30.0;
const ROUNDS: usize = 6;
const PULL: Stop = Stop { tolerance: 0.05, least_iterations: 3, most_iterations: 60 };

impl Implicit {
    /// Pulls edges that are still too long to their allowed length, in the metric of P: what the limiter cannot do
    /// edge by edge, where a row of edges is stretched between two pins. Velocities stay.
    ///
    /// Augmented Lagrangian steps with edges [`STIFFER`] than in the time step, until the excess is a tenth.
    pub(crate) fn pull(&mut self, system: &System, state: &mut State) {
        let Self { taut, gradients, preconditioner, at, residual, base, .. } = self;
        let mut tensions = vec![0.0; taut.edge_count()];
        let mut moved = Field::zeros(state.len());
        let mut product = Field::zeros(state.len());
        at.position.copy_from(&state.position);
        base.position.copy_from(&state.position);
        let (inverse, matrix) = preconditioner.both();
        let mut first = 0.0;
        for _ in 0..ROUNDS {
            taut.freeze(&at.position, &tensions, STIFFER, system);
            let excess = taut.largest_excess(&at.position);
            first = f64::max(first, excess);
            if excess <= 0.1 * first {
                break;
            }
            matrix.apply(&moved, &mut product);
            for (out, product) in residual.position.0.iter_mut().zip(&product.0) {
                for (i, (out, product)) in out.iter_mut().zip(product).enumerate() {
                    *out = if system.is_pinned(i) { 0.0 } else { -f64::from(*product) };
                }
            }
            taut.add_forces(&mut residual.position);
            gradients.start();
            gradients.take_residual(&residual.position);
            let operator = WithTaut { matrix, taut };
            self.iterations += gradients.solve(&operator, inverse, PULL).iterations;
            taut.follow(&gradients.solution, &mut tensions);
            for (axis, moved) in moved.0.iter_mut().enumerate() {
                let moves = moved.iter_mut().zip(&gradients.solution.0[axis]);
                let positions = at.position.0[axis].iter_mut().zip(&*base.position.0[axis]);
                for ((moved, dx), (x, from)) in moves.zip(positions) {
                    *moved += dx;
                    *x = from + f64::from(*moved);
                }
            }
        }
        let inertia = |particle: usize| inertia(system, &self.air, particle, self.memory.step);
        let shifts = self.pieces.shifts(&self.still.position, &moved, inertia);
        for (axis, positions) in state.position.0.iter_mut().enumerate() {
            for (particle, (x, pulled)) in
                positions.iter_mut().zip(&*at.position.0[axis]).enumerate()
            {
                let shift = shifts.as_ref().map_or(0.0, |shifts| shifts.of(particle)[axis]);
                *x = pulled + shift;
            }
        }
    }
}
