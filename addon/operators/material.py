"""Give the cloth a material that looks like a fabric, or shows the heat map's colours in renders."""

from __future__ import annotations

from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty
from bpy.types import Context, Operator

from .._identifiers import Operators
from ..bridge import dressing
from ..core import fabric
from .polling import has_cloth, is_in_object_mode

_ITEMS = tuple((one.key, one.label, one.description) for one in fabric.ALL)


def _can_dress(cls: type, context: Context) -> bool:
    """Whether the active cloth can get a material now."""
    return has_cloth(cls, context) and is_in_object_mode(cls, context)


class BOUCLE_OT_add_material(Operator):
    """Give the cloth a material that looks like a fabric, with yarns in real size"""

    bl_idname = Operators.ADD_MATERIAL
    bl_label = "Add Fabric Material"
    bl_options = {"REGISTER", "UNDO"}

    fabric: EnumProperty(
        name="Fabric", description="What the cloth looks like", items=_ITEMS, default="boucle"
    )
    color: FloatVectorProperty(
        name="Color",
        description="Colour of the yarn (linear red, green, blue); the fabric's own unless it is set",
        size=3, subtype="COLOR", min=0.0, max=1.0, default=(0.5, 0.5, 0.5), options={"SKIP_SAVE"},
    )  # fmt: skip
    scale: FloatProperty(
        name="Scale",
        description="Size of the yarns as a fraction of the fabric's own (fraction): above 1 coarser, below 1 finer",
        min=0.01, max=100.0, soft_min=0.1, soft_max=10.0, default=1.0, options={"SKIP_SAVE"},
    )  # fmt: skip

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only for a cloth of this file."""
        return _can_dress(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Make the material and put it into the active slot."""
        color = tuple(self.color) if self.properties.is_property_set("color") else None
        dressing.dress(context.object, self.fabric, color, self.scale)
        return {"FINISHED"}


class BOUCLE_OT_add_heat_map_material(Operator):
    """Give the cloth a material with the colours of the overlay, for renders"""

    bl_idname = Operators.ADD_HEAT_MAP_MATERIAL
    bl_label = "Add Heat Map Material"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only for a cloth of this file that shows a heat map."""
        if not _can_dress(cls, context):
            return False
        if context.object.boucle.overlay == "none":
            cls.poll_message_set("Choose a heat map in the Overlay panel first")
            return False
        return True

    def execute(self, context: Context) -> set[str]:
        """Make the material and put it into the active slot."""
        dressing.show_heat_map(context.object, context.scene)
        return {"FINISHED"}


CLASSES = (BOUCLE_OT_add_material, BOUCLE_OT_add_heat_map_material)
