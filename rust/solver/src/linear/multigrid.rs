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

use boucle_geometry::Vector;
use rayon::prelude::*;

use super::conjugate_gradient::Inverse;
use super::field::Field;
use super::laplacian::{Graph, Laplacian};
use super::ldlt::Ldlt;

/// Particles of the coarsest level, at the most.
const COARSEST: usize = 4000;

/// Products with the matrix in each smoothing.
const DEGREE: usize = 3;

/// The smoother works on eigenvalues of `diag⁻¹ P` from this part of the largest up.
const SMOOTHED: f32 = 0.25;

/// Rows of one task.
const CHUNK: usize = 2048;

/// No aggregate: a pinned particle.
const NONE: u32 = u32::MAX;

/// The levels, fine to coarse.
#[derive(Debug)]
pub(crate) struct Multigrid {
    levels: Vec<Level>,
    coarsest: Ldlt,
    coarse_residual: Field,
    coarse_solution: Field,
}

#[derive(Debug)]
struct Level {
    /// For each row, where its entries begin, and the end of the last.
    starts: Vec<u32>,
    columns: Vec<u32>,
    weights: Vec<f32>,
    diagonal: Vec<f32>,
    /// The particle of the next level that each is part of.
    aggregates: Vec<u32>,
    residual: Field,
    solution: Field,
    direction: Field,
    left: Field,
}

/// A matrix and where its particles are.
struct Problem {
    pairs: Vec<[u32; 2]>,
    weights: Vec<f64>,
    /// What the diagonal has beyond the weights; 0 and `is_pinned` where there is nothing to solve.
    excess: Vec<f64>,
    is_pinned: Vec<bool>,
    positions: Vec<Vector>,
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

impl Problem {
    fn matrix(&self) -> Laplacian {
        let is_pinned = |particle: usize| self.is_pinned[particle];
        Laplacian::new(&self.pairs, self.weights.clone(), self.excess.clone(), is_pinned)
    }

    /// Pairs of pairs.
    fn aggregates(&self, graph: &Graph, matrix: &Laplacian) -> Vec<u32> {
        let pairs = matched(graph, matrix, &self.is_pinned);
        let halfway = self.coarsen(&pairs);
        let graph = Graph::new(halfway.positions.len(), &halfway.pairs);
        let pairs_of_pairs = matched(&graph, &halfway.matrix(), &halfway.is_pinned);
        let of = |pair: u32| if pair == NONE { NONE } else { pairs_of_pairs[pair as usize] };
        pairs.into_iter().map(of).collect()
    }

