"""Seams that are closed in renders."""

from __future__ import annotations

from bpy.types import Context, Operator

from .._identifiers import WELD_MODIFIER, Operators
from ..bridge import slot
from .polling import has_cloth

NARROWEST = 0.001
"""Distance (m) that is merged at the least: what a load parts a closed seam by stays below it."""


class BOUCLE_OT_add_weld(Operator):
    """Add a Weld modifier below the cloth that merges its closed seams in renders; the simulation does not need it"""

    bl_idname = Operators.ADD_WELD
    bl_label = "Add Weld Modifier"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file."""
        return has_cloth(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Put it right below the slot, for renders only: in the viewport it would hide where the pins go."""
        obj = context.object
        cache = slot.ensure(obj).cache
        weld = obj.modifiers.get(WELD_MODIFIER)
        if weld is None:
            weld = obj.modifiers.new(WELD_MODIFIER, "WELD")
            obj.modifiers.move(obj.modifiers.find(weld.name), obj.modifiers.find(cache.name) + 1)
        weld.merge_threshold = max(obj.boucle.weld_distance, NARROWEST)
        weld.show_viewport = False
        return {"FINISHED"}


CLASSES = (BOUCLE_OT_add_weld,)
