//! The class `Interrupter`.

use pyo3::prelude::*;

/// Stops a simulation in the middle of a frame, from any thread.
#[pyclass(module = "boucle_core", frozen)]
pub(crate) struct Interrupter(pub(crate) boucle_solver::Interrupter);

#[pymethods]
impl Interrupter {
    fn interrupt(&self) {
        self.0.interrupt();
    }
}
