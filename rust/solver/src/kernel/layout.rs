//! Which springs each particle gathers, arranged for the kernel once and for all.

use std::ops::Range;

use super::{CHUNK, WIDTH};
use crate::cloth::Cloth;
use crate::law::spring::Law;

/// Springs of a run: neighbour = particle + offset, for every particle of the run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RunSlot {
    pub(crate) offset: isize,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    /// Index of the first particle's rest length.
    pub(crate) rest_lengths: usize,
}

/// Particles in a row, within one chunk, with the same relative neighbours and materials.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub(crate) particles: Range<usize>,
    pub(crate) slots: Range<usize>,
    pub(crate) law: Law,
}

/// One spring of each of `WIDTH` gathered particles; fills up with springs of no stiffness to oneself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GatherSlot {
    pub(crate) neighbors: [u32; WIDTH],
    pub(crate) stiffness: [f64; WIDTH],
    pub(crate) damping: [f64; WIDTH],
    pub(crate) rest_lengths: [f64; WIDTH],
}

/// Up to `WIDTH` particles of one chunk that no run holds; the last stands in for those that lack.
#[derive(Clone, Debug)]
pub(crate) struct Gather {
    pub(crate) particles: [u32; WIDTH],
    pub(crate) slots: Range<usize>,
    pub(crate) law: Law,
}

/// All the springs of a simulation as the kernel reads them.
#[derive(Debug, Default)]
pub(crate) struct Layout {
    pub(crate) runs: Vec<Run>,
    pub(crate) run_slots: Vec<RunSlot>,
    pub(crate) rest_lengths: Vec<f64>,
    pub(crate) gathers: Vec<Gather>,
    pub(crate) gather_slots: Vec<GatherSlot>,
    /// For each chunk, its runs and its gathers.
    pub(crate) chunks: Vec<(Range<usize>, Range<usize>)>,
}

/// A spring as one of its ends sees it.
#[derive(Clone, Copy)]
struct Half {
    neighbor: u32,
    stiffness: f64,
    damping: f64,
    rest_length: f64,
}

impl Half {
    fn is_like(&self, particle: usize, other: &Self, other_particle: usize) -> bool {
        let offset = i64::from(self.neighbor) - particle as i64;
        let other_offset = i64::from(other.neighbor) - other_particle as i64;
        offset == other_offset
            && self.stiffness.to_bits() == other.stiffness.to_bits()
            && self.damping.to_bits() == other.damping.to_bits()
    }
}

impl Layout {
    pub(crate) fn new(cloths: &[Cloth]) -> Self {
        let mut layout = Self::default();
        let (halves, laws) = halves_of(cloths);
        for start in (0..halves.len()).step_by(CHUNK) {
            layout.add_chunk(start..(start + CHUNK).min(halves.len()), &halves, &laws);
        }
        layout
    }

    fn add_chunk(&mut self, chunk: Range<usize>, halves: &[Vec<Half>], laws: &[Law]) {
        let (first_run, first_gather) = (self.runs.len(), self.gathers.len());
        let mut gathered = Vec::new();
        let mut start = chunk.start;
        while start < chunk.end {
            let is_like = |&i: &usize| {
                laws[i] == laws[start]
                    && halves[i].len() == halves[start].len()
                    && halves[i].iter().zip(&halves[start]).all(|(a, b)| a.is_like(i, b, start))
            };
            let length = (start + 1..chunk.end).take_while(is_like).count() + 1;
            if length < WIDTH {
                gathered.extend(start..start + length);
            } else {
                self.add_run(start..start + length, halves, laws[start]);
            }
            start += length;
        }
        // Neighbours in degree fill a gather with the least waste; the order within a chunk is free.
        gathered.sort_by_key(|&particle| halves[particle].len());
        for same_law in gathered.chunk_by(|&a, &b| laws[a] == laws[b]) {
            for particles in same_law.chunks(WIDTH) {
                self.add_gather(particles, halves, laws[particles[0]]);
            }
        }
        self.chunks.push((first_run..self.runs.len(), first_gather..self.gathers.len()));
    }

    fn add_run(&mut self, particles: Range<usize>, halves: &[Vec<Half>], law: Law) {
        let first_slot = self.run_slots.len();
        for (slot, half) in halves[particles.start].iter().enumerate() {
            self.run_slots.push(RunSlot {
                offset: half.neighbor as isize - particles.start as isize,
                stiffness: half.stiffness,
                damping: half.damping,
                rest_lengths: self.rest_lengths.len(),
            });
            let rest_lengths = particles.clone().map(|i| halves[i][slot].rest_length);
            self.rest_lengths.extend(rest_lengths);
        }
        self.runs.push(Run { particles, slots: first_slot..self.run_slots.len(), law });
    }

    fn add_gather(&mut self, particles: &[usize], halves: &[Vec<Half>], law: Law) {
        let first_slot = self.gather_slots.len();
        let of_lane = |lane: usize| particles[lane.min(particles.len() - 1)];
        let degree = particles.iter().map(|&i| halves[i].len()).max().unwrap_or(0);
        for slot in 0..degree {
            let lanes: [Half; WIDTH] = std::array::from_fn(|lane| {
                let particle = of_lane(lane);
                let none = Half {
                    neighbor: particle as u32,
                    stiffness: 0.0,
                    damping: 0.0,
                    rest_length: 1.0,
                };
                halves[particle].get(slot).copied().unwrap_or(none)
            });
            self.gather_slots.push(GatherSlot {
                neighbors: lanes.map(|half| half.neighbor),
                stiffness: lanes.map(|half| half.stiffness),
                damping: lanes.map(|half| half.damping),
                rest_lengths: lanes.map(|half| half.rest_length),
            });
        }
        self.gathers.push(Gather {
            particles: std::array::from_fn(|lane| of_lane(lane) as u32),
            slots: first_slot..self.gather_slots.len(),
            law,
        });
    }
}

/// Each particle's springs, by kind and neighbour, and its law, in the simulation's numbering.
fn halves_of(cloths: &[Cloth]) -> (Vec<Vec<Half>>, Vec<Law>) {
    let mut halves = Vec::new();
    let mut laws = Vec::new();
    for cloth in cloths {
        let base = halves.len() as u32;
        let mut of_cloth = vec![Vec::new(); cloth.positions.len()];
        for spring in cloth.springs.iter().filter(|s| s.stiffness > 0.0 || s.damping > 0.0) {
            let [a, b] = spring.ends;
            for (from, to) in [(a, b), (b, a)] {
                let half = Half {
                    neighbor: base + to,
                    stiffness: spring.stiffness,
                    damping: spring.damping,
                    rest_length: spring.rest_length,
                };
                of_cloth[from as usize].push((spring.kind, half));
            }
        }
        for mut of_particle in of_cloth {
            of_particle.sort_by_key(|(kind, half)| (*kind, half.neighbor));
            halves.push(of_particle.into_iter().map(|(_, half)| half).collect());
        }
        laws.resize(halves.len(), Law::of(&cloth.material));
    }
    (halves, laws)
}
