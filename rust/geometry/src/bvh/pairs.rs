//! Which items may meet: of one hierarchy, or of two.
//!
//! Groups, eight packs each, of the first hierarchy are taken in order; each descends the second. Tasks are runs of groups,
//! and what they find is kept in their order, so that it does not depend on threads.

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::{Bvh, Pack, WIDTH};

/// Groups of one task.
const TASK: usize = 4;

/// Levels there can be at the most: 8^11 items are more than 2^32.
const DEPTH: usize = 12;

/// Pairs that are shown together, at the most.
const BUNDLE: usize = 256;

/// All eight of a pack.
const ALL: u32 = (1 << WIDTH) - 1;

impl Bvh {
    /// Shows `visit` all pairs of items that may meet, each once, in bundles, with what its task has found so far; returns
    /// the findings of all tasks in order.
    pub fn pairs<T: Default + Send>(&self, visit: impl Fn(&[[u32; 2]], &mut T) + Sync) -> Vec<T> {
        self.search(self, None, &visit)
    }

    /// The same for pairs of which one item at least is marked.
    pub fn pairs_of_marked<T: Default + Send>(
        &self,
        is_marked: impl Fn(u32) -> bool + Sync,
        visit: impl Fn(&[[u32; 2]], &mut T) + Sync,
    ) -> Vec<T> {
        let marks = self.marks(is_marked);
        self.search(self, Some(&marks), &visit)
    }

    /// The same for pairs of an item of this and one of another hierarchy.
    pub fn pairs_with<T: Default + Send>(
        &self,
        other: &Self,
        visit: impl Fn(&[[u32; 2]], &mut T) + Sync,
    ) -> Vec<T> {
        self.search(other, None, &visit)
    }

    /// The same for pairs of a marked item of this and one of another hierarchy.
    pub fn pairs_of_marked_with<T: Default + Send>(
        &self,
        is_marked: impl Fn(u32) -> bool + Sync,
        other: &Self,
        visit: impl Fn(&[[u32; 2]], &mut T) + Sync,
    ) -> Vec<T> {
        let marks = self.marks(is_marked);
        self.search(other, Some(&marks), &visit)
    }

    /// A bit for each marked item, pack by pack.
    fn marks(&self, is_marked: impl Fn(u32) -> bool + Sync) -> Vec<u32> {
        let packs = self.items.par_chunks(WIDTH).with_min_len(TASK * WIDTH);
        let bits = packs.map(|items| {
            let lanes = items.iter().enumerate();
            lanes.fold(0, |bits, (lane, &item)| {
                bits | u32::from(item != u32::MAX && is_marked(item)) << lane
            })
        });
        bits.collect()
    }

    fn search<T: Default + Send>(
        &self,
        other: &Self,
        marks: Option<&[u32]>,
        visit: &(impl Fn(&[[u32; 2]], &mut T) + Sync),
    ) -> Vec<T> {
        let count = self.levels[1].len();
        let arch = Arch::new();
        let tasks = (0..count.div_ceil(TASK)).into_par_iter().map(|task| {
            let groups = task * TASK..count.min((task + 1) * TASK);
            let mut found = T::default();
            let mut bundle = Bundle { pairs: [[0; 2]; BUNDLE], count: 0, visit, found: &mut found };
            arch.dispatch(Search { own: self, other, groups, marks, bundle: &mut bundle });
            bundle.show();
            found
        });
        tasks.collect()
    }
}

/// Pairs that are still to be shown.
struct Bundle<'a, T, V> {
    pairs: [[u32; 2]; BUNDLE],
    count: usize,
    visit: &'a V,
    found: &'a mut T,
}

impl<T, V: Fn(&[[u32; 2]], &mut T)> Bundle<'_, T, V> {
    #[inline(always)]
    fn add(&mut self, pair: [u32; 2]) {
        self.pairs[self.count] = pair;
        self.count += 1;
        if self.count == BUNDLE {
            self.show();
        }
    }

    #[inline(never)]
    fn show(&mut self) {
        (self.visit)(&self.pairs[..self.count], self.found);
        self.count = 0;
    }
}

