//! The forces on all particles, and the one way to use them: all are computed before any particle moves.
//!
//! ```text
//! a_i = g + (sum of springs + wind - ka v_i) / m_i       (m/s²)     for a particle that is free
//! a_i = 0                                                           for one that is pinned
//! ```

use std::cell::Cell;

use boucle_geometry::Vector;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::cloth::Cloth;
use crate::force::{Air, AirScratch, Wind};
use crate::kernel::{CHUNK, ChunkVectors, Layout, Windows, add_spring_forces};
use crate::state::{Coordinates, State};

/// Everything that acts on the particles; only pins change.
#[derive(Debug)]
pub(crate) struct System {
    pub(crate) layout: Layout,
    pub(crate) air: Air,
    pub(crate) gravity: Vector,
    /// kg, of pinned particles too.
    pub(crate) masses: Vec<f64>,
    /// 1/m (1/kg), 0 where pinned.
    pub(crate) inverse_masses: Vec<f64>,
    /// Viscous air damping (N·s/m) of each particle.
    pub(crate) air_damping: Vec<f64>,
    arch: Arch,
}

/// One axis of one chunk, as an integrator's update sees it. All slices run over the same particles.
pub(crate) struct Axis<'a> {
    /// Which axis: 0, 1, 2.
    pub(crate) index: usize,
    /// First particle of the chunk.
    pub(crate) first: usize,
    /// Acceleration (m/s²) at the state that was evaluated.
    pub(crate) acceleration: &'a [f64],
    /// Positions (m) to fill.
    pub(crate) position: &'a mut [f64],
    /// Velocities (m/s) to fill.
    pub(crate) velocity: &'a mut [f64],
}

impl Axis<'_> {
    /// The same particles' and axis' part of other coordinates.
    #[inline(always)]
    pub(crate) fn of<'a>(&self, coordinates: &'a Coordinates) -> &'a [f64] {
        &coordinates.0[self.index][self.first..][..self.acceleration.len()]
    }
}

impl System {
    pub(crate) fn new(cloths: &[Cloth], winds: Vec<Wind>, gravity: Vector) -> Self {
        let masses: Vec<f64> = cloths.iter().flat_map(|cloth| cloth.masses.clone()).collect();
        let air_damping = cloths
            .iter()
            .flat_map(|cloth| std::iter::repeat_n(cloth.material.air_damping, cloth.masses.len()));
        Self {
            layout: Layout::new(cloths),
            air: Air::new(winds, cloths),
            gravity,
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

    pub(crate) fn set_pinned(&mut self, particle: usize, is_pinned: bool) {
        self.inverse_masses[particle] = if is_pinned { 0.0 } else { 1.0 / self.masses[particle] };
    }

    /// Evaluates the accelerations at `at` and lets `update` fill `out`, chunk by chunk and axis by axis.
    pub(crate) fn advance(
        &self,
        at: &State,
        out: &mut State,
        air: &mut AirScratch,
        update: impl Fn(Axis<'_>) + Sync,
    ) {
        if !self.air.is_still() {
            self.air.observe(at, air);
        }
        let air = &*air;
        let [x, y, z] = out.position.0.each_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        let [u, v, w] = out.velocity.0.each_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        let chunks = (x, y, z, u, v, w).into_par_iter().enumerate();
        chunks.for_each(|(chunk, (x, y, z, u, v, w))| {
            let mut windows = WINDOWS.take();
            let out = [(x, u), (y, v), (z, w)];
            let windows_now = &mut windows;
            self.arch.dispatch(Task {
                system: self,
                chunk,
                at,
                air,
                out,
                windows: windows_now,
                update: &update,
            });
            WINDOWS.set(windows);
        });
    }

    #[inline(always)]
    fn accelerations<S: Simd>(
        &self,
        simd: S,
        chunk: usize,
        at: &State,
        air: &AirScratch,
        windows: &mut Windows,
        out: &mut ChunkVectors,
    ) {
        add_spring_forces(simd, &self.layout, chunk, at, windows, out);
        if !self.air.is_still() {
            self.air.add_forces(chunk, at, air, out);
        }
        let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(self.masses.len());
        let inverse_masses = &self.inverse_masses[range.clone()];
        let damping = &self.air_damping[range.clone()];
        for (axis, out) in out.iter_mut().enumerate() {
            let velocity = &at.velocity.0[axis][range.clone()];
            let gravity = self.gravity[axis];
            for i in 0..velocity.len() {
                let free_fall = if inverse_masses[i] > 0.0 { gravity } else { 0.0 };
                out[i] = free_fall + inverse_masses[i] * (out[i] - damping[i] * velocity[i]);
            }
        }
    }
}

thread_local! {
    static WINDOWS: Cell<Windows> = Cell::default();
}

/// What a thread does at a time: the step of one chunk, compiled once for each set of instructions.
struct Task<'a, Update> {
    system: &'a System,
    chunk: usize,
    at: &'a State,
    air: &'a AirScratch,
    /// Positions and velocities to fill, axis by axis.
    out: [(&'a mut [f64], &'a mut [f64]); 3],
    windows: &'a mut Windows,
    update: &'a Update,
}

impl<Update: Fn(Axis<'_>)> WithSimd for Task<'_, Update> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { system, chunk, at, air, out, windows, update } = self;
        let mut acceleration: ChunkVectors = [[0.0; CHUNK]; 3];
        system.accelerations(simd, chunk, at, air, windows, &mut acceleration);
        for (axis, (position, velocity)) in out.into_iter().enumerate() {
            let count = position.len();
            let acceleration = &acceleration[axis][..count];
            let first = chunk * CHUNK;
            update(Axis {
                index: axis,
                first,
                acceleration,
                position,
                velocity: &mut velocity[..count],
            });
        }
    }
}
