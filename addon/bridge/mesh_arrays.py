"""Arrays of a mesh: positions and topology."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import bpy

from ..core import drift, points
from ..core.points import Affine, Points


class Topology(NamedTuple):
    """First corner of each face and the vertex of each corner, int32."""

    starts: Points
    corners: Points

    def digest(self) -> str:
        """A digest of the faces."""
        return drift.digest(self.starts, self.corners)


def read_vectors(attribute: bpy.types.Attribute) -> Points:
    """All values of a vector attribute, float32, flat."""
    values = points.empty("f", 3 * len(attribute.data))
    attribute.data.foreach_get("vector", values)
    return values


def read_positions(mesh: bpy.types.Mesh) -> Points:
    """What stands in the mesh's position attribute (m, object space), float32, flat."""
    if len(mesh.vertices) == 0:
        return points.empty("f", 0)
    return read_vectors(mesh.attributes["position"])


def write_positions(mesh: bpy.types.Mesh, positions: Points) -> None:
    """Move the mesh's vertices to positions (m, object space), float32, flat."""
    mesh.attributes["position"].data.foreach_set("vector", positions)
    mesh.update()


def topology(mesh: bpy.types.Mesh) -> Topology:
    """The faces of a mesh."""
    starts = points.empty("i", len(mesh.polygons))
    corners = points.empty("i", len(mesh.loops))
    mesh.polygons.foreach_get("loop_start", starts)
    mesh.loops.foreach_get("vertex_index", corners)
    return Topology(starts, corners)


def face_corners(mesh: bpy.types.Mesh) -> Iterator[tuple[int, int]]:
    """First corner and number of corners of each face."""
    starts = [*topology(mesh).starts, len(mesh.loops)]
    return ((int(one), int(other - one)) for one, other in pairwise(starts))


def next_corners(mesh: bpy.types.Mesh) -> Points:
    """Of each corner of a face the next one, int32."""
    out = array("i", range(1, len(mesh.loops) + 1))
    for first, count in face_corners(mesh):
        out[first + count - 1] = first
    return out


def edges(mesh: bpy.types.Mesh) -> Points:
    """The two vertices of each edge, int32, flat."""
    ends = points.empty("i", 2 * len(mesh.edges))
    mesh.edges.foreach_get("vertices", ends)
    return ends


def world_matrix(obj: Any) -> Affine:
    """Object to world space of an (evaluated) object."""
    return points.affine(obj.matrix_world)
