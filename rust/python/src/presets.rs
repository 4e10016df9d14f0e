//! The functions `fabric_presets` and `fabric_springs`.

use pyo3::prelude::*;

use crate::boundary::{parse_json, raise};

/// All named fabrics, by name.
#[pyfunction]
pub(crate) fn fabric_presets(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    parse_json(py, &boucle_scene::fabric_presets_json())
}

/// The springs of a named fabric.
#[pyfunction]
pub(crate) fn fabric_springs<'py>(
    py: Python<'py>,
    preset: &str,
    edge: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let springs = boucle_scene::fabric_springs_json(preset, edge);
    parse_json(py, &springs.map_err(|error| raise(py, &error))?)
}
