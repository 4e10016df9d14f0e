//! Products with the Hessian, chunk by chunk of particles.

use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::Hessian;
use crate::contact::ContactMatrix;
use crate::fabric::{FabricProduct, Moments};
use crate::kernel::{CHUNK, GATHERED, Layout};
use crate::linear::{Field, Link, Operator, Row};

/// The matrix with the layout that says where its springs are, and with the contacts.
pub(in crate::implicit) struct Product<'a> {
    pub(super) hessian: &'a Hessian,
    pub(super) layout: &'a Layout,
    pub(super) fabric: FabricProduct<'a>,
    pub(super) contacts: &'a ContactMatrix,
    pub(super) has_bends: bool,
}

impl Product<'_> {
    /// `from -= H p`.
    pub(in crate::implicit) fn subtract(&self, p: &Field, from: &mut Field) {
        self.each_chunk::<true>(p, from);
    }

    fn each_chunk<const SUBTRACT: bool>(&self, p: &Field, out: &mut Field) {
        let arch = self.hessian.arch;
        let bends = self.has_bends && !self.fabric.is_empty();
        let moments = bends.then(|| self.fabric.bend(p));
        let moments = moments.as_ref();
        out.chunks_mut().enumerate().for_each(|(chunk, out)| {
            arch.dispatch(Rows::<SUBTRACT> {
                product: self,
                moments,
                p,
                first: chunk * CHUNK,
                out,
            });
        });
        self.contacts.add::<SUBTRACT>(p, out);
    }
}

impl Operator for Product<'_> {
    fn apply(&self, p: &Field, out: &mut Field) {
        self.each_chunk::<false>(p, out);
    }
}

/// The rows of one chunk of particles.
struct Rows<'a, const SUBTRACT: bool> {
    product: &'a Product<'a>,
    /// Of hinges as faces share them, if they count so.
    moments: Option<&'a Moments<'a>>,
    p: &'a Field,
    first: usize,
    out: [&'a mut [f32]; 3],
}

impl<const SUBTRACT: bool> WithSimd for Rows<'_, SUBTRACT> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { product, moments, p, first, mut out } = self;
        let Product { hessian, layout, fabric, has_bends, .. } = *product;
        if !SUBTRACT {
            for axis in &mut out {
                axis.fill(0.0);
            }
        }
        let own = first..first + out[0].len();
        for (diagonal, tangents) in layout.diagonals.iter().zip(&hessian.diagonals) {
            if diagonal.is_bend && !has_bends {
                continue;
            }
            let numbers = tangents.of(0..diagonal.rest_lengths.len());
            let row = Row { first: diagonal.first, offset: diagonal.offset, numbers, p };
            let [x, y, z] = &mut out;
            row.add::<S, SpringLink, SUBTRACT>(simd, &own, [&mut **x, &mut **y, &mut **z]);
        }
        for gather in &layout.gathers[layout.gathers_of_chunk[first / CHUNK].clone()] {
            let slots = gather.slots.clone();
            let springs = layout.gather_slots[slots.clone()].iter().zip(&hessian.slots[slots]);
            let own = p.pick(&gather.particles);
            let mut sums = [[0.0_f32; GATHERED]; 3];
            for (slot, [nx, ny, nz, beta]) in springs {
                if slot.is_bend && !has_bends {
                    continue;
                }
                let [ox, oy, oz] = p.pick(&slot.neighbors);
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
                    let sum = if SUBTRACT { -sums[axis][i] } else { sums[axis][i] };
                    out[axis][gather.particles[i] as usize - first] += sum;
                }
            }
        }
        if !fabric.is_empty() {
            fabric.add::<S, SUBTRACT>(simd, p, moments, first, &mut out);
        }
        let inertia = &hessian.inertia[own.clone()];
        for (out, p) in out.into_iter().zip(&p.0) {
            for ((out, p), inertia) in out.iter_mut().zip(&p[own.clone()]).zip(inertia) {
                let own = if SUBTRACT { -(inertia * p) } else { inertia * p };
                *out = if *inertia > 0.0 { *out + own } else { 0.0 };
            }
        }
    }
}

/// `alpha n (n·d) + beta d`, of `sqrt(alpha) n` and beta.
struct SpringLink;

impl Link<4> for SpringLink {
    #[inline(always)]
    fn pull<S: Simd>(
        simd: S,
        numbers: [S::f32s; 4],
        [dx, dy, dz]: [S::f32s; 3],
    ) -> [[S::f32s; 3]; 2] {
        let [nx, ny, nz, beta] = numbers;
        let along = simd.add_f32s(
            simd.add_f32s(simd.mul_f32s(nx, dx), simd.mul_f32s(ny, dy)),
            simd.mul_f32s(nz, dz),
        );
        let force = [(nx, dx), (ny, dy), (nz, dz)].map(
            #[inline(always)]
            |(n, d)| simd.add_f32s(simd.mul_f32s(along, n), simd.mul_f32s(beta, d)),
        );
        [force; 2]
    }
}
