//! Goal springs: particles drawn to points that move.
//!
//! ```text
//! F = k (y - x) + c (y' - v)        y' = (to - from)/duration of the frame
//! ```
//!
//! with the goal y on the straight line from where the last frame left it to where it is to be at the end of this one.
//! Tangents are k and c on the
//! diagonal: they are part of an implicit step like inertia, whatever their size.

use boucle_geometry::Vector;

use crate::kernel::{CHUNK, ChunkVectors};
use crate::state::State;

/// A goal spring over one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Goal {
    pub(crate) particle: u32,
    /// (N/m)
    pub(crate) stiffness: f64,
    /// (N·s/m)
    pub(crate) damping: f64,
    /// Where the goal is at the frame's start and end (m).
    pub(crate) from: Vector,
    pub(crate) to: Vector,
}

/// All goal springs, by particle; there may be several at one.
#[derive(Debug, Default)]
pub(crate) struct Goals {
    springs: Vec<Goal>,
    /// How far through the frame the present step begins, and its part of it.
    step: [f64; 2],
    /// Length of a frame (s).
    duration: f64,
}

impl Goals {
    pub(crate) fn new(goals: impl Iterator<Item = Goal>, duration: f64) -> Self {
        let mut goals: Vec<_> = goals.filter(|goal| goal.stiffness > 0.0).collect();
        goals.sort_by_key(|goal| goal.particle);
        Self { springs: goals, step: [0.0; 2], duration }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.springs.is_empty()
    }

    /// The particles that are drawn, in order.
    pub(crate) fn particles(&self) -> impl Iterator<Item = u32> {
        self.springs.iter().map(|goal| goal.particle)
    }

    /// Whether a particle is drawn.
    pub(crate) fn draw(&self, particle: u32) -> bool {
        self.springs.binary_search_by_key(&particle, |goal| goal.particle).is_ok()
    }

    /// Whether the springs are the same, wherever their goals are.
    pub(crate) fn are_as_stiff_as(&self, other: &Self) -> bool {
        let springs = |goal: &Goal| (goal.particle, goal.stiffness, goal.damping);
        self.springs.iter().map(springs).eq(other.springs.iter().map(springs))
    }

    /// Begins a step of a frame: its number, from 1, of how many.
    pub(crate) fn start_step(&mut self, number: u32, count: u32) {
        let count = f64::from(count);
        self.step = [f64::from(number - 1) / count, 1.0 / count];
    }

    /// Adds the forces (N) on the particles of a chunk, in a state at a stage of the step (0 its start, 1 its end).
    pub(crate) fn add_forces(
        &self,
        chunk: usize,
        at: &State,
        stage: f64,
        forces: &mut ChunkVectors,
    ) {
        let part = self.step[0] + stage * self.step[1];
        let first = chunk * CHUNK;
        let begin = self.springs.partition_point(|goal| (goal.particle as usize) < first);
        for goal in &self.springs[begin..] {
            let particle = goal.particle as usize;
            if particle >= first + CHUNK {
                break;
            }
            let way = goal.to - goal.from;
            let ahead = goal.from + part * way - at.position.get(particle);
            let faster = way / self.duration - at.velocity.get(particle);
            let force = goal.stiffness * ahead + goal.damping * faster;
            for (axis, force) in forces.iter_mut().zip(force.iter()) {
                axis[particle - first] += force;
            }
        }
    }

    /// `k + c/h` (kg/s²) of each spring, by particle.
    pub(crate) fn tangents(&self, h: f64) -> impl Iterator<Item = (usize, f64)> {
        let tangent = move |goal: &Goal| goal.stiffness + goal.damping / h;
        self.springs.iter().map(move |goal| (goal.particle as usize, tangent(goal)))
    }

    /// Energy (J) between two frames, of springs on these particles.
    pub(crate) fn energy(&self, particles: std::ops::Range<usize>, state: &State) -> f64 {
        let energy = |goal: &Goal| {
            let away = state.position.get(goal.particle as usize) - goal.from;
            0.5 * goal.stiffness * away.norm_squared()
        };
        let own = self.springs.iter().filter(|goal| particles.contains(&(goal.particle as usize)));
        own.map(energy).sum()
    }

    /// The largest k/m (1/s²) and c/m (1/s) of a particle, and the smallest c/k (s) of a spring; zeros if there is none.
    pub(crate) fn largest_rates(&self, inverse_masses: &[f64]) -> [f64; 3] {
        let (mut stiffness, mut damping, mut ratio) = (0.0_f64, 0.0_f64, f64::INFINITY);
        for goals in self.springs.chunk_by(|a, b| a.particle == b.particle) {
            let inverse = inverse_masses[goals[0].particle as usize];
            stiffness =
                stiffness.max(inverse * goals.iter().map(|goal| goal.stiffness).sum::<f64>());
            damping = damping.max(inverse * goals.iter().map(|goal| goal.damping).sum::<f64>());
            ratio = goals.iter().map(|goal| goal.damping / goal.stiffness).fold(ratio, f64::min);
        }
        [stiffness, damping, if ratio.is_finite() { ratio } else { 0.0 }]
    }

    /// Ends a frame: all goals are where they were to be, and rest there.
    pub(crate) fn end_frame(&mut self) {
        for goal in &mut self.springs {
            goal.from = goal.to;
        }
    }
}
