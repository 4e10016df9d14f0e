"""The takes of a cloth."""

from __future__ import annotations

import bpy
from bpy.types import Context, Panel, UIList

from .._identifiers import Lists, Operators, PanelOrder, Panels
from .cloth import PhysicsPanel, draw_text


class BOUCLE_UL_takes(UIList):
    """One take a row"""

    bl_idname = Lists.TAKES

    def draw_item(
        self,
        _context: Context,
        layout: bpy.types.UILayout,
        _data: object,
        item: bpy.types.PropertyGroup,
        _icon: int,
        _active_data: object,
        _active_property: str,
        _index: int = 0,
    ) -> None:
        """Lay out."""
        row = layout.row()
        row.prop(item, "name", text="", emboss=False)
        row.label(text=item.date)


class BOUCLE_PT_takes(PhysicsPanel, Panel):
    """Results that are kept under a name"""

    bl_idname = Panels.TAKES
    bl_parent_id = Panels.CACHE
    bl_label = "Takes"
    bl_order = PanelOrder.TAKES
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings, layout = context.object.boucle, self.layout
        row = layout.row()
        row.template_list(Lists.TAKES, "", settings, "takes", settings, "take_index", rows=3)
        side = row.column(align=True)
        side.operator(Operators.ADD_TAKE, text="", icon="ADD")
        side.operator(Operators.REMOVE_TAKE, text="", icon="REMOVE")
        if not settings.takes:
            return
        if settings.take_index < len(settings.takes):
            layout.prop(settings.takes[settings.take_index], "note", text="")
        row = layout.row(align=True)
        row.operator(Operators.RESTORE_TAKE).with_settings = True
        row.operator(Operators.RESTORE_TAKE, text="Cache Only").with_settings = False
        row.operator(Operators.COMPARE_TAKE)
        for line in filter(None, settings.take_comparison.split("\n")):
            draw_text(layout, line, context)


CLASSES = (BOUCLE_UL_takes, BOUCLE_PT_takes)
