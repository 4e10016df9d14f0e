"""The presets: a menu of all in the head panel, and a popover in its header that also saves and deletes one's own."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface
from bpy.types import Context, Menu, Panel

from .._identifiers import Menus, Operators, Panels

_COLUMNS = 4
"""Of the menu: with fewer it is higher than a small screen."""


class BOUCLE_MT_presets(Menu):
    """Fabrics by their groups, then one's own presets; type to search"""

    bl_idname = Menus.PRESETS
    bl_label = "Presets"
    bl_options = {"SEARCH_ON_KEY_PRESS"}

    def draw(self, context: Context) -> None:
        """Lay out in columns of about the same height."""
        settings = context.object.boucle
        groups: dict[str, list[tuple[str, str]]] = {}
        for line in settings.shipped_presets.splitlines():
            name, group, title = line.split("\t")
            groups.setdefault(group, []).append((name, title))
        self.layout.operator_context = "EXEC_DEFAULT"
        row = self.layout.row()
        height = sum(len(group) + 2 for group in groups.values()) / _COLUMNS
        column, filled = row.column(), 0.0
        for group, presets in groups.items():
            if filled and filled + 0.5 * len(presets) > height:
                column, filled = row.column(), 0.0
            filled += len(presets) + 2
            column.label(text=group)
            for name, title in presets:
                column.operator(Operators.APPLY_PRESET, text=title).preset = name
            column.separator()
        own = settings.own_presets.splitlines()
        if own:
            column = row.column()
            column.label(text="Own Presets")
        for name in own:
            column.operator(Operators.APPLY_PRESET, text=name, translate=False).preset = name


class BOUCLE_PT_presets(Panel):
    """Presets of the cloth"""

    bl_idname = Panels.PRESETS
    bl_space_type = "PROPERTIES"
    bl_region_type = "HEADER"
    bl_label = "Boucle Cloth Presets"

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only for a Boucle cloth."""
        obj = context.object
        return obj is not None and obj.type == "MESH" and obj.boucle.enabled

    def draw(self, context: Context) -> None:
        """Lay out as Blender's own presets are, but for the fabrics: they are too many for one column."""
        settings = context.object.boucle
        layout = self.layout
        layout.menu(Menus.PRESETS, text="Fabrics")
        layout.emboss = "PULLDOWN_MENU"
        layout.operator_context = "EXEC_DEFAULT"
        column = layout.column(align=True)
        for name in settings.own_presets.splitlines():
            row = column.row(align=True)
            row.operator(Operators.APPLY_PRESET, text=name, translate=False).preset = name
            row.operator(Operators.DELETE_PRESET, text="", icon="REMOVE").preset = name
        layout.separator()
        row = layout.row()
        field = row.row()
        field.emboss = "NORMAL"
        manager = context.window_manager or bpy.data.window_managers[0]
        field.prop(manager, "preset_name", text="")
        row.operator(Operators.SAVE_PRESET, text="", icon="ADD").preset = manager.preset_name


def draw_popover(layout: bpy.types.UILayout) -> None:
    """The button in a panel's header."""
    layout.emboss = "NONE"
    layout.popover(panel=Panels.PRESETS, icon="PRESET", text="")


def draw_choice(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    """The menu, called by the preset that the cloth got last; a star says that settings were changed since."""
    row = layout.row()
    split = row.split(factor=0.4)
    row.separator(factor=2.0)  # where other rows have a dot to set keys
    label = split.row()
    label.alignment = "RIGHT"
    label.label(text="Preset")
    title = settings.preset_title
    text = pgettext_iface(title if title else "Choose...")
    split.menu(Menus.PRESETS, text=f"* {text}" if settings.is_preset_changed else text)


CLASSES = (BOUCLE_MT_presets, BOUCLE_PT_presets)
