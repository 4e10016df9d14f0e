"""Add > Mesh > Boucle Cloth."""

from __future__ import annotations

import bmesh
import bpy
from bpy.app.translations import pgettext_n
from bpy.props import EnumProperty, FloatProperty, IntProperty
from bpy.types import Context, Operator
from bpy_extras.object_utils import AddObjectHelper, object_data_add
from mathutils import Matrix

from .._identifiers import Operators
from ..bridge import cloth, presets
from ..core.preset import NONE
from ..core.refusal import Refusal
from .polling import is_in_object_mode

PIN_GROUP = "Pin"
_AXES = {
    "xy": ((1, 0), (0, 1), (0, 0)),
    "xz": ((1, 0), (0, 0), (0, 1)),
    "yz": ((0, 0), (1, 0), (0, 1)),
}
"""Rows x, y, z: how much of the grid's first and second axis goes into each."""
_choices: list[tuple[str, str, str]] = []
"""The presets that were last offered: Blender does not keep the texts of a list that is made for it."""


def _offered(_operator: Operator, _context: Context | None) -> list[tuple[str, str, str]]:
    named = [(row.name, row.title) for row in presets.shipped()]
    named += [(name, name) for name in presets.own_names()]
    _choices[:] = [
        (NONE, pgettext_n("None"), pgettext_n("The settings of a new cloth")),
        *((name, title, presets.description(name)) for name, title in named),
    ]
    return _choices


class BOUCLE_OT_add_cloth(AddObjectHelper, Operator):
    """Add a grid that is a cloth, with its pins"""

    bl_idname = Operators.ADD_CLOTH
    bl_label = "Boucle Cloth"
    bl_options = {"REGISTER", "UNDO"}

    vertices_x: IntProperty(
        name="Vertices X", description="Vertices along the first axis: more fold more finely and take longer",
        default=32, min=2, max=2048, soft_max=256,
    )  # fmt: skip
    vertices_y: IntProperty(
        name="Vertices Y", description="Vertices along the second axis: more fold more finely and take longer",
        default=32, min=2, max=2048, soft_max=256,
    )  # fmt: skip
    size_x: FloatProperty(
        name="Size X", description="Length along the first axis (m)",
        default=2.0, min=1e-4, max=1e4, soft_max=10.0, unit="LENGTH",
    )  # fmt: skip
    size_y: FloatProperty(
        name="Size Y", description="Length along the second axis (m)",
        default=2.0, min=1e-4, max=1e4, soft_max=10.0, unit="LENGTH",
    )  # fmt: skip
    plane: EnumProperty(
        name="Plane", description="The plane in which the cloth begins",
        items=(
            ("xz", "XZ", "Hanging, seen from the front"),
            ("xy", "XY", "Lying"),
            ("yz", "YZ", "Hanging, seen from the side"),
        ),
        default="xz",
    )  # fmt: skip
    pins: EnumProperty(
        name="Pins", description="Corners and edges that are held",
        items=(
            ("top_left", "Top Left", "The corner at the end of the first column"),
            ("top_right", "Top Right", "The corner at the end of the last column"),
            ("bottom_left", "Bottom Left", "The corner at the start of the first column"),
            ("bottom_right", "Bottom Right", "The corner at the start of the last column"),
            ("top", "Top", "The last row"),
            ("bottom", "Bottom", "The first row"),
            ("left", "Left", "The first column"),
            ("right", "Right", "The last column"),
        ),
        options={"ENUM_FLAG"}, default={"top_left", "top_right"},
    )  # fmt: skip
    preset: EnumProperty(
        name="Preset", description="The preset whose settings the cloth begins with", items=_offered
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only in Object Mode: a cloth is an object of its own."""
        return is_in_object_mode(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Make the mesh, the object, its pin group and its settings."""
        obj = object_data_add(context, self._make_mesh(), operator=self)
        if self.preset not in {"", NONE}:  # empty: a preset that has been deleted since
            try:
                presets.apply(obj, self.preset)
            except Refusal as refusal:
                self.report({"WARNING"}, str(refusal))
        pins = pinned(self.vertices_x, self.vertices_y, self.pins)
        if pins:
            obj.vertex_groups.new(name=PIN_GROUP).add(pins, 1.0, "REPLACE")
            obj.boucle.pin_group = PIN_GROUP
        cloth.set_range(obj, context.scene)
        obj.boucle.enabled = True
        return {"FINISHED"}

    def _make_mesh(self) -> bpy.types.Mesh:
        """The grid: vertex = row * columns + column, both growing with their axis."""
        rows = [
            (self.size_x * first, self.size_y * second, 0.0, 0.0)
            for first, second in _AXES[self.plane]
        ]
        grid = bmesh.new()
        grid.loops.layers.uv.new("UVMap")
        bmesh.ops.create_grid(
            grid,
            x_segments=self.vertices_x - 1,
            y_segments=self.vertices_y - 1,
            size=0.5,
            matrix=Matrix((*rows, (0.0, 0.0, 0.0, 1.0))),
            calc_uvs=True,
        )
        mesh = bpy.data.meshes.new("Cloth")
        grid.to_mesh(mesh)
        grid.free()
        return mesh


def pinned(columns: int, rows: int, names: set[str]) -> list[int]:
    """The vertices of the named corners and edges of a grid, in order."""
    top = (rows - 1) * columns
    places = {
        "bottom_left": [0],
        "bottom_right": [columns - 1],
        "top_left": [top],
        "top_right": [top + columns - 1],
        "bottom": range(columns),
        "top": range(top, top + columns),
        "left": range(0, top + 1, columns),
        "right": range(columns - 1, top + columns, columns),
    }
    return sorted({vertex for name in names for vertex in places[name]})


CLASSES = (BOUCLE_OT_add_cloth,)
