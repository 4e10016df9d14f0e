//! What changes a cloth's shape, as numbers of a checkpoint.
//!
//! Of each cloth how many rest lengths and rest angles are aimed at, and those, then how many others the frame begins with, and those; none
//! where they are as the cloth was given, or the same. Of each pressure where the frame begins and what is aimed at. Of each
//! seam 1 if it is welded, else 0. Of each face that may yield what bending has left in it.

use super::Simulation;
use crate::fabric::{CREASE, Crease};
use crate::force::Level;
use crate::tailoring::CLOSED;

/// The numbers of a checkpoint, told apart.
pub(super) struct SavedShape {
    /// Of each cloth, as the frame begins and as it ends.
    pub(super) lengths: Vec<[Vec<f64>; 2]>,
    levels: Vec<[Level; 2]>,
    pub(super) welded: Vec<bool>,
    pub(super) creases: Vec<Crease>,
}

impl Simulation {
    pub(super) fn shape_numbers(&self) -> Vec<f64> {
        let mut numbers = Vec::new();
        for rest in &self.rests {
            let [from, to] = rest.as_ref().map_or([&[][..]; 2], |rest| rest.both());
            let from = if from == to { &[] } else { from };
            for lengths in [to, from] {
                numbers.push(lengths.len() as f64);
                numbers.extend(lengths);
            }
        }
        numbers.extend(self.system.air.pressures.levels().flatten().flatten());
        numbers.extend(self.seams.welded().map(|is_welded| f64::from(u8::from(is_welded))));
        let creases = self.system.fabrics.creases().iter();
        numbers.extend(creases.flat_map(|crease| crease.to_numbers()));
        numbers
    }

    /// The present shape.
    pub(super) fn saved_shape(&self) -> SavedShape {
        SavedShape {
            lengths: self
                .rests
                .iter()
                .map(|rest| {
                    rest.as_ref()
                        .map_or_else(Default::default, |rest| rest.both().map(<[f64]>::to_vec))
                })
                .collect(),
            levels: self.system.air.pressures.levels().collect(),
            welded: self.seams.welded().collect(),
            creases: self.system.fabrics.creases().to_vec(),
        }
    }

    /// Tells the numbers of a checkpoint apart; nothing if they are not of these cloths.
    pub(super) fn read_shape(&self, numbers: &[f64]) -> Option<SavedShape> {
        let mut numbers = Numbers(numbers);
        let mut lengths = Vec::new();
        for (number, cloth) in self.cloths.iter().enumerate() {
            let hinge_count = self.system.fabrics.hinge_count(number);
            let [to, from] = [numbers.counted()?, numbers.counted()?];
            let is_length = |length: &f64| *length >= CLOSED && length.is_finite();
            let fits = |own: &[f64]| {
                let split = own.split_at_checked(cloth.springs.len());
                own.is_empty()
                    || split.is_some_and(|(lengths, angles)| {
                        angles.len() == hinge_count
                            && lengths.iter().all(is_length)
                            && angles.iter().all(|angle| angle.is_finite())
                    })
            };
            if !fits(to) || !fits(from) {
                return None;
            }
            lengths.push([from.to_vec(), to.to_vec()]);
        }
        let levels = numbers.take(6 * self.system.air.pressures.levels().count())?;
        let welded = numbers.take(self.seams.welded().count())?;
        let creases = numbers.take(CREASE * self.system.fabrics.creases().len())?;
        let is_finite = |number: &f64| number.is_finite();
        if !numbers.0.is_empty() || !levels.iter().chain(creases).all(is_finite) {
            return None;
        }
        let creases = creases.as_chunks().0.iter().copied().map(Crease::from_numbers).collect();
        let levels = levels.as_chunks::<3>().0.as_chunks::<2>().0.to_vec();
        let welded = welded.iter().map(|w| *w > 0.0).collect();
        Some(SavedShape { lengths, levels, welded, creases })
    }

    /// Takes the shape of a checkpoint up.
    pub(super) fn take_shape(&mut self, shape: SavedShape) {
        let SavedShape { lengths, levels, welded, creases } = shape;
        self.system.air.pressures.restore(&levels);
        let Self { seams, cloths, system, .. } = self;
        if seams.jump(welded.into_iter(), cloths, &mut system.layout) {
            self.follow_welds();
        }
        for (cloth, [from, to]) in lengths.iter().enumerate() {
            if !to.is_empty() {
                self.ensure_rest(cloth);
            }
            if let Some(rest) = &mut self.rests[cloth] {
                rest.restore(from, to);
                self.put_rest(cloth, 0.0);
            }
        }
        self.system.fabrics.put_creases(&creases);
    }
}

/// What is left of the numbers.
pub(super) struct Numbers<'a>(pub(super) &'a [f64]);

impl<'a> Numbers<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [f64]> {
        let (taken, others) = self.0.split_at_checked(count)?;
        self.0 = others;
        Some(taken)
    }

    /// A count, and so many numbers.
    pub(super) fn counted(&mut self) -> Option<&'a [f64]> {
        let count = self.take(1)?[0];
        self.take(count as usize)
    }
}
