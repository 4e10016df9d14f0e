//! Hinges side by side: their angles and how these change.

use pulp::Simd;

use super::elements::Hinge;
use super::hinge::{Point, angle_and_gradient, the_shorter_way};
use super::packs::{LANES, Places};
use crate::kernel::{Lanes, vectors, vectors_mut};
use crate::linear::Field;
use crate::state::{Coordinates, State};

/// Components of the gradients at four corners.
pub(super) const SLOPES: usize = 12;

/// For each hinge, the gradient (1/m) of its angle: corner by corner, axis by axis.
pub(super) type Slopes<N> = [[N; LANES]; SLOPES];

/// Hinges that follow one another in the list of all.
#[derive(Clone, Debug)]
pub(super) struct HingePack {
    pub(super) count: usize,
    corners: [Places; 4],
    /// rad, creases included.
    pub(super) rest_angles: [f64; LANES],
    /// Time (s) by which the stiffness is multiplied to damp.
    pub(super) times: [f64; LANES],
}

impl HingePack {
    /// The hinges in packs, given the times of laws.
    pub(super) fn all(hinges: &[Hinge], times: &[f64]) -> Vec<Self> {
        let pack = |own: &[Hinge]| {
            let count = own.len();
            let of = |lane: usize| &own[lane.min(count - 1)];
            Self {
                count,
                corners: [0, 1, 2, 3].map(|i| Places::new(count, |lane| of(lane).corners[i])),
                rest_angles: std::array::from_fn(|lane| of(lane).rest_angle),
                times: std::array::from_fn(|lane| times[of(lane).law as usize]),
            }
        };
        hinges.chunks(LANES).map(pack).collect()
    }

    /// The angles (rad) less those at rest, and by how much damping adds to them.
    #[inline(always)]
    pub(super) fn observe<S: Simd>(
        &self,
        simd: S,
        state: &State,
        slopes: &mut Slopes<f64>,
        angles: &mut [f64],
    ) {
        let at = self.corners(&state.position);
        let mut own = [0.0; LANES];
        for i in 0..LANES / S::F64_LANES {
            let x = at.each_ref().map(
                #[inline(always)]
                |point| vector(simd, point, i),
            );
            let (angle, gradient) = angle_and_gradient(x);
            let rest = Lanes::of(simd, vectors::<S>(&self.rest_angles)[i]);
            vectors_mut::<S>(&mut own)[i] = the_shorter_way(angle - rest).values;
            for (corner, gradient) in gradient.iter().enumerate() {
                for (axis, part) in gradient.iter().enumerate() {
                    vectors_mut::<S>(&mut slopes[3 * corner + axis])[i] = part.values;
                }
            }
        }
        if self.times.iter().any(|time| *time > 0.0) {
            let moving = self.corners(&state.velocity);
            for (corner, moving) in moving.iter().enumerate() {
                for (axis, v) in moving.iter().enumerate() {
                    for lane in 0..LANES {
                        own[lane] += self.times[lane] * slopes[3 * corner + axis][lane] * v[lane];
                    }
                }
            }
        }
        angles.copy_from_slice(&own);
    }

    /// The angles (rad) less those at rest, without damping.
    #[inline(always)]
    pub(super) fn angles<S: Simd>(&self, simd: S, state: &State, angles: &mut [f64; LANES]) {
        let at = self.corners(&state.position);
        for i in 0..LANES / S::F64_LANES {
            let x = at.each_ref().map(
                #[inline(always)]
                |point| vector(simd, point, i),
            );
            let rest = Lanes::of(simd, vectors::<S>(&self.rest_angles)[i]);
            let (angle, _) = angle_and_gradient(x);
            vectors_mut::<S>(angles)[i] = the_shorter_way(angle - rest).values;
        }
    }

    /// By how much a field turns each hinge.
    #[inline(always)]
    pub(super) fn turned(&self, slopes: &Slopes<f32>, p: &Field) -> [f32; LANES] {
        let mut sums = [0.0; LANES];
        for (corner, places) in self.corners.iter().enumerate() {
            for (axis, p) in p.0.iter().enumerate() {
                let p = places.load(p);
                for lane in 0..LANES {
                    sums[lane] += slopes[3 * corner + axis][lane] * p[lane];
                }
            }
        }
        sums
    }

    /// Adds moments along their slopes to the particles that are numbered from `first`.
    #[inline(always)]
    pub(super) fn add<N: Copy + std::ops::Mul<Output = N> + std::ops::AddAssign>(
        &self,
        slopes: &Slopes<N>,
        moments: [N; LANES],
        first: usize,
        out: [&mut [N]; 3],
    ) {
        for (axis, out) in out.into_iter().enumerate() {
            for (corner, places) in self.corners.iter().enumerate() {
                let slopes = &slopes[3 * corner + axis];
                let parts = std::array::from_fn(
                    #[inline(always)]
                    |lane| moments[lane] * slopes[lane],
                );
                places.add(self.count, &parts, first, out);
            }
        }
    }

    #[inline(always)]
    fn corners(&self, of: &Coordinates) -> [[[f64; LANES]; 3]; 4] {
        self.corners.each_ref().map(
            #[inline(always)]
            |corner| {
                of.0.each_ref().map(
                    #[inline(always)]
                    |axis| corner.load(axis),
                )
            },
        )
    }
}

#[inline(always)]
fn vector<S: Simd>(simd: S, lanes: &[[f64; LANES]; 3], i: usize) -> Point<Lanes<S>> {
    lanes.each_ref().map(
        #[inline(always)]
        |axis| Lanes::of(simd, vectors::<S>(axis)[i]),
    )
}
