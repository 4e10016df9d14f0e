//! The paper's method once more, written as plainly as it is told: the fast solver's oracle.
//!
//! A grid of equal masses; every particle asks its twelve neighbours for their springs; wind by vertex normal on some
//! vertices; all forces first, then `v += h F/m`, `x += h v`.

use boucle_geometry::Vector;

use crate::sheets::grid_positions;

/// A square grid of n x n particles and all that acts on it.
pub(crate) struct Plain {
    pub(crate) n: u32,
    pub(crate) spacing: f64,
    /// Of stretch, shear and bend springs (N/m).
    pub(crate) stiffness: [f64; 3],
    pub(crate) mass: f64,
    pub(crate) air_damping: f64,
    pub(crate) gravity: Vector,
    pub(crate) wind_velocity: Vector,
    pub(crate) wind_coefficient: f64,
    pub(crate) is_blown: fn(u32, u32) -> bool,
    pub(crate) pins: Vec<u32>,
}

impl Plain {
    /// Positions after some steps of h seconds from rest in the plane z = 0.
    pub(crate) fn run(&self, h: f64, steps: u32) -> Vec<Vector> {
        let mut x = grid_positions(self.n, self.n, self.spacing);
        let mut v = vec![Vector::zeros(); x.len()];
        for _ in 0..steps {
            let forces: Vec<Vector> =
                (0..self.n * self.n).map(|i| self.force(i % self.n, i / self.n, &x, &v)).collect();
            for (i, force) in forces.iter().enumerate() {
                if !self.pins.contains(&(i as u32)) {
                    v[i] += force * (h / self.mass);
                    x[i] += v[i] * h;
                }
            }
        }
        x
    }

    /// The particle some steps to the right and up, if there is one.
    fn near(&self, column: u32, row: u32, [right, up]: [i32; 2]) -> Option<usize> {
        let (column, row) = (column.checked_add_signed(right)?, row.checked_add_signed(up)?);
        (column < self.n && row < self.n).then_some((row * self.n + column) as usize)
    }

    fn force(&self, column: u32, row: u32, x: &[Vector], v: &[Vector]) -> Vector {
        let i = (row * self.n + column) as usize;
        let mut force = self.gravity * self.mass - v[i] * self.air_damping;
        for (kind, steps) in
            [[(1, 0), (0, 1)], [(1, 1), (1, -1)], [(2, 0), (0, 2)]].iter().enumerate()
        {
            for (right, up) in steps.iter().flat_map(|&(a, b)| [(a, b), (-a, -b)]) {
                let Some(j) = self.near(column, row, [right, up]) else { continue };
                let rest_length = self.spacing * f64::from(right * right + up * up).sqrt();
                let span = x[i] - x[j];
                let length = span.norm();
                force += span * (self.stiffness[kind] * (rest_length - length) / length);
            }
        }
        if (self.is_blown)(column, row) {
            let n = self.normal(column, row, x);
            force += n * (self.wind_coefficient * (self.wind_velocity - v[i]).dot(&n));
        }
        force
    }

    /// The mean of the unit normals of the squares around a particle.
    fn normal(&self, column: u32, row: u32, x: &[Vector]) -> Vector {
        let mut sum = Vector::zeros();
        for [right, up] in [[-1, -1], [0, -1], [-1, 0], [0, 0]] {
            let corners = [[0, 0], [1, 0], [1, 1], [0, 1]]
                .map(|[a, b]| self.near(column, row, [right + a, up + b]));
            if let [Some(a), Some(b), Some(c), Some(d)] = corners {
                sum += (x[c] - x[a]).cross(&(x[d] - x[b])).normalize();
            }
        }
        sum.normalize()
    }
}
