"""Winds and water that are animated: cloths are told of them frame by frame. They stand still from one frame to the next."""

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
        forces = [force for force in description.get("force", []) if force["kind"] == "wind"]
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


class Water:
    """The water of cloths while they are simulated: that of the first, without hold on Blender's data."""

    def __init__(self, cloth: bpy.types.Object, description: dict[str, Any]) -> None:
        """Remember whether it moves."""
        self._key, self._uid = registry.key_of(cloth), cloth.session_uid
        has_water = any(force["kind"] == "water" for force in description.get("force", []))
        paths = ("boucle.water_level", "boucle.water_velocity")
        moves = cloth.boucle.water_object is not None or any(
            animation.moves(cloth, path) for path in paths
        )
        self._moves = has_water and moves

    def sample(self, depsgraph: bpy.types.Depsgraph) -> tuple[float, tuple[float, ...]] | None:
        """Level (m) and current (m/s) at the depsgraph's frame; None where they do not move."""
        obj = registry.by_key(self._key, self._uid) if self._moves else None
        if obj is None:
            return None
        settings = obj.evaluated_get(depsgraph).boucle
        current = tuple(decimal(part) for part in settings.water_velocity)
        return level_of(obj, settings.water_level, depsgraph), current


def level_of(
    obj: bpy.types.Object, level: float, depsgraph: bpy.types.Depsgraph | None = None
) -> float:
    """The height (m) of the water around a cloth: that of its object, where it has one."""
    surface = obj.boucle.water_object
    if surface is None:
        return decimal(level)
    shown = surface if depsgraph is None else surface.evaluated_get(depsgraph)
    return decimal(shown.matrix_world.translation.z)
