"""Which properties of an object change in time."""

from __future__ import annotations

from collections.abc import Iterator

import bpy


def moves(obj: bpy.types.Object, path: str) -> bool:
    """Whether a property is keyed or driven, or any property below a path that ends with a dot."""
    data = obj.animation_data
    if data is None:
        return False
    curves = [*data.drivers, *_curves_of(data.action)]
    paths = [curve.data_path for curve in curves]
    return path in paths or (path.endswith(".") and any(one.startswith(path) for one in paths))


def _curves_of(action: bpy.types.Action | None) -> Iterator[bpy.types.FCurve]:
    """All curves of an action: in one list up to Blender 4.5, in layers since 4.4."""
    if action is None:
        return
    if not hasattr(action, "layers"):
        yield from action.fcurves
        return
    for layer in action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                yield from bag.fcurves
