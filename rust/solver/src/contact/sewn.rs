//! Vertices that seams join: they meet, so what has one of them does not collide with what has the other.
//!
//! Sewn vertices count as one, as if the mesh were welded there: two features that share one never collide.

use crate::cloth::{Cloth, placed};

/// Which particles are one.
#[derive(Debug, Default)]
pub(super) struct Sewn {
    /// For each particle the first that it is one with; empty without seams.
    first_of: Vec<u32>,
}

impl Sewn {
    pub(super) fn new(cloths: &[Cloth]) -> Self {
        let seams = placed(cloths).flat_map(|(cloth, base)| {
            let seams = cloth.tailoring.sewing.iter().flat_map(|sewing| &sewing.seams);
            seams.map(move |seam| seam.map(|end| base + end))
        });
        let mut seams = seams.peekable();
        if seams.peek().is_none() {
            return Self::default();
        }
        let count: usize = cloths.iter().map(|cloth| cloth.positions.len()).sum();
        let mut first_of: Vec<u32> = (0..count as u32).collect();
        for seam in seams {
            let [a, b] = seam.map(|end| first(&first_of, end));
            first_of[a.max(b) as usize] = a.min(b);
        }
        for particle in 0..count {
            first_of[particle] = first(&first_of, particle as u32);
        }
        Self { first_of }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.first_of.is_empty()
    }

    /// Whether two features have a vertex in common.
    pub(super) fn joins(&self, one: &[u32], other: &[u32]) -> bool {
        let first_of = |point: &u32| self.first_of.get(*point as usize);
        !self.is_empty()
            && one
                .iter()
                .any(|a| first_of(a).is_some_and(|a| other.iter().any(|b| first_of(b) == Some(a))))
    }
}

fn first(first_of: &[u32], mut particle: u32) -> u32 {
    while first_of[particle as usize] != particle {
        particle = first_of[particle as usize];
    }
    particle
}
