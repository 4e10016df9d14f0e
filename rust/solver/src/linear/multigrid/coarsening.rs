//! From a matrix to one of a quarter of its particles.

use boucle_geometry::Vector;

use super::super::laplacian::{Graph, Laplacian};

/// No aggregate: a pinned particle.
pub(super) const NONE: u32 = u32::MAX;

/// A matrix and where its particles are.
pub(super) struct Problem {
    pub(super) pairs: Vec<[u32; 2]>,
    pub(super) weights: Vec<f64>,
    /// What the diagonal has beyond the weights; 0 and `is_pinned` where there is nothing to solve.
    pub(super) excess: Vec<f64>,
    pub(super) is_pinned: Vec<bool>,
    pub(super) positions: Vec<Vector>,
}

impl Problem {
    pub(super) fn matrix(&self) -> Laplacian {
        let is_pinned = |particle: usize| self.is_pinned[particle];
        Laplacian::new(&self.pairs, self.weights.clone(), self.excess.clone(), is_pinned)
    }

    /// Pairs of pairs.
    pub(super) fn aggregates(&self, graph: &Graph, matrix: &Laplacian) -> Vec<u32> {
        let pairs = matched(graph, matrix, &self.is_pinned);
        let halfway = self.coarsen(&pairs);
        let graph = Graph::new(halfway.positions.len(), &halfway.pairs);
        let pairs_of_pairs = matched(&graph, &halfway.matrix(), &halfway.is_pinned);
        let of = |pair: u32| if pair == NONE { NONE } else { pairs_of_pairs[pair as usize] };
        pairs.into_iter().map(of).collect()
    }

    /// The matrix on aggregates.
    pub(super) fn coarsen(&self, aggregates: &[u32]) -> Self {
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
        let mut between: Vec<([u32; 2], f64)> = Vec::with_capacity(self.pairs.len());
        for (ends, &weight) in self.pairs.iter().zip(&self.weights) {
            let [a, b] = ends.map(|end| aggregates[end as usize]);
            if a != b && a != NONE && b != NONE && weight > 0.0 {
                between.push(([a.min(b), a.max(b)], weight));
            }
        }
        between.sort_by_key(|&(pair, _)| pair);
        let (mut pairs, mut weights) = (Vec::new(), Vec::new());
        for same in between.chunk_by(|a, b| a.0 == b.0) {
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
