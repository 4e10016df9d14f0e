"""What a cloth collides with: objects whose Collision modifier is on, as Blender evaluates them.

Blender's own rules: the object is in the view layer and its collection, and it is not disabled in viewports (an object that
is only hidden by its eye is evaluated and counts). Its modifiers all count, also those below Collision: the cloth meets the
mesh that is seen.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import bpy

from ..core import points
from ..core.points import Points
from ..core.refusal import Refusal
from ..core.scene_json import CollisionObject
from . import animation, mesh_arrays, registry, sampling

Arrays = tuple[Points, Points, Points]
"""Positions (m, world space), float64, flat; first corner of each face; vertex of each corner."""


def meet(one: bpy.types.Object, other: bpy.types.Object) -> bool:
    """Whether two cloths that are simulated together collide: if both collide with objects, and with this one."""
    for cloth, thing in ((one, other), (other, one)):
        wanted = cloth.boucle.collision_collection
        if not cloth.boucle.object_collision:
            return False
        if wanted is not None and thing not in set(wanted.all_objects):
            return False
    return True


def find(cloth: bpy.types.Object, scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """The objects that a cloth collides with, by their names."""
    settings = cloth.boucle
    if not settings.object_collision:
        return []
    # `collision` is None on objects that never had the physics: most are passed over without a look at their modifiers.
    found = [obj for obj in scene.objects if obj.collision is not None and _is_on(obj)]
    found = [obj for obj in found if obj != cloth]
    wanted = settings.collision_collection
    if found and wanted is not None:
        inside = set(wanted.all_objects)
        found = [obj for obj in found if obj in inside]
    return evaluated_for(cloth, scene, found)


def evaluated_for(
    cloth: bpy.types.Object, scene: bpy.types.Scene, found: list[bpy.types.Object]
) -> list[bpy.types.Object]:
    """Those of some objects that Blender evaluates in the view layer of a cloth, by their names."""
    if not found:
        return []
    layer = registry.layer_of(cloth, scene)
    in_layer, enabled = set(layer.objects), set(_enabled(layer.layer_collection))
    found = [obj for obj in found if obj in in_layer and not obj.hide_viewport]
    found = [obj for obj in found if enabled.intersection(obj.users_collection)]
    return sorted(found, key=lambda obj: obj.name_full)


def describe(obj: bpy.types.Object, frame: int | None = None) -> CollisionObject:
    """An object's Collision physics as the scene description takes it: now, or as it is at a frame."""
    settings = obj.collision
    if frame is None:
        return CollisionObject(obj.name_full, settings.thickness_outer, settings.cloth_friction)
    numbers = (
        animation.value_at(obj, f"collision.{name}", frame)
        for name in ("thickness_outer", "cloth_friction")
    )
    return CollisionObject(obj.name_full, *numbers)


def signature(cloth: bpy.types.Object, scene: bpy.types.Scene) -> tuple[object, ...]:
    """What must not change of the colliders while a cloth moves; numbers that are animated may."""
    return tuple(
        (obj.session_uid, None if animation.moves(obj, "collision.") else describe(obj))
        for obj in find(cloth, scene)
    )


def _is_on(obj: bpy.types.Object) -> bool:
    return any(
        modifier.type == "COLLISION" and modifier.show_viewport for modifier in obj.modifiers
    )


def _enabled(layer: bpy.types.LayerCollection) -> Iterator[bpy.types.Collection]:
    """The collections of a view layer that are not disabled in viewports."""
    if layer.collection.hide_viewport:
        return
    if not layer.exclude:
        yield layer.collection
    for child in layer.children:
        yield from _enabled(child)


@dataclass(frozen=True)
class _Known:
    """One collider, without hold on Blender's data."""

    key: tuple[str, str | None]
    uid: int
    vertex_count: int
    cloth: str
    """The name of a cloth that meets it."""


class Colliders:
    """The colliders of cloths while they are simulated, in the order of their scene description: by name."""

    def __init__(
        self,
        cloths: Sequence[bpy.types.Object],
        scene: bpy.types.Scene,
        depsgraph: bpy.types.Depsgraph,
    ) -> None:
        """Look at them at the start frame.

        Raises:
            Refusal: One of them is not evaluated.
        """
        self._known: list[_Known] = []
        self.arrays: list[Arrays] = []
        """Their meshes at the start frame, for the solver."""
        met = {obj: cloth.name for cloth in reversed(cloths) for obj in find(cloth, scene)}
        for obj in sorted(met.keys() - set(cloths), key=lambda obj: obj.name_full):
            evaluated = self._evaluated(obj, depsgraph, met[obj])
            faces = mesh_arrays.topology(evaluated.data)
            self.arrays.append((_positions(evaluated), faces.starts, faces.corners))
            count = len(evaluated.data.vertices)
            known = _Known(registry.key_of(obj), obj.session_uid, count, met[obj])
            self._known.append(known)

    def targets(self, depsgraph: bpy.types.Depsgraph) -> list[Points]:
        """Where the points of each stand at the depsgraph's frame (m, world space).

        Raises:
            Refusal: One of them is gone, not evaluated, or has other vertices than at the start.
        """
        return [self._target(known, depsgraph) for known in self._known]

    def _target(self, known: _Known, depsgraph: bpy.types.Depsgraph) -> Points:
        obj = registry.by_key(known.key, known.uid)
        if obj is None:
            raise Refusal(
                f'the collider "{known.key[0]}" of "{known.cloth}" is gone: begin anew at the '
                "start frame"
            )
        evaluated = self._evaluated(obj, depsgraph, known.cloth)
        count = len(evaluated.data.vertices)
        if count != known.vertex_count:
            raise Refusal(
                f'the collider "{obj.name}" of "{known.cloth}" has {count} vertices at frame '
                f"{depsgraph.scene.frame_current} and {known.vertex_count} at the start: switch off "
                "its modifiers that add or remove vertices in time, or its Collision modifier"
            )
        return _positions(evaluated)

    @staticmethod
    def _evaluated(
        obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, cloth: str
    ) -> bpy.types.Object:
        if sampling.is_evaluated(obj, depsgraph):
            return obj.evaluated_get(depsgraph)
        if depsgraph.mode == "RENDER":
            cure = "bake before you render, or enable it in renders"
        else:
            cure = "enable it in viewports at every frame, or switch its Collision modifier off"
        raise Refusal(
            f'the collider "{obj.name}" of "{cloth}" is not evaluated at frame '
            f"{depsgraph.scene.frame_current}: {cure}"
        )


def _positions(evaluated: bpy.types.Object) -> Points:
    local = mesh_arrays.read_positions(evaluated.data)
    return points.transform(local, mesh_arrays.world_matrix(evaluated), "d")
