//! Symplectic (semi-implicit) Euler, the paper's rule: the position moves by the new velocity.
//!
//! ```text
//! v' = v + h a(x, v)        x' = x + h v'
//! ```
//!
//! Order 1. Without damping an oscillator stays bounded for `w h < 2`.

use nalgebra::Matrix2;

use super::{Integrator, Scratch, drift, kick};
use crate::state::State;
use crate::system::{Motion, Rate, System};

pub(super) struct SymplecticEuler;

impl Integrator for SymplecticEuler {
    fn step(&self, system: &System, state: &mut State, scratch: &mut Scratch, h: f64) {
        let motion = Motion { from: &*state, kick: h, drift: h, rate: Rate::New, stage: 0.0 };
        system.advance(state, &mut scratch.next, &mut scratch.observed, motion);
        std::mem::swap(state, &mut scratch.next);
    }

    fn amplification(&self, w_squared: f64, c: f64, h: f64) -> Matrix2<f64> {
        drift(h) * kick(w_squared, c, h)
    }
}
