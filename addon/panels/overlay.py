"""What the viewports show on the cloth."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import Operators, PanelOrder, Panels
from .cloth import PhysicsPanel


class BOUCLE_PT_overlay(PhysicsPanel, Panel):
    """Colours that tell what happens to the cloth"""

    bl_idname = Panels.OVERLAY
    bl_parent_id = Panels.CLOTH
    bl_label = "Overlay"
    bl_order = PanelOrder.OVERLAY
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column()
        column.prop(settings, "overlay")
        details = column.column()
        details.active = settings.overlay != "none"
        details.prop(settings, "overlay_range")
        if settings.overlay_range == "manual":
            details.prop(settings, "overlay_minimum")
            details.prop(settings, "overlay_maximum")
        details.prop(settings, "overlay_opacity", slider=True)
        column.prop(settings, "show_thickness")
        if settings.overlay != "none":
            self.layout.operator(Operators.ADD_HEAT_MAP_MATERIAL)


CLASSES = (BOUCLE_PT_overlay,)