    /// The matrix on aggregates.
    fn coarsen(&self, aggregates: &[u32]) -> Self {
        let used = aggregates.iter().filter(|&&aggregate| aggregate != NONE);
        let count = used.max().map_or(0, |&last| last as usize + 1);
        let mut excess = vec![0.0; count];
        let mut positions = vec![Vector::zeros(); count];
        let mut sizes = vec![0.0; count];
        for (particle, &aggregate) in aggregates.iter().enumerate() {
            if aggregate != NONE {
                excess[aggregate as usize] += self.excess[particle];
                positions[aggregate as usize] += self.positions[particle];
                sizes[aggregate as usize] += 1.0;
            }
        }
        for (position, size) in positions.iter_mut().zip(sizes) {
            *position /= size;
        }
        let mut joined: Vec<([u32; 2], f64)> = Vec::with_capacity(self.pairs.len());
        for (ends, &weight) in self.pairs.iter().zip(&self.weights) {
            let [a, b] = ends.map(|end| aggregates[end as usize]);
            if a != b && a != NONE && b != NONE && weight > 0.0 {
                joined.push(([a.min(b), a.max(b)], weight));
            }
        }
        joined.sort_by_key(|&(pair, _)| pair);
        let (mut pairs, mut weights) = (Vec::new(), Vec::new());
        for same in joined.chunk_by(|a, b| a.0 == b.0) {
            pairs.push(same[0].0);
            weights.push(HALF * same.iter().map(|(_, weight)| weight).sum::<f64>());
        }
        Self { pairs, weights, excess, is_pinned: vec![false; count], positions }
    }
}

/// Of the weights between aggregates, for each pairing: two pairings halve them.
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Numbers the pairs of neighbors with the largest weight between them; who finds none stays alone.
fn matched(graph: &Graph, matrix: &Laplacian, is_pinned: &[bool]) -> Vec<u32> {
    let mut pair_of = vec![NONE; is_pinned.len()];
    let mut count = 0;
    for particle in 0..is_pinned.len() as u32 {
        if pair_of[particle as usize] != NONE || is_pinned[particle as usize] {
            continue;
        }
        let free = matrix.row(graph, particle).filter(|&(other, weight)| {
            weight > 0.0 && pair_of[other as usize] == NONE && !is_pinned[other as usize]
        });
        let strongest = free.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        pair_of[particle as usize] = count;
        if let Some((other, _)) = strongest {
            pair_of[other as usize] = count;
        }
        count += 1;
    }
    pair_of
}

impl Level {
    fn new(graph: &Graph, matrix: &Laplacian, aggregates: Vec<u32>) -> Self {
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

    fn start(&mut self) {
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
    fn smooth(&mut self) {
        let (high, low) = (2.0, 2.0 * SMOOTHED);
        let (middle, half) = (0.5 * (high + low), 0.5 * (high - low));
        let ratio = middle / half;
        let mut last = 1.0 / ratio;
        for step in 0..DEGREE {
            self.take_left();
            let (keep, take) = if step == 0 {
                (0.0, 1.0 / middle)
            } else {
                let next = 1.0 / (2.0 * ratio - last);
                let factors = (next * last, 2.0 * next / half);
                last = next;
                factors
            };
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
    fn restrict(&mut self, below: &mut Field) {
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
    fn prolong(&mut self, below: &Field) {
        for (x, below) in self.solution.0.iter_mut().zip(&below.0) {
            for (x, &aggregate) in x.iter_mut().zip(&self.aggregates) {
                if aggregate != NONE {
                    *x += below[aggregate as usize];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::conjugate_gradient::{ConjugateGradient, Operator, Stop};
    use super::super::problems::{grid, matrix};
    use super::*;
    use crate::scatter::scattered;
    use crate::state::State;

    struct Matrix<'a>(&'a Graph, &'a Laplacian);

    impl Operator for Matrix<'_> {
        fn apply(&self, p: &Field, out: &mut Field) {
            self.1.multiply(self.0, p, out);
        }
    }

    fn noise(count: usize, seed: u64) -> State {
        let mut state = State::zeros(count);
        for (axis, numbers) in state.position.0.iter_mut().enumerate() {
            for (i, number) in numbers.iter_mut().enumerate() {
                *number = scattered(seed + 3 * i as u64 + axis as u64);
            }
        }
        state
    }

    /// Iterations of conjugate gradients on the matrix itself, and the error of what they end with.
    fn iterations(side: u32, pins: &[usize]) -> (u32, f64) {
        let (positions, pairs) = grid(side, side);
        let count = positions.len();
        let graph = Graph::new(count, &pairs);
        let matrix = matrix(&pairs, count, pins);
        let mut cycle =
            Multigrid::new(&pairs, &matrix, &positions, |particle| pins.contains(&particle));
        let mut exact = noise(count, 7);
        for axis in &mut exact.position.0 {
            for &pin in pins {
                axis[pin] = 0.0;
            }
        }
        let mut x = Field::zeros(count);
        for (to, from) in x.0.iter_mut().zip(&exact.position.0) {
            for (to, from) in to.iter_mut().zip(&**from) {
                *to = *from as f32;
            }
        }
        let mut product = Field::zeros(count);
        matrix.multiply(&graph, &x, &mut product);
        let mut right = State::zeros(count);
        for (to, from) in right.position.0.iter_mut().zip(&product.0) {
            for (to, from) in to.iter_mut().zip(from) {
                *to = f64::from(*from);
            }
        }
        let mut gradients = ConjugateGradient::new(count);
        gradients.start();
        gradients.take_residual(&right.position);
        let stop = Stop { tolerance: 1e-3, least_iterations: 0, most_iterations: 300 };
        let taken = gradients.solve(&Matrix(&graph, &matrix), &mut cycle, stop);
        let errors = gradients.solution.0[0].iter().zip(&x.0[0]).map(|(a, b)| f64::from(a - b));
        let error = errors.map(|error| error * error).sum::<f64>().sqrt();
        (taken, error / f64::from(side))
    }

    #[test]
    fn a_cycle_solves_large_grids_in_few_iterations_whatever_their_size() {
        for pins in [&[][..], &[0, 77]] {
            for side in [80, 160] {
                let (taken, error) = iterations(side, pins);
                assert!(taken <= 30, "{side}², {pins:?}: {taken} iterations");
                assert!(error < 0.05, "{side}², {pins:?}: {error}");
            }
        }
    }

    #[test]
    fn a_cycle_is_symmetric_and_positive() {
        let (positions, pairs) = grid(90, 70);
        let count = positions.len();
        let matrix = matrix(&pairs, count, &[3]);
        let mut cycle = Multigrid::new(&pairs, &matrix, &positions, |particle| particle == 3);
        let fields = [11, 999_983].map(|seed| {
            let noise = noise(count, seed);
            let mut field = Field::zeros(count);
            for (to, from) in field.0.iter_mut().zip(&noise.position.0) {
                for (to, from) in to.iter_mut().zip(&**from) {
                    *to = *from as f32;
                }
            }
            field
        });
        let mut solved = [Field::zeros(count), Field::zeros(count)];
        for (field, solved) in fields.iter().zip(&mut solved) {
            cycle.apply_inverse(field, solved);
        }
        let dot = |a: &Field, b: &Field| -> f64 {
            let pairs = a.0.iter().flatten().zip(b.0.iter().flatten());
            pairs.map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
        };
        let [a, b] = &fields;
        let size = (dot(a, &solved[0]) * dot(b, &solved[1])).sqrt();
        assert!(dot(a, &solved[0]) > 0.0 && dot(b, &solved[1]) > 0.0);
        let difference = dot(a, &solved[1]) - dot(b, &solved[0]);
        assert!(difference.abs() < 1e-4 * size, "{difference} of {size}");
    }
}
