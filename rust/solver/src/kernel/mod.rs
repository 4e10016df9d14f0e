//! The spring kernel: the force on every particle of a chunk, summed in a fixed order.
//!
//! Springs that join particles at the same distance in memory (on a grid, all of them) form a *diagonal*: both ends
//! load as vectors, and each spring is computed once for its two ends. Those that lead out of a chunk are computed
//! again by the chunk that they lead to, so no two threads ever share a sum, and the bits do not depend on their
//! number. The other springs are *gathered*, one particle at a time, from both ends.
//!
//! The loops are plain; the compiler makes them SIMD, for the instruction set that [`crate::system`] finds. A
//! diagonal is computed in short loops, one for each stage of the law: the chain from position to force is too long
//! for a processor to look ahead over it.

mod diagonal;
mod gather;
mod layout;

pub(crate) use layout::Layout;

use crate::law::spring::Damping;
use crate::state::State;

/// Particles that one task handles: few enough for their forces to stay in the nearest cache.
pub(crate) const CHUNK: usize = 1024;

/// A vector for each particle of one chunk, an array an axis.
pub(crate) type ChunkVectors = [[f64; CHUNK]; 3];

/// Calls a function with the terms of a law as its type parameter.
macro_rules! with_terms {
    ($law:expr, $function:ident($($argument:expr),*)) => {
        match ($law.damping, $law.stiffen_beyond.is_finite()) {
            (Damping::None, false) => $function::<crate::law::spring::Undamped>($($argument),*),
            (Damping::Relative, false) => {
                $function::<crate::law::spring::RelativelyDamped>($($argument),*)
            }
            (Damping::Axial, false) => {
                $function::<crate::law::spring::AxiallyDamped>($($argument),*)
            }
            (Damping::None, true) => {
                $function::<crate::law::spring::UndampedStiffening>($($argument),*)
            }
            (Damping::Relative, true) => {
                $function::<crate::law::spring::RelativelyDampedStiffening>($($argument),*)
            }
            (Damping::Axial, true) => {
                $function::<crate::law::spring::AxiallyDampedStiffening>($($argument),*)
            }
        }
    };
}

/// Adds the spring forces (N) on the particles of a chunk.
///
/// Inlined into its caller, to be compiled for the instruction set that the caller found.
#[inline(always)]
pub(crate) fn add_spring_forces(
    layout: &Layout,
    chunk: usize,
    state: &State,
    force: &mut ChunkVectors,
) {
    use diagonal::{Block, add_diagonal};
    use gather::add_gather;
    let block = &mut Block::new();
    for diagonal in &layout.diagonals {
        with_terms!(diagonal.law, add_diagonal(diagonal, chunk, state, block, force));
    }
    for gather in &layout.gathers[layout.gathers_of_chunk[chunk].clone()] {
        let slots = &layout.gather_slots[gather.slots.clone()];
        with_terms!(gather.law, add_gather(gather, slots, chunk, state, force));
    }
}
