"""Copy from Cloth Modifier."""

from __future__ import annotations

from bpy.app.translations import pgettext_tip
from bpy.types import Context, Operator

from .._identifiers import Operators
from ..bridge import copy_from_cloth
from ..core.refusal import Refusal
from .polling import has_mesh


class BOUCLE_OT_copy_from_cloth(Operator):
    """Take over the settings of the object's Cloth modifier as far as they go, and switch that modifier off"""

    bl_idname = Operators.COPY_FROM_CLOTH
    bl_label = "Copy from Cloth Modifier"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a mesh of this file that has the modifier."""
        if not has_mesh(cls, context):
            return False
        if copy_from_cloth.find(context.object) is None:
            cls.poll_message_set(pgettext_tip("The object has no Cloth modifier"))
            return False
        return True

    def execute(self, context: Context) -> set[str]:
        """Copy, make the object a Boucle cloth if it is none, and say the numbers."""
        obj = context.object
        try:
            said, is_whole = copy_from_cloth.copy(obj)
        except Refusal as refusal:
            self.report({"ERROR"}, str(refusal))
            return {"CANCELLED"}
        obj.boucle.enabled = True
        self.report({"INFO" if is_whole else "WARNING"}, said)
        return {"FINISHED"}


CLASSES = (BOUCLE_OT_copy_from_cloth,)
