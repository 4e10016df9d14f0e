//! The Hessian without bend springs, and with a bound of hinges, written down as blocks on a graph of pairs of particles.

use rayon::prelude::*;

use super::Hessian;
use crate::contact::ContactMatrix;
use crate::kernel::{CHUNK, Place};
use crate::linear::BlockMatrix;
use crate::system::System;

/// Pairs that one task writes at the least.
const TASK: usize = 1024;

/// What joins a pair of particles.
#[derive(Clone, Copy, Debug)]
struct Coupling {
    /// The smaller particle first.
    ends: [u32; 2],
    spring: Option<Place>,
    /// The number of the fabrics' edge.
    edge: Option<u32>,
}

/// Where the Hessian has its blocks.
#[derive(Clone, Debug)]
pub(in crate::implicit) struct Pattern {
    couplings: Vec<Coupling>,
    /// For each particle, where its pairs begin, and the end of the last.
    starts: Vec<u32>,
    pairs: Vec<u32>,
}

impl Pattern {
    /// Of pairs, none of which may stand twice.
    pub(in crate::implicit) fn new(pairs: &[[u32; 2]], system: &System) -> Self {
        let count = system.particle_count();
        let springs = system.layout.places(pairs.iter().copied(), count, false);
        let coupling = |(&[a, b], spring): (&[u32; 2], Option<Place>)| {
            let ends = [a.min(b), a.max(b)];
            Coupling { ends, spring, edge: system.fabrics.edge_between(ends) }
        };
        let couplings: Vec<Coupling> = pairs.iter().zip(springs).map(coupling).collect();
        let both =
            |(pair, coupling): (usize, &Coupling)| coupling.ends.map(|end| (end, pair as u32));
        let mut halves: Vec<(u32, u32)> = couplings.iter().enumerate().flat_map(both).collect();
        halves.sort_unstable();
        let start = |particle| halves.partition_point(|(own, _)| *own < particle) as u32;
        let starts = (0..=count as u32).map(start).collect();
        Self { starts, pairs: halves.into_iter().map(|(_, pair)| pair).collect(), couplings }
    }
}

impl Hessian {
    /// Writes the blocks. Contacts count twice on the diagonal and nowhere else, as in the blocks of smoothing.
    pub(in crate::implicit) fn write(
        &self,
        pattern: &Pattern,
        system: &System,
        contacts: &ContactMatrix,
        out: &mut BlockMatrix,
    ) {
        let BlockMatrix { diagonal, pairs } = out;
        let couplings = pattern.couplings.par_iter().with_min_len(TASK);
        couplings.map(|coupling| self.block(coupling, system)).collect_into_vec(pairs);
        for entries in &mut *diagonal {
            entries.resize(self.inertia.len(), 0.0);
        }
        let [a, b, c, d, e, f] = diagonal.each_mut().map(|entries| entries.par_chunks_mut(CHUNK));
        (a, b, c, d, e, f).into_par_iter().enumerate().for_each(|(chunk, (a, b, c, d, e, f))| {
            let (first, mut blocks) = (chunk * CHUNK, [a, b, c, d, e, f]);
            for place in 0..blocks[0].len() {
                let own = self.own_block(pattern, pairs, first + place);
                blocks.iter_mut().zip(own).for_each(|(entries, entry)| entries[place] = entry);
            }
            contacts.add_blocks(first, &mut blocks);
        });
        let is_still = |end: u32| self.inertia[end as usize] <= 0.0;
        let still = pairs.iter_mut().zip(&pattern.couplings);
        for (block, _) in still.filter(|(_, coupling)| coupling.ends.into_iter().any(is_still)) {
            block.fill(0.0);
        }
    }

    /// The block of a pair, row by row.
    fn block(&self, coupling: &Coupling, system: &System) -> [f32; 9] {
        let mut block = [0.0; 9];
        if let Some(edge) = coupling.edge {
            block = self.fabric.block(&system.fabrics, edge as usize);
        }
        let [x, y, z, beta] = match coupling.spring {
            None => return block,
            Some(Place::Diagonal(diagonal, spring)) => {
                let numbers = &self.diagonals[diagonal as usize].0;
                numbers.each_ref().map(|numbers| numbers[spring as usize])
            }
            Some(Place::Gathered([(slot, lane), _])) => {
                self.slots[slot as usize].map(|lanes| lanes[lane as usize])
            }
        };
        let products = [x * x, y * x, z * x, x * y, y * y, z * y, x * z, y * z, z * z];
        block.iter_mut().zip(products).for_each(|(entry, product)| *entry += product);
        for entry in [0, 4, 8] {
            block[entry] += beta;
        }
        block
    }

    /// The block on the diagonal, without contacts: that of the identity where a particle does not move.
    fn own_block(&self, pattern: &Pattern, pairs: &[[f32; 9]], particle: usize) -> [f32; 6] {
        let inertia = self.inertia[particle];
        if inertia <= 0.0 {
            return [1.0, 0.0, 1.0, 0.0, 0.0, 1.0];
        }
        let own = pattern.starts[particle] as usize..pattern.starts[particle + 1] as usize;
        let mut sums = [f64::from(inertia), 0.0, f64::from(inertia), 0.0, 0.0, inertia.into()];
        for &pair in &pattern.pairs[own] {
            let [xx, a, b, c, yy, d, e, f, zz] = pairs[pair as usize].map(f64::from);
            let even = [xx, 0.5 * (a + c), yy, 0.5 * (b + e), 0.5 * (d + f), zz];
            sums.iter_mut().zip(even).for_each(|(sum, entry)| *sum += entry);
        }
        sums.map(|sum| sum as f32)
    }
}
