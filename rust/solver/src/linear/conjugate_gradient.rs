//! Conjugate gradients in f32, preconditioned.
//!
//! Solves `H x = r` for a positive definite H from x = 0, with the inverse of P as preconditioner. It stops when
//! `rᵀ P⁻¹ r` has fallen to the square of a tolerance times what it was, after at least some iterations.
//!
//! Sums run over fixed chunks in the order of the particles, whatever the number of threads.
//!
//! Source: Hestenes & Stiefel 1952.

use rayon::prelude::*;

use super::field::Field;
use crate::state::Coordinates;

/// A product with a symmetric positive definite matrix.
pub(crate) trait Operator: Sync {
    /// `out = H p`.
    fn apply(&self, p: &Field, out: &mut Field);
}

/// A product with the inverse of a symmetric positive definite matrix, or with something near it.
pub(crate) trait Inverse: Send {
    /// `z = P⁻¹ r`.
    fn apply_inverse(&mut self, r: &Field, z: &mut Field);
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    /// Of the norm of the residual, relative to the largest since [`ConjugateGradient::start`].
    pub(crate) tolerance: f64,
    pub(crate) least_iterations: u32,
    pub(crate) most_iterations: u32,
}

/// Numbers of a chunk.
const CHUNK: usize = 4096;

/// Vectors of one solve.
#[derive(Debug)]
pub(crate) struct ConjugateGradient {
    /// The right-hand side, then what is left of it.
    residual: Field,
    pub(crate) solution: Field,
    preconditioned: Field,
    direction: Field,
    product: Field,
    partial: Vec<f64>,
    /// Squared norm of the residual that tolerances are relative to.
    reference: f64,
}

impl ConjugateGradient {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            residual: Field::zeros(count),
            solution: Field::zeros(count),
            preconditioned: Field::zeros(count),
            direction: Field::zeros(count),
            product: Field::zeros(count),
            partial: vec![0.0; count.div_ceil(CHUNK)],
            reference: 0.0,
        }
    }

    /// Makes tolerances relative to the residuals that come.
    pub(crate) fn start(&mut self) {
        self.reference = 0.0;
    }

    /// Takes a right-hand side.
    pub(crate) fn take_residual(&mut self, from: &Coordinates) {
        for (to, from) in self.residual.0.iter_mut().zip(&from.0) {
            for (to, from) in to.iter_mut().zip(&**from) {
                *to = *from as f32;
            }
        }
    }

    /// Solves for the solution, given the residual; returns the iterations it took.
    pub(crate) fn solve(
        &mut self,
        operator: &impl Operator,
        inverse: &mut dyn Inverse,
        stop: Stop,
    ) -> u32 {
        let Self { residual, solution, preconditioned, direction, product, partial, reference } =
            self;
        for axis in &mut solution.0 {
            axis.fill(0.0);
        }
        inverse.apply_inverse(residual, preconditioned);
        for (direction, preconditioned) in direction.0.iter_mut().zip(&preconditioned.0) {
            direction.copy_from_slice(preconditioned);
        }
        let mut rz = dot(residual, preconditioned, partial);
        *reference = reference.max(rz);
        for iteration in 0..stop.most_iterations {
            let is_done = rz <= stop.tolerance * stop.tolerance * *reference;
            if rz.is_nan() {
                // What is lost must be seen to be lost.
                for axis in &mut solution.0 {
                    axis.fill(f32::NAN);
                }
                return iteration.max(1);
            }
            if rz <= 0.0 || (is_done && iteration >= stop.least_iterations) {
                return iteration;
            }
            operator.apply(direction, product);
            let curvature = dot(direction, product, partial);
            if !(curvature > 0.0) {
                return iteration;
            }
            let step = (rz / curvature) as f32;
            add_scaled(solution, step, direction);
            add_scaled(residual, -step, product);
            inverse.apply_inverse(residual, preconditioned);
            let next = dot(residual, preconditioned, partial);
            let keep = (next / rz) as f32;
            rz = next;
            scale_and_add(direction, keep, preconditioned);
        }
        stop.most_iterations
    }
}

/// `aᵀ b`.
fn dot(a: &Field, b: &Field, partial: &mut [f64]) -> f64 {
    let [ax, ay, az] = a.0.each_ref().map(|axis| axis.par_chunks(CHUNK));
    let [bx, by, bz] = b.0.each_ref().map(|axis| axis.par_chunks(CHUNK));
    let chunks = (ax, ay, az, bx, by, bz).into_par_iter().zip(&mut *partial);
    chunks.for_each(|((ax, ay, az, bx, by, bz), sum)| {
        *sum = (dot_of(ax, bx) + dot_of(ay, by)) + dot_of(az, bz);
    });
    partial.iter().sum()
}

/// Sums that run side by side.
const LANES: usize = 16;

fn dot_of(a: &[f32], b: &[f32]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0_f32; LANES];
    for (a, b) in a.iter().zip(b) {
        for i in 0..LANES {
            sums[i] += a[i] * b[i];
        }
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().map(|&sum| f64::from(sum)).sum::<f64>() + f64::from(rest)
}

/// `to += factor from`.
fn add_scaled(to: &mut Field, factor: f32, from: &Field) {
    each_chunk(to, from, |to, from| *to += factor * from);
}

/// `to = factor to + from`.
fn scale_and_add(to: &mut Field, factor: f32, from: &Field) {
    each_chunk(to, from, |to, from| *to = factor * *to + from);
}

fn each_chunk(to: &mut Field, from: &Field, update: impl Fn(&mut f32, f32) + Sync) {
    let [x, y, z] = to.0.each_mut().map(|axis| axis.par_chunks_mut(CHUNK));
    let [fx, fy, fz] = from.0.each_ref().map(|axis| axis.par_chunks(CHUNK));
    (x, y, z, fx, fy, fz).into_par_iter().for_each(|(x, y, z, fx, fy, fz)| {
        for (to, from) in [(x, fx), (y, fy), (z, fz)] {
            for (to, &from) in to.iter_mut().zip(from) {
                update(to, from);
            }
        }
    });
}
