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
//! Any smooth surface bends with its B along any direction on any mesh, an edge with one face takes no moment, and a face all
//! of whose corners are pinned does not bend. The sum is close to its diagonal, so a fixed number of Chebyshev steps
//! ([`super::steps`]) stands for its inverse: a polynomial p, whose energy, forces and tangents agree exactly. Where curvature
//! varies from face to face, R of [`variation`] is added:
//!
//! ```text
//! m = p t          E = 1/2 (tᵀ m + mᵀ R m)          moments p (t + R m)
//! ```
//!
//! Source: Morley 1968 for the element; Grinspun et al. 2006 for normals at edges.

use nalgebra::{Matrix3, Vector3};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::packs::LANES;
use super::rows::{Number, Rows};
use super::steps::{LEFT, eigenvalues, of_many, steps};
use super::variation;

/// Hinges that one task handles.
const TASK: usize = 4096;

/// The least bending stiffness along one yarn, as a part of that along the other.
const LEAST_PART: f64 = 1e-3;

/// A face as its hinges see it.
#[derive(Clone, Debug)]
pub(super) struct Face {
    /// Its corners in coordinates of warp and weft (m).
    pub(super) flat: [[f64; 2]; 3],
    /// The hinge at the edge from each corner to the next.
    pub(super) hinges: [Option<u32>; 3],
    /// 1 where that hinge turns as the face is wound; -1 where the face beside it decided otherwise.
    pub(super) signs: [f64; 3],
    /// Bending stiffness (N·m) along warp and weft, as long as friction holds.
    pub(super) bend: [f64; 2],
}

impl Face {
    /// S (rad/(N·m)) at its three edges.
    pub(super) fn compliance(&self) -> Matrix3<f64> {
        let stiffness = Matrix3::from_diagonal(&components(self.bend));
        let curvatures = self.curvatures();
        let stiffness = self.area() * curvatures.transpose() * stiffness * curvatures;
        stiffness.try_inverse().unwrap_or_else(Matrix3::zeros)
    }

    /// m²
    pub(super) fn area(&self) -> f64 {
        let [a, b, c] = self.flat;
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
    }

    /// The curvature `(K_ww, K_ff, 2 K_wf)` of the face for each angle at its edges (1/(m rad)).
    pub(super) fn curvatures(&self) -> Matrix3<f64> {
        let [a, b, c] = self.flat;
        let area = self.area();
        let curvatures = [(a, b, 0), (b, c, 1), (c, a, 2)].map(|(from, to, side)| {
            let [w, f] = [to[0] - from[0], to[1] - from[1]];
            let length = w.hypot(f);
            // The normal of the edge is (f, -w)/length.
            self.signs[side] * Vector3::new(f * f, w * w, -2.0 * f * w) / (length * area)
        });
        Matrix3::from_columns(&curvatures)
    }
}

/// The stiffness (N·m) of the curvatures `(K_ww, K_ff, 2 K_wf)`, given that along warp and weft.
pub(super) fn components(bend: [f64; 2]) -> Vector3<f64> {
    let most = bend[0].max(bend[1]);
    let [warp, weft] = bend.map(|bend| bend.max(LEAST_PART * most));
    Vector3::new(warp, weft, 0.5 * (warp * weft).sqrt())
}

/// The sum of all compliances, scaled so that its diagonal is 1, and the polynomial that stands for its inverse.
#[derive(Debug)]
pub(super) struct Compliance {
    /// The entries off the diagonal.
    rows: Vec<Rows<4>>,
    /// What is added for curvature that varies.
    variation: Vec<Rows<{ variation::WIDTH }>>,
    /// For each hinge, the root of what its angle is multiplied by; 0 for one that takes no moment.
    scale: Vec<[f32; LANES]>,
    /// `keep` and `gain` of each Chebyshev step.
    steps: Vec<[f32; 2]>,
    /// The largest eigenvalue of the polynomial.
    largest: f64,
    arch: Arch,
}

/// Vectors of the Chebyshev steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch<N> {
    left: Vec<N>,
    step: Vec<N>,
    last: Vec<N>,
    /// The moments, scaled, as if curvature did not vary.
    unvaried: Vec<N>,
}

