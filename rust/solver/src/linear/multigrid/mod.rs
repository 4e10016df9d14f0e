//! One V-cycle over coarser and coarser matrices: nearly the inverse of the constant matrix, at a cost and in memory
//! that grow with the number of particles.
//!
//! Particles are paired with the neighbor of their largest weight, and the pairs once more: aggregates of about four,
//! one particle of the next level each. A level's matrix has the form of the first, `D + sum w L`,
//!
//! ```text
//! D_c = sum of D over the aggregate        w_c = 1/2 sum of w between two aggregates
//! ```
//!
//! where the half makes up for the steps that constant interpolation has between aggregates: a membrane's weights are
//! the same at any resolution. Each level is smoothed before and after by the same Chebyshev polynomial of `diag⁻¹ P`, so
//! that the cycle is symmetric and positive; the coarsest is eliminated.
//!
//! Source: Notay 2010 for the pairs, Braess 1995 for the half, Adams et al. 2003 for the smoother.

mod coarsening;
mod level;
#[cfg(test)]
mod tests;

use boucle_geometry::Vector;

use super::conjugate_gradient::Inverse;
use super::field::Field;
use super::laplacian::{Graph, Laplacian};
use super::ldlt::Ldlt;
use coarsening::Problem;
use level::Level;

/// Particles of the coarsest level, at the most.
const COARSEST: usize = 4000;

/// The levels, fine to coarse.
#[derive(Debug)]
pub(crate) struct Multigrid {
    levels: Vec<Level>,
    coarsest: Ldlt,
    coarse_residual: Field,
    coarse_solution: Field,
}

impl Multigrid {
    /// The cycle for a matrix whose pinned particles have no weights.
    pub(crate) fn new(
        pairs: &[[u32; 2]],
        matrix: &Laplacian,
        positions: &[Vector],
        is_pinned: impl Fn(usize) -> bool,
    ) -> Self {
        let mut excess = matrix.diagonal.clone();
        for (&[a, b], weight) in pairs.iter().zip(&matrix.weights) {
            excess[a as usize] -= weight;
            excess[b as usize] -= weight;
        }
        let mut problem = Problem {
            pairs: pairs.to_vec(),
            weights: matrix.weights.clone(),
            is_pinned: (0..positions.len()).map(is_pinned).collect(),
            excess,
            positions: positions.to_vec(),
        };
        let mut levels = Vec::new();
        while problem.positions.len() > COARSEST {
            let graph = Graph::new(problem.positions.len(), &problem.pairs);
            let matrix = problem.matrix();
            let aggregates = problem.aggregates(&graph, &matrix);
            let coarse = problem.coarsen(&aggregates);
            // Nothing left to pair: the rest are single particles.
            if coarse.positions.len() * 10 > problem.positions.len() * 9 {
                break;
            }
            levels.push(Level::new(&graph, &matrix, aggregates));
            problem = coarse;
        }
        let graph = Graph::new(problem.positions.len(), &problem.pairs);
        let coarsest = Ldlt::new(&graph, &problem.positions, &problem.matrix());
        let count = problem.positions.len();
        Self {
            levels,
            coarsest,
            coarse_residual: Field::zeros(count),
            coarse_solution: Field::zeros(count),
        }
    }
}

impl Inverse for Multigrid {
    fn apply_inverse(&mut self, r: &Field, z: &mut Field) {
        let Self { levels, coarsest, coarse_residual, coarse_solution } = self;
        let Some(first) = levels.first_mut() else {
            coarsest.apply_inverse(r, z);
            return;
        };
        first.residual.copy_from(r);
        for index in 0..levels.len() {
            let (finer, coarser) = levels.split_at_mut(index + 1);
            let level = &mut finer[index];
            level.start();
            level.smooth();
            let below =
                coarser.first_mut().map_or(&mut *coarse_residual, |next| &mut next.residual);
            level.restrict(below);
        }
        coarsest.apply_inverse(coarse_residual, coarse_solution);
        for index in (0..levels.len()).rev() {
            let (finer, coarser) = levels.split_at_mut(index + 1);
            let level = &mut finer[index];
            let below = coarser.first().map_or(&*coarse_solution, |next| &next.solution);
            level.prolong(below);
            level.smooth();
        }
        z.copy_from(&levels[0].solution);
    }
}
