//! The numbers of the factor, front by front, halves in parallel.

use pulp::{Arch, Simd, WithSimd};

use super::super::fronts::Front;
use super::super::laplacian::{Graph, Laplacian};
use super::panel::{Lanes, Packed, store_below, store_inverse};
use super::symbolic::Symbolic;

/// `[S⁻¹; W]` of every front.
#[derive(Clone, Debug, Default)]
pub(super) struct Factor {
    pub(super) inverse: Vec<Lanes<f32>>,
    pub(super) below: Vec<Packed>,
}

impl Factor {
    pub(super) fn new(symbolic: &Symbolic, graph: &Graph, matrix: &Laplacian, arch: Arch) -> Self {
        let [inverse_len, below_len] = symbolic.lens();
        let mut inverse = vec![Lanes::default(); inverse_len];
        let mut below = vec![Lanes::default(); below_len];
        if let Some(root) = symbolic.stored.len().checked_sub(1) {
            let eliminator = Eliminator { symbolic, graph, matrix, arch };
            eliminator.eliminate(root, (&mut inverse, &mut below));
        }
        Self { inverse, below }
    }
}

/// The S⁻¹ and the W of a subtree.
type Part<'a> = (&'a mut [Lanes<f32>], &'a mut [Packed]);

/// A square matrix whose lower triangle counts, column by column.
#[derive(Default)]
struct Square {
    size: usize,
    numbers: Vec<f64>,
}

impl Square {
    fn zeros(size: usize) -> Self {
        Self { size, numbers: vec![0.0; size * size] }
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        let (row, column) = (row.max(column), row.min(column));
        self.numbers[column * self.size + row] += value;
    }
}

struct Eliminator<'a> {
    symbolic: &'a Symbolic,
    graph: &'a Graph,
    matrix: &'a Laplacian,
    arch: Arch,
}

impl Eliminator<'_> {
    /// Eliminates a subtree into its part of the numbers and returns what remains for the rows below its root.
    fn eliminate(&self, root: usize, (inverse, below): Part) -> Square {
        let Symbolic { fronts, stored } = self.symbolic;
        let front = &fronts.all[root];
        let mut square = Square::zeros(front.count());
        let (inverses, inverse) = inverse.split_at_mut(inverse.len() - stored[root].inverse.len());
        let (belows, below) = below.split_at_mut(below.len() - stored[root].below.len());
        if let Some([lower, upper]) = front.block.children {
            let [lower, upper] = [lower as usize, upper as usize];
            let end = &stored[lower];
            let start = &stored[front.block.first_block as usize];
            let (lower_inverses, upper_inverses) =
                inverses.split_at_mut(end.inverse.end - start.inverse.start);
            let (lower_belows, upper_belows) =
                belows.split_at_mut(end.below.end - start.below.start);
            let lower_part = (lower_inverses, lower_belows);
            let upper_part = (upper_inverses, upper_belows);
            let remainders = fronts.join(
                root,
                || self.eliminate(lower, lower_part),
                || self.eliminate(upper, upper_part),
            );
            for (child, remainder) in [lower, upper].into_iter().zip(&remainders) {
                extend_add(&mut square, &fronts.all[child], remainder);
            }
        }
        self.assemble(front, &mut square);
        let (count, own_count) = (front.count(), front.own_count());
        let columns = self.arch.dispatch(Elimination { square: &mut square, own: own_count });
        if own_count > 0 {
            store_inverse(&columns, count, own_count, inverse);
            store_below(&columns, count, own_count, below);
        }
        remainder(&square, own_count)
    }

    /// Adds the matrix's own entries.
    fn assemble(&self, front: &Front, square: &mut Square) {
        let fronts = &self.symbolic.fronts;
        for (column, &particle) in fronts.order[front.own_places()].iter().enumerate() {
            square.add(column, column, self.matrix.diagonal[particle as usize]);
            for (neighbor, weight) in self.matrix.row(self.graph, particle) {
                if let Some(row) = fronts.row_of(front, neighbor).filter(|row| *row >= column) {
                    square.add(row, column, -weight);
                }
            }
        }
    }
}

/// Adds what a child leaves to its parent's front.
fn extend_add(square: &mut Square, child: &Front, remainder: &Square) {
    for (i, column_run) in child.runs.iter().enumerate() {
        for offset in 0..column_run.count {
            let from_column = (column_run.from + offset) as usize;
            let to_column = (column_run.to + offset) as usize;
            for run in &child.runs[i..] {
                let first = from_column.max(run.from as usize);
                let skipped = first - run.from as usize;
                let count = (run.count as usize).saturating_sub(skipped);
                let from = &remainder.numbers[from_column * remainder.size + first..][..count];
                let start = to_column * square.size + run.to as usize + skipped;
                for (to, value) in square.numbers[start..][..count].iter_mut().zip(from) {
                    *to += value;
                }
            }
        }
    }
}

