"""Stiffness, damping and deformation."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import PanelOrder, Panels
from .cloth import PhysicsPanel


class _SpringPanel(PhysicsPanel):
    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only for a cloth of springs."""
        return super().poll(context) and context.object.boucle.model == "springs"


class BOUCLE_PT_springs(_SpringPanel, Panel):
    """What the springs are, and their stiffness, damping and deformation below"""

    bl_idname = Panels.SPRINGS
    bl_parent_id = Panels.CLOTH
    bl_label = "Springs"
    bl_order = PanelOrder.SPRINGS

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        self.column(settings).prop(settings, "stiffness_from", text="Stiffness")


class BOUCLE_PT_stiffness(_SpringPanel, Panel):
    """Stiffness"""

    bl_idname = Panels.STIFFNESS
    bl_parent_id = Panels.SPRINGS
    bl_label = "Stiffness (N/m)"
    bl_order = PanelOrder.STIFFNESS

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column(settings)
        for name in ("stretch", "shear", "bend"):
            column.prop(settings, name)


class BOUCLE_PT_damping(_SpringPanel, Panel):
    """Damping"""

    bl_idname = Panels.DAMPING
    bl_parent_id = Panels.SPRINGS
    bl_label = "Damping (N·s/m)"
    bl_order = PanelOrder.DAMPING

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column(settings)
        column.prop(settings, "damping_per_kind")
        if settings.damping_per_kind:
            for name in ("damping_stretch", "damping_shear", "damping_bend"):
                column.prop(settings, name)
        else:
            column.prop(settings, "damping")
        column.prop(settings, "damping_law")
        column.prop(settings, "air_damping")


class BOUCLE_PT_deformation(_SpringPanel, Panel):
    """Deformation"""

    bl_idname = Panels.DEFORMATION
    bl_parent_id = Panels.SPRINGS
    bl_label = "Deformation"
    bl_order = PanelOrder.DEFORMATION

    def draw(self, context: Context) -> None:
        """Lay out."""
        draw_deformation(self, context)


def draw_deformation(panel: PhysicsPanel, context: Context) -> None:
    """What both models have to say of the elongation."""
    settings = context.object.boucle
    column = panel.column(settings)
    column.prop(settings, "limiter")
    rate = column.column()
    rate.active = settings.limiter != "none"
    rate.prop(settings, "deformation_rate")


CLASSES = (BOUCLE_PT_springs, BOUCLE_PT_stiffness, BOUCLE_PT_damping, BOUCLE_PT_deformation)
