//! Bending that stays: creases, and the friction of yarns.
//!
//! A face of curvature K (see [`super::compliance`]) bends two elements side by side: an elastic one about the crease `K_p`
//! that was left in it, and one of friction about an anchor `K_a` that slips:
//!
//! ```text
//! E = A/2 (K - K_p):D:(K - K_p) + A/2 (K - K_a):D_f:(K - K_a)          (J)
//! |K - K_p|        <= yield_curvature + b |K_p|,   b = hardening/(1 - hardening)          (1/m)
//! |D_f:(K - K_a)|  <= bend_hysteresis/2                                                   (N·m/m)
//! ```
//!
//! Both together are one element of stiffness `D + D_f` about `(D + D_f)⁻¹ (D K_p + D_f K_a)`, whose angles at the edges are
//! added to the rest angles of hinges: forces and tangents are those of any fabric. After each step, the moments of hinges tell
//! the moments `M_nn = m_e/l_e` across a face's three edges, and so its whole M and K. What is beyond its bound is scaled back
//! to it by moving `K_p` or `K_a` towards K.
//!
//! Nothing depends on the mesh, as the bounds are those of the curvature and not of hinges that happen to lie across a fold. No
//! energy is gained: at the K of each face it becomes less, by `(2 s - s²)` of the energy of an element that is moved by the part
//! s of its way, and settling anew lessens it further; what a polynomial in place of the inverse errs by is less than that. Beside a
//! face that is bent far more, the part of [`super::variation`] may gain a little: moments tell each face without it.
//!
//! Curvature is that beyond the rest shape: where the rest shape changes, creases and anchors go with it.
//!
//! Source: Narain, Pfaff & O'Brien 2013 for creases; Miguel et al. 2013 for friction of Dahl's kind, here of Prandtl's; the
//! radial return of Wilkins 1964.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::compliance::{self, Compliance, Face, components};
use super::hinges::HingePack;
use super::material::Fabric;
use super::packs::LANES;
use crate::state::State;

/// Faces, or packs of hinges, that one task handles.
const TASK: usize = 256;

/// In place of an edge that has no hinge, or of a hinge that has no such face.
const NONE: u32 = u32::MAX;

/// What bends for good of one fabric: stiffness as [`components`] has it.
#[derive(Clone, Debug)]
struct YieldLaw {
    elastic: Vector3<f64>,
    friction: Vector3<f64>,
    both: Vector3<f64>,
    /// 1/m; infinite where nothing stays.
    yield_curvature: f64,
    /// By how much that grows with the curvature of the crease.
    growth: f64,
    /// The largest moment of friction by width (N·m/m).
    grip: f64,
}

/// A face that may yield, as it was given.
#[derive(Clone, Debug)]
struct YieldingFace {
    hinges: [u32; 3],
    /// The moments by width `(M_ww, M_ff, M_wf)` for each moment at its edges (1/m).
    moments: Matrix3<f64>,
    /// m²
    area: f64,
    law: u32,
    /// Among all faces.
    number: u32,
    /// One whose corners are all pinned does not bend.
    is_rigid: bool,
}

/// What was left in a face: curvatures `(K_ww, K_ff, 2 K_wf)` beyond those at rest (1/m).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Crease {
    elastic: Vector3<f64>,
    friction: Vector3<f64>,
}

/// Numbers of a crease.
pub(crate) const CREASE: usize = 6;

/// The faces that may yield.
#[derive(Debug, Default)]
pub(super) struct Yielding {
    laws: Vec<YieldLaw>,
    faces: Vec<YieldingFace>,
    /// Of each hinge, the places of the edges on both sides among `Scratch::left`.
    edges: Vec<[u32; 2]>,
    /// What changes, of each face.
    pub(super) creases: Vec<Crease>,
    scratch: Scratch,
}

/// Vectors of one look.
#[derive(Debug, Default)]
struct Scratch {
    /// Of each face, the angles (rad) at its edges that creases and anchors have left.
    left: Vec<[f64; 3]>,
    angles: Vec<f64>,
    moments: Vec<f64>,
    steps: compliance::Scratch<f64>,
}

