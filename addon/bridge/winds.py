"""Winds whose velocity is animated: cloths are told it frame by frame. A wind stands still from one frame to the next."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy

from ..core.scene_json import decimal
from . import animation, registry

Told = tuple[int, tuple[float, float, float]]
"""The number of a wind among those of the scene description, and its velocity (m/s)."""


class Winds:
    """The winds of cloths while they are simulated, without hold on Blender's data."""

    def __init__(self, cloths: Sequence[bpy.types.Object], description: dict[str, Any]) -> None:
        """Remember which of the description's winds blow as an animation says; each cloth has one or none."""
        first = cloths[0].name
        forces = description.get("force", [])
        blowing = [force.get("region", {}).get("cloth", first) for force in forces]
        self._moving = [
            (blowing.index(obj.name), registry.key_of(obj), obj.session_uid)
            for obj in cloths
            if obj.name in blowing and animation.moves(obj, "boucle.wind_velocity")
        ]

    def sample(self, depsgraph: bpy.types.Depsgraph) -> tuple[Told, ...]:
        """What those winds are at the depsgraph's frame."""
        told = []
        for number, key, uid in self._moving:
            obj = registry.by_key(key, uid)
            if obj is not None:
                velocity = obj.evaluated_get(depsgraph).boucle.wind_velocity
                told.append((number, tuple(decimal(part) for part in velocity)))
        return tuple(told)
