//! Arrays in and out by the buffer protocol: numpy arrays, `array.array`, memoryviews.
//!
//! Numbers in are copied while the interpreter is held, so that no other thread changes them under a computation.

use boucle_geometry::Vector;
use boucle_scene::limits::{MAX_LENGTH, MAX_VERTICES};
use pyo3::buffer::{Element, PyBuffer, PyUntypedBuffer};
use pyo3::exceptions::PyBufferError;
use pyo3::prelude::*;

use crate::boundary::refuse;

/// Positions (m) out of a float32 or float64 buffer of shape (n, 3), or flat with 3 n numbers.
pub(crate) fn positions(
    array: &Bound<'_, PyAny>,
    what: &str,
    count: Option<usize>,
) -> PyResult<Vec<Vector>> {
    let py = array.py();
    let buffer = contiguous(array, what)?;
    let vertex_count = rows_of(py, 3, &buffer, what, count)?;
    if vertex_count > MAX_VERTICES {
        let accepted = format!("at most {MAX_VERTICES}");
        return Err(refuse(
            py,
            format!("{what} holds {vertex_count} vertices; accepted: {accepted}"),
        ));
    }
    let numbers = floats(py, &buffer, what)?;
    Ok(numbers.chunks_exact(3).map(Vector::from_column_slice).collect())
}

/// So many UV coordinates out of a float32 or float64 buffer of shape (n, 2), or flat with 2 n numbers.
pub(crate) fn uvs(array: &Bound<'_, PyAny>, what: &str, count: usize) -> PyResult<Vec<[f64; 2]>> {
    let py = array.py();
    let buffer = contiguous(array, what)?;
    rows_of(py, 2, &buffer, what, Some(count))?;
    let numbers = floats(py, &buffer, what)?;
    if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
        return Err(refuse(py, format!("{what} hold {number}; accepted: finite numbers")));
    }
    Ok(numbers.chunks_exact(2).map(|uv| [uv[0], uv[1]]).collect())
}

/// So many numbers out of a float32 or float64 buffer of shape (n,).
pub(crate) fn numbers(array: &Bound<'_, PyAny>, what: &str, count: usize) -> PyResult<Vec<f64>> {
    let py = array.py();
    let buffer = contiguous(array, what)?;
    if buffer.item_count() != count || buffer.dimensions() != 1 {
        return Err(wrong_shape(py, &buffer, what, &format!("({count},)")));
    }
    floats(py, &buffer, what)
}

/// Groups of N points (m) out of a float32 or float64 buffer of shape (n, N, 3).
pub(crate) fn point_groups<const N: usize>(
    array: &Bound<'_, PyAny>,
    what: &str,
) -> PyResult<Vec<[Vector; N]>> {
    let py = array.py();
    let buffer = contiguous(array, what)?;
    if !matches!(*buffer.shape(), [_, points, 3] if points == N) {
        return Err(wrong_shape(py, &buffer, what, &format!("(n, {N}, 3)")));
    }
    let numbers = floats(py, &buffer, what)?;
    if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
        return Err(refuse(py, format!("{what} holds {number}; accepted: finite numbers")));
    }
    let group = |numbers: &[f64]| {
        std::array::from_fn(|point| Vector::from_column_slice(&numbers[3 * point..3 * point + 3]))
    };
    Ok(numbers.chunks_exact(3 * N).map(group).collect())
}

/// Refuses positions that are not finite or far beyond any scene, out of those at `vertices`.
pub(crate) fn check_finite(
    py: Python<'_>,
    positions: &[Vector],
    vertices: impl Iterator<Item = usize>,
    what: &str,
) -> PyResult<()> {
    let is_bad = |vertex: &usize| !positions[*vertex].iter().all(|x| x.abs() <= MAX_LENGTH);
    match vertices.into_iter().find(is_bad) {
        Some(vertex) => {
            let [x, y, z] = positions[vertex].into();
            let accepted = format!("numbers of at most {MAX_LENGTH:e} m");
            let shown = format!("({x:?}, {y:?}, {z:?})");
            Err(refuse(py, format!("{what} of vertex {vertex} is {shown}; accepted: {accepted}")))
        }
        None => Ok(()),
    }
}

/// The vertices of numbers that Python gave.
pub(crate) fn vertices(py: Python<'_>, numbers: Vec<i64>, count: usize) -> PyResult<Vec<u32>> {
    let vertex = |number: i64| match u32::try_from(number) {
        Ok(vertex) if (vertex as usize) < count => Ok(vertex),
        _ => {
            let accepted = format!("0 to {}", count.saturating_sub(1));
            Err(refuse(py, format!("vertices holds {number}; accepted: {accepted}")))
        }
    };
    numbers.into_iter().map(vertex).collect()
}

