"""The two sides of a cloth: its surface moved along the normals by the thickness."""

from __future__ import annotations

import math
from array import array

from . import points
from .points import Affine, Points


def normals_to_world(normals: Points, to_object: Affine) -> Points:
    """Normals of an object in world space, of length 1, float32, flat; to_object leads from world to object space."""
    a, b, c, _, d, e, f, _, g, h, i, _ = to_object
    turned = points.transform(normals, (a, d, g, 0.0, b, e, h, 0.0, c, f, i, 0.0), "f")
    return _unit(turned)


def sides(positions: Points, normals: Points, distance: float) -> tuple[Points, Points]:
    """The surface moved to both sides by a distance (m): positions and unit normals are flat, of one space, float32."""
    return _moved(positions, normals, distance), _moved(positions, normals, -distance)


def _unit(vectors: Points) -> Points:
    numpy = points.numpy_module()
    if numpy is not None:
        rows = vectors.reshape(-1, 3)
        lengths = numpy.linalg.norm(rows, axis=1)
        return (rows / numpy.where(lengths > 0.0, lengths, 1.0)[:, None]).reshape(-1)
    out = array("f", vectors)
    for k in range(0, len(out), 3):
        length = math.hypot(*out[k : k + 3]) or 1.0
        out[k : k + 3] = array("f", [value / length for value in out[k : k + 3]])
    return out


def _moved(positions: Points, normals: Points, distance: float) -> Points:
    if points.numpy_module() is not None:
        return positions + positions.dtype.type(distance) * normals
    pairs = zip(positions, normals, strict=True)
    return array("f", [place + distance * normal for place, normal in pairs])
