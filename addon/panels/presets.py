"""The popover of presets in the head panel: choose, save, delete."""

from __future__ import annotations

import bpy
from bpy.types import Context, Panel

from .._identifiers import Operators, Panels


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
        """Lay out as Blender's own presets are."""
        settings = context.object.boucle
        layout = self.layout
        layout.emboss = "PULLDOWN_MENU"
        layout.operator_context = "EXEC_DEFAULT"
        column = layout.column(align=True)
        for name in settings.shipped_presets.splitlines():
            column.operator(Operators.APPLY_PRESET, text=name).preset = name
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


CLASSES = (BOUCLE_PT_presets,)
