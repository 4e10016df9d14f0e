"""A grip on a cloth: which vertices a hand holds, and where it takes them. Points are tuples of m in one space."""

from __future__ import annotations

from array import array
from typing import NamedTuple

from . import points
from .points import Points

Vector = tuple[float, float, float]


class Grip(NamedTuple):
    """Vertices held around one."""

    vertex: int
    vertices: list[int]
    weights: Points
    """One a vertex, float64: 1 for the vertex itself, falling to 0 at the radius."""
    places: Points
    """Where they were when the hand closed, float64, flat."""
    point: Vector
    """Where the hand closed."""

    def targets(self, offset: Vector) -> Points:
        """Where the hand has them after moving by an offset, float64, flat."""
        return array("d", (x + offset[k % 3] for k, x in enumerate(self.places)))


def size(positions: Points) -> float:
    """The diagonal (m) of the box around all vertices."""
    spans = [max(axis) - min(axis) for axis in (positions[k::3] for k in range(3))]
    return float(sum(span * span for span in spans) ** 0.5)


def nearest(positions: Points, point: Vector) -> int:
    """The vertex nearest to a point."""
    distances = _squared_distances(positions, point)
    numpy = points.numpy_module()
    if numpy is not None:
        return int(numpy.argmin(distances))
    return min(range(len(distances)), key=distances.__getitem__)


def close(positions: Points, point: Vector, radius: float) -> Grip:
    """A grip on the vertex nearest to a point and its neighbourhood in space.

    Args:
        positions: Of all vertices, flat.
        point: Where the hand closes.
        radius: How far the hand reaches from that vertex (m); 0 takes it alone.
    """
    vertex = nearest(positions, point)
    reach = radius * radius
    held = {vertex: 1.0}
    if reach > 0.0:
        for other, squared in enumerate(_squared_distances(positions, _at(positions, vertex))):
            if other != vertex and squared < reach:
                held[other] = float((1.0 - squared / reach) ** 2)
    held = {one: weight for one, weight in sorted(held.items()) if weight > 1e-3}
    places = array("d", (x for one in held for x in _at(positions, one)))
    return Grip(vertex, list(held), array("d", held.values()), places, point)


def on_plane(origin: Vector, direction: Vector, point: Vector, normal: Vector) -> Vector | None:
    """Where a ray meets the plane through a point; None if it runs along it or leads away from it."""
    along = _dot(direction, normal)
    if abs(along) < 1e-9:
        return None
    way = _dot(_minus(point, origin), normal) / along
    if way < 0.0:
        return None
    return tuple(o + way * d for o, d in zip(origin, direction, strict=True))


def offset(origin: Vector, direction: Vector, grip: Grip, normal: Vector) -> Vector | None:
    """How far the hand has moved if it is now on this ray, in the plane of the view through the point that it holds."""
    found = on_plane(origin, direction, grip.point, normal)
    return None if found is None else _minus(found, grip.point)


def _at(positions: Points, vertex: int) -> Vector:
    x, y, z = positions[3 * vertex : 3 * vertex + 3]
    return float(x), float(y), float(z)


def _minus(one: Vector, other: Vector) -> Vector:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]


def _dot(one: Vector, other: Vector) -> float:
    return sum(a * b for a, b in zip(one, other, strict=True))


def _squared_distances(positions: Points, point: Vector) -> Points:
    numpy = points.numpy_module()
    if numpy is not None:
        away = numpy.asarray(positions, dtype="d").reshape(-1, 3) - numpy.array(point)
        return (away * away).sum(axis=1)
    x, y, z = point
    return [
        (positions[k] - x) ** 2 + (positions[k + 1] - y) ** 2 + (positions[k + 2] - z) ** 2
        for k in range(0, len(positions), 3)
    ]
