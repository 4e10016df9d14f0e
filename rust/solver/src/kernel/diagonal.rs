//! Springs that join particles at the same distance in memory.

use std::ops::Range;

use super::layout::Diagonal;
use super::{CHUNK, ChunkVectors};
use crate::law::spring::{Damping, Pull, Terms};
use crate::state::{Coordinates, State};

/// Springs computed at a time: what they pass from loop to loop stays in the nearest cache.
const BLOCK: usize = 256;

/// What the loops over a block pass on: a number a spring.
pub(super) struct Block {
    /// Spans (m), then forces (N).
    spans: [[f64; BLOCK]; 3],
    squared_lengths: [f64; BLOCK],
    /// Squared lengths, then one over the lengths.
    rough: [f32; BLOCK],
}

impl Block {
    pub(super) fn new() -> Self {
        Self { spans: [[0.0; BLOCK]; 3], squared_lengths: [0.0; BLOCK], rough: [0.0; BLOCK] }
    }
}

/// Adds the forces of a diagonal's springs that end in a chunk.
#[inline(always)]
pub(super) fn add_diagonal<T: Terms>(
    diagonal: &Diagonal,
    chunk: usize,
    state: &State,
    block: &mut Block,
    force: &mut ChunkVectors,
) {
    let offset = diagonal.offset;
    let own = chunk * CHUNK..((chunk + 1) * CHUNK).min(state.len());
    let all = diagonal.first..diagonal.first + diagonal.rest_lengths.len();
    // Springs whose second end is the chunk's own, and those whose first is.
    let ending = own.start.saturating_sub(offset)..own.end.saturating_sub(offset).min(own.start);
    for springs in [ending, own.clone()] {
        let mut start = springs.start.max(all.start);
        let end = springs.end.min(all.end);
        while start < end {
            let count = BLOCK.min(end - start);
            compute::<T>(diagonal, start, count, state, block);
            add(force, &own, start, count, block, |total, pull| total - pull);
            add(force, &own, start + offset, count, block, |total, pull| total + pull);
            start += count;
        }
    }
}

/// Leaves in `block.spans` the forces on the second ends of `count` springs from particle `start` on.
#[inline(always)]
fn compute<T: Terms>(
    diagonal: &Diagonal,
    start: usize,
    count: usize,
    state: &State,
    block: &mut Block,
) {
    let Block { spans: [sx, sy, sz], squared_lengths, rough } = block;
    let (sx, sy, sz) = (&mut sx[..count], &mut sy[..count], &mut sz[..count]);
    let (squared_lengths, rough) = (&mut squared_lengths[..count], &mut rough[..count]);
    let [x, y, z] = cut(&state.position, start, count);
    let [ox, oy, oz] = cut(&state.position, start + diagonal.offset, count);
    for i in 0..count {
        let span = [x[i] - ox[i], y[i] - oy[i], z[i] - oz[i]];
        [sx[i], sy[i], sz[i]] = span;
        squared_lengths[i] = Pull::squared_length(span);
        rough[i] = squared_lengths[i] as f32;
    }
    for value in rough.iter_mut() {
        *value = Pull::rough_inverse_length(*value);
    }
    let first = start - diagonal.first;
    let rest_lengths = &diagonal.rest_lengths[first..first + count];
    let [u, v, w] = cut(&state.velocity, start, count);
    let [ou, ov, ow] = cut(&state.velocity, start + diagonal.offset, count);
    for i in 0..count {
        // A rest length of 0 marks a gap in the diagonal.
        let is_there = rest_lengths[i] > 0.0;
        let pull = Pull {
            rest_length: if T::STIFFENS && !is_there { 1.0 } else { rest_lengths[i] },
            stiffness: if is_there { diagonal.stiffness } else { 0.0 },
            damping: if is_there { diagonal.damping } else { 0.0 },
            stiffen_beyond: diagonal.law.stiffen_beyond,
        };
        let relative_velocity = if T::DAMPING == Damping::None {
            [0.0; 3]
        } else {
            [u[i] - ou[i], v[i] - ov[i], w[i] - ow[i]]
        };
        let span = [sx[i], sy[i], sz[i]];
        [sx[i], sy[i], sz[i]] =
            pull.on_other::<T>(span, squared_lengths[i], rough[i], relative_velocity);
    }
}

/// Adds what the particles from `start` on feel to those of them that are the chunk's own.
#[inline(always)]
fn add(
    force: &mut ChunkVectors,
    own: &Range<usize>,
    start: usize,
    count: usize,
    block: &Block,
    sum: impl Fn(f64, f64) -> f64,
) {
    let (from, to) = (start.max(own.start), (start + count).min(own.end));
    if from >= to {
        return;
    }
    for (total, pulls) in force.iter_mut().zip(&block.spans) {
        let total = &mut total[from - own.start..to - own.start];
        for (total, pull) in total.iter_mut().zip(&pulls[from - start..to - start]) {
            *total = sum(*total, *pull);
        }
    }
}

#[inline(always)]
fn cut(coordinates: &Coordinates, start: usize, count: usize) -> [&[f64]; 3] {
    coordinates.0.each_ref().map(|axis| &axis[start..start + count])
}
