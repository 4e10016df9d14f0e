"""Simulate a coarse proxy in place of a dense mesh."""

from __future__ import annotations

import bpy
from bpy.props import IntProperty
from bpy.types import Context, Operator

from .. import native
from .._identifiers import Operators
from ..bridge import proxy
from .attempt import Attempt
from .polling import has_mesh, is_free


class _Drives(Attempt):
    """An operator that binds the active mesh to a proxy."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a mesh of this file, in Object Mode."""
        if not has_mesh(cls, context) or not is_free(cls):
            return False
        if context.mode != "OBJECT":
            cls.poll_message_set("Go to Object Mode first")
            return False
        return True

    def finish(self, context: Context, coarse: bpy.types.Object, also: str) -> str:
        """Let the proxy be what the artist looks at next, and say what was done."""
        for obj in context.selected_objects:
            obj.select_set(False)
        coarse.select_set(True)
        context.view_layer.objects.active = coarse
        text = f'"{coarse.name}" is the cloth now, with {len(coarse.data.vertices)} vertices'
        return f"{text}; {also}" if also else text


class BOUCLE_OT_add_proxy(_Drives, Operator):
    """Simulate a coarse copy of this mesh, which moves it through a Surface Deform modifier"""

    bl_idname = Operators.ADD_PROXY
    bl_label = "Add Proxy"
    bl_options = {"REGISTER", "UNDO"}

    vertex_count: IntProperty(
        name="Vertices", description="About how many vertices the proxy gets: fewer are faster, more fold more finely",
        default=1500, min=16, max=1_000_000, soft_max=20_000,
    )  # fmt: skip

    def execute(self, context: Context) -> set[str]:
        """Make it and bind to it."""
        dense, scene = context.object, context.scene

        def action() -> str:
            coarse = proxy.make(dense, scene, self.vertex_count)
            try:
                also = proxy.drive(dense, coarse, scene)
            except native.FAILURES:
                proxy.remove(coarse)
                raise
            return self.finish(context, coarse, also)

        return self.attempt(action)


class BOUCLE_OT_drive_with_proxy(_Drives, Operator):
    """Let the other selected mesh, simulated as cloth, move the active one through a Surface Deform modifier"""

    bl_idname = Operators.DRIVE_WITH_PROXY
    bl_label = "Drive with Proxy"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only with one other mesh selected."""
        if not super().poll(context):
            return False
        if len(_others(context)) != 1:
            cls.poll_message_set("Select the proxy, then the dense mesh: two mesh objects")
            return False
        return True

    def execute(self, context: Context) -> set[str]:
        """Bind to it."""
        (coarse,) = _others(context)
        return self.attempt(
            lambda: self.finish(context, coarse, proxy.drive(context.object, coarse, context.scene))
        )


def _others(context: Context) -> list[bpy.types.Object]:
    """The selected meshes of this file beside the active one."""
    return [
        obj
        for obj in context.selected_objects
        if obj != context.object and obj.type == "MESH" and obj.library is None
    ]


CLASSES = (BOUCLE_OT_add_proxy, BOUCLE_OT_drive_with_proxy)
