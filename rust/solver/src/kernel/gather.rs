//! Springs that lie nowhere in particular.

use super::layout::{GATHERED, Gather, GatherSlot};
use super::{CHUNK, ChunkVectors};
use crate::law::spring::{Damping, Pull, Terms};
use crate::state::{Coordinates, State};

/// Adds the forces of gathered springs on the particles of a chunk.
#[inline(always)]
pub(super) fn add_gather<T: Terms>(
    gather: &Gather,
    slots: &[GatherSlot],
    chunk: usize,
    state: &State,
    force: &mut ChunkVectors,
) {
    let mut total = [[0.0; GATHERED]; 3];
    let mut relative = [[0.0; GATHERED]; 3];
    for slot in slots {
        let spans = difference(&state.position, &gather.particles, &slot.neighbors);
        if T::DAMPING != Damping::None {
            relative = difference(&state.velocity, &gather.particles, &slot.neighbors);
        }
        for i in 0..GATHERED {
            let pull = Pull {
                rest_length: slot.rest_lengths[i],
                stiffness: slot.stiffness[i],
                damping: slot.damping[i],
                stiffen_beyond: gather.law.stiffen_beyond,
            };
            let span = [spans[0][i], spans[1][i], spans[2][i]];
            let squared = Pull::squared_length(span);
            let rough = Pull::rough_inverse_length(squared as f32);
            let velocity = [relative[0][i], relative[1][i], relative[2][i]];
            let on_neighbor = pull.on_other::<T>(span, squared, rough, velocity);
            for axis in 0..3 {
                total[axis][i] -= on_neighbor[axis];
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
fn difference(
    coordinates: &Coordinates,
    particles: &[u32; GATHERED],
    neighbors: &[u32; GATHERED],
) -> [[f64; GATHERED]; 3] {
    coordinates.0.each_ref().map(|axis| {
        std::array::from_fn(|i| axis[particles[i] as usize] - axis[neighbors[i] as usize])
    })
}
