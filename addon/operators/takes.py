"""Keep, restore, compare and remove takes."""

from __future__ import annotations

from bpy.props import BoolProperty, IntProperty, StringProperty
from bpy.types import Context, Operator

from .._identifiers import Operators
from ..bridge import takes
from .attempt import Attempt
from .polling import can_simulate


class _OfTakes(Attempt):
    """An operator on the takes of the active cloth."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file, while no bake runs."""
        return can_simulate(cls, context)


class _OfOneTake(_OfTakes):
    """An operator on one of them."""

    index: IntProperty(
        name="Take", description="Which take, counted from 0; -1 is the chosen one",
        default=-1, min=-1, max=100_000, options={"SKIP_SAVE"},
    )  # fmt: skip

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth with a take."""
        if not super().poll(context):
            return False
        if not context.object.boucle.takes:
            cls.poll_message_set(f'"{context.object.name}" has no takes: bake it and keep one')
            return False
        return True

    def number(self, context: Context) -> int:
        """The take that is meant."""
        return self.index if self.index >= 0 else context.object.boucle.take_index


class BOUCLE_OT_add_take(_OfTakes, Operator):
    """Keep the bake under a name, beside whatever is baked next"""

    bl_idname = Operators.ADD_TAKE
    bl_label = "Keep Take"
    bl_options = {"UNDO"}  # without REGISTER: the redo panel would copy again

    take_name: StringProperty(
        name="Name", description="What the take is called; empty for the next number", default="",
        options={"SKIP_SAVE"},
    )  # fmt: skip

    def execute(self, context: Context) -> set[str]:
        """Copy the files."""
        obj = context.object
        return self.attempt(
            lambda: (
                f'"{obj.name}": the bake is kept as '
                f'"{takes.add(obj, self.take_name or takes.free_name(obj)).name}"'
            )
        )


class BOUCLE_OT_restore_take(_OfOneTake, Operator):
    """Play a take again; the bake that is played now becomes the previous one"""

    bl_idname = Operators.RESTORE_TAKE
    bl_label = "Restore"
    bl_options = {"UNDO"}  # without REGISTER: the redo panel would set the bake aside once more

    with_settings: BoolProperty(
        name="With Settings", description="Give the cloth the settings of the take, too",
        default=True, options={"SKIP_SAVE"},
    )  # fmt: skip

    def execute(self, context: Context) -> set[str]:
        """Copy the files back."""
        obj, number = context.object, self.number(context)
        return self.attempt(lambda: takes.restore(obj, number, self.with_settings))


class BOUCLE_OT_remove_take(_OfOneTake, Operator):
    """Remove a take and its files from the disk"""

    bl_idname = Operators.REMOVE_TAKE
    bl_label = "Remove Take"
    bl_options = {"UNDO"}  # without REGISTER: the redo panel would remove the next one

    def execute(self, context: Context) -> set[str]:
        """Remove the files, then the entry."""
        obj, number = context.object, self.number(context)

        def action() -> str:
            name = takes.chosen(obj, number).name
            takes.remove(obj, number)
            return f'"{obj.name}": the take "{name}" is removed'

        return self.attempt(action)


class BOUCLE_OT_compare_take(_OfOneTake, Operator):
    """Tell in words what is different between a take and the bake that is played"""

    bl_idname = Operators.COMPARE_TAKE
    bl_label = "Compare"
    bl_options = {"REGISTER"}

    def execute(self, context: Context) -> set[str]:
        """Compare the reports."""
        obj, number = context.object, self.number(context)
        return self.attempt(lambda: "; ".join(takes.compare(obj, number)))


CLASSES = (
    BOUCLE_OT_add_take,
    BOUCLE_OT_restore_take,
    BOUCLE_OT_remove_take,
    BOUCLE_OT_compare_take,
)