impl Crease {
    /// As numbers of a checkpoint.
    pub(crate) fn to_numbers(self) -> [f64; CREASE] {
        let ([a, b, c], [d, e, f]) = (self.elastic.into(), self.friction.into());
        [a, b, c, d, e, f]
    }

    /// Back from those.
    pub(crate) fn from_numbers([a, b, c, d, e, f]: [f64; CREASE]) -> Self {
        Self { elastic: Vector3::new(a, b, c), friction: Vector3::new(d, e, f) }
    }
}

impl YieldLaw {
    fn new(fabric: &Fabric) -> Self {
        let (elastic, both) = (components(fabric.bend), components(fabric.holding_bend()));
        Self {
            friction: both - elastic,
            elastic,
            both,
            yield_curvature: fabric.yield_curvature.unwrap_or(f64::INFINITY),
            growth: fabric.hardening / (1.0 - fabric.hardening),
            grip: 0.5 * fabric.bend_hysteresis,
        }
    }

    /// The curvature (1/m) at which both elements together rest.
    fn rest(&self, crease: &Crease) -> Vector3<f64> {
        let elastic = self.elastic.component_mul(&crease.elastic);
        (elastic + self.friction.component_mul(&crease.friction)).component_div(&self.both)
    }

    /// Lets a face yield that bends against these moments by width (N·m/m), and says whether it did.
    fn give_way(&self, moments: &Vector3<f64>, crease: &mut Crease) -> bool {
        let curvature = self.rest(crease) + moments.component_div(&self.both);
        let bent = curvature - crease.elastic;
        let size = norm(bent, 0.5);
        let limit = self.yield_curvature + self.growth * norm(crease.elastic, 0.5);
        let slipped = curvature - crease.friction;
        let held = norm(self.friction.component_mul(&slipped), 2.0);
        if size > limit {
            crease.elastic += (size - limit) / ((1.0 + self.growth) * size) * bent;
        }
        if held > self.grip {
            crease.friction += (1.0 - self.grip / held) * slipped;
        }
        size > limit || held > self.grip
    }

    /// The energy (J/m²) that elements hold against each other.
    fn inner_energy(&self, crease: &Crease) -> f64 {
        let apart = crease.elastic - crease.friction;
        let parts = self.elastic.component_mul(&self.friction).component_div(&self.both);
        0.5 * parts.dot(&apart.component_mul(&apart))
    }
}

/// The size of a symmetric tensor, of whose three numbers the square of the last counts so often.
fn norm(tensor: Vector3<f64>, last: f64) -> f64 {
    (tensor.x * tensor.x + tensor.y * tensor.y + last * tensor.z * tensor.z).sqrt()
}

impl Yielding {
    /// Adds the faces of a cloth, which are numbered from `first`.
    pub(super) fn add(&mut self, fabric: &Fabric, faces: &[Face], first: usize) {
        if !fabric.yields() || fabric.holding_bend().iter().all(|bend| *bend <= 0.0) {
            return;
        }
        let law = self.laws.len() as u32;
        self.laws.push(YieldLaw::new(fabric));
        self.faces.extend(faces.iter().zip(first..).map(|(face, number)| {
            let area = face.area();
            let moments = (area * face.curvatures().transpose()).try_inverse();
            YieldingFace {
                hinges: face.hinges.map(|hinge| hinge.unwrap_or(NONE)),
                moments: moments.unwrap_or_else(Matrix3::zeros),
                area,
                law,
                number: number as u32,
                is_rigid: false,
            }
        }));
        self.creases.resize(self.faces.len(), Crease::default());
        self.scratch.left.resize(self.faces.len(), [0.0; 3]);
    }

