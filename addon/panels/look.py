"""What the cloth looks like in renders."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import Operators, PanelOrder, Panels
from .cloth import PhysicsPanel


class BOUCLE_PT_look(PhysicsPanel, Panel):
    """Materials of cloth"""

    bl_idname = Panels.LOOK
    bl_parent_id = Panels.CLOTH
    bl_label = "Look"
    bl_order = PanelOrder.LOOK
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Lay out."""
        obj = context.object
        buttons = self.layout.grid_flow(columns=3, row_major=True, even_columns=True, align=True)
        buttons.operator_enum(Operators.ADD_MATERIAL, "fabric")
        if obj.active_material is not None:
            self.layout.prop(obj, "active_material", text="")


CLASSES = (BOUCLE_PT_look,)
