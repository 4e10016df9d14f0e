//! How the numbers of a front are stored: panels of rows, column by column.
//!
//! S⁻¹ keeps all digits of f32. W is rounded to bf16, the upper half of an f32: a solve is bound by what it reads. Both
//! sweeps read the same rounded W, so what they apply together stays symmetric and positive definite.

use pulp::Simd;

/// Numbers of a vector that is read at once, whatever vectors the machine has.
pub(super) const LANES: usize = 8;

/// Rows of a panel.
pub(super) const ROWS: usize = 2 * LANES;

/// A vector of numbers, which never crosses a line of the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub(super) struct Lanes<T>(pub(super) [T; LANES]);

/// A column of a panel, of `GROUPS` times [`LANES`] rows.
pub(super) trait Column<const GROUPS: usize> {
    /// As vectors of the machine, `VECTORS` a group.
    fn load<S: Simd, const VECTORS: usize>(&self, simd: S) -> [[S::f32s; VECTORS]; GROUPS];
}

impl Column<1> for Lanes<f32> {
    #[inline(always)]
    fn load<S: Simd, const VECTORS: usize>(&self, _: S) -> [[S::f32s; VECTORS]; 1] {
        let vectors = S::as_simd_f32s(&self.0).0;
        [std::array::from_fn(
            #[inline(always)]
            |i| vectors[i],
        )]
    }
}

impl Column<2> for [Lanes<f32>; 2] {
    #[inline(always)]
    fn load<S: Simd, const VECTORS: usize>(&self, simd: S) -> [[S::f32s; VECTORS]; 2] {
        let [[lower], [upper]] = [self[0].load(simd), self[1].load(simd)];
        [lower, upper]
    }
}

/// [`ROWS`] numbers in bf16: the first half in the lower bits, the second half in the upper bits.
pub(super) type Packed = Lanes<u32>;

impl Column<2> for Packed {
    #[inline(always)]
    fn load<S: Simd, const VECTORS: usize>(&self, simd: S) -> [[S::f32s; VECTORS]; 2] {
        let vectors = S::as_simd_u32s(&self.0).0;
        let shift = simd.splat_u32s(16);
        let mask = simd.splat_u32s(0xFFFF_0000);
        let lower = std::array::from_fn(
            #[inline(always)]
            |i| simd.transmute_f32s_u32s(simd.wrapping_dyn_shl_u32s(vectors[i], shift)),
        );
        let upper = std::array::from_fn(
            #[inline(always)]
            |i| simd.transmute_f32s_u32s(simd.and_u32s(vectors[i], mask)),
        );
        [lower, upper]
    }
}

/// Vectors that hold the S⁻¹ of so many particles: panels, the last of half as many rows where that is enough.
pub(super) fn inverse_len(own: usize) -> usize {
    own.div_ceil(LANES) * own
}

/// Panels of W.
pub(super) fn panel_count(rows: usize) -> usize {
    rows.div_ceil(ROWS)
}

/// Stores S⁻¹, given the columns of `[S⁻¹; W]`, each of so many rows.
pub(super) fn store_inverse(columns: &[f64], rows: usize, own: usize, out: &mut [Lanes<f32>]) {
    let mut out = out.iter_mut();
    for first in (0..own).step_by(ROWS) {
        let last = own.min(first + ROWS);
        for column in columns.chunks_exact(rows) {
            for numbers in column[first..last].chunks(LANES) {
                let Some(out) = out.next() else { return };
                for (out, number) in out.0.iter_mut().zip(numbers) {
                    *out = *number as f32;
                }
            }
        }
    }
}

/// Numbers so much smaller than the largest of their column take nothing from others.
const SMALL: f64 = 1.0 / 256.0;

/// Stores W in the same way, rounded.
///
/// What rounding takes from a number is given to the next of its column, and what is left in the end to the smallest
/// of those that may take it, which is rounded last: columns keep their sums. Otherwise a cloth that hardly any inertia
/// holds in its place would seem to be tied to it. What is hardly coupled must remain so: zeros stay zeros, and a
/// pinned particle stays where it is.
pub(super) fn store_below(columns: &[f64], rows: usize, own: usize, out: &mut [Packed]) {
    for (j, column) in columns.chunks_exact(rows).enumerate() {
        let column = &column[own..];
        let least = SMALL * column.iter().fold(0.0, |largest: f64, w| largest.max(w.abs()));
        let mut lost = 0.0;
        let mut smallest = None;
        let mut store = |row: usize, taken: f64| {
            let wanted = column[row] + taken;
            let bits = bf16(wanted as f32);
            let out = &mut out[row / ROWS * own + j].0[row % LANES];
            *out |= if row % ROWS < LANES { bits >> 16 } else { bits };
            wanted - f64::from(f32::from_bits(bits))
        };
        for (row, w) in column.iter().map(|w| w.abs()).enumerate() {
            if w <= least {
                lost += store(row, 0.0);
            } else if let Some(before) = smallest.replace(row) {
                let now = if w < column[before].abs() { before } else { row };
                smallest = Some(before + row - now);
                lost = store(now, lost);
            }
        }
        if let Some(row) = smallest {
            store(row, lost);
        }
    }
}

/// The bits of the nearest f32 whose lower half is zero.
fn bf16(number: f32) -> u32 {
    if !number.is_finite() {
        return number.to_bits() & 0xFFFF_0000 | u32::from(number.is_nan()) << 22;
    }
    let bits = number.to_bits();
    (bits + 0x7FFF + (bits >> 16 & 1)) & 0xFFFF_0000
}