/// Eliminates the first columns of a front and returns its `[S⁻¹; W]`, column by column.
struct Elimination<'a> {
    square: &'a mut Square,
    own: usize,
}

impl WithSimd for Elimination<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<f64> {
        eliminate_own(self.square, self.own);
        inverse_and_below(self.square, self.own)
    }
}

/// Columns that are taken together.
const PANEL: usize = 4;

/// Replaces the first `own` columns by their Cholesky factor L and subtracts L Lᵀ from the rest.
#[inline(always)]
fn eliminate_own(square: &mut Square, own: usize) {
    let size = square.size;
    for first in (0..own).step_by(PANEL) {
        let width = PANEL.min(own - first);
        let (done, rest) = square.numbers.split_at_mut((first + width) * size);
        let panel = &mut done[first * size..];
        for j in 0..width {
            let (before, column) = panel.split_at_mut(j * size);
            let column = &mut column[..size];
            for i in 0..j {
                let factor = before[i * size + first + j];
                subtract(
                    &mut column[first + j..],
                    &before[i * size + first + j..(i + 1) * size],
                    factor,
                );
            }
            let pivot = column[first + j].sqrt();
            column[first + j] = pivot;
            for number in &mut column[first + j + 1..] {
                *number /= pivot;
            }
        }
        for (j, column) in rest.chunks_exact_mut(size).enumerate() {
            let j = first + width + j;
            let column = &mut column[j..];
            if width == PANEL {
                let sources = std::array::from_fn(|i| &panel[i * size + j..(i + 1) * size]);
                subtract_four(column, sources, sources.map(|source| source[0]));
            } else {
                for i in 0..width {
                    let source = &panel[i * size + j..(i + 1) * size];
                    subtract(column, source, source[0]);
                }
            }
        }
    }
}

#[inline(always)]
fn subtract(column: &mut [f64], source: &[f64], factor: f64) {
    for (to, from) in column.iter_mut().zip(source) {
        *to -= factor * from;
    }
}

#[inline(always)]
fn subtract_four(column: &mut [f64], sources: [&[f64]; 4], [p, q, r, s]: [f64; 4]) {
    let [a, b, c, d] = sources.map(|source| &source[..column.len()]);
    for (i, to) in column.iter_mut().enumerate() {
        *to -= (p * a[i] + q * b[i]) + (r * c[i] + s * d[i]);
    }
}

/// What is left for the rows below.
fn remainder(square: &Square, own: usize) -> Square {
    let size = square.size - own;
    let columns = square.numbers.chunks_exact(square.size.max(1)).skip(own);
    Square { size, numbers: columns.flat_map(|column| &column[own..]).copied().collect() }
}

/// `[S⁻¹; W] = [L⁻ᵀ; B] L⁻¹`, column by column, from the factor L of S and the rows `B = A L⁻ᵀ` below it.
#[inline(always)]
fn inverse_and_below(square: &Square, own: usize) -> Vec<f64> {
    let size = square.size;
    let lower = |row: usize, column: usize| square.numbers[column * size + row];
    let mut numbers = vec![0.0; own * size];
    for j in 0..own {
        let (before, column) = numbers.split_at_mut(j * size);
        column[j] = 1.0;
        for i in 0..j {
            subtract(&mut column[..=i], &before[i * size..=i * size + i], lower(j, i));
        }
        let pivot = lower(j, j);
        for number in &mut column[..=j] {
            *number /= pivot;
        }
        column[own..size].copy_from_slice(&square.numbers[j * size + own..(j + 1) * size]);
    }
    for j in (0..own).rev() {
        let (before, after) = numbers.split_at_mut((j + 1) * size);
        let column = &mut before[j * size..];
        let mut later = (j + 1..own).zip(after.chunks_exact(size));
        while let Some((i, a)) = later.next() {
            let next: [_; 3] = std::array::from_fn(|_| later.next());
            if let [Some((_, b)), Some((_, c)), Some((_, d))] = next {
                let factors = std::array::from_fn(|k| lower(i + k, j));
                subtract_four(column, [a, b, c, d], factors);
            } else {
                subtract(column, a, lower(i, j));
                for (i, source) in next.into_iter().flatten() {
                    subtract(column, source, lower(i, j));
                }
            }
        }
        let pivot = lower(j, j);
        for number in column {
            *number /= pivot;
        }
    }
    numbers
}
