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
use crate::system::System;

pub(super) struct Verlet;

impl Integrator for Verlet {
    fn step(&self, system: &System, state: &mut State, scratch: &mut Scratch, h: f64) {
        let [drifted, ..] = &mut scratch.stages;
        let old = &*state;
        system.advance(
            old,
            drifted,
            &mut scratch.air,
            #[inline(always)]
            |chunk| {
                let x = chunk.of(&old.position);
                let v = chunk.of(&old.velocity);
                for (i, a) in chunk.acceleration.iter().enumerate() {
                    let velocity = v[i] + 0.5 * h * a;
                    chunk.velocity[i] = velocity;
                    chunk.position[i] = x[i] + h * velocity;
                }
            },
        );
        let drifted = &*drifted;
        system.advance(
            drifted,
            state,
            &mut scratch.air,
            #[inline(always)]
            |chunk| {
                let x = chunk.of(&drifted.position);
                let u = chunk.of(&drifted.velocity);
                for (i, a) in chunk.acceleration.iter().enumerate() {
                    chunk.position[i] = x[i];
                    chunk.velocity[i] = u[i] + 0.5 * h * a;
                }
            },
        );
    }

    fn amplification(&self, w_squared: f64, c: f64, h: f64) -> Matrix2<f64> {
        let half_kick = kick(w_squared, c, 0.5 * h);
        half_kick * drift(h) * half_kick
    }
}
