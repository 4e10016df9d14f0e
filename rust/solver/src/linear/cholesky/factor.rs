//! The numbers of the factor, front by front, halves in parallel.

use std::cell::Cell;

use pulp::{Scalar, Simd, WithSimd};

use super::dense::{self, ROWS, Shape, Tile};
use super::{AXES, BlockMatrix, BlockPlace, Cholesky};
use crate::linear::fronts::Front;

thread_local! {
    static TILES: Cell<Vec<Tile>> = const { Cell::new(Vec::new()) };
}

impl Front {
    pub(super) fn shape(&self) -> Shape {
        Shape { size: AXES * self.count(), own: AXES * self.own_count() }
    }
}

impl Cholesky {
    /// Factors a matrix, of which `least` is on the diagonal of each particle beside parts that are not negative; 0 for one that
    /// does not move.
    pub(crate) fn factor(&mut self, matrix: &BlockMatrix, least: &[f32]) {
        let mut numbers = std::mem::take(&mut self.numbers);
        if let Some(root) = self.fronts.all.len().checked_sub(1) {
            self.eliminate((matrix, least), root, &mut numbers);
        }
        self.numbers = numbers;
    }

    /// Eliminates a subtree into its part of the numbers and returns what remains for the rows below its root.
    fn eliminate(
        &self,
        (matrix, least): (&BlockMatrix, &[f32]),
        root: usize,
        numbers: &mut [f32],
    ) -> Vec<f32> {
        let front = &self.fronts.all[root];
        let shape = front.shape();
        let (before, columns) = numbers.split_at_mut(numbers.len() - self.columns[root].len());
        columns.fill(0.0);
        let mut rest = vec![0.0; shape.below() * shape.below()];
        if let Some([lower, upper]) = front.block.children {
            let [lower, upper] = [lower as usize, upper as usize];
            let first = front.block.first_block as usize;
            let middle = self.columns[lower].end - self.columns[first].start;
            let (lower_numbers, upper_numbers) = before.split_at_mut(middle);
            let remainders = self.fronts.join(
                root,
                || self.eliminate((matrix, least), lower, lower_numbers),
                || self.eliminate((matrix, least), upper, upper_numbers),
            );
            for (child, remainder) in [lower, upper].into_iter().zip(&remainders) {
                extend_add(shape, columns, &mut rest, &self.fronts.all[child], remainder);
            }
        }
        let own = &self.fronts.order[front.own_places()];
        assemble(matrix, own, &self.places[root], columns, shape.size);
        let least = own.iter().flat_map(|&particle| {
            let least = least[particle as usize];
            [if least > 0.0 { least } else { 1.0 }; AXES]
        });
        let least: Vec<f32> = least.collect();
        self.arch.dispatch(Elimination { shape, columns, least: &least, rest: &mut rest });
        rest
    }
}

/// Adds a matrix's own entries to a front's columns.
fn assemble(
    matrix: &BlockMatrix,
    own: &[u32],
    places: &[BlockPlace],
    columns: &mut [f32],
    size: usize,
) {
    for (i, &particle) in own.iter().enumerate() {
        let [xx, yx, yy, zx, zy, zz] =
            matrix.diagonal.each_ref().map(|entries| entries[particle as usize]);
        let first = AXES * i * (size + 1);
        for (column, entries) in [&[xx, yx, zx][..], &[yy, zy], &[zz]].into_iter().enumerate() {
            let to = &mut columns[first + column * (size + 1)..][..entries.len()];
            to.iter_mut().zip(entries).for_each(|(to, entry)| *to += entry);
        }
    }
    for place in places {
        let block = &matrix.pairs[place.pair as usize];
        for column in 0..AXES {
            let first = (AXES * place.column as usize + column) * size + AXES * place.row as usize;
            for (row, to) in columns[first..][..AXES].iter_mut().enumerate() {
                let [i, j] = if place.is_turned { [column, row] } else { [row, column] };
                *to -= block[AXES * i + j];
            }
        }
    }
}

/// Adds what a child leaves to its parent's front: to its columns, or to the rest.
fn extend_add(
    parent: Shape,
    columns: &mut [f32],
    rest: &mut [f32],
    child: &Front,
    remainder: &[f32],
) {
    let size = child.shape().below();
    for (i, across) in child.runs.iter().enumerate() {
        let [from, to, count] = [across.from, across.to, across.count].map(|n| AXES * n as usize);
        for offset in 0..count {
            let [from, column] = [from, to].map(|first| first + offset);
            let source = &remainder[from * size..][..size];
            let (target, first_row) = if column < parent.own {
                (&mut columns[column * parent.size..][..parent.size], 0)
            } else {
                let below = parent.below();
                (&mut rest[(column - parent.own) * below..][..below], parent.own)
            };
            for run in &child.runs[i..] {
                let [run_from, run_to, count] =
                    [run.from, run.to, run.count].map(|n| AXES * n as usize);
                let skipped = from.saturating_sub(run_from);
                let source = &source[run_from + skipped..run_from + count];
                let to = &mut target[run_to + skipped - first_row..][..source.len()];
                to.iter_mut().zip(source).for_each(|(to, from)| *to += from);
            }
        }
    }
}

struct Elimination<'a> {
    shape: Shape,
    columns: &'a mut [f32],
    least: &'a [f32],
    rest: &'a mut [f32],
}

impl Elimination<'_> {
    #[inline(always)]
    fn run<S: Simd, const VECTORS: usize>(self, simd: S) {
        let Self { shape, columns, least, rest } = self;
        let mut tiles = TILES.take();
        dense::eliminate::<S, VECTORS>(simd, shape, columns, least, rest, &mut tiles);
        TILES.set(tiles);
    }
}

impl WithSimd for Elimination<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::F32_LANES {
            8 => self.run::<S, { ROWS / 8 }>(simd),
            4 => self.run::<S, { ROWS / 4 }>(simd),
            _ => self.run::<Scalar, ROWS>(Scalar::new()),
        }
    }
}
