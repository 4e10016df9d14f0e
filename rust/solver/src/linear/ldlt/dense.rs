//! Dense products of one front, for three right-hand sides.
//!
//! A panel's sums stay in registers while its numbers stream by.

use pulp::Simd;

use super::panel::{Column, LANES, Lanes, Packed, ROWS};

/// x, y, z of a particle, and a number that fills the vector.
pub(super) type Row = [f32; 4];

/// The numbers of so many rows, an array an axis.
type Sums<const GROUPS: usize> = [[Lanes<f32>; GROUPS]; 3];

/// A panel of values.
pub(super) type Values = Sums<2>;

/// Memory of the front that is computed.
#[derive(Default)]
pub(super) struct Scratch {
    pub(super) solved: Vec<[Row; QUAD]>,
    pub(super) values: Vec<Values>,
}

/// One front of a sweep.
#[derive(Clone, Copy)]
pub(super) struct Product<'a> {
    pub(super) inverse: &'a [Lanes<f32>],
    pub(super) below: &'a [Packed],
    /// Where the rows below are in the values that follow the front's own, [`ROWS`] a panel.
    pub(super) places: &'a [[u32; ROWS]],
}

/// Replaces a front's own values b by `S⁻¹ b` and takes `W b` from those below.
#[inline(always)]
pub(super) fn up<S: Simd, const VECTORS: usize>(
    simd: S,
    front: Product,
    own: &mut [Row],
    rest: &mut [Row],
    scratch: &mut Scratch,
) {
    let count = own.len();
    let mut below = front.below;
    for places in front.places {
        let columns;
        (columns, below) = below.split_at(count);
        let shares = multiply::<S, _, VECTORS, 2>(simd, columns, own);
        for (quad, places) in places.as_chunks::<QUAD>().0.iter().enumerate() {
            for (share, &place) in rows(&shares, quad).iter().zip(places) {
                let to = &mut rest[place as usize];
                *to = std::array::from_fn(|axis| to[axis] - share[axis]);
            }
        }
    }
    let (mut whole, last) = front.inverse.split_at((count + LANES - 1) / ROWS * 2 * count);
    let (panels, half) = scratch.solved.split_at_mut((count + LANES - 1) / ROWS * ROWS / QUAD);
    for solved in panels.chunks_exact_mut(ROWS / QUAD) {
        let columns;
        (columns, whole) = whole.split_at(2 * count);
        let sums = multiply::<S, _, VECTORS, 2>(simd, columns.as_chunks::<2>().0, own);
        for (quad, solved) in solved.iter_mut().enumerate() {
            *solved = rows(&sums, quad);
        }
    }
    if !last.is_empty() {
        let sums = multiply::<S, _, VECTORS, 1>(simd, last, own);
        for (quad, solved) in half[..LANES / QUAD].iter_mut().enumerate() {
            *solved = rows(&sums, quad);
        }
    }
    own.copy_from_slice(&scratch.solved.as_flattened()[..count]);
}

/// Takes `Wᵀ x` of the values below from a front's own.
#[inline(always)]
pub(super) fn down<S: Simd, const VECTORS: usize>(
    simd: S,
    front: Product,
    own: &mut [Row],
    rest: &[Row],
    scratch: &mut Scratch,
) {
    let count = own.len();
    let values = &mut scratch.values[..front.places.len()];
    for (values, places) in values.iter_mut().zip(front.places) {
        for (quad, places) in places.as_chunks::<QUAD>().0.iter().enumerate() {
            let axes = transposed(places.map(|place| rest[place as usize]));
            for (values, axis) in values.iter_mut().zip(axes) {
                values[quad / 2].0[quad % 2 * QUAD..][..QUAD].copy_from_slice(&axis);
            }
        }
    }
    let (pairs, last) = own.as_chunks_mut::<2>();
    for (j, own) in pairs.iter_mut().enumerate() {
        subtract_transposed::<S, VECTORS, 2>(simd, front.below, count, 2 * j, values, own);
    }
    if let [own] = last {
        let own = std::array::from_mut(own);
        subtract_transposed::<S, VECTORS, 1>(simd, front.below, count, count - 1, values, own);
    }
}

