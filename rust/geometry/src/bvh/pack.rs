//! Eight boxes side by side.

use crate::Vector;

/// How many boxes a pack holds.
pub(crate) const WIDTH: usize = 8;

/// Where an item is, and how far its points move: boxes in f32 that surely hold them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    /// Smallest and largest coordinates (m) at the start.
    pub(crate) min: [f32; 3],
    pub(crate) max: [f32; 3],
    /// Smallest and largest moves (m).
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
}

/// Rounding of a number to f32 changes it by less than this part of it.
const ROUNDING: f32 = 1.2e-7;

fn below(x: f64) -> f32 {
    let x = x as f32;
    x - ROUNDING * x.abs() - f32::MIN_POSITIVE
}

fn above(x: f64) -> f32 {
    let x = x as f32;
    x + ROUNDING * x.abs() + f32::MIN_POSITIVE
}

impl Sweep {
    /// Of nothing: it meets nothing.
    pub(crate) const EMPTY: Self = Self {
        min: [f32::INFINITY; 3],
        max: [f32::NEG_INFINITY; 3],
        low: [0.0; 3],
        high: [0.0; 3],
    };

    /// Of points (m) with their moves (m), and all that is within a radius (m) of them.
    #[inline]
    #[must_use]
    pub fn around<const N: usize>(points: [(&Vector, &Vector); N], radius: f64) -> Self {
        let mut sweep = Self::EMPTY;
        for axis in 0..3 {
            let (mut min, mut max) = (f64::INFINITY, f64::NEG_INFINITY);
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for (place, step) in points {
                (min, max) = (min.min(place[axis]), max.max(place[axis]));
                (low, high) = (low.min(step[axis]), high.max(step[axis]));
            }
            (sweep.min[axis], sweep.max[axis]) = (below(min - radius), above(max + radius));
            (sweep.low[axis], sweep.high[axis]) = (below(low), above(high));
        }
        sweep
    }
}

/// Eight sweeps, axis by axis.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Pack {
    min: [[f32; WIDTH]; 3],
    max: [[f32; WIDTH]; 3],
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
}

impl Pack {
    pub(crate) const EMPTY: Self = Self {
        min: [[f32::INFINITY; WIDTH]; 3],
        max: [[f32::NEG_INFINITY; WIDTH]; 3],
        low: [[0.0; WIDTH]; 3],
        high: [[0.0; WIDTH]; 3],
    };

    pub(crate) fn set(&mut self, lane: usize, sweep: &Sweep) {
        for axis in 0..3 {
            self.min[axis][lane] = sweep.min[axis];
            self.max[axis][lane] = sweep.max[axis];
            self.low[axis][lane] = sweep.low[axis];
            self.high[axis][lane] = sweep.high[axis];
        }
    }

    #[inline(always)]
    pub(crate) fn get(&self, lane: usize) -> Sweep {
        let pick = |lanes: &[[f32; WIDTH]; 3]| [lanes[0][lane], lanes[1][lane], lanes[2][lane]];
        Sweep {
            min: pick(&self.min),
            max: pick(&self.max),
            low: pick(&self.low),
            high: pick(&self.high),
        }
    }

    /// Of all eight.
    pub(crate) fn hull(&self) -> Sweep {
        let least = |lanes: &[f32; WIDTH]| lanes.iter().copied().fold(f32::INFINITY, f32::min);
        let most = |lanes: &[f32; WIDTH]| lanes.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        Sweep {
            min: self.min.each_ref().map(least),
            max: self.max.each_ref().map(most),
            low: self.low.each_ref().map(least),
            high: self.high.each_ref().map(most),
        }
    }

    /// A bit for each of the eight that may meet another.
    #[inline(always)]
    pub(crate) fn meets(&self, other: &Sweep) -> u32 {
        let mut apart = [f32::NEG_INFINITY; WIDTH];
        for axis in 0..3 {
            let [min, max] = [&self.min[axis], &self.max[axis]];
            let [low, high] = [&self.low[axis], &self.high[axis]];
            for lane in 0..WIDTH {
                let nearing = low[lane] - other.high[axis];
                let nearing = if nearing < 0.0 { nearing } else { 0.0 };
                let ahead = (min[lane] - other.max[axis]) + nearing;
                let nearing = other.low[axis] - high[lane];
                let nearing = if nearing < 0.0 { nearing } else { 0.0 };
                let behind = (other.min[axis] - max[lane]) + nearing;
                let most = if ahead > behind { ahead } else { behind };
                apart[lane] = if most > apart[lane] { most } else { apart[lane] };
            }
        }
        let mut bits = 0;
        for (lane, apart) in apart.into_iter().enumerate() {
            bits |= u32::from(apart <= 0.0) << lane;
        }
        bits
    }
}
