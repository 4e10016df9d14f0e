//! The tangents of triangles and hinges at one state, and products with them.
//!
//! Triangles lie side by side in packs, those of each chunk of particles together; one that reaches over a border is in the
//! packs of both sides, and each side adds to its own particles only.

use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use super::compliance;
use super::membrane::positive_part;
use super::{FabricScratch, Fabrics};
use crate::kernel::CHUNK;
use crate::linear::{Entries, Field};
use crate::state::Coordinates;

/// Triangles in a pack.
const LANES: usize = 8;

/// Packs and hinges that one task freezes at the least.
const TASK: usize = 512;

type Lanes = [f32; LANES];

/// Triangles side by side; what is left of the last pack of a chunk has no stiffness.
#[derive(Clone, Debug, Default)]
struct Pack {
    numbers: [u32; LANES],
    count: usize,
    corners: [[u32; LANES]; 3],
    /// Gradients (1/m) of the second and third corner along the warp, then along the weft.
    gradients: [Lanes; 4],
    /// U, V (3 each).
    frame: [Lanes; 6],
    /// Area times stiffness (N m) of warp, weft and shear, damping included.
    stiffness: [Lanes; 3],
    /// Area times the stress that pulls: ww, ff, wf (N m).
    stress: [Lanes; 3],
}

/// The tangents of all fabrics.
#[derive(Debug, Default)]
pub(crate) struct Tangent {
    packs: Vec<Pack>,
    packs_of_chunk: Vec<Range<usize>>,
    /// Gradients of the angles (1/m).
    hinges: Vec<[[f32; 3]; 4]>,
    /// `1 + t/h'` of each law.
    damped: Vec<f32>,
    bending: Mutex<Bending>,
}

/// Vectors of one product.
#[derive(Debug, Default)]
struct Bending {
    angles: Vec<f32>,
    moments: Vec<f32>,
    steps: compliance::Scratch<f32>,
}

impl Tangent {
    pub(crate) fn new(fabrics: &Fabrics, particle_count: usize) -> Self {
        let (mut packs, mut packs_of_chunk) = (Vec::new(), Vec::new());
        for chunk in 0..particle_count.div_ceil(CHUNK) {
            let first = packs.len();
            let numbers = fabrics.triangles_of.of(chunk);
            packs.extend(numbers.chunks(LANES).map(|numbers| pack(fabrics, numbers)));
            packs_of_chunk.push(first..packs.len());
        }
        Self { packs, packs_of_chunk, ..Self::default() }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.packs.is_empty()
    }

    /// Takes the tangents at these positions, in which hinges were observed, for a step h' (s).
    pub(crate) fn freeze(
        &mut self,
        fabrics: &Fabrics,
        scratch: &FabricScratch,
        positions: &Coordinates,
        h: f64,
    ) {
        if self.is_empty() {
            return;
        }
        self.packs.par_iter_mut().with_min_len(TASK).for_each(|pack| {
            for lane in 0..pack.count {
                let triangle = &fabrics.triangles[pack.numbers[lane] as usize];
                let law = &fabrics.laws[triangle.law as usize];
                let frame = triangle.frame(|corner| positions.get(corner as usize));
                let strained = law.strained(frame);
                let [stretch, shear] = law.times.map(|time| 1.0 + time / h);
                let [warp, weft] = strained.stiffness.map(|of| triangle.area * of * stretch);
                let stiffness = [warp, weft, triangle.area * law.shear * shear];
                let stress = positive_part(strained.stress).map(|of| triangle.area * of);
                let frame = frame.iter().flat_map(|axis| axis.iter().copied());
                put(&mut pack.frame, lane, frame);
                put(&mut pack.stiffness, lane, stiffness);
                put(&mut pack.stress, lane, stress);
            }
        });
        self.hinges.resize(scratch.gradients.len(), [[0.0; 3]; 4]);
        let hinges = self.hinges.par_iter_mut().zip(&scratch.gradients);
        hinges.with_min_len(TASK).for_each(|(own, gradients)| {
            *own = gradients.map(|gradient| [0, 1, 2].map(|axis| gradient[axis] as f32));
        });
        self.damped = fabrics.bend_times.iter().map(|time| (1.0 + time / h) as f32).collect();
    }
}

/// Tangents with the fabrics that they are of.
#[derive(Clone, Copy)]
pub(crate) struct FabricProduct<'a> {
    pub(crate) fabrics: &'a Fabrics,
    pub(crate) tangent: &'a Tangent,
}

/// The moments that a field turns hinges against.
pub(crate) struct Moments<'a>(MutexGuard<'a, Bending>);

