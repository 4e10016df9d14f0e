//! The function `bake`.

use std::ops::ControlFlow;
use std::path::PathBuf;

use boucle_scene::bake::{Progress, Request};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::boundary::thread_count;
use crate::boundary::{compute, parse_json, refuse};

/// Bakes a scene file into a folder and returns the report.
#[pyfunction]
#[pyo3(signature = (
    scene, out, *, frames = None, threads = 0, overrides = Vec::new(), resume = false, progress = None
))]
#[expect(clippy::too_many_arguments, reason = "the keyword arguments of Python's function")]
pub(crate) fn bake<'py>(
    py: Python<'py>,
    scene: PathBuf,
    out: PathBuf,
    frames: Option<(i64, i64)>,
    threads: i64,
    overrides: Vec<String>,
    resume: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let frames = frames.map(|range| frame_range(py, range)).transpose()?;
    let threads = thread_count(py, threads)?;
    let request = Request { scene, out, frames, threads, overrides, resume };
    let progress = progress.map(|callable| callable.clone().unbind());
    let mut raised = None;
    let outcome = compute(py, || {
        boucle_scene::bake::bake(&request, &mut |step| match tell(progress.as_ref(), step) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                raised = Some(error);
                ControlFlow::Break(())
            }
        })
    });
    let (_, report) = outcome?;
    match raised {
        Some(error) => Err(error),
        None => parse_json(py, &report.to_json()),
    }
}

/// Tells Python how far the bake is, and lets Ctrl-C through.
fn tell(progress: Option<&Py<PyAny>>, step: &Progress) -> PyResult<()> {
    Python::attach(|py| {
        py.check_signals()?;
        let Some(progress) = progress else { return Ok(()) };
        let told = PyDict::new(py);
        told.set_item("frame", step.frame)?;
        told.set_item("first", step.first)?;
        told.set_item("last", step.last)?;
        told.set_item("seconds", step.seconds)?;
        progress.call1(py, (told,)).map(drop)
    })
}

fn frame_range(py: Python<'_>, (from, to): (i64, i64)) -> PyResult<[i32; 2]> {
    match (i32::try_from(from), i32::try_from(to)) {
        (Ok(from), Ok(to)) => Ok([from, to]),
        _ => Err(refuse(py, format!("frames = {from}:{to}; accepted: frames of the scene"))),
    }
}
