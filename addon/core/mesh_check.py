"""What is wrong with a mesh that is to be a cloth: every problem with the vertices that have it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum
from typing import NamedTuple


class Severity(Enum):
    """How much a problem matters."""

    ERROR = "the cloth cannot be simulated"
    WARNING = "the cloth can be simulated, but look at this"
    HINT = "nothing is wrong, but it may not be what is meant"


class Problem(NamedTuple):
    """One problem: a sentence with its cure, and the vertices to select."""

    severity: Severity
    sentence: str
    vertices: Sequence[int] = ()
    passes_through: str = ""
    """Name of an object that the cloth passes through, because it is no collider."""


SMALLEST_AREA = 1e-18
"""Area (m²) of a face that the solver still accepts."""
SHORTEST_EDGE = 1e-9
"""Length (m) of an edge that the solver still accepts."""


def check(
    positions: Sequence[float], starts: Sequence[int], corners: Sequence[int], ends: Sequence[int]
) -> list[Problem]:
    """The problems of a mesh.

    Args:
        positions: x, y, z of each vertex (m, world space), flat.
        starts: First corner of each face.
        corners: Vertex of each corner.
        ends: The two vertices of each edge, flat.
    """
    count = len(positions) // 3
    if count == 0 or len(starts) == 0:
        return [_error("the mesh has no faces: give it at least one face", ())]
    values = [float(value) for value in positions]
    broken = [v for v in range(count) if not all(map(math.isfinite, values[3 * v : 3 * v + 3]))]
    if broken:
        return [_counted(broken, "with a position that is no number", "delete or move")]
    problems = [
        _counted(_loose(count, corners), "that no face uses", "delete"),
        _counted(_short_edges(values, ends), "on edges of no length", "merge"),
        _counted(_flat_faces(values, starts, corners), "on faces of no area", "dissolve"),
    ]
    found = [problem for problem in problems if problem is not None]
    doubles = _doubles(values)
    if doubles and not found:
        sentence = _sentence(doubles, "lying on another one", "merge them by distance")
        found.append(Problem(Severity.WARNING, sentence, doubles))
    return found


def thick_for_edges(
    positions: Sequence[float], ends: Sequence[int], thickness: float
) -> list[Problem]:
    """The problem of a cloth that is thicker than half of an edge: what is near at rest is always in contact.

    Args:
        positions: x, y, z of each vertex (m, world space), flat.
        ends: The two vertices of each edge, flat.
        thickness: Radius of the cloth (m).
    """
    values = [float(value) for value in positions]
    lengths = edge_lengths(values, ends)
    found = {
        int(vertex)
        for k, length in zip(range(0, len(ends), 2), lengths, strict=True)
        if length < 2.0 * thickness
        for vertex in ends[k : k + 2]
    }
    if not found:
        return []
    sentence = (
        f"Thickness is {thickness:.3g} m, more than half of the edges at {_vertices(len(found))} (the "
        f"shortest is {min(lengths):.3g} m): the cloth then touches itself at rest and takes longer: lower "
        f"Thickness to {0.5 * min(lengths):.2g} m, or merge short edges"
    )
    return [Problem(Severity.WARNING, sentence, sorted(found))]


def edge_lengths(values: Sequence[float], ends: Sequence[int]) -> list[float]:
    """The length of each edge (m)."""
    places = [values[k : k + 3] for k in range(0, len(values), 3)]
    return [math.dist(places[ends[k]], places[ends[k + 1]]) for k in range(0, len(ends), 2)]


def _error(sentence: str, vertices: Sequence[int]) -> Problem:
    return Problem(Severity.ERROR, sentence, vertices)


def _counted(vertices: Sequence[int], what: str, cure: str) -> Problem | None:
    if not vertices:
        return None
    return _error(_sentence(vertices, what, f"{cure} them"), vertices)


def _sentence(vertices: Sequence[int], what: str, cure: str) -> str:
    numbers = ", ".join(str(vertex) for vertex in vertices[:5])
    more = ", ..." if len(vertices) > 5 else ""
    return f"{_vertices(len(vertices))} {what} ({numbers}{more}): {cure}"


def _vertices(count: int) -> str:
    return f"{count} vertices" if count != 1 else "1 vertex"


def _loose(count: int, corners: Sequence[int]) -> list[int]:
    used = bytearray(count)
    for vertex in corners:
        used[vertex] = 1
    return [vertex for vertex in range(count) if not used[vertex]]


def _short_edges(values: list[float], ends: Sequence[int]) -> list[int]:
    found: set[int] = set()
    for k in range(0, len(ends), 2):
        i, j = int(ends[k]), int(ends[k + 1])
        if math.dist(values[3 * i : 3 * i + 3], values[3 * j : 3 * j + 3]) < SHORTEST_EDGE:
            found |= {i, j}
    return sorted(found)


def _flat_faces(values: list[float], starts: Sequence[int], corners: Sequence[int]) -> list[int]:
    found: set[int] = set()
    for face, start in enumerate(starts):
        end = int(starts[face + 1]) if face + 1 < len(starts) else len(corners)
        vertices = [int(corners[k]) for k in range(int(start), end)]
        if _is_flat([values[3 * v : 3 * v + 3] for v in vertices]):
            found.update(vertices)
    return sorted(found)


def _is_flat(ring: list[list[float]]) -> bool:
    x = y = z = 0.0
    ox, oy, oz = ring[0]
    px, py, pz = (a - b for a, b in zip(ring[-1], ring[0], strict=True))
    for point in ring:
        qx, qy, qz = point[0] - ox, point[1] - oy, point[2] - oz
        x += py * qz - pz * qy
        y += pz * qx - px * qz
        z += px * qy - py * qx
        px, py, pz = qx, qy, qz
    return not 0.5 * math.sqrt(x * x + y * y + z * z) > SMALLEST_AREA


def _doubles(values: list[float]) -> list[int]:
    seen: dict[tuple[float, ...], int] = {}
    found: set[int] = set()
    for vertex in range(len(values) // 3):
        place = tuple(values[3 * vertex : 3 * vertex + 3])
        other = seen.setdefault(place, vertex)
        if other != vertex:
            found |= {other, vertex}
    return sorted(found)
