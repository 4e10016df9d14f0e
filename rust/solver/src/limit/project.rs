//! Position and velocity correction: both ends of an edge that is too long move back, and their velocities with them.
//!
//! ```text
//! excess = |d| - (1 + rate) L0 > 0
//! x_near += p_near excess n        x_far -= p_far excess n        v += (move of x)/h
//! ```
//!
//! with n from near to far. After each step the edges are swept inward to the pins and outward again, with p by
//! inverse masses: momentum is kept, and a light end feels the weight that hangs on it. The next step starts from
//! where that led, so that many small steps converge together; [`Project::longest_step`] says how small.
//!
//! At the end of a frame, what is left is projected away. Edges are taken outward from the pins, and the end nearer
//! to a pin gives way the less, by a factor of ten for each edge that it is nearer: one sweep then carries a whole
//! hanging cloth. An edge that a move has made too long again is taken again, in the same sweep if
//! it lies farther out. Of the velocity, the ends of moved edges lose only the part by which they separate: the whole
//! move over the step would pump energy.
//!
//! Source: Provot 1995 and Zhong & Xu 2009 for the corrections; the outward metric is our own.

use std::collections::BTreeMap;

use super::marks::BitSet;
use super::order::{Edge, outward};
use crate::cloth::Cloth;
use crate::contact::Walls;
use crate::interrupter::Interrupter;
use crate::law::Spring;
use crate::material::SpringKind;
use crate::state::State;

/// Elongation beyond the allowed length, relative, that is let pass: a fifth of what is promised at a rate of 10 %.
const SLACK: f64 = 2e-4;

/// Deformation rate that steps are made for if the cloth's own is less.
const LEAST_RATE: f64 = 0.01;

/// Sweeps inward and outward after each step.
const SWEEPS: usize = 2;

/// Sweeps at the end of a frame of explicit steps: a hanging sheet takes 3 to 20.
const SWEEPS_AT_END: usize = 480;

/// Sweeps before the metric changes. Where a hanging chain has to swing aside to reach, its near ends must give way
/// too: then sweeps with the ends more even help.
const SWEEPS_OF_A_METRIC: usize = 16;

/// By how much a metric evens out the ends of edges.
#[derive(Clone, Copy, Debug)]
enum Evenness {
    Outward,
    /// Half way, by the logarithm.
    Between,
    /// By inverse masses alone.
    Even,
}

const METRICS: [Evenness; 3] = [Evenness::Outward, Evenness::Between, Evenness::Even];

#[derive(Debug)]
pub(crate) struct Project {
    edges: Vec<Edge>,
    allowed: f64,
    pub(super) base: u32,
    /// For each edge the number of its spring, once rest lengths have changed.
    spring_of: Vec<u32>,
    /// For each particle of the cloth, where its edges begin in `edges_of`, and the end of the last.
    starts: Vec<u32>,
    edges_of: Vec<u32>,
    now: BitSet,
    later: BitSet,
    moved: BitSet,
}

impl Project {
    /// The longest step (s) in which a particle that carries a cloth's whole weight moves by no more than an edge may
    /// get longer: with longer ones the sweeps of a step do not keep up, and end up adding energy.
    pub(crate) fn longest_step(
        cloth: &Cloth,
        gravity: f64,
        rest_lengths: impl Iterator<Item = f64>,
    ) -> f64 {
        let springs = cloth.springs.iter().zip(rest_lengths);
        let (count, length) = springs
            .filter(|(spring, _)| spring.kind == SpringKind::Stretch)
            .fold((0.0, 0.0), |(count, sum), (_, rest_length)| (count + 1.0, sum + rest_length));
        let rate = cloth.material.deformation_rate.max(LEAST_RATE);
        let weight_by_mass = gravity * cloth.masses.len() as f64;
        if count == 0.0 || cloth.pins.is_empty() || weight_by_mass == 0.0 {
            return f64::INFINITY;
        }
        (rate * length / count / weight_by_mass).sqrt()
    }