/// What one task searches.
struct Search<'a, 'b, T, V> {
    own: &'a Bvh,
    other: &'a Bvh,
    groups: Range<usize>,
    /// The marked items of each pack of `own`, if not all count.
    marks: Option<&'a [u32]>,
    bundle: &'a mut Bundle<'b, T, V>,
}

impl<T, V: Fn(&[[u32; 2]], &mut T)> WithSimd for Search<'_, '_, T, V> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for group in self.groups.clone() {
            if self.is_searched(group) {
                self.descend(simd, group);
            }
        }
    }
}

impl<T, V: Fn(&[[u32; 2]], &mut T)> Search<'_, '_, T, V> {
    #[inline(always)]
    fn is_same(&self) -> bool {
        std::ptr::eq(self.own, self.other)
    }

    #[inline(always)]
    fn is_searched(&self, group: usize) -> bool {
        self.marks.is_none_or(|marks| {
            let packs = marks[group * WIDTH..].iter().take(WIDTH);
            packs.fold(0, |all, marks| all | marks) != 0
        })
    }

    /// The items of a pack that count, whatever they meet.
    #[inline(always)]
    fn marks_of(&self, pack: usize) -> u32 {
        self.marks.map_or(ALL, |marks| marks[pack])
    }

    /// Finds what the items of a group may meet.
    #[inline(always)]
    fn descend<S: Simd>(&mut self, simd: S, group: usize) {
        let whole = self.own.levels[1][group].hull();
        let is_same = self.is_same();
        let mut stack = [(0_usize, 0_usize); DEPTH * WIDTH];
        let mut height = 1;
        stack[0] = (self.other.levels.len() - 1, 0);
        while height > 0 {
            height -= 1;
            let (level, place) = stack[height];
            if level == 1 {
                // Where both groups are searched, the first of them sees to the pair.
                if !is_same || place >= group || !self.is_searched(place) {
                    self.compare_groups(simd, group, place);
                }
                continue;
            }
            let mut bits = self.other.levels[level][place].meets(simd, &whole);
            while bits != 0 {
                let child = place * WIDTH + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let last = (child + 1) << (3 * (level - 2));
                if is_same && self.marks.is_none() && last <= group {
                    continue;
                }
                stack[height] = (level - 1, child);
                height += 1;
            }
        }
    }

    /// Compares the packs of two groups.
    #[inline(always)]
    fn compare_groups<S: Simd>(&mut self, simd: S, group: usize, place: usize) {
        let [own, other] = [&self.own.levels[1][group], &self.other.levels[1][place]];
        let is_same = self.is_same();
        for lane in 0..WIDTH {
            let pack = group * WIDTH + lane;
            if pack >= self.own.levels[0].len() {
                break;
            }
            let whole = own.get(lane);
            let mut bits = other.meets(simd, &whole);
            if is_same && place == group {
                bits &= ALL << lane;
            }
            while bits != 0 {
                let other_lane = bits.trailing_zeros() as usize;
                bits &= bits - 1;
                self.compare(simd, [pack, place * WIDTH + other_lane], other, other_lane);
            }
        }
    }

    /// Compares the items of two packs, of which the second lies in a lane of its group.
    #[inline(always)]
    fn compare<S: Simd>(&mut self, simd: S, [pack, place]: [usize; 2], group: &Pack, lane: usize) {
        let is_same = self.is_same();
        let marks = [self.marks_of(pack), if is_same { self.marks_of(place) } else { 0 }];
        if marks == [0, 0] {
            return;
        }
        let [own, other] = [&self.own.levels[0][pack], &self.other.levels[0][place]];
        // Most items of two packs whose hulls meet are beside the other hull.
        let mut near = own.meets(simd, &group.get(lane));
        while near != 0 {
            let lane = near.trailing_zeros() as usize;
            near &= near - 1;
            let mut bits = other.meets(simd, &own.get(lane));
            if is_same && place == pack {
                bits &= ALL << (lane + 1);
            }
            if marks[0] & (1 << lane) == 0 {
                bits &= marks[1];
            }
            let item = self.own.items[pack * WIDTH + lane];
            while bits != 0 {
                let found = self.other.items[place * WIDTH + bits.trailing_zeros() as usize];
                bits &= bits - 1;
                self.bundle.add([item, found]);
            }
        }
    }
}
