//! The tangents of triangles and hinges at one state, and products with them.
//!
//! Those of triangles are added up along the edges once, so that a product costs as much as one with springs. Hinges stay as
//! they are: what they press depends on all hinges.

use std::sync::{Mutex, MutexGuard, PoisonError};

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::coupling::{EDGE, EdgeLink, WingLink};
use super::hinges::{SLOPES, Slopes};
use super::packs::LANES;
use super::triangles::{SIDE, TrianglePack};
use super::{FabricScratch, Fabrics, compliance};
use crate::kernel::CHUNK;
use crate::linear::{Entries, Field, Pairs};
use crate::state::Coordinates;

/// The part of the bound of hinges that the factored Hessian knows. With none, a napkin of 64 x 64 vertices and 0.1 m takes 6 to
/// 22 times the iterations; with all, long waves take more than with a third.
const BENT: f64 = 0.3;

/// Packs that one task freezes or turns.
const TASK: usize = 128;

/// The tangents of all fabrics.
#[derive(Debug)]
pub(crate) struct Tangent {
    /// Of each triangle, the parts along its three sides.
    sides: Vec<[f32; SIDE]>,
    edges: Pairs<EDGE>,
    wings: Pairs<1>,
    /// Of each pack of hinges, the slopes of their angles (1/m), and `1 + t/h'`.
    slopes: Vec<Slopes<f32>>,
    damped: Vec<[f32; LANES]>,
    /// h' (s).
    step: f64,
    bending: Mutex<Bending>,
    arch: Arch,
}

/// Vectors of one product.
#[derive(Debug, Default)]
struct Bending {
    angles: Vec<f32>,
    moments: Vec<f32>,
    steps: compliance::Scratch<f32>,
}

impl Tangent {
    pub(crate) fn new(fabrics: &Fabrics, particle_count: usize) -> Self {
        let hinge_packs = fabrics.hinge_packs.len();
        Self {
            sides: vec![[0.0; SIDE]; 3 * fabrics.triangles.len()],
            edges: Pairs::new(&fabrics.couplings.edges, particle_count),
            wings: Pairs::new(&fabrics.couplings.wings, particle_count),
            slopes: vec![[[0.0; LANES]; SLOPES]; hinge_packs],
            damped: vec![[0.0; LANES]; hinge_packs],
            step: 1.0,
            bending: Mutex::default(),
            arch: Arch::new(),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.sides.is_empty()
    }

    /// Takes the tangents at these positions, in which hinges were observed, for a step h' (s).
    pub(crate) fn freeze(
        &mut self,
        fabrics: &Fabrics,
        scratch: &FabricScratch,
        positions: &Coordinates,
        h: f64,
    ) {
        if self.is_empty() {
            return;
        }
        self.step = h;
        self.freeze_edges(fabrics, positions, h);
        let packs = fabrics.hinge_packs.par_iter().zip(&scratch.slopes);
        let packs = packs.zip(&mut self.slopes).zip(&mut self.damped).with_min_len(TASK);
        packs.for_each(|(((pack, from), slopes), damped)| {
            *slopes = from.map(|lanes| lanes.map(|slope| slope as f32));
            *damped = pack.times.map(|time| (1.0 + time / h) as f32);
        });
    }

    fn freeze_edges(&mut self, fabrics: &Fabrics, positions: &Coordinates, h: f64) {
        // Packs may end before their last lane where laws change, so each finds its own place.
        let mut rest = &mut self.sides[..];
        let mut tasks = Vec::with_capacity(fabrics.triangle_packs.len() / TASK + 1);
        for packs in fabrics.triangle_packs.chunks(TASK) {
            let count: usize = packs.iter().map(|pack| pack.count).sum();
            let (own, others) = rest.split_at_mut(3 * count);
            rest = others;
            tasks.push((packs, own));
        }
        let arch = self.arch;
        tasks.into_par_iter().for_each(|(packs, out)| {
            arch.dispatch(Freeze { fabrics, packs, positions, h, out });
        });
        let Self { sides, edges, wings, .. } = self;
        let couplings = &fabrics.couplings;
        let bend = |both| within_step(both, h) as f32;
        edges.fill::<EdgeLink<true>>(|edge| {
            let mut numbers = [0.0; EDGE];
            numbers[..SIDE].copy_from_slice(&sum(sides, couplings.sides.of(edge)));
            numbers[SIDE] = bend(couplings.bends[edge]);
            numbers
        });
        let edge_count = couplings.edges.len();
        wings.fill::<WingLink>(|wings| [bend(couplings.bends[edge_count + wings])]);
    }

    /// What the triangles beside an edge add to the Hessian, by its number: the block by which its smaller end resists moves
    /// relative to its larger, row by row. Of what hinges add at most, [`BENT`] is in it.
    pub(crate) fn block(&self, fabrics: &Fabrics, edge: usize) -> [f32; 9] {
        let couplings = &fabrics.couplings;
        let [xx, yx, yy, zx, zy, zz, tx, ty, tz] = sum(&self.sides, couplings.sides.of(edge));
        let c = (BENT * within_step(couplings.most_bends[edge], self.step)) as f32;
        [xx + c, yx - tz, zx + ty, yx + tz, yy + c, zy - tx, zx - ty, zy + tx, zz + c]
    }

    /// Adds the blocks on the diagonal of a chunk's particles, of hinges as if each were alone.
    #[inline(always)]
    pub(crate) fn add_blocks(&self, first: usize, blocks: &mut Entries<&mut [f32]>) {
        self.edges.add_blocks::<EdgeLink<true>>(first, blocks);
        self.wings.add_blocks::<WingLink>(first, blocks);
    }
}

/// What stiffness (N/m) and damping (N·s/m) resist together (N/m) in a step of h (s).
fn within_step([stiffness, damping]: [f64; 2], h: f64) -> f64 {
    stiffness + damping / h
}

/// What the triangles beside an edge add up to.
#[inline(always)]
fn sum(sides: &[[f32; SIDE]], own: &[u32]) -> [f32; SIDE] {
    let mut sum = [0.0; SIDE];
    for &side in own {
        for (sum, part) in sum.iter_mut().zip(&sides[side as usize]) {
            *sum += part;
        }
    }
    sum
}

/// The parts of some triangles' tangents along their sides.
struct Freeze<'a> {
    fabrics: &'a Fabrics,
    packs: &'a [TrianglePack],
    positions: &'a Coordinates,
    h: f64,
    out: &'a mut [[f32; SIDE]],
}

