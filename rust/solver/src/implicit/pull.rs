//! Edges that no limiter can hold one by one, pulled to their allowed length all at once.

use super::Implicit;
use super::taut::WithTaut;
use crate::contact::ContactMatrix;
use crate::linear::{Field, Operator, Stop};
use crate::state::State;
use crate::system::System;

/// Edges that are pulled are so much stiffer than in the time step.
const STIFFER: f64 = 100.0;

/// They become stiffer by this factor after a round that leaves more than a half: a row of edges that is all but
/// straight takes a pull many times its stiffness. After a round that makes things worse they become softer again.
const GROWTH: f64 = 3.0;
const STIFFEST: f64 = 1e4;

/// Rounds at the most.
const ROUNDS: usize = 24;

/// Excess, relative, that is left to the limiter.
const ENOUGH: f64 = 2e-4;

/// Two rounds in a row that leave more than this part are in vain: pins alone force the rest.
const IN_VAIN: f64 = 0.999;

const PULL: Stop = Stop { tolerance: 0.05, least_iterations: 3, most_iterations: 60 };

/// Vectors of a pull.
#[derive(Debug)]
pub(super) struct Scratch {
    /// Of each edge (N).
    tensions: Vec<f64>,
    /// All moves so far (m).
    moved: Field,
    product: Field,
}

impl Scratch {
    pub(super) fn new(count: usize, edge_count: usize) -> Self {
        let [moved, product] = [0; 2].map(|_| Field::zeros(count));
        Self { tensions: vec![0.0; edge_count], moved, product }
    }

    fn clear(&mut self) {
        self.tensions.fill(0.0);
        self.moved.fill(0.0);
    }
}

impl Implicit {
    /// Pulls edges that are still too long to their allowed length, in the metric of P: what the limiter cannot do
    /// edge by edge, where a row of edges is stretched between two pins. Velocities stay. Says whether it is of use to
    /// go on.
    ///
    /// Augmented Lagrangian steps from no tension at all.
    pub(crate) fn pull(&mut self, system: &System, state: &mut State) -> bool {
        self.pulling.clear();
        self.at.position.copy_from(&state.position);
        self.base.position.copy_from(&state.position);
        let mut stiffer = STIFFER;
        let (mut last, mut in_vain) = (f64::INFINITY, 0);
        for _ in 0..ROUNDS {
            if self.interrupter.is_asked() {
                break;
            }
            self.taut.freeze(&self.at.position, &self.pulling.tensions, stiffer, system);
            let excess = self.taut.largest_excess(&self.at.position);
            in_vain = if excess > IN_VAIN * last && excess <= last { in_vain + 1 } else { 0 };
            if excess <= ENOUGH || in_vain == 2 {
                break;
            }
            if excess > last {
                stiffer = (stiffer / GROWTH).max(STIFFER);
            } else if excess > 0.5 * last {
                stiffer = (stiffer * GROWTH).min(STIFFEST);
            }
            last = excess;
            self.pull_once(system);
        }
        let mass = |particle: usize| system.masses[particle];
        let shifts = self.pieces.shifts(
            &self.still.position,
            &self.pulling.moved,
            mass,
            &ContactMatrix::default(),
        );
        for (axis, positions) in state.position.0.iter_mut().enumerate() {
            for (particle, (x, pulled)) in
                positions.iter_mut().zip(&*self.at.position.0[axis]).enumerate()
            {
                let shift = shifts.as_ref().map_or(0.0, |shifts| shifts.of(particle)[axis]);
                *x = pulled + shift;
            }
        }
        in_vain < 2
    }

    /// One round: solves for a move with the tensions as they are frozen, and takes it.
    fn pull_once(&mut self, system: &System) {
        let Self { taut, gradients, preconditioner, at, residual, base, pulling, .. } = self;
        let Scratch { tensions, moved, product } = pulling;
        let (inverse, matrix) = preconditioner.both(system, self.step);
        matrix.apply(moved, product);
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
        taut.follow(&gradients.solution, tensions);
        for (axis, moved) in moved.0.iter_mut().enumerate() {
            let moves = moved.iter_mut().zip(&gradients.solution.0[axis]);
            let positions = at.position.0[axis].iter_mut().zip(&*base.position.0[axis]);
            for ((moved, dx), (x, from)) in moves.zip(positions) {
                *moved += dx;
                *x = from + f64::from(*moved);
            }
        }
    }
}
