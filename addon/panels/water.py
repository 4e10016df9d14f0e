"""Water around the cloth."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import PanelOrder, Panels
from .cloth import PhysicsPanel


class BOUCLE_PT_water(PhysicsPanel, Panel):
    """Water around the cloth"""

    bl_idname = Panels.WATER
    bl_parent_id = Panels.FORCES
    bl_label = "Water"
    bl_order = PanelOrder.WATER
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Context) -> None:
        """Switch it on and off."""
        self.layout.prop(context.object.boucle, "use_water", text="")

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column(settings)
        column.active = settings.use_water
        column.prop(settings, "water_object")
        if settings.water_object is None:
            column.prop(settings, "water_level")
        column.prop(settings, "water_velocity")
        column.prop(settings, "water_density", text="Density (kg/m³)")
        column.prop(settings, "water_drag")
        column.prop(settings, "water_friction")
        column.prop(settings, "wave_amplitude")
        if settings.wave_amplitude > 0.0:
            column.prop(settings, "wave_length")
            column.prop(settings, "wave_angle")
        column.separator()
        column.prop(settings, "bulk_density", text="Cloth (kg/m³)")
        column.prop(settings, "water_hull")
        column.prop(settings, "absorbency")
        if settings.absorbency > 0.0:
            column.prop(settings, "soak_time", text="Soak Time (s)")
            column.prop(settings, "dry_time", text="Dry Time (s)")


CLASSES = (BOUCLE_PT_water,)
