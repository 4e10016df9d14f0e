//! Velocity Verlet: half a kick, a drift, half a kick.
//!
//! ```text
//! u  = v + h/2 a(x, v)        x' = x + h u        v' = u + h/2 a(x', u)
//! ```
//!
//! Order 2 without velocity-dependent forces; damping takes the half-step velocity in the second kick. Free fall is
//! exact. An undamped oscillator stays bounded for `w h < 2`. The forces are evaluated twice a step, so that a
//! state is whole by itself: no acceleration is carried from step to step.
//!
//! Source: Verlet 1967; velocity form after Swope et al. 1982.

use nalgebra::Matrix2;

use super::{Integrator, Scratch, drift, kick};
use crate::state::State;
use crate::system::{Motion, Rate, System};

pub(super) struct Verlet;

impl Integrator for Verlet {
    fn step(&self, system: &System, state: &mut State, scratch: &mut Scratch, h: f64) {
        let [drifted, ..] = &mut scratch.stages;
        let kick_and_drift =
            Motion { from: &*state, kick: 0.5 * h, drift: h, rate: Rate::New, stage: 0.0 };
        system.advance(state, drifted, &mut scratch.observed, kick_and_drift);
        let kick =
            Motion { from: &*drifted, kick: 0.5 * h, drift: 0.0, rate: Rate::New, stage: 1.0 };
        system.advance(drifted, state, &mut scratch.observed, kick);
    }

    fn amplification(&self, w_squared: f64, c: f64, h: f64) -> Matrix2<f64> {
        let half_kick = kick(w_squared, c, 0.5 * h);
        half_kick * drift(h) * half_kick
    }
}