impl<'a> FabricProduct<'a> {
    pub(crate) fn is_empty(&self) -> bool {
        self.tangent.is_empty()
    }

    /// What hinges do as particles move by a field: to be added chunk by chunk. Either as faces share their angles, or, to
    /// smooth with, as if each were alone.
    pub(crate) fn bend(&self, p: &Field, is_shared: bool) -> Moments<'a> {
        let Self { fabrics, tangent } = *self;
        // Whoever panicked before left numbers that are all filled anew.
        let mut bending = tangent.bending.lock().unwrap_or_else(PoisonError::into_inner);
        let Bending { angles, moments, steps } = &mut *bending;
        angles.resize(tangent.hinges.len(), 0.0);
        let hinges = fabrics.hinges.par_iter().zip(&tangent.hinges).zip(&mut *angles);
        hinges.with_min_len(TASK).for_each(|((hinge, gradients), angle)| {
            let mut sum = 0.0;
            for (&corner, gradient) in hinge.corners.iter().zip(gradients) {
                for (gradient, p) in gradient.iter().zip(&p.0) {
                    sum += gradient * p[corner as usize];
                }
            }
            *angle = tangent.damped[hinge.law as usize] * sum;
        });
        if is_shared {
            fabrics.compliance.moments(angles, moments, steps, |value| value as f32);
        } else {
            fabrics.compliance.moments_alone(angles, moments);
        }
        Moments(bending)
    }

    /// Adds what the triangles of a chunk resist a field with to its particles, or subtracts it.
    #[inline(always)]
    pub(crate) fn add_membrane<const SUBTRACT: bool>(
        &self,
        p: &Field,
        first: usize,
        out: &mut [&mut [f32]; 3],
    ) {
        let sign = if SUBTRACT { -1.0 } else { 1.0 };
        for pack in &self.tangent.packs[self.tangent.packs_of_chunk[first / CHUNK].clone()] {
            let forces = pack.resist(sign, p);
            for (corners, force) in pack.corners.iter().zip(&forces) {
                for lane in 0..pack.count {
                    let place = (corners[lane] as usize).wrapping_sub(first);
                    if place < out[0].len() {
                        for axis in 0..3 {
                            out[axis][place] += force[axis][lane];
                        }
                    }
                }
            }
        }
    }

    /// Adds what hinges resist with to the particles of a chunk, or subtracts it.
    #[inline(always)]
    pub(crate) fn add_bending<const SUBTRACT: bool>(
        &self,
        moments: &Moments<'_>,
        first: usize,
        out: &mut [&mut [f32]; 3],
    ) {
        let Self { fabrics, tangent } = *self;
        for &number in fabrics.hinges_of.of(first / CHUNK) {
            let number = number as usize;
            let moment = moments.0.moments[number];
            let moment = if SUBTRACT { -moment } else { moment };
            let corners = fabrics.hinges[number].corners.iter();
            for (&corner, gradient) in corners.zip(&tangent.hinges[number]) {
                let place = (corner as usize).wrapping_sub(first);
                if place < out[0].len() {
                    for axis in 0..3 {
                        out[axis][place] += moment * gradient[axis];
                    }
                }
            }
        }
    }

    /// Adds the blocks on the diagonal of a chunk's particles, of hinges as if each were alone.
    pub(crate) fn add_blocks(&self, first: usize, blocks: &mut Entries<&mut [f32]>) {
        let Self { fabrics, tangent } = *self;
        for &number in fabrics.hinges_of.of(first / CHUNK) {
            let hinge = &fabrics.hinges[number as usize];
            let stiffness = tangent.damped[hinge.law as usize]
                * fabrics.compliance.stiffness_alone(number as usize) as f32;
            let gradients = &tangent.hinges[number as usize];
            for (&corner, [x, y, z]) in hinge.corners.iter().zip(gradients) {
                let place = (corner as usize).wrapping_sub(first);
                if place < blocks[0].len() {
                    let products = [x * x, y * x, y * y, z * x, z * y, z * z];
                    for (entries, product) in blocks.iter_mut().zip(products) {
                        entries[place] += stiffness * product;
                    }
                }
            }
        }
        for pack in &self.tangent.packs[self.tangent.packs_of_chunk[first / CHUNK].clone()] {
            for lane in 0..pack.count {
                for (i, corners) in pack.corners.iter().enumerate() {
                    let place = (corners[lane] as usize).wrapping_sub(first);
                    if place < blocks[0].len() {
                        for (entries, value) in blocks.iter_mut().zip(pack.block(lane, i)) {
                            entries[place] += value;
                        }
                    }
                }
            }
        }
    }
}

