//! Position and velocity correction: edges that are too long get back to their allowed length and their ends stop
//! separating.
//!
//! ```text
//! excess = |d| - (1 + rate) L0          x_near += p_near excess n       x_far -= p_far excess n
//! s = (v_far - v_near)·n, if s > 0      v_near += q_near s n            v_far  -= q_far s n
//! ```
//!
//! with n from near to far and p and q summing to 1. Where a piece hangs on pins, edges are taken outward from them
//! and the end nearer to a pin gives way by a tenth of what the farther does: one sweep then carries a whole hanging
//! cloth. An edge that a move has made too long again is taken again, in the same sweep if it lies farther out. Where
//! nothing is pinned both ends give way by their inverse masses, and momentum is kept. Velocities are corrected once,
//! after positions, and by inverse masses wherever the outward weights would add kinetic energy.
//!
//! Adding the whole displacement over the step to the velocity would pump energy; only the separating part of the
//! relative velocity is taken away.
//!
//! Source: Zhong & Xu 2009 for position and velocity; the outward order is our own.

use super::order::{Edge, outward};
use crate::cloth::Cloth;
use crate::material::SpringKind;
use crate::state::State;

/// How much the end nearer to a pin gives way where the farther gives way by 1 (measured: 0.1 settles a
/// hanging sheet in the fewest sweeps; 0 leaves edges across the order apart, 1 is plain Gauss-Seidel).
const NEAR_WEIGHT: f64 = 0.1;

/// Elongation beyond the allowed length, relative, that is let pass: a fifth of what is promised at a rate of 10 %.
const SLACK: f64 = 2e-4;

/// Sweeps within a frame, whose errors the next step sees and mends.
const SWEEPS_WITHIN: usize = 4;

/// Sweeps at the end of a frame, whose result is seen; more are of use only where pins force the strain.
const SWEEPS_AT_END: usize = 400;

#[derive(Debug)]
pub(crate) struct Project {
    edges: Vec<Edge>,
    allowed: f64,
    base: u32,
    /// For each particle of the cloth, where its edges begin in `edges_of`, and the end of the last.
    starts: Vec<u32>,
    edges_of: Vec<u32>,
    now: BitSet,
    later: BitSet,
    moved: BitSet,
}

