//! Forward Euler: position and velocity both move by their old rates.
//!
//! ```text
//! x' = x + h v        v' = v + h a(x, v)
//! ```
//!
//! Order 1. Without damping the energy of an oscillator grows by `1 + (w h)²` each step: never stable.

use nalgebra::Matrix2;

use super::{Integrator, Scratch, euler, oscillator};
use crate::state::State;
use crate::system::System;

pub(super) struct ForwardEuler;

impl Integrator for ForwardEuler {
    fn step(&self, system: &System, state: &mut State, scratch: &mut Scratch, h: f64) {
        system.advance(state, &mut scratch.next, &mut scratch.observed, euler(state, h, 0.0));
        std::mem::swap(state, &mut scratch.next);
    }

    fn amplification(&self, w_squared: f64, c: f64, h: f64) -> Matrix2<f64> {
        Matrix2::identity() + oscillator(w_squared, c) * h
    }
}
