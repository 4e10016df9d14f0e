//! How shrink and pressure of a cloth change by its description, from frame to frame.

use boucle_geometry::Vector;
use boucle_solver::Simulation;

use crate::description::{ClothDescription, PressureDescription, Shrink};
use crate::error::{Error, Result};

/// What changes the shape of one cloth.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShapeTrack {
    shrink: Shrink,
    pressure: Option<PressureDescription>,
    count: usize,
}

impl ShapeTrack {
    /// Of a cloth of so many vertices; `at` is its key.
    pub(crate) fn new(description: &ClothDescription, count: usize, at: &str) -> Result<Self> {
        let shrink = description.shrink.clone().unwrap_or_default();
        let pressure = description.pressure.clone();
        let of_pressure = pressure.as_ref().map_or(0, |pressure| pressure.weights.len());
        for (key, given) in [("shrink", shrink.weights.len()), ("pressure", of_pressure)] {
            if given != 0 && given != count {
                let accepted = format!("{count}, one a vertex, or none");
                let key = format!("{at}.{key}.weights");
                return Err(Error::input(format!("{key} holds {given}; accepted: {accepted}")));
            }
        }
        Ok(Self { shrink, pressure, count })
    }

    /// Shrink of each vertex at a frame; empty where there is none.
    pub(crate) fn shrink(&self, frame: i32) -> Vec<f64> {
        match self.shrink.at(frame) {
            [min, max] if min == 0.0 && max == 0.0 => Vec::new(),
            both => self.shrink.of_vertices(both, self.count),
        }
    }

    /// Readies a cloth for the step to a frame, as far as keyframes change it.
    pub(crate) fn prepare(
        &self,
        simulation: &mut Simulation,
        cloth: usize,
        frame: i32,
    ) -> boucle_solver::Result<()> {
        if !self.shrink.keyframes.is_empty() {
            let shrink = self.shrink.of_vertices(self.shrink.at(frame), self.count);
            simulation.set_rest(cloth, None, Some(&shrink))?;
        }
        if let Some(pressure) = self.pressure.as_ref().filter(|each| !each.keyframes.is_empty()) {
            let [uniform, factor] = pressure.at(frame);
            simulation.set_pressure(cloth, uniform, factor, pressure.target_volume)?;
        }
        Ok(())
    }

    /// Sets the rest shape (m) of the next frame and its shrink, at vertices of weight 0 and 1.
    pub(crate) fn set_rest(
        &self,
        simulation: &mut Simulation,
        cloth: usize,
        shape: Option<&[Vector]>,
        shrink: Option<[f64; 2]>,
    ) -> boucle_solver::Result<()> {
        let shrink = shrink.map(|both| self.shrink.of_vertices(both, self.count));
        simulation.set_rest(cloth, shape, shrink.as_deref())
    }
}
