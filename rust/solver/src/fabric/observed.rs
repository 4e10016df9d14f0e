//! The forces of fabrics in one state: first what hinges press, of all, then chunk by chunk of particles.

use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::hinges::{HingePack, SLOPES, Slopes};
use super::packs::LANES;
use super::{Fabrics, compliance};
use crate::kernel::{CHUNK, ChunkVectors};
use crate::state::State;

/// Packs of hinges that one task looks at.
const TASK: usize = 64;

/// What hinges do in one state.
#[derive(Debug, Default)]
pub(crate) struct FabricScratch {
    /// Of each pack, the slopes of the hinges' angles (1/m).
    pub(super) slopes: Vec<Slopes<f64>>,
    angles: Vec<f64>,
    moments: Vec<f64>,
    steps: compliance::Scratch<f64>,
}

impl Fabrics {
    /// Looks at every hinge in `state`.
    pub(crate) fn observe(&self, state: &State, scratch: &mut FabricScratch) {
        if self.hinges.is_empty() {
            return;
        }
        let FabricScratch { slopes, angles, moments, steps } = scratch;
        slopes.resize(self.hinge_packs.len(), [[0.0; LANES]; SLOPES]);
        angles.resize(LANES * self.hinge_packs.len(), 0.0);
        let tasks = self.hinge_packs.par_chunks(TASK).zip(slopes.par_chunks_mut(TASK));
        tasks.zip(angles.par_chunks_mut(TASK * LANES)).for_each(|((packs, slopes), angles)| {
            self.arch.dispatch(Look { packs, state, slopes, angles });
        });
        self.compliance.moments(angles, moments, steps);
    }

    /// Adds the forces (N) on the particles of a chunk, in a state whose hinges were observed.
    ///
    /// Inlined into its caller, to be compiled for the instruction set that the caller found.
    #[inline(always)]
    pub(crate) fn add_forces<S: Simd>(
        &self,
        simd: S,
        chunk: usize,
        state: &State,
        scratch: &FabricScratch,
        forces: &mut ChunkVectors,
    ) {
        let first = chunk * CHUNK;
        let count = CHUNK.min(state.len() - first);
        let [x, y, z] = forces;
        let mut out = [&mut x[..count], &mut y[..count], &mut z[..count]];
        for &number in self.triangle_packs_of.of(chunk) {
            let pack = &self.triangle_packs[number as usize];
            let law = &self.laws[pack.law as usize];
            let [x, y, z] = &mut out;
            pack.add_forces(simd, law, state, first, [&mut **x, &mut **y, &mut **z]);
        }
        let moments = scratch.moments.as_chunks::<LANES>().0;
        for &number in self.hinge_packs_of.of(chunk) {
            let number = number as usize;
            let moments = moments[number].map(
                #[inline(always)]
                |moment| -moment,
            );
            let [x, y, z] = &mut out;
            let out = [&mut **x, &mut **y, &mut **z];
            self.hinge_packs[number].add(&scratch.slopes[number], moments, first, out);
        }
    }
}

/// What some packs of hinges do.
struct Look<'a> {
    packs: &'a [HingePack],
    state: &'a State,
    slopes: &'a mut [Slopes<f64>],
    angles: &'a mut [f64],
}

impl WithSimd for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let angles = self.angles.as_chunks_mut::<LANES>().0;
        for ((pack, slopes), angles) in self.packs.iter().zip(self.slopes).zip(angles) {
            pack.observe(simd, self.state, slopes, angles);
        }
    }
}
