"""The settings of a cloth as a take keeps them: plain values, groups of settings within, and collections by their names."""

from __future__ import annotations

import json
from typing import Any

import bpy

from ..core import quantity
from ..core.refusal import Refusal

_NOT_KEPT = frozenset({
    "enabled", "uuid", "bake_record", "take_index", "show_thickness", "use_live", "overlay", "overlay_range",
    "overlay_minimum", "overlay_maximum", "overlay_opacity", "bend_warp_micro", "bend_weft_micro",
    *(f"use_{one.key}" for one in quantity.ALL),
})  # fmt: skip
"""Settings that are not of the simulation."""
_DAMAGES = (
    AttributeError,
    IndexError,
    KeyError,
    OverflowError,
    RecursionError,
    TypeError,
    ValueError,
)
"""What Python and Blender say of values of the wrong kind."""


def keep(settings: bpy.types.PropertyGroup) -> str:
    """All settings that make the motion, as JSON."""
    return json.dumps(_plain(settings))


def give(settings: bpy.types.PropertyGroup, kept: str, take: str) -> list[str]:
    """Give a cloth the settings of a take; those that this version does not have are left. The collections that are gone.

    Raises:
        Refusal: The text is not what `keep` wrote; nothing is changed then.
    """
    before = _plain(settings)
    try:
        values = json.loads(kept or "{}")
        if not isinstance(values, dict):
            raise TypeError("accepted: a table")
        return _set(settings, values)
    except _DAMAGES as error:
        _set(settings, before)
        raise Refusal(f'the settings of the take "{take}" are damaged: {error}') from error


def _plain(settings: bpy.types.PropertyGroup) -> dict[str, Any]:
    out: dict[str, Any] = {}
    for prop in settings.bl_rna.properties:
        name = prop.identifier
        if name in {"rna_type", "name"} | _NOT_KEPT or prop.type == "COLLECTION":
            continue
        value = getattr(settings, name)
        if _is_group(prop):
            out[name] = _plain(value)
        elif prop.is_readonly:
            continue
        elif prop.type == "POINTER":
            out[name] = _name_of(value)
        else:
            out[name] = tuple(value) if getattr(prop, "is_array", False) else value
    return out


def _set(settings: bpy.types.PropertyGroup, values: dict[str, Any]) -> list[str]:
    gone = []
    now = _plain(settings)
    for name, value in values.items():
        if name not in now:
            continue
        prop = settings.bl_rna.properties[name]
        if _is_group(prop):
            gone += _set(getattr(settings, name), value)
        elif prop.type == "POINTER":
            found = bpy.data.collections.get(tuple(value)) if value else None
            if value and found is None:
                gone.append(value[0])
            elif getattr(settings, name) != found:
                setattr(settings, name, found)
        else:
            value = tuple(value) if isinstance(value, list) else value
            if now[name] != value:
                setattr(settings, name, value)
    return gone


def _is_group(prop: bpy.types.Property) -> bool:
    return prop.type == "POINTER" and prop.fixed_type.base is not None and (
        prop.fixed_type.base.identifier == "PropertyGroup"
    )  # fmt: skip


def _name_of(data: bpy.types.ID | None) -> tuple[str, str | None] | None:
    """By what Blender finds a collection: its name and library."""
    if data is None:
        return None
    return data.name, data.library.filepath if data.library else None
