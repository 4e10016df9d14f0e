//! The Hessian of an implicit step, frozen at one state and never written down as a matrix.
//!
//! A spring of present length l, rest length L, direction n and force T(l) adds, for `d = d_i - d_j`,
//!
//! ```text
//! alpha n (n·d) + beta d        beta = max(0, T/l) + kd/h'  (relative damping)
//!                               alpha = max(0, T' - T/l) + kd/h'  (axial damping)
//! ```
//!
//! to row i and its opposite to row j. Hooke's law has T' = k and T/l = k (1 - L/l): what a compressed spring would
//! make negative is left out, so that H is positive definite. Beyond the allowed length equation 6 has
//! T/l = k (l/L - 1) and T' = k (2 l/L - 1).
//!
//! Springs lie as [`crate::kernel`] lays them out: diagonals of equal offset, whose ends load as vectors, and the
//! rest gathered.
//!
//! Source: Choi & Ko 2002 for the clamp.

use pulp::{Arch, Scalar, Simd, WithSimd};
use rayon::prelude::*;

use crate::kernel::{CHUNK, Diagonal, GATHERED, GatherSlot, Layout};
use crate::law::spring::{Damping, Law};
use crate::linear::{Field, Operator};
use crate::state::Coordinates;

/// `sqrt(alpha) n` and beta of springs side by side.
#[derive(Clone, Debug, Default)]
struct Tangents([Vec<f32>; 4]);

/// The same of one slot of gathered springs.
type SlotTangents = [[f32; GATHERED]; 4];

/// The matrix at one state.
#[derive(Debug)]
pub(super) struct Hessian {
    /// For each diagonal of the layout.
    diagonals: Vec<Tangents>,
    /// For each gathered slot of the layout.
    slots: Vec<SlotTangents>,
    /// `m/h'² + ka/h'` (kg/s²); 0 where pinned.
    pub(super) inertia: Vec<f32>,
    arch: Arch,
}

impl Hessian {
    pub(super) fn new(layout: &Layout, particle_count: usize) -> Self {
        let diagonals = layout.diagonals.iter().map(|diagonal| {
            let count = diagonal.rest_lengths.len();
            Tangents(std::array::from_fn(|_| vec![0.0; count]))
        });
        Self {
            diagonals: diagonals.collect(),
            slots: vec![SlotTangents::default(); layout.gather_slots.len()],
            inertia: vec![0.0; particle_count],
            arch: Arch::new(),
        }
    }

    /// Takes the springs' tangents at these positions, for a step h' (s).
    pub(super) fn freeze(&mut self, layout: &Layout, positions: &Coordinates, h: f64) {
        let arch = self.arch;
        for (diagonal, tangents) in layout.diagonals.iter().zip(&mut self.diagonals) {
            let [x, y, z, beta] = tangents.0.each_mut().map(|axis| axis.par_chunks_mut(CHUNK));
            (x, y, z, beta).into_par_iter().enumerate().for_each(|(chunk, (x, y, z, beta))| {
                let first = chunk * CHUNK;
                arch.dispatch(Freeze { diagonal, positions, h, first, out: [x, y, z, beta] });
            });
        }
        for gather in &layout.gathers {
            let slots = &layout.gather_slots[gather.slots.clone()];
            for (slot, out) in slots.iter().zip(&mut self.slots[gather.slots.clone()]) {
                freeze_slot(slot, &gather.particles, gather.law, positions, h, out);
            }
        }
    }

    /// The product with H on the springs of a layout.
    pub(super) fn on<'a>(&'a self, layout: &'a Layout) -> Product<'a> {
        Product { hessian: self, layout }
    }
}

/// `sqrt(alpha) n` and beta of one spring that spans `d` (m), for a step h' (s).
#[inline(always)]
fn tangent(
    law: Law,
    stiffness: f32,
    damping_by_step: f32,
    rest_length: f32,
    [x, y, z]: [f32; 3],
) -> [f32; 4] {
    let is_spring = if rest_length > 0.0 { 1.0 } else { 0.0 };
    let length = (x * x + y * y + z * z).sqrt().max(f32::MIN_POSITIVE);
    let ratio = length / rest_length.max(f32::MIN_POSITIVE);
    // Where a diagonal has no spring the ratio is beyond all bounds, and 0 times infinity would be NaN.
    let is_stiffer = rest_length > 0.0 && ratio > law.stiffen_beyond as f32;
    let (tension, slope) =
        if is_stiffer { (ratio - 1.0, 2.0 * ratio - 1.0) } else { (1.0 - 1.0 / ratio, 1.0) };
    let tension = tension.max(0.0);
    let mut along = stiffness * (slope - tension).max(0.0);
    let mut across = stiffness * tension;
    match law.damping {
        Damping::None => {}
        Damping::Relative => across += damping_by_step,
        Damping::Axial => along += damping_by_step,
    }
    let scale = is_spring * along.sqrt() / length;
    [scale * x, scale * y, scale * z, is_spring * across]
}

