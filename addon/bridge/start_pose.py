"""What a cloth and its colliders are at its start frame, for questions that are asked at any other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import bpy

from ..core import points
from . import registry, runtime, sampling, settings, simulation
from .colliders import Arrays, Colliders
from .simulation import Given


class Start(NamedTuple):
    """A scene description and the meshes that belong to it."""

    description: dict[str, Any]
    given: Given
    """What belongs to the cloth."""
    colliders: Sequence[Arrays]


def sample(obj: bpy.types.Object, scene: bpy.types.Scene) -> Start:
    """Look at the start frame; the scene comes back to where it stands.

    Raises:
        Refusal: The settings contradict each other, or something is not evaluated.
    """
    with _standing_at(scene, obj.boucle.frame_start):
        depsgraph = registry.depsgraph_of(obj, scene)
        description = settings.describe(obj, scene, with_groups=True)
        matrix = sampling.object_matrix(obj, depsgraph)
        world = points.transform(sampling.targets(obj, depsgraph), matrix, "d")
        met = Colliders([obj], scene, depsgraph)
        return Start(description, simulation.given(obj, world, matrix), met.arrays)


@contextmanager
def _standing_at(scene: bpy.types.Scene, frame: int) -> Iterator[None]:
    """The scene at a frame, with live mode still; back where it was after."""
    was = scene.frame_current, scene.frame_subframe
    if was == (frame, 0.0):
        yield
        return
    runtime.busy.add("check")
    try:
        scene.frame_set(frame)
        yield
    finally:
        scene.frame_set(was[0], subframe=was[1])
        runtime.busy.discard("check")
