//! What is torn, as numbers of a checkpoint: of each cloth how many edges are torn, those in the order in which they tore, how many
//! seams are undone, and those.

use super::Simulation;
use super::saved_shape::Numbers;
use crate::tear::Split;

impl Simulation {
    pub(super) fn tears(&self) -> Vec<f64> {
        let none: [&[u32]; 2] = [&[], &[]];
        let histories =
            self.splits.iter().map(|split| split.as_deref().map_or(none, Split::history));
        let lists = histories.flatten().map(|list| list.iter().map(|&number| f64::from(number)));
        lists.flat_map(|list| std::iter::once(list.len() as f64).chain(list)).collect()
    }

    /// Tears the cloths as such numbers say, in the place of how they are torn now; the rest of the state is then to be restored.
    /// None, and nothing is changed, if the numbers are not of these cloths.
    pub(super) fn tear_alike(&mut self, tears: &[f64]) -> Option<()> {
        if tears == self.tears() {
            return Some(());
        }
        self.splits = self.splits_of(tears)?;
        let (cloths, from) = self.pieces();
        drop(self.become_cloths(cloths, &from));
        Some(())
    }

    /// The cloths as such numbers say that they are torn; none if the numbers are not of these cloths.
    fn splits_of(&self, tears: &[f64]) -> Option<Vec<Option<Box<Split>>>> {
        let mut numbers = Numbers(tears);
        let mut splits = Vec::new();
        for split in &self.splits {
            let [torn, undone] = [numbers.counted()?, numbers.counted()?]
                .map(|list| list.iter().map(|number| *number as u32).collect::<Vec<_>>());
            let Some(own) = split else {
                (torn.is_empty() && undone.is_empty()).then_some(())?;
                splits.push(None);
                continue;
            };
            own.has([&torn, &undone]).then_some(())?;
            let mut split = Split::new(own.given().clone());
            for edge in torn {
                split.tear(edge);
            }
            for seam in undone {
                split.undo(seam);
            }
            splits.push(Some(Box::new(split)));
        }
        numbers.0.is_empty().then_some(splits)
    }
}
