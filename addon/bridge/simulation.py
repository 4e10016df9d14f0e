"""A solver for cloths, from Blender's data."""

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
    description: dict[str, Any],
    meshes: Sequence[Arrays],
    threads: int = 0,
    colliders: Sequence[Arrays] = (),
    rests: Sequence[Points | None] = (),
) -> Callable[[], Any]:
    """A function that builds the simulation; it holds no Blender data and may run on any thread.

    Args:
        description: The scene description.
        meshes: The meshes of its cloths where they start, in its order.
        threads: 0 takes every core.
        colliders: The meshes of its colliders, in its order.
        rests: Rest positions (m, world space) of its cloths, float64, flat; None for those that they start from.
    """
    text = scene_json.encode(description)
    return lambda: native.simulation(text, meshes, threads, colliders, rests)


def mesh(obj: bpy.types.Object, start_world: Points) -> Arrays:
    """The mesh of a cloth that starts from these positions (m, world space), float64, flat."""
    faces = mesh_arrays.topology(obj.data)
    return start_world, faces.starts, faces.corners
