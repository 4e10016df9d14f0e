//! The 3 x 3 blocks on the diagonal of the Hessian.

use super::Hessian;
use crate::kernel::{CHUNK, Layout};
use crate::linear::{BlockJacobi, Entries};

impl Hessian {
    /// Inverts the blocks on the diagonal.
    pub(in crate::implicit) fn invert_blocks(&self, layout: &Layout, inverse: &mut BlockJacobi) {
        inverse.invert(&self.inertia, |first, blocks| self.sum_blocks(layout, first, blocks));
    }

    /// The blocks of a chunk of particles.
    fn sum_blocks(&self, layout: &Layout, first: usize, mut blocks: Entries<&mut [f32]>) {
        let own = first..first + blocks[0].len();
        for entries in &mut blocks {
            entries.fill(0.0);
        }
        for entry in [0, 2, 5] {
            blocks[entry].copy_from_slice(&self.inertia[own.clone()]);
        }
        for (diagonal, tangents) in layout.diagonals.iter().zip(&self.diagonals) {
            for begin in [0, diagonal.offset] {
                let start = diagonal.first + begin;
                let from = start.max(own.start);
                let to = (start + diagonal.rest_lengths.len()).min(own.end);
                if from < to {
                    let springs = from - start..to - start;
                    let tangents = tangents.0.each_ref().map(|axis| &axis[springs.clone()]);
                    let blocks = blocks.each_mut().map(|axis| &mut axis[from - first..to - first]);
                    add_springs(tangents, blocks);
                }
            }
        }
        for gather in &layout.gathers[layout.gathers_of_chunk[first / CHUNK].clone()] {
            for slot in &self.slots[gather.slots.clone()] {
                for (lane, &particle) in gather.particles[..gather.count].iter().enumerate() {
                    let place = particle as usize - first;
                    let tangents = slot.each_ref().map(|lanes| &lanes[lane..=lane]);
                    let blocks = blocks.each_mut().map(|axis| &mut axis[place..=place]);
                    add_springs(tangents, blocks);
                }
            }
        }
    }
}

/// Adds `alpha n nᵀ + beta` of springs to the blocks of one of their ends.
#[inline(always)]
fn add_springs(tangents: [&[f32]; 4], blocks: Entries<&mut [f32]>) {
    let count = tangents[0].len();
    let [nx, ny, nz, beta] = tangents.map(|axis| &axis[..count]);
    let [xx, yx, yy, zx, zy, zz] = blocks.map(|entries| &mut entries[..count]);
    for i in 0..count {
        xx[i] += nx[i] * nx[i] + beta[i];
        yx[i] += ny[i] * nx[i];
        yy[i] += ny[i] * ny[i] + beta[i];
        zx[i] += nz[i] * nx[i];
        zy[i] += nz[i] * ny[i];
        zz[i] += nz[i] * nz[i] + beta[i];
    }
}
