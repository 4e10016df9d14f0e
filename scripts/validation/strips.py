"""Strips of fabric and the meshes that they are cut from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from scipy.spatial import Delaunay

from .specimen import Shape, grid


def aligned(columns: Sequence[float], rows: Sequence[float]) -> Shape:
    """Triangles between columns and rows (m), the diagonals of their rectangles in turns."""
    quads = grid(columns, rows)
    across = len(columns) - 1
    number = np.arange(len(quads.faces))
    is_odd = (number + number // across) % 2 == 1
    corners = {False: [[0, 1, 2], [0, 2, 3]], True: [[0, 1, 3], [1, 2, 3]]}
    faces = [quads.faces[i][corners[bool(odd)]] for i, odd in enumerate(is_odd)]
    return Shape(quads.positions, np.concatenate(faces))


def diagonal(columns: Sequence[float], rows: int) -> Shape:
    """A square lattice with one diagonal, turned by 45°, so that the diagonal runs along the strip.

    Args:
        columns: Where the even rows have their vertices (m), evenly; the odd ones stand between, and at 0 and at both ends.
        rows: How many rows, half a column apart.
    """
    cell = columns[1] - columns[0]
    ends = np.array([columns[0], 0.0, columns[-1]])
    odd = np.unique(np.concatenate([ends, np.array(columns[:-1]) + 0.5 * cell]).round(12))
    lines = [np.array(columns) if row % 2 == 0 else odd for row in range(rows)]
    starts = np.concatenate([[0], np.cumsum([len(line) for line in lines])])
    points = [
        np.stack([line, np.full(len(line), 0.5 * cell * row), np.zeros(len(line))], axis=-1)
        for row, line in enumerate(lines)
    ]
    faces = []
    for row in range(rows - 1):
        below, above = lines[row], lines[row + 1]
        i = j = 0
        while i + 1 < len(below) or j + 1 < len(above):
            a, b = starts[row] + i, starts[row + 1] + j
            goes_below = j + 1 == len(above) or (
                i + 1 < len(below) and below[i + 1] <= above[j + 1]
            )
            faces.append([a, a + 1, b] if goes_below else [a, b + 1, b])
            i, j = i + goes_below, j + (not goes_below)
    return Shape(np.concatenate(points), np.array(faces))


def unstructured(columns: Sequence[float], rows: Sequence[float]) -> Shape:
    """Points of a grid, those inside moved by up to a third of a cell, joined as Delaunay says; x = 0 stays a line."""
    points = grid(columns, rows).positions.copy()
    cell = columns[1] - columns[0]
    inside = (points[:, 0] > 1e-9) & (points[:, 0] < columns[-1] - 1e-9)
    inside &= (points[:, 1] > rows[0] + 1e-9) & (points[:, 1] < rows[-1] - 1e-9)
    points[inside, :2] += (
        cell / 3.0 * np.random.default_rng(1).uniform(-1.0, 1.0, (inside.sum(), 2))
    )
    faces = Delaunay(points[:, :2]).simplices
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    areas = np.cross(b - a, c - a)[:, 2]
    whole = np.abs(areas) > 1e-6 * cell * cell
    faces, areas = faces[whole], areas[whole]
    return Shape(points, np.where(areas[:, None] > 0.0, faces, faces[:, ::-1]))


def masses(shape: Shape, density: float) -> np.ndarray:
    """The mass (kg) of each vertex: a third of the triangles at it."""
    a, b, c = (shape.positions[shape.faces[:, corner]] for corner in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    found = np.zeros(len(shape.positions))
    np.add.at(found, shape.faces, density / 3.0 * areas[:, None])
    return found


def fabric(stretch: float, bend: float, density: float, **keys: Any) -> Mapping[str, Any]:
    """An isotropic cloth of fabric without damping and limiter: membrane (N/m), bending (N·m), areal density (kg/m²)."""
    table = {
        "stretch_warp": stretch,
        "stretch_weft": stretch,
        "shear": 0.5 * stretch,
        "bend_warp": bend,
        "bend_weft": bend,
        "damping_ratio": 0.0,
        "limiter": "none",
        "warp": [1.0, 0.0, 0.0],
    }
    return {"model": "fabric", "density": density, "fabric": table | keys}
