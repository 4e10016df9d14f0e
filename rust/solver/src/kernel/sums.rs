//! The sums of the springs' forces on the particles of one chunk.
//!
//! A spring's force is computed once and added twice, for its first end and for its second. The two sums of a
//! particle are apart: what a processor has just stored it never loads again before it has stored the whole vector,
//! and no sum waits for the one before it.

use std::ops::Range;

use super::{BLOCK, ChunkVectors, PLACES};

/// An array for each axis.
pub(super) type Axes<'a> = [&'a mut [f64]; 3];

/// Sums of forces (N), and a place for those that are no concern of the chunk.
pub(crate) struct Sums {
    /// Of the springs that begin at a particle: the forces on their other ends.
    pub(crate) leaving: ChunkVectors,
    /// Of the springs that end at a particle, and of all that is no spring on a diagonal.
    pub(crate) arriving: ChunkVectors,
    nowhere: [[f64; BLOCK]; 3],
}

impl Sums {
    #[inline(always)]
    pub(crate) fn zeros() -> Self {
        Self {
            leaving: [[0.0; PLACES]; 3],
            arriving: [[0.0; PLACES]; 3],
            nowhere: [[0.0; BLOCK]; 3],
        }
    }

    /// Where springs add whose first ends and second ends are these particles of the chunk.
    #[inline(always)]
    pub(super) fn of(&mut self, first: Range<usize>, second: Range<usize>) -> [Axes<'_>; 2] {
        [part(&mut self.leaving, first), part(&mut self.arriving, second)]
    }

    /// Where springs add that only begin in the chunk.
    #[inline(always)]
    pub(super) fn of_first_ends(&mut self, first: Range<usize>) -> [Axes<'_>; 2] {
        let count = first.len();
        [part(&mut self.leaving, first), part(&mut self.nowhere, 0..count)]
    }

    /// Where springs add that only end in the chunk.
    #[inline(always)]
    pub(super) fn of_second_ends(&mut self, second: Range<usize>) -> [Axes<'_>; 2] {
        let count = second.len();
        [part(&mut self.nowhere, 0..count), part(&mut self.arriving, second)]
    }
}

#[inline(always)]
fn part<const COUNT: usize>(axes: &mut [[f64; COUNT]; 3], range: Range<usize>) -> Axes<'_> {
    let [x, y, z] = axes;
    [&mut x[range.clone()], &mut y[range.clone()], &mut z[range]]
}
