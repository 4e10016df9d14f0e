//! Triangles and hinges side by side.
//!
//! Elements are ordered so that those of one shape follow one another: on grids, each corner of such a run is one particle
//! further on than that of the element before, and eight of them load as vectors. Others are picked one by one.

use std::ops::AddAssign;

/// Elements in a pack.
pub(super) const LANES: usize = 8;

/// A shape of which there is one element in so many, or more, makes runs.
const RAREST: usize = 64;

/// Where the elements of a pack read and add: particles, or hinges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    numbers: [u32; LANES],
    is_run: bool,
}

impl Places {
    /// Of up to `LANES` elements; the last stands in for those that lack.
    pub(super) fn new(count: usize, number: impl Fn(usize) -> u32) -> Self {
        let numbers = std::array::from_fn(|lane| number(lane.min(count - 1)));
        Self { numbers, is_run: numbers.windows(2).all(|pair| pair[1] == pair[0] + 1) }
    }

    #[inline(always)]
    pub(super) fn load<N: Copy>(&self, from: &[N]) -> [N; LANES] {
        if self.is_run {
            let first = self.numbers[0] as usize;
            let run = &from[first..first + LANES];
            std::array::from_fn(
                #[inline(always)]
                |lane| run[lane],
            )
        } else {
            self.numbers.map(
                #[inline(always)]
                |number| from[number as usize],
            )
        }
    }

    /// Adds the values of the first lanes to those that are numbered from `first`; others are no concern of theirs.
    #[inline(always)]
    pub(super) fn add<N: Copy + AddAssign>(
        &self,
        count: usize,
        values: &[N; LANES],
        first: usize,
        to: &mut [N],
    ) {
        let start = (self.numbers[0] as usize).wrapping_sub(first);
        if self.is_run && start < to.len() && start + LANES <= to.len() {
            let run = &mut to[start..start + LANES];
            for lane in 0..LANES {
                run[lane] += values[lane];
            }
        } else {
            for (number, value) in self.numbers.iter().zip(values).take(count) {
                let place = (*number as usize).wrapping_sub(first);
                if place < to.len() {
                    to[place] += *value;
                }
            }
        }
    }
}

/// In which order elements lie in runs, given their corners.
pub(super) fn order<const N: usize>(corners: &[[u32; N]]) -> Vec<u32> {
    let shape = |number: u32| {
        let own = &corners[number as usize];
        own.map(|corner| corner.wrapping_sub(own[0]))
    };
    let first = |number: u32| corners[number as usize][0];
    let mut numbers: Vec<u32> = (0..corners.len() as u32).collect();
    numbers.sort_by_key(|&number| (shape(number), first(number), number));
    let (mut common, mut rare) = (Vec::with_capacity(numbers.len()), Vec::new());
    for alike in numbers.chunk_by(|&a, &b| shape(a) == shape(b)) {
        let is_common = alike.len() * RAREST >= corners.len() && alike.len() >= LANES;
        if is_common { &mut common } else { &mut rare }.extend_from_slice(alike);
    }
    rare.sort_by_key(|&number| (first(number), number));
    common.extend(rare);
    common
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_falls_into_runs() {
        // Two triangles in each of 20 x 20 cells of 21 x 21 particles, and one that is like no other.
        let cells = (0..20_u32).flat_map(|r| (0..20).map(move |c| 21 * r + c));
        let mut corners: Vec<[u32; 3]> =
            cells.flat_map(|a| [[a, a + 1, a + 22], [a, a + 22, a + 21]]).collect();
        corners.insert(0, [440, 3, 70]);
        let order = order(&corners);
        assert_eq!(order.last(), Some(&0));
        let packs = order
            .chunks(LANES)
            .map(|own| Places::new(own.len(), |lane| corners[own[lane] as usize][0]).is_run);
        let runs = packs.clone().filter(|is_run| *is_run).count();
        assert!(runs * 2 > packs.count(), "{runs}");
    }

    #[test]
    fn places_load_and_add_in_runs_and_out_of_them() {
        let from: Vec<u32> = (0..20).map(|number| 100 + number).collect();
        for (count, numbers) in [(8, [4, 5, 6, 7, 8, 9, 10, 11]), (5, [3, 1, 19, 0, 7, 7, 7, 7])] {
            let places = Places::new(count, |lane| numbers[lane]);
            assert_eq!(places.load(&from), numbers.map(|number| 100 + number));
            for first in [0, 6] {
                let mut sums = vec![0; 14 - first];
                places.add(count, &[1, 2, 3, 4, 5, 6, 7, 8], first, &mut sums);
                let mut wanted = vec![0; 14 - first];
                for (lane, number) in numbers[..count].iter().enumerate() {
                    let place = (*number as usize).wrapping_sub(first);
                    if place < wanted.len() {
                        wanted[place] += lane as u32 + 1;
                    }
                }
                assert_eq!(sums, wanted, "from {first}");
            }
        }
    }
}
