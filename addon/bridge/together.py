"""Which cloths are baked together, because they collide with each other."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import bpy

from ..core import joint
from ..core.refusal import Refusal
from . import cache, colliders, fields, registry, settings


def groups(
    cloths: Sequence[bpy.types.Object], scene: bpy.types.Scene
) -> tuple[list[list[bpy.types.Object]], list[str]]:
    """Cloths sorted into groups, and why some that could meet are in different ones.

    Cloths meet if both have Object Collisions on and each is in the other's Collision Collection, if that is set. They are
    baked together if they begin at the same frame, feel the same fields, and their solver settings are the same, but for
    the quality: the finest counts.
    """
    by_name = {obj.name: obj for obj in cloths}
    described, alone = [], []
    for name, obj in by_name.items():
        try:
            described.append(settings.describe(obj, scene, with_groups=False))
        except Refusal:  # its own bake says so
            alone.append(name)

    def meet(one: str, other: str) -> bool:
        pair = by_name[one], by_name[other]
        layers = [registry.layer_of(obj, scene) for obj in pair]
        return layers[0] == layers[1] and colliders.meet(*pair)

    pushed = {name: fields.shared(obj, scene) for name, obj in by_name.items()}
    found = joint.groups(described, meet, pushed)
    together = [*found.together, *([name] for name in alone)]
    return [[by_name[name] for name in group] for group in together], found.apart


def resumed(obj: bpy.types.Object) -> list[bpy.types.Object]:
    """The cloths with which a cloth's bake goes on: those that it was baked together with, and itself.

    Raises:
        Refusal: One of them is gone.
    """
    names = cache.record_of(obj).get("together", {})
    cache.ensure_identity()
    found = {other.boucle.uuid: other for other in registry.local_cloths()}
    for uuid, name in names.items():
        if uuid not in found:
            raise Refusal(
                f'"{obj.name}" was baked together with "{name}", which is gone: bake from the start'
            )
    return in_order({obj, *(found[uuid] for uuid in names)})


def in_order(cloths: Iterable[bpy.types.Object]) -> list[bpy.types.Object]:
    """Cloths in the order of the bake that is to go on, whatever they are called now; by name those of none."""

    def place(obj: bpy.types.Object) -> tuple[int, str]:
        order = cache.record_of(obj).get("order", [])
        return order.index(obj.boucle.uuid) if obj.boucle.uuid in order else len(order), obj.name

    return sorted(cloths, key=place)
