//! What is known before any number is: the fronts of all blocks and how they fit into each other.

use boucle_geometry::Vector;

use super::super::dissection::{Block, Dissection};
use super::super::laplacian::Graph;
use super::dense::{padded, panel_rows};

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
    /// Where its numbers begin in the factor.
    pub(super) numbers: usize,
    /// Where its vectors begin in the workspace.
    pub(super) vectors: usize,
    /// The same of the first block of its subtree.
    pub(super) first_vectors: usize,
}

impl Front {
    pub(super) fn own_count(&self) -> usize {
        self.block.own.len()
    }

    /// Particles, own and below.
    pub(super) fn count(&self) -> usize {
        self.own_count() + self.rows.len()
    }

    /// Rows with padding.
    pub(super) fn stride(&self) -> usize {
        padded(self.count())
    }

    /// How much a solve computes in it.
    pub(super) fn number_count(&self) -> usize {
        panel_rows(self.count()) * self.own_count()
    }

    pub(super) fn vector_count(&self) -> usize {
        3 * self.stride()
    }

    /// The places of its subtree.
    pub(super) fn places(&self) -> std::ops::Range<usize> {
        self.block.first_place as usize..self.block.own.end as usize
    }
}

/// All fronts, children before parents.
#[derive(Clone, Debug, Default)]
pub(super) struct Symbolic {
    pub(super) fronts: Vec<Front>,
    /// The particle at each place.
    pub(super) order: Vec<u32>,
    /// The place of each particle.
    pub(super) places: Vec<u32>,
    pub(super) number_count: usize,
    pub(super) vector_count: usize,
}

impl Symbolic {
    pub(super) fn new(graph: &Graph, positions: &[Vector]) -> Self {
        let Dissection { blocks, order, places } = Dissection::new(graph, positions);
        let mut symbolic = Self { order, places, ..Self::default() };
        for block in blocks {
            let rows = symbolic.rows_below(graph, &block);
            let front = Front {
                rows,
                runs: Vec::new(),
                numbers: symbolic.number_count,
                vectors: symbolic.vector_count,
                first_vectors: symbolic
                    .fronts
                    .get(block.first_block as usize)
                    .map_or(symbolic.vector_count, |first| first.vectors),
                block,
            };
            symbolic.number_count += front.number_count();
            symbolic.vector_count += front.vector_count();
            for child in front.block.children.into_iter().flatten() {
                let child = &mut symbolic.fronts[child as usize];
                child.runs = runs(&child.rows, &front);
            }
            symbolic.fronts.push(front);
        }
        symbolic
    }

    /// The places that a block touches after its own: its particles' neighbors and its children's rows.
    fn rows_below(&self, graph: &Graph, block: &Block) -> Vec<u32> {
        let own = &self.order[block.own.start as usize..block.own.end as usize];
        let neighbors = own.iter().flat_map(|&particle| graph.neighbors(particle));
        let children = block.children.into_iter().flatten();
        let mut rows: Vec<u32> = neighbors
            .map(|&neighbor| self.places[neighbor as usize])
            .chain(children.flat_map(|child| self.fronts[child as usize].rows.iter().copied()))
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
