"""The numpy demo's method, written here as plainly as it is told: a grid of springs, air, and wind by vertex normals.

With d = x_j - x_i, L the length at rest, n the mean of the unit normals of the squares around a particle and u the wind:

    F_i = m g - c v_i + sum k (|d| - L) d/|d| + b (n . (u - v_i)) n        v += h F/m, x += h v; pins stay
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SHIFTS = ((0, 1), (1, 0), (1, 1), (1, -1), (0, 2), (2, 0))
"""From a particle to those it has a spring to: rows and columns."""


@dataclass(frozen=True)
class Demo:
    """The demo's numbers, SI units; rows are upright along z."""

    side: int = 14
    spacing: float = 0.2
    stiffness: float = 8.0
    mass: float = 0.01
    air_damping: float = 0.05
    gravity: tuple[float, float, float] = (0.0, 0.0, -4.0)
    wind: tuple[float, float, float] = (0.5, 3.0, 0.0)
    wind_coefficient: float = 0.02
    step: float = 0.01

    def rest(self) -> np.ndarray:
        """Positions (m) at rest in the plane of x and z, (rows, columns, 3)."""
        line = self.spacing * np.arange(self.side)
        z, x = np.meshgrid(line, line, indexing="ij")
        return np.stack([x, np.zeros_like(x), z], axis=-1)

    def blown(self) -> np.ndarray:
        """Which particles the wind pushes: 4 x 4 in the lower right corner."""
        where = np.zeros((self.side, self.side), dtype=bool)
        where[:4, 10:] = True
        return where

    def pins(self) -> list[tuple[int, int]]:
        """Rows and columns of what is held: both upper corners."""
        return [(self.side - 1, 0), (self.side - 1, self.side - 1)]

    def forces(self, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """All forces (N)."""
        force = self.mass * np.array(self.gravity) - self.air_damping * v
        n = self.side
        for rows, columns in SHIFTS:
            left, right = max(0, -columns), max(0, columns)
            first = np.s_[: n - rows, left : n - right]
            second = np.s_[rows:, right : n - left]
            way = x[second] - x[first]
            length = np.linalg.norm(way, axis=-1, keepdims=True)
            pull = self.stiffness * (1.0 - self.spacing * np.hypot(rows, columns) / length) * way
            force[first] += pull
            force[second] -= pull
        normal = self.normals(x)
        against = ((np.array(self.wind) - v) * normal).sum(axis=-1, keepdims=True)
        force += self.blown()[..., None] * self.wind_coefficient * against * normal
        return force

    def normals(self, x: np.ndarray) -> np.ndarray:
        """The mean of the unit normals of the squares around each particle, as a unit vector."""
        of_squares = np.cross(x[1:, 1:] - x[:-1, :-1], x[1:, :-1] - x[:-1, 1:])
        of_squares /= np.linalg.norm(of_squares, axis=-1, keepdims=True)
        total = np.zeros_like(x)
        for rows in (np.s_[1:], np.s_[:-1]):
            for columns in (np.s_[1:], np.s_[:-1]):
                total[rows, columns] += of_squares
        return total / np.linalg.norm(total, axis=-1, keepdims=True)

    def run(self, steps: int) -> np.ndarray:
        """Positions (m) at the start and after each step, (steps + 1, particles, 3)."""
        x, v = self.rest(), np.zeros((self.side, self.side, 3))
        is_free = np.ones((self.side, self.side, 1))
        for pin in self.pins():
            is_free[pin] = 0.0
        seen = [x.reshape(-1, 3).copy()]
        for _ in range(steps):
            v += is_free * (self.step / self.mass) * self.forces(x, v)
            x += self.step * v
            seen.append(x.reshape(-1, 3).copy())
        return np.array(seen)
