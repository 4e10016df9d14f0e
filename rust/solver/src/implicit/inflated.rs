//! A matrix with that of volumes that resist as one: `sum_k c_k f_k f_kᵀ`, c = -dp/dV, f the areas on which p presses.

use std::ops::Range;

use crate::force::AirScratch;
use crate::linear::{Field, Operator};
use crate::system::System;

/// One volume.
struct Filling {
    particles: Range<usize>,
    /// (N/m⁵)
    slope: f64,
    /// (m²), 0 of pinned particles.
    areas: Vec<[f32; 3]>,
}

/// A matrix and all volumes, as they were last observed.
pub(super) struct Inflated<Matrix> {
    matrix: Matrix,
    fillings: Vec<Filling>,
}

impl<Matrix: Operator> Inflated<Matrix> {
    pub(super) fn new(matrix: Matrix, system: &System, air: &AirScratch) -> Self {
        let stiff = system.air.pressures.stiff(&air.pressure);
        let fillings = stiff.map(|(particles, slope, area)| {
            let areas = particles.clone().map(|particle| {
                let is_free = !system.is_pinned(particle);
                if is_free { area(particle).map(|x| x as f32).into() } else { [0.0; 3] }
            });
            Filling { areas: areas.collect(), particles, slope }
        });
        Self { fillings: fillings.collect(), matrix }
    }
}

impl<Matrix: Operator> Operator for Inflated<Matrix> {
    fn apply(&self, p: &Field, out: &mut Field) {
        self.matrix.apply(p, out);
        for Filling { particles, slope, areas } in &self.fillings {
            let [x, y, z] = p.0.each_ref().map(|axis| &axis[particles.clone()]);
            let moves = x.iter().zip(y).zip(z).zip(areas);
            let gain: f64 = moves
                .map(|(((x, y), z), [a, b, c])| {
                    f64::from(*x) * f64::from(*a)
                        + f64::from(*y) * f64::from(*b)
                        + f64::from(*z) * f64::from(*c)
                })
                .sum();
            let pressure = (slope * gain) as f32;
            for (axis, out) in out.0.iter_mut().enumerate() {
                for (out, area) in out[particles.clone()].iter_mut().zip(areas) {
                    *out += pressure * area[axis];
                }
            }
        }
    }
}
