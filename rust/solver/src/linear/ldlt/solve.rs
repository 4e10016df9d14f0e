//! The two sweeps of a solve: up the tree of fronts, and down again.

use pulp::Arch;

use super::super::field::Field;
use super::dense::{Multiply, Partial, SubtractTransposed};
use super::factor::Factor;
use super::symbolic::{Front, Symbolic};

/// A subtree that stores fewer numbers is one task.
const TASK: usize = 40_000;

/// Vectors of all fronts, and the solution by place.
#[derive(Debug)]
pub(super) struct Workspace {
    vectors: Vec<f32>,
    solution: Field,
    /// Numbers stored in the subtree of each front.
    work: Vec<usize>,
}

impl Workspace {
    pub(super) fn new(symbolic: &Symbolic) -> Self {
        let mut work = Vec::with_capacity(symbolic.fronts.len());
        for front in &symbolic.fronts {
            let children = front.block.children.into_iter().flatten();
            let below: usize = children.map(|child| work[child as usize]).sum();
            work.push(front.number_count() + below);
        }
        Self {
            vectors: vec![0.0; symbolic.vector_count],
            solution: Field::zeros(symbolic.order.len()),
            work,
        }
    }

    pub(super) fn solve(
        &mut self,
        symbolic: &Symbolic,
        factor: &Factor,
        arch: Arch,
        r: &Field,
        z: &mut Field,
    ) {
        let Some(root) = symbolic.fronts.len().checked_sub(1) else { return };
        let sweep = Sweep { symbolic, factor, arch, work: &self.work };
        sweep.up(root, r, &mut self.vectors);
        let solution = self.solution.0.each_mut().map(Vec::as_mut_slice);
        sweep.down(root, None, &mut self.vectors, solution);
        for (z, solution) in z.0.iter_mut().zip(&self.solution.0) {
            for (z, &place) in z.iter_mut().zip(&symbolic.places) {
                *z = solution[place as usize];
            }
        }
    }
}

struct Sweep<'a> {
    symbolic: &'a Symbolic,
    factor: &'a Factor,
    arch: Arch,
    work: &'a [usize],
}

/// A subtree and its vectors.
type Part<'v> = (usize, &'v mut [f32]);

/// The three axes of a front's vector.
fn axes(vector: &[f32]) -> [&[f32]; 3] {
    let (x, rest) = vector.split_at(vector.len() / 3);
    let (y, z) = rest.split_at(rest.len() / 2);
    [x, y, z]
}

fn axes_mut(vector: &mut [f32]) -> [&mut [f32]; 3] {
    let (x, rest) = vector.split_at_mut(vector.len() / 3);
    let (y, z) = rest.split_at_mut(rest.len() / 2);
    [x, y, z]
}

/// Memory of the front being computed; fronts of a grid have at most some hundred particles of their own.
#[derive(Default)]
struct Scratch {
    own: [Vec<f32>; 3],
    partials: Vec<Partial>,
}

thread_local! {
    static SCRATCH: std::cell::Cell<Scratch> = std::cell::Cell::default();
}

