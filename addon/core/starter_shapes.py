"""Shapes of the starters as grids: vertex = row * columns + column, from the bottom row up, in metres.

Every shape is one that a flat sheet can take (or a cone, for the cape): it is the rest shape, so nothing is stretched in it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

Point = tuple[float, float, float]


class Grid(NamedTuple):
    """Vertices and quads."""

    columns: int
    rows: int
    points: list[Point]

    def faces(self) -> Iterator[tuple[int, int, int, int]]:
        """The vertices of each quad."""
        for row in range(self.rows - 1):
            for column in range(self.columns - 1):
                first = row * self.columns + column
                yield first, first + 1, first + 1 + self.columns, first + self.columns

    def top(self) -> list[int]:
        """The vertices of the last row."""
        return list(range((self.rows - 1) * self.columns, self.rows * self.columns))

    def left(self) -> list[int]:
        """The vertices of the first column."""
        return list(range(0, self.rows * self.columns, self.columns))


def sheet(width: float, height: float, columns: int, rows: int, lying: bool) -> Grid:
    """A flat sheet around the origin, upright (XZ) or lying (XY)."""

    def place(across: float, up: float) -> Point:
        x, other = (across - 0.5) * width, (up - 0.5) * height
        return (x, other, 0.0) if lying else (x, 0.0, other)

    return _grid(columns, rows, place)


def pleated(
    width: float, height: float, columns: int, rows: int, pleats: int, fullness: float
) -> Grid:
    """An upright curtain in even waves, width wide; its cloth is fullness times as wide."""
    wave = width / pleats
    depth = _depth(wave, fullness)
    line = _evenly(lambda t: (wave * t, depth * math.sin(2.0 * math.pi * t)), pleats, columns)

    def place(across: float, up: float) -> Point:
        x, y = line[round(across * (columns - 1))]
        return x - 0.5 * width, y, (up - 0.5) * height

    return _grid(columns, rows, place)


def cape(
    neck: float, hem: float, length: float, columns: int, rows: int, pleats: int, opening: float
) -> Grid:
    """A cape around the Z axis that is open toward -Y: gathered at the neck, smooth and wide at the hem.

    The radii at the top and the bottom and the height are in metres, with the top at z = 0; the opening is an angle in radians.
    """
    arc = 2.0 * math.pi - opening

    def place(across: float, up: float) -> Point:
        angle = 0.5 * math.pi + arc * (across - 0.5)
        radius = hem + (neck - hem) * up
        # Waves that deepen downward, as gathered cloth falls.
        radius += 0.12 * radius * (1.0 - 0.85 * up) * math.sin(2.0 * math.pi * pleats * across)
        return radius * math.cos(angle), radius * math.sin(angle), length * (up - 1.0)

    return _grid(columns, rows, place)


def _grid(columns: int, rows: int, place: Callable[[float, float], Point]) -> Grid:
    points = [
        place(column / (columns - 1), row / (rows - 1))
        for row in range(rows)
        for column in range(columns)
    ]
    return Grid(columns, rows, points)


_FINE = 64
"""Straight pieces in which a wave is measured."""


def _depth(wave: float, fullness: float) -> float:
    """Amplitude (m) of a sine of this wavelength whose line is fullness times as long as straight: by bisection."""
    low, high = 0.0, fullness * wave
    for _ in range(60):
        middle = 0.5 * (low + high)
        pieces = [
            (wave * k / _FINE, middle * math.sin(2.0 * math.pi * k / _FINE))
            for k in range(_FINE + 1)
        ]
        length = sum(math.dist(pieces[k], pieces[k + 1]) for k in range(_FINE))
        low, high = (middle, high) if length < fullness * wave else (low, middle)
    return 0.5 * (low + high)


def _evenly(
    line: Callable[[float], tuple[float, float]], end: float, count: int
) -> list[tuple[float, float]]:
    """Points at equal distances along a line from 0 to end, so that edges across the waves are all alike."""
    pieces = max(_FINE * math.ceil(end), 4 * count)
    fine = [line(end * k / pieces) for k in range(pieces + 1)]
    lengths = [0.0]
    for k in range(pieces):
        lengths.append(lengths[-1] + math.dist(fine[k], fine[k + 1]))
    out, k = [], 0
    for number in range(count):
        wanted = lengths[-1] * number / (count - 1)
        while k < pieces - 1 and lengths[k + 1] < wanted:
            k += 1
        part = (wanted - lengths[k]) / (lengths[k + 1] - lengths[k])
        out.append(tuple(a + part * (b - a) for a, b in zip(fine[k], fine[k + 1], strict=True)))
    return out
