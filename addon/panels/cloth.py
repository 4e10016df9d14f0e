"""The head panel, what the others share, and the button in the Physics tab."""

from __future__ import annotations

import bpy
from bpy.types import Context, Panel

from .._identifiers import Operators, Panels


class PhysicsPanel:
    """Where the panels stand, and when."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "physics"

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only for a Boucle cloth."""
        obj = context.object
        return obj is not None and obj.type == "MESH" and obj.boucle.enabled

    def column(self) -> bpy.types.UILayout:
        """A column in Blender's property layout."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = True
        return self.layout.column()


class BOUCLE_PT_cloth(PhysicsPanel, Panel):
    """Mass, and what the cloth says of itself"""

    bl_idname = Panels.CLOTH
    bl_label = "Boucle Cloth"

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column()
        column.prop(settings, "mass_mode")
        by_area = settings.mass_mode == "density"
        column.prop(settings, "density" if by_area else "mass_per_vertex")
        self.layout.operator(Operators.CHECK, icon="CHECKMARK")


def draw_button(panel: Panel, context: Context) -> None:
    """The button among Blender's own physics buttons."""
    obj = context.object
    if obj is None or obj.type != "MESH":
        return
    column = panel.layout.column()
    if obj.boucle.enabled:
        column.operator(Operators.DISABLE, text="Boucle Cloth", icon="X")
    else:
        column.operator(Operators.ENABLE, text="Boucle Cloth", icon="MOD_CLOTH")


CLASSES = (BOUCLE_PT_cloth,)
