"""The presets that there are, and which one the cloth got last."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, StringProperty

from .changes import FIXED, OVERRIDABLE


def _read_shipped(_settings: object) -> str:
    from ..bridge import presets

    return "\n".join("\t".join(row) for row in presets.shipped())


def _read_own(_settings: object) -> str:
    from ..bridge import presets

    return "\n".join(presets.own_names())


def _read_title(settings: bpy.types.PropertyGroup) -> str:
    from ..bridge import presets

    return presets.title(settings.preset)


def _read_is_changed(settings: bpy.types.PropertyGroup) -> bool:
    from ..bridge import presets

    return presets.is_changed(settings.id_data)


class PresetProperties:
    """What presets there are. A group whose settings they hold says so by `in_presets`."""

    shipped_presets: StringProperty(
        name="Shipped Presets",
        description="The presets that come with Boucle, one a line: name, group and title, with tabs between them",
        get=_read_shipped, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    own_presets: StringProperty(
        name="Own Presets",
        description="Names of the presets that were saved here, one a line",
        get=_read_own, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    preset: StringProperty(
        name="Preset",
        description="Name of the preset that the cloth got last",
        default="", options={"HIDDEN"}, override=OVERRIDABLE,
    )  # fmt: skip
    preset_digest: StringProperty(
        name="Preset Digest",
        description="A digest of the settings as the preset left them",
        default="", options={"HIDDEN"}, override=OVERRIDABLE,
    )  # fmt: skip
    preset_title: StringProperty(
        name="Preset Title",
        description="What menus call the preset that the cloth got last; empty if there is none",
        get=_read_title, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
    is_preset_changed: BoolProperty(
        name="Is Preset Changed",
        description="Whether settings were changed since the cloth got its preset",
        get=_read_is_changed, options=FIXED, override=OVERRIDABLE,
    )  # fmt: skip
