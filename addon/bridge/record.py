"""What a bake remembers of a cloth, and what it would remember now: both made here, so that they can be compared.

Neither depends on the frame at which the scene stands. Of an animated setting that is taken once the value at the start frame
is remembered; of one that is followed from frame to frame, its keys.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import bpy

from ..core import drift
from . import animation, colliders, fields, mesh_arrays, pins, settings, shape, warp

FOLLOWED = (
    "pin_strength", "pin_stiffness", *shape.SHRINK, *shape.PRESSURE, "wind_velocity",
    "water_level", "water_velocity",
)  # fmt: skip
"""Settings that are followed where they are animated. All others are taken once, at the start frame."""
_USED_WITH = {
    "pin_strength": "pin_group", "pin_stiffness": "pin_group", "wind_velocity": "use_wind",
    **dict.fromkeys(shape.PRESSURE, "use_pressure"),
    **dict.fromkeys(("water_level", "water_velocity"), "use_water"),
}  # fmt: skip
"""Without what some of them make no difference."""


def of(
    obj: bpy.types.Object,
    scene: bpy.types.Scene,
    others: Sequence[bpy.types.Object] = (),
    in_full: bool = True,
) -> dict[str, Any]:
    """What a bake remembers of a cloth that is simulated with others.

    The vertices of groups and the digest of its faces take long and may be left out.

    Raises:
        Refusal: The settings contradict each other.
    """
    mesh, others = obj.data, [other for other in others if other != obj]
    description = settings.describe(obj, scene, in_full, others, at_start=True)
    faces = mesh_arrays.topology(mesh).digest() if in_full else ""
    steady = shape.steady(obj, description)
    made = drift.record(steady, len(mesh.vertices), faces, fields.record(obj, scene))
    map_ = warp.uvs(obj) if in_full else None
    if map_ is not None:
        made["settings"]["cloth.fabric.uv"] = drift.digest(map_)
    if obj.boucle.use_water and obj.boucle.water_object is not None:
        made["settings"]["water surface"] = _surface(obj.boucle.water_object)
    strength = pins.constant_strength(obj)
    if strength < 1.0:
        made["settings"]["cloth.pin_strength"] = strength
    if others:
        met = (other.boucle.uuid for other in others if colliders.meet(obj, other))
        made["settings"]["cloths met"] = sorted(met)
    made["settings"].update(_keys(obj, scene))
    return made


def _surface(surface: bpy.types.Object) -> list[Any]:
    """The object at which water has its surface, and its height, if nothing moves it."""
    moves = surface.animation_data or surface.parent or surface.constraints
    return [surface.name] if moves else [surface.name, round(surface.location.z, 6)]


def _keys(obj: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[tuple[str, str]]:
    """Digests of the keys of what is followed, by what it is called."""
    for name in FOLLOWED:
        if not getattr(obj.boucle, _USED_WITH.get(name, "enabled")):
            continue
        if animation.moves(obj, f"boucle.{name}"):
            yield f"keys of {name.replace('_', ' ')}", animation.keys(obj, f"boucle.{name}")
    for name in ("gravity", "use_gravity"):
        if animation.moves(scene, name):
            yield f"keys of {name.replace('_', ' ')}", animation.keys(scene, name)
