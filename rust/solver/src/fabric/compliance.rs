//! How faces share the angle of the hinge between them.
//!
//! A hinge's angle says nothing about which of its two faces has bent. In Morley's plate element each edge has a normal of its
//! own, and the angle `t_e` of a hinge is the sum of what the faces on both sides turn up to it. A face with angles `p_e` at its
//! edges, of lengths `l_e` and normals `n_e` in its plane, has the curvature
//!
//! ```text
//! K = sum_e (l_e/A) p_e n_e n_eᵀ         and the energy         A/2 K:D:K = 1/2 pᵀ S⁻¹ p
//! ```
//!
//! The normals of edges settle where both faces press them with the same moment `m_e`. Then the compliances S of the faces add
//! up, and the moments of all hinges follow from their angles:
//!
//! ```text
//! (sum of S over faces) m = t          (rad)          E = 1/2 tᵀ m          (J)
//! ```
//!
//! No weights to choose: any smooth surface bends with its B along any direction on any mesh, an edge with one face takes no
//! moment, and a face all of whose corners are pinned does not bend. The sum is close to its diagonal, so a fixed number of
//! Chebyshev steps stands for its inverse: a polynomial, whose energy, forces and tangents agree exactly.
//!
//! Source: Morley 1968 for the element; Grinspun et al. 2006 for normals at edges.

use std::ops::{Add, Mul, Sub};

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

use crate::grouped::Grouped;
use crate::linear::chebyshev;

/// Hinges that one task handles at the least.
const CHUNK: usize = 4096;

/// Error of the moments that is left, as a part of them.
const LEFT: f64 = 0.02;

/// The most Chebyshev steps: slivers are then stiffer than they should be.
const MOST_STEPS: usize = 24;

/// The least bending stiffness along one yarn, as a part of that along the other.
const LEAST_PART: f64 = 1e-3;

/// A number that moments and angles are computed in.
pub(super) trait Number:
    Copy + Default + Send + Sync + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    fn of(value: f32) -> Self;
}

impl Number for f32 {
    fn of(value: f32) -> Self {
        value
    }
}

impl Number for f64 {
    fn of(value: f32) -> Self {
        value.into()
    }
}

/// A face as its hinges see it.
#[derive(Clone, Debug)]
pub(super) struct Face {
    /// Its corners in coordinates of warp and weft (m).
    pub(super) flat: [[f64; 2]; 3],
    /// The hinge at the edge from each corner to the next.
    pub(super) hinges: [Option<u32>; 3],
    /// Bending stiffness (N·m) along warp and weft.
    pub(super) bend: [f64; 2],
}

impl Face {
    /// S (rad/(N·m)) at its three edges.
    fn compliance(&self) -> Matrix3<f64> {
        let [a, b, c] = self.flat;
        let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
        let most = self.bend[0].max(self.bend[1]);
        let [warp, weft] = self.bend.map(|bend| bend.max(LEAST_PART * most));
        let stiffness =
            Matrix3::from_diagonal(&Vector3::new(warp, weft, 0.5 * (warp * weft).sqrt()));
        let curvatures = [(a, b), (b, c), (c, a)].map(|(from, to)| {
            let [w, f] = [to[0] - from[0], to[1] - from[1]];
            let length = w.hypot(f);
            // The normal of the edge is (f, -w)/length.
            Vector3::new(f * f, w * w, -2.0 * f * w) / (length * area)
        });
        let curvatures = Matrix3::from_columns(&curvatures);
        let stiffness = area * curvatures.transpose() * stiffness * curvatures;
        stiffness.try_inverse().unwrap_or_else(Matrix3::zeros)
    }
}

/// The sum of all compliances, scaled so that its diagonal is 1, and the polynomial that stands for its inverse.
#[derive(Debug)]
pub(super) struct Compliance {
    /// For each hinge, the root of what its angle is multiplied by; 0 for one that takes no moment.
    scale: Vec<f64>,
    /// The entries of each hinge's row off the diagonal, and whose they are.
    neighbors: Grouped<(u32, f32)>,
    /// `keep` and `gain` of each Chebyshev step.
    steps: Vec<[f32; 2]>,
    /// The largest eigenvalue of the polynomial.
    largest: f64,
}

/// Vectors of the Chebyshev steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch<N> {
    left: Vec<N>,
    step: Vec<N>,
    last: Vec<N>,
}

