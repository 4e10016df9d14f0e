//! The dense work of one front: elimination and the two sweeps of a solve.
//!
//! Columns are eliminated [`ROWS`] at a time. What those before take from them is a product of matrices whose sums stay in
//! registers; for that, finished columns are kept a second time in tiles of [`ROWS`] rows. Products are added without rounding
//! in between, on every machine: where no instruction does so, slowly.

use pulp::Simd;

/// Rows of a tile, and columns that are eliminated together.
pub(super) const ROWS: usize = 16;

/// Columns whose sums are in registers together.
const QUAD: usize = 4;

/// A column of a tile.
pub(super) type Tile = [f32; ROWS];

/// A front: `size` rows, of which the first `own` are eliminated.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    pub(super) size: usize,
    pub(super) own: usize,
}

impl Shape {
    pub(super) fn below(self) -> usize {
        self.size - self.own
    }

    /// Tiles of own rows, and of all: rows below begin a tile of their own.
    fn tiles(self) -> [usize; 2] {
        let own = self.own.div_ceil(ROWS);
        [own, own + self.below().div_ceil(ROWS)]
    }

    /// The first row of a tile and how many it has.
    fn rows(self, tile: usize) -> (usize, usize) {
        let [own_tiles, _] = self.tiles();
        let (first, end) = if tile < own_tiles {
            (tile * ROWS, self.own)
        } else {
            (self.own + (tile - own_tiles) * ROWS, self.size)
        };
        (first, ROWS.min(end - first))
    }
}

/// Eliminates the own columns of a front in place, and subtracts what they make of the rows below from the rest. Both hold
/// whole columns, of which the lower triangle counts. The diagonal of L becomes its reciprocal; pivots are at least `least`.
#[inline(always)]
pub(super) fn eliminate<S: Simd, const VECTORS: usize>(
    simd: S,
    shape: Shape,
    columns: &mut [f32],
    least: &[f32],
    rest: &mut [f32],
    tiles: &mut Vec<Tile>,
) {
    let Shape { size, own } = shape;
    let [own_tiles, tile_count] = shape.tiles();
    tiles.clear();
    tiles.resize(tile_count * own, [0.0; ROWS]);
    for first in (0..own).step_by(ROWS) {
        let width = ROWS.min(own - first);
        let factors = &tiles[first / ROWS * own..][..first];
        for tile in first / ROWS..tile_count {
            let (row, count) = shape.rows(tile);
            let done = &tiles[tile * own..][..first];
            let to = &mut columns[first * size + row..];
            subtract_product::<S, VECTORS>(simd, done, factors, to, size, [count, width]);
        }
        factor_columns(&mut columns[first * size..][..width * size], size, first, least);
        for tile in first / ROWS..tile_count {
            let (row, count) = shape.rows(tile);
            let out = &mut tiles[tile * own + first..][..width];
            for (out, column) in out.iter_mut().zip(columns[first * size..].chunks_exact(size)) {
                out[..count].copy_from_slice(&column[row..row + count]);
            }
        }
    }
    let below = shape.below();
    for across in own_tiles..tile_count {
        let (column, width) = shape.rows(across);
        let factors = &tiles[across * own..][..own];
        for tile in across..tile_count {
            let (row, count) = shape.rows(tile);
            let done = &tiles[tile * own..][..own];
            let to = &mut rest[(column - own) * below + row - own..];
            subtract_product::<S, VECTORS>(simd, done, factors, to, below, [count, width]);
        }
    }
}

/// Subtracts the product of a tile and of the factors, transposed, from the first rows and columns of a matrix with so many
/// numbers from column to column.
#[inline(always)]
fn subtract_product<S: Simd, const VECTORS: usize>(
    simd: S,
    tile: &[Tile],
    factors: &[Tile],
    to: &mut [f32],
    stride: usize,
    [rows, columns]: [usize; 2],
) {
    if tile.is_empty() {
        return;
    }
    for first in (0..columns).step_by(QUAD) {
        let mut sums = [[simd.splat_f32s(0.0); VECTORS]; QUAD];
        for (numbers, factors) in tile.iter().zip(factors) {
            let numbers = S::as_simd_f32s(numbers).0;
            let factors: &[f32; QUAD] = &factors.as_chunks().0[first / QUAD];
            for (sums, &factor) in sums.iter_mut().zip(factors) {
                let factor = simd.splat_f32s(factor);
                for (sum, &number) in sums.iter_mut().zip(numbers) {
                    *sum = simd.mul_add_f32s(number, factor, *sum);
                }
            }
        }
        let width = QUAD.min(columns - first);
        for (i, sums) in sums.iter().enumerate().take(width) {
            let to = &mut to[(first + i) * stride..][..rows];
            if rows == ROWS {
                for (to, &sum) in S::as_mut_simd_f32s(to).0.iter_mut().zip(sums) {
                    *to = simd.sub_f32s(*to, sum);
                }
            } else {
                let mut lanes = [0.0; ROWS];
                S::as_mut_simd_f32s(&mut lanes).0.copy_from_slice(sums);
                for (to, sum) in to.iter_mut().zip(lanes) {
                    *to -= sum;
                }
            }
        }
    }
}

