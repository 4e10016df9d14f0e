//! Which items may meet: of one hierarchy, or of two.
//!
//! Packs of the first hierarchy are taken in order, each descends the second. Tasks are runs of packs, and what they
//! find is joined in their order, so that it does not depend on threads.

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::{Bvh, WIDTH};

/// Packs of one task.
const TASK: usize = 32;

/// Levels there can be at the most: 8^11 items are more than 2^32.
const DEPTH: usize = 12;

impl Bvh {
    /// Calls `visit` for every pair of items that may meet, each once, with a list to put findings on.
    pub fn pairs<T: Send>(&self, visit: impl Fn(u32, u32, &mut Vec<T>) + Sync) -> Vec<T> {
        self.search(self, None, &visit)
    }

    /// The same for pairs of which one item at least is marked.
    pub fn pairs_of_marked<T: Send>(
        &self,
        is_marked: impl Fn(u32) -> bool + Sync,
        visit: impl Fn(u32, u32, &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        let marks = self.marks(is_marked);
        self.search(self, Some(&marks), &visit)
    }

    /// The same for pairs of an item of this and one of another hierarchy.
    pub fn pairs_with<T: Send>(
        &self,
        other: &Self,
        visit: impl Fn(u32, u32, &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        self.search(other, None, &visit)
    }

    /// The same for pairs of a marked item of this and one of another hierarchy.
    pub fn pairs_of_marked_with<T: Send>(
        &self,
        is_marked: impl Fn(u32) -> bool + Sync,
        other: &Self,
        visit: impl Fn(u32, u32, &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        let marks = self.marks(is_marked);
        self.search(other, Some(&marks), &visit)
    }

    /// A bit for each marked item, pack by pack.
    fn marks(&self, is_marked: impl Fn(u32) -> bool + Sync) -> Vec<u32> {
        let packs = self.items.par_chunks(WIDTH).with_min_len(TASK);
        let bits = packs.map(|items| {
            let lanes = items.iter().enumerate();
            lanes.fold(0, |bits, (lane, &item)| {
                bits | u32::from(item != u32::MAX && is_marked(item)) << lane
            })
        });
        bits.collect()
    }

    fn search<T: Send>(
        &self,
        other: &Self,
        marks: Option<&[u32]>,
        visit: &(impl Fn(u32, u32, &mut Vec<T>) + Sync),
    ) -> Vec<T> {
        let count = self.levels[0].len();
        let arch = Arch::new();
        let tasks = (0..count.div_ceil(TASK)).into_par_iter().map(|task| {
            let packs = task * TASK..count.min((task + 1) * TASK);
            let mut found = Vec::new();
            arch.dispatch(Search { own: self, other, packs, marks, visit, found: &mut found });
            found
        });
        let found: Vec<Vec<T>> = tasks.collect();
        found.into_iter().flatten().collect()
    }
}

/// What one task searches.
struct Search<'a, T, V> {
    own: &'a Bvh,
    other: &'a Bvh,
    packs: Range<usize>,
    /// The marked items of each pack of `own`, if not all count.
    marks: Option<&'a [u32]>,
    visit: &'a V,
    found: &'a mut Vec<T>,
}

impl<T, V: Fn(u32, u32, &mut Vec<T>)> WithSimd for Search<'_, T, V> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        for pack in self.packs.clone() {
            if self.marks.is_none_or(|marks| marks[pack] != 0) {
                self.descend(pack);
            }
        }
    }
}

impl<T, V: Fn(u32, u32, &mut Vec<T>)> Search<'_, T, V> {
    /// Finds what the items of a pack may meet.
    #[inline(always)]
    fn descend(&mut self, pack: usize) {
        let whole = self.own.levels[1][pack / WIDTH].get(pack % WIDTH);
        let is_same = std::ptr::eq(self.own, self.other);
        let mut stack = [(0_usize, 0_usize); DEPTH * WIDTH];
        let mut height = 1;
        stack[0] = (self.other.levels.len() - 1, 0);
        while height > 0 {
            height -= 1;
            let (level, place) = stack[height];
            if level == 0 {
                self.compare(pack, place);
                continue;
            }
            let mut bits = self.other.levels[level][place].meets(&whole);
            while bits != 0 {
                let child = place * WIDTH + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                // Of a pair of packs of one hierarchy, the first finds the second; but one without marks does not search.
                let last = (child + 1) << (3 * (level - 1));
                if is_same && self.marks.is_none() && last <= pack {
                    continue;
                }
                stack[height] = (level - 1, child);
                height += 1;
            }
        }
    }

    /// Compares the items of two packs.
    #[inline(always)]
    fn compare(&mut self, pack: usize, place: usize) {
        let is_same = std::ptr::eq(self.own, self.other);
        let all = (1 << WIDTH) - 1;
        let marks_of = |pack: usize| self.marks.map_or(all, |marks| marks[pack]);
        // Where both packs are searched, the first of them sees to the pair.
        if is_same && place < pack && marks_of(place) != 0 {
            return;
        }
        let [own, other] = [&self.own.levels[0][pack], &self.other.levels[0][place]];
        // Most items of two packs whose hulls meet are beside the other hull.
        let mut near = own.meets(&self.other.levels[1][place / WIDTH].get(place % WIDTH));
        while near != 0 {
            let lane = near.trailing_zeros() as usize;
            near &= near - 1;
            let mut bits = other.meets(&own.get(lane));
            if is_same && place == pack {
                bits &= all << (lane + 1);
            }
            if marks_of(pack) & (1 << lane) == 0 {
                bits &= if is_same { marks_of(place) } else { 0 };
            }
            let item = self.own.items[pack * WIDTH + lane];
            while bits != 0 {
                let found = self.other.items[place * WIDTH + bits.trailing_zeros() as usize];
                bits &= bits - 1;
                (self.visit)(item, found, self.found);
            }
        }
    }
}
