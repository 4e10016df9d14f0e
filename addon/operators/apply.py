"""Apply the frame that is shown as rest shape, start pose or shape key."""

from __future__ import annotations

from bpy.props import StringProperty
from bpy.types import Context, Operator

from .._identifiers import Operators
from ..bridge import apply
from .attempt import Attempt
from .polling import can_simulate


class _Applies(Attempt):
    """An operator that makes something of the frame that is shown."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file, out of Edit Mode."""
        if not can_simulate(cls, context):
            return False
        if context.object.mode != "OBJECT":
            cls.poll_message_set("Go to Object Mode first")
            return False
        return True


class BOUCLE_OT_apply_as_rest(_Applies, Operator):
    """Make the shape that is shown the rest shape: all lengths are at rest in it. The result is let go"""

    bl_idname = Operators.APPLY_AS_REST
    bl_label = "Rest Shape"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: Context) -> set[str]:
        """Move the mesh."""
        obj, scene = context.object, context.scene
        words = f'"{obj.name}" rests in the shape of frame {scene.frame_current}: '
        return self.attempt(lambda: words + apply.as_rest(obj, scene), "WARNING")


class BOUCLE_OT_apply_as_start(_Applies, Operator):
    """Begin the simulation in the shape that is shown; the rest lengths stay. The result is let go"""

    bl_idname = Operators.APPLY_AS_START
    bl_label = "Start Pose"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: Context) -> set[str]:
        """Move the mesh and keep the rest shape as a key."""
        obj, scene = context.object, context.scene
        words = f'"{obj.name}" begins in the shape of frame {scene.frame_current}: '
        return self.attempt(lambda: words + apply.as_start(obj, scene), "WARNING")


class BOUCLE_OT_apply_as_shape_key(_Applies, Operator):
    """Keep the shape that is shown as a new shape key, which is switched off"""

    bl_idname = Operators.APPLY_AS_SHAPE_KEY
    bl_label = "Shape Key"
    bl_options = {"REGISTER", "UNDO"}

    key_name: StringProperty(
        name="Name", description="Name of the shape key; empty for the frame's number", default=""
    )

    def execute(self, context: Context) -> set[str]:
        """Add the key."""
        obj, scene = context.object, context.scene
        words = f'"{obj.name}" has a new shape key: '
        return self.attempt(lambda: words + apply.as_shape_key(obj, scene, self.key_name), "INFO")


CLASSES = (BOUCLE_OT_apply_as_rest, BOUCLE_OT_apply_as_start, BOUCLE_OT_apply_as_shape_key)
