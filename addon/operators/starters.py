"""Add > Mesh > Boucle Cloth: starters, each a cloth with its pins, its settings and what it needs around it."""

from __future__ import annotations

import math

import bmesh
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty
from bpy.types import Context, Menu, Operator
from bpy_extras.object_utils import AddObjectHelper, object_data_add
from mathutils import Matrix

from .._identifiers import Menus, Operators
from ..bridge import cloth, collider_setup
from ..core import starter_shapes
from ..core.starter_shapes import Grid
from .add import PIN_GROUP
from .polling import is_in_object_mode

TABLE_GAP = 0.002
"""What is kept free above a table, beside the cloth's thickness (m)."""


class _Starter(AddObjectHelper):
    """What the starters share: the mesh of a grid, its pins, and a cloth that plays."""

    resolution: FloatProperty(
        name="Resolution", description="Length of an edge of the cloth (m); a shorter one takes longer",
        default=0.04, min=1e-3, max=10.0, soft_min=0.01, soft_max=0.2, precision=3, unit="LENGTH",
    )  # fmt: skip

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only in Object Mode: a cloth is an object of its own."""
        return is_in_object_mode(cls, context)

    def count(self, length: float) -> int:
        """Vertices along a length (m)."""
        return min(max(round(length / self.resolution) + 1, 4), 1024)

    def make(self, context: Context, name: str, grid: Grid, pins: list[int]) -> bpy.types.Object:
        """The object, pinned, with the settings that fit its edges."""
        obj = object_data_add(context, mesh_of(name, grid), operator=self)
        if pins:
            obj.vertex_groups.new(name=PIN_GROUP).add(pins, 1.0, "REPLACE")
            obj.boucle.pin_group = PIN_GROUP
        # An eighth of an edge keeps two layers a quarter of an edge apart, and neighbours out of each other's reach.
        obj.boucle.thickness = 0.125 * self.resolution
        cloth.set_range(obj, context.scene)
        obj.boucle.enabled = True
        return obj


def mesh_of(name: str, grid: Grid) -> bpy.types.Mesh:
    """The mesh of a grid, smooth, with a UV map."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(grid.points, [], list(grid.faces()))
    uv = mesh.uv_layers.new(name="UVMap")
    size = max(grid.columns, grid.rows) - 1
    for loop, corner in zip(mesh.loops, uv.data, strict=True):
        row, column = divmod(loop.vertex_index, grid.columns)
        corner.uv = (column / size, row / size)
    mesh.shade_smooth()
    return mesh


class BOUCLE_OT_add_flag(_Starter, Operator):
    """Add a flag that is held at its mast and blows in the wind"""

    bl_idname = Operators.ADD_FLAG
    bl_label = "Flag"
    bl_options = {"REGISTER", "UNDO"}

    width: FloatProperty(
        name="Width", description="Length away from the mast (m)",
        default=1.5, min=0.01, max=1000.0, soft_max=10.0, unit="LENGTH",
    )  # fmt: skip
    height: FloatProperty(
        name="Height", description="Length along the mast (m)",
        default=1.0, min=0.01, max=1000.0, soft_max=10.0, unit="LENGTH",
    )  # fmt: skip
    wind: FloatProperty(
        name="Wind", description="Speed of the wind (m/s)",
        default=8.0, min=0.0, max=1000.0, soft_max=30.0,
    )  # fmt: skip

    def execute(self, context: Context) -> set[str]:
        """A sheet pinned at its first column."""
        columns, rows = self.count(self.width), self.count(self.height)
        grid = starter_shapes.sheet(self.width, self.height, columns, rows, lying=False)
        obj = self.make(context, "Flag", grid, grid.left())
        settings = obj.boucle
        settings.density = 0.12
        settings.use_wind, settings.wind_law = True, "face"
        # Not quite along the flag: straight along it, a flat sheet would feel nothing.
        along = obj.matrix_basis.to_3x3() @ Matrix.Rotation(math.radians(20.0), 3, "Z").col[0]
        settings.wind_velocity = self.wind * along.normalized()
        return {"FINISHED"}


class BOUCLE_OT_add_curtain(_Starter, Operator):
    """Add a curtain whose top is held in pleats"""

    bl_idname = Operators.ADD_CURTAIN
    bl_label = "Curtain"
    bl_options = {"REGISTER", "UNDO"}

    width: FloatProperty(
        name="Width", description="Width that it covers (m)",
        default=1.6, min=0.01, max=1000.0, soft_max=10.0, unit="LENGTH",
    )  # fmt: skip
    height: FloatProperty(
        name="Height", description="Height (m)",
        default=2.0, min=0.01, max=1000.0, soft_max=10.0, unit="LENGTH",
    )  # fmt: skip
    pleats: IntProperty(
        name="Pleats", description="Waves along the top", default=8, min=1, max=500, soft_max=40
    )
    fullness: FloatProperty(
        name="Fullness", description="Width of the cloth as a multiple of the width that it covers, a fraction above 1",
        default=1.8, min=1.0, max=4.0, soft_max=3.0,
    )  # fmt: skip

    def execute(self, context: Context) -> set[str]:
        """Waves pinned at the top."""
        columns = self.count(self.fullness * self.width)
        grid = starter_shapes.pleated(
            self.width, self.height, columns, self.count(self.height), self.pleats, self.fullness
        )
        self.make(context, "Curtain", grid, grid.top())
        return {"FINISHED"}


