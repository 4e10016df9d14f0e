"""Integrator and steps."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import PanelOrder, Panels
from .cloth import PhysicsPanel, draw_text


class BOUCLE_PT_solver(PhysicsPanel, Panel):
    """How a frame is cut into steps"""

    bl_idname = Panels.SOLVER
    bl_parent_id = Panels.CLOTH
    bl_label = "Solver"
    bl_order = PanelOrder.SOLVER

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column(settings)
        column.prop(settings, "integrator")
        if settings.is_implicit:
            quality = column.column()
            quality.active = settings.step_mode == "auto"
            quality.prop(settings, "quality")
            if settings.quality == "custom":
                quality.prop(settings, "tolerance")
        column.prop(settings, "step_mode")
        if settings.step_mode == "substeps":
            column.prop(settings, "substeps")
        elif settings.step_mode == "time_step":
            column.prop(settings, "time_step", text="Time Step (s)")
        if not settings.is_implicit:
            column.prop(settings, "allow_unstable")
        draw_text(self.layout, settings.safe_step, context, icon="TIME")


class BOUCLE_PT_solver_advanced(PhysicsPanel, Panel):
    """What seldom needs a change"""

    bl_idname = Panels.SOLVER_ADVANCED
    bl_parent_id = Panels.SOLVER
    bl_label = "Advanced"
    bl_order = PanelOrder.SOLVER_ADVANCED
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column(settings)
        column.active = settings.is_implicit
        column.prop(settings, "linear_solver")


CLASSES = (BOUCLE_PT_solver, BOUCLE_PT_solver_advanced)
