//! The rules that move particles: one file each, the same step for every force.
//!
//! Each also knows how it treats one damped oscillator `x'' = -w² x - c x'`: the 2 x 2 matrix by which a step
//! multiplies (x, v), from which [`crate::stability`] finds the largest stable step.

mod forward_euler;
mod leapfrog;
mod midpoint;
mod rk4;
mod symplectic_euler;
mod verlet;

use nalgebra::Matrix2;

use crate::settings::IntegratorKind;
use crate::state::State;
use crate::system::{Motion, Observed, Rate, System};

/// States that an integrator passes through within a step, kept to save allocations.
#[derive(Debug)]
pub(crate) struct Scratch {
    pub(crate) stages: [State; 3],
    pub(crate) next: State,
    pub(crate) observed: Observed,
}

impl Scratch {
    pub(crate) fn new(state: &State) -> Self {
        Self {
            stages: std::array::from_fn(|_| state.clone()),
            next: state.clone(),
            observed: Observed::default(),
        }
    }
}

/// A rule that moves particles.
pub(crate) trait Integrator: Send + Sync {
    /// Moves `state` by one step of h seconds.
    fn step(&self, system: &System, state: &mut State, scratch: &mut Scratch, h: f64);

    /// The matrix by which a step of h seconds multiplies (x, v) of `x'' = -w² x - c x'`.
    fn amplification(&self, w_squared: f64, c: f64, h: f64) -> Matrix2<f64>;
}

/// The explicit rule of a name; none for the implicit ones, see [`crate::implicit`].
pub(crate) fn explicit(kind: IntegratorKind) -> Option<&'static dyn Integrator> {
    match kind {
        IntegratorKind::ForwardEuler => Some(&forward_euler::ForwardEuler),
        IntegratorKind::SymplecticEuler => Some(&symplectic_euler::SymplecticEuler),
        IntegratorKind::Verlet => Some(&verlet::Verlet),
        IntegratorKind::Leapfrog => Some(&leapfrog::Leapfrog),
        IntegratorKind::Midpoint => Some(&midpoint::Midpoint),
        IntegratorKind::Rk4 => Some(&rk4::Rk4),
        IntegratorKind::ImplicitEuler | IntegratorKind::Bdf2 => None,
    }
}

/// `from + h rate`, of which Runge-Kutta rules are made, with the rate of a state at a stage of the step.
fn euler(from: &State, h: f64, stage: f64) -> Motion<'_> {
    Motion { from, kick: h, drift: h, rate: Rate::Evaluated, stage }
}

/// The matrix of `(x, v)' = (v, -w² x - c v)`.
fn oscillator(w_squared: f64, c: f64) -> Matrix2<f64> {
    Matrix2::new(0.0, 1.0, -w_squared, -c)
}

/// The matrix of a drift, `x += h v`.
fn drift(h: f64) -> Matrix2<f64> {
    Matrix2::new(1.0, h, 0.0, 1.0)
}

/// The matrix of a kick, `v += h a`.
fn kick(w_squared: f64, c: f64, h: f64) -> Matrix2<f64> {
    Matrix2::new(1.0, 0.0, -h * w_squared, 1.0 - h * c)
}
