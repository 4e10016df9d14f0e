//! A fault on purpose, for tests of the boundary.

use pyo3::prelude::*;

use crate::boundary::compute;
use crate::simulation::Simulation;

/// Panics inside the boundary, on a simulation if one is given.
#[pyfunction]
#[pyo3(name = "_panic_for_tests", signature = (simulation = None))]
pub(crate) fn panic_for_tests(
    py: Python<'_>,
    simulation: Option<PyRefMut<'_, Simulation>>,
) -> PyResult<()> {
    match simulation {
        Some(mut simulation) => simulation.with(py, |_| panic!("asked to panic\nby a test")),
        None => compute(py, || panic!("asked to panic\nby a test")),
    }
}