impl Pack {
    /// The forces that resist a field at the three corners, axis by axis.
    #[inline(always)]
    fn resist(&self, sign: f32, p: &Field) -> [[Lanes; 3]; 3] {
        let [a, b, c] = self.corners.each_ref().map(
            #[inline(always)]
            |corners| {
                p.0.each_ref().map(
                    #[inline(always)]
                    |axis| corners.map(|corner| axis[corner as usize]),
                )
            },
        );
        let mut forces = [[[0.0; LANES]; 3]; 3];
        let [bw, cw, bf, cf] = &self.gradients;
        let [yw, yf, g] = &self.stiffness;
        let [sww, sff, swf] = &self.stress;
        for i in 0..LANES {
            let u = [self.frame[0][i], self.frame[1][i], self.frame[2][i]];
            let v = [self.frame[3][i], self.frame[4][i], self.frame[5][i]];
            let (mut pu, mut pv) = ([0.0; 3], [0.0; 3]);
            for axis in 0..3 {
                let (db, dc) = (b[axis][i] - a[axis][i], c[axis][i] - a[axis][i]);
                pu[axis] = bw[i] * db + cw[i] * dc;
                pv[axis] = bf[i] * db + cf[i] * dc;
            }
            let dot = |x: [f32; 3], y: [f32; 3]| x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
            let warp = yw[i] * dot(u, pu);
            let weft = yf[i] * dot(v, pv);
            let slide = g[i] * (dot(u, pv) + dot(v, pu));
            for axis in 0..3 {
                let by_warp =
                    warp * u[axis] + slide * v[axis] + sww[i] * pu[axis] + swf[i] * pv[axis];
                let by_weft =
                    weft * v[axis] + slide * u[axis] + swf[i] * pu[axis] + sff[i] * pv[axis];
                let at_b = sign * (bw[i] * by_warp + bf[i] * by_weft);
                let at_c = sign * (cw[i] * by_warp + cf[i] * by_weft);
                forces[0][axis][i] = -(at_b + at_c);
                forces[1][axis][i] = at_b;
                forces[2][axis][i] = at_c;
            }
        }
        forces
    }

    /// xx, yx, yy, zx, zy, zz of the block of a corner.
    fn block(&self, lane: usize, corner: usize) -> [f32; 6] {
        let [bw, cw, bf, cf] = self.gradients.each_ref().map(|of| of[lane]);
        let [w, f] = [[-(bw + cw), -(bf + cf)], [bw, bf], [cw, cf]][corner];
        let [ux, uy, uz, vx, vy, vz] = self.frame.each_ref().map(|of| of[lane]);
        let [yw, yf, g] = self.stiffness.each_ref().map(|of| of[lane]);
        let [sww, sff, swf] = self.stress.each_ref().map(|of| of[lane]);
        let (u, v) = ([ux, uy, uz], [vx, vy, vz]);
        let slide = [0, 1, 2].map(|axis| w * v[axis] + f * u[axis]);
        let entry = |i: usize, j: usize| {
            yw * w * w * u[i] * u[j] + yf * f * f * v[i] * v[j] + g * slide[i] * slide[j]
        };
        let all = sww * w * w + 2.0 * swf * w * f + sff * f * f;
        [
            entry(0, 0) + all,
            entry(1, 0),
            entry(1, 1) + all,
            entry(2, 0),
            entry(2, 1),
            entry(2, 2) + all,
        ]
    }
}

fn pack(fabrics: &Fabrics, numbers: &[u32]) -> Pack {
    let mut pack = Pack { count: numbers.len(), ..Pack::default() };
    for lane in 0..LANES {
        // Lanes that are left stand for the last triangle, without stiffness.
        let number = numbers[lane.min(numbers.len() - 1)];
        let triangle = &fabrics.triangles[number as usize];
        let [[_, bw, cw], [_, bf, cf]] = triangle.gradients;
        pack.numbers[lane] = number;
        for (corners, corner) in pack.corners.iter_mut().zip(triangle.corners) {
            corners[lane] = corner;
        }
        put(&mut pack.gradients, lane, [bw, cw, bf, cf]);
    }
    pack
}

fn put<const COUNT: usize>(
    arrays: &mut [Lanes; COUNT],
    lane: usize,
    values: impl IntoIterator<Item = f64>,
) {
    for (array, value) in arrays.iter_mut().zip(values) {
        array[lane] = value as f32;
    }
}
