"""Specimens cut out of a fabric: strips and rings, as grids along the yarns or as meshes without any direction.

Every specimen lies flat, around or beside the origin of the plane. The same call gives the same mesh.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.spatial import Delaunay, cKDTree

Kind = Literal["grid", "delaunay"]
SEED = 20
"""Of the points of meshes without a direction."""
NEAREST = 0.7
"""How near two of these points may be at first, in edge lengths: closer than they can be packed, so that none lacks."""
DARTS = 12
"""Points that are tried for each that is kept, more or less."""
SMOOTHINGS = 4
CLEAR = 0.55
"""How far from the border of a cut the vertices of a grid inside keep, in edge lengths."""


@dataclass(frozen=True)
class Cut:
    """A mesh in the plane."""

    points: np.ndarray
    """(n, 2) (m)."""
    faces: np.ndarray
    """(f, 4) quads of a grid, or (f, 3) triangles, all counter-clockwise."""

    @property
    def triangles(self) -> np.ndarray:
        """(t, 3): quads fall apart as the solver cuts them."""
        corners = self.faces
        if corners.shape[1] == 3:
            return corners
        return np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])

    def area(self) -> float:
        """m²."""
        return float(doubled_areas(self.points, self.triangles).sum() / 2.0)


def doubled_areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Twice the area (m²) of triangles, positive where they turn to the left."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    u, v = b - a, c - a
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def strip(
    length: float,
    width: float,
    cells: tuple[int, int],
    kind: Kind = "grid",
    straight: Sequence[int] = (0, -1),
    turn: float = 0.0,
) -> Cut:
    """A strip (m) from x = 0 along x, its middle line y = 0, so many cells long and wide.

    A mesh without a direction, and a grid that is turned (degrees) as the yarns are in a strip cut on the bias, have
    vertices along both long sides as the grid along x has them, and in its columns `straight`.
    """
    columns, rows = cells
    x = np.linspace(0.0, length, columns + 1)
    y = np.linspace(-0.5 * width, 0.5 * width, rows + 1)
    grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    if kind == "grid" and turn == 0.0:
        return Cut(grid, quads(columns, rows))
    is_fixed = np.isin(grid[:, 0], x[list(straight)]) | np.isin(grid[:, 1], y[[0, -1]])
    edge = length / columns
    box = np.array([[0.0, -0.5 * width], [length, 0.5 * width]])
    if kind == "delaunay":
        return scattered(grid[is_fixed], box, edge, lambda points: np.full(len(points), True))
    inner = lattice(length + width, edge, turn) + box.mean(axis=0)
    return filled(grid[is_fixed], inner[((inner > box[0]) & (inner < box[1])).all(axis=1)], edge)


def quads(columns: int, rows: int) -> np.ndarray:
    """The faces of a grid so many cells wide and high, whose vertices are numbered row by row."""
    number = np.arange((columns + 1) * (rows + 1)).reshape(rows + 1, columns + 1)
    corners = [number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]]
    return np.stack(corners, axis=-1).reshape(-1, 4)


def annulus(radius: float, ring: float, edge: float, kind: Kind = "grid") -> Cut:
    """What hangs of a disc (m) about the origin that is held within a circle, with a row of faces inside of that.

    Edges are about so long (m). Along both circles there are vertices; between them lie those of a grid along x and y, or
    of a mesh without a direction.
    """
    fixed = np.concatenate([circle(r, edge) for r in (ring - edge, ring, radius)])

    def is_inside(points: np.ndarray) -> np.ndarray:
        return (norm(points) > ring) & (norm(points) < radius - 0.5 * edge)

    if kind == "delaunay":
        box = np.array([[-radius, -radius], [radius, radius]])
        cut = scattered(fixed, box, edge, is_inside)
    else:
        inner = lattice(2.0 * radius, edge)
        cut = filled(fixed, inner[is_inside(inner)], edge)
    is_innermost = norm(cut.points) < ring - 0.5 * edge
    return Cut(cut.points, cut.faces[~is_innermost[cut.faces].all(axis=1)])


def norm(points: np.ndarray) -> np.ndarray:
    """Distances (m) from the origin."""
    return np.hypot(points[:, 0], points[:, 1])


def circle(radius: float, edge: float) -> np.ndarray:
    """Points (m) around a circle, about an edge length apart."""
    count = round(2.0 * np.pi * radius / edge)
    angles = 2.0 * np.pi * np.arange(count) / count
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def lattice(size: float, edge: float, turn: float = 0.0) -> np.ndarray:
    """Points of a square grid (m) around the origin, turned by some degrees."""
    reach = int(0.5 * size / edge)
    axis = edge * np.arange(-reach, reach + 1)
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    return np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2) @ [[c, s], [-s, c]]


def filled(fixed: np.ndarray, inner: np.ndarray, edge: float) -> Cut:
    """A Delaunay mesh of fixed points (m) and of the others that keep clear of them."""
    is_clear = cKDTree(fixed).query(inner)[0] > CLEAR * edge
    points = np.concatenate([fixed, inner[is_clear]])
    return Cut(points, meshed(points, edge))


def scattered(
    fixed: np.ndarray,
    box: np.ndarray,
    edge: float,
    is_inside: Callable[[np.ndarray], np.ndarray],
) -> Cut:
    """A Delaunay mesh of fixed points (m) and of others thrown between them, none near another, then evened out."""
    dice = np.random.default_rng(SEED)
    count = int(DARTS * np.prod(box[1] - box[0]) / edge**2)
    darts = dice.uniform(box[0], box[1], (count, 2))
    darts = darts[is_inside(darts)]
    darts = darts[cKDTree(fixed).query(darts)[0] > NEAREST * edge]
    pairs = cKDTree(darts).query_pairs(NEAREST * edge, output_type="ndarray")
    kept = np.ones(len(darts), dtype=bool)
    # An earlier dart that stays keeps later ones away.
    for first, second in pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]:
        kept[second] &= not kept[first]
    points = np.concatenate([fixed, darts[kept]])
    for _ in range(SMOOTHINGS):
        points[len(fixed) :] = centroids(points, meshed(points, edge))[len(fixed) :]
    return Cut(points, meshed(points, edge))


def meshed(points: np.ndarray, edge: float) -> np.ndarray:
    """Delaunay triangles, without the flat ones along straight sides, all turning to the left."""
    triangles = Delaunay(points).simplices
    twice = doubled_areas(points, triangles)
    triangles = np.where(twice[:, None] < 0.0, triangles[:, ::-1], triangles)
    return triangles[np.abs(twice) > 1e-3 * edge**2]


def centroids(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """For each point the centre of mass (m) of the triangles around it."""
    weights = doubled_areas(points, triangles)
    middles = weights[:, None] * points[triangles].mean(axis=1)
    sums, totals = np.zeros_like(points), np.zeros(len(points))
    for corner in triangles.T:
        np.add.at(sums, corner, middles)
        np.add.at(totals, corner, weights)
    return sums / totals[:, None]
