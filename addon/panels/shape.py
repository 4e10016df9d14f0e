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
        column = self.column(obj.boucle)
        column.prop_search(obj.boucle, "pin_group", obj, "vertex_groups")
        pins = column.column()
        pins.active = bool(obj.boucle.pin_group)
        pins.prop(obj.boucle, "pin_strength")
        pins.prop(obj.boucle, "pin_stiffness", text="Stiffness (N/m)")
        pins.prop(obj.boucle, "pin_damping")


CLASSES = (BOUCLE_PT_shape,)
