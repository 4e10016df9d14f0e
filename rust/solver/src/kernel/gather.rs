//! Springs that lie nowhere in particular.

use pulp::Simd;

use super::lanes::{Lanes, difference, vectors, vectors_mut};
use super::layout::{GATHERED, Gather, GatherSlot};
use super::{CHUNK, ChunkVectors};
use crate::law::spring::{Damping, Pull, Terms};
use crate::state::{Coordinates, State};

/// A vector for each gathered particle, an array an axis.
type Gathered = [[f64; GATHERED]; 3];

/// Adds the forces of gathered springs on the particles of a chunk.
#[inline(always)]
pub(super) fn add_gather<S: Simd, T: Terms>(
    simd: S,
    gather: &Gather,
    slots: &[GatherSlot],
    chunk: usize,
    state: &State,
    force: &mut ChunkVectors,
) {
    let mut total: Gathered = [[0.0; GATHERED]; 3];
    let at = pick(&state.position, &gather.particles);
    let moving = pick_velocity::<T>(state, &gather.particles);
    for slot in slots {
        let other = pick(&state.position, &slot.neighbors);
        let other_moving = pick_velocity::<T>(state, &slot.neighbors);
        for i in 0..GATHERED / S::F64_LANES {
            let lanes = |numbers: &[f64; GATHERED]| Lanes::of(simd, vectors::<S>(numbers)[i]);
            let pull = Pull {
                rest_length: lanes(&slot.rest_lengths),
                stiffness: lanes(&slot.stiffness),
                damping: lanes(&slot.damping),
                stiffen_beyond: Lanes::splat(simd, gather.law.stiffen_beyond),
            };
            let span = difference(simd, vector::<S>(&at, i), vector::<S>(&other, i));
            let velocity = difference(simd, vector::<S>(&moving, i), vector::<S>(&other_moving, i));
            let on_neighbor = pull.on_other::<T>(span, velocity);
            for (total, force) in total.iter_mut().zip(on_neighbor) {
                let total = &mut vectors_mut::<S>(total)[i];
                *total = (Lanes::of(simd, *total) - force).values;
            }
        }
    }
    for i in 0..gather.count {
        for axis in 0..3 {
            force[axis][gather.particles[i] as usize - chunk * CHUNK] += total[axis][i];
        }
    }
}

#[inline(always)]
fn pick(coordinates: &Coordinates, particles: &[u32; GATHERED]) -> Gathered {
    coordinates.0.each_ref().map(|axis| particles.map(|particle| axis[particle as usize]))
}

/// Velocities, for a law that asks for them.
#[inline(always)]
fn pick_velocity<T: Terms>(state: &State, particles: &[u32; GATHERED]) -> Gathered {
    if T::DAMPING == Damping::None {
        [[0.0; GATHERED]; 3]
    } else {
        pick(&state.velocity, particles)
    }
}

#[inline(always)]
fn vector<S: Simd>(gathered: &Gathered, i: usize) -> [S::f64s; 3] {
    gathered.each_ref().map(|axis| vectors::<S>(axis)[i])
}
