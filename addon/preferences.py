"""The add-on's preferences."""

import bpy
from bpy.props import IntProperty
from bpy.types import AddonPreferences


class BOUCLE_AP_preferences(AddonPreferences):
    """What holds for every file"""

    bl_idname = __package__

    live_memory: IntProperty(
        name="Live Memory",
        description="Memory that the live frames of one cloth may take (MB). When it is full, live simulation stops: "
        "bake, or allow more",
        default=4000,
        min=10,
        max=1_000_000,
    )

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out."""
        self.layout.use_property_split = True
        self.layout.prop(self, "live_memory")


CLASSES = (BOUCLE_AP_preferences,)
