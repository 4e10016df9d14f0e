"""Presets: the named fabrics of the compiled module, the user's own on disk, and the settings that they hold."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy

from .. import native
from ..core import drift, fabric_preset, preset
from ..core.fabric_preset import Row
from ..core.preset import Preset, Schema, Setting
from ..core.refusal import Refusal
from ..core.scene_json import decimal
from . import shape

_PACKAGE = __package__.rpartition(".")[0]


def shipped() -> list[Row]:
    """The named fabrics, group by group; none where the compiled module is missing."""
    return fabric_preset.rows(native.fabric_presets())


def own_names() -> list[str]:
    """The presets that the user saved, in order."""
    folder = _own_folder()
    return sorted(path.stem for path in folder.glob("*" + preset.SUFFIX))


def title(name: str) -> str:
    """What menus call a preset."""
    fabric = native.fabric_presets().get(name)
    return fabric["title"] if fabric is not None else name


def description(name: str) -> str:
    """What is known of a fabric, or what a preset of the user's says of itself; empty if it cannot be read."""
    fabric = native.fabric_presets().get(name)
    if fabric is not None:
        return fabric_preset.sentence(fabric)
    try:
        return preset.description(name, _text(name))
    except Refusal:
        return ""


def apply(obj: bpy.types.Object, name: str) -> None:
    """Give a cloth the settings of a preset; those of which it does not speak stay.

    A fabric gives those of both models, so that the cloth stays what it is where the model is switched.

    Raises:
        Refusal: There is no such preset, or it holds what is not accepted; nothing was set.
    """
    fabric = native.fabric_presets().get(name)
    settings = obj.boucle
    if fabric is None:
        values = preset.parse(name, _text(name), schema(obj)).values
    else:
        springs = native.fabric_springs(name, shape.mean_edge(obj))
        values = fabric_preset.settings(fabric, springs)
        if _is_thickness_of_preset(settings):
            settings.thickness = fabric_preset.thickness(fabric)
    for key, value in values.items():
        setattr(settings, key, value)
    settings.preset = name
    settings.preset_digest = _digest(settings)


def is_changed(obj: bpy.types.Object) -> bool:
    """Whether settings of a cloth were changed since it got a preset."""
    settings = obj.boucle
    return bool(settings.preset) and settings.preset_digest != _digest(settings)


def save(obj: bpy.types.Object, name: str) -> str:
    """Keep a cloth's settings as a preset of the user's and return its name.

    Raises:
        Refusal: The name is not accepted, or the file cannot be written.
    """
    taken = {text for row in shipped() for text in (row.name, row.title)}
    name = preset.checked_name(name, taken, own_names())
    values = {key: _plain(getattr(obj.boucle, key)) for key in schema(obj)}
    path = _own_folder(create=True) / (name + preset.SUFFIX)
    fresh = path.with_name(path.name + ".new")
    try:
        fresh.write_text(preset.write(Preset("", values)), encoding="utf-8")
        os.replace(fresh, path)
    except OSError as error:
        raise Refusal(f'the preset "{name}" cannot be written ({error.strerror})') from error
    return name


def delete(name: str) -> None:
    """Remove a preset of the user's.

    Raises:
        Refusal: It is not the user's, or the file cannot be removed.
    """
    if name not in own_names():
        why = "ships with Boucle and stays" if _is_shipped(name) else "is not there"
        raise Refusal(f'the preset "{name}" {why}: only one of your own can be deleted')
    try:
        (_own_folder() / (name + preset.SUFFIX)).unlink()
    except OSError as error:
        raise Refusal(f'the preset "{name}" cannot be deleted ({error.strerror})') from error


def schema(obj: bpy.types.Object) -> Schema:
    """The settings that a preset holds: every number, switch and choice of the groups marked `in_presets`."""
    rows = obj.boucle.bl_rna.properties
    return {
        name: _setting(rows[name])
        for name in _carried(type(obj.boucle))
        if rows[name].type in {"BOOLEAN", "INT", "FLOAT", "ENUM"}
        and not rows[name].is_readonly
        and not getattr(rows[name], "is_array", False)
    }


def _carried(kind: type) -> Iterator[str]:
    """A group says `in_presets = True` for all of its properties, or names those that belong in one."""
    for group in kind.__mro__:
        marked = vars(group).get("in_presets", ())
        yield from group.__annotations__ if marked is True else marked


def _setting(prop: bpy.types.Property) -> Setting:
    if prop.type == "ENUM":
        return Setting(prop.type, choices=tuple(item.identifier for item in prop.enum_items))
    if prop.type == "BOOLEAN":
        return Setting(prop.type)
    return Setting(prop.type, decimal(prop.hard_min), decimal(prop.hard_max))


def _plain(value: Any) -> Any:
    return decimal(value) if isinstance(value, float) else value


def _is_shipped(name: str) -> bool:
    return name in native.fabric_presets()


def _is_thickness_of_preset(settings: bpy.types.PropertyGroup) -> bool:
    """Whether nobody else has set how thick the cloth is."""
    if not settings.is_property_set("thickness"):
        return True
    before = native.fabric_presets().get(settings.preset)
    return before is not None and math.isclose(
        settings.thickness, fabric_preset.thickness(before), rel_tol=1e-6
    )


def _digest(settings: bpy.types.PropertyGroup) -> str:
    values = [_plain(getattr(settings, name)) for name in fabric_preset.SETTINGS]
    return drift.digest(json.dumps(values).encode())


def _text(name: str) -> str:
    if name not in own_names():
        if native.problem():
            raise Refusal(native.problem())
        known = [row.name for row in shipped()] + own_names()
        raise Refusal(f'there is no preset "{name}": known are {", ".join(known)}')
    try:
        return (_own_folder() / (name + preset.SUFFIX)).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Refusal(f'the preset "{name}" cannot be read ({error}): mend or delete it') from error


def _own_folder(create: bool = False) -> Path:
    """Where extensions keep what is the user's: it outlives an update, their own folder does not."""
    return Path(bpy.utils.extension_path_user(_PACKAGE, path="presets", create=create))