    /// Links so many hinges to the faces that were added.
    pub(super) fn link(&mut self, hinge_count: usize) {
        if self.is_empty() {
            return;
        }
        self.edges = vec![[NONE; 2]; hinge_count];
        for (number, face) in self.faces.iter().enumerate() {
            for (side, &hinge) in face.hinges.iter().enumerate() {
                let Some([one, other]) = self.edges.get_mut(hinge as usize) else { continue };
                *if *one == NONE { one } else { other } = (3 * number + side) as u32;
            }
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// The numbers of the faces, in the order of their creases.
    pub(super) fn numbers(&self) -> impl Iterator<Item = usize> {
        self.faces.iter().map(|face| face.number as usize)
    }

    /// Takes up which faces are rigid.
    pub(super) fn follow_pins(&mut self, is_rigid: impl Fn(usize) -> bool) {
        for face in &mut self.faces {
            face.is_rigid = is_rigid(face.number as usize);
        }
    }

    /// Lets faces yield in a state, and hinges follow.
    pub(super) fn give_way(
        &mut self,
        state: &State,
        compliance: &Compliance,
        packs: &mut [HingePack],
        rest_angles: impl Fn(usize) -> f64 + Sync,
        arch: Arch,
    ) {
        let Self { laws, faces, creases, scratch, .. } = self;
        let Scratch { angles, moments, steps, .. } = scratch;
        angles.resize(LANES * packs.len(), 0.0);
        let tasks = packs.par_chunks(TASK).zip(angles.par_chunks_mut(TASK * LANES));
        tasks.for_each(|(packs, angles)| arch.dispatch(Look { packs, state, angles }));
        compliance.unvaried_moments(angles, moments, steps);
        let moments = &*moments;
        let all = faces.par_iter().zip(creases).with_min_len(TASK);
        let gave_way = all.map(|(face, crease)| {
            let at = |hinge: u32| moments.get(hinge as usize).copied().unwrap_or(0.0);
            let moments = face.moments * Vector3::from(face.hinges.map(at));
            !face.is_rigid && laws[face.law as usize].give_way(&moments, crease)
        });
        if gave_way.reduce(|| false, |one, other| one | other) {
            self.lay(packs, rest_angles);
        }
    }

    /// Gives hinges their rest angles (rad), from those without creases.
    pub(super) fn lay(
        &mut self,
        packs: &mut [HingePack],
        rest_angles: impl Fn(usize) -> f64 + Sync,
    ) {
        if self.is_empty() {
            return;
        }
        let Self { laws, faces, edges, creases, scratch } = self;
        let all = faces.par_iter().zip(creases).zip(&mut scratch.left).with_min_len(TASK);
        all.for_each(|((face, crease), left)| {
            let rest = laws[face.law as usize].rest(crease);
            let angles = face.area * face.moments.tr_mul(&rest);
            *left = if face.is_rigid { [0.0; 3] } else { angles.into() };
        });
        let left = scratch.left.as_flattened();
        let at = |edge: u32| left.get(edge as usize).copied().unwrap_or(0.0);
        packs.par_iter_mut().with_min_len(TASK).enumerate().for_each(|(number, pack)| {
            for (lane, angle) in pack.rest_angles.iter_mut().enumerate() {
                let hinge = LANES * number + lane.min(pack.count - 1);
                let [one, other] = edges[hinge];
                *angle = rest_angles(hinge) + (at(one) + at(other));
            }
        });
    }

    /// The energy (J) that the elements of some faces, of all that there are, hold against each other.
    pub(super) fn inner_energy(&self, faces: &Range<usize>) -> f64 {
        let place = |end| self.faces.partition_point(|face| (face.number as usize) < end);
        let own = place(faces.start)..place(faces.end);
        let own = self.faces[own.clone()].iter().zip(&self.creases[own]);
        let own = own.filter(|(face, _)| !face.is_rigid);
        own.map(|(face, crease)| face.area * self.laws[face.law as usize].inner_energy(crease))
            .sum()
    }
}

/// The angles of some packs of hinges.
struct Look<'a> {
    packs: &'a [HingePack],
    state: &'a State,
    angles: &'a mut [f64],
}

impl WithSimd for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for (pack, angles) in self.packs.iter().zip(self.angles.as_chunks_mut().0) {
            pack.angles(simd, self.state, angles);
        }
    }
}