impl WithSimd for Freeze<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let mut out = self.out.iter_mut();
        for pack in self.packs {
            let law = &self.fabrics.laws[pack.law as usize];
            let damped = law.times.map(|time| 1.0 + time / self.h);
            let sides = pack.sides(simd, law, self.positions, damped);
            for lane in 0..pack.count {
                for (side, out) in sides.iter().zip(&mut out) {
                    *out = side.map(|lanes| lanes[lane] as f32);
                }
            }
        }
    }
}

/// Tangents with the fabrics that they are of.
#[derive(Clone, Copy)]
pub(crate) struct FabricProduct<'a> {
    pub(crate) fabrics: &'a Fabrics,
    pub(crate) tangent: &'a Tangent,
}

/// The moments that a field turns hinges against.
pub(crate) struct Moments<'a>(MutexGuard<'a, Bending>);

impl<'a> FabricProduct<'a> {
    pub(crate) fn is_empty(&self) -> bool {
        self.tangent.is_empty()
    }

    /// What hinges press, as faces share their angles, where particles move by a field: to be added chunk by chunk.
    pub(crate) fn bend(&self, p: &Field) -> Moments<'a> {
        let Self { fabrics, tangent } = *self;
        // Whoever panicked before left numbers that are all filled anew.
        let mut bending = tangent.bending.lock().unwrap_or_else(PoisonError::into_inner);
        let Bending { angles, moments, steps } = &mut *bending;
        angles.resize(LANES * tangent.slopes.len(), 0.0);
        let tasks = angles.par_chunks_mut(TASK * LANES).enumerate();
        tasks.for_each(|(task, angles)| {
            tangent.arch.dispatch(Turn { product: *self, p, first: task * TASK, angles });
        });
        fabrics.compliance.moments(angles, moments, steps);
        Moments(bending)
    }

    /// Adds what triangles and hinges resist a field with to the particles of a chunk, or subtracts it: hinges by their
    /// moments, or, without, as if each were alone.
    #[inline(always)]
    pub(crate) fn add<S: Simd, const SUBTRACT: bool>(
        &self,
        simd: S,
        p: &Field,
        moments: Option<&Moments<'_>>,
        first: usize,
        out: &mut [&mut [f32]; 3],
    ) {
        let Self { fabrics, tangent } = *self;
        let Some(moments) = moments else {
            tangent.edges.add::<S, EdgeLink<true>, SUBTRACT>(simd, p, first, out);
            tangent.wings.add::<S, WingLink, SUBTRACT>(simd, p, first, out);
            return;
        };
        tangent.edges.add::<S, EdgeLink<false>, SUBTRACT>(simd, p, first, out);
        let all = moments.0.moments.as_chunks::<LANES>().0;
        let sign = if SUBTRACT { -1.0 } else { 1.0 };
        for &number in fabrics.hinge_packs_of.of(first / CHUNK) {
            let number = number as usize;
            let moments = all[number].map(
                #[inline(always)]
                |moment| sign * moment,
            );
            let [x, y, z] = &mut *out;
            let out = [&mut **x, &mut **y, &mut **z];
            fabrics.hinge_packs[number].add(&tangent.slopes[number], moments, first, out);
        }
    }
}

/// By how much a field turns some hinges.
struct Turn<'a> {
    product: FabricProduct<'a>,
    p: &'a Field,
    /// The first pack.
    first: usize,
    angles: &'a mut [f32],
}

impl WithSimd for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let FabricProduct { fabrics, tangent } = self.product;
        for (number, angles) in self.angles.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
            let number = self.first + number;
            let turned = fabrics.hinge_packs[number].turned(&tangent.slopes[number], self.p);
            for lane in 0..LANES {
                angles[lane] = tangent.damped[number][lane] * turned[lane];
            }
        }
    }
}
