//! The forces that one diagonal's springs have within reach of a chunk, and their sums.
//!
//! A spring's force is stored once. Its first end finds it at its own place in the window, its second end an offset
//! earlier: the sums are a second, short pass, so that no sum waits for the one before it.

use std::ops::Range;

use pulp::{Scalar, Simd};

use super::lanes::{Lanes, vectors, vectors_mut};
use super::{CHUNK, ChunkVectors};
use crate::aligned::LINE;

/// Diagonals whose forces are summed side by side: all those of a grid.
pub(super) const SIDE_BY_SIDE: usize = 6;

/// Places of a window for each axis; the excess keeps axes and windows from falling on the same lines of the cache.
const PLACES: usize = 2 * CHUNK + 88;

/// The forces on the second ends of springs, an array an axis.
pub(super) struct Window<'a> {
    pub(super) axes: [&'a mut [f64]; 3],
}

impl Window<'_> {
    /// The place of the spring that starts at the first particle of the chunk: a whole number of cache lines.
    #[inline(always)]
    pub(super) fn lead(offset: usize) -> usize {
        offset.min(CHUNK).next_multiple_of(LINE)
    }
}

/// Memory for windows, kept for each thread to stay in its cache.
#[derive(Debug, Default)]
pub(crate) struct Windows(Vec<f64>);

impl Windows {
    /// The windows, each beginning on a line of the cache.
    #[inline(always)]
    pub(super) fn each(&mut self) -> [Window<'_>; SIDE_BY_SIDE] {
        self.0.resize(3 * SIDE_BY_SIDE * PLACES + LINE, 0.0);
        let start = self.0.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE);
        let mut axes = self.0[start..].chunks_exact_mut(PLACES);
        std::array::from_fn(|_| Window {
            axes: std::array::from_fn(|_| axes.next().unwrap_or_default()),
        })
    }
}

/// Stands for the windows that a chunk does not need.
static NOTHING: [f64; CHUNK] = [0.0; CHUNK];

/// Adds to the forces on a chunk's `count` particles what springs of the given offsets do to them.
#[inline(always)]
pub(super) fn add_windows<S: Simd>(
    simd: S,
    windows: &[Window<'_>; SIDE_BY_SIDE],
    offsets: &[usize; SIDE_BY_SIDE],
    used: usize,
    count: usize,
    force: &mut ChunkVectors,
) {
    let whole = count / S::F64_LANES * S::F64_LANES;
    for (axis, force) in force.iter_mut().enumerate() {
        let mut arriving = [&NOTHING[..count]; SIDE_BY_SIDE];
        let mut leaving = arriving;
        for i in 0..used {
            let lead = Window::lead(offsets[i]);
            let reach = offsets[i].min(CHUNK);
            arriving[i] = &windows[i].axes[axis][lead - reach..][..count];
            leaving[i] = &windows[i].axes[axis][lead..][..count];
        }
        add(simd, 0..whole, &arriving, &leaving, force);
        add(Scalar::new(), whole..count, &arriving, &leaving, force);
    }
}

#[inline(always)]
fn add<S: Simd>(
    simd: S,
    range: Range<usize>,
    arriving: &[&[f64]; SIDE_BY_SIDE],
    leaving: &[&[f64]; SIDE_BY_SIDE],
    force: &mut [f64; CHUNK],
) {
    let [a0, a1, a2, a3, a4, a5] = arriving.map(|window| vectors::<S>(&window[range.clone()]));
    let [l0, l1, l2, l3, l4, l5] = leaving.map(|window| vectors::<S>(&window[range.clone()]));
    for (i, total) in vectors_mut::<S>(&mut force[range.clone()]).iter_mut().enumerate() {
        let of = [(a0, l0), (a1, l1), (a2, l2), (a3, l3), (a4, l4), (a5, l5)];
        let mut sum = Lanes::of(simd, *total);
        for (arriving, leaving) in of {
            sum = sum + (Lanes::of(simd, arriving[i]) - Lanes::of(simd, leaving[i]));
        }
        *total = sum.values;
    }
}
