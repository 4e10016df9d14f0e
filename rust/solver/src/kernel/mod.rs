//! The spring kernel: the force on every particle of a chunk, summed in a fixed order.
//!
//! Springs that join particles at the same distance in memory (on a grid, all of them) form a *diagonal*: both ends
//! load as vectors, and each spring is computed once for its two ends. Those that lead out of a chunk are computed
//! again by the chunk that they lead to, so no two threads ever share a sum, and the bits do not depend on their
//! number. The other springs are *gathered*, one particle at a time, from both ends.
//!
//! A chunk goes block by block: all diagonals of a block while its particles and sums are in the nearest cache, and
//! then, since springs lead on in memory only, the block's particles can move. The laws are written for numbers of
//! any width ([`crate::law::number`]); [`crate::system`] finds the instruction set.

mod diagonal;
mod gather;
mod lanes;
mod layout;
mod sums;
#[cfg(test)]
mod tests;

pub(crate) use lanes::{Lanes, lane_operators, vectors, vectors_mut};
pub(crate) use layout::{Diagonal, GATHERED, GatherSlot, Layout, Place};
pub(crate) use sums::Sums;

use std::ops::Range;

use pulp::Simd;

use diagonal::{add_from_before, add_from_block};
use gather::add_gather;

use crate::law::spring::Damping;
use crate::state::State;

/// Particles that one task handles: enough for few springs to be computed in two chunks, and few enough for two
/// cores to share a small cloth.
pub(crate) const CHUNK: usize = 2048;

/// Particles whose springs are computed at a time: few enough for all that these touch to stay in the nearest cache.
pub(crate) const BLOCK: usize = 512;

/// A vector for each particle of one chunk, an array an axis.
pub(crate) type ChunkVectors = [[f64; PLACES]; 3];

/// Places for a chunk's particles; the excess keeps axes from falling on the same lines of the cache.
const PLACES: usize = CHUNK + 88;

/// Calls a function with the terms of a law as its type parameter.
macro_rules! with_terms {
    ($law:expr, $function:ident::<$simd:ty>($($argument:expr),*)) => {
        match ($law.damping, $law.stiffen_beyond.is_finite()) {
            (Damping::None, false) => $function::<$simd, crate::law::spring::Undamped>($($argument),*),
            (Damping::Relative, false) => {
                $function::<$simd, crate::law::spring::RelativelyDamped>($($argument),*)
            }
            (Damping::Axial, false) => {
                $function::<$simd, crate::law::spring::AxiallyDamped>($($argument),*)
            }
            (Damping::None, true) => {
                $function::<$simd, crate::law::spring::UndampedStiffening>($($argument),*)
            }
            (Damping::Relative, true) => {
                $function::<$simd, crate::law::spring::RelativelyDampedStiffening>($($argument),*)
            }
            (Damping::Axial, true) => {
                $function::<$simd, crate::law::spring::AxiallyDampedStiffening>($($argument),*)
            }
        }
    };
}

/// Adds the forces (N) on a chunk's particles of all springs but those on diagonals that begin in it.
///
/// Inlined into its caller, as the next one is, to be compiled for the instruction set that the caller found.
#[inline(always)]
pub(crate) fn add_from_outside<S: Simd>(
    simd: S,
    layout: &Layout,
    chunk: usize,
    state: &State,
    sums: &mut Sums,
) {
    let own = chunk * CHUNK..((chunk + 1) * CHUNK).min(state.len());
    for gather in &layout.gathers[layout.gathers_of_chunk[chunk].clone()] {
        let slots = &layout.gather_slots[gather.slots.clone()];
        let force = &mut sums.arriving;
        with_terms!(gather.law, add_gather::<S>(simd, gather, slots, chunk, state, force));
    }
    for diagonal in &layout.diagonals {
        with_terms!(diagonal.law, add_from_before::<S>(simd, diagonal, &own, state, sums));
    }
}

/// Adds the forces (N) of the springs on diagonals that begin in a block; blocks come in order. Then the sums of the
/// block's particles are whole.
#[inline(always)]
pub(crate) fn add_from_inside<S: Simd>(
    simd: S,
    layout: &Layout,
    chunk: usize,
    block: &Range<usize>,
    state: &State,
    sums: &mut Sums,
) {
    let own = chunk * CHUNK..((chunk + 1) * CHUNK).min(state.len());
    for diagonal in &layout.diagonals {
        let block = block.clone();
        with_terms!(diagonal.law, add_from_block::<S>(simd, diagonal, &own, block, state, sums));
    }
}
