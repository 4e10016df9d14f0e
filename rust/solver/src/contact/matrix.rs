//! Contacts in the linear system of an implicit step, frozen at one guess.
//!
//! A contact of weights w and normal n adds, with its slope k and its resistance c,
//!
//! ```text
//! w_i w_j [ k n nT + c (I - n nT) ]
//! ```
//!
//! to the 3 x 3 block of its points i and j. Products take two passes: what each contact feels, then what each particle
//! gathers from its contacts, in their order, so that the sums do not depend on threads.

use std::sync::{Mutex, PoisonError};

use boucle_geometry::Vector;
use rayon::prelude::*;

use super::contact::Contact;
use crate::kernel::CHUNK;
use crate::linear::{Entries, Field};
use crate::state::Coordinates;

/// Contacts that one task takes, at the least.
const CONTACTS: usize = 1024;

/// A contact as products need it: zeros for the points of colliders.
#[derive(Clone, Copy, Debug)]
struct Tangent {
    points: [u32; 4],
    weights: [f32; 4],
    normal: [f32; 3],
    /// k - c and c.
    along: f32,
    all_around: f32,
}

/// All contacts of a step.
#[derive(Debug, Default)]
pub(crate) struct ContactMatrix {
    tangents: Vec<Tangent>,
    /// Particles that take part, in order, and where their incidences begin; one more for the end.
    particles: Vec<u32>,
    starts: Vec<u32>,
    /// Contact and weight of each incidence.
    incidences: Vec<(u32, f32)>,
    /// For each chunk of particles, where it begins in `particles`.
    chunks: Vec<u32>,
    /// What each contact feels: scratch of a product.
    forces: Mutex<Vec<[f32; 3]>>,
}

impl ContactMatrix {
    /// Takes over which particles the contacts join; `count` particles there are.
    pub(super) fn join(&mut self, contacts: &[Contact], inverse_masses: &[f64]) {
        let count = inverse_masses.len();
        let moves = |point: u32| inverse_masses.get(point as usize).is_some_and(|&inverse| inverse > 0.0);
        self.tangents.clear();
        self.tangents.extend(contacts.iter().map(|contact| {
            let mut tangent = Tangent {
                points: contact.points,
                weights: contact.weights.map(|weight| weight as f32),
                normal: contact.normal.map(|x| x as f32).into(),
                along: 0.0,
                all_around: 0.0,
            };
            for i in 0..4 {
                if !moves(tangent.points[i]) {
                    (tangent.points[i], tangent.weights[i]) = (0, 0.0);
                }
            }
            tangent
        }));
        self.sort_by_particle(count);
        self.chunks.clear();
        let firsts = (0..=count.div_ceil(CHUNK)).map(|chunk| {
            self.particles.partition_point(|&particle| (particle as usize) < chunk * CHUNK) as u32
        });
        self.chunks.extend(firsts);
        let forces = self.forces.get_mut().unwrap_or_else(PoisonError::into_inner);
        forces.clear();
        forces.resize(contacts.len(), [0.0; 3]);
    }

    /// Lists the contacts of every particle, in their order.
    fn sort_by_particle(&mut self, count: usize) {
        let ends = |tangent: &Tangent| {
            tangent.points.into_iter().zip(tangent.weights).filter(|&(_, weight)| weight != 0.0)
        };
        let mut next = vec![0_u32; count];
        for (point, _) in self.tangents.iter().flat_map(ends) {
            next[point as usize] += 1;
        }
        self.particles.clear();
        self.starts.clear();
        let mut total = 0;
        for (particle, next) in next.iter_mut().enumerate() {
            if *next > 0 {
                self.particles.push(particle as u32);
                self.starts.push(total);
                total += std::mem::replace(next, total);
            }
        }
        self.starts.push(total);
        self.incidences.clear();
        self.incidences.resize(total as usize, (0, 0.0));
        for (contact, tangent) in self.tangents.iter().enumerate() {
            for (point, weight) in ends(tangent) {
                let place = &mut next[point as usize];
                self.incidences[*place as usize] = (contact as u32, weight);
                *place += 1;
            }
        }
    }

    /// The particles that take part, in order.
    pub(crate) fn particles(&self) -> &[u32] {
        &self.particles
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.tangents.is_empty()
    }

