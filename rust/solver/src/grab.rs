//! A grip on a few particles, as of a hand: goal springs that need not have been pins.
//!
//! Together they have the stiffness and damping that bring the whole cloth, as one weight, to its goal without swinging:
//!
//! ```text
//! k_i = M w² share_i        c_i = 2 M w share_i
//! ```
//!
//! with the cloth's mass M, and share the weight of a particle by the sum of all. A whole cloth that is lifted by them
//! hangs g/w² below its goal.

use boucle_geometry::Vector;

use crate::cloth::Cloth;
use crate::goals::Goal;
use crate::state::State;

/// w (1/s): a cloth's own weight pulls it 4 mm from its goal, and it follows within 1/w.
const QUICKNESS: f64 = 50.0;

/// What is grabbed; nothing by default.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Grab {
    /// By particle, one a particle.
    pub(crate) goals: Vec<Goal>,
}

impl Grab {
    /// Grabs vertices of a cloth, given their targets (m) at the end of the next frame and weights above 0. Goals begin
    /// where the particles are, or where they were if the same particles were grabbed before.
    pub(crate) fn new(
        cloth: &Cloth,
        base: u32,
        grabbed: impl Iterator<Item = (u32, Vector, f64)> + Clone,
        state: &State,
        before: &Self,
    ) -> Self {
        let total: f64 = grabbed.clone().map(|(_, _, weight)| weight).sum();
        let mass: f64 = cloth.masses.iter().sum();
        let goals = grabbed.map(|(vertex, to, weight)| {
            let particle = base + vertex;
            let share = mass * weight / total;
            let (stiffness, damping) = (share * QUICKNESS * QUICKNESS, 2.0 * share * QUICKNESS);
            Goal { particle, stiffness, damping, from: state.position.get(particle as usize), to }
        });
        let mut goals: Vec<_> = goals.collect();
        goals.sort_by_key(|goal| goal.particle);
        goals.dedup_by_key(|goal| goal.particle);
        let particles = |goals: &[Goal]| goals.iter().map(|goal| goal.particle).collect::<Vec<_>>();
        if particles(&goals) == particles(&before.goals) {
            for (goal, before) in goals.iter_mut().zip(&before.goals) {
                goal.from = before.from;
            }
        }
        Self { goals }
    }

    /// Ends a frame: all goals are where they were to be.
    pub(crate) fn end_frame(&mut self) {
        for goal in &mut self.goals {
            goal.from = goal.to;
        }
    }
}