impl Compliance {
    /// Of so many hinges, given their faces; a rigid one does not bend.
    pub(super) fn new(
        hinge_count: usize,
        faces: &[Face],
        is_rigid: impl Fn(usize) -> bool,
    ) -> Self {
        let of_face = |(number, face): (usize, &Face)| {
            let bends = !is_rigid(number) && face.bend.iter().any(|bend| *bend > 0.0);
            bends.then(|| face.compliance())
        };
        let compliances: Vec<_> = faces.iter().enumerate().map(of_face).collect();
        let mut sums = vec![0.0; hinge_count];
        let mut entries: Vec<Vec<(u32, f64)>> = vec![Vec::new(); hinge_count];
        let (mut lows, mut high) = (Vec::new(), 1.0_f64);
        for (face, compliance) in faces.iter().zip(&compliances) {
            let Some(compliance) = compliance else { continue };
            for i in 0..3 {
                let Some(hinge) = face.hinges[i] else { continue };
                sums[hinge as usize] += compliance[(i, i)];
                for j in 0..3 {
                    if let (true, Some(other)) = (i != j, face.hinges[j]) {
                        entries[hinge as usize].push((other, compliance[(i, j)]));
                    }
                }
            }
            if let Some([least, most]) = eigenvalues(compliance) {
                lows.push(least);
                high = high.max(most);
            }
        }
        let low = lows.iter().copied().fold(1.0, f64::min);
        for own in &mut entries {
            own.sort_by_key(|(other, _)| *other);
        }
        let scale = |sum: &f64| if *sum > 0.0 { 1.0 / sum.sqrt() } else { 0.0 };
        let mut scale: Vec<f64> = sums.iter().map(scale).collect();
        let (variation, most) = variation::entries(hinge_count, faces, &compliances);
        let (rows, variation) = (Rows::all(&entries, &scale), Rows::all(&variation, &scale));
        scale.resize(hinge_count.next_multiple_of(LANES), 0.0);
        Self {
            rows,
            variation,
            scale: scale.as_chunks().0.iter().map(|own| own.map(|of| of as f32)).collect(),
            steps: steps(low, of_many(&mut lows), high),
            largest: (1.0 + LEFT) * (1.0 + (1.0 + LEFT) * most) / low,
            arch: Arch::new(),
        }
    }

    /// No moment of all hinges, each turned by at most as much as this one, is larger than this (N·m/rad) times the angle.
    pub(super) fn stiffest(&self, hinge: usize) -> f64 {
        self.largest * self.stiffness_alone(hinge)
    }

    /// What a hinge turns against (N·m/rad) if no other turns: more or less, since the others follow.
    pub(super) fn stiffness_alone(&self, hinge: usize) -> f64 {
        f64::from(self.scale[hinge / LANES][hinge % LANES]).powi(2)
    }

    /// Fills `moments` (N·m) with what angles (rad) press; both end with as many zeros as make the last pack whole.
    pub(super) fn moments<N: Number>(
        &self,
        angles: &[N],
        moments: &mut Vec<N>,
        scratch: &mut Scratch<N>,
    ) {
        let mut unvaried = std::mem::take(&mut scratch.unvaried);
        self.press(angles, None, &mut unvaried, scratch);
        self.press(angles, Some(&unvaried), moments, scratch);
        self.scale(moments);
        scratch.unvaried = unvaried;
    }

    /// The same as if curvature did not vary: what tells the curvature of each face.
    pub(super) fn unvaried_moments(
        &self,
        angles: &[f64],
        moments: &mut Vec<f64>,
        scratch: &mut Scratch<f64>,
    ) {
        self.press(angles, None, moments, scratch);
        self.scale(moments);
    }

    fn scale<N: Number>(&self, moments: &mut [N]) {
        for (moments, scale) in moments.as_chunks_mut::<LANES>().0.iter_mut().zip(&self.scale) {
            for lane in 0..LANES {
                moments[lane] = moments[lane] * N::of(scale[lane]);
            }
        }
    }

    /// All Chebyshev steps: without what varies, then with it, which the moments without tell.
    fn press<N: Number>(
        &self,
        angles: &[N],
        unvaried: Option<&[N]>,
        moments: &mut Vec<N>,
        scratch: &mut Scratch<N>,
    ) {
        let Scratch { left, step, last, .. } = scratch;
        for vector in [&mut *moments, &mut *left, &mut *step, &mut *last] {
            vector.resize(angles.len(), N::default());
        }
        for (number, factors) in self.steps.iter().enumerate() {
            let factors = factors.map(N::of);
            std::mem::swap(step, last);
            let last = &*last;
            let tasks = left.par_chunks_mut(TASK).zip(step.par_chunks_mut(TASK));
            let tasks = tasks.zip(moments.par_chunks_mut(TASK)).zip(angles.par_chunks(TASK));
            tasks.enumerate().for_each(|(task, (((left, step), moments), angles))| {
                let own = task * TASK..task * TASK + left.len();
                let packs = own.start / LANES..own.end / LANES;
                let varied = unvaried.map(|unvaried| (&self.variation[packs.clone()], unvaried));
                self.arch.dispatch(Press {
                    rows: &self.rows[packs.clone()],
                    scale: &self.scale[packs],
                    varied,
                    factors,
                    is_first: number == 0,
                    angles,
                    last,
                    own: &last[own],
                    left,
                    step,
                    moments,
                });
            });
        }
    }
}

