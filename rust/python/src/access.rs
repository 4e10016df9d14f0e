//! What is inside a `Simulation`: its assembly while it is whole, cloths and colliders by the numbers that Python gives.

use boucle_geometry::Vector;
use boucle_scene::{Assembly, Error};
use boucle_solver::{Cloth, Collider};
use pyo3::prelude::*;

use crate::boundary::{compute, raise_internal, refuse};
use crate::buffers;
use crate::simulation::Simulation;

impl Simulation {
    /// Runs work on the simulation with the interpreter released; a panic breaks the simulation for good.
    pub(crate) fn with<T: Send>(
        &mut self,
        py: Python<'_>,
        work: impl Send + FnOnce(&mut Assembly) -> Result<T, Error>,
    ) -> PyResult<T> {
        let mut taken = self.assembly.take();
        let Some(assembly) = taken.as_mut() else { return Err(broken(py)) };
        let mut returned = false;
        let outcome = compute(py, || {
            let outcome = work(assembly);
            returned = true;
            outcome
        });
        if returned {
            self.assembly = taken;
        }
        outcome
    }

    /// Fills `out` with a number for each vertex of a cloth as it was given: of what is torn, for the piece that keeps its number.
    pub(crate) fn read_numbers(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        out: &Bound<'_, PyAny>,
        of: fn(&boucle_solver::Simulation, usize) -> Vec<f32>,
    ) -> PyResult<()> {
        let (index, given) = self.cloth(py, cloth)?;
        let count = given.positions.len();
        let mut numbers = self.with(py, |assembly| Ok(of(&assembly.simulation, index)))?;
        numbers.truncate(count);
        buffers::write_numbers(out, &numbers, "float32")
    }

    /// Fills `out` with a vector for each vertex of a cloth as it was given.
    pub(crate) fn read_vectors(
        &mut self,
        py: Python<'_>,
        cloth: i64,
        out: &Bound<'_, PyAny>,
        of: fn(&boucle_solver::Simulation, usize) -> Vec<Vector>,
    ) -> PyResult<()> {
        let (index, given) = self.cloth(py, cloth)?;
        let count = given.positions.len();
        let mut rows = self.with(py, |assembly| Ok(of(&assembly.simulation, index)))?;
        rows.truncate(count);
        buffers::write_rows(out, &rows)
    }

    pub(crate) fn assembly(&self, py: Python<'_>) -> PyResult<&Assembly> {
        self.assembly.as_ref().ok_or_else(|| broken(py))
    }

    /// The collider of a number that Python gave.
    pub(crate) fn collider(&self, py: Python<'_>, collider: i64) -> PyResult<(usize, &Collider)> {
        let simulation = &self.assembly(py)?.simulation;
        let count = simulation.collider_count();
        match usize::try_from(collider) {
            Ok(index) if index < count => Ok((index, simulation.collider(index))),
            _ => {
                let accepted = match count {
                    0 => "none, as there are no colliders".to_owned(),
                    _ => format!("0 to {}", count - 1),
                };
                Err(refuse(py, format!("collider = {collider}; accepted: {accepted}")))
            }
        }
    }

    /// The cloth of a number that Python gave, as it was given: whole.
    pub(crate) fn cloth(&self, py: Python<'_>, cloth: i64) -> PyResult<(usize, &Cloth)> {
        let simulation = &self.assembly(py)?.simulation;
        match usize::try_from(cloth) {
            Ok(index) if index < simulation.cloth_count() => Ok((index, simulation.given(index))),
            _ => {
                let accepted = format!("0 to {}", simulation.cloth_count().saturating_sub(1));
                Err(refuse(py, format!("cloth = {cloth}; accepted: {accepted}")))
            }
        }
    }
}

fn broken(py: Python<'_>) -> PyErr {
    let message = "the simulation was broken by an earlier fault of Boucle's own; make a new one";
    raise_internal(py, message)
}
