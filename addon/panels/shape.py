"""Pins."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import PanelOrder, Panels
from .cloth import PhysicsPanel


class BOUCLE_PT_shape(PhysicsPanel, Panel):
    """Where the cloth is held"""

    bl_idname = Panels.SHAPE
    bl_parent_id = Panels.CLOTH
    bl_label = "Shape"
    bl_order = PanelOrder.SHAPE
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Lay out."""
        obj = context.object
        self.column(obj.boucle).prop_search(obj.boucle, "pin_group", obj, "vertex_groups")


CLASSES = (BOUCLE_PT_shape,)
