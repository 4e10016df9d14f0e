"""How much of gravity and of the scene's force fields the cloth feels."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import PanelOrder, Panels
from .cloth import PhysicsPanel, draw_text

_WEIGHTS = (
    "gravity", "all", "force", "vortex", "magnetic", "harmonic", "wind", "turbulence", "drag",
)  # fmt: skip


class BOUCLE_PT_field_weights(PhysicsPanel, Panel):
    """Weights of gravity and force fields"""

    bl_idname = Panels.FIELD_WEIGHTS
    bl_parent_id = Panels.FORCES
    bl_label = "Field Weights"
    bl_order = PanelOrder.FIELD_WEIGHTS
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Lay out."""
        weights = context.object.boucle.field_weights
        column = self.column(context.object.boucle)
        column.prop(weights, "collection", text="Collection")
        for name in _WEIGHTS:
            column.prop(weights, name, slider=True)
        for sentence in weights.unsupported.splitlines():
            draw_text(self.layout, sentence, context, icon="INFO")


CLASSES = (BOUCLE_PT_field_weights,)
