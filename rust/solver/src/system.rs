//! The forces on all particles, and the one way to use them: all are computed before any particle moves.
//!
//! ```text
//! a_i = g + (sum of springs + goals + wind, fields, pressure and water - ka v_i) / m_i   (m/s²)   for a particle that is free
//! a_i = 0                                                                           for one that is pinned
//! ```

use std::ops::Range;

use boucle_geometry::Vector;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::cloth::Cloth;
use crate::fabric::{FabricScratch, Fabrics};
use crate::force::{Air, AirScratch, Water, Wind};
use crate::goals::Goals;
use crate::kernel::{BLOCK, CHUNK, Layout, Sums, add_from_inside, add_from_outside};
use crate::state::State;

/// Everything that acts on the particles; only what holds them changes.
#[derive(Debug)]
pub(crate) struct System {
    pub(crate) layout: Layout,
    pub(crate) fabrics: Fabrics,
    pub(crate) air: Air,
    pub(crate) gravity: Vector,
    pub(crate) goals: Goals,
    /// kg, of pinned particles too.
    pub(crate) masses: Vec<f64>,
    /// 1/m (1/kg), 0 where pinned.
    pub(crate) inverse_masses: Vec<f64>,
    /// Viscous air damping (N·s/m) of each particle.
    pub(crate) air_damping: Vec<f64>,
    arch: Arch,
}

/// What faces and hinges do in the state whose forces were last evaluated.
#[derive(Debug, Default)]
pub(crate) struct Observed {
    pub(crate) fabric: FabricScratch,
    pub(crate) air: AirScratch,
}

/// How particles move by their accelerations a: what every integrator is made of.
///
/// ```text
/// v' = v + kick a        x' = x + drift r
/// ```
#[derive(Clone, Copy)]
pub(crate) struct Motion<'a> {
    /// x and v: where particles move from.
    pub(crate) from: &'a State,
    /// Seconds.
    pub(crate) kick: f64,
    /// Seconds.
    pub(crate) drift: f64,
    pub(crate) rate: Rate,
    /// When, in parts of the step, the state is whose accelerations are evaluated.
    pub(crate) stage: f64,
}

/// The velocity r by which positions move.
#[derive(Clone, Copy)]
pub(crate) enum Rate {
    /// That of the state whose accelerations are evaluated.
    Evaluated,
    /// v'
    New,
}

impl System {
    pub(crate) fn new(
        cloths: &[Cloth],
        winds: Vec<Wind>,
        water: Option<Water>,
        gravity: Vector,
    ) -> Self {
        let masses: Vec<f64> = cloths.iter().flat_map(|cloth| cloth.masses.clone()).collect();
        let air_damping = cloths
            .iter()
            .flat_map(|cloth| std::iter::repeat_n(cloth.material.air_damping, cloth.masses.len()));
        Self {
            layout: Layout::new(cloths),
            fabrics: Fabrics::new(cloths),
            air: Air::new(winds, water, cloths, &gravity),
            gravity,
            goals: Goals::default(),
            inverse_masses: masses.iter().map(|mass| 1.0 / mass).collect(),
            air_damping: air_damping.collect(),
            masses,
            arch: Arch::new(),
        }
    }

    pub(crate) fn particle_count(&self) -> usize {
        self.masses.len()
    }

    pub(crate) fn is_pinned(&self, particle: usize) -> bool {
        self.inverse_masses[particle] == 0.0
    }

    /// Whether anything keeps a particle in its place, hard or soft.
    pub(crate) fn is_held(&self, particle: usize) -> bool {
        self.is_pinned(particle) || self.goals.draw(particle as u32)
    }

    /// Takes this gravity (m/s²).
    pub(crate) fn set_gravity(&mut self, gravity: Vector) {
        self.gravity = gravity;
        self.air.set_gravity(&gravity);
    }

    /// Weighs all particles anew with the water that they have taken up; cloths say what they are dry.
    pub(crate) fn weigh(&mut self, cloths: &[Cloth]) {
        let Some(sea) = &self.air.sea else { return };
        let dry: Vec<f64> = cloths.iter().flat_map(|cloth| cloth.masses.iter().copied()).collect();
        for (particle, heavier) in sea.heavier() {
            self.masses[particle] = dry[particle] * heavier;
            if self.inverse_masses[particle] > 0.0 {
                self.inverse_masses[particle] = 1.0 / self.masses[particle];
            }
        }
    }

