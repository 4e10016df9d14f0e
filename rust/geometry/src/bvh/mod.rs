//! A hierarchy of boxes over moving items: which of them may come near each other?
//!
//! An item is two boxes: one around where its points start, one around where they end. On straight ways, two items stay
//! apart if on one axis
//!
//! ```text
//! min_A > max_B   at the start and at the end            or the same with A and B exchanged
//! ```
//!
//! for what is positive at both ends of a line is positive between. Only relative motion counts: what falls together does
//! not meet.
//!
//! Items are sorted once along a space-filling curve through where they are at rest, and packed by eights; eight packs
//! make a pack of the next level. Cloth keeps its neighbours, so the order stays good and only boxes are fitted anew.
//! Eight boxes are tested at a time.
//!
//! Source: Morton 1966 for the curve; Wald et al. 2008 for wide hierarchies.

mod pack;
mod pairs;

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::Vector;
use pack::{Pack, WIDTH};
pub use pack::{Sweep, Way};

/// Packs that one task fits, at the least.
const PACKS: usize = 16;

/// A hierarchy of boxes over items numbered from 0.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// The item in each place of the lowest level; `u32::MAX` where there is none.
    items: Vec<u32>,
    /// Packs of items, packs of those, and so on to a single one: two levels at the least.
    levels: Vec<Vec<Pack>>,
}

impl Bvh {
    /// A hierarchy over items with these middles (m) at rest, of which those of one group stay together.
    #[must_use]
    pub fn new(middles: &[Vector], groups: &[u32]) -> Self {
        let mut order: Vec<(u32, u64, u32)> = curve(middles)
            .zip(groups)
            .enumerate()
            .map(|(item, (code, &group))| (group, code, item as u32))
            .collect();
        order.sort_unstable();
        let mut items: Vec<u32> = order.into_iter().map(|(_, _, item)| item).collect();
        items.resize(items.len().max(1).next_multiple_of(WIDTH), u32::MAX);
        let mut counts = vec![items.len() / WIDTH];
        while counts.len() < 2 || counts.last().is_some_and(|&count| count > 1) {
            counts.push(counts[counts.len() - 1].div_ceil(WIDTH));
        }
        let levels = counts.into_iter().map(|count| vec![Pack::EMPTY; count]).collect();
        Self { items, levels }
    }

    /// Fits all boxes to where the items are now.
    pub fn fit(&mut self, sweep_of: impl Fn(u32) -> Sweep + Sync) {
        let (lowest, upper) = self.levels.split_at_mut(1);
        let fit = |pack: &mut Pack, items: &[u32]| {
            for (lane, &item) in items.iter().enumerate() {
                let sweep = if item == u32::MAX { Sweep::EMPTY } else { sweep_of(item) };
                pack.set(lane, &sweep);
            }
        };
        let around = |pack: &mut Pack, children: &[Pack]| {
            for (lane, child) in children.iter().enumerate() {
                pack.set(lane, &child.hull());
            }
        };
        // The packs of the lowest level are still at hand for the next.
        let parents = upper[0].par_iter_mut().zip(lowest[0].par_chunks_mut(WIDTH));
        let parents = parents.zip(self.items.par_chunks(WIDTH * WIDTH));
        parents.with_min_len(PACKS / WIDTH).for_each(|((parent, packs), items)| {
            for (pack, items) in packs.iter_mut().zip(items.chunks(WIDTH)) {
                fit(pack, items);
            }
            around(parent, packs);
        });
        for level in 1..upper.len() {
            let (below, above) = upper.split_at_mut(level);
            let packs = above[0].par_iter_mut().zip(below[level - 1].par_chunks(WIDTH));
            packs.with_min_len(PACKS).for_each(|(pack, children)| around(pack, children));
        }
    }
}

/// Bits of each coordinate along the curve.
const BITS: u32 = 21;

/// Where points lie on the curve that fills the cube around all of them.
fn curve(points: &[Vector]) -> impl Iterator<Item = u64> {
    let min = points.iter().fold(Vector3::repeat(f64::INFINITY), |min, point| min.inf(point));
    let max = points.iter().fold(Vector3::repeat(f64::NEG_INFINITY), |max, point| max.sup(point));
    let size = (max - min).max().max(f64::MIN_POSITIVE);
    let cells = f64::from((1_u32 << BITS) - 1);
    points.iter().map(move |point| {
        let code = |axis: usize| spread(((point[axis] - min[axis]) / size * cells) as u64);
        code(0) | code(1) << 1 | code(2) << 2
    })
}

/// The lowest 21 bits of a number, two zeros after each.
fn spread(number: u64) -> u64 {
    let steps = [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ];
    steps.into_iter().fold(number & 0x1f_ffff, |code, (shift, mask)| (code | code << shift) & mask)
}

#[cfg(test)]
mod tests;
