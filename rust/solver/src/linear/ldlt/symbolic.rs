//! Where the numbers of each front are in the factor.

use std::ops::Range;

use boucle_geometry::Vector;

use super::super::fronts::{Front, Fronts};
use super::super::laplacian::Graph;
use super::panel::{inverse_len, panel_count};

/// The vectors of one front.
#[derive(Clone, Debug)]
pub(super) struct Stored {
    /// S⁻¹.
    pub(super) inverse: Range<usize>,
    /// W.
    pub(super) below: Range<usize>,
}

impl Stored {
    /// How many vectors a solve reads.
    pub(super) fn work(&self) -> usize {
        self.inverse.len() + 2 * self.below.len()
    }
}

/// All fronts and their vectors.
#[derive(Clone, Debug, Default)]
pub(super) struct Symbolic {
    pub(super) fronts: Fronts,
    /// Of each front.
    pub(super) stored: Vec<Stored>,
}

impl Symbolic {
    pub(super) fn new(graph: &Graph, positions: &[Vector]) -> Self {
        let fronts = Fronts::new(graph, positions);
        let (mut inverse, mut below) = (0..0, 0..0);
        let store = |front: &Front| {
            let own = front.own_count();
            inverse = inverse.end..inverse.end + inverse_len(own);
            below = below.end..below.end + panel_count(front.rows.len()) * own;
            Stored { inverse: inverse.clone(), below: below.clone() }
        };
        let stored = fronts.all.iter().map(store).collect();
        Self { fronts, stored }
    }

    /// Vectors of all S⁻¹ and of all W.
    pub(super) fn lens(&self) -> [usize; 2] {
        self.stored.last().map_or([0; 2], |last| [last.inverse.end, last.below.end])
    }
}
