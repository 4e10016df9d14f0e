"""What the cloth collides with."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import PanelOrder, Panels
from .cloth import PhysicsPanel


class BOUCLE_PT_collisions(PhysicsPanel, Panel):
    """Contact of the cloth with objects and with itself"""

    bl_idname = Panels.COLLISIONS
    bl_parent_id = Panels.CLOTH
    bl_label = "Collisions"
    bl_order = PanelOrder.COLLISIONS
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column(settings)
        column.active = settings.object_collision or settings.self_collision
        for name in ("thickness", "show_thickness", "friction"):
            column.prop(settings, name)


class BOUCLE_PT_object_collisions(PhysicsPanel, Panel):
    """Contact of the cloth with objects"""

    bl_idname = Panels.OBJECT_COLLISIONS
    bl_parent_id = Panels.COLLISIONS
    bl_label = "Object Collisions"
    bl_order = PanelOrder.OBJECT_COLLISIONS

    def draw_header(self, context: Context) -> None:
        """The switch."""
        self.layout.prop(context.object.boucle, "object_collision", text="")

    def draw(self, context: Context) -> None:
        """Lay out."""
        obj = context.object
        column = self.column(obj.boucle)
        column.active = obj.boucle.object_collision
        column.prop_search(obj.boucle, "collision_group", obj, "vertex_groups")
        column.prop(obj.boucle, "collision_collection", text="Collection")


class BOUCLE_PT_self_collisions(PhysicsPanel, Panel):
    """Contact of the cloth with itself"""

    bl_idname = Panels.SELF_COLLISIONS
    bl_parent_id = Panels.COLLISIONS
    bl_label = "Self Collisions"
    bl_order = PanelOrder.SELF_COLLISIONS

    def draw_header(self, context: Context) -> None:
        """The switch."""
        self.layout.prop(context.object.boucle, "self_collision", text="")

    def draw(self, context: Context) -> None:
        """Lay out."""
        obj = context.object
        column = self.column(obj.boucle)
        column.active = obj.boucle.self_collision
        column.prop_search(obj.boucle, "self_collision_group", obj, "vertex_groups")


CLASSES = (BOUCLE_PT_collisions, BOUCLE_PT_object_collisions, BOUCLE_PT_self_collisions)
