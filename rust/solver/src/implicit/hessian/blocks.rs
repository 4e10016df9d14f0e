//! The 3 x 3 blocks on the diagonal of the Hessian without bend springs.

use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::Hessian;
use crate::contact::ContactMatrix;
use crate::kernel::{CHUNK, Layout};
use crate::linear::{BlockJacobi, Entries};
use crate::system::System;

impl Hessian {
    /// Inverts the blocks on the diagonal.
    pub(in crate::implicit) fn invert_blocks(
        &self,
        system: &System,
        contacts: &ContactMatrix,
        inverse: &mut BlockJacobi,
    ) {
        let layout = &system.layout;
        inverse.invert(&self.inertia, |first, mut blocks| {
            let entries = blocks.each_mut().map(|entries| &mut **entries);
            self.arch.dispatch(Blocks { hessian: self, layout, first, entries });
            contacts.add_blocks(first, &mut blocks);
        });
    }
}

/// The blocks of a chunk of particles.
struct Blocks<'a> {
    hessian: &'a Hessian,
    layout: &'a Layout,
    first: usize,
    entries: Entries<&'a mut [f32]>,
}

impl WithSimd for Blocks<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { hessian, layout, first, entries: mut blocks } = self;
        let own = first..first + blocks[0].len();
        for entries in &mut blocks {
            entries.fill(0.0);
        }
        for entry in [0, 2, 5] {
            blocks[entry].copy_from_slice(&hessian.inertia[own.clone()]);
        }
        for (diagonal, tangents) in layout.diagonals.iter().zip(&hessian.diagonals) {
            if diagonal.is_bend {
                continue;
            }
            for begin in [0, diagonal.offset] {
                let start = diagonal.first + begin;
                let from = start.max(own.start);
                let to = (start + diagonal.rest_lengths.len()).min(own.end);
                if from < to {
                    let springs = from - start..to - start;
                    add_springs(tangents.of(springs), &mut blocks, from - first..to - first);
                }
            }
        }
        for gather in &layout.gathers[layout.gathers_of_chunk[first / CHUNK].clone()] {
            let slots = gather.slots.clone();
            let springs = layout.gather_slots[slots.clone()].iter().zip(&hessian.slots[slots]);
            for (_, slot) in springs.filter(|(springs, _)| !springs.is_bend) {
                for (lane, &particle) in gather.particles[..gather.count].iter().enumerate() {
                    let place = particle as usize - first;
                    let tangents = slot.each_ref().map(|lanes| &lanes[lane..=lane]);
                    add_springs(tangents, &mut blocks, place..place + 1);
                }
            }
        }
        if !hessian.fabric.is_empty() {
            hessian.fabric.add_blocks(first, &mut blocks);
        }
    }
}

/// Adds `alpha n nᵀ + beta` of springs to the blocks of one of their ends.
#[inline(always)]
fn add_springs(
    [nx, ny, nz, beta]: [&[f32]; 4],
    [xx, yx, yy, zx, zy, zz]: &mut Entries<&mut [f32]>,
    places: Range<usize>,
) {
    let count = places.len();
    let (nx, ny, nz, beta) = (&nx[..count], &ny[..count], &nz[..count], &beta[..count]);
    let (xx, yx) = (&mut xx[places.clone()], &mut yx[places.clone()]);
    let (yy, zx) = (&mut yy[places.clone()], &mut zx[places.clone()]);
    let (zy, zz) = (&mut zy[places.clone()], &mut zz[places]);
    for i in 0..count {
        xx[i] += nx[i] * nx[i] + beta[i];
        yx[i] += ny[i] * nx[i];
        yy[i] += ny[i] * ny[i] + beta[i];
        zx[i] += nz[i] * nx[i];
        zy[i] += nz[i] * ny[i];
        zz[i] += nz[i] * nz[i] + beta[i];
    }
}
