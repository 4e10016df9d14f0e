"""Making an object a cloth and undoing it."""

from __future__ import annotations

import bpy

from . import (
    cache,
    live,
    overlay_view,
    registry,
    safe_step,
    slot,
    target_group,
    tear_groups,
    thickness_view,
)


def switch(obj: bpy.types.Object, enabled: bool) -> None:
    """Follow the switch `object.boucle.enabled`: the slot comes and goes with it."""
    registry.forget()
    safe_step.forget()
    if obj.type != "MESH" or obj.library is not None:
        return
    if enabled:
        store_groups(obj)
        slot.ensure(obj)
        cache.ensure_identity()
        cache.reattach(obj)
    else:
        live.drop(obj)
        cache.detach(obj)
        slot.remove(obj)
        target_group.remove_if_unused()
        tear_groups.remove_unused()
    overlay_view.follow()
    thickness_view.follow()


def store_groups(obj: bpy.types.Object) -> None:
    """Write a value into each group among the settings that holds none yet.

    From Blender 5.0 on a file that links the cloth would lose what it overrides in a group of which nothing is stored.
    """
    settings = obj.boucle
    for prop in settings.bl_rna.properties:
        if prop.type != "POINTER" or settings.is_property_set(prop.identifier):
            continue
        group = getattr(settings, prop.identifier)
        if isinstance(group, bpy.types.PropertyGroup):
            names = [p.identifier for p in group.bl_rna.properties if p.type == "FLOAT"]
            for name in names[:1]:
                setattr(group, name, getattr(group, name))


def set_range(obj: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Simulate over the scene's frame range."""
    obj.boucle.frame_start = scene.frame_start
    obj.boucle.frame_end = scene.frame_end