/// Rows that are turned at once.
pub(super) const QUAD: usize = 4;

#[inline(always)]
fn transposed([a, b, c, d]: [Row; QUAD]) -> [Row; QUAD] {
    [0, 1, 2, 3].map(|i| [a[i], b[i], c[i], d[i]])
}

/// Four rows out of arrays an axis. What fills the vector is z once more, so that it stays a vector.
#[inline(always)]
fn rows<const GROUPS: usize>(sums: &Sums<GROUPS>, quad: usize) -> [Row; QUAD] {
    let [x, y, z] = sums.each_ref().map(|groups| {
        let lanes = &groups[quad / 2].0[quad % 2 * QUAD..];
        [lanes[0], lanes[1], lanes[2], lanes[3]]
    });
    transposed([x, y, z, z])
}

/// The product of one panel.
#[inline(always)]
fn multiply<S: Simd, C: Column<GROUPS>, const VECTORS: usize, const GROUPS: usize>(
    simd: S,
    columns: &[C],
    b: &[Row],
) -> Sums<GROUPS> {
    let zero = simd.splat_f32s(0.0);
    let mut sums = [[[zero; VECTORS]; GROUPS]; 3];
    for (column, b) in columns.iter().zip(b) {
        let numbers = column.load::<S, VECTORS>(simd);
        for (sums, &b) in sums.iter_mut().zip(b) {
            let b = simd.splat_f32s(b);
            for (sums, numbers) in sums.iter_mut().zip(&numbers) {
                for (sum, &numbers) in sums.iter_mut().zip(numbers) {
                    *sum = simd.add_f32s(*sum, simd.mul_f32s(numbers, b));
                }
            }
        }
    }
    let mut out = [[Lanes::default(); GROUPS]; 3];
    for (out, sums) in out.iter_mut().zip(&sums) {
        for (out, sums) in out.iter_mut().zip(sums) {
            S::as_mut_simd_f32s(&mut out.0).0.copy_from_slice(sums);
        }
    }
    out
}

/// Some neighboring columns, all panels.
#[inline(always)]
fn subtract_transposed<S: Simd, const VECTORS: usize, const COLUMNS: usize>(
    simd: S,
    below: &[Packed],
    count: usize,
    first: usize,
    values: &[Values],
    own: &mut [Row; COLUMNS],
) {
    let zero = simd.splat_f32s(0.0);
    let mut sums = [[[zero; VECTORS]; 3]; COLUMNS];
    let mut below = below;
    for values in values {
        let panel;
        (panel, below) = below.split_at(count);
        let columns = &panel[first..][..COLUMNS];
        for (sums, column) in sums.iter_mut().zip(columns) {
            let numbers = column.load::<S, VECTORS>(simd);
            for (sums, values) in sums.iter_mut().zip(values) {
                for (numbers, values) in numbers.iter().zip(values) {
                    let values = S::as_simd_f32s(&values.0).0;
                    for ((sum, &a), &b) in sums.iter_mut().zip(numbers).zip(values) {
                        *sum = simd.add_f32s(*sum, simd.mul_f32s(a, b));
                    }
                }
            }
        }
    }
    for (own, sums) in own.iter_mut().zip(&sums) {
        let mut lanes = [Lanes::default(); 3];
        for (lanes, sums) in lanes.iter_mut().zip(sums) {
            S::as_mut_simd_f32s(&mut lanes.0).0.copy_from_slice(sums);
        }
        let [x, y, z] = lanes.map(|Lanes([a, b, c, d, e, f, g, h])| [a + e, b + f, c + g, d + h]);
        let [a, b, c, d] = transposed([x, y, z, z]);
        *own = std::array::from_fn(|axis| own[axis] - ((a[axis] + c[axis]) + (b[axis] + d[axis])));
    }
}
