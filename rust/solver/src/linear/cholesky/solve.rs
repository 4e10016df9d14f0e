//! The two sweeps of a solve: up the tree of fronts, and down again.

use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::dense::{self, Shape};
use super::{AXES, Cholesky};
use crate::linear::field::{CHUNK, Field};

/// Subtrees with fewer numbers are one task.
const TASK: usize = 100_000;

impl Cholesky {
    pub(super) fn solve(&mut self, r: &Field, z: &mut Field) {
        let Some(root) = self.fronts.all.len().checked_sub(1) else { return };
        let mut values = std::mem::take(&mut self.values);
        self.up(root, r, &mut values);
        self.down(root, &mut values);
        z.chunks_mut().enumerate().for_each(|(chunk, z)| {
            let value_of = &self.value_of[chunk * CHUNK..][..z[0].len()];
            for (axis, z) in z.into_iter().enumerate() {
                for (z, &value) in z.iter_mut().zip(value_of) {
                    *z = values[value as usize + axis];
                }
            }
        });
        self.values = values;
    }

    /// The values of a subtree, cut into those of its halves and those of its last front.
    fn cut<'v>(&self, root: usize, values: &'v mut [f32]) -> ([&'v mut [f32]; 2], &'v mut [f32]) {
        let (below, own) = values.split_at_mut(values.len() - self.values_of[root].len());
        let block = &self.fronts.all[root].block;
        let middle = block.children.map_or(0, |[lower, _]| {
            self.values_of[lower as usize].end - self.values_of[block.first_block as usize].start
        });
        let (lower, upper) = below.split_at_mut(middle);
        ([lower, upper], own)
    }

    /// Runs something on both halves of a subtree.
    fn on_both(
        &self,
        root: usize,
        halves: [&mut [f32]; 2],
        run: impl Fn(usize, &mut [f32]) + Sync,
    ) {
        let block = &self.fronts.all[root].block;
        let (Some([lower, upper]), [lower_values, upper_values]) = (block.children, halves) else {
            return;
        };
        let [lower, upper] = [lower as usize, upper as usize];
        let first = self.columns[block.first_block as usize].start;
        if self.columns[root].end - first < TASK {
            run(lower, lower_values);
            run(upper, upper_values);
        } else {
            rayon::join(|| run(lower, lower_values), || run(upper, upper_values));
        }
    }

    /// Fills the values of a subtree: `L⁻¹ b` of its own particles, and what it passes to the rows below.
    fn up(&self, root: usize, r: &Field, values: &mut [f32]) {
        let front = &self.fronts.all[root];
        let ([lower, upper], own) = self.cut(root, values);
        self.on_both(root, [&mut *lower, &mut *upper], |half, values| self.up(half, r, values));
        let [x, y, z] = &r.0;
        let (first, rest) = own.split_at_mut(AXES * front.own_count());
        let particles = &self.fronts.order[front.own_places()];
        for (own, &particle) in first.as_chunks_mut::<AXES>().0.iter_mut().zip(particles) {
            let particle = particle as usize;
            *own = [x[particle], y[particle], z[particle]];
        }
        rest.fill(0.0);
        for (child, half) in front.block.children.into_iter().flatten().zip([lower, upper]) {
            let child = &self.fronts.all[child as usize];
            let passed = &half[half.len() - AXES * child.rows.len()..];
            for run in &child.runs {
                let [from, to, count] =
                    [run.from, run.to, run.count].map(|number| AXES * number as usize);
                let pairs = own[to..to + count].iter_mut().zip(&passed[from..from + count]);
                pairs.for_each(|(to, from)| *to += from);
            }
        }
        self.arch.dispatch(Pass::<true> {
            shape: front.shape(),
            columns: &self.numbers[self.columns[root].clone()],
            values: own,
        });
    }

    /// Replaces `L⁻¹ b` by the solution in a subtree, given that of the rows below.
    fn down(&self, root: usize, values: &mut [f32]) {
        let front = &self.fronts.all[root];
        let ([lower, upper], own) = self.cut(root, values);
        self.arch.dispatch(Pass::<false> {
            shape: front.shape(),
            columns: &self.numbers[self.columns[root].clone()],
            values: &mut *own,
        });
        let halves = [&mut *lower, &mut *upper];
        for (child, half) in front.block.children.into_iter().flatten().zip(halves) {
            let child = &self.fronts.all[child as usize];
            let start = half.len() - AXES * child.rows.len();
            for run in &child.runs {
                let [from, to, count] =
                    [run.from, run.to, run.count].map(|number| AXES * number as usize);
                half[start + from..][..count].copy_from_slice(&own[to..to + count]);
            }
        }
        self.on_both(root, [lower, upper], |half, values| self.down(half, values));
    }
}

/// One front of a sweep.
struct Pass<'a, const UP: bool> {
    shape: Shape,
    columns: &'a [f32],
    values: &'a mut [f32],
}

impl<const UP: bool> WithSimd for Pass<'_, UP> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { shape, columns, values } = self;
        if UP { dense::up(shape, columns, values) } else { dense::down(shape, columns, values) }
    }
}