impl Sweep<'_> {
    /// The vectors of a subtree, cut into those of its halves and its root's.
    fn cut<'v>(
        &self,
        front: &Front,
        vectors: &'v mut [f32],
    ) -> (Option<[Part<'v>; 2]>, &'v mut [f32]) {
        let (below, own) = vectors.split_at_mut(vectors.len() - front.vector_count());
        let halves = front.block.children.map(|[lower, upper]| {
            let middle = self.symbolic.fronts[upper as usize].first_vectors - front.first_vectors;
            let (lower_vectors, upper_vectors) = below.split_at_mut(middle);
            [(lower as usize, lower_vectors), (upper as usize, upper_vectors)]
        });
        (halves, own)
    }

    /// Fills the vectors of a subtree with `[y; W b]`.
    fn up(&self, root: usize, r: &Field, vectors: &mut [f32]) {
        let front = &self.symbolic.fronts[root];
        let (halves, vector) = self.cut(front, vectors);
        let mut children = [None, None];
        if let Some([(lower, lower_vectors), (upper, upper_vectors)]) = halves {
            if self.work[root] < TASK {
                self.up(lower, r, lower_vectors);
                self.up(upper, r, upper_vectors);
            } else {
                rayon::join(
                    || self.up(lower, r, lower_vectors),
                    || self.up(upper, r, upper_vectors),
                );
            }
            children = [(lower, lower_vectors), (upper, upper_vectors)].map(|(child, vectors)| {
                let child = &self.symbolic.fronts[child];
                Some((child, &vectors[vectors.len() - child.vector_count()..]))
            });
        }
        let mut scratch = SCRATCH.take();
        let own = &front.block.own;
        let particles = &self.symbolic.order[own.start as usize..own.end as usize];
        for (axis, own) in scratch.own.iter_mut().enumerate() {
            own.clear();
            own.extend(particles.iter().map(|&particle| r.0[axis][particle as usize]));
        }
        // What children pass to the rows below joins this front's own share there.
        let count = front.own_count();
        let matrix = &self.factor.numbers[front.numbers..][..front.number_count()];
        for (child, passed) in children.iter().flatten() {
            for (own, passed) in scratch.own.iter_mut().zip(axes(passed)) {
                let passed = &passed[child.own_count()..];
                for run in child.runs.iter().take_while(|run| (run.to as usize) < count) {
                    let taken = (run.count as usize).min(count - run.to as usize);
                    let from = &passed[run.from as usize..][..taken];
                    for (to, value) in own[run.to as usize..].iter_mut().zip(from) {
                        *to -= value;
                    }
                }
            }
        }
        let b = scratch.own.each_ref().map(Vec::as_slice);
        self.arch.dispatch(Multiply { matrix, rows: front.count(), b, out: axes_mut(vector) });
        for (child, passed) in children.iter().flatten() {
            for (vector, passed) in axes_mut(vector).into_iter().zip(axes(passed)) {
                let passed = &passed[child.own_count()..];
                for run in child.runs.iter().filter(|run| (run.to + run.count) as usize > count) {
                    let skipped = count.saturating_sub(run.to as usize);
                    let from = &passed[run.from as usize..][skipped..run.count as usize];
                    let to = &mut vector[run.to as usize + skipped..];
                    for (to, value) in to.iter_mut().zip(from) {
                        *to += value;
                    }
                }
            }
        }
        SCRATCH.set(scratch);
    }

    /// Fills the solution of a subtree, given `[x; x_front]` of its parent.
    fn down(
        &self,
        root: usize,
        parent: Option<&[f32]>,
        vectors: &mut [f32],
        solution: [&mut [f32]; 3],
    ) {
        let front = &self.symbolic.fronts[root];
        let count = front.own_count();
        let (halves, vector) = self.cut(front, vectors);
        let places_below = front.places().len() - count;
        let mut below = [&mut [][..], &mut [], &mut []];
        let mut own = [&mut [][..], &mut [], &mut []];
        for (axis, solution) in solution.into_iter().enumerate() {
            (below[axis], own[axis]) = solution.split_at_mut(places_below);
        }
        self.solve_own(front, parent, vector, own);
        let Some([(lower, lower_vectors), (upper, upper_vectors)]) = halves else { return };
        let places_lower = self.symbolic.fronts[lower].places().len();
        let mut of_lower = [&mut [][..], &mut [], &mut []];
        let mut of_upper = [&mut [][..], &mut [], &mut []];
        for (axis, below) in below.into_iter().enumerate() {
            (of_lower[axis], of_upper[axis]) = below.split_at_mut(places_lower);
        }
        let vector = &*vector;
        if self.work[root] < TASK {
            self.down(lower, Some(vector), lower_vectors, of_lower);
            self.down(upper, Some(vector), upper_vectors, of_upper);
        } else {
            rayon::join(
                || self.down(lower, Some(vector), lower_vectors, of_lower),
                || self.down(upper, Some(vector), upper_vectors, of_upper),
            );
        }
    }

    /// Replaces a front's vector `[y; ..]` by `[x; x_front]` and copies x.
    fn solve_own(
        &self,
        front: &Front,
        parent: Option<&[f32]>,
        vector: &mut [f32],
        mut own: [&mut [f32]; 3],
    ) {
        let count = front.own_count();
        for (axis, (vector, own)) in axes_mut(vector).into_iter().zip(&mut own).enumerate() {
            own.copy_from_slice(&vector[..count]);
            vector[..count].fill(0.0);
            let Some(parent) = parent else { continue };
            let parent = axes(parent)[axis];
            for run in &front.runs {
                let to = &mut vector[count + run.from as usize..][..run.count as usize];
                to.copy_from_slice(&parent[run.to as usize..][..run.count as usize]);
            }
        }
        let mut scratch = SCRATCH.take();
        let matrix = &self.factor.numbers[front.numbers..][..front.number_count()];
        self.arch.dispatch(SubtractTransposed {
            matrix,
            rows: count..front.count(),
            front: axes(vector),
            x: own.each_mut().map(|axis| &mut **axis),
            partials: &mut scratch.partials,
        });
        SCRATCH.set(scratch);
        for (vector, own) in axes_mut(vector).into_iter().zip(own) {
            vector[..count].copy_from_slice(own);
        }
    }
}
