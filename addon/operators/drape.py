"""Add > Mesh > Boucle Cloth > Drape over Selected: a sheet that falls on what is selected."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_tip
from bpy.props import FloatProperty, IntProperty
from bpy.types import Context, Operator
from bpy_extras.object_utils import object_data_add
from mathutils import Matrix, Vector

from .._identifiers import Operators
from ..bridge import cloth, collider_setup
from ..core import starter_shapes
from .polling import is_in_object_mode
from .starters import mesh_of

_PART_OF_EDGE = 0.125
"""Of an edge: the cloth's thickness, and what is kept free around the objects; a quarter of an edge is between both."""


class BOUCLE_OT_drape(Operator):
    """Add a sheet above the selected objects, which become colliders, to fall on them"""

    bl_idname = Operators.DRAPE
    bl_label = "Drape over Selected"
    bl_options = {"REGISTER", "UNDO"}

    vertices: IntProperty(
        name="Vertices", description="Vertices along the sheet's longer side: more fold more finely and take longer",
        default=64, min=4, max=1024, soft_max=256,
    )  # fmt: skip
    overhang: FloatProperty(
        name="Overhang", description="How far the sheet can hang down, as a fraction of the objects' height",
        default=0.6, min=0.0, max=100.0, soft_max=2.0,
    )  # fmt: skip

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only in Object Mode, above something."""
        if not is_in_object_mode(cls, context):
            return False
        if not _below(context):
            cls.poll_message_set(
                pgettext_tip("Select the mesh objects on which the sheet shall fall")
            )
            return False
        return True

    def execute(self, context: Context) -> set[str]:
        """The sheet just above the highest of the objects, over the middle of all."""
        objects = _below(context)
        low, high = _box(objects, context.evaluated_depsgraph_get())
        hem = max(self.overhang * (high.z - low.z), 0.05 * max(high - low))
        width, depth = (high[axis] - low[axis] + 2.0 * hem for axis in (0, 1))
        edge = max(width, depth) / (self.vertices - 1)
        columns, rows = (max(round(length / edge) + 1, 2) for length in (width, depth))
        grid = starter_shapes.sheet(width, depth, columns, rows, lying=True)
        obj = object_data_add(context, mesh_of("Drape", grid))
        settings = obj.boucle
        settings.thickness = _PART_OF_EDGE * edge
        for below in objects:
            collider_setup.add(below, settings.thickness)
        # What is kept free around an object is between two limits: start outside of it, whatever it came to.
        gap = max(below.collision.thickness_outer for below in objects)
        middle = 0.5 * (low + high)
        obj.matrix_world = Matrix.Translation(
            (middle.x, middle.y, high.z + gap + 1.5 * settings.thickness)
        )
        cloth.set_range(obj, context.scene)
        settings.enabled = True
        return {"FINISHED"}


def _below(context: Context) -> list[bpy.types.Object]:
    """The selected meshes that can be colliders, in the order of their names."""
    found = [
        obj
        for obj in context.selected_objects
        if obj.type == "MESH"
        and obj.library is None
        and not obj.boucle.enabled
        and obj.data.polygons
    ]
    return sorted(found, key=lambda obj: obj.name)


def _box(objects: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> tuple[Vector, Vector]:
    """The least and the greatest corner (m, world space) of what is seen of the objects."""
    shown = [obj.evaluated_get(depsgraph) for obj in objects]
    corners = [one.matrix_world @ Vector(corner) for one in shown for corner in one.bound_box]
    low, high = (Vector(map(pick, zip(*corners, strict=True))) for pick in (min, max))
    return low, high


CLASSES = (BOUCLE_OT_drape,)
