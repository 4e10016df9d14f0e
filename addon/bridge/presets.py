"""Presets on disk: those that ship with the extension and the user's own, and the settings that they hold."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy

from ..core import preset
from ..core.preset import Preset, Schema, Setting
from ..core.refusal import Refusal
from ..core.scene_json import decimal

_PACKAGE = __package__.rpartition(".")[0]
_SHIPPED = Path(__file__).parents[1] / "presets"


def shipped_names() -> list[str]:
    """The presets of the extension, in order."""
    return _names(_SHIPPED)


def own_names() -> list[str]:
    """The presets that the user saved, in order."""
    return _names(_own_folder())


def description(name: str) -> str:
    """What a preset says of itself; empty if it cannot be read."""
    try:
        return preset.description(name, _text(name))
    except Refusal:
        return ""


def apply(obj: bpy.types.Object, name: str) -> None:
    """Give a cloth the settings of a preset; those of which it does not speak stay.

    Raises:
        Refusal: There is no such preset, or it holds what is not accepted; nothing was set.
    """
    for key, value in preset.parse(name, _text(name), schema(obj)).values.items():
        setattr(obj.boucle, key, value)


def save(obj: bpy.types.Object, name: str) -> str:
    """Keep a cloth's settings as a preset of the user's and return its name.

    Raises:
        Refusal: The name is not accepted, or the file cannot be written.
    """
    name = preset.checked_name(name, shipped_names(), own_names())
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
        why = "ships with Boucle and stays" if name in shipped_names() else "is not there"
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


def _text(name: str) -> str:
    if name in shipped_names():
        folder = _SHIPPED
    elif name in own_names():
        folder = _own_folder()
    else:
        there = ", ".join(f'"{one}"' for one in (*shipped_names(), *own_names()))
        raise Refusal(f'there is no preset "{name}": known are {there}')
    try:
        return (folder / (name + preset.SUFFIX)).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Refusal(f'the preset "{name}" cannot be read ({error}): mend or delete it') from error


def _own_folder(create: bool = False) -> Path:
    """Where extensions keep what is the user's: it outlives an update, their own folder does not."""
    return Path(bpy.utils.extension_path_user(_PACKAGE, path="presets", create=create))


def _names(folder: Path) -> list[str]:
    return sorted(path.stem for path in folder.glob("*" + preset.SUFFIX))
