"""What the check found: one problem after another, each with what can be done about it."""

from __future__ import annotations

import json

from bpy.types import Context, Panel

from .._identifiers import Operators, PanelOrder, Panels
from .cloth import PhysicsPanel, draw_text

_ICONS = {"ERROR": "CANCEL", "WARNING": "ERROR", "HINT": "INFO"}


class BOUCLE_PT_problems(PhysicsPanel, Panel):
    """What the last check found"""

    bl_idname = Panels.PROBLEMS
    bl_parent_id = Panels.CLOTH
    bl_label = "Problems"
    bl_order = PanelOrder.PROBLEMS

    def draw(self, context: Context) -> None:
        """Lay out."""
        layout = self.layout
        text = context.object.boucle.problems
        if not text:
            layout.label(text="Not checked yet")
            return
        rows = json.loads(text)
        if not rows:
            layout.label(text="No problems found", icon="CHECKMARK")
        for number, row in enumerate(rows):
            box = layout.box()
            draw_text(box, row["sentence"], context, icon=_ICONS[row["severity"]])
            buttons = box.row()
            if row["selects"]:
                buttons.operator(Operators.SELECT_PROBLEM, text="Select").number = number
            if row["passes_through"]:
                button = buttons.operator(Operators.MAKE_COLLIDER)
                button.object_name = row["passes_through"]


CLASSES = (BOUCLE_PT_problems,)
