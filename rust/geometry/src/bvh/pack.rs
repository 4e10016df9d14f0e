//! Eight boxes side by side.

use pulp::Simd;

use crate::Vector;

/// How many boxes a pack holds.
pub(super) const WIDTH: usize = 8;

/// Half of what the gap of two items can lose, as a part of the largest coordinate, where all is computed in f32: some
/// ten roundings of 6e-8 for each.
const ROUNDING: f64 = 1.5e-6;

/// The farthest that a coordinate (m) is taken to be: differences of boxes stay numbers.
const FARTHEST: f32 = 1e30;

/// The straight way of a point, in f32, and what is kept around it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct Way {
    /// m.
    pub start: [f32; 3],
    /// m.
    pub end: [f32; 3],
    /// How far around (m) the point is held to reach: enough to make up for rounding.
    pub around: f32,
}

impl Way {
    /// From a start (m) by a step (m), with so much (m) around it.
    #[inline]
    #[must_use]
    pub fn new(start: &Vector, step: &Vector, around: f64) -> Self {
        let end = start + step;
        let farthest = start.amax().max(end.amax()) + around;
        let single = |x: f64| (x as f32).clamp(-FARTHEST, FARTHEST);
        let singles = |x: &Vector| [single(x.x), single(x.y), single(x.z)];
        let around = (around + ROUNDING * farthest) as f32 + f32::MIN_POSITIVE;
        Self { start: singles(start), end: singles(&end), around: around.min(FARTHEST) }
    }
}

/// Boxes around where an item starts and where it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    /// Smallest and largest coordinates (m), at the start and at the end.
    min: [[f32; 3]; 2],
    max: [[f32; 3]; 2],
}

impl Sweep {
    /// Of nothing: it meets nothing.
    pub(super) const EMPTY: Self =
        Self { min: [[f32::INFINITY; 3]; 2], max: [[f32::NEG_INFINITY; 3]; 2] };

    /// Of points, and all that is around them.
    #[inline]
    #[must_use]
    pub fn of<const N: usize>(ways: [&Way; N]) -> Self {
        let mut sweep = Self::EMPTY;
        for way in ways {
            for (time, place) in [&way.start, &way.end].into_iter().enumerate() {
                let [min, max] = [&mut sweep.min[time], &mut sweep.max[time]];
                for axis in 0..3 {
                    min[axis] = min[axis].min(place[axis] - way.around);
                    max[axis] = max[axis].max(place[axis] + way.around);
                }
            }
        }
        sweep
    }
}

/// Eight sweeps, axis by axis.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct Pack {
    min: [[[f32; WIDTH]; 3]; 2],
    max: [[[f32; WIDTH]; 3]; 2],
}

impl Pack {
    pub(super) const EMPTY: Self =
        Self { min: [[[f32::INFINITY; WIDTH]; 3]; 2], max: [[[f32::NEG_INFINITY; WIDTH]; 3]; 2] };

    #[inline]
    pub(super) fn set(&mut self, lane: usize, sweep: &Sweep) {
        for time in 0..2 {
            for axis in 0..3 {
                self.min[time][axis][lane] = sweep.min[time][axis];
                self.max[time][axis][lane] = sweep.max[time][axis];
            }
        }
    }

    #[inline(always)]
    pub(super) fn get(&self, lane: usize) -> Sweep {
        let pick = |rows: &[[[f32; WIDTH]; 3]; 2]| {
            rows.each_ref().map(|axes| [axes[0][lane], axes[1][lane], axes[2][lane]])
        };
        Sweep { min: pick(&self.min), max: pick(&self.max) }
    }

    /// Of all eight.
    #[inline]
    pub(super) fn hull(&self) -> Sweep {
        let least = |lanes: &[f32; WIDTH]| lanes.iter().copied().fold(f32::INFINITY, f32::min);
        let most = |lanes: &[f32; WIDTH]| lanes.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        Sweep {
            min: self.min.each_ref().map(|axes| axes.each_ref().map(least)),
            max: self.max.each_ref().map(|axes| axes.each_ref().map(most)),
        }
    }

    /// A bit for each of the eight that may meet another.
    #[inline(always)]
    pub(super) fn meets<S: Simd>(&self, simd: S, other: &Sweep) -> u32 {
        const { assert!(S::F32_LANES <= WIDTH, "a vector holds more than a pack") };
        let mut apart = [0.0; WIDTH];
        for (vector, apart) in S::as_mut_simd_f32s(&mut apart).0.iter_mut().enumerate() {
            *apart = simd.splat_f32s(f32::NEG_INFINITY);
            for axis in 0..3 {
                let start = simd.sub_f32s(
                    S::as_simd_f32s(&self.min[0][axis]).0[vector],
                    simd.splat_f32s(other.max[0][axis]),
                );
                let end = simd.sub_f32s(
                    S::as_simd_f32s(&self.min[1][axis]).0[vector],
                    simd.splat_f32s(other.max[1][axis]),
                );
                let ahead = simd.min_f32s(start, end);
                let start = simd.sub_f32s(
                    simd.splat_f32s(other.min[0][axis]),
                    S::as_simd_f32s(&self.max[0][axis]).0[vector],
                );
                let end = simd.sub_f32s(
                    simd.splat_f32s(other.min[1][axis]),
                    S::as_simd_f32s(&self.max[1][axis]).0[vector],
                );
                let behind = simd.min_f32s(start, end);
                *apart = simd.max_f32s(*apart, simd.max_f32s(ahead, behind));
            }
        }
        let mut bits = 0;
        for (lane, apart) in apart.into_iter().enumerate() {
            bits |= u32::from(apart <= 0.0) << lane;
        }
        bits
    }
}
