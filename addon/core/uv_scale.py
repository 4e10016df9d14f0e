"""How many metres one unit of a UV map is, so that yarns get their real size."""

from __future__ import annotations

import math

from . import points
from .points import Points


def metres(positions: Points, uvs: Points) -> tuple[float, float]:
    """Metres along u and v that one unit of the map stands for, the mean over triangles by their area.

    On a triangle with edges p, q in space and (a, b), (c, d) in the map, position follows the map by
    `dP/du = (d p - b q) / (a d - b c)` and `dP/dv = (a q - c p) / (a d - b c)`.

    Args:
        positions: Corners of triangles (m), flat, 9 numbers each.
        uvs: The same corners in the map, flat, 6 numbers each.

    Returns:
        (1, 1) where the map has no area.
    """
    numpy = points.numpy_module()
    if numpy is None:
        return _metres_slowly(positions, uvs)
    places = numpy.asarray(positions, dtype=numpy.float64).reshape(-1, 3, 3)
    corners = numpy.asarray(uvs, dtype=numpy.float64).reshape(-1, 3, 2)
    p, q = places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]
    (a, b), (c, d) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    twice = a * d - b * c
    seen = numpy.abs(twice) > 1e-20
    p, q, a, b, c, d, twice = (array[seen] for array in (p, q, a, b, c, d, twice))
    areas = numpy.linalg.norm(numpy.cross(p, q), axis=1)
    total = float(areas.sum())
    if not total > 0.0:
        return 1.0, 1.0
    along_u = numpy.linalg.norm(d[:, None] * p - b[:, None] * q, axis=1) / numpy.abs(twice)
    along_v = numpy.linalg.norm(a[:, None] * q - c[:, None] * p, axis=1) / numpy.abs(twice)
    return float((areas * along_u).sum()) / total, float((areas * along_v).sum()) / total


def _metres_slowly(positions: Points, uvs: Points) -> tuple[float, float]:
    total = width = height = 0.0
    for k in range(len(positions) // 9):
        x, y, z = (positions[9 * k + 3 * i : 9 * k + 3 * i + 3] for i in range(3))
        p = [two - one for one, two in zip(x, y, strict=True)]
        q = [two - one for one, two in zip(x, z, strict=True)]
        u0, v0, u1, v1, u2, v2 = uvs[6 * k : 6 * k + 6]
        a, b, c, d = u1 - u0, v1 - v0, u2 - u0, v2 - v0
        twice = a * d - b * c
        if abs(twice) <= 1e-20:
            continue
        normal = (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])
        area = math.hypot(*normal)
        total += area
        pairs = list(zip(p, q, strict=True))
        width += area * math.hypot(*(d * one - b * two for one, two in pairs)) / abs(twice)
        height += area * math.hypot(*(a * two - c * one for one, two in pairs)) / abs(twice)
    return (width / total, height / total) if total > 0.0 else (1.0, 1.0)


def projected(positions: Points) -> list[float]:
    """A map for triangles that have none: each along the axis that it faces most, in metres, flat, 6 numbers a triangle."""
    out: list[float] = []
    flat = [float(value) for value in positions]
    for k in range(0, len(flat), 9):
        x, y, z = flat[k : k + 3], flat[k + 3 : k + 6], flat[k + 6 : k + 9]
        p = [two - one for one, two in zip(x, y, strict=True)]
        q = [two - one for one, two in zip(x, z, strict=True)]
        normal = (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])
        facing = max(range(3), key=lambda axis: abs(normal[axis]))
        first, second = ((1, 2), (0, 2), (0, 1))[facing]
        for place in (x, y, z):
            out += [place[first], place[second]]
    return out