    pub(crate) fn new(cloth: &Cloth, base: u32, is_held: impl Fn(u32) -> bool) -> Self {
        let stretch = cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Stretch);
        let edges: Vec<_> = stretch.map(|spring| (spring.ends, spring.rest_length)).collect();
        let count = cloth.positions.len();
        let edges = outward(&edges, count, |particle| is_held(base + particle));
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
            spring_of: Vec::new(),
            starts: std::iter::once(0).chain(ends).collect(),
            edges_of: of_particle.concat(),
            now: BitSet::new(edges.len()),
            later: BitSet::new(edges.len()),
            moved: BitSet::new(edges.len()),
            edges,
        }
    }

    /// Takes the present rest lengths of a cloth's springs. The order of the edges stays.
    pub(super) fn follow_rest_lengths(&mut self, springs: &[Spring]) {
        if self.spring_of.is_empty() {
            let numbered = springs.iter().map(|s| (s.kind, s.ends)).zip(0_u32..);
            let number_of: BTreeMap<_, u32> = numbered.collect();
            let spring_of = |edge: &Edge| {
                let (a, b) = (edge.near, edge.far);
                let number = |ends| number_of.get(&(SpringKind::Stretch, ends)).copied();
                number([a, b]).or_else(|| number([b, a])).unwrap_or(u32::MAX)
            };
            self.spring_of = self.edges.iter().map(spring_of).collect();
        }
        for (edge, &number) in self.edges.iter_mut().zip(&self.spring_of) {
            if let Some(spring) = springs.get(number as usize) {
                edge.rest_length = spring.rest_length;
            }
        }
    }

    pub(crate) fn apply(
        &mut self,
        state: &mut State,
        inverse_masses: &[f64],
        h: f64,
        is_last: bool,
        interrupter: &Interrupter,
    ) {
        if !self.find_too_long(state) {
            return;
        }
        for _ in 0..SWEEPS {
            let mut next = self.edges.len();
            while let Some(rank) = self.now.last_before(next) {
                self.correct(rank, state, inverse_masses, h);
                next = rank;
            }
            let mut next = 0;
            while let Some(rank) = self.now.first_from(next) {
                self.correct(rank, state, inverse_masses, h);
                next = rank + 1;
            }
        }
        if is_last {
            let walls = &Walls::default();
            self.project(state, inverse_masses, SWEEPS_AT_END, walls, interrupter);
        }
        self.now.clear();
    }

    /// Projects without the sweeps of explicit steps, and says whether all edges are held.
    pub(crate) fn hold(
        &mut self,
        state: &mut State,
        inverse_masses: &[f64],
        most_sweeps: usize,
        walls: &Walls,
        interrupter: &Interrupter,
    ) -> bool {
        if !self.find_too_long(state) {
            return true;
        }
        let is_held = self.project(state, inverse_masses, most_sweeps, walls, interrupter);
        self.now.clear();
        is_held
    }

    /// Moves the ends of one edge, and their velocities, by inverse masses.
    fn correct(&mut self, rank: usize, state: &mut State, inverse_masses: &[f64], h: f64) {
        let edge = self.edges[rank];
        let [near, far] = self.ends(&edge);
        let squared = state.position.distance_squared(near as u32, far as u32);
        let longest = self.allowed * edge.rest_length;
        let weights = [inverse_masses[near], inverse_masses[far]];
        let sum = weights[0] + weights[1];
        if !(squared > longest * longest) || sum == 0.0 {
            return;
        }
        let back = (1.0 - longest / squared.sqrt()) / sum;
        for (axis, speeds) in state.position.0.iter_mut().zip(&mut state.velocity.0) {
            let span = axis[far] - axis[near];
            for (end, give) in [(near, weights[0]), (far, -weights[1])] {
                let step = give * back * span;
                axis[end] += step;
                speeds[end] += step / h;
            }
        }
        for touched in self.touched(&edge) {
            self.now.insert(self.edges_of[touched] as usize);
        }
    }

    /// Where in `edges_of` the edges at the ends of an edge stand.
    fn touched(&self, edge: &Edge) -> impl Iterator<Item = usize> + use<> {
        let [near, far] = [edge.near, edge.far]
            .map(|end| self.starts[end as usize] as usize..self.starts[end as usize + 1] as usize);
        near.chain(far)
    }

    fn ends(&self, edge: &Edge) -> [usize; 2] {
        [edge.near, edge.far].map(|end| (self.base + end) as usize)
    }

    /// Moves the ends of edges that are still too long.
    fn project(
        &mut self,
        state: &mut State,
        inverse_masses: &[f64],
        most: usize,
        walls: &Walls,
        interrupter: &Interrupter,
    ) -> bool {
        for sweep in 0..most {
            let evenness = METRICS[sweep / SWEEPS_OF_A_METRIC % METRICS.len()];
            self.sweep_positions(state, inverse_masses, evenness, walls);
            std::mem::swap(&mut self.now, &mut self.later);
            if self.now.is_empty() || interrupter.is_asked() {
                break;
            }
        }
        self.correct_velocities(state, inverse_masses);
        self.moved.clear();
        self.now.is_empty()
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
    fn sweep_positions(
        &mut self,
        state: &mut State,
        inverse_masses: &[f64],
        evenness: Evenness,
        walls: &Walls,
    ) {
        let mut rank = 0;
        while let Some(next) = self.now.take_from(rank) {
            rank = next;
            let edge = self.edges[rank];
            if !self.is_too_long(&edge, state) {
                continue;
            }
            let [near, far] = [edge.near, edge.far].map(|end| (self.base + end) as usize);
            let nearness = match evenness {
                Evenness::Outward => edge.nearness,
                Evenness::Between => edge.nearness.sqrt(),
                Evenness::Even => 1.0,
            };
            let edge = Edge { nearness, ..edge };
            let inverse_mass = |end: usize| if walls.stop(end) { 0.0 } else { inverse_masses[end] };
            let Some([give_near, give_far]) = shares(&edge, [near, far].map(inverse_mass)) else {
                continue;
            };
            let length = state.position.distance_squared(near as u32, far as u32).sqrt();
            let back = 1.0 - self.allowed * edge.rest_length / length;
            for axis in &mut state.position.0 {
                let span = axis[far] - axis[near];
                axis[near] += give_near * back * span;
                axis[far] -= give_far * back * span;
            }
            for end in [near, far] {
                walls.keep(end, &mut state.position);
            }
            self.moved.insert(rank);
            for touched in self.touched(&edge) {
                let touched = self.edges_of[touched] as usize;
                if touched > rank { &mut self.now } else { &mut self.later }.insert(touched);
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
            let inverse_masses = [near, far].map(|end| inverse_masses[end]);
            let Some(outward) = shares(&edge, inverse_masses) else { continue };
            let normal = (state.position.get(far) - state.position.get(near)).normalize();
            let [near_speed, far_speed] =
                [near, far].map(|end| state.velocity.get(end).dot(&normal));
            let separation = far_speed - near_speed;
            if !(separation > 0.0) {
                continue;
            }
            let [wn, wf] = inverse_masses;
            let [qn, qf] = if adds_energy(outward, inverse_masses, near_speed, far_speed) {
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
fn shares(edge: &Edge, [near, far]: [f64; 2]) -> Option<[f64; 2]> {
    let weights = [edge.nearness * near, far];
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
