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

use super::{Integrator, Scratch, euler, oscillator};
use crate::state::State;
use crate::system::System;

pub(super) struct Rk4;

impl Integrator for Rk4 {
    fn step(&self, system: &System, state: &mut State, scratch: &mut Scratch, h: f64) {
        let [s1, s2, s3] = &mut scratch.stages;
        let s = &*state;
        system.advance(s, s1, &mut scratch.observed, euler(s, 0.5 * h, 0.0));
        system.advance(s1, s2, &mut scratch.observed, euler(s, 0.5 * h, 0.5));
        system.advance(s2, s3, &mut scratch.observed, euler(s, h, 0.5));
        mean(s, s1, s2, s3);
        system.advance(s3, &mut scratch.next, &mut scratch.observed, euler(s1, h / 6.0, 1.0));
        std::mem::swap(state, &mut scratch.next);
    }

    fn amplification(&self, w_squared: f64, c: f64, h: f64) -> Matrix2<f64> {
        let rates = oscillator(w_squared, c) * h;
        let square = rates * rates;
        Matrix2::identity() + rates + square / 2.0 + square * rates / 6.0 + square * square / 24.0
    }
}

/// Puts `(s1 + 2 s2 + s3 - s)/3` in the place of s1.
fn mean(s: &State, s1: &mut State, s2: &State, s3: &State) {
    let of = [
        (&s.position, &mut s1.position, &s2.position, &s3.position),
        (&s.velocity, &mut s1.velocity, &s2.velocity, &s3.velocity),
    ];
    for (s, s1, s2, s3) in of {
        for axis in 0..3 {
            let (s, s1, s2, s3) = (&s.0[axis], &mut s1.0[axis], &s2.0[axis], &s3.0[axis]);
            for (i, one) in s1.iter_mut().enumerate() {
                // Differences from s first: they are small, and their rounding with them.
                *one = s[i] + ((*one - s[i]) + 2.0 * (s2[i] - s[i]) + (s3[i] - s[i])) / 3.0;
            }
        }
    }
}
