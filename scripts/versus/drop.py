"""A sheet of 2 m x 2 m and 0.2 kg/m² that falls on a ball and on itself: what the benchmark of contact simulates.

Numpy alone, but for the check by ipctk, which this project has no part in.
"""

from __future__ import annotations

import numpy as np

from .sheet import SIZE, Sheet

HEIGHT = 0.6
"""m, where the sheet begins; the middle of the ball is at 0."""
RADIUS = 0.5
"""m, of the ball."""
CHECKED = 3
"""Frames at the end that ipctk looks at."""


class Drop(Sheet):
    """The sheet above the ball; nothing holds it."""

    def __init__(self, side: int) -> None:
        super().__init__(side)
        self.rest[:, 2] = HEIGHT
        self.pins = []

    @property
    def thickness(self) -> float:
        """Radius (m) of our cloth: a quarter of an edge."""
        return 0.25 * SIZE / self.side

    def triangles(self) -> np.ndarray:
        """The faces, each as two triangles from its first corner, as ours are cut."""
        return np.concatenate([self.faces[:, [0, 1, 2]], self.faces[:, [0, 2, 3]]])

    def crosses_itself(self, frames: list[np.ndarray]) -> list[bool]:
        """Whether ipctk finds the sheet passing through itself at each of some positions (m)."""
        import ipctk

        triangles = self.triangles()
        mesh = ipctk.CollisionMesh(self.rest, ipctk.edges(triangles), triangles)
        shapes = [np.asarray(frame, dtype=np.float64).reshape(-1, 3) for frame in frames]
        return [bool(ipctk.has_intersections(mesh, shape)) for shape in shapes]

    def depth(self, positions: np.ndarray) -> float:
        """How deep (m) the lowest vertex lies inside the ball; 0 outside."""
        distances = np.linalg.norm(np.asarray(positions, dtype=np.float64).reshape(-1, 3), axis=1)
        return max(0.0, RADIUS - float(distances.min()))
