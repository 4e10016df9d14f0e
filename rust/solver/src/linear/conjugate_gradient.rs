//! Conjugate gradients in f32, preconditioned.
//!
//! Solves `H x = r` for a positive definite H from x = 0, with something near H⁻¹ as preconditioner. An iteration brings
//! x nearer by `alpha rᵀ z`, in the square of the norm of H. They stop when one gains no more than the square of a
//! tolerance times what all have gained: that needs no product beside those of the iteration.
//!
//! Sums run over fixed chunks in the order of the particles, whatever the number of threads.
//!
//! Source: Hestenes & Stiefel 1952, theorem 6:1; Strakos & Tichy 2002 for the stop.

use rayon::prelude::*;

use super::field::{CHUNK, Field};
use crate::interrupter::Interrupter;
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

/// How a solve went.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solved {
    pub(crate) iterations: u32,
    /// Square of the norm, in that of H, by which the solution has come nearer.
    pub(crate) gained: f64,
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    /// Of an iteration's gain, relative to all since [`ConjugateGradient::start`]: both as norms.
    pub(crate) tolerance: f64,
    pub(crate) least_iterations: u32,
    pub(crate) most_iterations: u32,
}

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
    /// What all iterations have gained.
    gained: f64,
    interrupter: Interrupter,
}

impl ConjugateGradient {
    pub(crate) fn new(count: usize, interrupter: &Interrupter) -> Self {
        Self {
            residual: Field::zeros(count),
            solution: Field::zeros(count),
            preconditioned: Field::zeros(count),
            direction: Field::zeros(count),
            product: Field::zeros(count),
            partial: vec![0.0; count.div_ceil(CHUNK)],
            gained: 0.0,
            interrupter: interrupter.clone(),
        }
    }

    /// Makes tolerances relative to what comes.
    pub(crate) fn start(&mut self) {
        self.gained = 0.0;
    }

    /// Takes a right-hand side.
    pub(crate) fn take_residual(&mut self, from: &Coordinates) {
        for (to, from) in self.residual.0.iter_mut().zip(&from.0) {
            for (to, from) in to.iter_mut().zip(&**from) {
                *to = *from as f32;
            }
        }
    }

    /// Solves for the solution, given the residual.
    pub(crate) fn solve(
        &mut self,
        operator: &impl Operator,
        inverse: &mut dyn Inverse,
        stop: Stop,
    ) -> Solved {
        let Self {
            residual,
            solution,
            preconditioned,
            direction,
            product,
            partial,
            gained,
            interrupter,
        } = self;
        solution.fill(0.0);
        let before = *gained;
        let mut last = f64::INFINITY;
        let mut iterations = 0;
        while iterations < stop.most_iterations && !interrupter.is_asked() {
            inverse.apply_inverse(residual, preconditioned);
            let rz = dot(residual, preconditioned, partial);
            if !rz.is_finite() {
                return lost(solution, iterations);
            }
            if rz <= 0.0 {
                break;
            }
            if iterations == 0 {
                direction.copy_from(preconditioned);
            } else {
                let keep = (rz / last) as f32;
                direction.update(preconditioned, |d, z| *d = keep * *d + z);
            }
            last = rz;
            operator.apply(direction, product);
            let curvature = dot(direction, product, partial);
            if !curvature.is_finite() {
                return lost(solution, iterations);
            }
            if curvature <= 0.0 {
                break;
            }
            let length = rz / curvature;
            let step = length as f32;
            solution.update(direction, |x, d| *x += step * d);
            residual.update(product, |r, hd| *r += -step * hd);
            iterations += 1;
            let gain = length * rz;
            *gained += gain;
            let is_done = gain <= stop.tolerance * stop.tolerance * *gained;
            if is_done && iterations >= stop.least_iterations {
                break;
            }
        }
        Solved { iterations, gained: *gained - before }
    }
}

/// What is lost must be seen to be lost.
fn lost(solution: &mut Field, iterations: u32) -> Solved {
    solution.fill(f32::NAN);
    Solved { iterations: iterations + 1, gained: f64::NAN }
}

/// `aᵀ b`.
fn dot(a: &Field, b: &Field, partial: &mut [f64]) -> f64 {
    a.chunks().zip(b.chunks()).zip(&mut *partial).for_each(
        |(([ax, ay, az], [bx, by, bz]), sum)| {
            *sum = (dot_of(ax, bx) + dot_of(ay, by)) + dot_of(az, bz);
        },
    );
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
