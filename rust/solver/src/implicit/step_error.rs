//! The error of a step, by which the number of steps is chosen.

use super::Implicit;
use crate::contact::Contacts;
use crate::state::State;

impl Implicit {
    /// By how much (m, root mean square) a step differs from the one that goes on with the acceleration of the last. What
    /// is touched changes its acceleration at once, however short the step: it does not count.
    pub(super) fn error(&self, state: &State, contacts: &Contacts, h: f64) -> f64 {
        let touched = contacts.matrix.particles();
        let count = state.len() - touched.len();
        if self.memory.step == 0.0 || count == 0 {
            return 0.0;
        }
        let old = &self.memory.before;
        let gain = 0.5 * h * h / self.memory.step;
        let mut sum = 0.0_f64;
        for axis in 0..3 {
            let [x, v] = [&state.position.0[axis][..], &state.velocity.0[axis]];
            let [now, ov] = [&self.at.position.0[axis][..x.len()], &old.velocity.0[axis]];
            let (v, ov) = (&v[..x.len()], &ov[..x.len()]);
            let of = |i: usize| (now[i] - (x[i] + h * v[i] + gain * (v[i] - ov[i]))).powi(2);
            sum += (0..x.len()).map(of).sum::<f64>();
            sum -= touched.iter().map(|&particle| of(particle as usize)).sum::<f64>();
        }
        (sum.max(0.0) / count as f64).sqrt()
    }
}
