"""Rest shape, shrink, pressure and sewing."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import Operators, PanelOrder, Panels
from .cloth import PhysicsPanel


class BOUCLE_PT_rest_shape(PhysicsPanel, Panel):
    """The lengths that springs have at rest"""

    bl_idname = Panels.REST_SHAPE
    bl_parent_id = Panels.SHAPE
    bl_label = "Rest Shape"
    bl_order = PanelOrder.REST_SHAPE
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Lay out."""
        obj = context.object
        settings = obj.boucle
        column = self.column(settings)
        column.prop(settings, "use_dynamic_mesh")
        key = column.column()
        key.active = not settings.use_dynamic_mesh
        if obj.data.shape_keys is not None:
            key.prop_search(settings, "rest_shape_key", obj.data.shape_keys, "key_blocks")
        else:
            key.prop(settings, "rest_shape_key")
        column.prop(settings, "shrink_min")
        column.prop_search(settings, "shrink_group", obj, "vertex_groups")
        most = column.column()
        most.active = bool(settings.shrink_group)
        most.prop(settings, "shrink_max")


class BOUCLE_PT_pressure(PhysicsPanel, Panel):
    """What inflates the cloth"""

    bl_idname = Panels.PRESSURE
    bl_parent_id = Panels.SHAPE
    bl_label = "Pressure"
    bl_order = PanelOrder.PRESSURE
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Context) -> None:
        """The switch."""
        self.layout.prop(context.object.boucle, "use_pressure", text="")

    def draw(self, context: Context) -> None:
        """Lay out."""
        obj = context.object
        settings = obj.boucle
        column = self.column(settings)
        column.active = settings.use_pressure
        column.prop(settings, "uniform_pressure_force", text="Pressure (N/m²)")
        column.prop(settings, "use_pressure_volume")
        volume = column.column()
        volume.active = settings.use_pressure_volume
        volume.prop(settings, "target_volume")
        column.prop(settings, "pressure_factor", text="Scale (N/m²)")
        column.prop_search(settings, "pressure_group", obj, "vertex_groups")


class BOUCLE_PT_sewing(PhysicsPanel, Panel):
    """Seams along loose edges"""

    bl_idname = Panels.SEWING
    bl_parent_id = Panels.SHAPE
    bl_label = "Sewing"
    bl_order = PanelOrder.SEWING
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Context) -> None:
        """The switch."""
        self.layout.prop(context.object.boucle, "use_sewing_springs", text="")

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column(settings)
        column.active = settings.use_sewing_springs
        column.prop(settings, "sewing_force_max", text="Max Force (N)")
        column.prop(settings, "weld_distance")
        column.operator(Operators.ADD_WELD, icon="AUTOMERGE_ON")


CLASSES = (BOUCLE_PT_rest_shape, BOUCLE_PT_pressure, BOUCLE_PT_sewing)
