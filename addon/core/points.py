"""Points between object space (float32, Blender's) and world space (float64, the solver's).

Arrays are flat: x, y, z of each point in turn. numpy does the work where Blender has it; without numpy the same is done
by `array`, more slowly.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterable
from functools import cache
from types import ModuleType
from typing import Any

Affine = tuple[float, ...]
"""The upper three rows of a 4 x 4 matrix, row by row: 12 numbers."""

Points = Any
"""A flat buffer of coordinates (m): a numpy array or an `array`."""

IDENTITY: Affine = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@cache
def numpy_module() -> ModuleType | None:
    """numpy, if this Blender has it."""
    try:
        import numpy
    except ImportError:
        return None
    return numpy


def empty(kind: str, length: int) -> Points:
    """A buffer of zeros of length items; kind is "f" (float32), "d" (float64) or "i" (int32)."""
    numpy = numpy_module()
    if numpy is None:
        return array(kind, bytes(array(kind).itemsize * length))
    return numpy.zeros(length, dtype=kind)


def affine(rows: Iterable[Iterable[float]]) -> Affine:
    """The affine part of a 4 x 4 matrix given as rows."""
    return tuple(float(value) for row in list(rows)[:3] for value in row)


def inverse(matrix: Affine) -> Affine | None:
    """The inverse of an affine matrix, in double precision; None if it flattens space."""
    a, b, c, x, d, e, f, y, g, h, i, z = matrix
    cofactors = (e * i - f * h, f * g - d * i, d * h - e * g)
    determinant = a * cofactors[0] + b * cofactors[1] + c * cofactors[2]
    longest = max(abs(value) for value in (a, b, c, d, e, f, g, h, i))
    if not abs(determinant) > 1e-12 * longest**3:
        return None
    rows = (
        (cofactors[0], c * h - b * i, b * f - c * e),
        (cofactors[1], a * i - c * g, c * d - a * f),
        (cofactors[2], b * g - a * h, a * e - b * d),
    )
    out: list[float] = []
    for row in rows:
        p, q, r = (value / determinant for value in row)
        out += [p, q, r, -(p * x + q * y + r * z)]
    return tuple(out)


def product(one: Affine, other: Affine) -> Affine:
    """The matrix that moves first by other, then by one."""
    out: list[float] = []
    for row in range(3):
        p, q, r, move = one[4 * row : 4 * row + 4]
        out += [p * other[k] + q * other[4 + k] + r * other[8 + k] for k in range(4)]
        out[-1] += move
    return tuple(out)


def transform(points: Points, matrix: Affine, kind: str) -> Points:
    """The points moved by the matrix, as a new buffer of the kind ("f" or "d")."""
    numpy = numpy_module()
    if numpy is None:
        return _transform_slowly(points, matrix, kind)
    flat = numpy.asarray(points)
    if matrix == IDENTITY:
        return flat.astype(kind)
    rows = numpy.array(matrix, dtype=numpy.float64).reshape(3, 4)
    moved = flat.astype(numpy.float64).reshape(-1, 3) @ rows[:, :3].T
    moved += rows[:, 3]
    return moved.astype(kind, copy=False).reshape(-1)


def scaled(numbers: Points, factor: float) -> Points:
    """The numbers times a factor, as a new float64 buffer."""
    numpy = numpy_module()
    if numpy is None:
        return array("d", (factor * number for number in numbers))
    return numpy.asarray(numbers, dtype="d") * factor


def take(flat: Points, numbers: Points) -> Points:
    """The points of these numbers, float32, flat."""
    numpy = numpy_module()
    if numpy is None:
        return array("f", (flat[3 * number + axis] for number in numbers for axis in range(3)))
    return numpy.asarray(flat, dtype="f").reshape(-1, 3)[numpy.asarray(numbers)].reshape(-1)


def scatter(flat: Points, numbers: Points, count: int) -> Points:
    """So many points, float32, flat: each of the given ones put at its number."""
    out = empty("f", 3 * count)
    numpy = numpy_module()
    if numpy is None:
        for place, number in enumerate(numbers):
            out[3 * number : 3 * number + 3] = array("f", flat[3 * place : 3 * place + 3])
        return out
    out.reshape(-1, 3)[numpy.asarray(numbers)] = numpy.asarray(flat, dtype="f").reshape(-1, 3)
    return out


def joined(one: Points, other: Points) -> Points:
    """Two buffers of float32 as one."""
    numpy = numpy_module()
    return array("f", one) + array("f", other) if numpy is None else numpy.concatenate((one, other))


def pairs(count: int) -> Points:
    """The pairs of each of so many points and the one that stands so many places after it, int32, flat."""
    return array("i", (number + part for number in range(count) for part in (0, count)))


def integers(data: bytes) -> Points:
    """int32 of bytes, a buffer of its own."""
    numpy = numpy_module()
    return array("i", data) if numpy is None else numpy.frombuffer(data, dtype="i").copy()


def _transform_slowly(points: Points, matrix: Affine, kind: str) -> Points:
    if matrix == IDENTITY:
        return array(kind, points)
    a, b, c, x, d, e, f, y, g, h, i, z = matrix
    out = array(kind, bytes(array(kind).itemsize * len(points)))
    for k in range(0, len(points), 3):
        p, q, r = points[k : k + 3]
        out[k] = a * p + b * q + c * r + x
        out[k + 1] = d * p + e * q + f * r + y
        out[k + 2] = g * p + h * q + i * r + z
    return out


def rows(flat: Points, width: int) -> Any:
    """A flat buffer as rows, without a copy."""
    view = memoryview(flat).cast("B")
    return view.cast(memoryview(flat).format, [len(flat) // width, width])
