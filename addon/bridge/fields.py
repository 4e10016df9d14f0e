"""The force fields that push a cloth: objects with a field, as Blender evaluates them, sampled at every frame.

Blender's own rules: the object is in the view layer and its collection, it is not disabled in viewports, and in the cloth's
effector collection if there is one. A field stands still from one frame to the next.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import bpy

from ..core import fields
from ..core.fields import Field, Forces
from ..core.refusal import Refusal
from . import animation, colliders, registry, sampling, settings

GRAVITY = "gravity"
"""The field weight that scales the scene's gravity."""

_WITHOUT_EFFECT = {"CHARGE": "Charge", "LENNARDJ": "Lennard-Jones", "BOID": "Boid"}
"""Kinds that Blender's cloth does not feel either."""

_UNSUPPORTED = {"TEXTURE": "Texture", "GUIDE": "Curve Guide", "FLUID_FLOW": "Fluid Flow"}

_SHAPES = ("POINT", "LINE", "PLANE")


def find(cloth: bpy.types.Object, scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """The objects whose fields push a cloth, by their names."""
    return [obj for obj in _effectors(cloth, scene) if not _trouble(obj)]


def unsupported(cloth: bpy.types.Object, scene: bpy.types.Scene) -> list[str]:
    """What fields of the scene do not do to a cloth, a sentence each."""
    found = _effectors(cloth, scene)
    sentences = [sentence for sentence in map(_trouble, found) if sentence]
    sentences += [
        f'"{obj.name}": Absorption is not supported: the field acts through colliders'
        for obj in found
        if obj.field.use_absorption and not _trouble(obj)
    ]
    for obj in scene.objects:
        for system in obj.particle_systems:
            settings = system.settings
            both = (settings.force_field_1, settings.force_field_2)
            if any(field is not None and field.type != "NONE" for field in both):
                sentences.append(f'"{obj.name}": fields of particles are not supported')
    return sentences


def record(cloth: bpy.types.Object, scene: bpy.types.Scene) -> dict[str, Any]:
    """What a bake or a live session remembers of fields and weights; of what is animated only that it is there."""
    out: dict[str, Any] = {}
    for obj in find(cloth, scene):
        moves = animation.moves(obj, "field.")
        out[f'force field "{obj.name_full}"'] = None if moves else _plain(_values(obj.field))
    if not animation.moves(cloth, "boucle.field_weights."):
        numbers = _plain(_weights(cloth))
        if out or numbers[GRAVITY] != 1.0:
            out["field weights"] = numbers
    else:
        out["field weights"] = None
    return out


def signature(cloth: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """What must not change of the fields while a cloth moves; what is animated may."""
    uids = [obj.session_uid for obj in find(cloth, scene)]
    return repr((uids, record(cloth, scene)))


def shared(cloth: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """What cloths that are simulated together must have in common: fields, and weights that do not change."""
    own = cloth.name if animation.moves(cloth, "boucle.field_weights.") else ""
    return signature(cloth, scene) + own


class Fields:
    """The fields of one cloth while it is simulated."""

    def __init__(self, cloth: bpy.types.Object, scene: bpy.types.Scene) -> None:
        """Remember which there are, without hold on Blender's data."""
        self._name = cloth.name
        self._cloth = (registry.key_of(cloth), cloth.session_uid)
        self._known = [(registry.key_of(obj), obj.session_uid) for obj in find(cloth, scene)]
        self._is_needed = bool(
            self._known
            or cloth.boucle.field_weights.gravity != 1.0
            or animation.moves(cloth, "boucle.field_weights.gravity")
            or settings.gravity_moves(scene)
        )

    def sample(self, depsgraph: bpy.types.Depsgraph) -> Forces | None:
        """What pushes at the depsgraph's frame; None where there is nothing but the scene's plain gravity.

        Raises:
            Refusal: A field is gone, or has a number that no simulation takes.
        """
        if not self._is_needed:
            return None
        weights = _weights(self._found(self._cloth).evaluated_get(depsgraph))
        scene = depsgraph.scene
        pull = scene.gravity if scene.use_gravity else (0.0, 0.0, 0.0)
        gravity = tuple(part * weights[GRAVITY] for part in pull)
        found = (self._found(known) for known in self._known)
        sampled = [_sample(obj, depsgraph) for obj in found if _acts(obj, depsgraph)]
        return Forces(gravity, fields.encode(sampled, weights))

    def _found(self, known: tuple[tuple[str, str | None], int]) -> bpy.types.Object:
        obj = registry.by_key(*known)
        if obj is None:
            raise Refusal(
                f'the force field "{known[0][0]}" of "{self._name}" is gone: begin anew at the start frame'
            )
        return obj


def _effectors(cloth: bpy.types.Object, scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """The objects of which a cloth would feel the field if it were of a kind that pushes it."""
    # `field` is None on objects that never had the physics: most are passed over at once.
    found = [obj for obj in scene.objects if obj.field is not None and obj.field.type != "NONE"]
    found = [obj for obj in found if obj != cloth]
    wanted = cloth.boucle.field_weights.collection
    if found and wanted is not None:
        inside = set(wanted.all_objects)
        found = [obj for obj in found if obj in inside]
    return colliders.evaluated_for(cloth, scene, found)


def _trouble(obj: bpy.types.Object) -> str:
    """Why a field does not push cloth; empty if it does."""
    field = obj.field
    if field.type in _WITHOUT_EFFECT:
        return f'"{obj.name}": {_WITHOUT_EFFECT[field.type]} fields do not act on cloth, nor do they in Blender'
    if field.type not in fields.KINDS:
        kind = _UNSUPPORTED.get(field.type, field.type.title())
        return f'"{obj.name}": {kind} fields are not supported'
    if field.shape not in _SHAPES:
        shape = "Surface" if field.shape == "SURFACE" else "Every Point"
        return f'"{obj.name}": fields with the shape {shape} are not supported'
    return ""


def _acts(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bool:
    if not sampling.is_evaluated(obj, depsgraph):
        return False
    evaluated = obj.evaluated_get(depsgraph)
    return not evaluated.hide_viewport and evaluated.field.apply_to_location


def _sample(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Field:
    evaluated = obj.evaluated_get(depsgraph)
    matrix = evaluated.matrix_world
    axis = [row[2] for row in matrix][:3]
    return Field(obj.name, _values(evaluated.field), tuple(matrix.translation), axis)


def _values(field: bpy.types.FieldSettings) -> dict[str, Any]:
    return {key: getattr(field, key) for key in (*fields.NUMBERS, *fields.CHOICES)}


def _weights(cloth: bpy.types.Object) -> dict[str, float]:
    weights = cloth.boucle.field_weights
    keys = (GRAVITY, "all", *fields.WEIGHTS.values())
    return {key: getattr(weights, key) for key in keys}


def _plain(values: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers as JSON gives them back."""
    return {
        key: round(value, 6) if isinstance(value, float) else value for key, value in values.items()
    }
