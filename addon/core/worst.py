"""The worst of a result: the frame with the largest strain or most intersections, and the most stretched edges."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

STRAIN = "max_strain"
INTERSECTIONS = "intersections"


class Edge(NamedTuple):
    """An edge by its number, and its strain."""

    number: int
    strain: float


def frame(rows: Mapping[int, Mapping[str, Any]], key: str) -> tuple[int, float] | None:
    """The first frame at which a number of the certificates is largest, and that number; None where nothing is told.

    A report knows no infinity: there a strain that left the numbers is None.
    """
    best: tuple[int, float] | None = None
    for number in sorted(rows):
        value = rows[number].get(key, 0.0)
        if value is None:
            value = math.inf if key == STRAIN else 0.0
        if best is None or value > best[1]:
            best = (number, float(value))
    return best


def rest_lengths(springs: Sequence[bytes]) -> dict[tuple[int, int], float]:
    """Rest length (m) of each edge by its vertices, the lower first, from what a simulation tells of its springs."""
    ends = memoryview(springs[0]).cast("i")
    kinds = memoryview(springs[1])
    lengths = memoryview(springs[2]).cast("d")
    out: dict[tuple[int, int], float] = {}
    for spring, kind in enumerate(kinds):
        if kind == 0:
            one, other = ends[2 * spring], ends[2 * spring + 1]
            out[min(one, other), max(one, other)] = lengths[spring]
    return out


def edges(
    positions: Sequence[float],
    ends: Sequence[int],
    lengths: Mapping[tuple[int, int], float],
    places: Sequence[int] | None = None,
) -> list[Edge]:
    """The strain of every edge whose rest length is known, the largest first.

    Args:
        positions: x, y, z of each vertex, or of each point of a cloth that may tear (m, world space), flat.
        ends: The two vertices of each edge, flat.
        lengths: Rest length (m) by the vertices of an edge, the lower first.
        places: The two points of each edge, flat; its vertices if None.
    """
    at = ends if places is None else places
    values = [float(value) for value in positions]
    found = []
    for number in range(len(ends) // 2):
        one, other = int(ends[2 * number]), int(ends[2 * number + 1])
        rest = lengths.get((min(one, other), max(one, other)))
        if rest:
            here, there = 3 * int(at[2 * number]), 3 * int(at[2 * number + 1])
            length = math.dist(values[here : here + 3], values[there : there + 3])
            found.append(Edge(number, length / rest - 1.0))
    return sorted(found, key=lambda edge: (-edge.strain, edge.number))
