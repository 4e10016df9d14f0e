"""A solver for cloths, from Blender's data."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import bpy

from .. import native
from ..core import scene_json
from ..core.points import Affine, Points
from . import mesh_arrays, shape, warp
from .colliders import Arrays


class Given(NamedTuple):
    """What the solver is given of one cloth beside its description."""

    mesh: Arrays
    """Where it starts (m, world space)."""
    rest: Points | None
    """Rest positions (m, world space), float64, flat; None for those that it starts from."""
    uvs: Points | None
    """(u, v) of each corner, flat, where the warp follows them."""
    matrix: Affine
    """Object to world space."""


def maker(
    description: dict[str, Any],
    cloths: Sequence[Given],
    threads: int = 0,
    colliders: Sequence[Arrays] = (),
) -> Callable[[], Any]:
    """A function that builds the simulation; it holds no Blender data and may run on any thread.

    Args:
        description: The scene description.
        cloths: What belongs to its cloths, in its order.
        threads: 0 takes every core.
        colliders: The meshes of its colliders, in its order.
    """
    meshes, rests, uvs, matrices = zip(*cloths, strict=True)
    text = scene_json.encode(scene_json.in_world(description, matrices))
    return lambda: native.simulation(text, meshes, threads, colliders, rests, uvs)


def given(obj: bpy.types.Object, start_world: Points, matrix: Affine) -> Given:
    """What the solver is given of a cloth that starts from these positions (m, world space), float64, flat.

    Raises:
        Refusal: A shape key or a UV map is named that the mesh does not have.
    """
    faces = mesh_arrays.topology(obj.data)
    mesh = start_world, faces.starts, faces.corners
    return Given(mesh, shape.rest(obj, matrix), warp.uvs(obj), matrix)
