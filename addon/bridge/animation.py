"""Which properties change in time, and what they are at a frame at which the scene does not stand."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from typing import Any

import bpy

from ..core import drift


def moves(owner: bpy.types.ID, path: str) -> bool:
    """Whether a property is keyed, driven or in an NLA strip, or any property below a path that ends with a dot."""
    if owner.animation_data is None:
        return False
    paths = {curve.data_path for curve in _curves(owner.animation_data)}
    return path in paths or (path.endswith(".") and any(one.startswith(path) for one in paths))


def moving(owner: bpy.types.ID, path: str) -> list[str]:
    """The names of the properties right below a path that ends with a dot which change in time, in order."""
    if owner.animation_data is None:
        return []
    paths = {curve.data_path for curve in _curves(owner.animation_data)}
    names = {one.removeprefix(path) for one in paths if one.startswith(path)}
    return sorted(name for name in names if "." not in name)


def value_at(owner: bpy.types.ID, path: str, frame: float) -> Any:
    """What a property is at a frame, wherever the scene stands; vectors as tuples.

    Of one that a driver or a strip moves only Blender can tell it, where the scene stands: it is told as its default.
    """
    holder, _, name = path.rpartition(".")
    place = owner.path_resolve(holder) if holder else owner
    prop = place.bl_rna.properties[name]
    value, is_array = getattr(place, name), getattr(prop, "is_array", False)
    numbers = list(value) if is_array else [value]
    if prop.type == "FLOAT" and moves(owner, path):
        data = owner.animation_data
        others = [*data.drivers, *_curves_of_strips(data)]
        if any(curve.data_path == path for curve in others):
            numbers = list(prop.default_array) if is_array else [prop.default]
        else:
            for curve in _keyed(data):
                if curve.data_path == path and not curve.mute:
                    number = min(max(curve.evaluate(frame), prop.hard_min), prop.hard_max)
                    numbers[curve.array_index] = number
    return tuple(numbers) if is_array else numbers[0]


def keys(owner: bpy.types.ID, path: str) -> str:
    """A digest of how a property changes in time, by which a changed key is noticed."""
    found = []
    for curve in _curves(owner.animation_data):
        if curve.data_path == path:
            found.append(
                repr((curve.array_index, curve.extrapolation, len(curve.modifiers))).encode()
            )
            found += _numbers(curve.keyframe_points)
            if curve.driver is not None:
                found.append(f"{curve.driver.type} {curve.driver.expression}".encode())
    return drift.digest(*found)


def _numbers(points: bpy.types.FCurveKeyframePoints) -> Iterator[bytes]:
    for name in ("co", "handle_left", "handle_right"):
        numbers = array("f", bytes(8 * len(points)))
        points.foreach_get(name, numbers)
        yield numbers.tobytes()
    kinds = array("i", bytes(4 * len(points)))
    points.foreach_get("interpolation", kinds)
    yield kinds.tobytes()


def _curves(data: bpy.types.AnimData) -> Iterator[bpy.types.FCurve]:
    """Everything that moves a property, but what is muted."""
    found = (*data.drivers, *_keyed(data), *_curves_of_strips(data))
    yield from (curve for curve in found if not curve.mute)


def _keyed(data: bpy.types.AnimData) -> Iterator[bpy.types.FCurve]:
    if data.action is not None:
        yield from _curves_of(data.action, getattr(data, "action_slot", None))


def _curves_of_strips(data: bpy.types.AnimData) -> Iterator[bpy.types.FCurve]:
    tracks = data.nla_tracks if data.use_nla else ()
    for track in tracks:
        for strip in () if track.mute else track.strips:
            if strip.action is not None and not strip.mute:
                yield from _curves_of(strip.action, getattr(strip, "action_slot", None))


def _curves_of(
    action: bpy.types.Action, slot: bpy.types.bpy_struct | None
) -> Iterator[bpy.types.FCurve]:
    """The curves of an action: all in one list up to Blender 4.3, those of a slot in layers since 4.4."""
    if not hasattr(action, "layers"):
        yield from action.fcurves
        return
    for layer in action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                if slot is not None and bag.slot_handle == slot.handle:
                    yield from bag.fcurves