/// One Chebyshev step of some packs.
struct Press<'a, N> {
    rows: &'a [Rows<4>],
    scale: &'a [[f32; LANES]],
    varied: Option<(&'a [Rows<{ variation::WIDTH }>], &'a [N])>,
    factors: [N; 2],
    /// Before the first, nothing was.
    is_first: bool,
    angles: &'a [N],
    /// The last step of all hinges, and of these.
    last: &'a [N],
    own: &'a [N],
    left: &'a mut [N],
    step: &'a mut [N],
    moments: &'a mut [N],
}

impl<N: Number> WithSimd for Press<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { rows, factors: [keep, gain], is_first, last, varied, .. } = self;
        let (angles, own) = (self.angles.as_chunks().0, self.own.as_chunks().0);
        let (left, step) = (self.left.as_chunks_mut().0, self.step.as_chunks_mut().0);
        let moments = self.moments.as_chunks_mut::<LANES>().0;
        for (pack, rows) in rows.iter().enumerate() {
            let (angles, own): (&[N; LANES], &[N; LANES]) = (&angles[pack], &own[pack]);
            let (left, step): (&mut [N; LANES], &mut [N; LANES]) =
                (&mut left[pack], &mut step[pack]);
            let moments = &mut moments[pack];
            let scale = self.scale[pack].map(N::of);
            if is_first {
                let mut sums = [N::default(); LANES];
                if let Some((rows, unvaried)) = varied {
                    rows[pack].add(unvaried, &mut sums);
                }
                for lane in 0..LANES {
                    left[lane] = scale[lane] * angles[lane] + sums[lane];
                    step[lane] = gain * left[lane];
                    moments[lane] = step[lane];
                }
            } else {
                let mut sums = *own;
                rows.add(last, &mut sums);
                for lane in 0..LANES {
                    left[lane] = left[lane] - sums[lane];
                    step[lane] = keep * own[lane] + gain * left[lane];
                    moments[lane] += step[lane];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::elements::Elements;
    use crate::fabric::tests::{cloth, sheet, uneven};
    use crate::scatter::scattered;

    /// The compliance of a sheet of so many by so many quads, and what is left of random angles (rad) that moments should press.
    fn left(counts: [u32; 2], sizes: [f64; 2]) -> (usize, f64) {
        let (faces, positions) = sheet(counts, sizes, 0.0);
        let fabric = uneven();
        let cloth = cloth(&faces, positions, 0.2, fabric.clone());
        let mut elements = Elements::default();
        elements.add(&cloth, &fabric, 0, 0);
        let count = elements.hinges.len();
        let compliance = Compliance::new(count, &elements.faces, |_| false);
        let scale = |hinge: usize| f64::from(compliance.scale[hinge / LANES][hinge % LANES]);
        let mut angles: Vec<f64> = (0..count).map(|i| scattered(i as u64) / scale(i)).collect();
        angles.resize(count.next_multiple_of(LANES), 0.0);
        let mut moments = Vec::new();
        compliance.unvaried_moments(&angles, &mut moments, &mut Scratch::default());
        let mut turned = vec![0.0; count];
        for face in &elements.faces {
            let own = face.hinges.map(|hinge| hinge.map_or(0.0, |hinge| moments[hinge as usize]));
            let angles = face.compliance() * Vector3::from(own);
            for (hinge, angle) in face.hinges.iter().zip(&angles) {
                if let Some(hinge) = hinge {
                    turned[*hinge as usize] += angle;
                }
            }
        }
        let sum = |of: &dyn Fn(usize) -> f64| (0..count).map(|i| of(i).powi(2)).sum::<f64>().sqrt();
        let error = sum(&|i| scale(i) * (turned[i] - angles[i]));
        (compliance.steps.len(), error / sum(&|i| scale(i) * angles[i]))
    }

    #[test]
    fn moments_of_needles_press_the_angles_that_they_are_told() {
        let (few, error) = left([8; 2], [1.0; 2]);
        assert!(few <= 12 && error < LEFT, "{few}: {error}");
        for part in [1.0 / 8.0, 1.0 / 16.0] {
            let (_, error) = left([8; 2], [1.0, part]);
            assert!(error < LEFT, "{part}: {error}");
        }
    }
}
