//! A symmetric matrix of pairs of particles, N numbers a pair, laid out so that products load side by side.
//!
//! Pairs at the same distance in memory lie in rows ([`super::links`]); the others are gathered, a particle at a time, from
//! both ends.

use std::ops::Range;

use pulp::Simd;
use rayon::prelude::*;

use super::block_jacobi::Entries;
use super::field::{CHUNK, Field};
use super::links::{Link, Row, difference};
use crate::kernel::GATHERED;

/// A row holds a pair for at least one in so many of its places.
const SPARSEST: usize = 8;

/// Pairs that make a row at the least.
const SHORTEST: usize = 64;

/// No pair.
const NONE: u32 = u32::MAX;

/// What is known of a link beside its pull.
pub(crate) trait Block<const N: usize>: Link<N> {
    /// Its part of the blocks of its ends: xx, yx, yy, zx, zy, zz.
    fn block(numbers: [f32; N]) -> [f32; 6];

    /// Its numbers with near and far end exchanged.
    fn turned(numbers: [f32; N]) -> [f32; N];
}

/// Pairs in a row.
#[derive(Clone, Debug)]
struct PairRow<const N: usize> {
    first: usize,
    offset: usize,
    /// For each near end in a row, its pair, or [`NONE`].
    pairs: Vec<u32>,
    numbers: [Vec<f32>; N],
}

/// Up to `GATHERED` particles of one chunk; the last stands in for those that lack.
#[derive(Clone, Debug)]
struct Gather {
    particles: [u32; GATHERED],
    count: usize,
    slots: Range<usize>,
}

/// One pair of each gathered particle; one that has no more is joined to itself.
#[derive(Clone, Debug)]
struct Slot<const N: usize> {
    neighbors: [u32; GATHERED],
    pairs: [u32; GATHERED],
    is_far: [bool; GATHERED],
    numbers: [[f32; GATHERED]; N],
}

/// All pairs.
#[derive(Debug)]
pub(crate) struct Pairs<const N: usize> {
    rows: Vec<PairRow<N>>,
    gathers: Vec<Gather>,
    slots: Vec<Slot<N>>,
    gathers_of_chunk: Vec<Range<usize>>,
}

impl<const N: usize> Default for Pairs<N> {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            gathers: Vec::new(),
            slots: Vec::new(),
            gathers_of_chunk: Vec::new(),
        }
    }
}

impl<const N: usize> Pairs<N> {
    /// Of pairs whose smaller end comes first, with zeros for numbers.
    pub(crate) fn new(pairs: &[[u32; 2]], particle_count: usize) -> Self {
        let mut numbers: Vec<u32> = (0..pairs.len() as u32).collect();
        let ends = |number: u32| pairs[number as usize];
        let offset = |number: u32| ends(number)[1] - ends(number)[0];
        numbers.sort_by_key(|&number| (offset(number), ends(number)[0]));
        let mut made = Self::default();
        let mut halves: Vec<Vec<[u32; 2]>> = vec![Vec::new(); particle_count];
        for alike in numbers.chunk_by(|&a, &b| offset(a) == offset(b)) {
            let first = ends(alike[0])[0];
            let span = (ends(alike[alike.len() - 1])[0] - first) as usize + 1;
            if alike.len() >= SHORTEST && alike.len() * SPARSEST >= span {
                let mut own = vec![NONE; span];
                for &number in alike {
                    own[(ends(number)[0] - first) as usize] = number;
                }
                made.rows.push(PairRow {
                    first: first as usize,
                    offset: offset(alike[0]) as usize,
                    pairs: own,
                    numbers: std::array::from_fn(|_| vec![0.0; span]),
                });
            } else {
                for &number in alike {
                    let [near, far] = ends(number);
                    halves[near as usize].push([far, number]);
                    halves[far as usize].push([near, number]);
                }
            }
        }
        for start in (0..particle_count).step_by(CHUNK) {
            made.gather(start..(start + CHUNK).min(particle_count), &halves);
        }
        made
    }

    fn gather(&mut self, chunk: Range<usize>, halves: &[Vec<[u32; 2]>]) {
        let first = self.gathers.len();
        let mut particles: Vec<usize> = chunk.filter(|&i| !halves[i].is_empty()).collect();
        // Like numbers of pairs fill a gather with the least waste; the order within a chunk is free.
        particles.sort_by_key(|&particle| halves[particle].len());
        for own in particles.chunks(GATHERED) {
            let of_lane = |lane: usize| own[lane.min(own.len() - 1)];
            let first_slot = self.slots.len();
            // In this order, the last has the most.
            for place in 0..halves[own[own.len() - 1]].len() {
                let mut slot = Slot {
                    neighbors: std::array::from_fn(|lane| of_lane(lane) as u32),
                    pairs: [NONE; GATHERED],
                    is_far: [false; GATHERED],
                    numbers: [[0.0; GATHERED]; N],
                };
                for lane in 0..GATHERED {
                    let particle = of_lane(lane);
                    let Some(&[neighbor, pair]) = halves[particle].get(place) else { continue };
                    slot.neighbors[lane] = neighbor;
                    slot.pairs[lane] = pair;
                    slot.is_far[lane] = (neighbor as usize) < particle;
                }
                self.slots.push(slot);
            }
            self.gathers.push(Gather {
                particles: std::array::from_fn(|lane| of_lane(lane) as u32),
                count: own.len(),
                slots: first_slot..self.slots.len(),
            });
        }
        self.gathers_of_chunk.push(first..self.gathers.len());
    }

