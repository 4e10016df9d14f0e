"""What can be done with a result: look where it is worst, and apply it."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import Operators, PanelOrder, Panels
from .cloth import PhysicsPanel


class BOUCLE_PT_result(PhysicsPanel, Panel):
    """Where the result is worst, and what to make of it"""

    bl_idname = Panels.RESULT
    bl_parent_id = Panels.CACHE
    bl_label = "Result"
    bl_order = PanelOrder.RESULT
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: Context) -> None:
        """Lay out."""
        layout = self.layout
        layout.label(text="Worst Frame")
        row = layout.row(align=True)
        row.operator(Operators.GO_TO_WORST_FRAME, text="Strain").by = "strain"
        row.operator(Operators.GO_TO_WORST_FRAME, text="Intersections").by = "intersections"
        layout.label(text="Worst Edges")
        row = layout.row(align=True)
        row.operator(Operators.SELECT_WORST_EDGES, text="Over the Rate").which = "rate"
        row.operator(Operators.SELECT_WORST_EDGES, text="Most Stretched").which = "most"
        layout.label(text="Apply as")
        row = layout.row(align=True)
        for name in (
            Operators.APPLY_AS_REST,
            Operators.APPLY_AS_START,
            Operators.APPLY_AS_SHAPE_KEY,
        ):
            row.operator(name)


CLASSES = (BOUCLE_PT_result,)
