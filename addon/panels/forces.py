"""Wind."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import PanelOrder, Panels
from .cloth import PhysicsPanel


class BOUCLE_PT_forces(PhysicsPanel, Panel):
    """Wind"""

    bl_idname = Panels.FORCES
    bl_parent_id = Panels.CLOTH
    bl_label = "Forces"
    bl_order = PanelOrder.FORCES
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Lay out."""
        obj = context.object
        settings = obj.boucle
        column = self.column(settings)
        column.prop(settings, "use_wind")
        wind = column.column()
        wind.active = settings.use_wind
        wind.prop(settings, "wind_velocity")
        wind.prop(settings, "wind_law")
        if settings.wind_law == "vertex":
            wind.prop(settings, "wind_coefficient", text="Drag (N·s/m)")
        else:
            wind.prop(settings, "wind_air_density", text="Density (kg/m³)")
            wind.prop(settings, "wind_drag")
            wind.prop(settings, "use_wind_lift")
            if settings.use_wind_lift:
                wind.prop(settings, "wind_lift")
        wind.prop(settings, "wind_gusts")
        if settings.wind_gusts > 0.0:
            wind.prop(settings, "wind_gust_period", text="Period (s)")
        wind.prop(settings, "wind_turbulence")
        if settings.wind_turbulence > 0.0:
            wind.prop(settings, "wind_turbulence_size", text="Size (m)")
        if settings.wind_gusts > 0.0 or settings.wind_turbulence > 0.0:
            wind.prop(settings, "wind_seed", text="Seed")
        wind.prop(settings, "use_wind_shelter")
        wind.prop_search(settings, "wind_group", obj, "vertex_groups")


CLASSES = (BOUCLE_PT_forces,)