    /// Takes the numbers of all pairs.
    pub(crate) fn fill<B: Block<N>>(&mut self, of: impl Fn(usize) -> [f32; N] + Sync) {
        self.rows.par_iter_mut().for_each(|row| {
            for (place, &pair) in row.pairs.iter().enumerate().filter(|(_, pair)| **pair != NONE) {
                for (numbers, number) in row.numbers.iter_mut().zip(of(pair as usize)) {
                    numbers[place] = number;
                }
            }
        });
        self.slots.par_iter_mut().for_each(|slot| {
            for lane in (0..GATHERED).filter(|&lane| slot.pairs[lane] != NONE) {
                let own = of(slot.pairs[lane] as usize);
                let own = if slot.is_far[lane] { B::turned(own) } else { own };
                for (numbers, number) in slot.numbers.iter_mut().zip(own) {
                    numbers[lane] = number;
                }
            }
        });
    }

    /// Adds what the pairs make of p to the particles of a chunk, or subtracts it.
    #[inline(always)]
    pub(crate) fn add<S: Simd, L: Link<N>, const SUBTRACT: bool>(
        &self,
        simd: S,
        p: &Field,
        first: usize,
        out: &mut [&mut [f32]; 3],
    ) {
        const { assert!(GATHERED.is_multiple_of(S::F32_LANES)) };
        let own = first..first + out[0].len();
        for row in &self.rows {
            let numbers = row.numbers.each_ref().map(
                #[inline(always)]
                |numbers| &numbers[..],
            );
            let row = Row { first: row.first, offset: row.offset, numbers, p };
            let [x, y, z] = out;
            row.add::<S, L, SUBTRACT>(simd, &own, [&mut **x, &mut **y, &mut **z]);
        }
        for gather in &self.gathers[self.gathers_of_chunk[first / CHUNK].clone()] {
            let mut sums = [[0.0_f32; GATHERED]; 3];
            let own = p.pick(&gather.particles);
            for slot in &self.slots[gather.slots.clone()] {
                let other = p.pick(&slot.neighbors);
                for i in 0..GATHERED / S::F32_LANES {
                    let numbers = slot.numbers.each_ref().map(
                        #[inline(always)]
                        |lanes| S::as_simd_f32s(lanes).0[i],
                    );
                    let [own, other] = [&own, &other].map(
                        #[inline(always)]
                        |axes| {
                            axes.each_ref().map(
                                #[inline(always)]
                                |lanes| S::as_simd_f32s(lanes).0[i],
                            )
                        },
                    );
                    let [gets, _] = L::pull(simd, numbers, difference(simd, own, other));
                    for (sum, gets) in sums.iter_mut().zip(gets) {
                        let sum = &mut S::as_mut_simd_f32s(sum).0[i];
                        *sum = simd.add_f32s(*sum, gets);
                    }
                }
            }
            for i in 0..gather.count {
                for axis in 0..3 {
                    let sum = if SUBTRACT { -sums[axis][i] } else { sums[axis][i] };
                    out[axis][gather.particles[i] as usize - first] += sum;
                }
            }
        }
    }

    /// Adds the pairs' parts of the blocks on the diagonal of a chunk's particles.
    #[inline(always)]
    pub(crate) fn add_blocks<B: Block<N>>(&self, first: usize, blocks: &mut Entries<&mut [f32]>) {
        let own = first..first + blocks[0].len();
        for row in &self.rows {
            for begin in [row.first, row.first + row.offset] {
                let (from, to) = (begin.max(own.start), (begin + row.pairs.len()).min(own.end));
                if from >= to {
                    continue;
                }
                let numbers = row.numbers.each_ref().map(
                    #[inline(always)]
                    |numbers| &numbers[from - begin..to - begin],
                );
                let entries = blocks.each_mut().map(
                    #[inline(always)]
                    |entries| &mut entries[from - first..to - first],
                );
                add_row::<B, N>(numbers, entries);
            }
        }
        for gather in &self.gathers[self.gathers_of_chunk[first / CHUNK].clone()] {
            for slot in &self.slots[gather.slots.clone()] {
                for (lane, &particle) in gather.particles[..gather.count].iter().enumerate() {
                    let block = B::block(slot.numbers.each_ref().map(|lanes| lanes[lane]));
                    for (entries, value) in blocks.iter_mut().zip(block) {
                        entries[particle as usize - first] += value;
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn add_row<B: Block<N>, const N: usize>(numbers: [&[f32]; N], entries: Entries<&mut [f32]>) {
    let [xx, yx, yy, zx, zy, zz] = entries;
    let count = xx.len();
    let (yx, yy, zx) = (&mut yx[..count], &mut yy[..count], &mut zx[..count]);
    let (zy, zz) = (&mut zy[..count], &mut zz[..count]);
    for i in 0..count {
        let block = B::block(numbers.map(
            #[inline(always)]
            |numbers| numbers[i],
        ));
        xx[i] += block[0];
        yx[i] += block[1];
        yy[i] += block[2];
        zx[i] += block[3];
        zy[i] += block[4];
        zz[i] += block[5];
    }
}
