"""The settings of a cloth and its scene as plain values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy

from ..core import drift, scene_json
from ..core.scene_json import Groups, World
from . import animation, colliders, mesh_arrays, pins, shape, vertex_groups

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


def is_implicit(integrator: str) -> bool:
    """Whether an integrator is stable at any step."""
    return integrator in scene_json.IMPLICIT


def world(scene: bpy.types.Scene) -> World:
    """Gravity (m/s²) and frames a second of a scene."""
    gravity = tuple(scene.gravity) if scene.use_gravity else (0.0, 0.0, 0.0)
    return World(gravity, scene.render.fps / scene.render.fps_base)


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
    return Groups(list(held), wind, not_self or [], not_objects or [], shape.groups(obj), weights)


def describe(
    obj: bpy.types.Object,
    scene: bpy.types.Scene,
    with_groups: bool,
    others: Sequence[bpy.types.Object] = (),
) -> dict[str, Any]:
    """The scene description of one cloth among its colliders; groups take long to read and may be left out.

    Others are simulated with it: it meets them as cloths, not as colliders.
    """
    found = groups(obj) if with_groups else Groups([], None)
    met = [thing for thing in colliders.find(obj, scene) if thing not in others]
    things = [colliders.describe(thing) for thing in met]
    given = values(obj)
    if animation.moves(obj, "boucle.pin_stiffness"):
        given.pop("pin_stiffness")  # told frame by frame
    return scene_json.describe(obj.name, given, world(scene), found, things, bool(others))


def record(
    obj: bpy.types.Object,
    description: dict[str, Any],
    fields: dict[str, Any],
    with_faces: bool = True,
) -> dict[str, Any]:
    """What a bake with this description and these force fields remembers of its cloth.

    The digest of its faces takes long and may be left out.
    """
    mesh = obj.data
    faces = mesh_arrays.topology(mesh).digest() if with_faces else ""
    description = shape.steady(obj, description)
    made = drift.record(description, len(mesh.vertices), faces, fields)
    strength = pins.constant_strength(obj)
    if strength < 1.0:
        made["settings"]["cloth.pin_strength"] = strength
    return made


def _vertices(obj: bpy.types.Object, label: str, name: str) -> list[int] | None:
    vertex_groups.require(obj, label, name)
    return vertex_groups.vertices(obj, name) if name else None