    /// Sets slope k and resistance c (N/m) of every contact.
    pub(super) fn set(&mut self, factors: &[[f64; 2]]) {
        for (tangent, [slope, resistance]) in self.tangents.iter_mut().zip(factors) {
            tangent.along = (slope - resistance) as f32;
            tangent.all_around = *resistance as f32;
        }
    }

    /// `out += A p`, or `out -= A p`.
    pub(crate) fn add<const SUBTRACT: bool>(&self, p: &Field, out: &mut Field) {
        if self.is_empty() {
            return;
        }
        let mut forces = self.forces.lock().unwrap_or_else(PoisonError::into_inner);
        let sign = if SUBTRACT { -1.0 } else { 1.0 };
        let pairs = forces.par_iter_mut().zip(&self.tangents).with_min_len(CONTACTS);
        pairs.for_each(|(force, tangent)| *force = tangent.pull(p, sign));
        let forces = &*forces;
        out.chunks_mut().enumerate().for_each(|(chunk, mut out)| {
            for place in self.places(chunk) {
                let mut sum = [0.0_f32; 3];
                for (contact, weight) in self.incidences_of(place) {
                    let force = forces[contact as usize];
                    for axis in 0..3 {
                        sum[axis] += weight * force[axis];
                    }
                }
                let particle = self.particles[place] as usize - chunk * CHUNK;
                for (axis, sum) in out.iter_mut().zip(sum) {
                    axis[particle] += sum;
                }
            }
        });
    }

    /// Adds forces along the contacts (N, vectors for each contact) to the particles, in f64.
    pub(super) fn add_forces(&self, forces: &[Vector], out: &mut Coordinates) {
        for (place, &particle) in self.particles.iter().enumerate() {
            let sum = self
                .incidences_of(place)
                .fold(Vector::zeros(), |sum, (contact, weight)| {
                    sum + f64::from(weight) * forces[contact as usize]
                });
            for axis in 0..3 {
                out.0[axis][particle as usize] += sum[axis];
            }
        }
    }

    /// Adds to the diagonal blocks of a chunk twice what contacts have there: four points are joined, not two as by a
    /// spring, and the whole stays below twice the blocks.
    pub(crate) fn add_blocks(&self, first: usize, blocks: &mut Entries<&mut [f32]>) {
        if self.is_empty() {
            return;
        }
        for place in self.places(first / CHUNK) {
            let particle = self.particles[place] as usize - first;
            for (contact, weight) in self.incidences_of(place) {
                let Tangent { normal: [x, y, z], along, all_around, .. } =
                    self.tangents[contact as usize];
                let square = 2.0 * weight * weight;
                let (along, all_around) = (square * along, square * all_around);
                blocks[0][particle] += along * x * x + all_around;
                blocks[1][particle] += along * y * x;
                blocks[2][particle] += along * y * y + all_around;
                blocks[3][particle] += along * z * x;
                blocks[4][particle] += along * z * y;
                blocks[5][particle] += along * z * z + all_around;
            }
        }
    }

    fn places(&self, chunk: usize) -> std::ops::Range<usize> {
        self.chunks[chunk] as usize..self.chunks[chunk + 1] as usize
    }

    fn incidences_of(&self, place: usize) -> impl Iterator<Item = (u32, f32)> {
        let incidences = self.starts[place] as usize..self.starts[place + 1] as usize;
        self.incidences[incidences].iter().copied()
    }
}

impl Tangent {
    /// What the contact feels of moves p: `k n (n·u) + c (u - n (n·u))`, u the sum of moves by weight.
    #[inline]
    fn pull(&self, p: &Field, sign: f32) -> [f32; 3] {
        let mut u = [0.0_f32; 3];
        for (point, weight) in self.points.into_iter().zip(self.weights) {
            for axis in 0..3 {
                u[axis] += weight * p.0[axis][point as usize];
            }
        }
        let [x, y, z] = self.normal;
        let along = sign * self.along * (x * u[0] + y * u[1] + z * u[2]);
        let all_around = sign * self.all_around;
        [x * along + all_around * u[0], y * along + all_around * u[1], z * along + all_around * u[2]]
    }
}
