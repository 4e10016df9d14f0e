"""The head panel, what the others share, and the button in the Physics tab."""

from __future__ import annotations

import textwrap

import bpy
from bpy.types import Context, Panel

from .._identifiers import Operators, Panels
from .presets import draw_choice, draw_popover

_DENSE = 20_000
"""Vertices from which on a proxy is offered in place of the mesh itself."""
_LETTER = 7.0
"""Width (pixels) of a letter of the default font at scale 1."""


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

    def column(self, settings: bpy.types.PropertyGroup | None = None) -> bpy.types.UILayout:
        """A column in Blender's property layout; dim, as Blender's own cloth is, while a bake of these settings plays."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = True
        outer = self.layout.column()
        outer.active = settings is None or not settings.is_baked
        return outer.column()


def draw_text(layout: bpy.types.UILayout, text: str, context: Context, icon: str = "NONE") -> None:
    """A text in as many lines as the panel's width asks for: Blender cuts a long label in its middle."""
    width = context.region.width if context.region else 280
    scale = context.preferences.system.ui_scale or 1.0  # 0 in background
    column = layout.column(align=True)
    for line in textwrap.wrap(text, max(20, int(width / (_LETTER * scale)) - 6)):
        column.label(text=line, icon=icon)
        icon = "NONE" if icon == "NONE" else "BLANK1"


class BOUCLE_PT_cloth(PhysicsPanel, Panel):
    """Mass, and what the cloth says of itself"""

    bl_idname = Panels.CLOTH
    bl_label = "Boucle Cloth"

    def draw_header_preset(self, _context: Context) -> None:
        """The presets, at the right end of the header."""
        draw_popover(self.layout)

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        row = self.layout.row(align=True)
        row.operator(Operators.BAKE).resume = False
        if settings.is_baked:
            row.operator(Operators.FREE_BAKE)
        column = self.column(settings)
        column.row().prop(settings, "model", expand=True)
        draw_choice(column, settings)
        column.prop(settings, "mass_mode")
        if settings.mass_mode == "density":
            column.prop(settings, "density", text="Density (kg/m²)")
        else:
            column.prop(settings, "mass_per_vertex", text="Mass (kg)")
        column.prop(settings, "speed")
        self.layout.operator(Operators.CHECK, icon="CHECKMARK")
        if any(modifier.type == "CLOTH" for modifier in context.object.modifiers):
            self.layout.operator(Operators.COPY_FROM_CLOTH, icon="COPYDOWN")
        column = self.layout.column(align=True)
        column.operator(Operators.ADD_PROXY)
        column.operator(Operators.DRIVE_WITH_PROXY)


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
        if len(obj.data.vertices) > _DENSE:
            column.operator(Operators.ADD_PROXY, text="Boucle Cloth Proxy", icon="MOD_MESHDEFORM")


CLASSES = (BOUCLE_PT_cloth,)
