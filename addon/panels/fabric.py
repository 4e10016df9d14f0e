"""Warp, stiffness, damping and deformation of fabric."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import PanelOrder, Panels
from .cloth import PhysicsPanel
from .springs import draw_deformation


class _FabricPanel(PhysicsPanel):
    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only for a cloth of fabric."""
        return super().poll(context) and context.object.boucle.model == "fabric"


class BOUCLE_PT_fabric(_FabricPanel, Panel):
    """Which way the warp runs, and the fabric's stiffness, damping and deformation below"""

    bl_idname = Panels.FABRIC
    bl_parent_id = Panels.CLOTH
    bl_label = "Fabric"
    bl_order = PanelOrder.FABRIC

    def draw(self, context: Context) -> None:
        """Lay out."""
        obj = context.object
        column = self.column(obj.boucle)
        column.prop(obj.boucle, "warp")
        if obj.boucle.warp == "uv":
            column.prop_search(obj.boucle, "warp_uv_map", obj.data, "uv_layers")


class BOUCLE_PT_fabric_stiffness(_FabricPanel, Panel):
    """Stiffness of the fabric in its plane"""

    bl_idname = Panels.FABRIC_STIFFNESS
    bl_parent_id = Panels.FABRIC
    bl_label = "Stiffness (N/m)"
    bl_order = PanelOrder.STIFFNESS

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column(settings)
        for name in ("stretch_warp", "stretch_weft", "shear", "use_compression"):
            column.prop(settings, name)
        if settings.use_compression:
            for name in ("compression_warp", "compression_weft"):
                column.prop(settings, name)


class BOUCLE_PT_fabric_bending(_FabricPanel, Panel):
    """Stiffness of the fabric against bending, and what stays of a bend"""

    bl_idname = Panels.FABRIC_BENDING
    bl_parent_id = Panels.FABRIC
    bl_label = "Bending (µN·m)"
    bl_order = PanelOrder.BENDING

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column(settings)
        column.prop(settings, "bend_warp_micro", text="Warp")
        column.prop(settings, "bend_weft_micro", text="Weft")
        column.prop(settings, "yield_curvature", text="Crease Beyond (1/m)")
        if settings.yield_curvature > 0.0:
            column.prop(settings, "hardening")
        column.prop(settings, "bend_hysteresis", text="Hysteresis (N·m/m)")


class BOUCLE_PT_fabric_damping(_FabricPanel, Panel):
    """Damping of the fabric, and of its vertices by the air"""

    bl_idname = Panels.FABRIC_DAMPING
    bl_parent_id = Panels.FABRIC
    bl_label = "Damping"
    bl_order = PanelOrder.DAMPING

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column(settings)
        column.prop(settings, "damping_ratio_per_kind")
        if settings.damping_ratio_per_kind:
            for name in ("damping_ratio_stretch", "damping_ratio_shear", "damping_ratio_bend"):
                column.prop(settings, name)
        else:
            column.prop(settings, "damping_ratio")
        column.prop(settings, "air_damping", text="Air (N·s/m)")


class BOUCLE_PT_fabric_deformation(_FabricPanel, Panel):
    """How far the fabric may stretch"""

    bl_idname = Panels.FABRIC_DEFORMATION
    bl_parent_id = Panels.FABRIC
    bl_label = "Deformation"
    bl_order = PanelOrder.DEFORMATION

    def draw(self, context: Context) -> None:
        """Lay out."""
        draw_deformation(self, context)


CLASSES = (
    BOUCLE_PT_fabric,
    BOUCLE_PT_fabric_stiffness,
    BOUCLE_PT_fabric_bending,
    BOUCLE_PT_fabric_damping,
    BOUCLE_PT_fabric_deformation,
)