/// The tangents of one chunk of a diagonal.
struct Freeze<'a> {
    diagonal: &'a Diagonal,
    positions: &'a Coordinates,
    h: f64,
    /// First of the chunk's springs.
    first: usize,
    out: [&'a mut [f32]; 4],
}

impl WithSimd for Freeze<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { diagonal, positions, h, first, out: [x, y, z, beta] } = self;
        let count = x.len();
        let near = diagonal.first + first;
        let [ax, ay, az] = positions.0.each_ref().map(|axis| &axis[near..][..count]);
        let far = near + diagonal.offset;
        let [bx, by, bz] = positions.0.each_ref().map(|axis| &axis[far..][..count]);
        let rest_lengths = &diagonal.rest_lengths[first..][..count];
        let (y, z, beta) = (&mut y[..count], &mut z[..count], &mut beta[..count]);
        let stiffness = diagonal.stiffness as f32;
        let damping = (diagonal.damping / h) as f32;
        for i in 0..count {
            let span = [ax[i] - bx[i], ay[i] - by[i], az[i] - bz[i]].map(|d| d as f32);
            let rest_length = rest_lengths[i] as f32;
            [x[i], y[i], z[i], beta[i]] =
                tangent(diagonal.law, stiffness, damping, rest_length, span);
        }
    }
}

fn freeze_slot(
    slot: &GatherSlot,
    particles: &[u32; GATHERED],
    law: Law,
    positions: &Coordinates,
    h: f64,
    out: &mut SlotTangents,
) {
    for lane in 0..GATHERED {
        let [a, b] = [particles[lane], slot.neighbors[lane]].map(|end| end as usize);
        let span = positions.0.each_ref().map(|axis| (axis[a] - axis[b]) as f32);
        let damping = (slot.damping[lane] / h) as f32;
        let (stiffness, rest_length) =
            (slot.stiffness[lane] as f32, slot.rest_lengths[lane] as f32);
        let tangent = tangent(law, stiffness, damping, rest_length, span);
        for (out, value) in out.iter_mut().zip(tangent) {
            out[lane] = value;
        }
    }
}

/// The matrix with the layout that says where its springs are.
pub(super) struct Product<'a> {
    hessian: &'a Hessian,
    layout: &'a Layout,
}

impl Operator for Product<'_> {
    fn apply(&self, p: &Field, out: &mut Field) {
        let [x, y, z] = out.0.each_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        (x, y, z).into_par_iter().enumerate().for_each(|(chunk, (x, y, z))| {
            let first = chunk * CHUNK;
            self.hessian.arch.dispatch(Rows { product: self, p, first, out: [x, y, z] });
        });
    }
}

/// The rows of one chunk of particles.
struct Rows<'a> {
    product: &'a Product<'a>,
    p: &'a Field,
    first: usize,
    out: [&'a mut [f32]; 3],
}

