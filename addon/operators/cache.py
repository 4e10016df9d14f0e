"""What can be done with a bake: free it, take back the one before, make another's one's own."""

from __future__ import annotations

from collections.abc import Callable

import bpy
from bpy.types import Context, Operator

from .._identifiers import Operators
from ..bridge import cache, live, saving
from .attempt import Attempt
from .polling import can_simulate


class _OfBake(Attempt):
    """An operator that acts on the active cloth's bake."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file, while no bake runs."""
        return can_simulate(cls, context)

    def act(self, obj: bpy.types.Object, action: Callable[[bpy.types.Object], None]) -> set[str]:
        """Do it, or report why it cannot be done."""
        live.drop(obj)
        return self.attempt(lambda: action(obj))


class BOUCLE_OT_free_bake(_OfBake, Operator):
    """Remove the bake from the disk, and the one before it; the cloth is live again"""

    bl_idname = Operators.FREE_BAKE
    bl_label = "Free Bake"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: Context) -> set[str]:
        """Remove the files and let the modifier go."""
        return self.act(context.object, cache.free)


class BOUCLE_OT_restore_bake(_OfBake, Operator):
    """Swap the bake with the one before it, to compare both or to take the last one back"""

    bl_idname = Operators.RESTORE_BAKE
    bl_label = "Restore Previous"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: Context) -> set[str]:
        """Exchange the files."""
        return self.act(context.object, cache.restore_previous)


class BOUCLE_OT_adopt_bake(_OfBake, Operator):
    """Copy the bake of another file or object, so that this cloth has one of its own"""

    bl_idname = Operators.ADOPT_BAKE
    bl_label = "Copy Bake"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: Context) -> set[str]:
        """Copy the files and play the copy."""
        return self.act(context.object, saving.adopt)


CLASSES = (BOUCLE_OT_free_bake, BOUCLE_OT_restore_bake, BOUCLE_OT_adopt_bake)
