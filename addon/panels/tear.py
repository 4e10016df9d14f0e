"""When the cloth tears."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import PanelOrder, Panels
from .cloth import PhysicsPanel


class BOUCLE_PT_tearing(PhysicsPanel, Panel):
    """When the cloth tears, and where it comes undone"""

    bl_idname = Panels.TEARING
    bl_parent_id = Panels.CLOTH
    bl_label = "Tearing"
    bl_order = PanelOrder.TEARING
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Context) -> None:
        """Switch it on and off."""
        self.layout.prop(context.object.boucle, "use_tear", text="")

    def draw(self, context: Context) -> None:
        """Lay out."""
        obj = context.object
        settings = obj.boucle
        column = self.column(settings)
        column.active = settings.use_tear
        column.prop(settings, "tear_stress", text="Stress (N/m)")
        column.prop(settings, "tear_force", text="Force (N)")
        column.prop(settings, "tear_strain")
        column.prop(settings, "tear_noise", slider=True)
        if settings.tear_noise > 0.0:
            column.prop(settings, "tear_seed", text="Seed")
        column.prop_search(settings, "tear_strength_group", obj, "vertex_groups")
        column.prop(settings, "seam_force", text="Seams (N)")
        column.separator()
        column.prop_search(settings, "tear_opening_group", obj, "vertex_groups")
        if settings.tear_opening_group:
            column.prop(settings, "tear_opening_frame", text="Frame")


CLASSES = (BOUCLE_PT_tearing,)
