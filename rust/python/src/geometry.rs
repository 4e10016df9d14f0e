//! Batches of geometric questions, for tests that ask others the same.

use boucle_geometry::distance::{Closest, edge_edge, point_triangle};
use boucle_geometry::{
    Meeting, Vector, edge_edge_impact as time_of_edges, edge_meets_triangle,
    point_triangle_impact as time_of_point,
};
use pyo3::prelude::*;

use crate::boundary::{compute, refuse};
use crate::buffers::{point_groups, write_numbers};

/// Distances (m) of points (first) and triangles.
#[pyfunction]
pub(crate) fn point_triangle_distance(
    points: &Bound<'_, PyAny>,
    out: &Bound<'_, PyAny>,
) -> PyResult<()> {
    write_distances(points, out, |[p, a, b, c]| point_triangle(p, a, b, c))
}

/// Distances (m) of pairs of edges.
#[pyfunction]
pub(crate) fn edge_edge_distance(
    points: &Bound<'_, PyAny>,
    out: &Bound<'_, PyAny>,
) -> PyResult<()> {
    write_distances(points, out, |[a, b, c, d]| edge_edge(a, b, c, d))
}

/// Times up to which points (first) and triangles surely keep a gap.
#[pyfunction]
pub(crate) fn point_triangle_impact(
    starts: &Bound<'_, PyAny>,
    ends: &Bound<'_, PyAny>,
    gap: f64,
    out: &Bound<'_, PyAny>,
) -> PyResult<()> {
    write_impacts(starts, ends, gap, out, time_of_point)
}

/// Times up to which pairs of edges surely keep a gap.
#[pyfunction]
pub(crate) fn edge_edge_impact(
    starts: &Bound<'_, PyAny>,
    ends: &Bound<'_, PyAny>,
    gap: f64,
    out: &Bound<'_, PyAny>,
) -> PyResult<()> {
    write_impacts(starts, ends, gap, out, time_of_edges)
}

/// What edges (two points) and triangles have in common.
#[pyfunction]
pub(crate) fn edge_crosses_triangle(
    points: &Bound<'_, PyAny>,
    out: &Bound<'_, PyAny>,
) -> PyResult<()> {
    let groups = point_groups::<5>(points, "points")?;
    let code = |[p, q, a, b, c]: &[Vector; 5]| match edge_meets_triangle([p, q], [a, b, c]) {
        Meeting::Apart => 0_u8,
        Meeting::Touching => 1,
        Meeting::Crossing => 2,
    };
    let codes = compute(points.py(), || Ok(groups.iter().map(code).collect::<Vec<_>>()))?;
    write_numbers(out, &codes, "uint8")
}

fn write_distances(
    points: &Bound<'_, PyAny>,
    out: &Bound<'_, PyAny>,
    closest: impl Fn(&[Vector; 4]) -> Closest + Sync,
) -> PyResult<()> {
    let groups = point_groups(points, "points")?;
    let distance = |group| closest(group).distance();
    let distances = compute(points.py(), || Ok(groups.iter().map(distance).collect::<Vec<_>>()))?;
    write_numbers(out, &distances, "float64")
}

fn write_impacts(
    starts: &Bound<'_, PyAny>,
    ends: &Bound<'_, PyAny>,
    gap: f64,
    out: &Bound<'_, PyAny>,
    impact: impl Fn([&Vector; 4], [&Vector; 4], f64) -> Option<f64> + Sync,
) -> PyResult<()> {
    let py = starts.py();
    let (from, to) = (point_groups(starts, "starts")?, point_groups(ends, "ends")?);
    if from.len() != to.len() {
        let accepted = format!("as many ends as starts, {}", from.len());
        return Err(refuse(py, format!("ends holds {} rows; accepted: {accepted}", to.len())));
    }
    if !(gap >= 0.0 && gap.is_finite()) {
        return Err(refuse(py, format!("gap is {gap} m; accepted: numbers from 0")));
    }
    let times = compute(py, || {
        let paths = from.iter().zip(&to);
        let time = |(start, end): (&[Vector; 4], &[Vector; 4])| {
            impact(start.each_ref(), end.each_ref(), gap).unwrap_or(f64::INFINITY)
        };
        Ok(paths.map(time).collect::<Vec<_>>())
    })?;
    write_numbers(out, &times, "float64")
}
