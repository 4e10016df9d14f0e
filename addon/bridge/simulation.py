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
    rest_world: Points,
    threads: int = 0,
    colliders: Sequence[Arrays] = (),
) -> Callable[[], Any]:
    """A function that builds the simulation; it holds no Blender data and may run on any thread.

    Args:
        obj: The cloth.
        description: Its scene description.
        rest_world: Rest positions (m, world space), float64, flat.
        threads: 0 takes every core.
        colliders: The meshes of the description's colliders, in its order.
    """
    faces = mesh_arrays.topology(obj.data)
    text = scene_json.encode(description)
    mesh = (rest_world, faces.starts, faces.corners)
    return lambda: native.simulation(text, [mesh], threads, colliders)
