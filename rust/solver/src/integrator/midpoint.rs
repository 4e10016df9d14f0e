//! The midpoint rule, Runge-Kutta of order 2: rates from half a step ahead.
//!
//! ```text
//! y = x + h/2 v      u = v + h/2 a(x, v)      x' = x + h u      v' = v + h a(y, u)
//! ```
//!
//! Without damping the energy of an oscillator grows by `1 + (w h)⁴/4` each step: never stable.

use nalgebra::Matrix2;

use super::{Integrator, Scratch, euler, oscillator};
use crate::state::State;
use crate::system::System;

pub(super) struct Midpoint;

impl Integrator for Midpoint {
    fn step(&self, system: &System, state: &mut State, scratch: &mut Scratch, h: f64) {
        let [half_way, ..] = &mut scratch.stages;
        system.advance(state, half_way, &mut scratch.observed, euler(state, 0.5 * h, 0.0));
        system.advance(half_way, &mut scratch.next, &mut scratch.observed, euler(state, h, 0.5));
        std::mem::swap(state, &mut scratch.next);
    }

    fn amplification(&self, w_squared: f64, c: f64, h: f64) -> Matrix2<f64> {
        let rates = oscillator(w_squared, c) * h;
        Matrix2::identity() + rates + rates * rates / 2.0
    }
}
