"""The sheet that every program simulates: 2 m x 2 m, 0.2 kg/m², lying flat, held by two corners.

Numpy alone, because each program runs it in its own environment.
"""

from __future__ import annotations

import numpy as np

SIZE = 2.0
"""m, each side."""
DENSITY = 0.2
"""kg/m²."""
FPS = 24


class Sheet:
    """A square grid in the plane z = 0; a vertex is row · columns + column."""

    def __init__(self, side: int) -> None:
        axis = np.linspace(-0.5 * SIZE, 0.5 * SIZE, side)
        x, y = np.meshgrid(axis, axis)
        self.side = side
        self.rest = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
        number = np.arange(side * side, dtype=np.int32).reshape(side, side)
        corners = [number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]]
        self.faces = np.stack(corners, axis=-1).reshape(-1, 4)
        self.pins = [side * (side - 1), side * side - 1]
        self.mass_per_vertex = DENSITY * SIZE**2 / side**2
        """kg, where a program takes no areal density."""
        self.spacing = SIZE / (side - 1)

    def strain(self, positions: np.ndarray) -> tuple[float, float]:
        """Largest elongation L/L0 - 1 of the grid's edges at some positions (m), and its 99th percentile."""
        grid = np.asarray(positions, dtype=np.float64).reshape(self.side, self.side, 3)
        lengths = [np.linalg.norm(np.diff(grid, axis=axis), axis=2).ravel() for axis in (0, 1)]
        strain = np.concatenate(lengths) / self.spacing - 1.0
        return float(strain.max()), float(np.quantile(strain, 0.99))