impl WithSimd for Rows<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { product: Product { hessian, layout }, p, first, mut out } = self;
        for axis in &mut out {
            axis.fill(0.0);
        }
        let own = first..first + out[0].len();
        for (diagonal, tangents) in layout.diagonals.iter().zip(&hessian.diagonals) {
            let springs = diagonal.first..diagonal.first + diagonal.rest_lengths.len();
            let offset = diagonal.offset;
            // Springs that begin at an own particle, then those that end at one.
            for (begin, to_other) in [(0, offset as isize), (offset, -(offset as isize))] {
                let from = (springs.start + begin).max(own.start);
                let to = (springs.end + begin).min(own.end);
                if from >= to {
                    continue;
                }
                let spring = from - begin - springs.start;
                let other = from.wrapping_add_signed(to_other);
                let count = to - from;
                add_springs(
                    simd,
                    tangents.0.each_ref().map(|axis| &axis[spring..][..count]),
                    p.0.each_ref().map(|axis| &axis[from..][..count]),
                    p.0.each_ref().map(|axis| &axis[other..][..count]),
                    out.each_mut().map(|axis| &mut axis[from - first..][..count]),
                );
            }
        }
        for gather in &layout.gathers[layout.gathers_of_chunk[first / CHUNK].clone()] {
            let slots = gather.slots.clone();
            let springs = layout.gather_slots[slots.clone()].iter().zip(&hessian.slots[slots]);
            let own = pick(p, &gather.particles);
            let mut sums = [[0.0_f32; GATHERED]; 3];
            for (slot, [nx, ny, nz, beta]) in springs {
                let [ox, oy, oz] = pick(p, &slot.neighbors);
                for i in 0..GATHERED {
                    let (dx, dy, dz) = (own[0][i] - ox[i], own[1][i] - oy[i], own[2][i] - oz[i]);
                    let along = nx[i] * dx + ny[i] * dy + nz[i] * dz;
                    sums[0][i] += along * nx[i] + beta[i] * dx;
                    sums[1][i] += along * ny[i] + beta[i] * dy;
                    sums[2][i] += along * nz[i] + beta[i] * dz;
                }
            }
            for i in 0..gather.count {
                for axis in 0..3 {
                    out[axis][gather.particles[i] as usize - first] += sums[axis][i];
                }
            }
        }
        let inertia = &hessian.inertia[own.clone()];
        for (out, p) in out.into_iter().zip(&p.0) {
            for ((out, p), inertia) in out.iter_mut().zip(&p[own.clone()]).zip(inertia) {
                *out = if *inertia > 0.0 { *out + inertia * p } else { 0.0 };
            }
        }
    }
}

#[inline(always)]
fn pick(field: &Field, particles: &[u32; GATHERED]) -> [[f32; GATHERED]; 3] {
    field.0.each_ref().map(|axis| particles.map(|particle| axis[particle as usize]))
}

/// Adds to one end of springs what they make of both ends' vectors.
#[inline(always)]
fn add_springs<S: Simd>(
    simd: S,
    tangents: [&[f32]; 4],
    own: [&[f32]; 3],
    other: [&[f32]; 3],
    out: [&mut [f32]; 3],
) {
    let whole = own[0].len() / S::F32_LANES * S::F32_LANES;
    let (tangents, tangents_rest) = split(tangents, whole);
    let (own, own_rest) = split(own, whole);
    let (other, other_rest) = split(other, whole);
    let [x, y, z] = out;
    let ((x, x_rest), (y, y_rest), (z, z_rest)) =
        (x.split_at_mut(whole), y.split_at_mut(whole), z.split_at_mut(whole));
    add_whole(simd, tangents, own, other, [x, y, z]);
    let out = [x_rest, y_rest, z_rest];
    add_whole(Scalar::new(), tangents_rest, own_rest, other_rest, out);
}

#[inline(always)]
fn split<const N: usize>(slices: [&[f32]; N], at: usize) -> ([&[f32]; N], [&[f32]; N]) {
    (slices.map(|slice| &slice[..at]), slices.map(|slice| &slice[at..]))
}

#[inline(always)]
fn add_whole<S: Simd>(
    simd: S,
    tangents: [&[f32]; 4],
    own: [&[f32]; 3],
    other: [&[f32]; 3],
    out: [&mut [f32]; 3],
) {
    let [nx, ny, nz, beta] = tangents.map(|slice| S::as_simd_f32s(slice).0);
    let [px, py, pz] = own.map(|slice| S::as_simd_f32s(slice).0);
    let [ox, oy, oz] = other.map(|slice| S::as_simd_f32s(slice).0);
    let [x, y, z] = out.map(|slice| S::as_mut_simd_f32s(slice).0);
    let count = x.len();
    let (nx, ny, nz, beta) = (&nx[..count], &ny[..count], &nz[..count], &beta[..count]);
    let (px, py, pz) = (&px[..count], &py[..count], &pz[..count]);
    let (ox, oy, oz) = (&ox[..count], &oy[..count], &oz[..count]);
    let (y, z) = (&mut y[..count], &mut z[..count]);
    for i in 0..count {
        let [dx, dy, dz] = [(px, ox), (py, oy), (pz, oz)].map(
            #[inline(always)]
            |(p, o)| simd.sub_f32s(p[i], o[i]),
        );
        let along = simd.add_f32s(
            simd.add_f32s(simd.mul_f32s(nx[i], dx), simd.mul_f32s(ny[i], dy)),
            simd.mul_f32s(nz[i], dz),
        );
        for (out, n, d) in [(&mut x[i], nx[i], dx), (&mut y[i], ny[i], dy), (&mut z[i], nz[i], dz)]
        {
            let sum = simd.add_f32s(simd.mul_f32s(along, n), simd.mul_f32s(beta[i], d));
            *out = simd.add_f32s(*out, sum);
        }
    }
}
