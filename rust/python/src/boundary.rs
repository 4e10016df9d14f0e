//! The one place where errors, panics and threads meet the interpreter.
//!
//! [`compute`] lets the interpreter go, runs the work, and turns its refusal or its panic into an exception.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

use boucle_scene::{Error, Result};
use pyo3::exceptions::{PyArithmeticError, PyException, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple, PyType};

/// The exceptions of the module.
struct Exceptions {
    scene: Py<PyType>,
    diverged: Py<PyType>,
    unstable: Py<PyType>,
    cache: Py<PyType>,
    interrupted: Py<PyType>,
    internal: Py<PyType>,
}

static EXCEPTIONS: PyOnceLock<Exceptions> = PyOnceLock::new();

/// Where the last panic happened.
static PANIC_PLACE: Mutex<Option<String>> = Mutex::new(None);

/// Runs work with the interpreter released.
pub(crate) fn compute<T: Send>(
    py: Python<'_>,
    work: impl Send + FnOnce() -> Result<T>,
) -> PyResult<T> {
    match py.detach(|| catch_unwind(AssertUnwindSafe(work))) {
        Ok(outcome) => outcome.map_err(|error| raise(py, &error)),
        Err(panic) => Err(raise_internal(py, &panic_message(panic.as_ref()))),
    }
}

/// The exception that tells a refusal.
pub(crate) fn raise(py: Python<'_>, error: &Error) -> PyErr {
    let Some(exceptions) = EXCEPTIONS.get(py) else {
        return PyRuntimeError::new_err(error.to_string());
    };
    let kind = match error {
        Error::Diverged { .. } => &exceptions.diverged,
        Error::Unstable { .. } => &exceptions.unstable,
        Error::Cache(_) => &exceptions.cache,
        Error::Interrupted { .. } => &exceptions.interrupted,
        _ => &exceptions.scene,
    };
    let exception = PyErr::from_type(kind.bind(py).clone(), error.to_string());
    let value = exception.value(py);
    let told = match error {
        Error::Diverged { frame, vertex, .. } => {
            value.setattr("frame", frame).and_then(|()| value.setattr("vertex", vertex))
        }
        Error::Unstable { frame, .. } | Error::Interrupted { frame } => {
            value.setattr("frame", frame)
        }
        _ => Ok(()),
    };
    told.err().unwrap_or(exception)
}

/// The exception that tells a fault of our own.
pub(crate) fn raise_internal(py: Python<'_>, message: &str) -> PyErr {
    match EXCEPTIONS.get(py) {
        Some(exceptions) => {
            PyErr::from_type(exceptions.internal.bind(py).clone(), message.to_owned())
        }
        None => PyRuntimeError::new_err(message.to_owned()),
    }
}

/// JSON as Python objects.
pub(crate) fn parse_json<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (text,))
}

/// A refusal of an argument.
pub(crate) fn refuse(py: Python<'_>, message: impl Into<String>) -> PyErr {
    raise(py, &Error::Input(message.into()))
}

/// Makes the exceptions: each is a `BoucleError` and one of Python's own.
pub(crate) fn add_exceptions(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let doc = "Anything that this module refuses or reports. The message is one sentence.";
    let base = exception(module, "BoucleError", &[py.get_type::<PyException>()], doc)?;
    let add = |name, own: Bound<'_, PyType>, doc| {
        exception(module, name, &[base.clone(), own], doc).map(Bound::unbind)
    };
    let exceptions = Exceptions {
        scene: add(
            "SceneError",
            py.get_type::<PyValueError>(),
            "The input is wrong: names the key or object, the value and what would be accepted.",
        )?,
        diverged: add(
            "DivergedError",
            py.get_type::<PyArithmeticError>(),
            "A position left the finite numbers: \"diverged at frame F, vertex V of cloth NAME\". \
             Earlier frames are kept.",
        )?,
        unstable: add(
            "UnstableError",
            py.get_type::<PyArithmeticError>(),
            "From this frame on the settings would not stay stable. Earlier frames are kept.",
        )?,
        cache: add(
            "CacheError",
            py.get_type::<PyOSError>(),
            "A result cannot be written or read (disk full, no permission). Earlier frames are kept.",
        )?,
        interrupted: add(
            "InterruptionError",
            py.get_type::<PyRuntimeError>(),
            "A frame was stopped by an Interrupter: the state is that of the frame before it.",
        )?,
        internal: add(
            "InternalError",
            py.get_type::<PyRuntimeError>(),
            "A fault of our own: a Rust panic, caught. The simulation must be thrown away.",
        )?,
    };
    EXCEPTIONS.get_or_init(py, || exceptions);
    Ok(())
}

fn exception<'py>(
    module: &Bound<'py, PyModule>,
    name: &str,
    bases: &[Bound<'py, PyType>],
    doc: &str,
) -> PyResult<Bound<'py, PyType>> {
    let py = module.py();
    let members = PyDict::new(py);
    members.set_item("__module__", "boucle_core")?;
    members.set_item("__doc__", doc)?;
    let made = py.get_type::<PyType>().call1((name, PyTuple::new(py, bases)?, members))?;
    module.add(name, &made)?;
    Ok(made.cast_into()?)
}

/// Keeps panics off standard error: they become exceptions, which tell where they happened.
pub(crate) fn keep_panics_quiet() {
    std::panic::set_hook(Box::new(|panic| {
        if let Ok(mut place) = PANIC_PLACE.lock() {
            *place = panic.location().map(ToString::to_string);
        }
    }));
}

/// One line about a panic.
fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    let place = PANIC_PLACE.lock().ok().and_then(|mut place| place.take());
    let line = format!(
        "a fault of Boucle's own at {}: {}; please report it",
        place.as_deref().unwrap_or("an unknown place"),
        text.unwrap_or("no message")
    );
    line.replace(['\n', '\r'], " ")
}

/// The number of threads that Python gave.
pub(crate) fn thread_count(py: Python<'_>, threads: i64) -> PyResult<usize> {
    let refused = || refuse(py, format!("threads = {threads}; accepted: 1 to 1024, or 0"));
    let count = usize::try_from(threads).map_err(|_| refused())?;
    boucle_scene::limits::threads(count).map_err(|error| raise(py, &error))?;
    Ok(count)
}
