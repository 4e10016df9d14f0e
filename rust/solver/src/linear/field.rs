//! A small vector for each particle, as the linear solver reads it.

use rayon::prelude::*;

pub(crate) use crate::kernel::CHUNK;

/// Single precision, an array an axis.
#[derive(Clone, Debug, Default)]
pub(crate) struct Field(pub(crate) [Vec<f32>; 3]);

impl Field {
    pub(crate) fn zeros(count: usize) -> Self {
        Self(std::array::from_fn(|_| vec![0.0; count]))
    }

    pub(crate) fn copy_from(&mut self, other: &Self) {
        for (axis, source) in self.0.iter_mut().zip(&other.0) {
            axis.copy_from_slice(source);
        }
    }

    /// The vectors of some particles, axis by axis.
    #[inline(always)]
    pub(crate) fn pick<const N: usize>(&self, particles: &[u32; N]) -> [[f32; N]; 3] {
        self.0.each_ref().map(
            #[inline(always)]
            |axis| particles.map(|particle| axis[particle as usize]),
        )
    }

    /// The three axes of each chunk of particles.
    pub(crate) fn chunks(&self) -> impl IndexedParallelIterator<Item = [&[f32]; 3]> {
        let [x, y, z] = self.0.each_ref().map(|axis| axis.par_chunks(CHUNK));
        (x, y, z).into_par_iter().map(|(x, y, z)| [x, y, z])
    }

    /// The same, to change them.
    pub(crate) fn chunks_mut(&mut self) -> impl IndexedParallelIterator<Item = [&mut [f32]; 3]> {
        let [x, y, z] = self.0.each_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        (x, y, z).into_par_iter().map(|(x, y, z)| [x, y, z])
    }

    pub(crate) fn fill(&mut self, number: f32) {
        for axis in &mut self.0 {
            axis.fill(number);
        }
    }

    /// Changes each number by that of another field in its place.
    pub(crate) fn update(&mut self, other: &Self, change: impl Fn(&mut f32, f32) + Sync) {
        self.chunks_mut().zip(other.chunks()).for_each(|(own, other)| {
            for (own, other) in own.into_iter().zip(other) {
                for (own, &other) in own.iter_mut().zip(other) {
                    change(own, other);
                }
            }
        });
    }
}