    pub(crate) fn set_pinned(&mut self, particle: usize, is_pinned: bool) {
        self.inverse_masses[particle] = if is_pinned { 0.0 } else { 1.0 / self.masses[particle] };
    }

    /// Evaluates the accelerations at `at` and fills `out` with where they move the particles.
    pub(crate) fn advance(
        &self,
        at: &State,
        out: &mut State,
        observed: &mut Observed,
        motion: Motion<'_>,
    ) {
        self.air.observe(at, &mut observed.air);
        self.fabrics.observe(at, &mut observed.fabric);
        let observed = &*observed;
        let [x, y, z] = out.position.0.each_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        let [u, v, w] = out.velocity.0.each_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        let chunks = (x, y, z, u, v, w).into_par_iter().enumerate();
        chunks.for_each(|(chunk, (x, y, z, u, v, w))| {
            let out = [(x, u), (y, v), (z, w)];
            self.arch.dispatch(Task { system: self, chunk, at, observed, motion, out });
        });
    }
}

/// What a thread does at a time: the step of one chunk, compiled once for each set of instructions.
struct Task<'a> {
    system: &'a System,
    chunk: usize,
    at: &'a State,
    observed: &'a Observed,
    motion: Motion<'a>,
    /// Positions and velocities to fill, axis by axis.
    out: [(&'a mut [f64], &'a mut [f64]); 3],
}

impl WithSimd for Task<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let Self { system, chunk, at, .. } = self;
        let mut sums = Sums::zeros();
        if !system.air.is_still() {
            system.air.add_forces(chunk, at, &self.observed.air, &mut sums.arriving);
        }
        if !system.fabrics.is_empty() {
            let observed = &self.observed.fabric;
            system.fabrics.add_forces(simd, chunk, at, observed, &mut sums.arriving);
        }
        if !system.goals.is_empty() {
            system.goals.add_forces(chunk, at, self.motion.stage, &mut sums.arriving);
        }
        add_from_outside(simd, &system.layout, chunk, at, &mut sums);
        let end = ((chunk + 1) * CHUNK).min(at.len());
        for start in (chunk * CHUNK..end).step_by(BLOCK) {
            let block = start..end.min(start + BLOCK);
            add_from_inside(simd, &system.layout, chunk, &block, at, &mut sums);
            self.advance(&block, &sums);
        }
    }
}

impl Task<'_> {
    /// Moves the particles of a block, whose sums are whole.
    #[inline(always)]
    fn advance(&mut self, block: &Range<usize>, sums: &Sums) {
        match self.motion.rate {
            Rate::Evaluated => self.advance_by(block, sums, |evaluated, _| evaluated),
            Rate::New => self.advance_by(block, sums, |_, new| new),
        }
    }

    #[inline(always)]
    fn advance_by(&mut self, block: &Range<usize>, sums: &Sums, rate: impl Fn(f64, f64) -> f64) {
        let Self { system, at, motion, .. } = *self;
        let Motion { from, kick, drift, .. } = motion;
        let inverse_masses = &system.inverse_masses[block.clone()];
        let damping = &system.air_damping[block.clone()];
        let first = self.chunk * CHUNK;
        let places = block.start - first..block.end - first;
        for (axis, (position, velocity)) in self.out.iter_mut().enumerate() {
            let gravity = system.gravity[axis];
            let [leaving, arriving] =
                [&sums.leaving, &sums.arriving].map(|sums| &sums[axis][places.clone()]);
            let [evaluated, x, v] = [&at.velocity, &from.position, &from.velocity]
                .map(|coordinates| &coordinates.0[axis][block.clone()]);
            let [position, velocity] = [position, velocity].map(|out| &mut out[places.clone()]);
            for i in 0..leaving.len() {
                let force = (arriving[i] - leaving[i]) - damping[i] * evaluated[i];
                let free_fall = if inverse_masses[i] > 0.0 { gravity } else { 0.0 };
                let new = v[i] + kick * (free_fall + inverse_masses[i] * force);
                velocity[i] = new;
                position[i] = x[i] + drift * rate(evaluated[i], new);
            }
        }
    }
}
