//! The classic Runge-Kutta rule of order 4.
//!
//! With s = (x, v) and f its rate:
//!
//! ```text
//! s1 = s + h/2 f(s)      s2 = s + h/2 f(s1)      s3 = s + h f(s2)
//! s' = s + h/6 (f(s) + 2 f(s1) + 2 f(s2) + f(s3))
//!    = (s1 + 2 s2 + s3 - s)/3 + h/6 f(s3)
//! ```
//!
//! An undamped oscillator stays bounded for `w h < 2√2`.

use nalgebra::Matrix2;

use super::{Integrator, Scratch, euler_stage, oscillator};
use crate::state::State;
use crate::system::System;

pub(super) struct Rk4;

impl Integrator for Rk4 {
    fn step(&self, system: &System, state: &mut State, scratch: &mut Scratch, h: f64) {
        let [s1, s2, s3] = &mut scratch.stages;
        let s = &*state;
        euler_stage(system, s, s, s1, &mut scratch.air, 0.5 * h);
        euler_stage(system, s, s1, s2, &mut scratch.air, 0.5 * h);
        euler_stage(system, s, s2, s3, &mut scratch.air, h);
        let (s1, s2, s3) = (&*s1, &*s2, &*s3);
        system.advance(
            s3,
            &mut scratch.next,
            &mut scratch.air,
            #[inline(always)]
            |chunk| {
                let of = |state: &State, i: usize| {
                    let particle = chunk.first + i;
                    (
                        state.position.0[chunk.index][particle],
                        state.velocity.0[chunk.index][particle],
                    )
                };
                for (i, a) in chunk.acceleration.iter().enumerate() {
                    let ((x, v), (x1, v1)) = (of(s, i), of(s1, i));
                    let ((x2, v2), (x3, v3)) = (of(s2, i), of(s3, i));
                    // Differences from s first: they are small, and their rounding with them.
                    let (dx, dv) = (
                        (x1 - x) + 2.0 * (x2 - x) + (x3 - x),
                        (v1 - v) + 2.0 * (v2 - v) + (v3 - v),
                    );
                    chunk.position[i] = x + dx / 3.0 + h / 6.0 * v3;
                    chunk.velocity[i] = v + dv / 3.0 + h / 6.0 * a;
                }
            },
        );
        std::mem::swap(state, &mut scratch.next);
    }

    fn amplification(&self, w_squared: f64, c: f64, h: f64) -> Matrix2<f64> {
        let rates = oscillator(w_squared, c) * h;
        let square = rates * rates;
        Matrix2::identity() + rates + square / 2.0 + square * rates / 6.0 + square * square / 24.0
    }
}
