"""Export: bakes for other programs, as USD or Alembic."""

from __future__ import annotations

from collections.abc import Callable

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy.types import Context, Operator
from bpy_extras.io_utils import ExportHelper

from .._identifiers import Operators
from ..bridge import export
from .attempt import Attempt
from .polling import has_cloth, is_free

Write = Callable[[list[bpy.types.Object], str], tuple[int, int]]


class _Export(Attempt, ExportHelper):
    """What both exports share: which cloths, and what became of them."""

    all_cloths: BoolProperty(
        name="All Cloths",
        description="Export every baked cloth of the scene, not the active one alone",
        default=False,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only with a cloth whose bake can be played, while no bake runs."""
        if not has_cloth(cls, context) or not is_free(cls):
            return False
        if context.object.mode != "OBJECT":
            cls.poll_message_set("Leave the mode that the object is in")
            return False
        if not context.object.boucle.is_baked:
            cls.poll_message_set(f'"{context.object.name}" is not baked: bake it first')
            return False
        return True

    def write(self, context: Context, write: Write) -> set[str]:
        """Export, or report why it cannot be done."""
        found = export.exportable(context.scene) if self.all_cloths else []
        cloths = found or [context.object]
        names = ", ".join(f'"{obj.name}"' for obj in cloths)

        def action() -> str:
            first, last = write(cloths, self.filepath)
            return f'{names}, frames {first} to {last}, exported to "{self.filepath}"'

        return self.attempt(action)


class BOUCLE_OT_export_usd(_Export, Operator):
    """Write the baked cloth and its motion into a USD file, with the attributes that are shown"""

    bl_idname = Operators.EXPORT_USD
    bl_label = "Export USD"
    filename_ext = ".usdc"
    check_extension = False  # .usd, .usda and .usdz are as good
    filter_glob: StringProperty(default="*.usd;*.usda;*.usdc;*.usdz", options={"HIDDEN"})

    def execute(self, context: Context) -> set[str]:
        """Call Blender's own exporter."""
        return self.write(context, export.to_usd)


class BOUCLE_OT_export_alembic(_Export, Operator):
    """Write the baked cloth and its motion into an Alembic file"""

    bl_idname = Operators.EXPORT_ALEMBIC
    bl_label = "Export Alembic"
    filename_ext = ".abc"
    filter_glob: StringProperty(default="*.abc", options={"HIDDEN"})

    def execute(self, context: Context) -> set[str]:
        """Call Blender's own exporter."""
        return self.write(context, export.to_alembic)


CLASSES = (BOUCLE_OT_export_usd, BOUCLE_OT_export_alembic)
