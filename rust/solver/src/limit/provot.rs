//! Provot's correction: after each step, the ends of every stretch and shear spring that is too long are moved back
//! to its allowed length, spring after spring, once.
//!
//! ```text
//! excess = |d| - (1 + rate) L0
//! x_i -= w_i/(w_i + w_j) excess n        x_j += w_j/(w_i + w_j) excess n        v += (move of x)/h
//! ```
//!
//! The velocity follows the positions, as it does by itself in the Verlet schemes that this correction is used with:
//! were it kept, gravity would go on adding to it, and the sheet bursts within frames. One pass does not undo what its
//! own moves stretch again, so the limit is approached, not held.
//!
//! Source: Provot 1995.

use crate::cloth::Cloth;
use crate::law::Spring;
use crate::material::SpringKind;
use crate::state::State;

fn is_limited(spring: &Spring) -> bool {
    matches!(spring.kind, SpringKind::Stretch | SpringKind::Shear)
}

#[derive(Debug)]
pub(crate) struct Provot {
    pub(super) base: u32,
    springs: Vec<Limited>,
}

#[derive(Clone, Copy, Debug)]
struct Limited {
    ends: [u32; 2],
    longest: f64,
}

impl Provot {
    pub(crate) fn new(cloth: &Cloth, base: u32) -> Self {
        let allowed = 1.0 + cloth.material.deformation_rate;
        let springs = cloth.springs.iter().filter(|spring| is_limited(spring));
        let limited = springs.map(|spring| Limited {
            ends: spring.ends.map(|end| end + base),
            longest: allowed * spring.rest_length,
        });
        Self { base, springs: limited.collect() }
    }

    /// Takes the present rest lengths of a cloth's springs.
    pub(super) fn follow_rest_lengths(&mut self, springs: &[Spring], allowed: f64) {
        let limited = springs.iter().filter(|spring| is_limited(spring));
        for (own, spring) in self.springs.iter_mut().zip(limited) {
            own.longest = allowed * spring.rest_length;
        }
    }

    pub(crate) fn apply(&self, state: &mut State, inverse_masses: &[f64], h: f64) {
        for &Limited { ends: [a, b], longest } in &self.springs {
            let squared = state.position.distance_squared(a, b);
            if !(squared > longest * longest) {
                continue;
            }
            let [wa, wb] = [a, b].map(|end| inverse_masses[end as usize]);
            if wa + wb == 0.0 {
                continue;
            }
            let back = (1.0 - longest / squared.sqrt()) / (wa + wb);
            for (axis, speeds) in state.position.0.iter_mut().zip(&mut state.velocity.0) {
                let span = axis[a as usize] - axis[b as usize];
                for (end, give) in [(a, -wa), (b, wb)] {
                    axis[end as usize] += give * back * span;
                    speeds[end as usize] += give * back * span / h;
                }
            }
        }
    }
}
