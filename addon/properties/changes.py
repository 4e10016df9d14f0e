"""What a changed setting does: the live result no longer belongs to it."""

from __future__ import annotations

import bpy

OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}
FIXED: set[str] = set()
"""Options of a setting that makes no sense animated."""


def changed(settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    """Drop the live session of the cloth; the next play starts from the rest pose."""
    from ..bridge import live

    live.drop(settings.id_data)


def attributes_switched(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Show the numbers at the vertices that are known of the present frame, or no longer."""
    from ..bridge import live, registry

    if registry.is_cloth(settings.id_data) and settings.id_data.library is None:
        live.show_attributes(settings.id_data, context.scene)


def overlay_switched(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Learn what is to be shown, as far as it is known of the present frame, and begin or end to draw it."""
    from ..bridge import live, overlay_view, registry

    obj = settings.id_data
    if registry.is_cloth(obj) and obj.library is None:
        if settings.overlay != "none":
            live.read_last(obj)
        live.show_attributes(obj, context.scene)
    overlay_view.follow()


def overlay_redrawn(_settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    """Draw the heat map anew."""
    from ..bridge import overlay_view

    overlay_view.forget()


def thickness_switched(_settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    """Begin to draw the thickness in the viewports, or end it."""
    from ..bridge import thickness_view

    thickness_view.follow()


def switched(settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    """Make the object a cloth, or no longer one."""
    from ..bridge import cloth

    cloth.switch(settings.id_data, settings.enabled)
