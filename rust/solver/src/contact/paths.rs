//! Straight ways of all points over a step: where they start, and how far they go.

use boucle_geometry::Vector;

use crate::state::Coordinates;

/// The ways of all points.
#[derive(Clone, Debug)]
pub(super) struct Paths {
    /// m.
    pub(super) start: Vec<Vector>,
    /// m.
    pub(super) step: Vec<Vector>,
    /// Which points can go another way: neither pinned nor a collider's.
    is_free: Vec<bool>,
}

impl Paths {
    pub(super) fn at_rest(points: &[Vector]) -> Self {
        let (start, step) = (points.to_vec(), vec![Vector::zeros(); points.len()]);
        Self { start, step, is_free: vec![false; points.len()] }
    }

    /// Takes over which particles are pinned.
    pub(super) fn follow_pins(&mut self, inverse_masses: &[f64]) {
        for (is_free, inverse) in self.is_free.iter_mut().zip(inverse_masses) {
            *is_free = *inverse > 0.0;
        }
    }

    #[inline]
    pub(super) fn is_free(&self, point: u32) -> bool {
        self.is_free[point as usize]
    }

    /// Where a point ends (m).
    #[inline]
    pub(super) fn end(&self, point: u32) -> Vector {
        self.start[point as usize] + self.step[point as usize]
    }

    /// Starts particles at these positions (m).
    pub(super) fn set_starts(&mut self, positions: &Coordinates) {
        let [x, y, z] = positions.0.each_ref();
        for (((start, x), y), z) in self.start.iter_mut().zip(x.iter()).zip(y.iter()).zip(z.iter())
        {
            *start = Vector::new(*x, *y, *z);
        }
    }

    /// Sends particles to these positions (m).
    pub(super) fn set_ends(&mut self, positions: &Coordinates) {
        let [x, y, z] = positions.0.each_ref();
        let points = self.step.iter_mut().zip(&self.start);
        for ((((step, start), x), y), z) in points.zip(x.iter()).zip(y.iter()).zip(z.iter()) {
            *step = Vector::new(*x, *y, *z) - start;
        }
    }
}