/// Eliminates columns from which all before are subtracted already.
#[inline(always)]
fn factor_columns(columns: &mut [f32], size: usize, first: usize, least: &[f32]) {
    for j in 0..columns.len() / size {
        let (before, column) = columns.split_at_mut(j * size);
        let column = &mut column[first + j..size];
        let mut sources = before.chunks_exact(size).map(|source| &source[first + j..]);
        while let Some(a) = sources.next() {
            if let [Some(b), Some(c), Some(d)] = std::array::from_fn(|_| sources.next()) {
                subtract_four(column, [a, b, c, d], [a[0], b[0], c[0], d[0]]);
            } else {
                break;
            }
        }
        for source in before.chunks_exact(size).skip(j / QUAD * QUAD) {
            let source = &source[first + j..];
            let factor = source[0];
            for (to, from) in column.iter_mut().zip(source) {
                *to -= factor * from;
            }
        }
        // A pivot that is no number becomes `least`; the rest of its row and column still says so to the solve.
        let reciprocal = 1.0 / column[0].max(least[first + j]).sqrt();
        for number in &mut *column {
            *number *= reciprocal;
        }
        column[0] = reciprocal;
    }
}

#[inline(always)]
fn subtract_four(to: &mut [f32], sources: [&[f32]; QUAD], [p, q, r, s]: [f32; QUAD]) {
    let [a, b, c, d] = sources.map(|source| &source[..to.len()]);
    for (i, to) in to.iter_mut().enumerate() {
        *to -= (p * a[i] + q * b[i]) + (r * c[i] + s * d[i]);
    }
}

/// Replaces a front's own values b by `L⁻¹ b` and takes `B L⁻¹ b` from those below.
#[inline(always)]
pub(super) fn up(Shape { size, own }: Shape, columns: &[f32], values: &mut [f32]) {
    for first in (0..own).step_by(QUAD) {
        let width = QUAD.min(own - first);
        let columns = &columns[first * size..][..width * size];
        let (solved, rest) = values[first..size].split_at_mut(width);
        for (j, column) in columns.chunks_exact(size).enumerate() {
            let column = &column[first..];
            solved[j] *= column[j];
            for i in j + 1..width {
                solved[i] -= column[i] * solved[j];
            }
        }
        let mut below = columns.chunks_exact(size).map(|column| &column[first + width..]);
        if let (&mut [p, q, r, s], [Some(a), Some(b), Some(c), Some(d)]) =
            (&mut *solved, std::array::from_fn(|_| below.next()))
        {
            subtract_four(rest, [a, b, c, d], [p, q, r, s]);
            continue;
        }
        for (column, value) in columns.chunks_exact(size).zip(&*solved) {
            for (to, number) in rest.iter_mut().zip(&column[first + width..]) {
                *to -= number * value;
            }
        }
    }
}

/// Replaces `L⁻¹ b` by the solution, given that of the values below.
#[inline(always)]
pub(super) fn down(Shape { size, own }: Shape, columns: &[f32], values: &mut [f32]) {
    for first in (0..own).step_by(QUAD).rev() {
        let width = QUAD.min(own - first);
        let (solved, rest) = values[first..size].split_at_mut(width);
        let column = |i: usize| &columns[(first + i) * size + first..][..size - first];
        let mut sums = [0.0; QUAD];
        if width == QUAD {
            sums = dot_four([0, 1, 2, 3].map(|i| &column(i)[QUAD..]), rest);
        } else {
            for (i, sum) in sums.iter_mut().enumerate().take(width) {
                *sum = column(i)[width..].iter().zip(&*rest).map(|(a, b)| a * b).sum();
            }
        }
        for j in (0..width).rev() {
            let own = column(j);
            let others: f32 = (j + 1..width).map(|i| own[i] * solved[i]).sum();
            solved[j] = (solved[j] - sums[j] - others) * own[j];
        }
    }
}

/// Sums that run side by side.
const LANES: usize = 8;

#[inline(always)]
fn dot_four(columns: [&[f32]; QUAD], values: &[f32]) -> [f32; QUAD] {
    let count = values.len();
    let [a, b, c, d] = columns.map(|column| &column[..count]);
    let mut sums = [[0.0_f32; LANES]; QUAD];
    let whole = count / LANES * LANES;
    for first in (0..whole).step_by(LANES) {
        let lanes = first..first + LANES;
        let values = &values[lanes.clone()];
        for (sums, column) in sums.iter_mut().zip([a, b, c, d]) {
            let column = &column[lanes.clone()];
            for lane in 0..LANES {
                sums[lane] += column[lane] * values[lane];
            }
        }
    }
    let mut dots = [0.0; QUAD];
    for (dot, (sums, column)) in dots.iter_mut().zip(sums.into_iter().zip([a, b, c, d])) {
        let [a, b, c, d, e, f, g, h] = sums;
        *dot = ((a + e) + (c + g)) + ((b + f) + (d + h));
        for (number, value) in column[whole..].iter().zip(&values[whole..]) {
            *dot += number * value;
        }
    }
    dots
}
