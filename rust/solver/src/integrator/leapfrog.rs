//! Leapfrog: half a drift, a kick, half a drift. Position and velocity leap over each other.
//!
//! ```text
//! y = x + h/2 v        v' = v + h a(y, v)        x' = y + h/2 v'
//! ```
//!
//! Order 2 without velocity-dependent forces. An undamped oscillator stays bounded for `w h < 2`.
//!
//! Source: Hockney & Eastwood 1981; this synchronised form is the drift-kick-drift of Quinn et al. 1997.

use nalgebra::Matrix2;

use super::{Integrator, Scratch, drift, kick};
use crate::state::State;
use crate::system::{Motion, Rate, System};

pub(super) struct Leapfrog;

impl Integrator for Leapfrog {
    fn step(&self, system: &System, state: &mut State, scratch: &mut Scratch, h: f64) {
        for (positions, velocities) in state.position.0.iter_mut().zip(&state.velocity.0) {
            for (x, v) in positions.iter_mut().zip(velocities.iter()) {
                *x += 0.5 * h * v;
            }
        }
        let motion = Motion { from: &*state, kick: h, drift: 0.5 * h, rate: Rate::New, stage: 0.5 };
        system.advance(state, &mut scratch.next, &mut scratch.observed, motion);
        std::mem::swap(state, &mut scratch.next);
    }

    fn amplification(&self, w_squared: f64, c: f64, h: f64) -> Matrix2<f64> {
        let half_drift = drift(0.5 * h);
        half_drift * kick(w_squared, c, h) * half_drift
    }
}
