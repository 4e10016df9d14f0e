//! What an elimination knows before any number: the fronts of all blocks and how they fit into each other.

use std::ops::Range;

use boucle_geometry::Vector;

use super::dissection::{Block, Dissection};
use super::laplacian::Graph;

/// Rows of a child's front that follow each other in its parent's as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Run {
    /// Row of the child, counted from the first below its own.
    pub(super) from: u32,
    /// Row of the parent, its own included.
    pub(super) to: u32,
    pub(super) count: u32,
}

/// One block: its own particles first, then those below.
#[derive(Clone, Debug)]
pub(super) struct Front {
    pub(super) block: Block,
    /// Places of the particles below, ascending.
    pub(super) rows: Vec<u32>,
    /// How those lie in the parent's front.
    pub(super) runs: Vec<Run>,
}

/// Subtrees of fewer fronts are one task.
const TASK: usize = 24;

impl Front {
    pub(super) fn own_count(&self) -> usize {
        self.block.own.len()
    }

    /// Particles, own and below.
    pub(super) fn count(&self) -> usize {
        self.own_count() + self.rows.len()
    }

    pub(super) fn own_places(&self) -> Range<usize> {
        self.block.own.start as usize..self.block.own.end as usize
    }

    /// The places of its subtree.
    pub(super) fn places(&self) -> Range<usize> {
        self.block.first_place as usize..self.block.own.end as usize
    }
}

/// All fronts, children before parents.
#[derive(Clone, Debug, Default)]
pub(super) struct Fronts {
    pub(super) all: Vec<Front>,
    /// The particle at each place.
    pub(super) order: Vec<u32>,
    /// The place of each particle.
    pub(super) places: Vec<u32>,
}

impl Fronts {
    pub(super) fn new(graph: &Graph, positions: &[Vector]) -> Self {
        let Dissection { blocks, order, places } = Dissection::new(graph, positions);
        let mut fronts = Self { all: Vec::with_capacity(blocks.len()), order, places };
        for block in blocks {
            let rows = fronts.rows_below(graph, &block);
            let front = Front { block, rows, runs: Vec::new() };
            for child in front.block.children.into_iter().flatten() {
                let child = &mut fronts.all[child as usize];
                child.runs = runs(&child.rows, &front);
            }
            fronts.all.push(front);
        }
        fronts
    }

    /// What becomes of the subtrees of both children of a front: side by side, or one after the other where they are small.
    pub(super) fn join<R: Send>(
        &self,
        root: usize,
        lower: impl FnOnce() -> R + Send,
        upper: impl FnOnce() -> R + Send,
    ) -> [R; 2] {
        if root - (self.all[root].block.first_block as usize) < TASK {
            return [lower(), upper()];
        }
        let (lower, upper) = rayon::join(lower, upper);
        [lower, upper]
    }

    /// The row of a particle in a front that it takes part in: its own come first, then those below; none if it was eliminated
    /// before.
    pub(super) fn row_of(&self, front: &Front, particle: u32) -> Option<usize> {
        let place = self.places[particle as usize];
        let own = &front.block.own;
        if place < own.start {
            None
        } else if place < own.end {
            Some((place - own.start) as usize)
        } else {
            Some(own.len() + front.rows.partition_point(|&row| row < place))
        }
    }

    /// The places that a block touches after its own: its particles' neighbors and its children's rows.
    fn rows_below(&self, graph: &Graph, block: &Block) -> Vec<u32> {
        let own = &self.order[block.own.start as usize..block.own.end as usize];
        let neighbors = own.iter().flat_map(|&particle| graph.neighbors(particle));
        let children = block.children.into_iter().flatten();
        let mut rows: Vec<u32> = neighbors
            .map(|&neighbor| self.places[neighbor as usize])
            .chain(children.flat_map(|child| self.all[child as usize].rows.iter().copied()))
            .filter(|&place| place >= block.own.end)
            .collect();
        rows.sort_unstable();
        rows.dedup();
        rows
    }
}

/// Where a child's rows are in its parent's front.
fn runs(rows: &[u32], parent: &Front) -> Vec<Run> {
    let own = &parent.block.own;
    let mut runs: Vec<Run> = Vec::new();
    let mut below = 0;
    for (from, &place) in rows.iter().enumerate() {
        let to = if own.contains(&place) {
            place - own.start
        } else {
            below += parent.rows[below..].partition_point(|&row| row < place);
            own.len() as u32 + below as u32
        };
        match runs.last_mut() {
            Some(run) if run.to + run.count == to => run.count += 1,
            _ => runs.push(Run { from: from as u32, to, count: 1 }),
        }
    }
    runs
}