/// Whole numbers from 0 to below 2^32 out of a buffer of 4- or 8-byte integers.
pub(crate) fn indices(array: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<u32>> {
    let py = array.py();
    let buffer = contiguous(array, what)?;
    if let Some(values) = read::<i32>(py, &buffer)? {
        return narrow(py, &values, what);
    }
    if let Some(values) = read::<i64>(py, &buffer)? {
        return narrow(py, &values, what);
    }
    if let Some(values) = read::<u32>(py, &buffer)? {
        return Ok(values);
    }
    if let Some(values) = read::<u64>(py, &buffer)? {
        return narrow(py, &values, what);
    }
    Err(wrong_numbers(py, &buffer, what, "int32"))
}

/// Fills a float32 or float64 buffer of shape (n, 3), or flat with 3 n numbers.
pub(crate) fn write_rows(array: &Bound<'_, PyAny>, rows: &[Vector]) -> PyResult<()> {
    let py = array.py();
    let buffer = contiguous(array, "out")?;
    rows_of(py, 3, &buffer, "out", Some(rows.len()))?;
    let numbers = rows.iter().flat_map(|row| [row.x, row.y, row.z]);
    if let Ok(buffer) = buffer.as_typed::<f32>() {
        return fill(py, buffer, numbers.map(|number| number as f32));
    }
    match buffer.as_typed::<f64>() {
        Ok(buffer) => fill(py, buffer, numbers),
        Err(_) => Err(wrong_numbers(py, &buffer, "out", "float32 or float64")),
    }
}

/// Fills a buffer of shape (n,) whose numbers are of the type that Python calls `kind`.
pub(crate) fn write_numbers<T: Element>(
    array: &Bound<'_, PyAny>,
    numbers: &[T],
    kind: &str,
) -> PyResult<()> {
    let py = array.py();
    let buffer = contiguous(array, "out")?;
    if buffer.item_count() != numbers.len() || buffer.dimensions() != 1 {
        return Err(wrong_shape(py, &buffer, "out", &format!("({},)", numbers.len())));
    }
    match buffer.as_typed::<T>() {
        Ok(buffer) => fill(py, buffer, numbers.iter().copied()),
        Err(_) => Err(wrong_numbers(py, &buffer, "out", kind)),
    }
}

fn contiguous(array: &Bound<'_, PyAny>, what: &str) -> PyResult<PyUntypedBuffer> {
    let py = array.py();
    let buffer = PyUntypedBuffer::get(array).map_err(|error| {
        if error.is_instance_of::<PyBufferError>(py) {
            return refuse(py, format!("{what} cannot be read: {error}; accepted: plain arrays"));
        }
        error
    })?;
    if !buffer.is_c_contiguous() {
        let accepted = "accepted: C-contiguous arrays";
        return Err(refuse(py, format!("{what} is not C-contiguous; {accepted}")));
    }
    // PyO3 looks at the type alone, and would take another machine's byte order for ours.
    let foreign: &[u8] = if cfg!(target_endian = "little") { b">!" } else { b"<" };
    if buffer.format().to_bytes().first().is_some_and(|order| foreign.contains(order)) {
        return Err(wrong_numbers(py, &buffer, what, "this machine's byte order"));
    }
    Ok(buffer)
}

/// How many rows of so many numbers a buffer holds.
fn rows_of(
    py: Python<'_>,
    width: usize,
    buffer: &PyUntypedBuffer,
    what: &str,
    count: Option<usize>,
) -> PyResult<usize> {
    let rows = match *buffer.shape() {
        [rows, numbers] if numbers == width => Some(rows),
        [numbers] if numbers % width == 0 => Some(numbers / width),
        _ => None,
    };
    match (rows, count) {
        (Some(rows), None) => Ok(rows),
        (Some(rows), Some(count)) if rows == count => Ok(rows),
        (_, count) => {
            let n = count.map_or("n".to_owned(), |count| count.to_string());
            Err(wrong_shape(py, buffer, what, &format!("({n}, {width}), or flat")))
        }
    }
}

fn floats(py: Python<'_>, buffer: &PyUntypedBuffer, what: &str) -> PyResult<Vec<f64>> {
    if let Some(values) = read::<f32>(py, buffer)? {
        return Ok(values.into_iter().map(f64::from).collect());
    }
    match read::<f64>(py, buffer)? {
        Some(values) => Ok(values),
        None => Err(wrong_numbers(py, buffer, what, "float32 or float64")),
    }
}

/// The numbers of a buffer, if they are of this type.
fn read<T: Element>(py: Python<'_>, buffer: &PyUntypedBuffer) -> PyResult<Option<Vec<T>>> {
    // An empty buffer points nowhere, which PyO3 takes for numbers of another type.
    if buffer.item_count() == 0 {
        return Ok(Some(Vec::new()));
    }
    match buffer.as_typed::<T>() {
        Ok(buffer) => buffer.to_vec(py).map(Some),
        Err(_) => Ok(None),
    }
}

fn narrow<T: Copy + TryInto<u32> + std::fmt::Display>(
    py: Python<'_>,
    values: &[T],
    what: &str,
) -> PyResult<Vec<u32>> {
    let number = |value: &T| {
        (*value).try_into().map_err(|_| {
            refuse(py, format!("{what} holds {value}; accepted: whole numbers from 0"))
        })
    };
    values.iter().map(number).collect()
}

fn fill<T: Element>(
    py: Python<'_>,
    buffer: &PyBuffer<T>,
    numbers: impl Iterator<Item = T>,
) -> PyResult<()> {
    if buffer.readonly() {
        return Err(refuse(py, "out is read-only; accepted: arrays that can be written"));
    }
    buffer.copy_from_slice(py, &numbers.collect::<Vec<T>>())
}

fn wrong_shape(py: Python<'_>, buffer: &PyUntypedBuffer, what: &str, accepted: &str) -> PyErr {
    refuse(py, format!("{what} has the shape {:?}; accepted: {accepted}", buffer.shape()))
}

fn wrong_numbers(py: Python<'_>, buffer: &PyUntypedBuffer, what: &str, accepted: &str) -> PyErr {
    let format = buffer.format().to_string_lossy();
    refuse(py, format!("{what} holds numbers of format \"{format}\"; accepted: {accepted}"))
}
