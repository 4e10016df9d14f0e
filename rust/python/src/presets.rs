//! The function `fabric_presets`.

use pyo3::prelude::*;

use crate::simulation::parse_json;

/// All named fabrics, by name.
#[pyfunction]
pub(crate) fn fabric_presets(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    parse_json(py, &boucle_scene::fabric_presets_json())
}
