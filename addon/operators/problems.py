"""What can be done about a problem that the check found: select where it is, or make an object a collider."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Context, Event, Operator

from .._identifiers import Operators
from ..bridge import collider_setup, findings, selection
from ..core.refusal import Refusal, sentence_of
from .attempt import Attempt
from .polling import has_cloth


class BOUCLE_OT_select_problem(Operator):
    """Select the vertices that have this problem, and no others"""

    bl_idname = Operators.SELECT_PROBLEM
    bl_label = "Select Problem"
    bl_options = {"REGISTER", "UNDO"}

    number: IntProperty(
        name="Problem", description="Which of the problems in the panel, counted from 0",
        default=0, min=0, max=1_000_000,
    )  # fmt: skip
    edit: BoolProperty(
        name="Edit Mode", description="Go to Edit Mode, where the selection is seen", default=True
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file."""
        return has_cloth(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Select them as vertices."""
        obj = context.object
        try:
            problem = findings.problem(obj, self.number)
        except Refusal as refusal:
            self.report({"ERROR"}, sentence_of(refusal))
            return {"CANCELLED"}
        if self.edit and obj.mode == "OBJECT":
            bpy.ops.object.mode_set(mode="EDIT")
        context.tool_settings.mesh_select_mode = (True, False, False)
        selection.select(obj, set(problem.vertices))
        return {"FINISHED"}


class BOUCLE_OT_make_collider(Attempt, Operator):
    """Give an object that the cloth passes through Collision physics, so that the cloth lies on it"""

    bl_idname = Operators.MAKE_COLLIDER
    bl_label = "Make Collider"
    bl_options = {"REGISTER", "UNDO"}

    object_name: StringProperty(
        name="Object", description="The mesh that becomes a collider", default=""
    )
    thickness: FloatProperty(
        name="Outer Thickness",
        description="What is kept free around it, beside the thickness of the cloth (m); 0 takes the cloth's",
        default=0.0, min=0.0, max=1.0, soft_max=0.05, precision=4, step=0.1, unit="LENGTH",
    )  # fmt: skip

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file."""
        return has_cloth(cls, context)

    def invoke(self, context: Context, _event: Event) -> set[str]:
        """Begin with the thickness that fits."""
        self.thickness = 0.0
        return self.execute(context)

    def execute(self, context: Context) -> set[str]:
        """Add the modifier, or say why not."""
        obj, scene, name = context.object, context.scene, self.object_name
        return self.attempt(lambda: collider_setup.make(obj, scene, name, self.thickness))


CLASSES = (BOUCLE_OT_select_problem, BOUCLE_OT_make_collider)
