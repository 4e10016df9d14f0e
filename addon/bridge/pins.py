"""How firmly the pins of a cloth are held: painted in its Pin Group, weakened and stiffened by animated properties."""

from __future__ import annotations

from typing import Any

import bpy

from ..core import points, scene_json
from ..core.bake import Hold
from . import animation, vertex_groups

HARD = 0.999
"""From this weight on a vertex is held firmly, as in Blender's own cloth."""


def painted(obj: bpy.types.Object, name: str) -> dict[int, float]:
    """The pins of a vertex group by vertex, in order: weights above 0, of which the highest are 1."""
    found = vertex_groups.weights(obj, name)
    return {vertex: 1.0 if weight >= HARD else weight for vertex, weight in found.items()}


def constant_strength(obj: bpy.types.Object) -> float:
    """The part of the painted weights that counts, where it does not change in time; 1 otherwise."""
    return 1.0 if animation.moves(obj, "boucle.pin_strength") else obj.boucle.pin_strength


class Pins:
    """The painted weights of one cloth, and what its solver was last told of them."""

    def __init__(self, description: dict[str, Any], cloth: int, vertex_count: int) -> None:
        """Take the weights that a scene description gives to the vertices of a cloth."""
        pins = description["cloth"][cloth].get("pins")
        self.are_there = bool(pins)
        self._told: tuple[float, float] | None = None
        self._painted = points.empty("d", vertex_count if pins else 0)
        if pins:
            weights = pins.get("weights") or [1.0] * len(pins["vertices"])
            for vertex, weight in zip(pins["vertices"], weights, strict=True):
                self._painted[vertex] = weight

    def change(self, obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Hold | None:
        """What the properties say at the depsgraph's frame, if that is not what they said before."""
        if not self.are_there:
            return None
        settings = obj.evaluated_get(depsgraph).boucle
        strength = settings.pin_strength
        told = (strength, scene_json.decimal(settings.pin_stiffness))
        if told == self._told:
            return None
        self._told = told
        return Hold(points.scaled(self._painted, strength), told[1])
