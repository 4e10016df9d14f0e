//! The spring kernel: the force on every particle of a chunk, summed in a fixed order.
//!
//! Springs that join particles at the same distance in memory (on a grid, all of them) form a *diagonal*: both ends
//! load as vectors, and each spring is computed once for its two ends. Those that lead out of a chunk are computed
//! again by the chunk that they lead to, so no two threads ever share a sum, and the bits do not depend on their
//! number. The other springs are *gathered*, one particle at a time, from both ends.
//!
//! A diagonal's forces are computed first and stored, then summed: two short loops, because a processor looks ahead
//! over a few hundred instructions only, and one spring's chain from position to force is long. The laws are written
//! for numbers of any width ([`crate::law::number`]); [`crate::system`] finds the instruction set.

mod diagonal;
mod gather;
mod lanes;
mod layout;
#[cfg(test)]
mod tests;
mod window;

pub(crate) use layout::{Diagonal, GATHERED, GatherSlot, Layout};
pub(crate) use window::Windows;

use pulp::Simd;

use diagonal::fill_window;
use gather::add_gather;
use window::{SIDE_BY_SIDE, add_windows};

use crate::law::spring::Damping;
use crate::state::State;

/// Particles that one task handles: enough for few springs to be computed in two chunks, and few enough for two
/// cores to share a small cloth and for a chunk's forces to stay in a core's cache.
pub(crate) const CHUNK: usize = 2048;

/// A vector for each particle of one chunk, an array an axis.
pub(crate) type ChunkVectors = [[f64; CHUNK]; 3];

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

/// Adds the spring forces (N) on the particles of a chunk.
///
/// Inlined into its caller, to be compiled for the instruction set that the caller found.
#[inline(always)]
pub(crate) fn add_spring_forces<S: Simd>(
    simd: S,
    layout: &Layout,
    chunk: usize,
    state: &State,
    windows: &mut Windows,
    force: &mut ChunkVectors,
) {
    let own = chunk * CHUNK..((chunk + 1) * CHUNK).min(state.len());
    let mut windows = windows.each();
    let (mut offsets, mut used) = ([0; SIDE_BY_SIDE], 0);
    for diagonal in layout.diagonals.iter().filter(|diagonal| diagonal.reaches(&own)) {
        let window = &mut windows[used];
        with_terms!(diagonal.law, fill_window::<S>(simd, diagonal, &own, state, window));
        offsets[used] = diagonal.offset;
        used += 1;
        if used == SIDE_BY_SIDE {
            add_windows(simd, &windows, &offsets, used, own.len(), force);
            used = 0;
        }
    }
    if used > 0 {
        add_windows(simd, &windows, &offsets, used, own.len(), force);
    }
    for gather in &layout.gathers[layout.gathers_of_chunk[chunk].clone()] {
        let slots = &layout.gather_slots[gather.slots.clone()];
        with_terms!(gather.law, add_gather::<S>(simd, gather, slots, chunk, state, force));
    }
}
