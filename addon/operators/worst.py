"""Go to where a result is worst."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, IntProperty
from bpy.types import Context, Operator

from .._identifiers import Operators
from ..bridge import selection, worst
from ..core.certificate import percent
from ..core.worst import INTERSECTIONS, STRAIN
from .attempt import Attempt
from .polling import can_simulate


class BOUCLE_OT_go_to_worst_frame(Attempt, Operator):
    """Go to the frame in which the cloth stretches most, or passes through most"""

    bl_idname = Operators.GO_TO_WORST_FRAME
    bl_label = "Worst Frame"
    bl_options = {"REGISTER", "UNDO"}

    by: EnumProperty(
        name="By", description="What is worst",
        items=(
            ("strain", "Strain", "The largest strain of any edge"),
            ("intersections", "Intersections", "The most edges that pass through triangles"),
        ),
        default="strain",
    )  # fmt: skip

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file."""
        return can_simulate(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Find it among the certificates and go there."""
        obj, by_strain = context.object, self.by == "strain"

        def action() -> str:
            frame, value = worst.frame(obj, STRAIN if by_strain else INTERSECTIONS)
            if not by_strain and value == 0.0:
                return f'"{obj.name}" has no intersections in any frame'
            context.scene.frame_set(frame)
            words = f"stretch {percent(value)}" if by_strain else f"{value:.0f} intersections"
            return f'"{obj.name}" is worst at frame {frame}: {words}'

        return self.attempt(action)


class BOUCLE_OT_select_worst_edges(Attempt, Operator):
    """Select the edges that stretch most in the frame that is shown"""

    bl_idname = Operators.SELECT_WORST_EDGES
    bl_label = "Worst Edges"
    bl_options = {"REGISTER", "UNDO"}

    which: EnumProperty(
        name="Which", description="Which edges are selected",
        items=(
            ("rate", "Over the Rate", "Those that are longer than the deformation rate allows"),
            ("most", "Most Stretched", "A number of those that stretch most"),
        ),
        default="rate",
    )  # fmt: skip
    count: IntProperty(
        name="Count", description="How many of the most stretched edges",
        default=10, min=1, max=1_000_000, soft_max=100,
    )  # fmt: skip

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file, and its frame."""
        return can_simulate(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Compare lengths with those at rest."""
        return self.attempt(lambda: self._select(context))

    def _select(self, context: Context) -> str:
        obj = context.object
        was_editing = obj.mode == "EDIT"
        if was_editing:
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            found = worst.edges(obj, context.scene)
        finally:
            if was_editing:
                bpy.ops.object.mode_set(mode="EDIT")
        chosen = worst.over_the_rate(obj, found) if self.which == "rate" else found[: self.count]
        context.tool_settings.mesh_select_mode = (False, True, False)
        selection.select_edges(obj, {edge.number for edge in chosen})
        largest = (
            f"the largest strain is {percent(found[0].strain)}" if found else "it has no edges"
        )
        return f'"{obj.name}": {len(chosen)} edges selected; {largest}'


CLASSES = (BOUCLE_OT_go_to_worst_frame, BOUCLE_OT_select_worst_edges)
