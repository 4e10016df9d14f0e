"""Integrator and steps."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import Panels
from .cloth import PhysicsPanel, draw_text


class BOUCLE_PT_solver(PhysicsPanel, Panel):
    """How a frame is cut into steps"""

    bl_idname = Panels.SOLVER
    bl_parent_id = Panels.CLOTH
    bl_label = "Solver"

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column()
        for name in ("integrator", "substeps", "time_step", "allow_unstable"):
            column.prop(settings, name)
        draw_text(self.layout, settings.safe_step, context, icon="TIME")


CLASSES = (BOUCLE_PT_solver,)