impl Compliance {
    /// Of so many hinges, given their faces; a rigid one does not bend.
    pub(super) fn new(
        hinge_count: usize,
        faces: &[Face],
        is_rigid: impl Fn(usize) -> bool,
    ) -> Self {
        let mut sums = vec![0.0; hinge_count];
        let mut entries: Vec<(u32, u32, f64)> = Vec::new();
        let mut bounds = [1.0_f64, 1.0_f64];
        for (number, face) in faces.iter().enumerate() {
            if is_rigid(number) || face.bend.iter().all(|bend| *bend <= 0.0) {
                continue;
            }
            let compliance = face.compliance();
            for i in 0..3 {
                let Some(hinge) = face.hinges[i] else { continue };
                sums[hinge as usize] += compliance[(i, i)];
                for j in 0..3 {
                    if let (true, Some(other)) = (i != j, face.hinges[j]) {
                        entries.push((hinge, other, compliance[(i, j)]));
                    }
                }
            }
            bounds = widened(bounds, &compliance);
        }
        let scale: Vec<f64> =
            sums.iter().map(|sum| if *sum > 0.0 { 1.0 / sum.sqrt() } else { 0.0 }).collect();
        entries.sort_by_key(|&(hinge, other, _)| (hinge, other));
        let neighbors = entries.iter().map(|&(hinge, other, value)| {
            let scaled = value * scale[hinge as usize] * scale[other as usize];
            (hinge, (other, scaled as f32))
        });
        let neighbors = Grouped::new(hinge_count, neighbors);
        Self { scale, neighbors, steps: steps(bounds), largest: (1.0 + LEFT) / bounds[0] }
    }

    /// No moment of all hinges, each turned by at most as much as this one, is larger than this (N·m/rad) times the angle.
    pub(super) fn stiffest(&self, hinge: usize) -> f64 {
        self.largest * self.stiffness_alone(hinge)
    }

    /// What a hinge turns against (N·m/rad) if no other turns: more or less, since the others follow.
    pub(super) fn stiffness_alone(&self, hinge: usize) -> f64 {
        self.scale[hinge].powi(2)
    }

    /// Fills `moments` (N·m) with what angles (rad) would press, were each hinge alone.
    pub(super) fn moments_alone(&self, angles: &[f32], moments: &mut Vec<f32>) {
        moments.resize(angles.len(), 0.0);
        let rows = moments.par_iter_mut().zip(angles).enumerate().with_min_len(CHUNK);
        rows.for_each(|(hinge, (moment, angle))| {
            *moment = self.stiffness_alone(hinge) as f32 * angle;
        });
    }

    /// Fills `moments` (N·m) with what angles (rad) press.
    pub(super) fn moments<N: Number>(
        &self,
        angles: &[N],
        moments: &mut Vec<N>,
        scratch: &mut Scratch<N>,
        to_number: impl Fn(f64) -> N + Sync,
    ) {
        let count = angles.len();
        let Scratch { left, step, last } = scratch;
        for vector in [&mut *moments, &mut *left, &mut *step, &mut *last] {
            vector.clear();
            vector.resize(count, N::default());
        }
        let scaled = left.par_iter_mut().zip(angles).zip(&self.scale).with_min_len(CHUNK);
        scaled.for_each(|((left, angle), scale)| *left = *angle * to_number(*scale));
        for (number, [keep, gain]) in self.steps.iter().enumerate() {
            let [keep, gain] = [keep, gain].map(|factor| N::of(*factor));
            if number > 0 {
                std::mem::swap(step, last);
                let last = &*last;
                let rows = left.par_iter_mut().enumerate().with_min_len(CHUNK);
                rows.for_each(|(hinge, left)| *left = *left - self.row(hinge, last));
            }
            let rows = step.par_iter_mut().zip(&*left).zip(&*last).zip(&mut *moments);
            rows.with_min_len(CHUNK).for_each(|(((step, left), last), moment)| {
                *step = keep * *last + gain * *left;
                *moment = *moment + *step;
            });
        }
        let scaled = moments.par_iter_mut().zip(&self.scale).with_min_len(CHUNK);
        scaled.for_each(|(moment, scale)| *moment = *moment * to_number(*scale));
    }

    /// A row of the scaled matrix times a vector.
    fn row<N: Number>(&self, hinge: usize, vector: &[N]) -> N {
        let others = self.neighbors.of(hinge).iter();
        others
            .fold(vector[hinge], |sum, &(other, value)| sum + N::of(value) * vector[other as usize])
    }
}

/// Bounds of the eigenvalues of the scaled sum, widened by those of one face: of a sum, they lie between those of its parts.
fn widened([low, high]: [f64; 2], compliance: &Matrix3<f64>) -> [f64; 2] {
    let diagonal = compliance.diagonal();
    if !diagonal.iter().all(|&value| value > 0.0) {
        return [low, high];
    }
    let scaled = Matrix3::from_fn(|i, j| compliance[(i, j)] / (diagonal[i] * diagonal[j]).sqrt());
    let eigenvalues = scaled.symmetric_eigenvalues();
    [low.min(eigenvalues.min()), high.max(eigenvalues.max())]
}

/// As many Chebyshev steps as leave little of the error.
fn steps([low, high]: [f64; 2]) -> Vec<[f32; 2]> {
    // Of a matrix that is hardly regular, the steps leave the softest parts out.
    let low = low.max(high / 400.0).min(0.98 * high);
    let root = (high / low).sqrt();
    let factor = (root - 1.0) / (root + 1.0);
    let count = ((0.5 * LEFT).ln() / factor.ln()).ceil().clamp(1.0, MOST_STEPS as f64);
    chebyshev::steps(low as f32, high as f32).take(count as usize).collect()
}
