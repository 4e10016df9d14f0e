"""Vertex groups: which vertices are in one, and with which weight."""

from __future__ import annotations

import bpy

from ..core.refusal import Refusal

ANY = 1e-6
"""From this weight on a vertex is taken for one of a group that only includes or excludes."""


def require(obj: bpy.types.Object, label: str, name: str) -> None:
    """Refuse a name, unless it is empty, of which the object has no group; label is the setting that holds it.

    Raises:
        Refusal: It is not a group of the object.
    """
    if name and obj.vertex_groups.get(name) is None:
        known = ", ".join(f'"{group.name}"' for group in obj.vertex_groups) or "none"
        raise Refusal(
            f'"{obj.name}": {label} "{name}" is not a vertex group of the object '
            f"(it has {known}): choose one of them or clear the field"
        )


def vertices(obj: bpy.types.Object, name: str, threshold: float = ANY) -> list[int]:
    """The vertices whose weight in a group is at least threshold, in order."""
    return list(weights(obj, name, threshold))


def weights(obj: bpy.types.Object, name: str, threshold: float = ANY) -> dict[int, float]:
    """The same vertices and their weights."""
    group = obj.vertex_groups.get(name)
    if group is None:
        return {}
    index = group.index
    return {
        vertex.index: element.weight
        for vertex in obj.data.vertices
        for element in vertex.groups
        if element.group == index and element.weight >= threshold
    }
