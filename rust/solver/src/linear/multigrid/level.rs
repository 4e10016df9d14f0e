//! One matrix of the cycle: its product, its smoother, and the ways to the next.

use rayon::prelude::*;

use super::super::chebyshev;
use super::super::field::Field;
use super::super::laplacian::{Graph, Laplacian};
use super::coarsening::NONE;

/// Products with the matrix in each smoothing.
const DEGREE: usize = 3;

/// The smoother works on eigenvalues of `diag⁻¹ P` from this part of the largest up.
const SMOOTHED: f32 = 0.25;

/// Rows of one task.
const CHUNK: usize = 2048;

/// A matrix by rows, and the vectors of a cycle.
#[derive(Debug)]
pub(super) struct Level {
    /// For each row, where its entries begin, and the end of the last.
    starts: Vec<u32>,
    columns: Vec<u32>,
    weights: Vec<f32>,
    diagonal: Vec<f32>,
    /// The particle of the next level that each is part of.
    aggregates: Vec<u32>,
    pub(super) residual: Field,
    pub(super) solution: Field,
    direction: Field,
    left: Field,
}

impl Level {
    pub(super) fn new(graph: &Graph, matrix: &Laplacian, aggregates: Vec<u32>) -> Self {
        let count = aggregates.len();
        let (mut starts, mut columns, mut weights) = (vec![0], Vec::new(), Vec::new());
        for particle in 0..count as u32 {
            for (other, weight) in matrix.row(graph, particle).filter(|&(_, weight)| weight > 0.0) {
                columns.push(other);
                weights.push(weight as f32);
            }
            starts.push(columns.len() as u32);
        }
        let zeros = || Field::zeros(count);
        Self {
            starts,
            columns,
            weights,
            diagonal: matrix.diagonal.iter().map(|&number| number as f32).collect(),
            aggregates,
            residual: zeros(),
            solution: zeros(),
            direction: zeros(),
            left: zeros(),
        }
    }

    pub(super) fn start(&mut self) {
        for axis in &mut self.solution.0 {
            axis.fill(0.0);
        }
    }

    /// `left = residual - P solution`
    fn take_left(&mut self) {
        let Self { starts, columns, weights, diagonal, residual, solution, left, .. } = self;
        for ((left, residual), x) in left.0.iter_mut().zip(&residual.0).zip(&solution.0) {
            left.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, left)| {
                for (place, left) in left.iter_mut().enumerate() {
                    let row = chunk * CHUNK + place;
                    let entries = starts[row] as usize..starts[row + 1] as usize;
                    let others = columns[entries.clone()].iter().zip(&weights[entries]);
                    let others = others.map(|(&column, weight)| weight * x[column as usize]);
                    *left = residual[row] - (diagonal[row] * x[row] - others.sum::<f32>());
                }
            });
        }
    }

    /// Chebyshev iteration from the present solution. `diag⁻¹ P` has no eigenvalue above 2.
    pub(super) fn smooth(&mut self) {
        for [keep, take] in chebyshev::steps(2.0 * SMOOTHED, 2.0).take(DEGREE) {
            self.take_left();
            let Self { diagonal, solution, direction, left, .. } = self;
            for ((x, direction), left) in solution.0.iter_mut().zip(&mut direction.0).zip(&left.0) {
                let chunks = x.par_chunks_mut(CHUNK).zip(direction.par_chunks_mut(CHUNK));
                let rest = left.par_chunks(CHUNK).zip(diagonal.par_chunks(CHUNK));
                chunks.zip(rest).for_each(|((x, direction), (left, diagonal))| {
                    let rows = x.iter_mut().zip(direction).zip(left.iter().zip(diagonal));
                    for ((x, direction), (left, diagonal)) in rows {
                        *direction = keep * *direction + take * (left / diagonal);
                        *x += *direction;
                    }
                });
            }
        }
    }

    /// Sums what is left over each aggregate.
    pub(super) fn restrict(&mut self, below: &mut Field) {
        self.take_left();
        for (below, left) in below.0.iter_mut().zip(&self.left.0) {
            below.fill(0.0);
            for (left, &aggregate) in left.iter().zip(&self.aggregates) {
                if aggregate != NONE {
                    below[aggregate as usize] += left;
                }
            }
        }
    }

    /// Adds to each particle what its aggregate moves by.
    pub(super) fn prolong(&mut self, below: &Field) {
        for (x, below) in self.solution.0.iter_mut().zip(&below.0) {
            for (x, &aggregate) in x.iter_mut().zip(&self.aggregates) {
                if aggregate != NONE {
                    *x += below[aggregate as usize];
                }
            }
        }
    }
}
