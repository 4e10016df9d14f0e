"""The settings of a cloth and its scene as plain values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy

from ..core import scene_json
from ..core.scene_json import Groups, World
from . import animation, colliders, pins, shape, tear_settings, vertex_groups, winds

_DATA = frozenset({"POINTER", "COLLECTION"})


def values(obj: bpy.types.Object) -> dict[str, Any]:
    """Every setting by its name, but those that point to Blender's data; vectors as tuples."""
    settings = obj.boucle
    out: dict[str, Any] = {}
    for prop in settings.bl_rna.properties:
        if prop.identifier in {"rna_type", "name"} or prop.is_readonly or prop.type in _DATA:
            continue
        value = getattr(settings, prop.identifier)
        out[prop.identifier] = tuple(value) if getattr(prop, "is_array", False) else value
    return out


def values_at_start(obj: bpy.types.Object) -> dict[str, Any]:
    """Every setting as it is at the cloth's start frame, wherever the scene stands."""
    out = values(obj)
    for name in animation.moving(obj, "boucle."):
        if name in out:
            out[name] = animation.value_at(obj, f"boucle.{name}", obj.boucle.frame_start)
    return out


def is_implicit(integrator: str) -> bool:
    """Whether an integrator is stable at any step."""
    return integrator in scene_json.IMPLICIT


def world(scene: bpy.types.Scene) -> World:
    """Gravity (m/s²) and frames a second of a scene."""
    gravity = tuple(scene.gravity) if scene.use_gravity else (0.0, 0.0, 0.0)
    return World(gravity, scene.render.fps / scene.render.fps_base)


def gravity_moves(scene: bpy.types.Scene) -> bool:
    """Whether the gravity of a scene changes in time."""
    return animation.moves(scene, "gravity") or animation.moves(scene, "use_gravity")


def steady_world(scene: bpy.types.Scene) -> World:
    """The world of a scene, but for a gravity that changes in time: it is told frame by frame."""
    now = world(scene)
    return now._replace(gravity=(0.0, 0.0, 0.0)) if gravity_moves(scene) else now


def groups(obj: bpy.types.Object) -> Groups:
    """The pinned vertices, those in the wind, those that do not collide, and what shapes the cloth.

    Raises:
        Refusal: A group is named that the object does not have.
    """
    settings = obj.boucle
    vertex_groups.require(obj, "Pin Group", settings.pin_group)
    held = pins.painted(obj, settings.pin_group) if settings.pin_group else {}
    wind = _vertices(obj, "Wind Group", settings.wind_group) if settings.use_wind else None
    not_self = not_objects = None
    if settings.self_collision:
        name = settings.self_collision_group
        not_self = _vertices(obj, "Self Collision Vertex Group", name)
    if settings.object_collision:
        name = settings.collision_group
        not_objects = _vertices(obj, "Object Collision Vertex Group", name)
    weights = list(held.values())
    shaped, torn = shape.groups(obj), tear_settings.groups(obj)
    return Groups(list(held), wind, not_self or [], not_objects or [], shaped, weights, torn)


def describe(
    obj: bpy.types.Object,
    scene: bpy.types.Scene,
    with_groups: bool,
    others: Sequence[bpy.types.Object] = (),
    at_start: bool = False,
) -> dict[str, Any]:
    """The scene description of one cloth among its colliders; groups take long to read and may be left out.

    Others are simulated with it: it meets them as cloths, not as colliders. Settings that are animated are those of the
    present frame or, to compare them, those of the start frame.
    """
    found = groups(obj) if with_groups else Groups([], None)
    met = [thing for thing in colliders.find(obj, scene) if thing not in others]
    frame = obj.boucle.frame_start if at_start else None
    things = [colliders.describe(thing, frame) for thing in met]
    given = values_at_start(obj) if at_start else values(obj)
    if obj.boucle.water_object is not None:  # told frame by frame
        given["water_level"] = 0.0 if at_start else winds.level_of(obj, given["water_level"])
    around = steady_world(scene) if at_start else world(scene)
    if animation.moves(obj, "boucle.pin_stiffness"):
        given.pop("pin_stiffness")  # told frame by frame
    meets = any(colliders.meet(obj, other) for other in others if other != obj)
    return scene_json.describe(obj.name, given, around, found, things, meets)


def _vertices(obj: bpy.types.Object, label: str, name: str) -> list[int] | None:
    vertex_groups.require(obj, label, name)
    return vertex_groups.vertices(obj, name) if name else None
