//! The constant matrix of an implicit step: one number for each pair of particles, the same for x, y and z.
//!
//! ```text
//! P = D + sum over pairs (i, j) of w_ij L_ij          L_ij = [1 -1; -1 1] at rows and columns i, j
//! ```
//!
//! The pairs never change; the weights do, with the step and the stiffness. A pinned particle's row is that of the
//! identity, and its pairs count for the diagonal of the other end only.

use std::ops::Range;

use rayon::prelude::*;

use super::conjugate_gradient::Operator;
use super::field::Field;

/// Rows that one task multiplies at the least.
const CHUNK: usize = 1024;

/// Which particles are joined: both directions of every pair, by particle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Graph {
    /// For each particle, where its neighbors begin, and the end of the last.
    starts: Vec<u32>,
    neighbors: Vec<u32>,
    /// For each entry of `neighbors`, the number of its pair.
    pairs: Vec<u32>,
}

impl Graph {
    /// The graph of pairs of particles; none may stand twice.
    pub(crate) fn new(particle_count: usize, pairs: &[[u32; 2]]) -> Self {
        let mut starts = vec![0_u32; particle_count + 2];
        for &[a, b] in pairs {
            starts[a as usize + 2] += 1;
            starts[b as usize + 2] += 1;
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut neighbors = vec![0; 2 * pairs.len()];
        let mut pairs_of = vec![0; 2 * pairs.len()];
        for (pair, &[a, b]) in pairs.iter().enumerate() {
            for (from, to) in [(a, b), (b, a)] {
                let place = &mut starts[from as usize + 1];
                neighbors[*place as usize] = to;
                pairs_of[*place as usize] = pair as u32;
                *place += 1;
            }
        }
        starts.pop();
        Self { starts, neighbors, pairs: pairs_of }
    }

    pub(crate) fn particle_count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    fn entries(&self, particle: u32) -> Range<usize> {
        self.starts[particle as usize] as usize..self.starts[particle as usize + 1] as usize
    }

    pub(crate) fn neighbors(&self, particle: u32) -> &[u32] {
        &self.neighbors[self.entries(particle)]
    }

    /// Neighbors and the numbers of the pairs with them.
    pub(crate) fn edges(&self, particle: u32) -> impl Iterator<Item = (u32, u32)> {
        let entries = self.entries(particle);
        self.neighbors[entries.clone()].iter().copied().zip(self.pairs[entries].iter().copied())
    }
}

/// The numbers of the matrix on a graph.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Laplacian {
    /// Of each particle.
    pub(crate) diagonal: Vec<f64>,
    /// Of each pair; the matrix has its opposite. 0 where an end is pinned.
    pub(crate) weights: Vec<f64>,
}

impl Laplacian {
    /// Adds the weights of pairs to a diagonal and cuts the pinned particles off.
    pub(crate) fn new(
        pairs: &[[u32; 2]],
        mut weights: Vec<f64>,
        mut diagonal: Vec<f64>,
        is_pinned: impl Fn(usize) -> bool,
    ) -> Self {
        for (&[a, b], weight) in pairs.iter().zip(&mut weights) {
            diagonal[a as usize] += *weight;
            diagonal[b as usize] += *weight;
            if is_pinned(a as usize) || is_pinned(b as usize) {
                *weight = 0.0;
            }
        }
        for (particle, number) in diagonal.iter_mut().enumerate() {
            if is_pinned(particle) {
                *number = 1.0;
            }
        }
        Self { diagonal, weights }
    }

    /// `out = P p`.
    pub(crate) fn multiply(&self, graph: &Graph, p: &Field, out: &mut Field) {
        for (out, p) in out.0.iter_mut().zip(&p.0) {
            out.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(|(i, out)| {
                let diagonal = self.diagonal[i] * f64::from(p[i]);
                let others = self.row(graph, i as u32);
                let others = others.map(|(j, weight)| weight * f64::from(p[j as usize]));
                *out = (diagonal - others.sum::<f64>()) as f32;
            });
        }
    }

    /// The entries of a particle's row off the diagonal: neighbor and weight, whose opposite the matrix has.
    pub(crate) fn row<'a>(
        &'a self,
        graph: &'a Graph,
        particle: u32,
    ) -> impl Iterator<Item = (u32, f64)> + 'a {
        graph.edges(particle).map(|(neighbor, pair)| (neighbor, self.weights[pair as usize]))
    }
}

/// The product with a matrix on its graph.
#[derive(Clone, Copy)]
pub(crate) struct Forward<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) matrix: &'a Laplacian,
}

impl Operator for Forward<'_> {
    fn apply(&self, p: &Field, out: &mut Field) {
        self.matrix.multiply(self.graph, p, out);
    }
}