class BOUCLE_OT_add_cape(_Starter, Operator):
    """Add a cape that is gathered around the neck and open in front"""

    bl_idname = Operators.ADD_CAPE
    bl_label = "Cape"
    bl_options = {"REGISTER", "UNDO"}

    neck: FloatProperty(
        name="Neck", description="Radius at the top (m)",
        default=0.12, min=0.01, max=100.0, soft_max=1.0, unit="LENGTH",
    )  # fmt: skip
    hem: FloatProperty(
        name="Hem", description="Radius at the bottom (m)",
        default=0.5, min=0.01, max=100.0, soft_max=2.0, unit="LENGTH",
    )  # fmt: skip
    length: FloatProperty(
        name="Length", description="Height from neck to hem (m)",
        default=1.2, min=0.01, max=100.0, soft_max=3.0, unit="LENGTH",
    )  # fmt: skip
    pleats: IntProperty(
        name="Pleats", description="Waves around the neck", default=9, min=0, max=200, soft_max=30
    )
    opening: FloatProperty(
        name="Opening", description="Angle that is left open in front (radians)",
        default=math.radians(100.0), min=0.01, max=math.radians(300.0), subtype="ANGLE",
    )  # fmt: skip

    def execute(self, context: Context) -> set[str]:
        """A pleated cone pinned at the neck."""
        arc = 2.0 * math.pi - self.opening
        columns = self.count(0.5 * (self.neck + self.hem) * arc)
        grid = starter_shapes.cape(
            self.neck, self.hem, self.length, columns, self.count(self.length), self.pleats,
            self.opening,
        )  # fmt: skip
        obj = self.make(context, "Cape", grid, grid.top())
        obj.boucle.thickness = min(obj.boucle.thickness, 0.25 * self.neck * arc / columns)
        return {"FINISHED"}


class BOUCLE_OT_add_tablecloth(_Starter, Operator):
    """Add a table, which is a collider, and a cloth that falls on it"""

    bl_idname = Operators.ADD_TABLECLOTH
    bl_label = "Tablecloth"
    bl_options = {"REGISTER", "UNDO"}

    table: EnumProperty(
        name="Table", description="The shape of the table",
        items=(("round", "Round", "A disc"), ("square", "Square", "A slab")), default="round",
    )  # fmt: skip
    table_size: FloatProperty(
        name="Table Size", description="Diameter or side of the table (m)",
        default=1.0, min=0.01, max=1000.0, soft_max=5.0, unit="LENGTH",
    )  # fmt: skip
    overhang: FloatProperty(
        name="Overhang", description="How far the cloth reaches beyond the table (m)",
        default=0.35, min=0.0, max=1000.0, soft_max=2.0, unit="LENGTH",
    )  # fmt: skip
    with_table: BoolProperty(
        name="Make Table", description="Make the table; without it, only the cloth", default=True
    )

    def execute(self, context: Context) -> set[str]:
        """The table at the cursor, the cloth just above it."""
        side = self.table_size + 2.0 * self.overhang
        count = self.count(side)
        grid = starter_shapes.sheet(side, side, count, count, lying=True)
        table = object_data_add(context, self._table(), operator=self) if self.with_table else None
        obj = self.make(context, "Tablecloth", grid, [])
        above = obj.boucle.thickness + 2.0 * TABLE_GAP
        obj.location += (
            obj.matrix_basis.to_3x3() @ Matrix.Translation((0.0, 0.0, above)).translation
        )
        if table is not None:
            collider_setup.add(table, TABLE_GAP, friction=0.3)
        return {"FINISHED"}

    def _table(self) -> bpy.types.Mesh:
        """A slab whose top is at z = 0."""
        radius, height = 0.5 * self.table_size, 0.05 * self.table_size
        shape = bmesh.new()
        down = Matrix.Translation((0.0, 0.0, -0.5 * height))
        if self.table == "round":
            bmesh.ops.create_cone(
                shape, cap_ends=True, segments=48, radius1=radius, radius2=radius, depth=height,
                matrix=down,
            )  # fmt: skip
        else:
            size = Matrix.Diagonal((self.table_size, self.table_size, height, 1.0))
            bmesh.ops.create_cube(shape, size=1.0, matrix=down @ size)
        mesh = bpy.data.meshes.new("Table")
        shape.to_mesh(mesh)
        shape.free()
        return mesh


class BOUCLE_MT_add(Menu):
    """Starters"""

    bl_idname = Menus.ADD
    bl_label = "Boucle Cloth"

    def draw(self, _context: Context) -> None:
        """Lay out."""
        self.layout.operator(Operators.ADD_CLOTH, text="Sheet", icon="MESH_GRID")
        for name in (
            Operators.ADD_FLAG, Operators.ADD_CURTAIN, Operators.ADD_CAPE, Operators.ADD_TABLECLOTH,
        ):  # fmt: skip
            self.layout.operator(name)
        self.layout.separator()
        self.layout.operator(Operators.DRAPE)


def draw_menu(menu: Menu, _context: Context) -> None:
    """The entry in Add > Mesh."""
    menu.layout.menu(Menus.ADD, icon="MOD_CLOTH")


CLASSES = (
    BOUCLE_OT_add_flag,
    BOUCLE_OT_add_curtain,
    BOUCLE_OT_add_cape,
    BOUCLE_OT_add_tablecloth,
    BOUCLE_MT_add,
)
