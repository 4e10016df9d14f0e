//! The Hessian of an implicit step, frozen at one state and never written down as a matrix.
//!
//! A spring of present length l, rest length L, direction n and force T(l) adds, for `d = d_i - d_j`,
//!
//! ```text
//! alpha n (n·d) + beta d        beta = max(0, T/l) + kd/h'  (relative damping)
//!                               alpha = max(0, T' - T/l) + kd/h'  (axial damping)
//! ```
//!
//! to row i and its opposite to row j. Hooke's law has T' = k and T/l = k (1 - L/l): what a compressed spring would
//! make negative is left out, so that H is positive definite. Beyond the allowed length equation 6 has
//! T/l = k (l/L - 1) and T' = k (2 l/L - 1).
//!
//! An edge at its limit adds its own alpha and beta to those of its spring ([`super::taut`]).
//!
//! Triangles and hinges of fabrics add their own ([`crate::fabric`]).
//!
//! Springs lie as [`crate::kernel`] lays them out: diagonals of equal offset, whose ends load as vectors, and the
//! rest gathered.
//!
//! Source: Choi & Ko 2002 for the clamp.

mod blocks;
mod matrix;
mod product;
mod tangent;

use std::ops::Range;

use pulp::Arch;
use rayon::prelude::*;

use super::taut::Pulling;
use crate::contact::ContactMatrix;
use crate::fabric::{FabricProduct, Tangent};
use crate::kernel::{CHUNK, GATHERED, Layout, Place};
use crate::linear::LARGEST;
use crate::state::Coordinates;
use crate::system::{Observed, System};
pub(super) use matrix::Pattern;
pub(super) use product::Product;
use tangent::{Freeze, freeze_slot};

/// `sqrt(alpha) n` and beta of springs side by side.
#[derive(Clone, Debug, Default)]
struct Tangents([Vec<f32>; 4]);

impl Tangents {
    #[inline(always)]
    fn of(&self, springs: Range<usize>) -> [&[f32]; 4] {
        self.0.each_ref().map(|axis| &axis[springs.clone()])
    }
}

/// The same of one slot of gathered springs.
type SlotTangents = [[f32; GATHERED]; 4];

/// Bound of the eigenvalues where triangles are.
const LARGEST_OF_FABRIC: f32 = 4.0;

/// Slots that one task freezes, at the least.
const SLOTS: usize = 256;

/// The matrix at one state.
#[derive(Debug)]
pub(super) struct Hessian {
    /// For each diagonal of the layout.
    diagonals: Vec<Tangents>,
    /// For each gathered slot of the layout.
    slots: Vec<SlotTangents>,
    fabric: Tangent,
    /// `m/h'² + ka/h'` (kg/s²); 0 where pinned.
    pub(super) inertia: Vec<f32>,
    arch: Arch,
}

impl Hessian {
    pub(super) fn new(system: &System, particle_count: usize) -> Self {
        let layout = &system.layout;
        let diagonals = layout.diagonals.iter().map(|diagonal| {
            let count = diagonal.rest_lengths.len();
            Tangents(std::array::from_fn(|_| vec![0.0; count]))
        });
        Self {
            diagonals: diagonals.collect(),
            slots: vec![SlotTangents::default(); layout.gather_slots.len()],
            fabric: Tangent::new(&system.fabrics, particle_count),
            inertia: vec![0.0; particle_count],
            arch: Arch::new(),
        }
    }

    /// Takes the tangents at these positions, where forces were observed, for a step h' (s).
    pub(super) fn freeze(
        &mut self,
        system: &System,
        observed: &Observed,
        positions: &Coordinates,
        h: f64,
    ) {
        let layout = &system.layout;
        self.fabric.freeze(&system.fabrics, &observed.fabric, positions, h);
        let arch = self.arch;
        layout.diagonals.par_iter().zip(&mut self.diagonals).for_each(|(diagonal, tangents)| {
            let [x, y, z, beta] = tangents.0.each_mut().map(|axis| axis.par_chunks_mut(CHUNK));
            (x, y, z, beta).into_par_iter().enumerate().for_each(|(chunk, (x, y, z, beta))| {
                let first = chunk * CHUNK;
                arch.dispatch(Freeze { diagonal, positions, h, first, out: [x, y, z, beta] });
            });
        });
        let slots = layout.gather_slots.par_iter().zip(&mut self.slots);
        slots.with_min_len(SLOTS).for_each(|(slot, out)| {
            let gather = &layout.gathers[slot.gather as usize];
            freeze_slot(slot, &gather.particles, gather.law, positions, h, out);
        });
        self.freeze_seams(layout, h);
    }

    /// A seam resists all ways alike, closed or not: closed, it has no direction of its own.
    fn freeze_seams(&mut self, layout: &Layout, h: f64) {
        for (slot, lane) in layout.seams.iter().flatten() {
            let (slot, lane) = (*slot as usize, *lane as usize);
            let springs = &layout.gather_slots[slot];
            let [x, y, z, beta] = &mut self.slots[slot];
            (x[lane], y[lane], z[lane]) = (0.0, 0.0, 0.0);
            beta[lane] = (springs.stiffness[lane] + springs.damping[lane] / h) as f32;
        }
    }

    /// Adds what edges at their limit add to the tangents of their springs.
    pub(super) fn tauten(&mut self, pulling: &[Pulling]) {
        for pulling in pulling {
            match pulling.place {
                Place::Diagonal(diagonal, spring) => {
                    let [x, y, z, beta] = &mut self.diagonals[diagonal as usize].0;
                    let spring = spring as usize;
                    pulling.add_to([
                        &mut x[spring],
                        &mut y[spring],
                        &mut z[spring],
                        &mut beta[spring],
                    ]);
                }
                Place::Gathered(ends) => {
                    for (slot, lane) in ends {
                        let tangents = self.slots[slot as usize].each_mut();
                        pulling.add_to(tangents.map(|lanes| &mut lanes[lane as usize]));
                    }
                }
            }
        }
    }

    /// The product with H in a system, and on contacts.
    pub(super) fn on<'a>(&'a self, system: &'a System, contacts: &'a ContactMatrix) -> Product<'a> {
        let fabric = FabricProduct { fabrics: &system.fabrics, tangent: &self.fabric };
        Product { hessian: self, layout: &system.layout, fabric, contacts, has_bends: true }
    }

    /// The same without bend springs, which are soft and a third of the work, and with hinges as pairs of particles that do not know of each other:
    /// what smoothing works with.
    pub(super) fn without_bends<'a>(
        &'a self,
        system: &'a System,
        contacts: &'a ContactMatrix,
    ) -> Product<'a> {
        Product { has_bends: false, ..self.on(system, contacts) }
    }

    /// No eigenvalue of what smoothing works with, times the inverse of its blocks, is above this: a triangle's part is at
    /// most three times its part of the blocks, a hinge's four times.
    pub(super) fn largest(&self) -> f32 {
        if self.fabric.is_empty() { LARGEST } else { LARGEST_OF_FABRIC }
    }
}
