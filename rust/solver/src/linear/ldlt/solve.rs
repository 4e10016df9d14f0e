//! The two sweeps of a solve: up the tree of tasks, and down again.

use pulp::{Arch, Scalar, Simd, WithSimd};
use rayon::prelude::*;

use super::super::field::Field;
use super::super::fronts::Front;
use super::dense::{self, Product, QUAD, Row, Scratch};
use super::factor::Factor;
use super::panel::{LANES, ROWS};
use super::plan::{Plan, Step, Task};
use super::symbolic::Symbolic;

/// Particles that one task reads out at the least.
const CHUNK: usize = 4096;

/// The values of all tasks.
#[derive(Debug)]
pub(super) struct Workspace {
    plan: Plan,
    values: Vec<Row>,
}

impl Workspace {
    pub(super) fn new(symbolic: &Symbolic) -> Self {
        let plan = Plan::new(symbolic);
        Self { values: vec![Row::default(); plan.value_count], plan }
    }

    #[cfg(test)]
    pub(super) fn task_count(&self) -> usize {
        self.plan.tasks.len()
    }

    pub(super) fn solve(
        &mut self,
        symbolic: &Symbolic,
        factor: &Factor,
        arch: Arch,
        r: &Field,
        z: &mut Field,
    ) {
        let Self { plan, values } = self;
        let Some(root) = plan.tasks.len().checked_sub(1) else { return };
        let sweep = Sweep { symbolic, plan, factor, arch };
        sweep.up(root, r, values);
        sweep.down(root, values);
        let [x, y, z] = z.0.each_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        let chunks = (x, y, z, plan.value_of.par_chunks(CHUNK)).into_par_iter();
        chunks.for_each(|(x, y, z, value_of)| {
            for (((x, y), z), &value) in x.iter_mut().zip(y).zip(z).zip(value_of) {
                [*x, *y, *z, _] = values[value as usize];
            }
        });
    }
}

#[derive(Clone, Copy)]
struct Sweep<'a> {
    symbolic: &'a Symbolic,
    plan: &'a Plan,
    factor: &'a Factor,
    arch: Arch,
}

/// A task and the values of its subtree.
type Part<'v> = (usize, &'v mut [Row]);

thread_local! {
    static SCRATCH: std::cell::Cell<Scratch> = std::cell::Cell::default();
}

impl<'a> Sweep<'a> {
    /// The values of a subtree, cut into those of its halves and its last task's.
    fn cut<'v>(
        &self,
        task: &Task,
        values: &'v mut [Row],
    ) -> (Option<[Part<'v>; 2]>, &'v mut [Row]) {
        let (below, own) = values.split_at_mut(task.values.start - task.first_value);
        let halves = task.children.map(|[lower, upper]| {
            let middle = self.plan.tasks[upper].first_value - task.first_value;
            let (lower_values, upper_values) = below.split_at_mut(middle);
            [(lower, lower_values), (upper, upper_values)]
        });
        (halves, own)
    }

    /// A child's last front and its rows below, at the end of the values of its subtree.
    fn passed<'v>(&self, (child, values): Part<'v>) -> (&'a Front, &'v mut [Row]) {
        let front = &self.symbolic.fronts.all[self.plan.tasks[child].root];
        let start = values.len() - 1 - front.rows.len();
        (front, &mut values[start..])
    }

    /// Fills the values of a subtree: y in its places, and what it passes to the rows below.
    fn up(&self, root: usize, r: &Field, values: &mut [Row]) {
        let task = &self.plan.tasks[root];
        let (halves, values) = self.cut(task, values);
        let (own, rest) = values.split_at_mut(task.places.len());
        let [x, y, z] = r.0.each_ref().map(Vec::as_slice);
        for (own, &particle) in own.iter_mut().zip(&self.symbolic.fronts.order[task.places.clone()])
        {
            let i = particle as usize;
            *own = [x[i], y[i], z[i], 0.0];
        }
        rest.fill(Row::default());
        if let Some([(lower, lower_values), (upper, upper_values)]) = halves {
            rayon::join(|| self.up(lower, r, lower_values), || self.up(upper, r, upper_values));
            for half in [(lower, lower_values), (upper, upper_values)] {
                let (front, passed) = self.passed(half);
                for run in &front.runs {
                    let to = &mut values[run.to as usize..][..run.count as usize];
                    for (to, from) in to.iter_mut().zip(&passed[run.from as usize..]) {
                        for (to, from) in to.iter_mut().zip(from) {
                            *to += from;
                        }
                    }
                }
            }
        }
        self.arch.dispatch(Pass::<true> { sweep: *self, task, values });
    }

    /// Replaces y by the solution in a subtree, given that of the rows below.
    fn down(&self, root: usize, values: &mut [Row]) {
        let task = &self.plan.tasks[root];
        let (halves, values) = self.cut(task, values);
        self.arch.dispatch(Pass::<false> { sweep: *self, task, values });
        let Some([(lower, lower_values), (upper, upper_values)]) = halves else { return };
        for half in [(lower, &mut *lower_values), (upper, &mut *upper_values)] {
            let (front, passed) = self.passed(half);
            for run in &front.runs {
                let to = &mut passed[run.from as usize..][..run.count as usize];
                to.copy_from_slice(&values[run.to as usize..][..run.count as usize]);
            }
        }
        rayon::join(|| self.down(lower, lower_values), || self.down(upper, upper_values));
    }
}

#[inline(always)]
fn product<'a>(plan: &'a Plan, factor: &'a Factor, step: &Step) -> Product<'a> {
    Product {
        inverse: &factor.inverse[step.inverse.clone()],
        below: &factor.below[step.below.clone()],
        places: &plan.rows[step.rows.clone()],
    }
}

/// The fronts of one task, one after the other.
struct Pass<'a, const UP: bool> {
    sweep: Sweep<'a>,
    task: &'a Task,
    values: &'a mut [Row],
}

impl<const UP: bool> WithSimd for Pass<'_, UP> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::F32_LANES {
            LANES => self.run::<S, 1>(simd),
            4 => self.run::<S, { LANES / 4 }>(simd),
            _ => self.run::<Scalar, LANES>(Scalar::new()),
        }
    }
}

impl<const UP: bool> Pass<'_, UP> {
    #[inline(always)]
    fn run<S: Simd, const VECTORS: usize>(self, simd: S) {
        let Self { sweep: Sweep { plan, factor, .. }, task, values } = self;
        let mut scratch = SCRATCH.take();
        let [own, below] = task.panels;
        if scratch.solved.len() < own * ROWS / QUAD {
            scratch.solved.resize(own * ROWS / QUAD, Default::default());
        }
        if scratch.values.len() < below {
            scratch.values.resize(below, Default::default());
        }
        let steps = &plan.steps[task.steps.clone()];
        if UP {
            for step in steps {
                let (own, rest) = values.split_at_mut(step.own.end);
                let own = &mut own[step.own.start..];
                dense::up::<S, VECTORS>(simd, product(plan, factor, step), own, rest, &mut scratch);
            }
        } else {
            for step in steps.iter().rev() {
                let (own, rest) = values.split_at_mut(step.own.end);
                let own = &mut own[step.own.start..];
                dense::down::<S, VECTORS>(
                    simd,
                    product(plan, factor, step),
                    own,
                    rest,
                    &mut scratch,
                );
            }
        }
        SCRATCH.set(scratch);
    }
}