impl Project {
    pub(crate) fn new(cloth: &Cloth, base: u32, inverse_masses: &[f64]) -> Self {
        let stretch = cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Stretch);
        let edges: Vec<_> = stretch.map(|spring| (spring.ends, spring.rest_length)).collect();
        let count = cloth.positions.len();
        let is_pinned = |particle: u32| inverse_masses[(base + particle) as usize] == 0.0;
        let edges = outward(&edges, count, is_pinned);
        let mut of_particle = vec![Vec::new(); count];
        for (rank, edge) in edges.iter().enumerate() {
            of_particle[edge.near as usize].push(rank as u32);
            of_particle[edge.far as usize].push(rank as u32);
        }
        let ends = of_particle.iter().scan(0, |end, edges| {
            *end += edges.len() as u32;
            Some(*end)
        });
        Self {
            allowed: 1.0 + cloth.material.deformation_rate,
            base,
            starts: std::iter::once(0).chain(ends).collect(),
            edges_of: of_particle.concat(),
            now: BitSet::new(edges.len()),
            later: BitSet::new(edges.len()),
            moved: BitSet::new(edges.len()),
            edges,
        }
    }

    pub(crate) fn apply(&mut self, state: &mut State, inverse_masses: &[f64], is_last: bool) {
        if !self.find_too_long(state) {
            return;
        }
        let sweeps = if is_last { SWEEPS_AT_END } else { SWEEPS_WITHIN };
        for _ in 0..sweeps {
            self.sweep_positions(state, inverse_masses);
            std::mem::swap(&mut self.now, &mut self.later);
            if self.now.is_empty() {
                break;
            }
        }
        self.now.clear();
        self.correct_velocities(state, inverse_masses);
        self.moved.clear();
    }

    fn is_too_long(&self, edge: &Edge, state: &State) -> bool {
        let longest = self.allowed * (1.0 + SLACK) * edge.rest_length;
        let [near, far] = [edge.near, edge.far].map(|end| self.base + end);
        state.position.distance_squared(near, far) > longest * longest
    }

    /// Marks every edge that is too long.
    fn find_too_long(&mut self, state: &State) -> bool {
        let mut any = 0;
        for word in 0..self.now.words.len() {
            let edges = &self.edges[64 * word..self.edges.len().min(64 * word + 64)];
            let bits = edges.iter().enumerate().fold(0, |bits, (bit, edge)| {
                bits | u64::from(self.is_too_long(edge, state)) << bit
            });
            self.now.words[word] = bits;
            any |= bits;
        }
        any != 0
    }

    /// Takes the marked edges outward; marks for later those farther in that a move has touched.
    fn sweep_positions(&mut self, state: &mut State, inverse_masses: &[f64]) {
        let mut rank = 0;
        while let Some(next) = self.now.take_from(rank) {
            rank = next;
            let edge = self.edges[rank];
            if !self.is_too_long(&edge, state) {
                continue;
            }
            let [near, far] = [edge.near, edge.far].map(|end| (self.base + end) as usize);
            let Some([give_near, give_far]) = shares(&edge, near, far, inverse_masses) else {
                continue;
            };
            let length = state.position.distance_squared(near as u32, far as u32).sqrt();
            let back = 1.0 - self.allowed * edge.rest_length / length;
            for axis in &mut state.position.0 {
                let span = axis[far] - axis[near];
                axis[near] += give_near * back * span;
                axis[far] -= give_far * back * span;
            }
            self.moved.insert(rank);
            for end in [edge.near, edge.far] {
                let edges =
                    self.starts[end as usize] as usize..self.starts[end as usize + 1] as usize;
                for &touched in &self.edges_of[edges] {
                    let touched = touched as usize;
                    if touched > rank { &mut self.now } else { &mut self.later }.insert(touched);
                }
            }
        }
    }

    /// Takes the separating velocity from every edge that was moved, outward.
    fn correct_velocities(&mut self, state: &mut State, inverse_masses: &[f64]) {
        let mut rank = 0;
        while let Some(next) = self.moved.take_from(rank) {
            rank = next;
            let edge = self.edges[rank];
            let [near, far] = [edge.near, edge.far].map(|end| (self.base + end) as usize);
            let Some(outward) = shares(&edge, near, far, inverse_masses) else { continue };
            let normal = (state.position.get(far) - state.position.get(near)).normalize();
            let [near_speed, far_speed] =
                [near, far].map(|end| state.velocity.get(end).dot(&normal));
            let separation = far_speed - near_speed;
            if !(separation > 0.0) {
                continue;
            }
            let [wn, wf] = [inverse_masses[near], inverse_masses[far]];
            let [qn, qf] = if adds_energy(outward, [wn, wf], near_speed, far_speed) {
                [wn / (wn + wf), wf / (wn + wf)]
            } else {
                outward
            };
            for axis in 0..3 {
                state.velocity.0[axis][near] += qn * separation * normal[axis];
                state.velocity.0[axis][far] -= qf * separation * normal[axis];
            }
        }
    }
}

/// By which parts of a correction the two ends of an edge give way; none if both are pinned.
fn shares(edge: &Edge, near: usize, far: usize, inverse_masses: &[f64]) -> Option<[f64; 2]> {
    let nearness = if edge.hangs { NEAR_WEIGHT } else { 1.0 };
    let weights = [nearness * inverse_masses[near], inverse_masses[far]];
    let sum = weights[0] + weights[1];
    (sum > 0.0).then(|| weights.map(|weight| weight / sum))
}

/// Whether taking away the separating speed by these shares would add kinetic energy.
fn adds_energy(shares: [f64; 2], inverse_masses: [f64; 2], near: f64, far: f64) -> bool {
    if inverse_masses.contains(&0.0) {
        return false;
    }
    let separation = far - near;
    let (near_after, far_after) = (near + shares[0] * separation, far - shares[1] * separation);
    let gain_near = (near_after * near_after - near * near) / inverse_masses[0];
    let gain_far = (far_after * far_after - far * far) / inverse_masses[1];
    gain_near + gain_far > 0.0
}

/// Marks on edges, by rank.
#[derive(Debug)]
struct BitSet {
    words: Vec<u64>,
}

impl BitSet {
    fn new(count: usize) -> Self {
        Self { words: vec![0; count.div_ceil(64)] }
    }

    fn insert(&mut self, index: usize) {
        self.words[index / 64] |= 1 << (index % 64);
    }

    fn clear(&mut self) {
        self.words.fill(0);
    }

    fn is_empty(&self) -> bool {
        self.words.iter().all(|&word| word == 0)
    }

    /// Removes and returns the first mark at or after an index.
    fn take_from(&mut self, index: usize) -> Option<usize> {
        let mut word = index / 64;
        let mut bits = self.words.get(word)? & (!0 << (index % 64));
        while bits == 0 {
            word += 1;
            bits = *self.words.get(word)?;
        }
        let bit = bits.trailing_zeros() as usize;
        self.words[word] &= !(1 << bit);
        Some(64 * word + bit)
    }
}
