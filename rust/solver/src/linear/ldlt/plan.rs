//! What a solve does in which order: subtrees that are one task, and where their values are.
//!
//! A task is a whole subtree of little work, or one front of those above. Its values are those of its own places, then
//! those of the rows below its last front, which it passes up and later gets back, then one that takes what padding
//! brings. Tasks follow from the fronts alone, so the order of all sums does not depend on the number of threads.

use std::ops::Range;

use super::super::fronts::Front;
use super::panel::{ROWS, panel_count};
use super::symbolic::{Stored, Symbolic};

/// A subtree in which a solve reads fewer vectors is one task.
const TASK: usize = 5_000;

/// One front of a task.
#[derive(Clone, Debug)]
pub(super) struct Step {
    /// Among the values of the task.
    pub(super) own: Range<usize>,
    /// Vectors of S⁻¹ in the factor.
    pub(super) inverse: Range<usize>,
    /// Those of W.
    pub(super) below: Range<usize>,
    /// Rows below, by panels, in [`Plan::rows`].
    pub(super) rows: Range<usize>,
}

#[derive(Clone, Debug)]
pub(super) struct Task {
    pub(super) steps: Range<usize>,
    /// Its own places.
    pub(super) places: Range<usize>,
    /// Its values among those of all tasks.
    pub(super) values: Range<usize>,
    /// The values of its whole subtree begin here.
    pub(super) first_value: usize,
    pub(super) children: Option<[usize; 2]>,
    /// Its last front.
    pub(super) root: usize,
    /// Panels of its largest front, own and below.
    pub(super) panels: [usize; 2],
}

/// All tasks, children before parents.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    pub(super) tasks: Vec<Task>,
    pub(super) steps: Vec<Step>,
    /// Where rows below are among the values that follow the front's own; padding goes to the last value of a task.
    pub(super) rows: Vec<[u32; ROWS]>,
    /// Where the value of each particle is.
    pub(super) value_of: Vec<u32>,
    pub(super) value_count: usize,
}

impl Plan {
    pub(super) fn new(symbolic: &Symbolic) -> Self {
        let mut plan = Self { value_of: vec![0; symbolic.fronts.order.len()], ..Self::default() };
        let mut work: Vec<usize> = Vec::with_capacity(symbolic.stored.len());
        for (front, stored) in symbolic.fronts.all.iter().zip(&symbolic.stored) {
            let children = front.block.children.into_iter().flatten();
            let below: usize = children.map(|child| work[child as usize]).sum();
            work.push(stored.work() + below);
        }
        if let Some(root) = symbolic.stored.len().checked_sub(1) {
            plan.add_subtree(symbolic, &work, root);
        }
        plan
    }

    /// Returns the number of the last task of a subtree.
    fn add_subtree(&mut self, symbolic: &Symbolic, work: &[usize], root: usize) -> usize {
        let front = &symbolic.fronts.all[root];
        let first_value = self.value_count;
        let (children, fronts, places) = match front.block.children {
            Some(children) if work[root] >= TASK => {
                let children =
                    children.map(|child| self.add_subtree(symbolic, work, child as usize));
                (Some(children), root..root + 1, front.own_places())
            }
            _ => (None, front.block.first_block as usize..root + 1, front.places()),
        };
        let values = self.value_count..self.value_count + places.len() + front.rows.len() + 1;
        self.value_count = values.end;
        for place in places.clone() {
            let value = values.start + place - places.start;
            self.value_of[symbolic.fronts.order[place] as usize] = value as u32;
        }
        let first_step = self.steps.len();
        let mut panels = [0; 2];
        for (step, stored) in
            symbolic.fronts.all[fronts.clone()].iter().zip(&symbolic.stored[fronts])
        {
            let counts = [step.own_count(), step.rows.len()].map(panel_count);
            panels = std::array::from_fn(|i| panels[i].max(counts[i]));
            if step.own_count() > 0 {
                self.add_step((step, stored), &places, front, values.len());
            }
        }
        let steps = first_step..self.steps.len();
        self.tasks.push(Task { steps, places, values, first_value, children, root, panels });
        self.tasks.len() - 1
    }

    fn add_step(
        &mut self,
        (front, stored): (&Front, &Stored),
        places: &Range<usize>,
        root: &Front,
        values: usize,
    ) {
        let own_places = front.own_places();
        let own = own_places.start - places.start..own_places.end - places.start;
        let first_rows = self.rows.len();
        for rows in front.rows.chunks(ROWS) {
            let mut panel = [(values - 1 - own.end) as u32; ROWS];
            for (to, &row) in panel.iter_mut().zip(rows) {
                let value = if (row as usize) < places.end {
                    row as usize - places.start
                } else {
                    places.len() + root.rows.partition_point(|&below| below < row)
                };
                *to = (value - own.end) as u32;
            }
            self.rows.push(panel);
        }
        self.steps.push(Step {
            own,
            inverse: stored.inverse.clone(),
            below: stored.below.clone(),
            rows: first_rows..self.rows.len(),
        });
    }
}
