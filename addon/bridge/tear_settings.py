"""What an object's vertex groups say of tearing, and up to what the colours of a force go."""

from __future__ import annotations

import bpy

from ..core.refusal import Refusal
from ..core.shape import decimal
from ..core.tear import TearGroups
from . import mesh_arrays, shape, vertex_groups


def groups(obj: bpy.types.Object) -> TearGroups:
    """The strength of the vertices, and the edges that open.

    Raises:
        Refusal: A group is named that the object does not have.
    """
    settings = obj.boucle
    if not settings.use_tear:
        return TearGroups()
    return TearGroups(_strength(obj), _openings(obj) if settings.tear_opening_group else None)


def _strength(obj: bpy.types.Object) -> list[float]:
    name = obj.boucle.tear_strength_group
    if not name:
        return []
    vertex_groups.require(obj, "Strength Group", name)
    found = [1.0] * len(obj.data.vertices)
    for vertex, weight in vertex_groups.weights(obj, name, 0.0).items():
        found[vertex] = min(1.0, decimal(weight))
    return found


def _openings(obj: bpy.types.Object) -> list[tuple[int, int]]:
    """Those with both ends in the group; loose edges are seams only where they are sewn."""
    name = obj.boucle.tear_opening_group
    vertex_groups.require(obj, "Opening Group", name)
    inside = set(vertex_groups.vertices(obj, name))
    is_sewn = obj.boucle.use_sewing_springs
    ends = mesh_arrays.edges(obj.data) if is_sewn else shape.face_edges(obj.data)
    pairs = zip(ends[::2], ends[1::2], strict=True)
    return [(int(a), int(b)) for a, b in pairs if int(a) in inside and int(b) in inside]


def limit(obj: bpy.types.Object, key: str) -> float | None:
    """At which strain or force (N) an edge tears; None where it does not, or not by that."""
    settings = obj.boucle
    if not settings.use_tear:
        return None
    if key == "strain":
        return settings.tear_strain or None
    if key not in ("force", "tension"):
        return None
    limits = [settings.tear_force]
    try:
        limits.append(
            settings.tear_stress * shape.mean_edge(obj)
        )  # of a grid, its spacing is the width
    except Refusal:  # no edges: there is nothing to colour
        return None
    return min((limit for limit in limits if limit > 0.0), default=None)
