"""A solver for one cloth, from Blender's data."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import bpy

from .. import native
from ..core import scene_json
from ..core.points import Points
from . import mesh_arrays
from .colliders import Arrays


def maker(
    obj: bpy.types.Object,
    description: dict[str, Any],
    start_world: Points,
    threads: int = 0,
    colliders: Sequence[Arrays] = (),
    shape: Points | None = None,
) -> Callable[[], Any]:
    """A function that builds the simulation; it holds no Blender data and may run on any thread.

    Args:
        obj: The cloth.
        description: Its scene description.
        start_world: Positions (m, world space) that it starts from, float64, flat.
        threads: 0 takes every core.
        colliders: The meshes of the description's colliders, in its order.
        shape: Rest positions (m, world space), float64, flat; None for those that it starts from.
    """
    faces = mesh_arrays.topology(obj.data)
    text = scene_json.encode(description)
    mesh = (start_world, faces.starts, faces.corners)
    return lambda: native.simulation(text, [mesh], threads, colliders, [shape])


def is_pinned(description: dict[str, Any]) -> bool:
    """Whether anything holds the cloth."""
    return bool(description["cloth"][0].get("pins"))
