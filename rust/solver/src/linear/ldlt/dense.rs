//! Dense products of one front, for three right-hand sides.
//!
//! `[S⁻¹; W]` is stored in panels of [`PANEL`] rows, a last one of half as many where that is enough; within a panel,
//! column by column. A panel's sums stay in registers while its numbers stream by.

use std::ops::Range;

use pulp::{Scalar, Simd, WithSimd};

/// Rows of a panel.
const PANEL: usize = 16;

/// Rows of the last panel if it holds no more.
const HALF: usize = PANEL / 2;

/// Numbers of a vector that hold so many rows.
pub(super) fn padded(rows: usize) -> usize {
    rows.next_multiple_of(PANEL)
}

/// Rows that are stored for so many.
pub(super) fn panel_rows(rows: usize) -> usize {
    rows.next_multiple_of(HALF)
}

/// Where the numbers of a front's panels are: first row, rows, and the range of each.
pub(super) fn panels(
    rows: usize,
    columns: usize,
) -> impl Iterator<Item = (usize, usize, Range<usize>)> {
    (0..rows).step_by(PANEL).map(move |first| {
        let height = if rows - first <= HALF { HALF } else { PANEL };
        (first, height, first * columns..(first + height) * columns)
    })
}

/// `out = matrix b`, each an array an axis.
pub(super) struct Multiply<'a> {
    pub(super) matrix: &'a [f32],
    pub(super) rows: usize,
    /// A number for each column.
    pub(super) b: [&'a [f32]; 3],
    /// As long as [`padded`] says.
    pub(super) out: [&'a mut [f32]; 3],
}

impl WithSimd for Multiply<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        multiply(simd, self);
    }
}

#[inline(always)]
fn multiply<S: Simd>(simd: S, Multiply { matrix, rows, b, out }: Multiply<'_>) {
    let columns = b[0].len();
    let [x, y, z] = out;
    for (first, height, range) in panels(rows, columns) {
        let panel = &matrix[range];
        let out = [&mut *x, &mut *y, &mut *z].map(|axis| &mut axis[first..][..height]);
        match (height, S::F32_LANES) {
            (PANEL, 16) | (HALF, 8) => multiply_panel::<S, 1>(simd, panel, b, out),
            (PANEL, 8) | (HALF, 4) => multiply_panel::<S, 2>(simd, panel, b, out),
            (PANEL, 4) => multiply_panel::<S, 4>(simd, panel, b, out),
            (PANEL, _) => multiply_panel::<Scalar, PANEL>(Scalar::new(), panel, b, out),
            _ => multiply_panel::<Scalar, HALF>(Scalar::new(), panel, b, out),
        }
    }
}

/// One panel of as many vectors of rows.
#[inline(always)]
fn multiply_panel<S: Simd, const VECTORS: usize>(
    simd: S,
    panel: &[f32],
    b: [&[f32]; 3],
    out: [&mut [f32]; 3],
) {
    let zero = simd.splat_f32s(0.0);
    let mut sums = [[zero; VECTORS]; 3];
    let (columns, _) = S::as_simd_f32s(panel).0.as_chunks::<VECTORS>();
    for (((column, &x), &y), &z) in columns.iter().zip(b[0]).zip(b[1]).zip(b[2]) {
        for (sums, b) in sums.iter_mut().zip([x, y, z]) {
            let b = simd.splat_f32s(b);
            for (sum, &numbers) in sums.iter_mut().zip(column) {
                *sum = simd.add_f32s(*sum, simd.mul_f32s(numbers, b));
            }
        }
    }
    for (out, sums) in out.into_iter().zip(sums) {
        S::as_mut_simd_f32s(out).0.copy_from_slice(&sums);
    }
}

/// Lanes of a partial sum.
const LANES: usize = HALF;

/// Partial sums of one column for three right-hand sides.
pub(super) type Partial = [[f32; LANES]; 3];

/// `x -= matrixᵀ front`.
pub(super) struct SubtractTransposed<'a> {
    pub(super) matrix: &'a [f32],
    /// Rows that count.
    pub(super) rows: Range<usize>,
    /// 0 in the rows that do not count, and for all padding.
    pub(super) front: [&'a [f32]; 3],
    pub(super) x: [&'a mut [f32]; 3],
    /// Memory.
    pub(super) partials: &'a mut Vec<Partial>,
}

impl WithSimd for SubtractTransposed<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        subtract_transposed(simd, self);
    }
}

#[inline(always)]
fn subtract_transposed<S: Simd>(simd: S, product: SubtractTransposed<'_>) {
    let SubtractTransposed { matrix, rows, front, x, partials } = product;
    let columns = x[0].len();
    partials.clear();
    partials.resize(columns, Partial::default());
    for (first, height, range) in panels(rows.end, columns) {
        if first + height <= rows.start {
            continue;
        }
        let panel = &matrix[range];
        let front = front.map(|axis| &axis[first..][..height]);
        match (height, S::F32_LANES) {
            (PANEL, 8) => add_panel::<S, 2, 1>(simd, panel, front, partials),
            (PANEL, 4) => add_panel::<S, 2, 2>(simd, panel, front, partials),
            (PANEL, _) => add_panel::<Scalar, 2, LANES>(Scalar::new(), panel, front, partials),
            (_, 8) => add_panel::<S, 1, 1>(simd, panel, front, partials),
            (_, 4) => add_panel::<S, 1, 2>(simd, panel, front, partials),
            _ => add_panel::<Scalar, 1, LANES>(Scalar::new(), panel, front, partials),
        }
    }
    for (axis, x) in x.into_iter().enumerate() {
        for (x, partial) in x.iter_mut().zip(partials.iter()) {
            let [a, b, c, d, e, f, g, h] = partial[axis];
            *x -= ((a + e) + (c + g)) + ((b + f) + (d + h));
        }
    }
}

/// Adds a panel of `GROUPS` times [`LANES`] rows, each of as many vectors, to the partial sums.
#[inline(always)]
fn add_panel<S: Simd, const GROUPS: usize, const VECTORS: usize>(
    simd: S,
    panel: &[f32],
    front: [&[f32]; 3],
    partials: &mut [Partial],
) {
    let zero = simd.splat_f32s(0.0);
    let mut fronts = [[[zero; VECTORS]; GROUPS]; 3];
    for (to, from) in fronts.iter_mut().zip(front) {
        to.as_flattened_mut().copy_from_slice(S::as_simd_f32s(from).0);
    }
    let (columns, _) = S::as_simd_f32s(panel).0.as_chunks::<VECTORS>();
    let (columns, _) = columns.as_chunks::<GROUPS>();
    for (column, partial) in columns.iter().zip(partials) {
        for (partial, front) in partial.iter_mut().zip(&fronts) {
            let partial = S::as_mut_simd_f32s(partial).0;
            for (numbers, front) in column.iter().zip(front) {
                for ((sum, &a), &b) in partial.iter_mut().zip(numbers).zip(front) {
                    *sum = simd.add_f32s(*sum, simd.mul_f32s(a, b));
                }
            }
        }
    }
}
