//! Block Cholesky: the inverse of a matrix of 3 x 3 blocks that changes at each guess.
//!
//! The blocks of the [`Dissection`](super::dissection) are eliminated children first, as in [`ldlt`](super::ldlt), but with all
//! three axes of a particle coupled to those of its neighbors: nine times the numbers, 27 times the work. So the products of
//! the elimination are what counts here. Of a front, with S its own rows and A those below,
//!
//! ```text
//! [S  Aᵀ]   [L  0] [Lᵀ Bᵀ]
//! [A  U ] = [B  I] [   U - B Bᵀ]         B = A L⁻ᵀ
//! ```
//!
//! [L; B] is kept, column by column, with the reciprocals of L's diagonal in its place; the rest goes up to the parent. All of
//! it is f32: what rounding leaves is for conjugate gradients to mend. A pivot is never taken below the part of the matrix
//! that is on its diagonal alone (inertia): no exact pivot is, so the inverse stays positive definite.
//!
//! Halves of the dissection never touch and may run side by side; each sums in its own memory and in a fixed order, and the
//! number of lanes changes no sum: the bits depend on neither threads nor instruction set.
//!
//! Sources: multifrontal elimination after Duff & Reid 1983; kernels after Goto & van de Geijn 2008.

mod dense;
mod factor;
mod solve;
#[cfg(test)]
mod tests;

use std::ops::Range;

use boucle_geometry::Vector;
use pulp::Arch;

use super::block_jacobi::Entries;
use super::conjugate_gradient::Inverse;
use super::field::Field;
use super::fronts::{Front, Fronts};
use super::laplacian::Graph;

/// Unknowns of a particle.
const AXES: usize = 3;

/// A symmetric matrix of 3 x 3 blocks on a graph.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockMatrix {
    /// The block of each particle; that of the identity where one does not move.
    pub(crate) diagonal: Entries<Vec<f32>>,
    /// Of each pair a block B, row by row: the matrix has -B in the rows of the smaller particle and the columns of the larger,
    /// and -Bᵀ in the others. Zeros where an end does not move.
    pub(crate) pairs: Vec<[f32; AXES * AXES]>,
}

/// A block of the matrix in a front.
#[derive(Clone, Copy, Debug)]
struct BlockPlace {
    pair: u32,
    /// Among the front's particles.
    row: u32,
    column: u32,
    is_turned: bool,
}

/// A factored matrix and the memory that its solves need.
#[derive(Debug)]
pub(crate) struct Cholesky {
    fronts: Fronts,
    /// Of each front, its particles' pairs with each other and with those below.
    places: Vec<Vec<BlockPlace>>,
    /// Of each front, where its columns are.
    columns: Vec<Range<usize>>,
    /// Of each front, where its values are: its own particles' and those below.
    values_of: Vec<Range<usize>>,
    /// Where the first value of each particle is.
    value_of: Vec<u32>,
    /// [L; B] of all fronts.
    numbers: Vec<f32>,
    values: Vec<f32>,
    arch: Arch,
}

impl Cholesky {
    /// Orders a graph by the positions of its particles.
    pub(crate) fn new(graph: &Graph, positions: &[Vector]) -> Self {
        let fronts = Fronts::new(graph, positions);
        let places = fronts.all.iter().map(|front| places(&fronts, front, graph)).collect();
        let ranges = |len: fn(&Front) -> usize| {
            let ends = fronts.all.iter().scan(0, move |end, front| {
                let start = *end;
                *end += len(front);
                Some(start..*end)
            });
            ends.collect::<Vec<_>>()
        };
        let columns = ranges(|front| AXES * AXES * front.own_count() * front.count());
        let values_of = ranges(|front| AXES * front.count());
        let mut value_of = vec![0; positions.len()];
        for (front, values) in fronts.all.iter().zip(&values_of) {
            for (i, &particle) in fronts.order[front.own_places()].iter().enumerate() {
                value_of[particle as usize] = (values.start + AXES * i) as u32;
            }
        }
        let end = |ranges: &[Range<usize>]| ranges.last().map_or(0, |last| last.end);
        Self {
            numbers: vec![0.0; end(&columns)],
            values: vec![0.0; end(&values_of)],
            fronts,
            places,
            columns,
            values_of,
            value_of,
            arch: Arch::new(),
        }
    }
}

/// Where the blocks of a front's own columns are, diagonal aside.
fn places(fronts: &Fronts, front: &Front, graph: &Graph) -> Vec<BlockPlace> {
    let own = fronts.order[front.own_places()].iter().enumerate();
    let of = |(column, &particle): (usize, &u32)| {
        let below = graph.edges(particle).filter_map(move |(neighbor, pair)| {
            let row = fronts.row_of(front, neighbor).filter(|row| *row > column)?;
            let is_turned = particle < neighbor;
            Some(BlockPlace { pair, row: row as u32, column: column as u32, is_turned })
        });
        below.collect::<Vec<_>>()
    };
    own.flat_map(of).collect()
}

impl Inverse for Cholesky {
    fn apply_inverse(&mut self, r: &Field, z: &mut Field) {
        self.solve(r, z);
    }
}
