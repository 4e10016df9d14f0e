//! The function `run_batch`.

use std::ops::ControlFlow;
use std::path::PathBuf;

use boucle_scene::batch::{self, Progress, Request};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::boundary::thread_count;
use crate::boundary::{compute, parse_json};

/// Runs many scenes and returns a row of each.
#[pyfunction]
#[pyo3(signature = (scenes, *, folder = None, threads = 0, progress = None))]
pub(crate) fn run_batch<'py>(
    py: Python<'py>,
    scenes: Vec<String>,
    folder: Option<PathBuf>,
    threads: i64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let threads = thread_count(py, threads)?;
    let request = Request { scenes, folder: folder.unwrap_or_default(), threads };
    let progress = progress.map(|callable| callable.clone().unbind());
    let mut raised = None;
    let rows = compute(py, || {
        let rows = batch::run(&request, &mut |step| match tell(progress.as_ref(), step) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                raised = Some(error);
                ControlFlow::Break(())
            }
        });
        rows.map(|rows| batch::to_json(&rows))
    })?;
    match raised {
        Some(error) => Err(error),
        None => parse_json(py, &rows),
    }
}

/// Tells Python how far the batch is, and lets Ctrl-C through.
fn tell(progress: Option<&Py<PyAny>>, step: &Progress) -> PyResult<()> {
    Python::attach(|py| {
        py.check_signals()?;
        let Some(progress) = progress else { return Ok(()) };
        let told = PyDict::new(py);
        told.set_item("done", step.done)?;
        told.set_item("total", step.total)?;
        told.set_item("seconds", step.seconds)?;
        progress.call1(py, (told,)).map(drop)
    })
}
