//! The tangents of springs at one state.

use pulp::{Simd, WithSimd};

use super::SlotTangents;
use crate::kernel::{Diagonal, GATHERED, GatherSlot};
use crate::law::spring::{Damping, Law};
use crate::state::Coordinates;

/// What springs side by side have in common.
#[derive(Clone, Copy)]
struct Common {
    /// Ratio of length to rest length beyond which equation 6 holds.
    stiffen_beyond: f32,
    /// What damping adds along the spring and across it, for each unit of kd/h'.
    damped: [f32; 2],
}

impl Common {
    fn of(law: Law) -> Self {
        let damped = match law.damping {
            Damping::None => [0.0, 0.0],
            Damping::Relative => [0.0, 1.0],
            Damping::Axial => [1.0, 0.0],
        };
        Self { stiffen_beyond: law.stiffen_beyond as f32, damped }
    }
}

/// `sqrt(alpha) n` and beta of one spring that spans `d` (m), with kd/h' (N/m); zeros for no spring, of rest length 0.
#[inline(always)]
fn tangent<const STIFFENS: bool>(
    Common { stiffen_beyond, damped }: Common,
    [stiffness, damping]: [f32; 2],
    rest_length: f32,
    [x, y, z]: [f32; 3],
) -> [f32; 4] {
    let is_spring = if rest_length > 0.0 { 1.0 } else { 0.0 };
    let length = larger((x * x + y * y + z * z).sqrt(), f32::MIN_POSITIVE);
    let by_length = 1.0 / length;
    let part = rest_length * by_length;
    let mut tension = larger(1.0 - part, 0.0);
    let mut slope = 1.0 - tension;
    if STIFFENS && is_spring * length > stiffen_beyond * rest_length {
        slope = length / rest_length;
        tension = slope - 1.0;
    }
    let along = stiffness * slope + damped[0] * damping;
    let across = stiffness * tension + damped[1] * damping;
    // Ends that coincide have no direction: zeros, before anything large is multiplied.
    let [x, y, z] = [x * by_length, y * by_length, z * by_length];
    let root = is_spring * along.sqrt();
    [root * x, root * y, root * z, is_spring * across]
}

/// The larger of two numbers, as one instruction.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The tangents of one chunk of a diagonal.
pub(super) struct Freeze<'a> {
    pub(super) diagonal: &'a Diagonal,
    pub(super) positions: &'a Coordinates,
    pub(super) h: f64,
    /// First of the chunk's springs.
    pub(super) first: usize,
    pub(super) out: [&'a mut [f32]; 4],
}

impl WithSimd for Freeze<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        if self.diagonal.law.stiffen_beyond.is_finite() {
            freeze::<true>(self);
        } else {
            freeze::<false>(self);
        }
    }
}

#[inline(always)]
fn freeze<const STIFFENS: bool>(chunk: Freeze<'_>) {
    let Freeze { diagonal, positions, h, first, out: [x, y, z, beta] } = chunk;
    let count = x.len();
    let near = diagonal.first + first;
    let far = near + diagonal.offset;
    let [ax, ay, az] = positions.0.each_ref().map(|axis| &axis[near..][..count]);
    let [bx, by, bz] = positions.0.each_ref().map(|axis| &axis[far..][..count]);
    let rest_lengths = &diagonal.rest_lengths[first..][..count];
    let (y, z, beta) = (&mut y[..count], &mut z[..count], &mut beta[..count]);
    let common = Common::of(diagonal.law);
    let factors = [diagonal.stiffness as f32, (diagonal.damping / h) as f32];
    for i in 0..count {
        let span = [ax[i] - bx[i], ay[i] - by[i], az[i] - bz[i]].map(|d| d as f32);
        let rest_length = rest_lengths[i] as f32;
        [x[i], y[i], z[i], beta[i]] = tangent::<STIFFENS>(common, factors, rest_length, span);
    }
}

/// The tangents of one slot of gathered springs.
pub(super) fn freeze_slot(
    slot: &GatherSlot,
    particles: &[u32; GATHERED],
    law: Law,
    positions: &Coordinates,
    h: f64,
    out: &mut SlotTangents,
) {
    let common = Common::of(law);
    for lane in 0..GATHERED {
        let [a, b] = [particles[lane], slot.neighbors[lane]].map(|end| end as usize);
        let span = positions.0.each_ref().map(|axis| (axis[a] - axis[b]) as f32);
        let factors = [slot.stiffness[lane], slot.damping[lane] / h].map(|factor| factor as f32);
        let rest_length = slot.rest_lengths[lane] as f32;
        let tangent = tangent::<true>(common, factors, rest_length, span);
        for (out, value) in out.iter_mut().zip(tangent) {
            out[lane] = value;
        }
    }
}
