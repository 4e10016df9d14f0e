"""Making an object a cloth and undoing it."""

from __future__ import annotations

import bpy

from . import cache, live, registry, safe_step, slot, target_group


def switch(obj: bpy.types.Object, enabled: bool) -> None:
    """Follow the switch `object.boucle.enabled`: the slot comes and goes with it."""
    registry.forget()
    safe_step.forget()
    if obj.type != "MESH" or obj.library is not None:
        return
    if enabled:
        slot.ensure(obj)
        cache.ensure_identity()
        cache.reattach(obj)
    else:
        live.drop(obj)
        cache.detach(obj)
        slot.remove(obj)
        target_group.remove_if_unused()


def set_range(obj: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Simulate over the scene's frame range."""
    obj.boucle.frame_start = scene.frame_start
    obj.boucle.frame_end = scene.frame_end
