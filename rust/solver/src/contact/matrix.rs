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
    /// Whether a point takes part that does not move by itself.
    is_held: bool,
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
    /// L⁻¹ of `L Lᵀ = I + C/inertia` for each particle that takes part, C the block that contacts add to it: xx, yx, yy, zx,
    /// zy, zz.
    roots: Vec<Entries<f32>>,
}

impl ContactMatrix {
    /// Takes over which particles the contacts join; `count` particles there are.
    pub(super) fn join(&mut self, contacts: &[Contact], inverse_masses: &[f64]) {
        let count = inverse_masses.len();
        let moves =
            |point: u32| inverse_masses.get(point as usize).is_some_and(|&inverse| inverse > 0.0);
        self.tangents.clear();
        self.tangents.extend(contacts.iter().map(|contact| {
            let mut tangent = Tangent {
                points: contact.points,
                weights: contact.weights.map(|weight| weight as f32),
                normal: contact.normal.map(|x| x as f32).into(),
                along: 0.0,
                all_around: 0.0,
                is_held: false,
            };
            for i in 0..4 {
                if !moves(tangent.points[i]) {
                    tangent.is_held |= tangent.weights[i] != 0.0;
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

    /// The particles that each contact joins, and whether it joins them to something held.
    pub(crate) fn joints(&self) -> impl Iterator<Item = (impl Iterator<Item = u32>, bool)> {
        self.tangents.iter().map(|tangent| {
            let ends = tangent.points.into_iter().zip(tangent.weights);
            (ends.filter(|end| end.1 != 0.0).map(|end| end.0), tangent.is_held)
        })
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
            let sum = self.incidences_of(place).fold(Vector::zeros(), |sum, (contact, weight)| {
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

    /// Weighs what contacts add to each particle against its inertia (kg/s²).
    pub(crate) fn weigh(&mut self, inertia: &[f32]) {
        let mut roots = std::mem::take(&mut self.roots);
        let places = (0..self.particles.len()).into_par_iter().with_min_len(CONTACTS);
        let each = places.map(|place| {
            let mut block = [1.0, 0.0, 1.0, 0.0, 0.0, 1.0];
            let by_inertia = 1.0 / inertia[self.particles[place] as usize];
            for (contact, weight) in self.incidences_of(place) {
                let Tangent { normal: [x, y, z], along, all_around, .. } =
                    self.tangents[contact as usize];
                let square = weight * weight * by_inertia;
                let products = [x * x, y * x, y * y, z * x, z * y, z * z];
                for (entry, product) in block.iter_mut().zip(products) {
                    *entry += square * along * product;
                }
                for entry in [0, 2, 5] {
                    block[entry] += square * all_around;
                }
            }
            inverse_root(block)
        });
        each.collect_into_vec(&mut roots);
        self.roots = roots;
    }

    /// `p = L⁻¹ p` for the particles that take part; returns what they had.
    pub(crate) fn lighten(&self, p: &mut Field) -> Vec<[f32; 3]> {
        self.change(p, |[xx, yx, yy, zx, zy, zz], [x, y, z]| {
            [xx * x, yx * x + yy * y, zx * x + zy * y + zz * z]
        })
    }

    /// `p = L⁻ᵀ p` for the particles that take part.
    pub(crate) fn lighten_transposed(&self, p: &mut Field) {
        self.change(p, |[xx, yx, yy, zx, zy, zz], [x, y, z]| {
            [xx * x + yx * y + zx * z, yy * y + zy * z, zz * z]
        });
    }

    /// Gives the particles that take part these vectors.
    pub(crate) fn put_back(&self, vectors: &[[f32; 3]], p: &mut Field) {
        for (&particle, vector) in self.particles.iter().zip(vectors) {
            for (axis, value) in p.0.iter_mut().zip(vector) {
                axis[particle as usize] = *value;
            }
        }
    }

    fn change(
        &self,
        p: &mut Field,
        by: impl Fn(&Entries<f32>, [f32; 3]) -> [f32; 3],
    ) -> Vec<[f32; 3]> {
        let change = |(&particle, root): (&u32, &Entries<f32>)| {
            let before = p.0.each_ref().map(|axis| axis[particle as usize]);
            for (axis, value) in p.0.iter_mut().zip(by(root, before)) {
                axis[particle as usize] = value;
            }
            before
        };
        self.particles.iter().zip(&self.roots).map(change).collect()
    }

    fn places(&self, chunk: usize) -> std::ops::Range<usize> {
        self.chunks[chunk] as usize..self.chunks[chunk + 1] as usize
    }

    fn incidences_of(&self, place: usize) -> impl Iterator<Item = (u32, f32)> {
        let incidences = self.starts[place] as usize..self.starts[place + 1] as usize;
        self.incidences[incidences].iter().copied()
    }
}

/// L⁻¹ of a block `L Lᵀ`.
fn inverse_root([xx, yx, yy, zx, zy, zz]: Entries<f32>) -> Entries<f32> {
    // The blocks are no less than the identity; rounding must not make them so.
    let x = 1.0 / xx.max(1.0).sqrt();
    let (lyx, lzx) = (yx * x, zx * x);
    let y = 1.0 / (yy - lyx * lyx).max(1.0).sqrt();
    let lzy = (zy - lzx * lyx) * y;
    let z = 1.0 / (zz - lzx * lzx - lzy * lzy).max(1.0).sqrt();
    let inverse_yx = -lyx * x * y;
    let inverse_zx = -(lzx * x + lzy * inverse_yx) * z;
    [x, inverse_yx, y, inverse_zx, -lzy * y * z, z]
}

impl Tangent {
    /// What the contact feels of moves p: `k n (n·u) + c (u - n (n·u))`, u the sum of moves by weight.
    #[inline]
    fn pull(&self, p: &Field, sign: f32) -> [f32; 3] {
        let mut u = [0.0_f32; 3];
        for (point, weight) in self.points.into_iter().zip(self.weights) {
            for (sum, axis) in u.iter_mut().zip(&p.0) {
                *sum += weight * axis[point as usize];
            }
        }
        let [x, y, z] = self.normal;
        let along = sign * self.along * (x * u[0] + y * u[1] + z * u[2]);
        let all_around = sign * self.all_around;
        [
            x * along + all_around * u[0],
            y * along + all_around * u[1],
            z * along + all_around * u[2],
        ]
    }
}
