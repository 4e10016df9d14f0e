//! What an implicit step starts from: the states before it.
//!
//! ```text
//! implicit Euler   base = x0                v_base = v0                h' = h
//! BDF2             base = a x0 - b x1       v_base = a v0 - b v1       h' = c h
//!                  a = (1 + w)²/(1 + 2w)    b = w²/(1 + 2w)    c = (1 + w)/(1 + 2w)
//! ```
//!
//! with 0 the last state, 1 the one before, and w the ratio of this step to the last; equal steps have a = 4/3,
//! b = 1/3, c = 2/3. BDF2's first step, and one after a jump, is implicit Euler's.
//!
//! Source: Gear 1971 for the formula of varying steps.

use crate::state::State;

/// What the next step depends on besides the present state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Memory {
    /// The state before the last.
    pub(crate) before: State,
    /// Length (s) of the step from it to the last; 0 if there is none.
    pub(crate) step: f64,
    /// Tension (N) of each edge at its allowed length, see `taut`.
    pub(crate) tensions: Vec<f64>,
    /// Sum of the errors (m) of the steps since the frame began.
    pub(crate) error: f64,
    /// Steps that the error of the last frame asks for; 0 if there was none.
    pub(crate) substeps: u32,
}

impl Memory {
    pub(crate) fn new(state: &State, edge_count: usize) -> Self {
        let tensions = vec![0.0; edge_count];
        Self { before: state.clone(), step: 0.0, tensions, error: 0.0, substeps: 0 }
    }

    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.before.copy_from(&other.before);
        self.tensions.copy_from_slice(&other.tensions);
        (self.step, self.error, self.substeps) = (other.step, other.error, other.substeps);
    }

    /// Error (m) of each of so many steps of the frame, on average.
    pub(crate) fn mean_error(&self, substeps: u32) -> f64 {
        self.error / f64::from(substeps)
    }

    /// Forgets all that led to the present state.
    pub(crate) fn clear(&mut self) {
        self.tensions.fill(0.0);
        (self.step, self.error, self.substeps) = (0.0, 0.0, 0);
    }
}

/// The factors of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Formula {
    /// Of the last state.
    pub(crate) last: f64,
    /// Of the state before the last.
    pub(crate) before: f64,
    /// h' (s).
    pub(crate) step: f64,
}

impl Formula {
    pub(crate) fn implicit_euler(h: f64) -> Self {
        Self { last: 1.0, before: 0.0, step: h }
    }

    /// BDF2 with steps of h seconds after one of `last_step` seconds.
    pub(crate) fn bdf2(h: f64, last_step: f64) -> Self {
        let w = h / last_step;
        let whole = 1.0 + 2.0 * w;
        Self {
            last: (1.0 + w) * (1.0 + w) / whole,
            before: -w * w / whole,
            step: h * (1.0 + w) / whole,
        }
    }
}
