"""Enable, disable and check a cloth, and reset its live result."""

from __future__ import annotations

from bpy.props import BoolProperty
from bpy.types import Context, Operator

from .._identifiers import Operators
from ..bridge import cloth, findings, live, preflight, selection
from ..core.mesh_check import Severity
from .polling import cloths_of, has_cloth, has_mesh


class BOUCLE_OT_enable(Operator):
    """Make the active mesh a Boucle cloth, which moves as the animation plays"""

    bl_idname = Operators.ENABLE
    bl_label = "Boucle Cloth"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a mesh of this file."""
        return has_mesh(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Insert the slot and take over the scene's frame range."""
        obj = context.object
        if not obj.boucle.enabled:
            cloth.set_range(obj, context.scene)
        obj.boucle.enabled = True
        return {"FINISHED"}


class BOUCLE_OT_disable(Operator):
    """Make the active object an ordinary mesh again; its bake stays on disk"""

    bl_idname = Operators.DISABLE
    bl_label = "Remove Boucle Cloth"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file."""
        return has_cloth(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Give the rest shape back and remove the slot."""
        context.object.boucle.enabled = False
        return {"FINISHED"}


class BOUCLE_OT_reset(Operator):
    """Forget the live result and show the rest shape; a bake is kept"""

    bl_idname = Operators.RESET
    bl_label = "Reset"
    bl_options = {"REGISTER", "UNDO"}

    every: BoolProperty(name="All", description="Reset every cloth of the scene", default=False)

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file."""
        return has_cloth(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Drop the sessions."""
        for obj in cloths_of(context) if self.every else [context.object]:
            live.drop(obj)
        return {"FINISHED"}


class BOUCLE_OT_check(Operator):
    """Look for what would go wrong with the cloth, tell the cure of each problem, and select the vertices that have them"""

    bl_idname = Operators.CHECK
    bl_label = "Check"
    bl_options = {"REGISTER", "UNDO"}

    select: BoolProperty(
        name="Select", description="Select the vertices that have problems", default=True
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file."""
        return has_cloth(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Report every problem; all stand in the panel."""
        obj = context.object
        problems = preflight.problems(obj, context.scene)
        culprits = {
            vertex
            for problem in problems
            if problem.severity is not Severity.HINT
            for vertex in problem.vertices
        }
        if self.select and culprits:
            selection.select(obj, culprits)
        findings.keep(obj, problems)
        for problem in problems:
            is_error = problem.severity is Severity.ERROR
            kind = "INFO" if problem.severity is Severity.HINT else "WARNING"
            # An ERROR report would raise in a script that only asked.
            self.report({kind}, f"{'Error: ' if is_error else ''}{problem.sentence}")
        if not problems:
            self.report({"INFO"}, f'"{obj.name}" has no problems')
        return {"FINISHED"}


CLASSES = (BOUCLE_OT_enable, BOUCLE_OT_disable, BOUCLE_OT_reset, BOUCLE_OT_check)
